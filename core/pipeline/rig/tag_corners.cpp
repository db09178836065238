#include "core/pipeline/rig/tag_corners.h"

#include <cmath>
#include <map>

namespace evical {
namespace {

constexpr std::size_t kCorners = 4;

// Calls visit(corners, middle of the tag) for each whole tag of one view. Corners of a tag have consecutive
// indices.
template <class Corner, class Visit>
void forEachTag(std::span<Corner> corners, const Visit& visit) {
  for (std::size_t i = 0; i + kCorners <= corners.size(); ++i) {
    const int first = corners[i].circle;
    if (first % static_cast<int>(kCorners) != 0 || corners[i + kCorners - 1].circle != first + 3) continue;
    Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();
    for (std::size_t k = 0; k < kCorners; ++k) middle_px += corners[i + k].centre_px / 4.0;
    visit(corners.subspan(i, kCorners), middle_px);
  }
}

struct Mean {
  double sum_px = 0.0;
  int count = 0;

  double mean_px() const { return sum_px / count; }
};

}  // namespace

TagCornerShift tagCornerShift(std::size_t camera, std::span<const CircleResidual> residuals) {
  std::map<int, Mean> by_view;
  const auto of_camera = static_cast<int>(camera);
  for (std::size_t begin = 0, end = 0; begin < residuals.size(); begin = end) {
    const int view = residuals[begin].view;
    const bool is_of_camera = residuals[begin].camera == of_camera;
    while (end < residuals.size() && residuals[end].camera == residuals[begin].camera &&
           residuals[end].view == view)
      ++end;
    if (!is_of_camera) continue;
    forEachTag(residuals.subspan(begin, end - begin), [&](auto corners, const Eigen::Vector2d& middle_px) {
      for (const CircleResidual& corner : corners) {
        if (!corner.used) continue;
        Mean& mean = by_view[view];
        mean.sum_px += (corner.centre_px - middle_px).normalized().dot(corner.residual_px);
        ++mean.count;
      }
    });
  }
  TagCornerShift shift;
  if (by_view.size() < 2) return shift;
  const auto count = static_cast<double>(by_view.size());
  double squares = 0.0;
  for (const auto& [view, mean] : by_view) shift.outwards_px += mean.mean_px() / count;
  for (const auto& [view, mean] : by_view) squares += std::pow(mean.mean_px() - shift.outwards_px, 2);
  shift.sigma_px = std::sqrt(squares / (count * (count - 1.0)));
  return shift;
}

void moveTagCorners(double outwards_px, std::vector<BoardView>& views) {
  for (BoardView& view : views)
    forEachTag(std::span(view.circles), [&](auto corners, const Eigen::Vector2d& middle_px) {
      for (CircleObservation& corner : corners)
        corner.centre_px += outwards_px * (corner.centre_px - middle_px).normalized();
    });
}

}  // namespace evical
