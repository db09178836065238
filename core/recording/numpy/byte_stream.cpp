#include "core/recording/numpy/byte_stream.h"

#include "core/base/error.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <utility>
#include <vector>

namespace evical::numpy {
namespace {

constexpr std::size_t kStreamBlock_bytes = std::size_t{1} << 16;
constexpr std::uint64_t kMaxDeflated = 1032;  // zlib.net, "zlib technical details"

std::ifstream opened(const ByteRange& range) {
  std::ifstream file(range.path, std::ios::binary);
  if (!file) throw badInput(range.path.string(), "the file cannot be opened", "Check its permissions");
  file.seekg(static_cast<std::streamoff>(range.position));
  return file;
}

// Checksum of bytes in order.
class Checksum {
 public:
  explicit Checksum(const ByteRange& range) : expected_(range.checksum), rest_(range.bytes) {}

  void add(const char* bytes, std::size_t count) {
    if (!expected_) return;
    sum_ = crc32_z(sum_, reinterpret_cast<const Bytef*>(bytes), count);
    rest_ -= std::min<std::uint64_t>(rest_, count);
  }
  void giveUp() { expected_.reset(); }
  bool differs() const { return expected_ && rest_ == 0 && sum_ != *expected_; }

 private:
  std::optional<std::uint32_t> expected_;
  std::uint64_t rest_;
  uLong sum_ = crc32_z(0, nullptr, 0);
};

class StoredBytes : public ByteStream {
 public:
  explicit StoredBytes(const ByteRange& range)
      : file_(opened(range)), rest_(std::min(range.bytes, range.packed_bytes)), checksum_(range) {}

  std::size_t read(char* bytes, std::size_t count) override {
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(count, rest_));
    file_.read(bytes, static_cast<std::streamsize>(wanted));
    const auto got = static_cast<std::size_t>(std::max<std::streamsize>(0, file_.gcount()));
    rest_ -= got;
    checksum_.add(bytes, got);
    return got;
  }

  bool skip(std::uint64_t count) override {
    if (count > rest_) return false;
    if (count <= kStreamBlock_bytes) return readPast(static_cast<std::size_t>(count));
    checksum_.giveUp();
    file_.seekg(static_cast<std::streamoff>(count), std::ios::cur);
    rest_ -= count;
    return static_cast<bool>(file_);
  }

  std::string problem() const override { return checksum_.differs() ? "the checksum is wrong" : ""; }

 private:
  // Inflates the headers, so that the checksum is known.
  bool readPast(std::size_t count) {
    std::vector<char> passed(count);
    return read(passed.data(), count) == count;
  }

  std::ifstream file_;
  std::uint64_t rest_;
  Checksum checksum_;
};

class InflatedBytes : public ByteStream {
 public:
  explicit InflatedBytes(const ByteRange& range)
      : file_(opened(range)), packed_rest_(range.packed_bytes), rest_(range.bytes), checksum_(range) {
    constexpr int kWithoutHeader = -15;
    if (inflateInit2(&state_, kWithoutHeader) != Z_OK)
      throw calibrationFailed(range.path.string(), "zlib has no memory");
  }
  ~InflatedBytes() override { inflateEnd(&state_); }
  InflatedBytes(const InflatedBytes&) = delete;
  InflatedBytes& operator=(const InflatedBytes&) = delete;

  std::size_t read(char* bytes, std::size_t count) override {
    const auto wanted = static_cast<std::size_t>(
        std::min<std::uint64_t>({count, rest_, std::numeric_limits<uInt>::max() / 2}));
    state_.next_out = reinterpret_cast<Bytef*>(bytes);
    state_.avail_out = static_cast<uInt>(wanted);
    while (state_.avail_out > 0 && !ended_) inflateSome();
    const std::size_t got = wanted - state_.avail_out;
    rest_ -= got;
    checksum_.add(bytes, got);
    return got;
  }

  bool skip(std::uint64_t count) override {
    std::vector<char> passed(kStreamBlock_bytes);
    while (count > 0) {
      const std::size_t got =
          read(passed.data(), static_cast<std::size_t>(std::min<std::uint64_t>(count, passed.size())));
      if (got == 0) return false;
      count -= got;
    }
    return true;
  }

  std::string problem() const override {
    if (!problem_.empty()) return problem_;
    return checksum_.differs() ? "the checksum is wrong" : "";
  }

 private:
  void inflateSome() {
    if (state_.avail_in == 0) refill();
    const int result = inflate(&state_, Z_NO_FLUSH);
    if (result == Z_OK) return;
    ended_ = true;
    if (result != Z_STREAM_END)
      problem_ =
          state_.avail_in == 0 && packed_rest_ == 0 ? "it ends before it should" : "it cannot be unpacked";
  }

  void refill() {
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(packed_rest_, packed_.size()));
    file_.read(packed_.data(), static_cast<std::streamsize>(wanted));
    const auto got = static_cast<std::size_t>(std::max<std::streamsize>(0, file_.gcount()));
    packed_rest_ = got < wanted ? 0 : packed_rest_ - got;
    state_.next_in = reinterpret_cast<Bytef*>(packed_.data());
    state_.avail_in = static_cast<uInt>(got);
  }

  std::ifstream file_;
  std::uint64_t packed_rest_, rest_;
  Checksum checksum_;
  std::array<char, kStreamBlock_bytes> packed_{};
  z_stream state_{};
  bool ended_ = false;
  std::string problem_;
};

}  // namespace

std::unique_ptr<ByteStream> openBytes(const ByteRange& range) {
  if (range.deflated) return std::make_unique<InflatedBytes>(range);
  return std::make_unique<StoredBytes>(range);
}

std::uint64_t mostInflated(std::uint64_t packed_bytes) {
  std::uint64_t most = 0;
  return __builtin_mul_overflow(packed_bytes, kMaxDeflated, &most) ? std::numeric_limits<std::uint64_t>::max()
                                                                   : most;
}

}  // namespace evical::numpy
