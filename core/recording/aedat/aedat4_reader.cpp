#include "core/recording/aedat/aedat4_reader.h"

#include "core/base/error.h"
#include "core/recording/byte_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace evical {
namespace {

constexpr std::uint64_t kLargestAedat4Header_bytes = std::uint64_t{1} << 26;
constexpr std::uint64_t kLargestTable_bytes = std::uint64_t{1} << 28;
constexpr std::int32_t kLargestId = 9999;

struct PacketType {
  std::string_view id;
  const char* name;  // if the file has no name
  StreamType type;
};
constexpr PacketType kPacketTypes[] = {{"EVTS", "events", StreamType::Events},
                                       {"IMUS", "imu", StreamType::Imu},
                                       {"FRME", "frames", StreamType::Frames},
                                       {"TRIG", "triggers", StreamType::Triggers}};

const PacketType* findType(std::string_view id) {
  for (const PacketType& type : kPacketTypes)
    if (type.id == id) return &type;
  return nullptr;
}

}  // namespace

Aedat4Reader::Aedat4Reader(const std::filesystem::path& path)
    : path_(path.string()), file_(path), limit_(path_, file_.size()) {
  const aedat::FileHeader header = readFileHeader();
  position_ = data_position_;
  compression_ = static_cast<aedat::Compression>(header.compression);
  unpacker_ = std::make_unique<aedat::Unpacker>(compression_);
  std::map<std::int32_t, Listed> listed = listFromTable(header.table_position);
  if (table_position_ == 0) listed = listByScan();
  addStreams(aedat::parseDescriptions(header.description), listed);
}

aedat::FileHeader Aedat4Reader::readFileHeader() {
  const std::uint64_t at = aedat::kMagic.size();
  const char* advice = "Copy the file again; if it was recorded like this, it cannot be read";
  std::string_view bytes;
  const bool has_size = file_.read(at, 4, bytes);
  const std::uint64_t size = has_size ? std::uint64_t{ByteCursor(bytes).number<std::uint32_t>()} + 4 : 4;
  if (!has_size || size > kLargestAedat4Header_bytes || !file_.read(at, size, bytes)) {
    throw badInput(path_, fmt::format("the header at byte {} is cut off or damaged", at), advice);
  }
  const std::optional<aedat::FileHeader> header = aedat::decodeHeader(bytes);
  if (!header) throw badInput(path_, fmt::format("the header at byte {} is damaged", at), advice);
  if (header->compression < 0 || header->compression >= aedat::kCompressions) {
    throw badInput(path_, fmt::format("the header at byte {} names the unknown compression {}", at,
                                      header->compression));
  }
  data_position_ = at + size;
  return *header;
}

// Sets table_position_ if the table exists and is complete.
std::map<std::int32_t, Aedat4Reader::Listed> Aedat4Reader::listFromTable(std::int64_t position) {
  std::map<std::int32_t, Listed> listed;
  const auto at = static_cast<std::uint64_t>(position);
  if (position < 0 || at < data_position_ || at >= file_.size()) {
    if (position > 0) {
      addFault("", FaultKind::Truncated,
               fmt::format("The table of packets should be at byte {} of {}; the file is cut off or was not "
                           "finished.",
                           position, file_.size()));
    }
    return listed;
  }
  std::string_view packed, content;
  std::size_t used = 0;
  const bool whole = file_.size() - at <= kLargestTable_bytes && file_.read(at, file_.size() - at, packed) &&
                     unpackCounted(packed, content, used);
  const auto entries = whole ? aedat::decodeTable(content) : std::nullopt;
  if (!entries) {
    addFault("", FaultKind::Corrupt,
             fmt::format("The table of packets at byte {} is damaged; packets are read without it.", at));
    return listed;
  }
  for (const aedat::TableEntry& entry : *entries) {
    Listed& stream = listed[entry.stream];
    if (stream.packets++ == 0) stream.first_position = static_cast<std::uint64_t>(entry.position);
    stream.elements += static_cast<std::uint64_t>(std::max<std::int64_t>(entry.count, 0));
  }
  table_position_ = at;
  return listed;
}

std::map<std::int32_t, Aedat4Reader::Listed> Aedat4Reader::listByScan() {
  std::map<std::int32_t, Listed> listed;
  PacketHeader header;
  for (std::uint64_t at = data_position_; at < file_.size();) {
    if (readHeader(at, header) != HeaderState::Good) {
      at = scanForPacket(at + 1);
      continue;
    }
    Listed& stream = listed[header.stream];
    if (stream.packets++ == 0) stream.first_position = at;
    at = header.end();
  }
  return listed;
}

void Aedat4Reader::addStreams(std::vector<aedat::StreamDescription> described,
                              const std::map<std::int32_t, Listed>& listed) {
  for (const auto& [id, stream] : listed) {
    const auto same = [id = id](const aedat::StreamDescription& known) { return known.id == id; };
    if (id < 0 || id > kLargestId || std::any_of(described.begin(), described.end(), same)) continue;
    described.emplace_back().id = id;
  }
  const auto before = [](const auto& a, const auto& b) { return a.id < b.id; };
  std::sort(described.begin(), described.end(), before);
  for (aedat::StreamDescription& stream : described) {
    const auto found = listed.find(stream.id);
    if (!findType(stream.type) && found != listed.end()) takeTypeOfPackets(stream, found->second);
    const PacketType* type = findType(stream.type);
    if (stream.name.empty() && type) stream.name = type->name;
  }
  const std::vector<std::string> names = aedat::uniqueNames(described);
  for (std::size_t i = 0; i < described.size(); ++i) {
    const PacketType* type = findType(described[i].type);
    const auto found = listed.find(described[i].id);
    StreamInfo info;
    info.name = names[i];
    info.source = described[i].source;
    info.message = described[i].type;
    info.type = type ? type->type : StreamType::Other;
    info.readable = info.type != StreamType::Triggers && info.type != StreamType::Other;
    info.resolution_px = described[i].size_px;
    if (found != listed.end()) {
      info.messages = std::max(found->second.packets, found->second.elements);
    }
    info.time_unit_ns = kMicrosecond_ns;
    info.acceleration_unit = AccelerationUnit::Gravity;
    info.angular_rate_unit = AngularRateUnit::DegreesPerSecond;
    stream_of_id_[described[i].id] = i;
    streams_.push_back(info);
    states_.emplace_back().selected = info.readable && info.type != StreamType::Frames;
  }
}

// For descriptions with a missing or damaged type.
void Aedat4Reader::takeTypeOfPackets(aedat::StreamDescription& stream, const Listed& listed) {
  const std::string type = typeOfPacket(listed.first_position);
  if (!stream.type.empty() && findType(type)) {
    addFault("", FaultKind::Corrupt,
             fmt::format("The header gives stream {} the type \"{}\"; its packets are \"{}\".", stream.id,
                         stream.type, type));
  }
  if (stream.type.empty() || findType(type)) stream.type = type;
}

std::string Aedat4Reader::typeOfPacket(std::uint64_t position) {
  PacketHeader header;
  std::string_view packed, content;
  std::size_t used = 0;
  const bool good = readHeader(position, header) == HeaderState::Good &&
                    file_.read(header.dataPosition(), static_cast<std::uint64_t>(header.size), packed) &&
                    unpackCounted(packed, content, used);
  return good ? std::string(aedat::packetType(content)) : std::string();
}

void Aedat4Reader::select(const std::vector<std::size_t>& streams) {
  for (StreamState& state : states_) state.selected = false;
  for (const std::size_t stream : streams) states_.at(stream).selected = true;
}

Aedat4Reader::HeaderState Aedat4Reader::readHeader(std::uint64_t position, PacketHeader& header) {
  header = {};
  header.position = position;
  if (position >= file_.size()) return HeaderState::End;
  std::string_view bytes;
  if (!file_.read(position, aedat::kPacketHeader_bytes, bytes)) return HeaderState::Cut;
  ByteCursor cursor(bytes);
  header.stream = cursor.number<std::int32_t>();
  header.size = cursor.number<std::int32_t>();
  const bool possible = header.stream >= 0 && header.stream <= kLargestId && header.size > 0;
  if (!possible || !looksLikeData(header.dataPosition(), header.size)) return HeaderState::Damaged;
  return header.end() <= file_.size() ? HeaderState::Good : HeaderState::Cut;
}

// Packed data begin with the frame's magic number, others with their size.
bool Aedat4Reader::looksLikeData(std::uint64_t position, std::int32_t size) {
  std::string_view bytes;
  if (!file_.read(position, 4, bytes)) return position + 4 > file_.size();
  if (compression_ != aedat::Compression::None) return bytes == aedat::frameMagic(compression_);
  return std::uint64_t{ByteCursor(bytes).number<std::uint32_t>()} + 4 == static_cast<std::uint64_t>(size);
}

// The file's size if there is none.
std::uint64_t Aedat4Reader::scanForPacket(std::uint64_t from) {
  constexpr std::uint64_t kBlock_bytes = 1 << 20;
  constexpr std::uint64_t kOverlap_bytes = 20;
  const bool packed = compression_ != aedat::Compression::None;
  // The packet's header precedes the magic number; with a type, also its size and root offset do.
  const std::size_t lead = aedat::kPacketHeader_bytes + (packed ? 0 : 8);
  std::vector<std::string_view> marks{aedat::frameMagic(compression_)};
  if (!packed) marks = {"EVTS", "IMUS", "FRME", "TRIG"};
  std::string block;
  PacketHeader header;
  for (std::uint64_t begin = from; begin < file_.size(); begin += kBlock_bytes) {
    std::string_view bytes;
    if (!file_.read(begin, std::min(kBlock_bytes + kOverlap_bytes, file_.size() - begin), bytes)) break;
    block = bytes;  // checking packets reads others
    std::uint64_t nearest = file_.size();
    for (const std::string_view mark : marks) {
      for (std::size_t hit = block.find(mark, lead); hit != std::string::npos;
           hit = block.find(mark, hit + 1)) {
        const std::uint64_t at = begin + hit - lead;
        if (at >= nearest) break;
        if (readHeader(at, header) == HeaderState::Good) nearest = at;
      }
    }
    if (nearest != file_.size()) return nearest;
  }
  return file_.size();
}

bool Aedat4Reader::nextPacket(PacketHeader& header) {
  for (;;) {
    if (position_ == table_position_) return false;
    const HeaderState state = follows_ ? awaitHeader(header) : readHeader(position_, header);
    if (state == HeaderState::End) return false;
    if (state == HeaderState::Good) {
      position_ = header.end();
      return true;
    }
    if (!skipDamage(header, state)) return false;
  }
}

// Anything but a packet is the table, or damage. At the end the header has the place of the table.
Aedat4Reader::HeaderState Aedat4Reader::awaitHeader(PacketHeader& header) {
  file_.reaches(position_ + aedat::kPacketHeader_bytes + 4);
  HeaderState state = readHeader(position_, header);
  if (state == HeaderState::Cut && file_.reaches(header.end())) state = readHeader(position_, header);
  limit_.setFileBytes(file_.size());
  if (state == HeaderState::Good || state == HeaderState::End) return state;
  file_.awaitEnd();
  follows_ = false;
  const std::int64_t table = readFileHeader().table_position;
  if (table > 0 && static_cast<std::uint64_t>(table) <= file_.size())
    table_position_ = static_cast<std::uint64_t>(table);
  return position_ == table_position_ ? HeaderState::End : readHeader(position_, header);
}

bool Aedat4Reader::follow(const std::shared_ptr<Growth>& growth) {
  follows_ = table_position_ == 0;
  if (follows_) file_.follow(growth);
  // The table is still to come.
  if (follows_)
    std::erase_if(faults_, [](const RecordingFault& fault) { return fault.kind == FaultKind::Truncated; });
  return true;
}

void Aedat4Reader::resumeBehind(std::uint64_t position) {
  position_ = scanForPacket(position + 1);
  if (table_position_ != 0) position_ = std::min(position_, table_position_);
}

// A size beyond the end may be wrong, or the recording was cut here.
bool Aedat4Reader::skipDamage(const PacketHeader& header, HeaderState state) {
  const std::uint64_t at = header.position;
  resumeBehind(at);
  const bool last = position_ == file_.size() || position_ == table_position_;
  if (last && state == HeaderState::Cut) {
    addFault(
        "", FaultKind::Truncated,
        fmt::format("The last packet, at byte {} of {}, is incomplete; it is left out.", at, file_.size()));
  } else {
    addFault("", FaultKind::Corrupt,
             fmt::format("The packet at byte {} of {} is damaged; {}.", at, file_.size(),
                         last ? "nothing after it can be read"
                              : fmt::format("reading continues at byte {}", position_)));
  }
  return !last;
}

// The size of a frame that ends early was wrong: reading continues after its actual end.
bool Aedat4Reader::unpack(const PacketHeader& header, std::string_view& content) {
  std::size_t used = 0;
  const auto size = static_cast<std::uint64_t>(header.size);
  std::string_view packed;
  const bool read = file_.read(header.dataPosition(), size, packed);
  if (read && unpackCounted(packed, content, used)) {
    if (used == size) return true;
    position_ = header.dataPosition() + used;
    addFault("", FaultKind::Corrupt,
             fmt::format("The packet at byte {} states {} bytes and has {}.", header.position, size, used));
    return true;
  }
  resumeBehind(header.position);
  addFault("", FaultKind::Corrupt,
           fmt::format("The packet at byte {} cannot be unpacked; it is left out.", header.position));
  return false;
}

bool Aedat4Reader::unpackCounted(std::string_view packed, std::string_view& content, std::size_t& used) {
  const bool good = unpacker_->unpack(packed, content, used);
  limit_.add(unpacker_->unpackedBytes());
  return good;
}

bool Aedat4Reader::decode(std::size_t stream, std::string_view content, Packet& packet) {
  packet.stream = stream;
  packet.clear();
  if (streams_[stream].type == StreamType::Imu) return aedat::decodeImu(content, packet.imu_samples);
  if (streams_[stream].type == StreamType::Frames) return decodeFrame(stream, content, packet.frames);
  if (!aedat::decodeEvents(content, packet.events)) return false;
  finishEvents(stream, packet);
  return true;
}

bool Aedat4Reader::decodeFrame(std::size_t stream, std::string_view content, std::vector<Frame>& frames) {
  StreamInfo& info = streams_[stream];
  Frame frame;
  std::string unusable;
  if (!aedat::decodeFrame(content, frame, unusable)) return false;
  if (!unusable.empty()) {
    addFault(info.name, FaultKind::Encoding, fmt::format("Frames {}; they are left out.", unusable));
    return true;
  }
  if (!info.resolution_px.known()) info.resolution_px = frame.size_px;
  frames.push_back(std::move(frame));
  return true;
}

void Aedat4Reader::finishEvents(std::size_t stream, Packet& packet) {
  EventOrder& order = states_[stream].order;
  order.split(packet.events, rest_);
  rest_stream_ = stream;
  if (!order.changedAnything()) return;
  const std::string& name = streams_[stream].name;
  const auto known = std::find_if(faults_.begin(), faults_.end(), [&](const RecordingFault& fault) {
    return fault.stream == name && fault.kind == FaultKind::Unsorted;
  });
  if (known == faults_.end()) {
    faults_.push_back({name, FaultKind::Unsorted, 0.0, order.text()});
  } else {
    known->text = order.text();
  }
}

bool Aedat4Reader::handOutRest(Packet& packet) {
  if (rest_.empty()) return false;
  packet.stream = rest_stream_;
  packet.clear();
  std::swap(packet.events, rest_);
  finishEvents(packet.stream, packet);
  return true;
}

// The file may not state the number of triggers.
void Aedat4Reader::countListed(std::size_t stream, std::string_view content) {
  StreamState& state = states_[stream];
  state.elements += aedat::countTriggers(content).value_or(0);
  streams_[stream].messages = state.elements;
}

bool Aedat4Reader::read(Packet& packet) {
  if (handOutRest(packet)) return true;
  PacketHeader header;
  std::string_view content;
  while (nextPacket(header)) {
    const auto found = stream_of_id_.find(header.stream);
    if (found == stream_of_id_.end()) {
      addFault(
          "", FaultKind::Corrupt,
          fmt::format("The packet at byte {} is of stream {}, which the file does not list; it is left out.",
                      header.position, header.stream));
      continue;
    }
    const std::size_t stream = found->second;
    const StreamType type = streams_[stream].type;
    const bool triggers = type == StreamType::Triggers;
    const bool wanted = states_[stream].selected && streams_[stream].readable;
    if (!(wanted || triggers) || !unpack(header, content)) continue;
    if (triggers) {
      countListed(stream, content);
    } else if (!decode(stream, content, packet)) {
      addFault(
          streams_[stream].name, FaultKind::Corrupt,
          fmt::format("The content of the packet at byte {} is damaged; it is left out.", header.position));
    } else if (!packet.empty()) {
      return true;
    }
  }
  packet.clear();
  return false;
}

double Aedat4Reader::fractionRead() const {
  const std::uint64_t end = table_position_ != 0 ? table_position_ : file_.size();
  return std::min(1.0, static_cast<double>(position_) / static_cast<double>(std::max<std::uint64_t>(1, end)));
}

void Aedat4Reader::addFault(const std::string& stream, FaultKind kind, const std::string& text) {
  const auto alike = [&](const RecordingFault& fault) {
    return fault.stream == stream && fault.kind == kind;
  };
  const std::ptrdiff_t most = kind == FaultKind::Encoding ? 1 : kMostAlikeFaults;
  if (std::count_if(faults_.begin(), faults_.end(), alike) < most)
    faults_.push_back({stream, kind, 0.0, text});
}

}  // namespace evical
