#include "core/recording/ros/bag_source.h"

#include "core/recording/byte_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace evical::ros {
namespace {

constexpr std::uint32_t kLargestRecordHeader_bytes = 1 << 20;  // real ones are below 100 bytes

// Packed data are hardly ever longer than unpacked ones.
std::uint64_t largestPacked(std::uint32_t plain_bytes) {
  return std::uint64_t{plain_bytes} + plain_bytes / 64 + 4096;
}

struct BagRecord {
  rosbag::RecordHeader header;
  std::string_view data;
};

// Removes the first record; returns false without doing so if it is damaged.
bool takeBagRecord(std::string_view& records, BagRecord& record) {
  ByteCursor cursor(records);
  const std::string_view header = cursor.sized();
  record.data = cursor.sized();
  if (!cursor.ok() || !rosbag::parseRecordHeader(header, record.header)) return false;
  records.remove_prefix(cursor.position());
  return true;
}

}  // namespace

BagSource::BagSource(const std::filesystem::path& path, FaultSink sink)
    : sink_(std::move(sink)), file_(path), limit_(path.string(), file_.size()) {
  rewind();
  listTopics();
  rewind();
  separatePublishers();
}

void BagSource::rewind() {
  position_ = rosbag::kMagic.size();
  limit_.restart();
  chunk_data_ = 0;
  chunk_ = {};
}

bool BagSource::follow(const std::shared_ptr<Growth>& growth) {
  file_.follow(growth);
  return true;
}

std::string BagSource::place() const {
  return fmt::format("in the chunk at byte {}", chunk_position_);
}

double BagSource::fractionRead() const {
  return std::min(
      1.0, static_cast<double>(position_) / static_cast<double>(std::max<std::uint64_t>(1, file_.size())));
}

void BagSource::listTopics() {
  FileRecord record;
  const bool has_header =
      readRecord(position_, record) == RecordState::Whole && record.header.is(rosbag::Op::BagHeader);
  const rosbag::RecordHeader header = record.header;
  const bool is_empty =
      has_header && header.index_position == record.end() && header.index_position == file_.size();
  if (is_empty) return;
  if (has_header && listFromIndex(header.index_position, header.connection_count, header.chunk_count)) return;
  topic_of_connection_.clear();  // an incomplete index is not used
  chunk_connections_.clear();
  topics_.clear();
  publishers_.clear();
  listByScan();
  const bool never_closed = has_header && header.index_position == 0;
  sink_(FaultKind::NoIndex,
        never_closed
            ? "The bag has no index: its recorder did not close it. It is read from the start."
            : fmt::format("The bag's index is damaged, or cut off at byte {}. It is read from the start.",
                          file_.size()));
}

BagSource::RecordState BagSource::readRecord(std::uint64_t position, FileRecord& record) {
  record = {};
  file_.reaches(position + 4);
  limit_.setFileBytes(file_.size());
  if (position >= file_.size()) return RecordState::End;
  std::string_view bytes;
  if (!file_.read(position, 4, bytes)) return RecordState::Damaged;
  const auto header_size = ByteCursor(bytes).number<std::uint32_t>();
  if (header_size > kLargestRecordHeader_bytes) return RecordState::Damaged;
  file_.reaches(position + 8 + header_size);
  if (!file_.read(position + 4, std::uint64_t{header_size} + 4, bytes)) return RecordState::Damaged;
  header_bytes_ = bytes;  // reading the data changes the file's block
  ByteCursor cursor(header_bytes_);
  if (!rosbag::parseRecordHeader(cursor.take(header_size), record.header)) return RecordState::Damaged;
  record.data_size = cursor.number<std::uint32_t>();
  record.data_position = position + 8 + header_size;
  return file_.reaches(record.end()) ? RecordState::Whole : RecordState::Cut;
}

// Searches for a chunk's header from here on, also within data: packed data do not look like one by chance,
// and chunks contain none. Returns the file's size if there is none.
std::uint64_t BagSource::scanForChunk(std::uint64_t from) {
  static constexpr std::string_view kOp("op=\x05", 4);
  constexpr std::uint64_t kBlock_bytes = 1 << 20;
  constexpr std::uint64_t kFurthestOp_bytes = 128;  // from the record's beginning; real headers have about 60
  std::string block;
  FileRecord record;
  for (std::uint64_t begin = from; begin < file_.size(); begin += kBlock_bytes) {
    const std::uint64_t length = std::min(kBlock_bytes + kFurthestOp_bytes, file_.size() - begin);
    std::string_view bytes;
    if (!file_.read(begin, length, bytes)) break;
    block = bytes;  // checking records reads others
    for (std::size_t hit = block.find(kOp); hit != std::string::npos; hit = block.find(kOp, hit + 1)) {
      const std::uint64_t op = begin + hit;
      for (std::uint64_t at = std::max(from, op - std::min(op, kFurthestOp_bytes)); at < op; ++at) {
        const RecordState state = readRecord(at, record);
        const bool has_header = state == RecordState::Whole || state == RecordState::Cut;
        if (has_header && record.header.is(rosbag::Op::Chunk) && record.data_position > op) return at;
      }
    }
  }
  return file_.size();
}

// Position after a record, whose stated length may be wrong. `chunk_data` is the beginning of the last
// chunk's data: a chunk with a wrong length may hide the next one.
std::uint64_t BagSource::recordAfter(std::uint64_t position, RecordState state, const FileRecord& record,
                                     std::uint64_t& chunk_data) {
  const bool is_chunk = state != RecordState::Damaged && record.header.is(rosbag::Op::Chunk);
  if (is_chunk) chunk_data = record.data_position;
  const bool plausible = !is_chunk || record.data_size <= largestPacked(record.header.size);
  if (state == RecordState::Whole && plausible) return record.end();
  return scanForChunk(chunk_data != 0 ? chunk_data : position + 1);
}

// Unpacks the intact part: a cut chunk up to the cut, and one with a wrong length as far as its
// packed data reach. False if nothing is intact.
bool BagSource::loadChunk(std::uint64_t position, const FileRecord& record) {
  chunk_position_ = position;
  chunk_ = {};
  const std::uint64_t largest = largestPacked(record.header.size);
  const std::uint64_t available =
      record.data_position < file_.size() ? file_.size() - record.data_position : 0;
  const std::uint64_t size = std::min({std::uint64_t{record.data_size}, largest, available});
  std::string_view bytes;
  Unpacked result = Unpacked::Damaged;
  const bool plausible = record.header.size <= UnpackingLimit::ofPart(size);
  if (plausible && file_.read(record.data_position, size, bytes)) {
    const bool is_plain = record.header.compression == "none" && bytes.size() == record.header.size;
    result = is_plain
                 ? Unpacked::Whole
                 : rosbag::decompressChunk(record.header.compression, bytes, record.header.size, unpacked_);
    chunk_ = is_plain ? bytes : std::string_view(unpacked_);
    limit_.add(is_plain ? 0 : record.header.size);
  }
  chunk_size_ = chunk_.size();
  chunk_is_cut_ = result == Unpacked::Cut;
  if (result == Unpacked::Damaged) {
    sink_(FaultKind::Corrupt,
          plausible ? fmt::format("The chunk at byte {} cannot be unpacked; it is left out.", position)
                    : fmt::format("The chunk at byte {} states {} bytes for {} packed ones, which is "
                                  "implausible; it is left out.",
                                  position, record.header.size, size));
  } else if (result == Unpacked::Cut) {
    sink_(FaultKind::Truncated, fmt::format("The chunk at byte {} has {} of {} bytes; these are read.",
                                            position, chunk_size_, record.header.size));
  }
  return !chunk_.empty();
}

// False unless the index exists and is complete.
bool BagSource::listFromIndex(std::uint64_t index_position, std::uint32_t connections, std::uint32_t chunks) {
  if (index_position < position_ || index_position >= file_.size()) return false;
  FileRecord record;
  RecordState state = RecordState::Whole;
  std::uint32_t found_chunks = 0;
  for (std::uint64_t at = index_position; (state = readRecord(at, record)) == RecordState::Whole;
       at = record.end()) {
    std::string_view data;
    if (!file_.read(record.data_position, record.data_size, data)) return false;
    if (record.header.is(rosbag::Op::Connection)) {
      addConnection(record.header, rosbag::parseConnectionData(data));
    } else if (record.header.is(rosbag::Op::ChunkInfo)) {
      addChunkInfo(record.header.chunk_position, data);
      ++found_chunks;
    } else {
      return false;
    }
  }
  return state == RecordState::End && topic_of_connection_.size() == connections && found_chunks == chunks;
}

// Only chunks with new connections are unpacked: the index data after a chunk list them.
void BagSource::listByScan() {
  FileRecord record;
  std::uint64_t chunk = 0, chunk_data = 0;
  bool has_index_data = false, is_new = false;
  const auto finishChunk = [&] {
    if (chunk != 0 && (is_new || !has_index_data)) listFromChunk(chunk);
    chunk = 0;
    has_index_data = is_new = false;
  };
  RecordState state = RecordState::End;
  for (std::uint64_t at = position_, next = 0;; at = next) {
    state = readRecord(at, record);
    if (state == RecordState::End) break;
    const bool has_header = state == RecordState::Whole || state == RecordState::Cut;
    const bool is_chunk = has_header && record.header.is(rosbag::Op::Chunk);
    const bool is_index_data = has_header && record.header.is(rosbag::Op::IndexData);
    const std::uint32_t connection = record.header.connection;
    next = recordAfter(at, state, record, chunk_data);
    if (state == RecordState::Damaged || state == RecordState::Cut)
      has_index_data = false;  // some may be missing
    if (is_index_data) {
      has_index_data = state == RecordState::Whole;
      is_new = is_new || !topic_of_connection_.contains(connection);
      continue;
    }
    finishChunk();
    if (is_chunk) chunk = at;
  }
  finishChunk();
}

void BagSource::listFromChunk(std::uint64_t position) {
  FileRecord record;
  const RecordState state = readRecord(position, record);
  const bool usable = state == RecordState::Whole || state == RecordState::Cut;
  if (!usable || !record.header.is(rosbag::Op::Chunk)) return;
  const FaultSink sink = std::exchange(sink_, [](FaultKind, const std::string&) {});
  loadChunk(position, record);  // its damage is reported on reading
  sink_ = sink;
  BagRecord part;
  while (!chunk_.empty() && takeBagRecord(chunk_, part)) {
    if (part.header.is(rosbag::Op::Connection))
      addConnection(part.header, rosbag::parseConnectionData(part.data));
  }
  chunk_ = {};
}

// A topic of a sensor with messages of several nodes in turn is several topics. Nodes that follow each other,
// as after a restart, are one publisher.
void BagSource::separatePublishers() {
  constexpr int kMaxMessages = 20'000, kEnoughTurns = 4;
  std::map<std::string, std::set<std::string>> nodes;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    const Topic& topic = topics_[i].topic;
    const bool read = contentOf(topic.type, topic.md5, topic.definition) != Content::Other;
    if (read) nodes[topic.name + ' ' + topic.type].insert(publishers_[i]);
  }
  std::erase_if(nodes, [](const auto& of_topic) { return of_topic.second.size() < 2; });
  if (nodes.empty()) return;
  const auto keyOf = [&](std::size_t i) { return topics_[i].topic.name + ' ' + topics_[i].topic.type; };
  wanted_.assign(topics_.size(), false);
  for (std::size_t i = 0; i < topics_.size(); ++i) wanted_[i] = nodes.contains(keyOf(i));
  const FaultSink sink = std::exchange(sink_, [](FaultKind, const std::string&) {});
  std::map<std::string, std::pair<std::string, int>> turns;
  SourceMessage message;
  for (int k = 0; k < kMaxMessages && next(message); ++k) {
    auto& [last, count] = turns[keyOf(message.topic)];
    if (publishers_[message.topic] != last) ++count;
    last = publishers_[message.topic];
  }
  sink_ = sink;
  for (std::size_t i = 0; i < topics_.size(); ++i)
    if (nodes.contains(keyOf(i)) && turns[keyOf(i)].second >= kEnoughTurns)
      topics_[i].topic.publisher = publishers_[i];
  wanted_.clear();
  rewind();
}

// The record's header has the topic under which messages were stored. The data are the header of the
// publisher's connection, which may have another name, or none if a program wrote the bag itself.
void BagSource::addConnection(const rosbag::RecordHeader& header, const rosbag::ConnectionData& data) {
  if (topic_of_connection_.contains(header.connection)) return;
  topic_of_connection_[header.connection] = topics_.size();
  const std::string_view topic = header.topic.empty() ? data.topic : header.topic;
  topics_.push_back({{std::string(topic), std::string(data.type), std::string(data.md5),
                      std::string(data.definition), Serialization::Ros1},
                     0});
  publishers_.emplace_back(data.publisher.empty() ? fmt::format("connection {}", header.connection)
                                                  : std::string(data.publisher));
}

// u32 connection, u32 messages, ...
void BagSource::addChunkInfo(std::uint64_t chunk, std::string_view counts) {
  ByteCursor cursor(counts);
  while (!cursor.atEnd()) {
    const auto id = cursor.number<std::uint32_t>(), count = cursor.number<std::uint32_t>();
    if (!cursor.ok()) return;
    chunk_connections_[chunk].push_back(id);
    const auto found = topic_of_connection_.find(id);
    if (found != topic_of_connection_.end()) topics_[found->second].messages += count;
  }
}

bool BagSource::wanted(std::uint32_t connection) const {
  const auto found = topic_of_connection_.find(connection);
  if (found == topic_of_connection_.end()) return false;
  return found->second >= wanted_.size() || wanted_[found->second];
}

bool BagSource::chunkIsWanted(std::uint64_t position) const {
  const auto found = chunk_connections_.find(position);
  if (found == chunk_connections_.end()) return true;
  return std::any_of(found->second.begin(), found->second.end(),
                     [this](std::uint32_t id) { return wanted(id); });
}

// 0 if the index has none.
std::uint64_t BagSource::indexedChunkAfter(std::uint64_t position) const {
  const auto found = chunk_connections_.upper_bound(position);
  return found == chunk_connections_.end() ? 0 : found->first;
}

// From one chunk to the next, while the index has both.
void BagSource::skipUnwantedChunks() {
  while (!chunkIsWanted(position_)) {
    const std::uint64_t following = indexedChunkAfter(position_);
    if (following == 0) return;
    position_ = following;
  }
}

// If a record is damaged, or longer than possible, the index or a search gives the next position.
bool BagSource::nextChunk() {
  FileRecord record;
  for (;;) {
    skipUnwantedChunks();
    const std::uint64_t at = position_;
    const RecordState state = readRecord(at, record);
    if (state == RecordState::End) return false;
    const std::uint64_t indexed = indexedChunkAfter(at), end = record.end();
    const bool fits = state == RecordState::Whole && end <= indexed;
    position_ = indexed == 0 ? recordAfter(at, state, record, chunk_data_) : fits ? end : indexed;
    if (state != RecordState::Whole || position_ != end) {
      reportDamage(at, state);
      readRecord(at, record);  // the search read others
    }
    const bool is_chunk = state != RecordState::Damaged && record.header.is(rosbag::Op::Chunk);
    if (is_chunk && chunkIsWanted(at) && loadChunk(at, record)) return true;
  }
}

void BagSource::reportDamage(std::uint64_t position, RecordState state) {
  const bool last = position_ == file_.size();
  const std::uint64_t lost = std::max(position, position_) - position;
  sink_(state == RecordState::Cut && last ? FaultKind::Truncated : FaultKind::Corrupt,
        fmt::format("The record at byte {} of {} {}; {}.", position, file_.size(),
                    state == RecordState::Damaged ? fmt::format("is damaged, {} bytes are lost", lost)
                                                  : "is cut off or has a false length",
                    last ? "nothing after it is read"
                         : fmt::format("reading continues with the chunk at byte {}", position_)));
}

bool BagSource::nextOfChunk(SourceMessage& message) {
  BagRecord record;
  while (!chunk_.empty()) {
    const std::size_t at = chunk_size_ - chunk_.size();
    if (!takeBagRecord(chunk_, record)) {
      if (!chunk_is_cut_)
        sink_(FaultKind::Corrupt,
              fmt::format("The chunk at byte {} is damaged from its byte {}; the rest is left out.",
                          chunk_position_, at));
      chunk_ = {};
      return false;
    }
    if (!record.header.is(rosbag::Op::Message) || !wanted(record.header.connection)) continue;
    message = {topic_of_connection_.at(record.header.connection), record.header.time_ns, record.data};
    return true;
  }
  return false;
}

bool BagSource::next(SourceMessage& message) {
  do {
    if (nextOfChunk(message)) return true;
  } while (nextChunk());
  return false;
}

}  // namespace evical::ros
