#include "core/frames/picture_header.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <string_view>

namespace evical {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint32_t kLargestSide_px = 1'000'000;

bool beginsWith(Bytes bytes, std::string_view text) {
  return bytes.size() >= text.size() &&
         std::equal(text.begin(), text.end(), bytes.begin(),
                    [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
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
  return {static_cast<int>(std::min(width, kLargestSide_px)),
          static_cast<int>(std::min(height, kLargestSide_px))};
}

std::optional<PictureHeader> png(Bytes bytes) {
  constexpr std::size_t kWidthAt = 16, kHeightAt = 20;
  if (!has(bytes, kHeightAt, 4)) return std::nullopt;
  return PictureHeader{PictureKind::Png,
                       sizeOf(bigEndian(bytes, kWidthAt, 4), bigEndian(bytes, kHeightAt, 4))};
}

std::optional<PictureHeader> bmp(Bytes bytes) {
  constexpr std::size_t kWidthAt = 18, kHeightAt = 22;
  if (!has(bytes, kHeightAt, 4)) return std::nullopt;
  // Of a picture that is stored from the top the height is negative.
  const std::uint32_t height = littleEndian(bytes, kHeightAt, 4);
  return PictureHeader{PictureKind::Bmp,
                       sizeOf(littleEndian(bytes, kWidthAt, 4), height > 0x7FFFFFFFU ? 0U - height : height)};
}

// Segments until the one that begins a frame, which holds the size.
std::optional<PictureHeader> jpeg(Bytes bytes) {
  std::size_t at = 2;
  while (has(bytes, at, 9)) {
    if (bytes[at] != 0xFF) return std::nullopt;
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xFF) {  // filling
      ++at;
      continue;
    }
    const bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (frame) {
      constexpr std::array<std::uint8_t, 2> kEnd = {0xFF, 0xD9};
      const Bytes rest = bytes.subspan(at);
      const bool ends = std::search(rest.begin(), rest.end(), kEnd.begin(), kEnd.end()) != rest.end();
      return PictureHeader{PictureKind::Jpeg,
                           sizeOf(bigEndian(bytes, at + 7, 2), bigEndian(bytes, at + 5, 2)), !ends};
    }
    at += 2 + bigEndian(bytes, at + 2, 2);
  }
  return std::nullopt;
}

// P5 width height, with spaces and comments between.
std::optional<PictureHeader> pnm(Bytes bytes) {
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
      number = std::min(10 * number + (bytes[at] - std::uint32_t{'0'}), kLargestSide_px);
    if (at == begin) return std::nullopt;
  }
  return PictureHeader{PictureKind::Pnm, sizeOf(numbers[0], numbers[1])};
}

// The first directory's tags 256 and 257.
std::optional<PictureHeader> tiff(Bytes bytes) {
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
  return PictureHeader{PictureKind::Tiff, sizeOf(width, height)};
}

}  // namespace

std::optional<PictureHeader> readPictureHeader(std::span<const std::uint8_t> bytes) {
  using namespace std::string_view_literals;
  if (beginsWith(bytes, "\xFF\xD8\xFF"sv)) return jpeg(bytes);
  if (beginsWith(bytes, "\x89PNG\r\n\x1A\n"sv)) return png(bytes);
  if (beginsWith(bytes, "BM"sv)) return bmp(bytes);
  if (beginsWith(bytes, "II*\0"sv) || beginsWith(bytes, "MM\0*"sv)) return tiff(bytes);
  if (bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6') return pnm(bytes);
  return std::nullopt;
}

}  // namespace evical
