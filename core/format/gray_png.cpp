#include "core/format/gray_png.h"

#include "core/base/error.h"

#include <zlib.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace evical {
namespace {

constexpr std::uint8_t kUp = 2;  // rows as differences to the previous ones, which are mostly equal
constexpr std::size_t kChunk_bytes = 1 << 20;

std::string bigEndian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(value >> shift));
  return bytes;
}

}  // namespace

struct GrayPng::Stream {
  z_stream z = {};
};

GrayPng::GrayPng(int width_px, int height_px, double resolution_dpi)
    : stream_(std::make_unique<Stream>()), above_(static_cast<std::size_t>(width_px), 0) {
  if (deflateInit(&stream_->z, Z_DEFAULT_COMPRESSION) != Z_OK)
    throw calibrationFailed("PNG", "cannot be compressed: out of memory", "Use fewer dots per inch");
  file_ = std::string("\x89PNG\r\n\x1A\n", 8);
  const std::string gray8 = {8, 0, 0, 0, 0};
  addChunk("IHDR", bigEndian(static_cast<std::uint32_t>(width_px)) +
                       bigEndian(static_cast<std::uint32_t>(height_px)) + gray8);
  constexpr double kInch_m = 0.0254;
  const std::string per_metre = bigEndian(static_cast<std::uint32_t>(std::lround(resolution_dpi / kInch_m)));
  addChunk("pHYs", per_metre + per_metre + '\1');
}

GrayPng::~GrayPng() {
  deflateEnd(&stream_->z);
}

void GrayPng::addChunk(const char* type, const std::string& data) {
  const std::string content = type + data;
  const uLong sum =
      crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
  file_ += bigEndian(static_cast<std::uint32_t>(data.size())) + content +
           bigEndian(static_cast<std::uint32_t>(sum));
}

void GrayPng::compress(std::span<const std::uint8_t> bytes, int flush) {
  z_stream& z = stream_->z;
  std::array<Bytef, 1 << 15> buffer;
  z.next_in = const_cast<Bytef*>(bytes.data());  // the library does not write there
  z.avail_in = static_cast<uInt>(bytes.size());
  do {
    z.next_out = buffer.data();
    z.avail_out = static_cast<uInt>(buffer.size());
    deflate(&z, flush);
    data_.append(reinterpret_cast<const char*>(buffer.data()), buffer.size() - z.avail_out);
  } while (z.avail_out == 0);
  if (data_.size() < kChunk_bytes && flush != Z_FINISH) return;
  addChunk("IDAT", data_);
  data_.clear();
}

void GrayPng::addRow(std::span<const std::uint8_t> shades) {
  line_.assign(1, kUp);
  for (std::size_t x = 0; x < above_.size(); ++x) {
    line_.push_back(static_cast<std::uint8_t>(shades[x] - above_[x]));
    above_[x] = shades[x];
  }
  compress(line_, Z_NO_FLUSH);
}

std::string GrayPng::finish() {
  compress({}, Z_FINISH);
  addChunk("IEND", {});
  return std::move(file_);
}

}  // namespace evical
