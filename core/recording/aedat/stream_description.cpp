#include "core/recording/aedat/stream_description.h"

#include "core/data/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>

namespace evical::aedat {
namespace {

struct Entity {
  char letter;
  std::string_view text;
};
constexpr Entity kEntities[] = {
    {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&apos;"}, {'&', "&amp;"}};

std::string unescaped(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    const auto known = std::find_if(std::begin(kEntities), std::end(kEntities),
                                    [&](const Entity& entity) { return text.starts_with(entity.text); });
    const bool found = known != std::end(kEntities);
    plain += found ? known->letter : text.front();
    text.remove_prefix(found ? known->text.size() : 1);
  }
  return plain;
}

std::string escaped(std::string_view text) {
  std::string xml;
  for (const char letter : text) {
    const auto known = std::find_if(std::begin(kEntities), std::end(kEntities),
                                    [&](const Entity& entity) { return entity.letter == letter; });
    if (known != std::end(kEntities)) {
      xml += known->text;
    } else {
      xml += letter;
    }
  }
  return xml;
}

std::optional<std::int32_t> wholeNumber(std::string_view text) {
  std::int32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Value of an attribute in a tag's inside: name="..." of `<attr key="name">`.
std::string_view attribute(std::string_view tag, std::string_view name) {
  const std::string start = fmt::format(" {}=\"", name);
  const std::size_t at = tag.find(start);
  if (at == std::string_view::npos) return {};
  tag.remove_prefix(at + start.size());
  return tag.substr(0, tag.find('"'));
}

void store(std::string_view key, const std::string& value, StreamDescription& stream) {
  if (key == "originalOutputName") stream.name = value;
  if (key == "typeIdentifier") stream.type = value;
  if (key == "source") stream.source = value;
  if (key != "sizeX" && key != "sizeY") return;
  const std::int32_t side_px = wholeNumber(value).value_or(0);
  if (side_px < 1 || side_px > kLargestSide_px) return;
  (key == "sizeX" ? stream.size_px.width_px : stream.size_px.height_px) = side_px;
}

// Nodes are named "outInfo", below it the stream's id, below that perhaps "info".
class DescriptionParser {
 public:
  explicit DescriptionParser(std::string_view xml) : rest_(xml) {}

  std::vector<StreamDescription> run() {
    for (std::size_t begin = rest_.find('<'); begin != std::string_view::npos; begin = rest_.find('<')) {
      rest_.remove_prefix(begin + 1);
      const std::size_t end = rest_.find('>');
      if (end == std::string_view::npos) break;
      const std::string_view tag = rest_.substr(0, end);
      rest_.remove_prefix(end + 1);
      handle(tag);
    }
    return std::move(streams_);
  }

 private:
  void handle(std::string_view tag) {
    if (tag.starts_with("node ")) {
      if (!tag.ends_with('/')) openNode(attribute(tag, "name"));
    } else if (tag == "/node") {
      if (!nodes_.empty()) nodes_.pop_back();
    } else if (tag.starts_with("attr ") && !tag.ends_with('/') && isInStream()) {
      store(attribute(tag, "key"), unescaped(rest_.substr(0, rest_.find('<'))), streams_.back());
    }
  }

  void openNode(std::string_view name) {
    const std::optional<std::int32_t> id = wholeNumber(name);
    if (!nodes_.empty() && nodes_.back() == "outInfo" && id && *id >= 0) {
      streams_.emplace_back().id = *id;
    }
    nodes_.push_back(name);
  }

  bool isInStream() const {
    const std::size_t depth = nodes_.size();
    const auto isId = [this](std::size_t i) {
      return i >= 1 && nodes_[i - 1] == "outInfo" && wholeNumber(nodes_[i]).value_or(-1) >= 0;
    };
    return (depth >= 2 && isId(depth - 1)) || (depth >= 3 && nodes_[depth - 1] == "info" && isId(depth - 2));
  }

  std::string_view rest_;
  std::vector<std::string_view> nodes_;
  std::vector<StreamDescription> streams_;
};

const char* typeDescription(std::string_view type) {
  return type == "EVTS" ? "Array of events (polarity ON/OFF)." : "Inertial Measurement Unit data samples.";
}

void appendStream(const StreamDescription& stream, std::string_view compression, std::string& xml) {
  const auto out = std::back_inserter(xml);
  const std::string path = fmt::format("/mainloop/Recorder/outInfo/{}/", stream.id);
  const auto text = [&](int depth, const char* key, std::string_view value) {
    fmt::format_to(out, "{:{}}<attr key=\"{}\" type=\"string\">{}</attr>\n", "", 4 * depth, key,
                   escaped(value));
  };
  fmt::format_to(out, "        <node name=\"{}\" path=\"{}\">\n", stream.id, path);
  text(3, "compression", compression);
  text(3, "originalModuleName", "capture");
  text(3, "originalOutputName", stream.name);
  text(3, "typeDescription", typeDescription(stream.type));
  text(3, "typeIdentifier", stream.type);
  fmt::format_to(out, "            <node name=\"info\" path=\"{}info/\">\n", path);
  if (stream.size_px.known()) {
    const auto side = [&](const char* key, int value) {
      fmt::format_to(out, "{:16}<attr key=\"{}\" type=\"int\">{}</attr>\n", "", key, value);
    };
    side("sizeX", stream.size_px.width_px);
    side("sizeY", stream.size_px.height_px);
  }
  text(4, "source", stream.source);
  xml += "            </node>\n        </node>\n";
}

}  // namespace

std::vector<StreamDescription> parseDescriptions(std::string_view xml) {
  std::vector<StreamDescription> streams = DescriptionParser(xml).run();
  const auto before = [](const StreamDescription& a, const StreamDescription& b) { return a.id < b.id; };
  const auto same = [](const StreamDescription& a, const StreamDescription& b) { return a.id == b.id; };
  std::stable_sort(streams.begin(), streams.end(), before);
  streams.erase(std::unique(streams.begin(), streams.end(), same), streams.end());
  return streams;
}

std::string descriptionsXml(const std::vector<StreamDescription>& streams, std::string_view compression) {
  std::string xml =
      "<dv version=\"2.0\">\n    <node name=\"outInfo\" path=\"/mainloop/Recorder/outInfo/\">\n";
  for (const StreamDescription& stream : streams) appendStream(stream, compression, xml);
  return xml + "    </node>\n</dv>\n";
}

std::vector<std::string> uniqueNames(const std::vector<StreamDescription>& streams) {
  std::vector<std::string> names;
  for (const StreamDescription& stream : streams) {
    names.push_back(stream.name.empty() ? fmt::format("stream {}", stream.id) : stream.name);
  }
  const auto isAlone = [&](std::size_t i) { return std::count(names.begin(), names.end(), names[i]) == 1; };
  std::vector<std::string> longer = names;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (!isAlone(i) && !streams[i].source.empty()) longer[i] = streams[i].source + "/" + names[i];
  }
  names = longer;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (!isAlone(i)) longer[i] = fmt::format("{}_{}", names[i], streams[i].id);
  }
  return longer;
}

}  // namespace evical::aedat

namespace evical::aedat {
namespace {

constexpr const char* kNobody = "Evical";

std::string sourceOf(const StreamInfo& stream) {
  if (!stream.source.empty()) return stream.source;
  const std::size_t begin = stream.name.starts_with('/') ? 1 : 0, end = stream.name.rfind('/');
  return end == std::string::npos || end <= begin ? std::string() : stream.name.substr(begin, end - begin);
}

// Our reader puts a source before names that are not unique.
std::string ownName(const StreamInfo& stream) {
  const std::string prefix = stream.source + "/";
  return !stream.source.empty() && stream.name.starts_with(prefix) ? stream.name.substr(prefix.size())
                                                                   : stream.name;
}

}  // namespace

std::vector<DeviceName> deviceNames(const std::vector<StreamInfo>& streams) {
  std::vector<DeviceName> names;
  for (const StreamInfo& stream : streams) names.push_back({sourceOf(stream), ownName(stream)});
  const auto is_camera = [](const StreamInfo& stream) { return stream.type == StreamType::Events; };
  const auto camera = std::find_if(streams.begin(), streams.end(), is_camera);
  const bool only = std::count_if(streams.begin(), streams.end(), is_camera) == 1;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (only && streams[i].source.empty())
      names[i].source = names[static_cast<std::size_t>(camera - streams.begin())].source;
    if (names[i].source.empty()) names[i].source = kNobody;
  }
  for (std::size_t i = 0; i < streams.size(); ++i) {
    std::size_t same = 0;
    for (std::size_t j = 0; j < streams.size(); ++j)
      same += streams[j].type == streams[i].type && names[j].source == names[i].source;
    if (same == 1) names[i].output = is_camera(streams[i]) ? "events" : "imu";
  }
  return names;
}

}  // namespace evical::aedat
