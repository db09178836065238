#include "core/format/picture_header.h"

#include "core/data/recording.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <span>

namespace evical {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint32_t kLargestClaim_px = 1'000'000;

Bytes bytesOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

bool has(Bytes bytes, std::size_t at, std::size_t count) {
  return at <= bytes.size() && bytes.size() - at >= count;
}

std::uint32_t bigEndian(Bytes bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < count; ++k) value = value << 8 | bytes[at + k];
  return value;
}

std::uint32_t littleEndian(Bytes bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < count; ++k) value |= static_cast<std::uint32_t>(bytes[at + k]) << (8 * k);
  return value;
}

Resolution sizeOf(std::uint32_t width, std::uint32_t height) {
  return {static_cast<int>(std::min(width, kLargestClaim_px)),
          static_cast<int>(std::min(height, kLargestClaim_px))};
}

std::optional<Resolution> pngSize(Bytes bytes) {
  constexpr std::size_t kWidthAt = 16, kHeightAt = 20;
  if (!has(bytes, kHeightAt, 4)) return std::nullopt;
  return sizeOf(bigEndian(bytes, kWidthAt, 4), bigEndian(bytes, kHeightAt, 4));
}

std::optional<Resolution> bmpSize(Bytes bytes) {
  constexpr std::size_t kWidthAt = 18, kHeightAt = 22;
  if (!has(bytes, kHeightAt, 4)) return std::nullopt;
  // The height is negative if rows are stored from the top.
  const std::uint32_t height = littleEndian(bytes, kHeightAt, 4);
  return sizeOf(littleEndian(bytes, kWidthAt, 4), height > 0x7FFFFFFFU ? 0U - height : height);
}

// Begin of the segment that starts a frame, which has the size.
std::optional<std::size_t> jpegFrame(Bytes bytes) {
  std::size_t at = 2;
  while (has(bytes, at, 9)) {
    if (bytes[at] != 0xFF) return std::nullopt;
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xFF) {  // filling
      ++at;
      continue;
    }
    if (marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC) return at;
    at += 2 + bigEndian(bytes, at + 2, 2);
  }
  return std::nullopt;
}

std::optional<Resolution> jpegSize(Bytes bytes) {
  const std::optional<std::size_t> at = jpegFrame(bytes);
  if (!at) return std::nullopt;
  return sizeOf(bigEndian(bytes, *at + 7, 2), bigEndian(bytes, *at + 5, 2));
}

// P5 width height, with spaces and comments between.
std::optional<Resolution> pnmSize(Bytes bytes) {
  std::array<std::uint32_t, 2> numbers{};
  std::size_t at = 2;
  for (std::uint32_t& number : numbers) {
    while (at < bytes.size() && (std::isspace(bytes[at]) != 0 || bytes[at] == '#')) {
      if (bytes[at] == '#')
        at = static_cast<std::size_t>(
            std::find(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end(), '\n') - bytes.begin());
      else
        ++at;
    }
    const std::size_t begin = at;
    for (; at < bytes.size() && std::isdigit(bytes[at]) != 0; ++at)
      number = std::min(10 * number + (bytes[at] - std::uint32_t{'0'}), kLargestClaim_px);
    if (at == begin) return std::nullopt;
  }
  return sizeOf(numbers[0], numbers[1]);
}

// The first directory's tags 256 and 257.
std::optional<Resolution> tiffSize(Bytes bytes) {
  const bool big = bytes[0] == 'M';
  const auto number = [&](std::size_t at, std::size_t count) {
    return big ? bigEndian(bytes, at, count) : littleEndian(bytes, at, count);
  };
  if (!has(bytes, 4, 4)) return std::nullopt;
  const std::size_t directory = number(4, 4);
  if (!has(bytes, directory, 2)) return std::nullopt;
  std::uint32_t width = 0, height = 0;
  for (std::size_t k = 0, count = number(directory, 2); k < count; ++k) {
    const std::size_t entry = directory + 2 + 12 * k;
    if (!has(bytes, entry, 12)) return std::nullopt;
    const std::uint32_t tag = number(entry, 2);
    if (tag != 256 && tag != 257) continue;
    (tag == 256 ? width : height) = number(entry + 8, number(entry + 2, 2) == 3 ? 2 : 4);
  }
  return sizeOf(width, height);
}

}  // namespace

PictureKind pictureKind(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\xFF\xD8\xFF"sv)) return PictureKind::Jpeg;
  if (bytes.starts_with("\x89PNG\r\n\x1A\n"sv)) return PictureKind::Png;
  if (bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv)) return PictureKind::Tiff;
  if (bytes.starts_with("BM"sv)) return PictureKind::Bmp;
  const bool pnm = bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6' &&
                   (bytes[2] == '#' || (bytes[2] > 0 && bytes[2] <= ' '));
  return pnm ? PictureKind::Pnm : PictureKind::None;
}

std::optional<Resolution> claimedPictureSize(std::string_view text) {
  const Bytes bytes = bytesOf(text);
  switch (pictureKind(text)) {
    case PictureKind::Jpeg:
      return jpegSize(bytes);
    case PictureKind::Png:
      return pngSize(bytes);
    case PictureKind::Pnm:
      return pnmSize(bytes);
    case PictureKind::Tiff:
      return tiffSize(bytes);
    case PictureKind::Bmp:
      return bmpSize(bytes);
    case PictureKind::None:
      break;
  }
  return std::nullopt;
}

Resolution pictureSize(std::string_view bytes) {
  const Resolution size_px = claimedPictureSize(bytes).value_or(Resolution{});
  const bool can_be =
      size_px.known() && size_px.width_px <= kLargestSide_px && size_px.height_px <= kLargestSide_px;
  return can_be ? size_px : Resolution{};
}

std::vector<std::uint8_t> pngPixels(std::string_view png) {
  constexpr std::size_t kMagic_bytes = 8, kLength_bytes = 4, kAround_bytes = 12;  // length, type and checksum
  constexpr std::array<std::string_view, 5> kNeeded = {"IHDR", "PLTE", "tRNS", "IDAT", "IEND"};
  const Bytes bytes = bytesOf(png);
  std::vector<std::uint8_t> kept;
  std::size_t at = kMagic_bytes;
  const auto keep = [&](std::size_t from, std::size_t count) {
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(from);
    kept.insert(kept.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  keep(0, kMagic_bytes);
  while (at < bytes.size()) {
    if (!has(bytes, at, kAround_bytes)) return {};
    const std::size_t whole = kAround_bytes + bigEndian(bytes, at, kLength_bytes);
    if (!has(bytes, at, whole)) return {};
    const std::string_view type = png.substr(at + kLength_bytes, 4);
    if (std::find(kNeeded.begin(), kNeeded.end(), type) != kNeeded.end()) keep(at, whole);
    if (type == "IEND") break;
    at += whole;
  }
  return kept;
}

std::size_t jpegScans(std::string_view jpeg) {
  constexpr std::string_view kScan = "\xFF\xDA";
  std::size_t scans = 0;
  for (std::size_t at = jpeg.find(kScan); at != std::string_view::npos; at = jpeg.find(kScan, at + 2))
    ++scans;
  return scans;
}

bool isTruncatedJpeg(std::string_view text) {
  if (pictureKind(text) != PictureKind::Jpeg) return false;
  const Bytes bytes = bytesOf(text);
  const std::optional<std::size_t> frame = jpegFrame(bytes);
  constexpr std::array<std::uint8_t, 2> kEnd = {0xFF, 0xD9};
  const Bytes rest = bytes.subspan(frame.value_or(bytes.size()));
  return std::search(rest.begin(), rest.end(), kEnd.begin(), kEnd.end()) == rest.end();
}

}  // namespace evical
