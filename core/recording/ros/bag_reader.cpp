#include "core/recording/ros/bag_reader.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/recording/byte_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <set>
#include <system_error>
#include <utility>

namespace evical {
namespace {

constexpr std::uint32_t kLargestHeader_bytes = 1 << 20;  // real ones have below 100 bytes

// Packed data are hardly ever longer than the plain ones.
std::uint64_t largestPacked(std::uint32_t plain_bytes) {
  return std::uint64_t{plain_bytes} + plain_bytes / 64 + 4096;
}

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

// Those that `rosbag record --split` made before and behind this one: "a_3.bag" for "a_2.bag". Their names
// may also hold the time at which they were begun, which differs: "a_2024-05-06-07-08-09_2.bag". They count
// from 0: without that one these are recordings that somebody numbered.
std::vector<std::string> otherParts(const std::filesystem::path& path) {
  constexpr const char* kNumbered = R"((.*?)(_\d{4}(?:-\d{2}){5})?_(\d{1,6})\.bag)";
  const std::regex numbered(kNumbered);
  std::smatch own, other;
  const std::string name = path.filename().string();
  std::vector<std::string> parts;
  if (!std::regex_match(name, own, numbered)) return parts;
  const int number = std::stoi(own[3]);
  bool has_first = number == 0;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(path.parent_path() / ".", error)) {
    const std::string candidate = entry.path().filename().string();
    if (!std::regex_match(candidate, other, numbered)) continue;
    const bool same = own[1] == other[1] && own[2].matched == other[2].matched;
    if (!same) continue;
    const int its_number = std::stoi(other[3]);
    has_first = has_first || its_number == 0;
    if (std::abs(its_number - number) == 1) parts.push_back(candidate);
  }
  if (!has_first) return {};
  std::sort(parts.begin(), parts.end());
  return parts;
}

}  // namespace

BagReader::BagReader(const std::filesystem::path& path)
    : path_(path.string()), file_(path, std::ios::binary | std::ios::ate) {
  if (!file_) throw badInput(path_, "the file cannot be opened", "Check its permissions");
  file_size_ = static_cast<std::uint64_t>(file_.tellg());
  position_ = rosbag::kMagic.size();
  listStreams();
  lookIntoFirstMessages();
  topics_.finishLooking();
  const std::vector<std::string> parts = otherParts(path);
  if (parts.empty()) return;
  addFault(FaultKind::Part,
           fmt::format("The name is that of a part of a recording that was split: {} {} beside it. Only "
                       "this part is read.",
                       joined(parts), parts.size() == 1 ? "lies" : "lie"));
}

void BagReader::listStreams() {
  FileRecord record;
  const bool has_header =
      readRecord(position_, record) == RecordState::Whole && record.header.is(rosbag::Op::BagHeader);
  const rosbag::RecordHeader header = record.header;
  const bool is_empty =
      has_header && header.index_position == record.end() && header.index_position == file_size_;
  if (is_empty) return;
  if (has_header && listFromIndex(header.index_position, header.connection_count, header.chunk_count)) return;
  connections_.clear();  // an index that is not whole is none
  chunk_connections_.clear();
  topics_.clear();
  listByScan();
  const bool never_closed = has_header && header.index_position == 0;
  addFault(FaultKind::NoIndex,
           never_closed
               ? "The bag has no index: its recorder did not close it. It is read from the start."
               : fmt::format("The bag's index is damaged, or cut off at byte {}. It is read from the start.",
                             file_size_));
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
  return record.end() <= file_size_ ? RecordState::Whole : RecordState::Cut;
}

// A chunk's header somewhere from here on, also within data: packed data don't look like one by chance, and
// chunks hold none. The file's size where there is none.
std::uint64_t BagReader::scanForChunk(std::uint64_t from) {
  static constexpr std::string_view kOp("op=\x05", 4);
  constexpr std::uint64_t kBlock_bytes = 1 << 20;
  constexpr std::uint64_t kFurthestOp_bytes = 128;  // from the record's beginning; real headers have about 60
  std::string block;
  FileRecord record;
  for (std::uint64_t begin = from; begin < file_size_; begin += kBlock_bytes) {
    const std::uint64_t length = std::min(kBlock_bytes + kFurthestOp_bytes, file_size_ - begin);
    if (!readBytes(begin, length, block)) break;
    for (std::size_t hit = block.find(kOp); hit != std::string::npos; hit = block.find(kOp, hit + 1)) {
      const std::uint64_t op = begin + hit;
      for (std::uint64_t at = std::max(from, op - std::min(op, kFurthestOp_bytes)); at < op; ++at) {
        const RecordState state = readRecord(at, record);
        const bool has_header = state == RecordState::Whole || state == RecordState::Cut;
        if (has_header && record.header.is(rosbag::Op::Chunk) && record.data_position > op) return at;
      }
    }
  }
  return file_size_;
}

// Where the file goes on behind a record, whatever its length says. `chunk_data` is where those of the last
// chunk begin: a chunk with a false length may hide the next one.
std::uint64_t BagReader::recordAfter(std::uint64_t position, RecordState state, const FileRecord& record,
                                     std::uint64_t& chunk_data) {
  const bool is_chunk = state != RecordState::Damaged && record.header.is(rosbag::Op::Chunk);
  if (is_chunk) chunk_data = record.data_position;
  const bool plausible = !is_chunk || record.data_size <= largestPacked(record.header.size);
  if (state == RecordState::Whole && plausible) return record.end();
  return scanForChunk(chunk_data != 0 ? chunk_data : position + 1);
}

// What can be unpacked of it: a cut chunk is read up to the cut, and one whose length lies as far as its
// packed data can go.
void BagReader::loadChunk(std::uint64_t position, const FileRecord& record) {
  chunk_position_ = position;
  chunk_offset_ = 0;
  chunk_.clear();
  const std::uint64_t largest = largestPacked(record.header.size);
  const std::uint64_t available = record.data_position < file_size_ ? file_size_ - record.data_position : 0;
  const std::uint64_t size = std::min({std::uint64_t{record.data_size}, largest, available});
  const bool read = readBytes(record.data_position, size, file_bytes_);
  const ros::Unpacked result =
      read ? rosbag::decompressChunk(record.header.compression, file_bytes_, record.header.size, chunk_)
           : ros::Unpacked::Damaged;
  if (result == ros::Unpacked::Damaged) {
    addFault(FaultKind::Corrupt,
             fmt::format("The chunk at byte {} cannot be unpacked; it is left out.", position));
  } else if (result == ros::Unpacked::Cut) {
    addFault(FaultKind::Truncated, fmt::format("The chunk at byte {} holds {} of {} bytes; these are read.",
                                               position, chunk_.size(), record.header.size));
  }
}

// False unless the index is there and complete.
bool BagReader::listFromIndex(std::uint64_t index_position, std::uint32_t connections, std::uint32_t chunks) {
  if (index_position < position_ || index_position >= file_size_) return false;
  FileRecord record;
  RecordState state = RecordState::Whole;
  std::uint32_t found_chunks = 0;
  for (std::uint64_t at = index_position; (state = readRecord(at, record)) == RecordState::Whole;
       at = record.end()) {
    if (record.header.is(rosbag::Op::Connection)) {
      if (!readBytes(record.data_position, record.data_size, file_bytes_)) return false;
      addConnection(record.header.connection, rosbag::parseConnectionData(file_bytes_));
    } else if (record.header.is(rosbag::Op::ChunkInfo)) {
      addChunkInfo(record);
      ++found_chunks;
    } else {
      return false;
    }
  }
  return state == RecordState::End && connections_.size() == connections && found_chunks == chunks;
}

// Only chunks with connections not met before need to be unpacked: the index data behind a chunk tell.
void BagReader::listByScan() {
  FileRecord record;
  std::uint64_t chunk = 0, chunk_data = 0;
  bool has_index_data = false, is_new = false;
  const auto finishChunk = [&] {
    if (chunk != 0 && (is_new || !has_index_data)) lookIntoChunk(chunk);
    chunk = 0;
    has_index_data = is_new = false;
  };
  RecordState state = RecordState::End;
  for (std::uint64_t at = position_, next = 0;; at = next) {
    state = readRecord(at, record);
    if (state == RecordState::End) break;
    const FileRecord found = record;  // looking on, and into a chunk, reads others
    next = recordAfter(at, state, found, chunk_data);
    if (state == RecordState::Damaged || state == RecordState::Cut)
      has_index_data = false;  // some may be lost
    const bool has_header = state == RecordState::Whole || state == RecordState::Cut;
    if (has_header && found.header.is(rosbag::Op::IndexData)) {
      has_index_data = state == RecordState::Whole;
      is_new = is_new || !connections_.contains(found.header.connection);
      continue;
    }
    finishChunk();
    if (has_header && found.header.is(rosbag::Op::Chunk)) chunk = at;
  }
  finishChunk();
}

void BagReader::addConnection(std::uint32_t id, const rosbag::ConnectionData& data) {
  if (connections_.contains(id)) return;
  connections_[id].stream =
      topics_.add({std::string(data.topic), std::string(data.type), std::string(data.md5),
                   std::string(data.definition), ros::Serialization::Ros1});
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
    topics_.countMessages(connection.stream, count);
    if (connection.first_chunk == 0 || chunk < connection.first_chunk) connection.first_chunk = chunk;
  }
}

void BagReader::lookIntoChunk(std::uint64_t position) {
  FileRecord record;
  const RecordState state = readRecord(position, record);
  const bool usable = state == RecordState::Whole || state == RecordState::Cut;
  if (!usable || !record.header.is(rosbag::Op::Chunk)) return;
  const std::size_t faults = topics_.faults().size();
  loadChunk(position, record);
  topics_.dropFaultsFrom(faults);  // reading will find them again
  ChunkRecord part;
  while (chunk_offset_ < chunk_.size() && takeRecord(chunk_, chunk_offset_, part)) {
    if (part.header.is(rosbag::Op::Connection))
      addConnection(part.header.connection, rosbag::parseConnectionData(part.data));
    const auto found = connections_.find(part.header.connection);
    if (!part.header.is(rosbag::Op::Message) || found == connections_.end()) continue;
    Connection& connection = found->second;
    if (connection.first_chunk == 0) connection.first_chunk = position;
    if (connection.first_chunk == position) topics_.lookInto(connection.stream, part.data);
  }
  chunk_.clear();
  chunk_offset_ = 0;
}

void BagReader::lookIntoFirstMessages() {
  std::set<std::uint64_t> chunks;
  for (const auto& [id, connection] : connections_) {
    if (connection.first_chunk != 0 && !topics_.hasBeenLookedInto(connection.stream) &&
        !topics_.knows(connection.stream))
      chunks.insert(connection.first_chunk);
  }
  for (const std::uint64_t chunk : chunks) lookIntoChunk(chunk);
}

bool BagReader::wanted(std::uint32_t connection) const {
  const auto found = connections_.find(connection);
  return found != connections_.end() && topics_.selected(found->second.stream);
}

bool BagReader::chunkIsWanted(std::uint64_t position) const {
  const auto found = chunk_connections_.find(position);
  if (found == chunk_connections_.end()) return true;
  return std::any_of(found->second.begin(), found->second.end(),
                     [this](std::uint32_t id) { return wanted(id); });
}

// 0 where the index knows none.
std::uint64_t BagReader::indexedChunkAfter(std::uint64_t position) const {
  const auto found = chunk_connections_.upper_bound(position);
  return found == chunk_connections_.end() ? 0 : found->first;
}

// Where a record is damaged, or longer than it can be, the index tells where to go on, or a search.
bool BagReader::nextChunk() {
  FileRecord record;
  for (;;) {
    const std::uint64_t at = position_;
    const RecordState state = readRecord(at, record);
    if (state == RecordState::End) return false;
    const std::uint64_t indexed = indexedChunkAfter(at), end = record.end();
    const bool fits = state == RecordState::Whole && end <= indexed;
    position_ = indexed == 0 ? recordAfter(at, state, record, chunk_data_) : fits ? end : indexed;
    if (state != RecordState::Whole || position_ != end) {
      reportDamage(at, state);
      readRecord(at, record);  // the search has read others
    }
    const bool is_chunk = state != RecordState::Damaged && record.header.is(rosbag::Op::Chunk);
    if (!is_chunk || !chunkIsWanted(at)) continue;
    loadChunk(at, record);
    if (!chunk_.empty()) return true;
  }
}

void BagReader::reportDamage(std::uint64_t position, RecordState state) {
  const bool last = position_ == file_size_;
  const std::uint64_t lost = std::max(position, position_) - position;
  addFault(state == RecordState::Cut && last ? FaultKind::Truncated : FaultKind::Corrupt,
           fmt::format("The record at byte {} of {} {}; {}.", position, file_size_,
                       state == RecordState::Damaged ? fmt::format("is damaged, {} bytes are lost", lost)
                                                     : "is cut off or has a false length",
                       last ? "nothing behind it is read"
                            : fmt::format("reading goes on with the chunk at byte {}", position_)));
}

bool BagReader::nextMessage(Packet& packet) {
  ChunkRecord record;
  while (chunk_offset_ < chunk_.size()) {
    const std::size_t offset = chunk_offset_;
    if (!takeRecord(chunk_, chunk_offset_, record)) {
      addFault(FaultKind::Corrupt,
               fmt::format("The chunk at byte {} is damaged from its byte {} on; the rest is left out.",
                           chunk_position_, offset));
      chunk_.clear();
      return false;
    }
    if (!record.header.is(rosbag::Op::Message) || !wanted(record.header.connection)) continue;
    const std::size_t stream = connections_.at(record.header.connection).stream;
    const std::string place = fmt::format("in the chunk at byte {}", chunk_position_);
    if (topics_.decode(stream, record.data, record.header.time_ns, place, packet)) return true;
  }
  return false;
}

bool BagReader::read(Packet& packet) {
  if (topics_.handOutRest(packet)) return true;
  do {
    if (nextMessage(packet)) return true;
  } while (nextChunk());
  topics_.finishReading();
  packet.events.clear();
  packet.imu_samples.clear();
  return false;
}

double BagReader::fractionRead() const {
  return std::min(
      1.0, static_cast<double>(position_) / static_cast<double>(std::max<std::uint64_t>(1, file_size_)));
}

}  // namespace evical
