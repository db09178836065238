#include "core/recording/ros/image_messages.h"

#include "core/data/recording.h"
#include "core/format/picture_header.h"
#include "core/recording/ros/message_cursor.h"

#include <algorithm>
#include <iterator>

namespace evical::ros {
namespace {

// Names of sensor_msgs/image_encodings.h.
struct ImageEncoding {
  std::string_view name;
  FrameFormat format;
  std::size_t pixel_bytes;
};
constexpr ImageEncoding kImageEncodings[] = {{"mono8", FrameFormat::Gray8, 1},
                                             {"8UC1", FrameFormat::Gray8, 1},
                                             {"mono16", FrameFormat::Gray16, 2},
                                             {"16UC1", FrameFormat::Gray16, 2},
                                             {"rgb8", FrameFormat::Rgb8, 3},
                                             {"bgr8", FrameFormat::Bgr8, 3},
                                             {"rgba8", FrameFormat::Rgba8, 4},
                                             {"bgra8", FrameFormat::Bgra8, 4},
                                             {"bayer_rggb8", FrameFormat::BayerRggb8, 1},
                                             {"bayer_bggr8", FrameFormat::BayerBggr8, 1},
                                             {"bayer_gbrg8", FrameFormat::BayerGbrg8, 1},
                                             {"bayer_grbg8", FrameFormat::BayerGrbg8, 1},
                                             {"bayer_rggb16", FrameFormat::BayerRggb16, 2},
                                             {"bayer_bggr16", FrameFormat::BayerBggr16, 2},
                                             {"bayer_gbrg16", FrameFormat::BayerGbrg16, 2},
                                             {"bayer_grbg16", FrameFormat::BayerGrbg16, 2},
                                             {"8UC3", FrameFormat::Bgr8, 3},  // as OpenCV orders colours
                                             {"8UC4", FrameFormat::Bgra8, 4}};

const ImageEncoding* encodingNamed(std::string_view name) {
  const auto same = [&](const ImageEncoding& encoding) { return encoding.name == name; };
  const auto* const found = std::find_if(std::begin(kImageEncodings), std::end(kImageEncodings), same);
  return found == std::end(kImageEncodings) ? nullptr : found;
}

// `part` is in lower case.
bool has(std::string_view text, std::string_view part) {
  const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

void assign(const ImageMessage& image, Frame& frame) {
  frame = {};
  frame.time_ns = image.stamp_ns;
  frame.bytes.assign(image.bytes.begin(), image.bytes.end());
}

}  // namespace

bool isReadableImage(std::string_view encoding) {
  return encodingNamed(encoding) != nullptr;
}

// compressed_image_transport writes "bgr8; jpeg compressed bgr8", compressed_depth_image_transport "16UC1;
// compressedDepth png", whose pictures follow a header of that transport.
bool isReadablePackedImage(std::string_view format) {
  if (has(format, "compresseddepth")) return false;
  return format.empty() || has(format, "jpeg") || has(format, "jpg") || has(format, "png");
}

bool parseImage(std::string_view message, Serialization serialization, ImageMessage& image) {
  image = {};
  MessageCursor cursor(message, serialization);
  image.stamp_ns = cursor.header();
  const auto height = cursor.number<std::uint32_t>(), width = cursor.number<std::uint32_t>();
  image.encoding = cursor.text();
  image.big_endian = cursor.number<std::uint8_t>() != 0;
  image.row_bytes = cursor.number<std::uint32_t>();
  image.bytes = cursor.sequence();
  if (!cursor.wellEnded() || width == 0 || height == 0 || width > kLargestSide_px || height > kLargestSide_px)
    return false;
  image.size_px = {static_cast<int>(width), static_cast<int>(height)};
  return true;
}

bool parsePackedImage(std::string_view message, Serialization serialization, ImageMessage& image) {
  image = {};
  MessageCursor cursor(message, serialization);
  image.stamp_ns = cursor.header();
  image.encoding = cursor.text();
  image.bytes = cursor.sequence();
  if (!cursor.wellEnded()) return false;
  image.size_px = pictureSize(image.bytes);
  return true;
}

std::optional<WrongStep> wrongStep(const ImageMessage& image) {
  const ImageEncoding* const encoding = encodingNamed(image.encoding);
  if (!encoding) return std::nullopt;
  const auto width = static_cast<std::uint64_t>(image.size_px.width_px);
  const auto height = static_cast<std::uint64_t>(image.size_px.height_px);
  const std::uint64_t needed = width * encoding->pixel_bytes;
  if (image.row_bytes >= needed) return std::nullopt;
  return WrongStep{image.row_bytes, needed, needed * height == image.bytes.size()};
}

bool toFrame(const ImageMessage& image, Frame& frame) {
  const ImageEncoding* const encoding = encodingNamed(image.encoding);
  const auto height = static_cast<std::uint64_t>(image.size_px.height_px);
  const std::optional<WrongStep> wrong = wrongStep(image);
  const std::uint64_t row_bytes = wrong ? wrong->needed_bytes : image.row_bytes;
  if (!encoding || (wrong && !wrong->complete) || row_bytes * height > image.bytes.size()) return false;
  assign(image, frame);
  frame.format = encoding->format;
  frame.big_endian = image.big_endian;
  frame.size_px = image.size_px;
  frame.row_bytes = static_cast<std::size_t>(row_bytes);
  return true;
}

bool toPackedFrame(const ImageMessage& image, Frame& frame) {
  const PictureKind kind = pictureKind(image.bytes);
  if (kind != PictureKind::Jpeg && kind != PictureKind::Png) return false;
  assign(image, frame);
  frame.format = FrameFormat::Encoded;
  return true;
}

bool encodeImage(const Frame& frame, std::uint32_t sequence, Serialization serialization,
                 std::string& message) {
  const auto* const encoding =
      std::find_if(std::begin(kImageEncodings), std::end(kImageEncodings),
                   [&](const ImageEncoding& known) { return known.format == frame.format; });
  if (encoding == std::end(kImageEncodings)) return false;
  MessageBytes bytes(message, serialization);
  bytes.appendHeader(sequence, frame.time_ns);
  bytes.append(static_cast<std::uint32_t>(frame.size_px.height_px));
  bytes.append(static_cast<std::uint32_t>(frame.size_px.width_px));
  bytes.appendText(encoding->name);
  bytes.append(static_cast<std::uint8_t>(frame.big_endian ? 1 : 0));
  bytes.append(static_cast<std::uint32_t>(frame.row_bytes));
  bytes.appendSequence(frame.bytes);
  return true;
}

bool encodePackedImage(const Frame& frame, std::uint32_t sequence, Serialization serialization,
                       std::string& message) {
  if (frame.format != FrameFormat::Encoded) return false;
  const PictureKind kind =
      pictureKind({reinterpret_cast<const char*>(frame.bytes.data()), frame.bytes.size()});
  if (kind != PictureKind::Jpeg && kind != PictureKind::Png) return false;
  MessageBytes bytes(message, serialization);
  bytes.appendHeader(sequence, frame.time_ns);
  bytes.appendText(kind == PictureKind::Jpeg ? "jpeg" : "png");
  bytes.appendSequence(frame.bytes);
  return true;
}

}  // namespace evical::ros
