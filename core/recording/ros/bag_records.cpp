#include "core/recording/ros/bag_records.h"

#include "core/recording/byte_cursor.h"

#include <bzlib.h>
#include <lz4frame.h>

#include <algorithm>
#include <memory>
#include <new>
#include <utility>

namespace evical::rosbag {
namespace {

// Walks "u32 length, name=value" fields; a value may hold any byte, so the first '=' splits.
template <class Visitor>
bool forEachField(std::string_view bytes, Visitor&& visit) {
  ByteCursor cursor(bytes);
  while (!cursor.atEnd()) {
    const std::string_view field = cursor.sized();
    const std::size_t equals = field.find('=');
    if (!cursor.ok() || equals == std::string_view::npos) return false;
    visit(field.substr(0, equals), field.substr(equals + 1));
  }
  return true;
}

template <class Number>
Number numberIn(std::string_view value) {
  return ByteCursor(value).number<Number>();
}

std::int64_t timeIn(std::string_view value) {
  ByteCursor cursor(value);
  const std::int64_t seconds = cursor.number<std::uint32_t>();
  return seconds * 1'000'000'000 + cursor.number<std::uint32_t>();
}

// Makes room behind what is there, within the declared size.
void growTowards(std::string& output, std::size_t used, std::uint32_t size) {
  constexpr std::size_t kFirstBytes = std::size_t{4} << 20;
  output.resize(std::min<std::size_t>(size, std::max(kFirstBytes, 2 * used)));
}

Unpacked decompressLz4(std::string_view data, std::uint32_t size, std::string& output) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION))) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, &LZ4F_freeDecompressionContext);
  std::size_t used = 0, consumed = 0, hint = 1;
  output.clear();
  while (hint != 0) {
    if (used == output.size()) growTowards(output, used, size);
    std::size_t room = output.size() - used, given = data.size() - consumed;
    hint = LZ4F_decompress(raw, output.data() + used, &room, data.data() + consumed, &given, nullptr);
    if (LZ4F_isError(hint)) return Unpacked::Damaged;
    used += room;
    consumed += given;
    const bool stalled = room == 0 && given == 0 && hint != 0;
    if (stalled && consumed < data.size()) return Unpacked::Damaged;  // they hold more than declared
    if (stalled) break;
  }
  output.resize(used);
  return used == size ? Unpacked::Whole : Unpacked::Cut;
}

Unpacked decompressBz2(std::string_view data, std::uint32_t size, std::string& output) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> guard(&stream, &BZ2_bzDecompressEnd);
  stream.next_in = const_cast<char*>(data.data());  // the library does not write there
  stream.avail_in = static_cast<unsigned>(data.size());
  std::size_t used = 0;
  int state = BZ_OK;
  output.clear();
  while (state == BZ_OK) {
    if (used == output.size()) growTowards(output, used, size);
    stream.next_out = output.data() + used;
    stream.avail_out = static_cast<unsigned>(output.size() - used);
    const unsigned in_before = stream.avail_in, out_before = stream.avail_out;
    state = BZ2_bzDecompress(&stream);
    used += out_before - stream.avail_out;
    const bool stalled = in_before == stream.avail_in && out_before == stream.avail_out;
    if (state == BZ_OK && stalled && stream.avail_in > 0) return Unpacked::Damaged;  // more than declared
    if (state == BZ_OK && stalled) break;
  }
  if (state != BZ_OK && state != BZ_STREAM_END) return Unpacked::Damaged;
  output.resize(used);
  return used == size ? Unpacked::Whole : Unpacked::Cut;
}

}  // namespace

bool parseRecordHeader(std::string_view bytes, RecordHeader& header) {
  header = {};
  const bool whole = forEachField(bytes, [&](std::string_view name, std::string_view value) {
    if (name == "op") header.op = numberIn<std::uint8_t>(value);
    if (name == "conn") header.connection = numberIn<std::uint32_t>(value);
    if (name == "time") header.time_ns = timeIn(value);
    if (name == "size") header.size = numberIn<std::uint32_t>(value);
    if (name == "conn_count") header.connection_count = numberIn<std::uint32_t>(value);
    if (name == "chunk_count") header.chunk_count = numberIn<std::uint32_t>(value);
    if (name == "index_pos") header.index_position = numberIn<std::uint64_t>(value);
    if (name == "chunk_pos") header.chunk_position = numberIn<std::uint64_t>(value);
    if (name == "compression") header.compression = value;
    if (name == "topic") header.topic = value;
  });
  return whole && header.op != 0;
}

ConnectionData parseConnectionData(std::string_view bytes) {
  ConnectionData connection;
  forEachField(bytes, [&](std::string_view name, std::string_view value) {
    if (name == "topic") connection.topic = value;
    if (name == "type") connection.type = value;
    if (name == "md5sum") connection.md5 = value;
    if (name == "message_definition") connection.definition = value;
  });
  return connection;
}

Unpacked decompressChunk(std::string_view compression, std::string_view data, std::uint32_t size,
                         std::string& output) {
  Unpacked result = Unpacked::Damaged;
  if (compression == "lz4") result = decompressLz4(data, size, output);
  if (compression == "bz2") result = decompressBz2(data, size, output);
  if (compression == "none") {
    output.assign(data.substr(0, size));
    result = output.size() == size ? Unpacked::Whole : Unpacked::Cut;
  }
  if (result == Unpacked::Damaged) output.clear();
  return result;
}

void compressLz4(std::string_view data, std::string& output) {
  LZ4F_preferences_t preferences{};  // what roslz4 insists on
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  preferences.frameInfo.blockSizeID = LZ4F_max1MB;
  output.resize(LZ4F_compressFrameBound(data.size(), &preferences));
  const std::size_t written =
      LZ4F_compressFrame(output.data(), output.size(), data.data(), data.size(), &preferences);
  if (LZ4F_isError(written)) throw std::bad_alloc();  // the bound leaves no other reason
  output.resize(written);
}

}  // namespace evical::rosbag
