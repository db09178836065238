#include "core/recording/bag_reader.h"

#include "core/base/error.h"
#include "core/recording/byte_cursor.h"
#include "core/recording/ros_messages.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical {
namespace {

constexpr std::uint32_t kLargestHeader_bytes = 1 << 20;  // real ones have below 100 bytes
constexpr int kMostAlikeFaults = 10;  // of one kind and stream; a broken file has thousands

struct ChunkRecord {
  rosbag::RecordHeader header;
  std::string_view data;
};

// Takes the record at `offset` and moves on; false if it is damaged.
bool takeRecord(const std::string& chunk, std::size_t& offset, ChunkRecord& record) {
  ByteCursor cursor(std::string_view(chunk).substr(offset));
  const std::string_view header = cursor.sized();
  record.data = cursor.sized();
  if (!cursor.ok() || !rosbag::parseRecordHeader(header, record.header)) return false;
  offset += cursor.position();
  return true;
}

}  // namespace

BagReader::BagReader(const std::filesystem::path& path)
    : path_(path.string()), file_(path, std::ios::binary | std::ios::ate) {
  if (!file_) throw badInput(path_, "the file cannot be opened", "Check its permissions.");
  file_size_ = static_cast<std::uint64_t>(file_.tellg());
  position_ = rosbag::kMagic.size();
  FileRecord record;
  const bool has_header =
      readRecord(position_, record) == RecordState::Whole && record.header.is(rosbag::Op::BagHeader);
  const std::uint32_t chunks = record.header.chunk_count;
  const bool has_index =
      has_header && listFromIndex(record.header.index_position) && chunk_connections_.size() >= chunks;
  if (connections_.empty()) {
    listByScan();
    if (!has_index) {
      addFault("", "no_index",
               "The bag has no usable index: its recorder did not close it. It is read from the start.");
    }
  }
  findResolutions();
  selected_.resize(streams_.size());
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    selected_[i] = streams_[i].type == StreamType::Events || streams_[i].type == StreamType::Imu;
  }
}

void BagReader::select(const std::vector<std::size_t>& streams) {
  selected_.assign(streams_.size(), false);
  for (const std::size_t stream : streams) selected_.at(stream) = true;
}

bool BagReader::readBytes(std::uint64_t position, std::uint64_t count, std::string& bytes) {
  if (position > file_size_ || count > file_size_ - position) return false;
  bytes.resize(static_cast<std::size_t>(count));
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(position));
  file_.read(bytes.data(), static_cast<std::streamsize>(count));
  return static_cast<std::uint64_t>(file_.gcount()) == count;
}

BagReader::RecordState BagReader::readRecord(std::uint64_t position, FileRecord& record) {
  record = {};
  if (position >= file_size_) return RecordState::End;
  if (!readBytes(position, 4, header_bytes_)) return RecordState::Damaged;
  const auto header_size = ByteCursor(header_bytes_).number<std::uint32_t>();
  if (header_size > kLargestHeader_bytes) return RecordState::Damaged;
  if (!readBytes(position + 4, std::uint64_t{header_size} + 4, header_bytes_)) return RecordState::Damaged;
  ByteCursor cursor(header_bytes_);
  if (!rosbag::parseRecordHeader(cursor.take(header_size), record.header)) return RecordState::Damaged;
  record.data_size = cursor.number<std::uint32_t>();
  record.data_position = position + 8 + header_size;
  return record.data_size <= file_size_ - record.data_position ? RecordState::Whole : RecordState::Damaged;
}

bool BagReader::loadChunk(const FileRecord& record) {
  chunk_offset_ = 0;
  if (readBytes(record.data_position, record.data_size, file_bytes_) &&
      rosbag::decompressChunk(record.header.compression, file_bytes_, record.header.size, chunk_)) {
    return true;
  }
  chunk_.clear();
  return false;
}

bool BagReader::listFromIndex(std::uint64_t index_position) {
  if (index_position < position_) return false;
  FileRecord record;
  RecordState state = RecordState::Whole;
  for (std::uint64_t at = index_position; (state = readRecord(at, record)) == RecordState::Whole;
       at = record.end()) {
    if (record.header.is(rosbag::Op::Connection)) {
      if (!readBytes(record.data_position, record.data_size, file_bytes_)) break;
      addConnection(record.header.connection, rosbag::parseConnectionData(file_bytes_));
    } else if (record.header.is(rosbag::Op::ChunkInfo)) {
      addChunkInfo(record);
    } else {
      break;
    }
  }
  if (state == RecordState::End && index_position < file_size_) return true;
  connections_.clear();  // an index that is not whole is none
  chunk_connections_.clear();
  streams_.clear();
  return false;
}

// Only chunks with connections not met before need to be unpacked: the index data behind a chunk tell.
void BagReader::listByScan() {
  FileRecord record;
  std::uint64_t chunk = 0;
  bool has_index_data = false, is_new = false;
  const auto finishChunk = [&] {
    if (chunk != 0 && (is_new || !has_index_data)) lookIntoChunk(chunk);
    chunk = 0;
    has_index_data = is_new = false;
  };
  for (std::uint64_t at = position_; readRecord(at, record) == RecordState::Whole;) {
    const std::uint64_t next = record.end();
    if (record.header.is(rosbag::Op::IndexData)) {
      has_index_data = true;
      is_new = is_new || !connections_.contains(record.header.connection);
    } else {
      const bool is_chunk = record.header.is(rosbag::Op::Chunk);
      finishChunk();
      if (is_chunk) chunk = at;
    }
    at = next;
  }
  finishChunk();
}

void BagReader::addConnection(std::uint32_t id, const rosbag::ConnectionData& data) {
  if (connections_.contains(id)) return;
  const auto same = [&](const StreamInfo& stream) {
    return stream.name == data.topic && stream.message == data.type;
  };
  const auto found = std::find_if(streams_.begin(), streams_.end(), same);
  connections_[id].stream = static_cast<std::size_t>(found - streams_.begin());
  if (found != streams_.end()) return;
  StreamInfo stream;
  stream.name = data.topic;
  stream.message = data.type;
  stream.type = ros::streamTypeOf(data.type, data.md5);
  streams_.push_back(stream);
}

void BagReader::addChunkInfo(const FileRecord& record) {
  const std::uint64_t chunk = record.header.chunk_position;
  if (!readBytes(record.data_position, record.data_size, file_bytes_)) return;
  ByteCursor cursor(file_bytes_);
  while (!cursor.atEnd()) {
    const auto id = cursor.number<std::uint32_t>(), count = cursor.number<std::uint32_t>();
    if (!cursor.ok()) return;
    chunk_connections_[chunk].push_back(id);
    const auto found = connections_.find(id);
    if (found == connections_.end()) continue;
    Connection& connection = found->second;
    streams_[connection.stream].messages += count;
    if (connection.first_chunk == 0 || chunk < connection.first_chunk) connection.first_chunk = chunk;
  }
}

void BagReader::lookIntoChunk(std::uint64_t position) {
  FileRecord record;
  if (readRecord(position, record) != RecordState::Whole || !record.header.is(rosbag::Op::Chunk)) return;
  loadChunk(record);
  std::vector<Event> events;
  ChunkRecord part;
  while (chunk_offset_ < chunk_.size() && takeRecord(chunk_, chunk_offset_, part)) {
    if (part.header.is(rosbag::Op::Connection)) {
      addConnection(part.header.connection, rosbag::parseConnectionData(part.data));
    }
    const auto found = connections_.find(part.header.connection);
    if (!part.header.is(rosbag::Op::Message) || found == connections_.end()) continue;
    StreamInfo& stream = streams_[found->second.stream];
    if (stream.type != StreamType::Events || stream.resolution_px.known()) continue;
    bool stampless = false;
    ros::decodeEventArray(part.data, 0, events, stream.resolution_px, &stampless);
  }
  chunk_.clear();
  chunk_offset_ = 0;
}

void BagReader::findResolutions() {
  for (const auto& [id, connection] : connections_) {
    const StreamInfo& stream = streams_[connection.stream];
    const bool missing = stream.type == StreamType::Events && !stream.resolution_px.known();
    if (missing && connection.first_chunk != 0) lookIntoChunk(connection.first_chunk);
  }
}

bool BagReader::wanted(std::uint32_t connection) const {
  const auto found = connections_.find(connection);
  return found != connections_.end() && selected_[found->second.stream];
}

bool BagReader::chunkIsWanted(std::uint64_t position) const {
  const auto found = chunk_connections_.find(position);
  if (found == chunk_connections_.end()) return true;
  return std::any_of(found->second.begin(), found->second.end(),
                     [this](std::uint32_t id) { return wanted(id); });
}

bool BagReader::nextChunk() {
  FileRecord record;
  RecordState state = RecordState::Whole;
  while ((state = readRecord(position_, record)) == RecordState::Whole) {
    chunk_position_ = position_;
    position_ = record.end();
    if (!record.header.is(rosbag::Op::Chunk) || !chunkIsWanted(chunk_position_)) continue;
    if (loadChunk(record)) return true;
    addFault("", "corrupt",
             fmt::format("The chunk at byte {} cannot be unpacked; it is left out.", chunk_position_));
  }
  if (state == RecordState::Damaged) {
    addFault("", "truncated",
             fmt::format("The record at byte {} of {} is cut off or damaged; nothing behind it is read.",
                         position_, file_size_));
    position_ = file_size_;
    // Whole messages may lie before the cut, where the chunk is not packed.
    if (record.header.is(rosbag::Op::Chunk) && record.header.compression == "none") {
      chunk_offset_ = 0;
      return readBytes(record.data_position, file_size_ - record.data_position, chunk_);
    }
  }
  return false;
}

bool BagReader::nextMessage(Packet& packet) {
  ChunkRecord record;
  while (chunk_offset_ < chunk_.size()) {
    const std::size_t offset = chunk_offset_;
    if (!takeRecord(chunk_, chunk_offset_, record)) {
      addFault("", "corrupt",
               fmt::format("The chunk at byte {} is damaged from its byte {} on; the rest is left out.",
                           chunk_position_, offset));
      chunk_.clear();
      return false;
    }
    if (!record.header.is(rosbag::Op::Message) || !wanted(record.header.connection)) continue;
    const std::size_t stream = connections_.at(record.header.connection).stream;
    if (decode(record.header, record.data, stream, packet)) return true;
  }
  return false;
}

bool BagReader::decode(const rosbag::RecordHeader& header, std::string_view message, std::size_t stream,
                       Packet& packet) {
  StreamInfo& info = streams_[stream];
  packet.stream = stream;
  bool stampless = false, whole = true, ordered = true;
  if (info.type == StreamType::Events) {
    packet.imu_samples.clear();
    whole = ros::decodeEventArray(message, header.time_ns, packet.events, info.resolution_px, &stampless);
    const auto earlier = [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; };
    ordered = std::is_sorted(packet.events.begin(), packet.events.end(), earlier);
    if (!ordered) std::stable_sort(packet.events.begin(), packet.events.end(), earlier);
  } else if (info.type == StreamType::Imu) {
    packet.events.clear();
    whole = ros::decodeImu(message, header.time_ns, packet.imu_samples, &stampless);
  } else {
    return false;
  }
  if (!whole) {
    addFault(info.name, "corrupt",
             fmt::format("A message in the chunk at byte {} is damaged; it is left out.", chunk_position_));
  }
  if (!ordered)
    addFault(info.name, "unsorted", "Events within a message are out of order; they were sorted.");
  if (stampless)
    addFault(info.name, "no_stamps", "Stamps are 0; the times of recording are used, which jitter by ms.");
  return !packet.events.empty() || !packet.imu_samples.empty();
}

bool BagReader::read(Packet& packet) {
  do {
    if (nextMessage(packet)) return true;
  } while (nextChunk());
  packet.events.clear();
  packet.imu_samples.clear();
  return false;
}

double BagReader::fractionRead() const {
  return std::min(
      1.0, static_cast<double>(position_) / static_cast<double>(std::max<std::uint64_t>(1, file_size_)));
}

void BagReader::addFault(const std::string& stream, const std::string& kind, const std::string& text) {
  const int limit = kind == "corrupt" ? kMostAlikeFaults : 1;
  const auto alike = [&](const RecordingFault& fault) {
    return fault.stream == stream && fault.kind == kind;
  };
  if (std::count_if(faults_.begin(), faults_.end(), alike) < limit)
    faults_.push_back({stream, kind, 0.0, text});
}

}  // namespace evical
