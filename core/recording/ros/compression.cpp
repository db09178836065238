#include "core/recording/ros/compression.h"

#include "core/recording/unpacking_limit.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <new>

namespace evical::ros {
namespace {

constexpr int kZstdLevel = 3;  // the library's default

// Makes room after the existing bytes, within the declared size.
void growTowards(std::string& output, std::size_t used, std::uint64_t size_bytes) {
  constexpr std::size_t kFirst_bytes = std::size_t{4} << 20;
  output.resize(
      static_cast<std::size_t>(std::min<std::uint64_t>(size_bytes, std::max(kFirst_bytes, 2 * used))));
}

Unpacked finished(std::string& output, std::size_t used, std::uint64_t size_bytes) {
  output.resize(used);
  return used == size_bytes ? Unpacked::Whole : Unpacked::Cut;
}

Unpacked damaged(std::string& output) {
  output.clear();
  return Unpacked::Damaged;
}

using ZstdContext = std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)>;

ZstdContext zstdContext() {
  ZstdContext context(ZSTD_createDCtx(), &ZSTD_freeDCtx);
  if (!context) throw std::bad_alloc();
  return context;
}

// Appends output until the data end or are invalid; `whole` is true if a frame just ended.
Unpacked unpackZstdStream(std::string_view data, std::uint64_t largest_bytes, std::string& output,
                          bool& whole) {
  const ZstdContext context = zstdContext();
  ZSTD_inBuffer input{data.data(), data.size(), 0};
  std::size_t used = 0;
  whole = false;
  output.clear();
  while (!whole || input.pos < input.size) {
    if (used == output.size()) growTowards(output, used, largest_bytes);
    ZSTD_outBuffer room{output.data(), output.size(), used};
    const std::size_t consumed = input.pos;
    const std::size_t hint = ZSTD_decompressStream(context.get(), &room, &input);
    if (ZSTD_isError(hint) != 0U) return Unpacked::Damaged;
    const bool stalled = room.pos == used && input.pos == consumed;
    used = room.pos;
    whole = hint == 0;
    if (stalled && input.pos < input.size) return Unpacked::Damaged;  // more content than declared
    if (stalled) break;
  }
  output.resize(used);
  return Unpacked::Whole;
}

}  // namespace

Unpacked unpackLz4(std::string_view data, std::uint64_t size_bytes, std::string& output) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION))) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, &LZ4F_freeDecompressionContext);
  std::size_t used = 0, consumed = 0, hint = 1;
  output.clear();
  while (hint != 0) {
    if (used == output.size()) growTowards(output, used, size_bytes);
    std::size_t room = output.size() - used, given = data.size() - consumed;
    hint = LZ4F_decompress(raw, output.data() + used, &room, data.data() + consumed, &given, nullptr);
    if (LZ4F_isError(hint)) return damaged(output);
    used += room;
    consumed += given;
    const bool stalled = room == 0 && given == 0 && hint != 0;
    if (stalled && consumed < data.size()) return damaged(output);  // more content than declared
    if (stalled) break;
  }
  return finished(output, used, size_bytes);
}

Unpacked unpackBz2(std::string_view data, std::uint64_t size_bytes, std::string& output) {
  constexpr std::size_t kLargestStep_bytes = std::numeric_limits<unsigned>::max();
  bz_stream stream{};
  if (data.size() > kLargestStep_bytes) return damaged(output);
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> guard(&stream, &BZ2_bzDecompressEnd);
  stream.next_in = const_cast<char*>(data.data());  // the library does not write there
  stream.avail_in = static_cast<unsigned>(data.size());
  std::size_t used = 0;
  int state = BZ_OK;
  output.clear();
  while (state == BZ_OK) {
    if (used == output.size()) growTowards(output, used, size_bytes);
    stream.next_out = output.data() + used;
    stream.avail_out = static_cast<unsigned>(std::min(output.size() - used, kLargestStep_bytes));
    const unsigned in_before = stream.avail_in, out_before = stream.avail_out;
    state = BZ2_bzDecompress(&stream);
    used += out_before - stream.avail_out;
    const bool stalled = in_before == stream.avail_in && out_before == stream.avail_out;
    if (state == BZ_OK && stalled && stream.avail_in > 0) return damaged(output);  // more than declared
    if (state == BZ_OK && stalled) break;
  }
  if (state != BZ_OK && state != BZ_STREAM_END) return damaged(output);
  return finished(output, used, size_bytes);
}

Unpacked unpackZstd(std::string_view data, std::uint64_t size_bytes, std::string& output) {
  bool whole = false;
  if (unpackZstdStream(data, size_bytes, output, whole) == Unpacked::Damaged) return damaged(output);
  return output.size() == size_bytes ? Unpacked::Whole : Unpacked::Cut;
}

Unpacked unpackZstdFrame(std::string_view data, std::string& output) {
  bool whole = false;
  if (unpackZstdStream(data, UnpackingLimit::ofPart(data.size()), output, whole) == Unpacked::Damaged)
    return Unpacked::Damaged;
  return whole ? Unpacked::Whole : Unpacked::Cut;
}

Unpacked copyPlain(std::string_view data, std::uint64_t size_bytes, std::string& output) {
  output.assign(data.substr(0, static_cast<std::size_t>(std::min<std::uint64_t>(size_bytes, data.size()))));
  return output.size() == size_bytes ? Unpacked::Whole : Unpacked::Cut;
}

void packLz4(std::string_view data, std::string& output) {
  LZ4F_preferences_t preferences{};  // required by roslz4
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  preferences.frameInfo.blockSizeID = LZ4F_max1MB;
  output.resize(LZ4F_compressFrameBound(data.size(), &preferences));
  const std::size_t written =
      LZ4F_compressFrame(output.data(), output.size(), data.data(), data.size(), &preferences);
  if (LZ4F_isError(written)) throw std::bad_alloc();  // the bound excludes any other reason
  output.resize(written);
}

void packZstd(std::string_view data, std::string& output) {
  output.resize(ZSTD_compressBound(data.size()));
  const std::size_t written =
      ZSTD_compress(output.data(), output.size(), data.data(), data.size(), kZstdLevel);
  if (ZSTD_isError(written) != 0U) throw std::bad_alloc();  // the bound excludes any other reason
  output.resize(written);
}

}  // namespace evical::ros
