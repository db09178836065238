#include "core/pipeline/lens/lens_comparison.h"

#include "core/base/error.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/projection_difference.h"
#include "core/intrinsics/intrinsics_uncertainty.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

std::array<LensComparison::Number, kIntrinsicsCount> compareNumbers(
    const IntrinsicsResult& found, const CameraIntrinsics& other, const IntrinsicsMatrix& other_covariance) {
  std::array<double, kIntrinsicsCount> ours{}, theirs{};
  writeIntrinsics(found.intrinsics, ours.data());
  writeIntrinsics(other, theirs.data());
  std::array<LensComparison::Number, kIntrinsicsCount> numbers;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    numbers[k] = {ours[k] - theirs[k],
                  std::sqrt(std::max(0.0, found.covariance(i, i) + other_covariance(i, i)))};
  }
  return numbers;
}

}  // namespace

LensComparison compareLenses(const IntrinsicsResult& found, const KnownIntrinsics& known) {
  const Resolution size_px = found.intrinsics.resolution_px;
  CameraIntrinsics other = known.camera;
  if (!other.resolution_px.known()) other.resolution_px = size_px;
  if (other.resolution_px != size_px)
    throw badInput(
        "the other lens",
        fmt::format("is for images of {} x {} px, but this one for {} x {} px", other.resolution_px.width_px,
                    other.resolution_px.height_px, size_px.width_px, size_px.height_px),
        "Compare with a lens of the same camera in the same mode");
  const IntrinsicsMatrix other_covariance =
      known.uncertainty ? known.uncertainty->covariance() : IntrinsicsMatrix::Zero();
  LensComparison out;
  if (other.model == found.intrinsics.model) out.numbers = compareNumbers(found, other, other_covariance);
  out.columns = found.image.columns;
  out.rows = found.image.rows;
  const auto differences_px = projectionDifferences(found.intrinsics, other, out.columns, out.rows);
  ImageMap other_map = found.image;
  setSigmas(other, other_covariance, other_map);
  double squares_px2 = 0.0, squares = 0.0;
  int seen = 0;
  for (std::size_t k = 0; k < differences_px.size(); ++k) {
    LensComparison::Place& place = out.places.emplace_back();
    place.sigma_px = std::hypot(found.image.cells[k].sigma_px, other_map.cells[k].sigma_px);
    if (!differences_px[k]) continue;
    place.difference_px = differences_px[k]->norm();
    squares_px2 += std::pow(*place.difference_px, 2);
    if (place.sigma_px > 0.0) squares += std::pow(*place.difference_px / place.sigma_px, 2);
    out.max_px = std::max(out.max_px, *place.difference_px);
    ++seen;
  }
  if (seen == 0)
    throw badInput("the other lens", "has no common field of view with this one",
                   "Check that it belongs to this camera, and check its focal length and principal point");
  out.rms_px = std::sqrt(squares_px2 / seen);
  out.rms_sigmas = std::sqrt(squares / seen);
  return out;
}

}  // namespace evical
