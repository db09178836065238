#include "core/frames/saddle_measurement.h"

#include "core/frames/brightness.h"

#include <Eigen/LU>

#include <cmath>
#include <numbers>

namespace evical {
namespace {

constexpr double kReach = 3.0;  // radius of the smoothing, in its sigmas

struct Slope {
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d bend = Eigen::Matrix2d::Zero();
};

// First and second derivatives of the smoothed brightness.
Slope slopeAt(const GrayImage& image, const Eigen::Vector2d& at, double sigma) {
  const int reach = static_cast<int>(std::ceil(kReach * sigma)), width = image.size_px.width_px;
  const auto left = static_cast<int>(std::floor(at.x())) - reach,
             top = static_cast<int>(std::floor(at.y())) - reach;
  const auto forEach = [&](const auto& visit) {
    for (int y = top; y <= top + 2 * reach + 1; ++y)
      for (int x = left; x <= left + 2 * reach + 1; ++x) {
        const Eigen::Vector2d d = (Eigen::Vector2d(x, y) - at) / sigma;
        visit(d, std::exp(-0.5 * d.squaredNorm()),
              static_cast<double>(image.pixels[static_cast<std::size_t>(y * width + x)]));
      }
  };
  double weights = 0.0, mean = 0.0;
  forEach([&](const Eigen::Vector2d&, double weight, double brightness) {
    weights += weight;
    mean += weight * brightness;
  });
  mean /= weights;
  Slope slope;
  forEach([&](const Eigen::Vector2d& d, double weight, double brightness) {
    const double part = weight * (brightness - mean) / weights;
    slope.gradient += part / sigma * d;
    slope.bend += part / (sigma * sigma) * (d * d.transpose() - Eigen::Matrix2d::Identity());
  });
  return slope;
}

}  // namespace

std::optional<MeasuredCorner> measureSaddle(const GrayImage& image, const Eigen::Vector2d& start_px,
                                            double sigma_px, double reach_px, double noise_sigma,
                                            double correlated_px) {
  constexpr int kMaxIterations = 12;
  constexpr double kSettled = 1e-3;  // relative to the smoothing's sigma
  Eigen::Vector2d at = start_px;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    if (!isInside(image, at, kReach * sigma_px + 2.0)) return std::nullopt;
    const Slope slope = slopeAt(image, at, sigma_px);
    if (!(slope.bend.determinant() < 0.0)) return std::nullopt;
    const Eigen::Matrix2d inverse = slope.bend.inverse();
    const Eigen::Vector2d step = -inverse * slope.gradient;
    at += step;
    if (!((at - start_px).norm() <= reach_px)) return std::nullopt;
    if (step.norm() > kSettled * sigma_px) continue;
    // Variance of a gradient along either axis for white noise of pixels of this size.
    const double variance =
        std::pow(noise_sigma * correlated_px, 2) / (8.0 * std::numbers::pi * std::pow(sigma_px, 4));
    return MeasuredCorner{at, variance * inverse * inverse.transpose()};
  }
  return std::nullopt;
}

}  // namespace evical
