#include "core/synthetic/clutter_texture.h"

#include "core/synthetic/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace evical {
namespace {

constexpr double kMeanLogReflectance = -1.2;
constexpr double kDarkest = 0.03, kBrightest = 0.95;

// A square periodic image.
struct Image {
  explicit Image(int size_texels)
      : size(size_texels), values(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), 0.0f) {}
  float& at(int x, int y) {
    return values[static_cast<std::size_t>((y & (size - 1)) * size + (x & (size - 1)))];
  }
  int size;
  std::vector<float> values;
};

// One pass of a kernel over the rows, the result transposed: twice makes a two-dimensional filter.
void filterRows(Image& image, const std::vector<float>& kernel) {
  const int reach = static_cast<int>(kernel.size() / 2);
  Image result(image.size);
  for (int y = 0; y < image.size; ++y) {
    for (int x = 0; x < image.size; ++x) {
      float sum = 0.0f;
      for (int d = -reach; d <= reach; ++d)
        sum += kernel[static_cast<std::size_t>(d + reach)] * image.at(x + d, y);
      result.at(y, x) = sum;
    }
  }
  image = std::move(result);
}

// Box of 2 radius + 1 texels by running sums, rows only, transposed.
void boxRows(Image& image, int radius) {
  Image result(image.size);
  for (int y = 0; y < image.size; ++y) {
    double sum = 0.0;
    for (int x = -radius; x <= radius; ++x) sum += image.at(x, y);
    for (int x = 0; x < image.size; ++x) {
      result.at(y, x) = static_cast<float>(sum);
      sum += image.at(x + radius + 1, y) - image.at(x - radius, y);
    }
  }
  image = std::move(result);
}

void normalise(Image& image) {
  double sum = 0.0, squares = 0.0;
  for (const float v : image.values) {
    sum += v;
    squares += static_cast<double>(v) * v;
  }
  const auto n = static_cast<double>(image.values.size());
  const double mean = sum / n, sigma = std::sqrt(std::max(squares / n - mean * mean, 1e-12));
  for (float& v : image.values) v = static_cast<float>((v - mean) / sigma);
}

// Clouds with the same variance in every octave, like pictures of natural scenes.
Image clouds(int size, Random& random) {
  Image sum(size), white(size);
  for (float& v : white.values) v = static_cast<float>(random.normal());
  for (const int radius : {4, 8, 16, 32, 64}) {
    Image octave(size);  // from the same noise, shifted
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) octave.at(x, y) = white.at(x + 97 * radius, y + 61 * radius);
    for (int round = 0; round < 6; ++round) boxRows(octave, radius);
    normalise(octave);
    for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += octave.values[i];
  }
  normalise(sum);
  return sum;
}

void addDisc(Image& image, Random& random) {
  constexpr double kSmallest = 4.0, kLargest = 14.0;  // radii: those of circles on boards in usual recordings
  const double radius = kSmallest + (kLargest - kSmallest) * random.uniform();
  const double x0 = image.size * random.uniform(), y0 = image.size * random.uniform();
  const auto value = static_cast<float>(random.normal());
  const int reach = static_cast<int>(radius) + 1;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx)
      if (std::hypot(dx, dy) <= radius)
        image.at(static_cast<int>(x0) + dx, static_cast<int>(y0) + dy) = value;
}

// Overlapping rectangles, small ones more numerous (a dead-leaves picture), and discs.
Image objects(int size, double round_share, Random& random) {
  constexpr int kObjects = 1200;
  constexpr double kSmallest = 6.0, kLargest = 110.0;  // half sides
  Image image(size);
  for (int k = 0; k < kObjects; ++k) {
    if (round_share > 0.0 && random.uniform() < round_share) {
      addDisc(image, random);
      continue;
    }
    const double half_length =
        kSmallest / std::sqrt(1.0 - random.uniform() * (1.0 - std::pow(kSmallest / kLargest, 2)));
    const double half_width = half_length * (0.3 + 0.7 * random.uniform());
    const double angle = std::numbers::pi * random.uniform(), c = std::cos(angle), s = std::sin(angle);
    const double x0 = size * random.uniform(), y0 = size * random.uniform();
    const auto value = static_cast<float>(random.normal());
    const int reach = static_cast<int>(std::hypot(half_length, half_width)) + 1;
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        if (std::abs(c * dx + s * dy) > half_length || std::abs(c * dy - s * dx) > half_width) continue;
        image.at(static_cast<int>(x0) + dx, static_cast<int>(y0) + dy) = value;
      }
    }
  }
  normalise(image);
  return image;
}

// Checkerboards and tiles, all upright: the worst that can be behind a board of squares.
void addCheckerboards(Image& image, double side_texels, Random& random) {
  constexpr int kBoards = 40, kRows = 7, kColumns = 10;
  constexpr float kContrast = 1.5f;
  for (int board = 0; board < kBoards; ++board) {
    const int x0 = static_cast<int>(image.size * random.uniform()),
              y0 = static_cast<int>(image.size * random.uniform());
    for (int y = 0; y < kRows * side_texels; ++y)
      for (int x = 0; x < kColumns * side_texels; ++x) {
        const bool dark = (static_cast<int>(x / side_texels) + static_cast<int>(y / side_texels)) % 2 == 0;
        image.at(x0 + x, y0 + y) = dark ? -kContrast : kContrast;
      }
  }
}

void blur(Image& image, double sigma_texels) {
  const int reach = static_cast<int>(std::ceil(3.0 * sigma_texels));
  std::vector<float> kernel;
  float sum = 0.0f;
  for (int d = -reach; d <= reach; ++d) {
    kernel.push_back(static_cast<float>(std::exp(-0.5 * d * d / (sigma_texels * sigma_texels))));
    sum += kernel.back();
  }
  for (float& k : kernel) k /= sum;
  filterRows(image, kernel);
  filterRows(image, kernel);
}

}  // namespace

ClutterTexture::ClutterTexture(const ClutterTextureOptions& options) {
  if (options.contrast <= 0.0) {
    texels_.assign(static_cast<std::size_t>(kSize) * kStride, static_cast<float>(kMeanLogReflectance));
    return;
  }
  constexpr std::uint64_t kStream = 0xc1u;
  Random random(options.seed, kStream);
  Image cloudy = clouds(kSize, random);
  Image flat = objects(kSize, options.round_share, random);
  if (options.square_texels > 0.0) addCheckerboards(flat, options.square_texels, random);
  const double object_weight = options.contrast * std::sqrt(options.object_share),
               cloud_weight = options.contrast * std::sqrt(1.0 - options.object_share);
  for (std::size_t i = 0; i < flat.values.size(); ++i) {
    const double log_reflectance =
        kMeanLogReflectance + object_weight * flat.values[i] + cloud_weight * cloudy.values[i];
    flat.values[i] = static_cast<float>(std::clamp(std::exp(log_reflectance), kDarkest, kBrightest));
  }
  if (options.blur_texels > 0.05) blur(flat, options.blur_texels);
  takeLog(flat.values);
}

ClutterTexture::ClutterTexture(const ClutterTexture& sharper, double blur_texels) {
  Image image(kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      image.at(x, y) = std::exp(sharper.texels_[static_cast<std::size_t>(y * kStride + x)]);
  blur(image, blur_texels);
  takeLog(image.values);
}

void ClutterTexture::takeLog(const std::vector<float>& reflectance) {
  texels_.reserve(static_cast<std::size_t>(kSize) * kStride);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kStride; ++x)
      texels_.push_back(std::log(reflectance[static_cast<std::size_t>(y * kSize + (x & (kSize - 1)))]));
}

}  // namespace evical
