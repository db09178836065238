#include "core/intrinsics/view_selection.h"

#include "core/intrinsics/board_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace evical {
namespace {

constexpr int kColumns = 8, kRows = 6;
constexpr int kTiltSteps = 5;         // along each axis of the board's normal in the image
constexpr double kWidestTilt = 0.75;  // largest component of the normal in the image, to either side
constexpr double kTiltWeight = 0.5;   // weight of a new tilt relative to a view with only new cells

std::size_t step(double value, double low, double high, int count) {
  const int index = static_cast<int>(std::floor((value - low) / (high - low) * count));
  return static_cast<std::size_t>(std::clamp(index, 0, count - 1));
}

struct Candidate {
  const SensorView* view = nullptr;
  std::vector<std::size_t> cells;  // one per circle
  std::size_t tilt = 0;
  bool taken = false, too_near = false;
};

std::vector<Candidate> candidatesOf(const std::vector<SensorView>& views, const Board& board,
                                    const CameraIntrinsics& camera) {
  std::vector<Candidate> candidates;
  for (const SensorView& view : views) {
    const auto pose = boardPose(view, board, camera);
    if (!pose) continue;
    Candidate& candidate = candidates.emplace_back();
    candidate.view = &view;
    const Eigen::Vector3d normal = pose->rotation * Eigen::Vector3d::UnitZ();
    candidate.tilt = step(normal.y(), -kWidestTilt, kWidestTilt, kTiltSteps) * kTiltSteps +
                     step(normal.x(), -kWidestTilt, kWidestTilt, kTiltSteps);
    for (const SensorCircle& circle : view.circles)
      candidate.cells.push_back(step(circle.centre_px.y(), 0.0, camera.resolution_px.height_px, kRows) *
                                    kColumns +
                                step(circle.centre_px.x(), 0.0, camera.resolution_px.width_px, kColumns));
  }
  return candidates;
}

}  // namespace

std::vector<SensorView> selectViews(const std::vector<SensorView>& views, const Board& board,
                                    const CameraIntrinsics& camera, const IntrinsicsOptions& options) {
  std::vector<Candidate> candidates = candidatesOf(views, board, camera);
  std::array<int, kColumns* kRows> in_cell = {};
  std::array<int, kTiltSteps* kTiltSteps> of_tilt = {};
  // Gain of a view: circles in rarely covered cells, and a rare tilt.
  const auto gain = [&](const Candidate& candidate) {
    double sum = 0.0;
    for (const std::size_t cell : candidate.cells) sum += 1.0 / (1.0 + in_cell[cell]);
    const double full = kTiltWeight * board.pointCount();
    return sum + full / (1.0 + of_tilt[candidate.tilt]);
  };
  std::vector<SensorView> selected;
  while (static_cast<int>(selected.size()) < options.most_views) {
    Candidate* best = nullptr;
    double most = 0.0;
    for (Candidate& candidate : candidates) {
      if (candidate.taken || candidate.too_near) continue;
      if (const double value = gain(candidate); value > most) {
        most = value;
        best = &candidate;
      }
    }
    if (best == nullptr) break;
    best->taken = true;
    selected.push_back(*best->view);
    for (const std::size_t cell : best->cells) ++in_cell[cell];
    ++of_tilt[best->tilt];
    for (Candidate& candidate : candidates)
      candidate.too_near = candidate.too_near || std::abs(candidate.view->time_s - best->view->time_s) <
                                                     options.least_view_spacing_s;
  }
  std::sort(selected.begin(), selected.end(),
            [](const SensorView& a, const SensorView& b) { return a.time_s < b.time_s; });
  return selected;
}

}  // namespace evical
