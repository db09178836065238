#include "core/frames/brightness.h"

#include "core/numerics/robust.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace evical {

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
