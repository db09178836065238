#include "core/recording/aedat/packet_compression.h"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <new>

namespace evical::aedat {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t kFirstBuffer_bytes = std::size_t{1} << 16;
constexpr std::size_t kLargestUnpacked_bytes = std::size_t{1} << 27;
constexpr int kPacketZstdLevel = 3;

bool isLz4(Compression compression) {
  return compression == Compression::Lz4 || compression == Compression::Lz4High;
}

}  // namespace

std::string_view compressionName(Compression compression) {
  static constexpr std::array kNames{"NONE"sv, "LZ4"sv, "LZ4_HIGH"sv, "ZSTD"sv, "ZSTD_HIGH"sv};
  return kNames.at(static_cast<std::size_t>(compression));
}

std::string_view frameMagic(Compression compression) {
  if (compression == Compression::None) return {};
  return isLz4(compression) ? "\x04\x22\x4D\x18"sv : "\x28\xB5\x2F\xFD"sv;
}

struct Unpacker::Contexts {
  LZ4F_dctx* lz4 = nullptr;
  ZSTD_DCtx* zstd = nullptr;
  ~Contexts() {
    LZ4F_freeDecompressionContext(lz4);
    ZSTD_freeDCtx(zstd);
  }
};

Unpacker::Unpacker(Compression compression)
    : compression_(compression), contexts_(std::make_unique<Contexts>()) {
  if (compression == Compression::None) return;
  if (isLz4(compression)) {
    if (LZ4F_isError(LZ4F_createDecompressionContext(&contexts_->lz4, LZ4F_VERSION))) throw std::bad_alloc();
  } else {
    contexts_->zstd = ZSTD_createDCtx();
    if (!contexts_->zstd) throw std::bad_alloc();
  }
}

Unpacker::~Unpacker() = default;

// Both lengths are set to the number of bytes used.
bool Unpacker::step(const char*& in, std::size_t& in_bytes, char* out, std::size_t& out_bytes,
                    bool& finished) {
  if (isLz4(compression_)) {
    const std::size_t hint = LZ4F_decompress(contexts_->lz4, out, &out_bytes, in, &in_bytes, nullptr);
    finished = hint == 0;
    return LZ4F_isError(hint) == 0;
  }
  ZSTD_inBuffer input{in, in_bytes, 0};
  ZSTD_outBuffer output{out, out_bytes, 0};
  const std::size_t hint = ZSTD_decompressStream(contexts_->zstd, &output, &input);
  in_bytes = input.pos;
  out_bytes = output.pos;
  finished = hint == 0;
  return ZSTD_isError(hint) == 0;
}

bool Unpacker::grow(std::size_t packed_bytes) {
  if (buffer_.size() >= kLargestUnpacked_bytes) return false;
  buffer_.resize(
      std::min(kLargestUnpacked_bytes, std::max({2 * buffer_.size(), 4 * packed_bytes, kFirstBuffer_bytes})));
  return true;
}

bool Unpacker::unpack(std::string_view packed, std::string_view& content, std::size_t& frame_bytes) {
  produced_ = 0;
  if (compression_ == Compression::None) {
    content = packed;
    frame_bytes = packed.size();
    return true;
  }
  if (contexts_->lz4) LZ4F_resetDecompressionContext(contexts_->lz4);
  if (contexts_->zstd) ZSTD_DCtx_reset(contexts_->zstd, ZSTD_reset_session_only);
  std::size_t consumed = 0;
  for (bool finished = false; !finished;) {
    if (produced_ == buffer_.size() && !grow(packed.size())) return false;
    const char* in = packed.data() + consumed;
    std::size_t in_bytes = packed.size() - consumed, out_bytes = buffer_.size() - produced_;
    if (!step(in, in_bytes, buffer_.data() + produced_, out_bytes, finished)) return false;
    consumed += in_bytes;
    produced_ += out_bytes;
    const bool stalled = in_bytes == 0 && out_bytes == 0 && produced_ < buffer_.size();
    if (stalled && !finished) return false;
  }
  content = std::string_view(buffer_).substr(0, produced_);
  frame_bytes = consumed;
  return true;
}

void pack(Compression compression, std::string_view content, std::string& packed) {
  if (compression == Compression::None) {
    packed.assign(content);
    return;
  }
  const bool lz4 = isLz4(compression);
  packed.resize(lz4 ? LZ4F_compressFrameBound(content.size(), nullptr) : ZSTD_compressBound(content.size()));
  const std::size_t size =
      lz4 ? LZ4F_compressFrame(packed.data(), packed.size(), content.data(), content.size(), nullptr)
          : ZSTD_compress(packed.data(), packed.size(), content.data(), content.size(), kPacketZstdLevel);
  // The bound excludes any other reason.
  if (lz4 ? LZ4F_isError(size) != 0 : ZSTD_isError(size) != 0) throw std::bad_alloc();
  packed.resize(size);
}

}  // namespace evical::aedat
