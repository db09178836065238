#include "core/recording/chunk_compression.h"

#include "core/base/error.h"

#include <bzlib.h>
#include <lz4frame.h>

#include <algorithm>
#include <memory>

namespace evical {
namespace {

constexpr std::size_t kFirstGuess = std::size_t{1} << 20;

// Room for more output behind the `used` bytes, as far as the limit allows.
void makeRoom(std::vector<std::uint8_t>& output, std::size_t used, std::size_t limit) {
  if (used < output.size() || output.size() >= limit) return;
  output.resize(std::min(limit, std::max(kFirstGuess, 2 * output.size())));
}

struct FreeLz4 {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

Unpacked unpackLz4(Bytes packed, std::size_t limit, std::vector<std::uint8_t>& output) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION))) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, FreeLz4> context(raw);
  output.resize(std::min(output.capacity(), limit));
  std::size_t used = 0;
  std::size_t hint = 1;  // 0 when the frame is complete
  Unpacked result = Unpacked::Partial;
  while (hint != 0) {
    makeRoom(output, used, limit);
    std::size_t out = output.size() - used;
    std::size_t in = packed.size();
    hint = LZ4F_decompress(context.get(), output.data() + used, &out, packed.data(), &in, nullptr);
    if (LZ4F_isError(hint)) {
      result = Unpacked::Corrupt;
      break;
    }
    used += out;
    packed = packed.subspan(in);
    if (hint != 0 && in == 0 && out == 0) {  // no progress: out of input, or more output than was declared
      result = packed.empty() ? Unpacked::Partial : Unpacked::Corrupt;
      break;
    }
  }
  output.resize(used);
  return hint == 0 ? Unpacked::Whole : result;
}

struct BzStream {
  bz_stream state = {};
  BzStream() {
    if (BZ2_bzDecompressInit(&state, 0, 0) != BZ_OK) throw std::bad_alloc();
  }
  ~BzStream() { BZ2_bzDecompressEnd(&state); }
  BzStream(const BzStream&) = delete;
  BzStream& operator=(const BzStream&) = delete;
};

// At most 2 GiB of input: InputFile's callers bound chunks well below that.
Unpacked unpackBz2(Bytes packed, std::size_t limit, std::vector<std::uint8_t>& output) {
  BzStream stream;
  stream.state.next_in = const_cast<char*>(reinterpret_cast<const char*>(packed.data()));
  stream.state.avail_in = static_cast<unsigned>(packed.size());
  output.resize(std::min(output.capacity(), limit));
  std::size_t used = 0;
  for (;;) {
    makeRoom(output, used, limit);
    const auto space = static_cast<unsigned>(std::min<std::size_t>(output.size() - used, 1U << 30));
    const unsigned left = stream.state.avail_in;
    stream.state.next_out = reinterpret_cast<char*>(output.data() + used);
    stream.state.avail_out = space;
    const int status = BZ2_bzDecompress(&stream.state);
    const std::size_t out = space - stream.state.avail_out;
    used += out;
    const bool stalled = out == 0 && left == stream.state.avail_in;
    if (status == BZ_OK && !stalled) continue;
    output.resize(used);
    if (status == BZ_STREAM_END) return Unpacked::Whole;
    return status == BZ_OK && stream.state.avail_in == 0 ? Unpacked::Partial : Unpacked::Corrupt;
  }
}

}  // namespace

std::optional<Compression> compressionNamed(std::string_view name) {
  for (const Compression known : {Compression::None, Compression::Lz4, Compression::Bz2})
    if (name == compressionName(known)) return known;
  return std::nullopt;
}

const char* compressionName(Compression compression) {
  switch (compression) {
    case Compression::None:
      return "none";
    case Compression::Lz4:
      return "lz4";
    case Compression::Bz2:
      return "bz2";
  }
  return "";
}

Unpacked unpack(Compression compression, Bytes packed, std::size_t limit,
                std::vector<std::uint8_t>& unpacked) {
  switch (compression) {
    case Compression::None: {
      const Bytes plain = packed.first(std::min(packed.size(), limit));
      unpacked.assign(plain.begin(), plain.end());
      return plain.size() < packed.size() ? Unpacked::Corrupt : Unpacked::Whole;
    }
    case Compression::Lz4:
      return unpackLz4(packed, limit, unpacked);
    case Compression::Bz2:
      return unpackBz2(packed, limit, unpacked);
  }
  return Unpacked::Corrupt;
}

void packLz4(Bytes plain, std::vector<std::uint8_t>& packed) {
  LZ4F_preferences_t preferences = {};
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  packed.resize(LZ4F_compressFrameBound(plain.size(), &preferences));
  const std::size_t size =
      LZ4F_compressFrame(packed.data(), packed.size(), plain.data(), plain.size(), &preferences);
  if (LZ4F_isError(size)) throw calibrationFailed("", "LZ4 failed to pack a chunk of the recording");
  packed.resize(size);
}

}  // namespace evical
