#include "core/recording/ros/mcap_source.h"

#include "core/base/error.h"
#include "core/recording/byte_cursor.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <utility>

namespace evical::ros {
namespace {

struct McapRecord {
  std::uint8_t op = 0;
  std::string_view content;
  bool is(mcap::Op other) const { return op == static_cast<std::uint8_t>(other); }
};

// Removes the first record; returns false without doing so if it is damaged.
bool takeMcapRecord(std::string_view& records, McapRecord& record) {
  ByteCursor cursor(records);
  record.op = cursor.number<std::uint8_t>();
  record.content = cursor.take(cursor.number<std::uint64_t>());
  if (!cursor.ok() || record.op == 0) return false;
  records.remove_prefix(cursor.position());
  return true;
}

bool isKnown(std::uint8_t op) {
  constexpr std::uint8_t kFirstPrivate = 0x80;
  return (op != 0 && op <= static_cast<std::uint8_t>(mcap::Op::DataEnd)) || op >= kFirstPrivate;
}

}  // namespace

McapSource::McapSource(const std::filesystem::path& path, FaultSink sink)
    : path_(path.string()), sink_(std::move(sink)), file_(path), limit_(path_, file_.size()) {
  std::string_view magic;
  if (!file_.read(0, mcap::kMagic.size(), magic) || magic != mcap::kMagic)
    throw badInput(path.string(), "the MCAP file is cut off within its first bytes", "Copy it again");
  rewind();
  if (!listFromSummary()) {
    topics_.clear();
    schemas_.clear();
    topic_of_channel_.clear();
    chunk_channels_.clear();
    without_schema_.clear();
    listByScan();
  }
  for (const std::string& topic : without_schema_)
    sink_(FaultKind::Corrupt,
          fmt::format("The schema of the topic {} is missing; its messages cannot be read.", topic));
}

void McapSource::rewind() {
  limit_.restart();
  goToBegin();
}

void McapSource::goToBegin() {
  position_ = record_position_ = mcap::kMagic.size();
  chunk_ = {};
  unknown_channels_.clear();
  ended_ = false;
}

bool McapSource::follow(const std::shared_ptr<Growth>& growth) {
  file_.follow(growth);
  return true;
}

std::string McapSource::place() const {
  return fmt::format("in the record at byte {}", record_position_);
}

double McapSource::fractionRead() const {
  return std::min(1.0, static_cast<double>(position_) / static_cast<double>(file_.size()));
}

bool McapSource::readHead(std::uint64_t position, Record& record) {
  std::string_view bytes;
  if (!file_.read(position, mcap::kRecordHead_bytes, bytes)) return false;
  ByteCursor cursor(bytes);
  record.op = cursor.number<std::uint8_t>();
  record.size = cursor.number<std::uint64_t>();
  record.position = position;
  record.content = position + mcap::kRecordHead_bytes;
  return true;
}

// False if the file ends too early.
bool McapSource::readContent(const Record& record, std::string_view& content) {
  return file_.read(record.content, record.size, content);
}

// False unless the summary exists and names all channels.
bool McapSource::listFromSummary() {
  const std::uint64_t tail = mcap::kFooter_bytes + mcap::kMagic.size();
  Record record;
  std::string_view bytes;
  closed_ = file_.size() >= mcap::kMagic.size() + tail && file_.read(file_.size() - 8, 8, bytes) &&
            bytes == mcap::kMagic && readHead(file_.size() - tail, record) && record.is(mcap::Op::Footer) &&
            readContent(record, bytes);
  if (!closed_) {
    sink_(FaultKind::NoIndex,
          fmt::format("The end of the file is missing: its recorder did not close it, or it is cut off at "
                      "byte {}. It is read from the start.",
                      file_.size()));
    return false;
  }
  const std::uint64_t footer = record.position;
  const auto summary = ByteCursor(bytes).number<std::uint64_t>();
  if (summary == 0) return false;
  mcap::Statistics statistics;
  bool whole = summary >= position_;
  for (std::uint64_t at = summary; whole && at != footer; at = record.end())
    whole = at < footer && readHead(at, record) && record.size <= footer - record.content &&
            takeSummaryRecord(record, statistics);
  if (!whole)
    sink_(FaultKind::NoIndex,
          fmt::format("The summary at byte {} is damaged; the file is read from the start.",
                      std::min(summary, file_.size())));
  if (!whole || statistics.channels == 0 || topic_of_channel_.size() != statistics.channels) return false;
  for (const auto& [channel, topic] : topic_of_channel_)
    if (const auto found = statistics.messages.find(channel); found != statistics.messages.end())
      topics_[topic].messages += found->second;
  return true;
}

bool McapSource::takeSummaryRecord(const Record& record, mcap::Statistics& statistics) {
  std::string_view content;
  if (!isKnown(record.op) || !readContent(record, content)) return false;
  if (record.is(mcap::Op::Schema)) addSchema(content);
  if (record.is(mcap::Op::Channel)) addChannel(content);
  if (record.is(mcap::Op::Statistics)) return mcap::parseStatistics(content, statistics);
  if (!record.is(mcap::Op::ChunkIndex)) return true;
  mcap::ChunkIndex index;
  if (!mcap::parseChunkIndex(content, index) || index.position >= record.position) return false;
  chunk_channels_[index.position] = std::move(index.channels);
  return true;
}

// Chunks are unpacked only if the indexes after them are missing, or name new channels.
void McapSource::listByScan() {
  PendingChunk chunk;
  Record record;
  for (std::uint64_t at = mcap::kMagic.size(); readHead(at, record);) {
    const bool fits = record.size <= file_.size() - record.content;
    const bool whole = fits && isKnown(record.op);
    std::string_view content;
    if (mcap::MessageIndex index; whole && chunk.position != 0 && record.is(mcap::Op::MessageIndex)) {
      if (readContent(record, content) && mcap::parseMessageIndex(content, index))
        chunk.messages[index.channel] += index.messages;
      at = record.end();
      continue;
    }
    countPending(chunk);
    if (record.is(mcap::Op::Chunk)) chunk.position = at;
    if (whole && (record.is(mcap::Op::DataEnd) || record.is(mcap::Op::Footer))) break;
    if (whole && record.is(mcap::Op::Schema) && readContent(record, content)) addSchema(content);
    if (whole && record.is(mcap::Op::Channel) && readContent(record, content)) addChannel(content);
    if (whole && record.is(mcap::Op::Message) &&
        file_.read(record.content, std::min<std::uint64_t>(record.size, 2), content))
      countMessage(content);
    at = whole ? record.end() : scanForChunk(at + 1);
  }
  countPending(chunk);
}

void McapSource::countPending(PendingChunk& chunk) {
  if (chunk.position == 0) return;
  const bool known = !chunk.messages.empty() &&
                     std::all_of(chunk.messages.begin(), chunk.messages.end(), [this](const auto& entry) {
                       return topic_of_channel_.contains(entry.first);
                     });
  if (known) {
    for (const auto& [channel, count] : chunk.messages) topics_[topic_of_channel_[channel]].messages += count;
  } else if (Record record; readHead(chunk.position, record)) {
    const FaultSink sink = std::exchange(sink_, [](FaultKind, const std::string&) {});
    if (loadChunk(record)) {  // its damage is reported on reading
      McapRecord part;
      while (takeMcapRecord(chunk_, part)) {
        if (part.is(mcap::Op::Schema)) addSchema(part.content);
        if (part.is(mcap::Op::Channel)) addChannel(part.content);
        if (part.is(mcap::Op::Message)) countMessage(part.content);
      }
    }
    sink_ = sink;
    goToBegin();
  }
  chunk = {};
}

void McapSource::addSchema(std::string_view content) {
  mcap::Schema schema;
  if (!mcap::parseSchema(content, schema)) return;
  const bool readable = schema.encoding == "ros2msg" || schema.encoding == "ros1msg";
  schemas_[schema.id] = {std::string(schema.name), readable ? std::string(schema.data) : std::string()};
}

void McapSource::addChannel(std::string_view content) {
  mcap::Channel channel;
  if (!mcap::parseChannel(content, channel) || topic_of_channel_.contains(channel.id)) return;
  const auto known = schemas_.find(channel.schema);
  const SchemaText schema = known != schemas_.end() ? known->second : SchemaText{};
  if (known == schemas_.end() && channel.schema != 0) without_schema_.emplace_back(channel.topic);
  SourceTopic entry;
  entry.topic = {std::string(channel.topic), schema.name, "", schema.definition,
                 channel.encoding == "ros1" ? Serialization::Ros1 : Serialization::Cdr};
  if (channel.encoding != "ros1" && channel.encoding != "cdr") {
    entry.topic.type += fmt::format(" ({})", channel.encoding);  // unknown type
    entry.topic.definition.clear();
  }
  constexpr std::size_t kMaxDefinitions_bytes = std::size_t{1} << 26;
  definitions_bytes_ += entry.topic.definition.size();
  if (definitions_bytes_ > kMaxDefinitions_bytes)
    throw badInput(path_, "the definitions of its messages are too large", "Copy the file again");
  topic_of_channel_[channel.id] = topics_.size();
  topics_.push_back(std::move(entry));
}

void McapSource::countMessage(std::string_view content) {
  ByteCursor cursor(content);
  const auto found = topic_of_channel_.find(cursor.number<std::uint16_t>());
  if (cursor.ok() && found != topic_of_channel_.end()) ++topics_[found->second].messages;
}

bool McapSource::next(SourceMessage& message) {
  for (;;) {
    if (!chunk_.empty()) {
      if (nextOfChunk(message)) return true;
    } else if (ended_) {
      return false;
    } else if (nextRecord(message)) {
      return true;
    }
  }
}

bool McapSource::nextOfChunk(SourceMessage& message) {
  McapRecord record;
  const std::size_t at = chunk_size_ - chunk_.size();
  if (!takeMcapRecord(chunk_, record)) {
    if (!chunk_is_cut_)
      sink_(FaultKind::Corrupt,
            fmt::format("The chunk at byte {} is damaged from its byte {}; the rest is left out.",
                        record_position_, at));
    chunk_ = {};
    return false;
  }
  if (record.is(mcap::Op::Schema)) addSchema(record.content);
  if (record.is(mcap::Op::Channel)) addChannel(record.content);
  return record.is(mcap::Op::Message) && handOut(record.content, message);
}

// Reads the next record of the file: true if it is a message.
bool McapSource::nextRecord(SourceMessage& message) {
  Record record;
  record_position_ = position_;
  file_.reaches(position_ + mcap::kRecordHead_bytes);
  if (!readHead(position_, record)) {
    ended_ = true;
    if (position_ < file_.size()) {
      sink_(FaultKind::Truncated, fmt::format("The file ends within a record, at byte {}.", file_.size()));
    } else if (closed_) {
      sink_(FaultKind::Corrupt, "Records are damaged: they end before the file does. Some may be missing.");
    }
    return false;
  }
  if (record.size <= kLargestAwaited_bytes && isKnown(record.op)) file_.reaches(record.end());
  limit_.setFileBytes(file_.size());
  if (record.size > file_.size() - record.content || !isKnown(record.op)) {
    skipDamage(record);
    return false;
  }
  position_ = record.end();
  ended_ = record.is(mcap::Op::DataEnd) || record.is(mcap::Op::Footer);
  std::string_view content;
  if (record.is(mcap::Op::Schema) && readContent(record, content)) addSchema(content);
  if (record.is(mcap::Op::Channel) && readContent(record, content)) addChannel(content);
  if (record.is(mcap::Op::Chunk) && chunkIsWanted(record.position)) loadChunk(record);
  return record.is(mcap::Op::Message) && readContent(record, content) && handOut(content, message);
}

bool McapSource::handOut(std::string_view content, SourceMessage& message) {
  mcap::Message record;
  if (!mcap::parseMessage(content, record)) {
    sink_(FaultKind::Corrupt, fmt::format("A message {} is damaged; it is left out.", place()));
    return false;
  }
  const auto found = topic_of_channel_.find(record.channel);
  if (found == topic_of_channel_.end() && unknown_channels_.insert(record.channel).second) {
    sink_(FaultKind::Corrupt,
          fmt::format("Messages are of channel {}, which the file does not describe; they are left out.",
                      record.channel));
  }
  if (found == topic_of_channel_.end() || !wanted(found->second)) return false;
  message = {found->second, record.log_time_ns, record.data};
  return true;
}

bool McapSource::chunkIsWanted(std::uint64_t position) const {
  const auto found = chunk_channels_.find(position);
  if (found == chunk_channels_.end() || found->second.empty()) return true;
  return std::any_of(found->second.begin(), found->second.end(), [this](std::uint16_t channel) {
    const auto topic = topic_of_channel_.find(channel);
    return topic == topic_of_channel_.end() || wanted(topic->second);
  });
}

// Unpacks the intact part: a cut chunk is read up to the cut.
bool McapSource::loadChunk(const Record& record) {
  chunk_ = {};
  std::string_view bytes;
  mcap::ChunkHead head;
  const std::uint64_t available = std::min(record.size, file_.size() - record.content);
  const bool has_head =
      file_.read(record.content, std::min(available, mcap::kLargestChunkHead_bytes), bytes) &&
      mcap::parseChunkHead(bytes, head);
  const std::string compression(head.compression);
  const std::uint64_t records_bytes = has_head ? std::min(head.records_bytes, available - head.size) : 0;
  Unpacked result = Unpacked::Damaged;
  if (has_head && head.uncompressed_bytes <= UnpackingLimit::ofPart(records_bytes) &&
      file_.read(record.content + head.size, records_bytes, bytes)) {
    if (compression.empty() && bytes.size() == head.uncompressed_bytes) {
      chunk_ = bytes;  // not copied
      result = Unpacked::Whole;
    } else {
      result = mcap::unpackChunk(compression, bytes, head.uncompressed_bytes, unpacked_);
      chunk_ = unpacked_;
      limit_.add(head.uncompressed_bytes);
    }
  }
  chunk_size_ = chunk_.size();
  chunk_is_cut_ = result == Unpacked::Cut;
  reportChunk(result, record, head);
  if (result == Unpacked::Whole) checkSum(head, record);
  return !chunk_.empty();
}

void McapSource::reportChunk(Unpacked result, const Record& record, const mcap::ChunkHead& head) {
  if (result == Unpacked::Damaged && head.uncompressed_bytes > UnpackingLimit::ofPart(record.size)) {
    sink_(FaultKind::Corrupt, fmt::format("The chunk at byte {} states {} bytes for {} packed ones, which is "
                                          "implausible; it is left out.",
                                          record.position, head.uncompressed_bytes, record.size));
  } else if (result == Unpacked::Damaged) {
    sink_(FaultKind::Corrupt,
          fmt::format("The chunk at byte {} cannot be unpacked; it is left out.", record.position));
  } else if (result == Unpacked::Cut) {
    sink_(FaultKind::Truncated, fmt::format("The chunk at byte {} has {} of {} bytes; these are read.",
                                            record.position, chunk_size_, head.uncompressed_bytes));
  }
}

void McapSource::checkSum(const mcap::ChunkHead& head, const Record& record) {
  if (head.crc == 0) return;
  const uLong crc = crc32_z(0, reinterpret_cast<const Bytef*>(chunk_.data()), chunk_.size());
  if (crc != head.crc) {
    sink_(FaultKind::Corrupt,
          fmt::format("The chunk at byte {} contradicts its checksum; it is read nevertheless.",
                      record.position));
  }
}

// A record with an impossible length, or of unknown kind.
void McapSource::skipDamage(const Record& record) {
  const bool is_chunk = record.is(mcap::Op::Chunk);
  position_ = chunkAfter(record.position);
  const bool last = position_ == file_.size();
  sink_(last && isKnown(record.op) ? FaultKind::Truncated : FaultKind::Corrupt,
        fmt::format("The record at byte {} of {} is {}; {}.", record.position, file_.size(),
                    isKnown(record.op) ? "cut off or has a false length" : "damaged",
                    last ? "nothing after it is read"
                         : fmt::format("reading continues with the chunk at byte {}", position_)));
  ended_ = last;
  if (is_chunk) loadChunk(record);
}

// Next chunk, from the index if it exists, otherwise by searching; the file's size if there is none.
std::uint64_t McapSource::chunkAfter(std::uint64_t position) {
  const auto found = chunk_channels_.upper_bound(position);
  if (found != chunk_channels_.end()) return found->first;
  return chunk_channels_.empty() ? scanForChunk(position + 1) : file_.size();
}

// A packed chunk has the name of its compression at a fixed position.
std::uint64_t McapSource::scanForChunk(std::uint64_t from) {
  constexpr std::uint64_t kName = mcap::kRecordHead_bytes + 8 + 8 + 8 + 4;  // its length, behind the crc
  constexpr std::uint64_t kBlock_bytes = 1 << 20, kLongestName_bytes = 8;
  static constexpr std::string_view kNames[] = {std::string_view("\3\0\0\0lz4", 7),
                                                std::string_view("\4\0\0\0zstd", 8)};
  std::string block;
  Record record;
  for (std::uint64_t begin = from + kName; begin < file_.size(); begin += kBlock_bytes) {
    std::string_view bytes;
    if (!file_.read(begin, std::min(kBlock_bytes + kLongestName_bytes, file_.size() - begin), bytes)) break;
    block = bytes;  // a copy: checking records replaces the bytes
    std::uint64_t first = file_.size();
    for (const std::string_view name : kNames) {
      for (std::size_t hit = block.find(name); hit != std::string::npos; hit = block.find(name, hit + 1)) {
        if (begin + hit - kName >= first) break;
        if (readHead(begin + hit - kName, record) && record.is(mcap::Op::Chunk)) first = record.position;
      }
    }
    if (first < file_.size()) return first;
  }
  return file_.size();
}

}  // namespace evical::ros
