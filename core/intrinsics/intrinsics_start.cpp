#include "core/intrinsics/intrinsics_start.h"

#include "core/intrinsics/sensor_views.h"

#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/lens_fit.h"
#include "core/geometry/projection_difference.h"
#include "core/numerics/angles.h"
#include "core/numerics/robust.h"

#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace evical {
namespace {

CameraIntrinsics plain(CameraModel model, Resolution resolution_px) {
  CameraIntrinsics camera;
  camera.model = model;
  camera.resolution_px = resolution_px;
  camera.focal_length_px.setConstant(0.8 * std::max(resolution_px.width_px, resolution_px.height_px));
  camera.principal_point_px = 0.5 * Eigen::Vector2d(resolution_px.width_px - 1, resolution_px.height_px - 1);
  return camera;
}

std::optional<CameraIntrinsics> byOpenCv(const std::vector<SensorView>& views, Resolution resolution_px) {
  constexpr std::size_t kMaxViews = 30;
  const std::size_t every = views.size() / kMaxViews + 1;
  std::vector<std::vector<cv::Point3f>> on_board;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (std::size_t v = 0; v < views.size(); v += every) {
    auto& points = on_board.emplace_back();
    auto& images = pixels.emplace_back();
    for (const SensorCircle& circle : views[v].circles) {
      points.emplace_back(static_cast<float>(circle.on_board_m.x()),
                          static_cast<float>(circle.on_board_m.y()), 0.0f);
      images.emplace_back(static_cast<float>(circle.centre_px.x()), static_cast<float>(circle.centre_px.y()));
    }
  }
  try {
    cv::Mat matrix, distortion;
    std::vector<cv::Mat> rotations, translations;
    // LU: with the default, a singular value decomposition, the tests of wide lenses took three times as
    // long.
    cv::calibrateCamera(on_board, pixels, {resolution_px.width_px, resolution_px.height_px}, matrix,
                        distortion, rotations, translations,
                        cv::CALIB_ZERO_TANGENT_DIST | cv::CALIB_FIX_K3 | cv::CALIB_USE_LU);
    CameraIntrinsics camera = plain(CameraModel::PinholeRadtan, resolution_px);
    camera.focal_length_px = {matrix.at<double>(0, 0), matrix.at<double>(1, 1)};
    camera.principal_point_px = {matrix.at<double>(0, 2), matrix.at<double>(1, 2)};
    camera.distortion = {distortion.at<double>(0), distortion.at<double>(1), 0.0, 0.0, 0.0};
    const bool sane = camera.focal_length_px.allFinite() && camera.focal_length_px.minCoeff() > 1.0;
    return sane ? std::optional(camera) : std::nullopt;
  } catch (const cv::Exception&) {
    return std::nullopt;  // views that do not determine a camera; the other start values remain
  }
}

// Lenses without distortion, with the focal lengths of stereographic lenses that have these angles at the
// image's corners.
std::vector<CameraIntrinsics> wideGuesses(CameraModel model, Resolution resolution_px) {
  const double corner_px = 0.5 * std::hypot(resolution_px.width_px, resolution_px.height_px);
  std::vector<CameraIntrinsics> guesses;
  for (const double angle_deg : {50.0, 75.0, 100.0}) {
    CameraIntrinsics camera = plain(CameraModel::PinholeRadtan, resolution_px);
    camera.focal_length_px.setConstant(0.5 * corner_px / std::tan(0.5 * kRadPerDeg * angle_deg));
    guesses.push_back(plainLens(camera, model));
  }
  return guesses;
}

// Median error of circles for the camera and the board's best pose, in some views; infinite for circles that
// it does not see.
double startError_px(const CameraIntrinsics& camera, const std::vector<SensorView>& views,
                     const Board& board) {
  constexpr std::size_t kMaxViews = 20;
  std::vector<double> errors_px;
  for (std::size_t v = 0; v < views.size(); v += views.size() / kMaxViews + 1) {
    const auto pose = boardPose(views[v], board, camera);
    for (const SensorCircle& circle : views[v].circles) {
      const Eigen::Vector3d on_board(circle.on_board_m.x(), circle.on_board_m.y(), 0.0);
      const auto pixel = pose ? project(camera, *pose * on_board) : std::nullopt;
      errors_px.push_back(pixel ? (*pixel - circle.centre_px).norm()
                                : std::numeric_limits<double>::infinity());
    }
  }
  return medianOf(std::move(errors_px), std::numeric_limits<double>::infinity());
}

// Nearest first.
void sortByError(const std::vector<SensorView>& views, const Board& board,
                 std::vector<CameraIntrinsics>& starts) {
  std::vector<std::pair<double, CameraIntrinsics>> sorted;
  for (const CameraIntrinsics& start : starts) sorted.emplace_back(startError_px(start, views, board), start);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t k = 0; k < starts.size(); ++k) starts[k] = sorted[k].second;
}

}  // namespace

CameraIntrinsics sameLens(const CameraIntrinsics& camera, CameraModel model) {
  if (camera.model == model) return camera;
  return fitLens(camera, model, model == CameraModel::PinholeRadtan ? 4 : coefficientCount(model)).camera;
}

CameraIntrinsics otherSide(const CameraIntrinsics& sphere) {
  constexpr double kXi = 0.2, kStep = 0.01;
  const double xi = sphere.distortion[0] < 0.0 ? kXi : -kXi;
  CameraIntrinsics nearest = sphere, side = sphere;
  side.focal_length_px = (1.0 + xi) * idealFocalLength_px(sphere);
  double min_px = std::numeric_limits<double>::infinity();
  for (double alpha = 0.3; alpha < 0.95; alpha += kStep) {
    side.distortion = {xi, alpha, 0.0, 0.0, 0.0};
    const ProjectionDifference difference = projectionDifference(sphere, side);
    if (difference.places == 0 || difference.rms_px >= min_px) continue;
    min_px = difference.rms_px;
    nearest = side;
  }
  return nearest;
}

std::vector<CameraIntrinsics> intrinsicsStarts(const std::vector<SensorView>& views, const Board& board,
                                               CameraModel model, Resolution resolution_px,
                                               const std::optional<CameraIntrinsics>& detection_intrinsics) {
  std::vector<CameraIntrinsics> starts;
  if (detection_intrinsics) starts.push_back(sameLens(*detection_intrinsics, model));
  // A lens without distortion is a guess, which may lead to another minimum.
  const bool guessed =
      !detection_intrinsics || detection_intrinsics->distortion == CameraIntrinsics{}.distortion;
  const auto camera = guessed ? byOpenCv(views, resolution_px) : std::nullopt;
  if (camera) starts.push_back(sameLens(*camera, model));
  // Even a start that is nearly right is not enough: it can make most errors so small that all views with
  // larger first errors are rejected, and never return.
  if (model != CameraModel::PinholeRadtan) {
    for (const CameraIntrinsics& guess : wideGuesses(model, resolution_px)) starts.push_back(guess);
    sortByError(views, board, starts);
    constexpr std::size_t kTried = 2;
    starts.resize(kTried);
  }
  if (starts.empty()) starts.push_back(plain(model, resolution_px));
  return starts;
}

CameraIntrinsics roughStart(const std::vector<SensorView>& views, const Board& board,
                            Resolution resolution_px,
                            const std::optional<CameraIntrinsics>& detection_intrinsics) {
  constexpr double kGood_px = 1.0, kClearlyBetter = 0.3;
  const CameraIntrinsics pinhole =
      intrinsicsStarts(views, board, CameraModel::PinholeRadtan, resolution_px, detection_intrinsics).back();
  const double error_px = startError_px(pinhole, views, board);
  if (error_px < kGood_px) return pinhole;
  const CameraIntrinsics wide =
      intrinsicsStarts(views, board, CameraModel::DoubleSphere, resolution_px, detection_intrinsics).front();
  return startError_px(wide, views, board) < kClearlyBetter * error_px ? wide : pinhole;
}

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
  while (static_cast<int>(selected.size()) < options.max_views) {
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
      candidate.too_near = candidate.too_near ||
                           std::abs(candidate.view->time_s - best->view->time_s) < options.min_view_spacing_s;
  }
  std::sort(selected.begin(), selected.end(),
            [](const SensorView& a, const SensorView& b) { return a.time_s < b.time_s; });
  return selected;
}

}  // namespace evical
