#include "core/pipeline/rig/tag_corners.h"

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr std::size_t kCorners = 4;

// Calls visit(first corner, middle of the tag) for each whole tag. Corners of a tag have consecutive indices.
template <class View, class Visit>
void forEachTag(View& view, const Visit& visit) {
  auto& circles = view.circles;
  for (std::size_t i = 0; i + kCorners <= circles.size(); ++i) {
    const int first = circles[i].circle;
    if (first % static_cast<int>(kCorners) != 0 || circles[i + kCorners - 1].circle != first + 3) continue;
    Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();
    for (std::size_t k = 0; k < kCorners; ++k) middle_px += circles[i + k].centre_px / 4.0;
    visit(i, middle_px);
  }
}

}  // namespace

TagCornerShift tagCornerShift(const CalibrationInput& input, std::size_t camera,
                              std::span<const CircleResidual> residuals) {
  TagCornerShift shift;
  if (input.boardOf(camera).type != BoardType::AprilGrid) return shift;
  const auto& views = input.cameras[camera].observations.views;
  struct Sum {
    double outwards_px = 0.0;
    int count = 0;
  };
  std::vector<Sum> by_view(views.size());
  std::vector<std::vector<Eigen::Vector2d>> directions(views.size());  // by corner; zero: not of a whole tag
  for (std::size_t v = 0; v < views.size(); ++v) {
    directions[v].assign(static_cast<std::size_t>(input.boardOf(camera).pointCount()),
                         Eigen::Vector2d::Zero());
    forEachTag(views[v], [&](std::size_t first, const Eigen::Vector2d& middle_px) {
      for (std::size_t k = first; k < first + kCorners; ++k) {
        const CircleObservation& corner = views[v].circles[k];
        directions[v][static_cast<std::size_t>(corner.circle)] = (corner.centre_px - middle_px).normalized();
      }
    });
  }
  for (const CircleResidual& residual : residuals) {
    if (residual.camera != static_cast<int>(camera) || !residual.used) continue;
    const auto view = static_cast<std::size_t>(residual.view);
    const Eigen::Vector2d& direction = directions[view][static_cast<std::size_t>(residual.circle)];
    if (direction.isZero()) continue;
    by_view[view].outwards_px += direction.dot(residual.residual_px);
    ++by_view[view].count;
  }
  std::erase_if(by_view, [](const Sum& sum) { return sum.count == 0; });
  if (by_view.size() < 2) return shift;
  const auto count = static_cast<double>(by_view.size());
  double squares = 0.0;
  for (const Sum& sum : by_view) shift.outwards_px += sum.outwards_px / sum.count / count;
  for (const Sum& sum : by_view) squares += std::pow(sum.outwards_px / sum.count - shift.outwards_px, 2);
  shift.sigma_px = std::sqrt(squares / (count * (count - 1.0)));
  return shift;
}

void moveTagCorners(double outwards_px, std::vector<BoardView>& views) {
  for (BoardView& view : views)
    forEachTag(view, [&](std::size_t first, const Eigen::Vector2d& middle_px) {
      for (std::size_t k = first; k < first + kCorners; ++k) {
        Eigen::Vector2d& corner_px = view.circles[k].centre_px;
        corner_px += outwards_px * (corner_px - middle_px).normalized();
      }
    });
}

}  // namespace evical
