#include "core/recording/text/text_table_reader.h"

#include "core/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>

namespace evical {
namespace {

constexpr std::size_t kPacketEvents = 10'000;
constexpr std::int64_t kPacketSpan_ns = 10'000'000;
constexpr std::size_t kPacketSamples = 10;
constexpr int kMostBadLines = 10;  // reported one by one

bool parsePixel(std::string_view text, std::uint16_t& value) {
  if (parseNumber(text, value)) return true;
  double number = 0.0;  // as numpy.savetxt writes it
  if (!parseNumber(text, number) || number < 0.0 || number > 65535.0) return false;
  value = static_cast<std::uint16_t>(number);
  return static_cast<double>(value) == number;
}

bool parsePolarity(std::string_view text, bool& brighter) {
  double number = 0.0;
  brighter = text == "1" || text == "true" || text == "True";
  if (brighter || text == "0" || text == "false" || text == "False") return true;
  if (!parseNumber(text, number)) return false;
  brighter = number == 1.0;
  return number == 1.0 || number == 0.0 || number == -1.0;
}

bool parseEvent(std::string_view line, Event& event) {
  return parseSeconds(takeColumn(line), event.time_ns) && parsePixel(takeColumn(line), event.x_px) &&
         parsePixel(takeColumn(line), event.y_px) && parsePolarity(takeColumn(line), event.brighter);
}

bool isComment(std::string_view line) {
  const std::string_view column = takeColumn(line);
  return column.empty() || column.front() == '#' || column.front() == '%';
}

// Where a header's names put time, acceleration and angular rate; false if it does not name all three.
bool columnsFromHeader(std::string_view line, std::size_t& time, std::size_t& acceleration,
                       std::size_t& rate) {
  bool has_time = false, has_acceleration = false, has_rate = false;
  for (std::size_t i = 0;; ++i) {
    std::string name(takeColumn(line));
    if (name.empty()) return has_time && has_acceleration && has_rate;
    if (name == "#") {
      --i;  // a comment's sign is no column
      continue;
    }
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    name.erase(0, name.find_first_not_of('#'));
    const auto first = [&](bool& has, std::size_t& column, std::initializer_list<const char*> starts) {
      const bool match =
          std::any_of(starts.begin(), starts.end(), [&](const char* s) { return name.starts_with(s); });
      if (match && !has) column = i;
      has = has || match;
      return match;
    };
    if (first(has_rate, rate, {"ang", "gyr", "w_", "wx", "gx"})) continue;
    if (first(has_acceleration, acceleration, {"acc", "lin", "a_", "ax"})) continue;
    first(has_time, time, {"time", "t"});
  }
}

std::size_t countColumns(std::string_view line) {
  std::size_t count = 0;
  while (!takeColumn(line).empty()) ++count;
  return count;
}

StreamType typeOfLine(std::string_view line) {
  Event event{};
  if (countColumns(line) == 4 && parseEvent(line, event)) return StreamType::Events;
  if (countColumns(line) != 7) return StreamType::Other;
  double number = 0.0;
  for (int i = 0; i < 7; ++i) {
    if (!parseNumber(takeColumn(line), number)) return StreamType::Other;
  }
  return StreamType::Imu;
}

}  // namespace

StreamType textTableType(std::string_view first_bytes) {
  while (!first_bytes.empty()) {
    const std::size_t end = std::min(first_bytes.find('\n'), first_bytes.size());
    const std::string_view line = first_bytes.substr(0, end);
    first_bytes.remove_prefix(std::min(end + 1, first_bytes.size()));
    std::size_t time = 0, acceleration = 0, rate = 0;
    if (columnsFromHeader(line, time, acceleration, rate)) return StreamType::Imu;
    if (isComment(line)) continue;
    const StreamType type = typeOfLine(line);
    if (type != StreamType::Other || std::isalpha(static_cast<unsigned char>(line[0])) == 0) return type;
  }
  return StreamType::Other;
}

TextTableReader::TextTableReader(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) {
    std::string bytes(1024, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    addSource(path, textTableType(bytes));
    return;
  }
  if (std::filesystem::exists(path / "events.txt")) addSource(path / "events.txt", StreamType::Events);
  if (std::filesystem::exists(path / "imu.txt")) addSource(path / "imu.txt", StreamType::Imu);
}

void TextTableReader::addSource(const std::filesystem::path& path, StreamType type) {
  if (type != StreamType::Events && type != StreamType::Imu) {
    throw badInput(path.string(), "the lines are neither \"t x y p\" nor \"t ax ay az gx gy gz\"");
  }
  sources_.push_back({TextLines(path), type, true, false, std::numeric_limits<std::int64_t>::min()});
  StreamInfo stream;
  stream.name = path.filename().string();
  stream.type = type;
  stream.message = type == StreamType::Events ? "t x y p" : "t ax ay az gx gy gz";
  streams_.push_back(stream);
}

void TextTableReader::select(const std::vector<std::size_t>& streams) {
  for (Source& source : sources_) source.wanted = false;
  for (const std::size_t stream : streams) sources_.at(stream).wanted = true;
}

// The stream that is behind goes first, so that files are read side by side.
bool TextTableReader::read(Packet& packet) {
  packet.events.clear();
  packet.imu_samples.clear();
  while (packet.events.empty() && packet.imu_samples.empty()) {
    Source* behind = nullptr;
    for (Source& source : sources_) {
      const bool runs = source.wanted && !source.finished;
      if (runs && (!behind || source.last_ns < behind->last_ns)) behind = &source;
    }
    if (!behind) return false;
    packet.stream = static_cast<std::size_t>(behind - sources_.data());
    if (behind->type == StreamType::Events) {
      fillEvents(*behind, packet.stream, packet.events);
    } else {
      fillImu(*behind, packet.stream, packet.imu_samples);
    }
  }
  return true;
}

// A packet ends where time steps back: within a packet events are in order, and nothing is rearranged.
void TextTableReader::fillEvents(Source& source, std::size_t stream, std::vector<Event>& events) {
  if (source.has_next_event) events.push_back(source.next_event);
  source.has_next_event = false;
  std::string_view line;
  Event event{};
  while (source.lines.next(line)) {
    if (!parseEvent(line, event)) {
      if (!isComment(line)) addBadLine(source, stream);
      continue;
    }
    if (!events.empty() && (event.time_ns < events.back().time_ns || events.size() >= kPacketEvents ||
                            event.time_ns - events.front().time_ns >= kPacketSpan_ns)) {
      source.next_event = event;
      source.has_next_event = true;
      source.last_ns = event.time_ns;
      return;
    }
    events.push_back(event);
  }
  source.finished = true;
}

void TextTableReader::fillImu(Source& source, std::size_t stream, std::vector<ImuSample>& samples) {
  std::string_view line;
  ImuSample sample;
  while (samples.size() < kPacketSamples) {
    if (!source.lines.next(line)) {
      source.finished = true;
      return;
    }
    if (!source.columns_known) {
      // Names stand in the first line, if anywhere, perhaps as a comment.
      source.columns_known = true;
      if (columnsFromHeader(line, source.time_column, source.acceleration_column, source.rate_column))
        continue;
    }
    if (parseImu(source, line, sample)) {
      samples.push_back(sample);
      source.last_ns = sample.time_ns;
    } else if (!isComment(line)) {
      addBadLine(source, stream);
    }
  }
}

bool TextTableReader::parseImu(Source& source, std::string_view line, ImuSample& sample) {
  std::size_t values = 0;
  for (std::size_t i = 0; values < 7; ++i) {
    const std::string_view column = takeColumn(line);
    if (column.empty()) return false;
    const std::size_t in_acceleration = i - source.acceleration_column, in_rate = i - source.rate_column;
    bool good = true;
    if (i == source.time_column) {
      good = parseSeconds(column, sample.time_ns);
    } else if (in_acceleration < 3) {
      good = parseNumber(column, sample.specific_force_m_s2[static_cast<Eigen::Index>(in_acceleration)]);
    } else if (in_rate < 3) {
      good = parseNumber(column, sample.angular_rate_rad_s[static_cast<Eigen::Index>(in_rate)]);
    } else {
      continue;
    }
    if (!good) return false;
    ++values;
  }
  return true;
}

void TextTableReader::addBadLine(const Source& source, std::size_t stream) {
  const std::string& name = streams_[stream].name;
  const auto alike = [&](const RecordingFault& fault) { return fault.stream == name; };
  if (std::count_if(faults_.begin(), faults_.end(), alike) >= kMostBadLines) return;
  const bool last = source.lines.bytesRead() == source.lines.size();
  faults_.push_back({name, last ? "truncated" : "corrupt", 0.0,
                     fmt::format("Line {} is not \"{}\"; it is left out.", source.lines.number(),
                                 streams_[stream].message)});
}

double TextTableReader::fractionRead() const {
  double read = 0.0, size = 1.0;
  for (const Source& source : sources_) {
    if (!source.wanted) continue;
    read += static_cast<double>(source.lines.bytesRead());
    size += static_cast<double>(source.lines.size());
  }
  return read / std::max(1.0, size - 1.0);
}

}  // namespace evical
