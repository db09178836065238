#include "core/recording/bag_layout.h"

#include "core/base/error.h"
#include "core/recording/bag_chunk.h"
#include "core/recording/rosbag_format.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical {
namespace {

using State = BagFileRecord::State;

constexpr std::uint32_t kLongestIndexRecord = 1U << 24;  // definitions and counts have some kB
constexpr std::size_t kMostConnections = 10000;          // real bags have up to some hundreds

bool knows(const BagLayout& layout, std::uint32_t connection) {
  return std::any_of(layout.connections.begin(), layout.connections.end(),
                     [&](const BagConnection& known) { return known.id == connection; });
}

// The topic of the record's header is the one under which it was recorded; that in the data is the
// publisher's.
void addConnection(const BagFields& header, Bytes data, BagLayout& layout) {
  const std::optional<std::uint32_t> id = header.number<std::uint32_t>("conn");
  const std::optional<BagFields> details = BagFields::parse(data);
  if (!id || !details || knows(layout, *id) || layout.connections.size() == kMostConnections) return;
  layout.connections.push_back({*id, header.text("topic"), details->text("type"), details->text("md5sum"),
                                details->text("message_definition")});
}

bool addChunkInfo(const BagFields& header, Bytes data, BagLayout& layout) {
  const std::optional<std::uint64_t> position = header.number<std::uint64_t>("chunk_pos");
  if (!position) return false;
  BagChunk chunk;
  chunk.position = *position;
  chunk.counted = true;
  ByteReader reader(data);
  BagChunk::Count count;
  while (reader.read(count.connection) && reader.read(count.messages)) chunk.counts.push_back(count);
  layout.chunks.push_back(std::move(chunk));
  return true;
}

// The section at the file's end; nothing if it isn't whole or contradicts the bag header's counts.
std::optional<BagLayout> readIndex(const InputFile& file, std::uint64_t position,
                                   const BagFields& bag_header) {
  BagLayout layout;
  BagFileRecord record;
  std::vector<std::uint8_t> data;
  while (position < file.size()) {
    readBagFileRecord(file, position, record);
    if (record.state != State::Whole || record.data_size > kLongestIndexRecord) return std::nullopt;
    file.readAt(record.data_position, record.data_size, data);
    const std::optional<BagOp> op = record.fields.op();
    if (op == BagOp::Connection)
      addConnection(record.fields, data, layout);
    else if (op != BagOp::ChunkInfo || !addChunkInfo(record.fields, data, layout))
      return std::nullopt;
    position = record.end();
  }
  if (layout.connections.size() != bag_header.number<std::uint32_t>("conn_count") ||
      layout.chunks.size() != bag_header.number<std::uint32_t>("chunk_count"))
    return std::nullopt;
  std::sort(layout.chunks.begin(), layout.chunks.end(),
            [](const BagChunk& a, const BagChunk& b) { return a.position < b.position; });
  const auto same = [](const BagChunk& a, const BagChunk& b) { return a.position == b.position; };
  layout.chunks.erase(std::unique(layout.chunks.begin(), layout.chunks.end(), same), layout.chunks.end());
  return layout;
}

// One record of the pass; what it says goes into the layout.
void addScanned(const InputFile& file, std::uint64_t position, const BagFileRecord& record,
                BagLayout& layout) {
  const std::optional<BagOp> op = record.fields.op();
  if (op == BagOp::Chunk) {
    layout.chunks.push_back({position, {}, false});
  } else if (op == BagOp::IndexData && !layout.chunks.empty()) {
    const auto connection = record.fields.number<std::uint32_t>("conn");
    const auto count = record.fields.number<std::uint32_t>("count");
    if (!connection || !count) return;
    layout.chunks.back().counts.push_back({*connection, *count});
    layout.chunks.back().counted = true;
  } else if (op == BagOp::Connection && record.data_size <= kLongestIndexRecord) {
    std::vector<std::uint8_t> data;
    file.readAt(record.data_position, record.data_size, data);
    addConnection(record.fields, data, layout);
  }
}

// A chunk holds the connection records of its messages; look only where the counts name one that we lack.
void findConnections(const InputFile& file, BagLayout& layout) {
  BagChunkReader reader;
  BagRecord record;
  for (const BagChunk& chunk : layout.chunks) {
    const bool complete = chunk.counted && std::all_of(chunk.counts.begin(), chunk.counts.end(),
                                                       [&](const BagChunk::Count& count) {
                                                         return knows(layout, count.connection);
                                                       });
    if (complete) continue;
    reader.load(file, chunk.position);
    while (reader.next(record))
      if (record.fields.op() == BagOp::Connection) addConnection(record.fields, record.data, layout);
  }
}

BagLayout scan(const InputFile& file, FaultLog& faults) {
  BagLayout layout;
  BagFileRecord record;
  std::uint64_t position = kBagMagic.size();
  while (position < file.size()) {
    readBagFileRecord(file, position, record);
    if (record.has_header) addScanned(file, position, record, layout);
    if (record.state == State::Corrupt) {
      faults.add("", "corrupt", 0.0,
                 fmt::format("there is no valid record at byte {}; the {} bytes from there on are not read",
                             position, file.size() - position));
    } else if (record.state == State::Truncated) {
      faults.add("", "truncated", 0.0,
                 fmt::format("the file ends at byte {}, within the record that begins at byte {}",
                             file.size(), position));
    }
    if (record.state != State::Whole) {
      if (!layout.chunks.empty()) layout.chunks.back().counted = false;  // its counts may have been cut off
      break;
    }
    position = record.end();
  }
  findConnections(file, layout);
  return layout;
}

}  // namespace

BagLayout readBagLayout(const InputFile& file, FaultLog& faults) {
  BagFileRecord header;
  readBagFileRecord(file, kBagMagic.size(), header);
  if (header.state == State::Whole && header.fields.op() == BagOp::BagHeader) {
    const std::uint64_t index = header.fields.number<std::uint64_t>("index_pos").value_or(0);
    if (index == 0) {
      faults.add(
          "", "truncated", 0.0,
          "the bag was not closed when it was recorded (its index is missing); it is read in sequence. "
          "`rosbag reindex` repairs it");
    } else if (index >= file.size()) {
      // An empty bag's index is empty, at the very end.
      if (index == file.size() && header.fields.number<std::uint32_t>("chunk_count") == 0U) return {};
      faults.add("", "truncated", 0.0,
                 fmt::format("the index should be at byte {}, but the file ends at byte {}; what "
                             "is there is read in sequence",
                             index, file.size()));
    } else if (std::optional<BagLayout> layout = readIndex(file, index, header.fields)) {
      return std::move(*layout);
    } else {
      faults.add("", "corrupt", 0.0,
                 fmt::format("the index at byte {} is damaged; the bag is read in sequence", index));
    }
  }
  return scan(file, faults);
}

}  // namespace evical
