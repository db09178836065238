#include "core/intrinsics/intrinsics_checks.h"

#include "core/base/error.h"
#include "core/geometry/sphere_lens.h"
#include "core/numerics/angles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace evical {
namespace {

// The board's normal in a view, pointing into the board, in the camera frame.
Eigen::Vector3d normal(const RigidTransform& camera_from_board) {
  return camera_from_board.rotation * Eigen::Vector3d::UnitZ();
}

double tilt_deg(const Eigen::Vector3d& normal) {
  return kDegPerRad * std::acos(std::clamp(normal.z(), -1.0, 1.0));
}

// Normals of the used views.
std::vector<Eigen::Vector3d> normals(const Bundle& bundle) {
  std::vector<Eigen::Vector3d> all;
  for (std::size_t v = 0; v < bundle.views.size(); ++v) {
    const auto& circles = bundle.views[v].circles;
    if (std::any_of(circles.begin(), circles.end(), [](const SensorCircle& c) { return c.used; }))
      all.push_back(normal(bundle.poses[v]));
  }
  return all;
}

std::string joinedInWords(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  return text;
}

struct Region {
  const char* name;
  int cells = 0, seen = 0;
};

std::array<Region, 9> imageRegions() {
  return {{{"the upper left corner"},
           {"the upper edge"},
           {"the upper right corner"},
           {"the left edge"},
           {"the middle"},
           {"the right edge"},
           {"the lower left corner"},
           {"the lower edge"},
           {"the lower right corner"}}};
}

// Corners and edges are a quarter of the image's width and height.
std::size_t regionAt(double x, double y) {
  const auto third = [](double part) { return part < 0.25 ? 0 : part >= 0.75 ? 2 : 1; };
  return static_cast<std::size_t>(3 * third(y) + third(x));
}

std::array<Region, 9> regionsOf(const ImageMap& image) {
  std::array<Region, 9> regions = imageRegions();
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      Region& region = regions[regionAt((column + 0.5) / image.columns, (row + 0.5) / image.rows)];
      ++region.cells;
      region.seen += image.cells[static_cast<std::size_t>(row * image.columns + column)].circles > 0;
    }
  }
  return regions;
}

// Sides of the image, including corners, without circles.
std::vector<std::string> unseenSides(const ImageMap& image) {
  const std::array<Region, 9> regions = regionsOf(image);
  std::vector<std::string> sides;
  const auto add = [&](const char* side, std::array<std::size_t, 3> parts) {
    if (std::all_of(parts.begin(), parts.end(), [&](std::size_t k) { return regions[k].seen == 0; }))
      sides.emplace_back(side);
  };
  add("left", {0, 3, 6});
  add("right", {2, 5, 8});
  add("upper", {0, 1, 2});
  add("lower", {6, 7, 8});
  return sides;
}

}  // namespace

std::string missingPlaces(const std::vector<SensorView>& views, Resolution resolution_px) {
  std::array<Region, 9> regions = imageRegions();
  for (const SensorView& view : views)
    for (const SensorCircle& circle : view.circles)
      ++regions[regionAt(circle.centre_px.x() / resolution_px.width_px,
                         circle.centre_px.y() / resolution_px.height_px)]
            .seen;
  std::vector<std::string> none;
  for (const Region& region : regions)
    if (region.seen == 0) none.emplace_back(region.name);
  return none.empty() || none.size() == regions.size() ? std::string() : joinedInWords(none);
}

double focalLengthRelativeStd(const CameraIntrinsics& camera, const IntrinsicsMatrix& covariance) {
  double largest = 0.0;
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    IntrinsicsVector by_numbers = IntrinsicsVector::Zero();  // of the logarithm
    by_numbers[axis] = 1.0 / camera.focal_length_px[axis];
    if (hasCentresApart(camera.model)) by_numbers[4] = -1.0 / (1.0 + camera.distortion[0]);
    largest = std::max(largest, by_numbers.dot(covariance * by_numbers));
  }
  return std::sqrt(std::max(largest, 0.0));
}

double largestTilt_deg(const Bundle& bundle) {
  std::vector<double> tilts_deg;
  for (const Eigen::Vector3d& normal : normals(bundle)) tilts_deg.push_back(tilt_deg(normal));
  if (tilts_deg.empty()) return 0.0;
  std::sort(tilts_deg.begin(), tilts_deg.end());
  return tilts_deg[(tilts_deg.size() - 1) * 19 / 20];
}

std::vector<IntrinsicsView> viewsOf(const Bundle& bundle, const Board& board) {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  const std::vector<Eigen::Vector2d> points_m = boardPoints_m(board);
  for (const Eigen::Vector2d& point_m : points_m)
    middle_m.head<2>() += point_m / static_cast<double>(points_m.size());
  std::vector<IntrinsicsView> views;
  for (std::size_t v = 0; v < bundle.views.size(); ++v) {
    IntrinsicsView view;
    double squares = 0.0;
    for (const SensorCircle& circle : bundle.views[v].circles) {
      if (!circle.used) continue;
      ++view.circles;
      squares += bundle.error_px(v, circle).squaredNorm();
    }
    if (view.circles == 0) continue;
    view.time_s = bundle.views[v].time_s;
    view.distance_m = (bundle.poses[v] * middle_m).norm();
    view.tilt_deg = tilt_deg(normal(bundle.poses[v]));
    view.reprojection_rms_px = std::sqrt(squares / view.circles);
    views.push_back(view);
  }
  return views;
}

void checkTilts(const Bundle& bundle, double focal_length_relative_std, const IntrinsicsOptions& options) {
  constexpr double kUseless = 0.05;
  const double largest_deg = largestTilt_deg(bundle);
  if (largest_deg >= options.min_tilt_deg && focal_length_relative_std < kUseless) return;
  throw calibrationFailed(
      "intrinsics",
      fmt::format("the focal length is not observable: its sigma is {:.1f} %, and the board's largest tilt "
                  "relative to the image is {:.0f} deg",
                  100.0 * focal_length_relative_std, largest_deg),
      "Tilt the board by 20 to 40 deg to all four sides");
}

std::vector<std::string> coverageAdvice(const Bundle& bundle, const ImageMap& image) {
  std::vector<std::string> none, few, advice;
  for (const Region& region : regionsOf(image)) {
    if (region.seen == 0) none.push_back(region.name);
    if (region.seen > 0 && 3 * region.seen < region.cells) few.push_back(region.name);
  }
  if (!none.empty())
    advice.push_back(fmt::format("Move the board to {}: no views there", joinedInWords(none)));
  if (!few.empty())
    advice.push_back(
        fmt::format("Move the board more often to {}: hardly any views there", joinedInWords(few)));
  constexpr double kTilted = 0.17;  // sine of 10 deg
  std::vector<std::string> sides;
  const std::vector<Eigen::Vector3d> all = normals(bundle);
  const auto never = [&](int axis, double sign) {
    return std::none_of(all.begin(), all.end(), [&](const auto& n) { return sign * n[axis] > kTilted; });
  };
  if (never(0, 1.0)) sides.emplace_back("right");
  if (never(0, -1.0)) sides.emplace_back("left");
  if (never(1, 1.0)) sides.emplace_back("lower");
  if (never(1, -1.0)) sides.emplace_back("upper");
  if (!sides.empty())
    advice.push_back(
        fmt::format("Tilt the board's {} side towards the camera, which was missing in the recording",
                    joinedInWords(sides)));
  return advice;
}

void judge(bool converged, const IntrinsicsOptions& options, IntrinsicsResult& result) {
  const double focal = focalLengthRelativeStd(result.intrinsics, result.covariance);
  std::vector<std::string> reasons;
  if (!converged) reasons.emplace_back("the bundle adjustment did not converge");
  if (!(focal <= options.needed_focal_length))
    reasons.push_back(fmt::format("the focal length has a large sigma of {:.2f} %", 100.0 * focal));
  if (!(result.image.rms_px <= options.needed_projection_px))
    reasons.push_back(fmt::format("projections have a large sigma of {:.2f} px RMS", result.image.rms_px));
  // Sigmas assume that the model is valid in those parts, which is uncertain for real lenses.
  if (const std::vector<std::string> sides = unseenSides(result.image); !sides.empty())
    reasons.push_back(fmt::format("no views reach the {} {} of the image", joinedInWords(sides),
                                  sides.size() == 1 ? "side" : "sides"));
  if (result.circles_rejected > result.circles_used)
    reasons.emplace_back("most points do not fit (check the board's type, spacing and radius)");
  result.status = reasons.empty() ? CalibrationStatus::Ok : CalibrationStatus::Doubtful;
  result.reason = joinedInWords(reasons);
}

}  // namespace evical
