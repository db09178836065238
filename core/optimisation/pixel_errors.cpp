#include "core/optimisation/pixel_errors.h"

#include <algorithm>
#include <cmath>

namespace evical {

PixelErrors::PixelErrors(const CameraData& camera, const Board& board, double pixel_error_px)
    : mean_px_(static_cast<std::size_t>(board.pointCount()), Eigen::Vector2d::Zero()) {
  std::vector<double> counts(mean_px_.size(), 0.0);
  const auto forEach = [&](auto&& visit) {
    for (const BoardView& view : camera.observations.views)
      for (const CircleObservation& circle : view.circles)
        visit(static_cast<std::size_t>(circle.circle), circle);
  };
  forEach([&](std::size_t i, const CircleObservation& circle) {
    mean_px_[i] += (circle.centre_px - mean_px_[i]) / ++counts[i];
  });
  double sum_px2 = 0.0, count = 0.0;
  forEach([&](std::size_t i, const CircleObservation& circle) {
    sum_px2 += (circle.centre_px - mean_px_[i]).squaredNorm();
    count += 1.0;
  });
  constexpr double kOnePixel = 1.0;  // fewer are not crossed
  const double amplitude_px = std::max(kOnePixel, std::sqrt(sum_px2 / std::max(1.0, count)));
  swing_ = pixel_error_px / (amplitude_px * std::sqrt(amplitude_px));
}

Eigen::Vector2d PixelErrors::at(const CircleObservation& circle) const {
  return swing_ * (circle.centre_px - mean_px_[static_cast<std::size_t>(circle.circle)]);
}

}  // namespace evical
