#include "core/frames/gray_image.h"

#include "core/frames/picture_view.h"

#include "core/base/error.h"
#include "core/format/picture_header.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace evical {
namespace {

constexpr std::int64_t kMaxPixels = 200'000'000;  // larger than any sensor
constexpr std::int64_t kFewPixels = 20'000'000;   // of a picture that may be as even as it likes
constexpr std::int64_t kMaxPixelsOfByte = 100;    // of a larger one
constexpr std::size_t kMaxScans = 100;            // real ones have up to 15
constexpr double kWhitePart = 0.995;

struct Layout {
  int type = CV_8UC1;
  int to_gray = -1;  // cv::cvtColor's code; -1: already gray
};

// OpenCV names a Bayer pattern after its second row's second and third pixel, its newer aliases and everybody
// else after the first row and column.
Layout layoutOf(FrameFormat format) {
  switch (format) {
    case FrameFormat::Gray16:
      return {CV_16UC1, -1};
    case FrameFormat::Rgb8:
      return {CV_8UC3, cv::COLOR_RGB2GRAY};
    case FrameFormat::Bgr8:
      return {CV_8UC3, cv::COLOR_BGR2GRAY};
    case FrameFormat::Rgba8:
      return {CV_8UC4, cv::COLOR_RGBA2GRAY};
    case FrameFormat::Bgra8:
      return {CV_8UC4, cv::COLOR_BGRA2GRAY};
    case FrameFormat::BayerRggb8:
      return {CV_8UC1, cv::COLOR_BayerRGGB2GRAY};
    case FrameFormat::BayerBggr8:
      return {CV_8UC1, cv::COLOR_BayerBGGR2GRAY};
    case FrameFormat::BayerGbrg8:
      return {CV_8UC1, cv::COLOR_BayerGBRG2GRAY};
    case FrameFormat::BayerGrbg8:
      return {CV_8UC1, cv::COLOR_BayerGRBG2GRAY};
    case FrameFormat::BayerRggb16:
      return {CV_16UC1, cv::COLOR_BayerRGGB2GRAY};
    case FrameFormat::BayerBggr16:
      return {CV_16UC1, cv::COLOR_BayerBGGR2GRAY};
    case FrameFormat::BayerGbrg16:
      return {CV_16UC1, cv::COLOR_BayerGBRG2GRAY};
    case FrameFormat::BayerGrbg16:
      return {CV_16UC1, cv::COLOR_BayerGRBG2GRAY};
    default:
      return {};
  }
}

void refuseAbsurdSize(const Resolution& size, std::int64_t max_pixels, const std::string& place) {
  if (size.known() && std::int64_t{size.width_px} * size.height_px <= max_pixels) return;
  throw badInput(
      place,
      fmt::format("claims a size of {} x {} pixels, which is implausible", size.width_px, size.height_px),
      "Copy the damaged file again, or remove it");
}

cv::Mat eightBits(const cv::Mat& sixteen) {
  std::vector<std::size_t> histogram(65536, 0);
  for (int y = 0; y < sixteen.rows; ++y)
    for (int x = 0; x < sixteen.cols; ++x) ++histogram[sixteen.at<std::uint16_t>(y, x)];
  const auto wanted = static_cast<std::size_t>(kWhitePart * static_cast<double>(sixteen.total()));
  std::size_t white = 0;
  for (std::size_t below = histogram[0]; below < wanted && white < 65535; below += histogram[white]) ++white;
  cv::Mat eight;
  sixteen.convertTo(eight, CV_8U, 255.0 / static_cast<double>(std::max<std::size_t>(white, 1)));
  return eight;
}

void swapBytes(cv::Mat& sixteen) {
  for (int y = 0; y < sixteen.rows; ++y)
    for (int x = 0; x < sixteen.cols; ++x) {
      auto& value = sixteen.at<std::uint16_t>(y, x);
      value = static_cast<std::uint16_t>(value << 8 | value >> 8);
    }
}

cv::Mat rawPixels(const Frame& frame, const std::string& place) {
  refuseAbsurdSize(frame.size_px, kMaxPixels, place);
  const Layout layout = layoutOf(frame.format);
  const auto width = static_cast<std::size_t>(frame.size_px.width_px);
  const auto height = static_cast<std::size_t>(frame.size_px.height_px);
  const std::size_t needed = width * static_cast<std::size_t>(CV_ELEM_SIZE(layout.type));
  const std::size_t step = frame.row_bytes == 0 ? needed : frame.row_bytes;
  if (step < needed || frame.bytes.size() < needed ||
      (height > 1 && (frame.bytes.size() - needed) / (height - 1) < step))
    throw badInput(place,
                   fmt::format("has {} bytes, but {} x {} pixels of its format need {}", frame.bytes.size(),
                               width, height, std::max(step, needed) * (height - 1) + needed),
                   "Copy the recording again, or remove the truncated picture");
  if (layout.to_gray >= 0 && CV_MAT_CN(layout.type) == 1 && (width < 3 || height < 3))
    throw badInput(place, "is too small for a Bayer pattern", "Remove this picture");
  cv::Mat seen = viewOf(frame.size_px, layout.type, frame.bytes, step);
  const bool swapped =
      layout.type == CV_16UC1 && frame.big_endian != (std::endian::native == std::endian::big);
  if (swapped || layout.to_gray < 0) seen = seen.clone();
  if (swapped) swapBytes(seen);  // before the pattern is interpolated
  if (layout.to_gray < 0) return seen;
  cv::Mat gray;
  cv::cvtColor(seen, gray, layout.to_gray);
  return gray;
}

cv::Mat decoded(const Frame& frame, const std::string& place) {
  const std::string_view bytes(reinterpret_cast<const char*>(frame.bytes.data()), frame.bytes.size());
  const std::optional<Resolution> claimed_px = claimedPictureSize(bytes);
  if (!claimed_px)
    throw badInput(place, "is not a JPEG, PNG, PGM, TIFF or BMP picture, or is truncated in its header",
                   "Save it as PNG, or remove it");
  refuseAbsurdSize(*claimed_px, std::clamp(kMaxPixelsOfByte * std::ssize(bytes), kFewPixels, kMaxPixels),
                   place);
  const PictureKind kind = pictureKind(bytes);
  if (kind == PictureKind::Jpeg && jpegScans(bytes) > kMaxScans)
    throw badInput(place, fmt::format("has {} scans, too many for a picture", jpegScans(bytes)),
                   "Save it again, or remove it");
  cv::Mat picture;
  const std::vector<std::uint8_t> png =
      kind == PictureKind::Png ? pngPixels(bytes) : std::vector<std::uint8_t>{};
  const std::vector<std::uint8_t>& pixels = kind == PictureKind::Png ? png : frame.bytes;
  if (!isTruncatedJpeg(bytes) && !pixels.empty()) {
    try {
      picture =
          cv::imdecode(pixels, cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
    } catch (const cv::Exception&) {
      picture.release();  // reported below
    }
  }
  if (picture.empty() || (picture.type() != CV_8UC1 && picture.type() != CV_16UC1))
    throw badInput(place, "is a damaged or truncated picture",
                   "Copy the recording again, or remove this picture");
  return picture;
}

}  // namespace

GrayImage decodeFrame(const Frame& frame, const std::string& place) {
  const bool encoded = frame.format == FrameFormat::Encoded;
  cv::Mat picture = encoded ? decoded(frame, place) : rawPixels(frame, place);
  GrayImage image{{picture.cols, picture.rows}, {}};
  if (encoded && frame.size_px.known() && !(frame.size_px == image.size_px))
    throw badInput(place,
                   fmt::format("has {} x {} pixels instead of the specified {} x {}", image.size_px.width_px,
                               image.size_px.height_px, frame.size_px.width_px, frame.size_px.height_px),
                   "Remove this picture: it is damaged or from another camera");
  if (picture.type() == CV_16UC1) picture = eightBits(picture);
  image.pixels.assign(picture.datastart, picture.dataend);
  return image;
}

void decodeAhead(Frame& frame) {
  if (frame.format == FrameFormat::Gray8) return;
  try {
    GrayImage image = decodeFrame(frame, {});
    frame.format = FrameFormat::Gray8;
    frame.size_px = image.size_px;
    frame.row_bytes = 0;
    frame.bytes = std::move(image.pixels);
  } catch (const CalibrationError&) {
    // reported where the frame is used
  }
}

namespace {

std::string encoded(const Frame& frame, const char* suffix, const std::vector<int>& options) {
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(suffix, viewOf(frame.size_px, CV_8UC1, frame.bytes, frame.row_bytes), bytes, options))
    throw calibrationFailed("frame", std::string("cannot be written as ") + suffix,
                            "Check that OpenCV supports this format");
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::string encodedPng(const Frame& frame) {
  return encoded(frame, ".png", {cv::IMWRITE_PNG_COMPRESSION, 1});
}

std::string encodedJpeg(const Frame& frame, int quality) {
  return encoded(frame, ".jpg", {cv::IMWRITE_JPEG_QUALITY, quality});
}

bool isInside(const GrayImage& image, const Eigen::Vector2d& at_px, double half_width_px) {
  return at_px.x() >= half_width_px && at_px.y() >= half_width_px &&
         at_px.x() <= image.size_px.width_px - 1 - half_width_px &&
         at_px.y() <= image.size_px.height_px - 1 - half_width_px;
}

double brightnessAt(const GrayImage& image, const Eigen::Vector2d& at_px) {
  const int width = image.size_px.width_px;
  const int x = std::clamp(static_cast<int>(at_px.x()), 0, width - 2);
  const int y = std::clamp(static_cast<int>(at_px.y()), 0, image.size_px.height_px - 2);
  const double u = at_px.x() - x, v = at_px.y() - y;
  const std::uint8_t* row = &image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                          static_cast<std::size_t>(x)];
  return (1.0 - v) * ((1.0 - u) * row[0] + u * row[1]) + v * ((1.0 - u) * row[width] + u * row[width + 1]);
}

double noiseSigma(const GrayImage& image) {
  constexpr int kStep = 5;       // a subset of the pixels suffices
  constexpr double kGain = 6.0;  // of the second difference below, on white noise
  constexpr double kOfWholeNumbers = 0.29;
  const int width = image.size_px.width_px, height = image.size_px.height_px;
  std::vector<int> differences;
  for (int y = 1; y + 1 < height; y += kStep) {
    for (int x = 1; x + 1 < width; x += kStep) {
      const std::uint8_t* p = &image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                            static_cast<std::size_t>(x)];
      if (*p == 0 || *p == 255) continue;
      differences.push_back(std::abs(4 * p[0] - 2 * (p[-1] + p[1] + p[-width] + p[width]) + p[-width - 1] +
                                     p[-width + 1] + p[width - 1] + p[width + 1]));
    }
  }
  if (differences.empty()) return kOfWholeNumbers;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return std::max(kOfWholeNumbers, kMadToSigma * *middle / kGain);
}

}  // namespace evical
