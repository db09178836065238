#include "core/recording/aedat/aedat3_reader.h"

#include "core/base/error.h"
#include "core/recording/aedat/chips.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

namespace evical {
namespace {

using aedat3::PacketHeader;
using aedat3::Type;

constexpr std::uint64_t kLargestAedat3Header_bytes = std::uint64_t{1} << 20;

StreamType streamTypeOf(Type type) {
  switch (type) {
    case Type::Special:
      return StreamType::Triggers;
    case Type::Polarity:
      return StreamType::Events;
    case Type::Frame:
      return StreamType::Frames;
    case Type::Imu6:
    case Type::Imu9:
      return StreamType::Imu;
    case Type::Other:
      break;
  }
  return StreamType::Other;
}

std::string_view withoutLineEnd(std::string_view line) {
  while (!line.empty() && line.back() <= ' ') line.remove_suffix(1);
  return line;
}

// "#Source 1: DAVIS240C"; in files of earlier programs the line begins with "#-Source".
void takeSource(std::string_view line, std::map<int, std::string>& sources) {
  constexpr std::string_view kSource = "#Source ";
  if (!line.starts_with(kSource)) return;
  line.remove_prefix(kSource.size());
  int number = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  if (error == std::errc() && line.starts_with(": ")) sources[number] = line.substr(2);
}

}  // namespace

Aedat3Reader::Aedat3Reader(const std::filesystem::path& path) : path_(path.string()), file_(path) {
  readFileHeader();
  position_ = data_position_;
  listStreams();
}

void Aedat3Reader::readFileHeader() {
  constexpr std::string_view kFormat = "#Format: ", kEnd = "#!END-HEADER";
  std::string_view bytes;
  file_.read(0, std::min(file_.size(), kLargestAedat3Header_bytes), bytes);
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = bytes.find('\n', at);
    const std::string_view line =
        withoutLineEnd(bytes.substr(at, end == std::string_view::npos ? end : end - at));
    if (end == std::string_view::npos || !line.starts_with('#')) break;
    at = end + 1;
    takeSource(line, sources_);
    if (line.starts_with(kFormat) && line.substr(kFormat.size()) != "RAW") {
      throw badInput(path_,
                     fmt::format("this is an AEDAT 3.1 file of the format {}", line.substr(kFormat.size())),
                     "Convert it to AEDAT4 with iniVation's DV; only RAW is supported");
    }
    if (line != kEnd) continue;
    data_position_ = at;
    return;
  }
  throw badInput(path_, "the header has no line #!END-HEADER: the file is cut off or damaged",
                 "Copy the file again");
}

void Aedat3Reader::listStreams() {
  std::map<Key, std::uint64_t> counts;
  std::set<int> sources;
  PacketHeader header;
  std::uint64_t position = 0;
  while (nextPacket(header, position, false)) {
    const StreamType type = streamTypeOf(header.type);
    if (type == StreamType::Other) continue;
    const bool triggers = type == StreamType::Triggers;  // and others; counted while reading
    counts[{header.source, type}] += triggers ? 0 : header.valid;
    if (!triggers) sources.insert(header.source);
  }
  for (const auto& [key, count] : counts) addStream(key, count, sources.size() > 1);
  position_ = data_position_;
}

void Aedat3Reader::addStream(const Key& key, std::uint64_t count, bool several_sources) {
  const auto& [source, type] = key;
  const auto named = sources_.find(source);
  StreamInfo info;
  info.name = streamTypeName(type);
  if (several_sources) info.name = fmt::format("source {}/{}", source, info.name);
  info.message = named == sources_.end() ? "" : named->second;
  info.type = type;
  info.readable = type != StreamType::Triggers;
  if (type == StreamType::Events) info.resolution_px = aedat::chipSize(info.message);
  info.messages = count;
  info.time_unit_ns = 1000;
  info.acceleration_unit = AccelerationUnit::Gravity;
  info.angular_rate_unit = AngularRateUnit::DegreesPerSecond;
  if (type == StreamType::Events && !info.resolution_px.known())
    addFault(info.name, FaultKind::NoResolution,
             "The header does not state the sensor's size. Set it in the session.");
  stream_of_key_[key] = streams_.size();
  states_.emplace_back().selected = info.readable && type != StreamType::Frames;
  streams_.push_back(std::move(info));
}

void Aedat3Reader::select(const std::vector<std::size_t>& streams) {
  for (State& state : states_) state.selected = false;
  for (const std::size_t stream : streams) states_.at(stream).selected = true;
}

bool Aedat3Reader::isHeaderAt(std::uint64_t position, PacketHeader& header) {
  std::string_view bytes;
  if (!file_.read(position, aedat3::kHeader_bytes, bytes)) return false;
  const auto found = aedat3::decodeHeader(bytes);
  if (!found) return false;
  header = *found;
  return true;
}

// Data may look like a header: the packet must end in the file, and at the file's end or before another
// packet.
std::uint64_t Aedat3Reader::findHeader(std::uint64_t from) {
  PacketHeader header, next;
  for (std::uint64_t at = from; at + aedat3::kHeader_bytes <= file_.size(); ++at) {
    if (!isHeaderAt(at, header) || header.type == Type::Other) continue;
    const std::uint64_t end = at + aedat3::kHeader_bytes + header.dataBytes();
    if (header.events > 0 && (end == file_.size() || (end < file_.size() && isHeaderAt(end, next))))
      return at;
  }
  return file_.size();
}

// `position` is the beginning of the packet's data. Damage is reported on the second pass, which reads the
// data.
bool Aedat3Reader::nextPacket(PacketHeader& header, std::uint64_t& position, bool say) {
  while (position_ < file_.size()) {
    const std::uint64_t at = position_;
    const bool good = isHeaderAt(at, header);
    position = at + aedat3::kHeader_bytes;
    position_ = position + header.dataBytes();
    if (good && position_ <= file_.size()) return true;
    position_ = findHeader(at + 1);
    const bool cut = position_ == file_.size() && (good || at + aedat3::kHeader_bytes > file_.size());
    if (say && cut) {
      addFault(
          "", FaultKind::Truncated,
          fmt::format("The last packet, at byte {} of {}, is incomplete; it is left out.", at, file_.size()));
    } else if (say) {
      addFault("", FaultKind::Corrupt,
               fmt::format("The packet at byte {} of {} is damaged; reading continues at byte {}.", at,
                           file_.size(), position_));
    }
  }
  return false;
}

bool Aedat3Reader::read(Packet& packet) {
  if (handOutRest(packet)) return true;
  PacketHeader header;
  std::uint64_t position = 0;
  packet.clear();
  while (nextPacket(header, position, true)) {
    const auto found = stream_of_key_.find({header.source, streamTypeOf(header.type)});
    if (found == stream_of_key_.end()) continue;
    const std::size_t stream = found->second;
    const bool triggers = streams_[stream].type == StreamType::Triggers;
    if (!triggers && (!states_[stream].selected || !streams_[stream].readable)) continue;
    decode(stream, header, position, packet);
    if (!packet.empty()) return true;
  }
  return false;
}

void Aedat3Reader::decode(std::size_t stream, const PacketHeader& header, std::uint64_t position,
                          Packet& packet) {
  packet.stream = stream;
  packet.clear();
  std::string_view bytes;
  const bool whole =
      file_.read(position, header.dataBytes(), bytes) && decodeContent(stream, header, bytes, packet);
  putInOrder(stream, packet.events);
  if (whole) return;
  addFault(streams_[stream].name, FaultKind::Corrupt,
           fmt::format("The packet at byte {} has invalid times or sizes; these are left out.",
                       position - aedat3::kHeader_bytes));
}

bool Aedat3Reader::decodeContent(std::size_t stream, const PacketHeader& header, std::string_view bytes,
                                 Packet& packet) {
  StreamInfo& info = streams_[stream];
  if (header.type == Type::Polarity) return aedat3::decodePolarity(header, bytes, packet.events);
  if (header.type == Type::Imu6 || header.type == Type::Imu9)
    return aedat3::decodeImu(header, bytes, packet.imu_samples);
  if (header.type == Type::Special) {
    countSpecial(stream, header, bytes);
    return true;
  }
  std::string unusable;
  const bool whole = aedat3::decodeFrames(header, bytes, packet.frames, unusable);
  if (!unusable.empty())
    addFault(info.name, FaultKind::Encoding, fmt::format("Frames {}; they are left out.", unusable));
  if (!packet.frames.empty() && !info.resolution_px.known()) info.resolution_px = packet.frames[0].size_px;
  return whole;
}

void Aedat3Reader::countSpecial(std::size_t stream, const PacketHeader& header, std::string_view bytes) {
  const aedat3::SpecialCounts counts = aedat3::countSpecial(header, bytes);
  states_[stream].counted += counts.triggers;
  streams_[stream].messages = states_[stream].counted;
  resets_ += counts.resets;
  if (counts.resets > 0 && resets_ > 1)
    addFault("", FaultKind::BackwardTime, "The camera's clock was reset to 0 within the recording.");
}

void Aedat3Reader::putInOrder(std::size_t stream, std::vector<Event>& events) {
  EventOrder& order = states_[stream].order;
  order.split(events, rest_);
  rest_stream_ = stream;
  if (!order.changedAnything()) return;
  const std::string& name = streams_[stream].name;
  addFault(name, FaultKind::Unsorted, "");
  for (RecordingFault& fault : faults_)
    if (fault.stream == name && fault.kind == FaultKind::Unsorted) fault.text = order.text();
}

bool Aedat3Reader::handOutRest(Packet& packet) {
  if (rest_.empty()) return false;
  packet.clear();
  packet.stream = rest_stream_;
  std::swap(packet.events, rest_);
  putInOrder(packet.stream, packet.events);
  return true;
}

double Aedat3Reader::fractionRead() const {
  const auto size = static_cast<double>(std::max<std::uint64_t>(1, file_.size()));
  return std::min(1.0, static_cast<double>(position_) / size);
}

void Aedat3Reader::addFault(const std::string& stream, FaultKind kind, const std::string& text) {
  const std::ptrdiff_t most = kind == FaultKind::Corrupt ? kMostAlikeFaults : 1;
  const auto alike = [&](const RecordingFault& fault) {
    return fault.stream == stream && fault.kind == kind;
  };
  if (std::count_if(faults_.begin(), faults_.end(), alike) < most)
    faults_.push_back({stream, kind, 0.0, text});
}

}  // namespace evical
