#include "core/recording/picture_bytes.h"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace evical {
namespace {

using namespace std::string_view_literals;

constexpr std::int64_t kLargestSide_px = 65536;

std::uint32_t bigEndian(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

std::int32_t littleEndian32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return static_cast<std::int32_t>(value);
}

Resolution sized(std::int64_t width_px, std::int64_t height_px) {
  const auto isSide = [](std::int64_t side_px) { return side_px >= 1 && side_px <= kLargestSide_px; };
  if (!isSide(width_px) || !isSide(height_px)) return {};
  return {static_cast<int>(width_px), static_cast<int>(height_px)};
}

// Segment by segment to the one that begins the frame.
Resolution jpegSize(std::string_view bytes) {
  std::size_t at = 2;
  while (at + 9 <= bytes.size() && static_cast<unsigned char>(bytes[at]) == 0xFF) {
    const auto marker = static_cast<unsigned char>(bytes[at + 1]);
    if (marker == 0xFF) {  // a fill byte
      ++at;
      continue;
    }
    const bool no_frame = marker == 0xC4 || marker == 0xC8 || marker == 0xCC;
    if (marker >= 0xC0 && marker <= 0xCF && !no_frame)
      return sized(bigEndian(bytes, at + 7, 2), bigEndian(bytes, at + 5, 2));
    at += 2 + bigEndian(bytes, at + 2, 2);
  }
  return {};
}

// "P5 640 480 255", with comments to the ends of lines.
Resolution pnmSize(std::string_view bytes) {
  bytes.remove_prefix(2);
  int sides_px[2] = {0, 0};
  for (int& side_px : sides_px) {
    while (!bytes.empty() && (bytes.front() == '#' || bytes.front() <= ' ')) {
      const std::size_t end = bytes.front() == '#' ? bytes.find('\n') : 0;
      bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + 1);
    }
    const auto [end, error] = std::from_chars(bytes.data(), bytes.data() + bytes.size(), side_px);
    if (error != std::errc()) return {};
    bytes.remove_prefix(static_cast<std::size_t>(end - bytes.data()));
  }
  return sized(sides_px[0], sides_px[1]);
}

}  // namespace

PictureKind pictureKind(std::string_view bytes) {
  if (bytes.starts_with("\xFF\xD8\xFF"sv)) return PictureKind::Jpeg;
  if (bytes.starts_with("\x89PNG\r\n\x1A\n"sv)) return PictureKind::Png;
  if (bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv)) return PictureKind::Tiff;
  if (bytes.starts_with("BM"sv)) return PictureKind::Bmp;
  const bool pnm = bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6' &&
                   (bytes[2] == '#' || (bytes[2] > 0 && bytes[2] <= ' '));
  return pnm ? PictureKind::Pnm : PictureKind::None;
}

Resolution pictureSize(std::string_view bytes) {
  switch (pictureKind(bytes)) {
    case PictureKind::Jpeg:
      return jpegSize(bytes);
    case PictureKind::Png:
      return bytes.size() < 24 ? Resolution{} : sized(bigEndian(bytes, 16, 4), bigEndian(bytes, 20, 4));
    case PictureKind::Pnm:
      return pnmSize(bytes);
    case PictureKind::Bmp:  // a negative height: the rows begin with the topmost
      return bytes.size() < 26
                 ? Resolution{}
                 : sized(littleEndian32(bytes, 18), std::abs(std::int64_t{littleEndian32(bytes, 22)}));
    case PictureKind::Tiff:
    case PictureKind::None:
      break;
  }
  return {};
}

}  // namespace evical
