#include "core/egomotion/rotation_alignment.h"

#include "core/egomotion/alignment_fit.h"
#include "core/egomotion/alignment_start.h"
#include "core/egomotion/summed_rates.h"
#include "core/geometry/so3.h"
#include "core/numerics/dense.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace evical {
namespace {

// Used windows whose time the gyroscope covers, with what the offset may yet move.
std::vector<const WindowMotion*> coveredWindows(std::vector<WindowMotion>& windows, const SummedRates& rates,
                                                double offset_s) {
  constexpr double kMargin_s = 0.05;
  std::vector<const WindowMotion*> covered;
  for (WindowMotion& window : windows) {
    if (window.use != WindowUse::Used) continue;
    const double from_s = window.begin_s + offset_s, to_s = window.end_s + offset_s;
    if (rates.covers(from_s - kMargin_s, to_s + kMargin_s)) {
      covered.push_back(&window);
    } else {
      window.use = WindowUse::NoGyroscope;
    }
  }
  return covered;
}

// The delete-a-block jackknife, to first order: what each block moves the estimate by. With few blocks their scatter is
// itself uncertain, as Student's distribution says.
std::optional<AlignmentMatrix> blockCovariance(const AlignmentFit& fit, const AlignmentState& state,
                                               const EgomotionOptions& options, int& blocks) {
  const AlignmentFit::Part all = fit.partOf(state, 0, fit.windowCount());
  std::vector<AlignmentVector> moves;
  for (std::size_t first = 0; first < fit.windowCount();) {
    const double block = std::floor(fit.window(first).middle_s() / options.block_s);
    std::size_t end = first;
    while (end < fit.windowCount() && std::floor(fit.window(end).middle_s() / options.block_s) == block)
      ++end;
    const AlignmentFit::Part part = fit.partOf(state, first, end);
    moves.push_back((all.normal - part.normal).ldlt().solve(part.gradient));
    first = end;
  }
  blocks = static_cast<int>(moves.size());
  if (blocks < options.least_blocks) return std::nullopt;
  AlignmentVector mean = AlignmentVector::Zero();
  for (const AlignmentVector& move : moves) mean += move / static_cast<double>(blocks);
  AlignmentMatrix sum = AlignmentMatrix::Zero();
  for (const AlignmentVector& move : moves) sum += (move - mean) * (move - mean).transpose();
  const double n = blocks, student = (n - 1.0) / (n - 3.0 + 0.5);
  const AlignmentMatrix covariance = student * (n - 1.0) / n * sum;
  if (!covariance.allFinite()) return std::nullopt;
  return covariance;
}

// The numbers where translation is not taken out, less those where it is.
std::optional<Eigen::Vector4d> shiftByTranslation(const std::vector<WindowMotion>& windows,
                                                  const SummedRates& rates,
                                                  const Eigen::Matrix3d& gyroscope_matrix,
                                                  const AlignmentState& state) {
  std::vector<WindowMotion> alone = windows;
  for (WindowMotion& window : alone) window.rate_rad_s = window.turning_alone_rad_s;
  AlignmentFit fit(coveredWindows(alone, rates, state.time_offset_s), rates, gyroscope_matrix);
  AlignmentState there = state;
  if (!fit.solve(there)) return std::nullopt;
  Eigen::Vector4d shift;
  shift.head<3>() = so3Log(there.imu_from_camera * state.imu_from_camera.transpose());
  shift[3] = there.time_offset_s - state.time_offset_s;
  return shift;
}

void markOutOfLine(const AlignmentFit& fit, std::vector<WindowMotion>& windows) {
  constexpr double kFar = 36.0;  // chance leaves one of some ten million windows above
  for (std::size_t k = 0; k < fit.windowCount(); ++k) {
    if (fit.squares()[k] <= kFar) continue;
    const auto place = static_cast<std::size_t>(&fit.window(k) - windows.data());
    windows[place].use = WindowUse::OutOfLine;
  }
}

RotationAlignment failed(std::string reason) {
  RotationAlignment out;
  out.failure = std::move(reason);
  return out;
}

std::optional<AlignmentState> bestSolution(const std::vector<const WindowMotion*>& windows,
                                           const SummedRates& rates, const Eigen::Matrix3d& gyroscope_matrix,
                                           const AlignmentState& start, double search_s) {
  AlignmentFit fit(windows, rates, gyroscope_matrix);
  std::optional<AlignmentState> best;
  double least = std::numeric_limits<double>::infinity();
  for (AlignmentState state : alignmentStarts(windows, fit, rates, start, search_s)) {
    if (!fit.solve(state) || std::abs(state.time_offset_s - start.time_offset_s) > search_s + 0.01) continue;
    if (fit.medianError_rad_s() >= least) continue;
    least = fit.medianError_rad_s();
    best = state;
  }
  return best;
}

void describe(const AlignmentFit& fit, const AlignmentState& state, RotationAlignment& out) {
  double rates = 0.0, misfits = 0.0;
  for (std::size_t k = 0; k < fit.windowCount(); ++k) {
    const Eigen::Vector3d expected =
        state.scale * state.imu_from_camera.transpose() * fit.imuRate_rad_s(fit.window(k), state);
    rates += expected.squaredNorm();
    if (fit.squares()[k] < 36.0) misfits += (expected - fit.window(k).rate_rad_s).squaredNorm();
  }
  const double n = static_cast<double>(std::max<std::size_t>(1, fit.windowCount()));
  out.rate_rms_rad_s = std::sqrt(rates / n);
  out.misfit_rms_rad_s = std::sqrt(misfits / n);
}

}  // namespace

RotationAlignment alignRotation(std::vector<WindowMotion>& windows, const GyroscopeRecord& gyroscope,
                                const AlignmentStart& start, const EgomotionOptions& options) {
  const SummedRates rates(gyroscope.samples, gyroscope.start_ns);
  const Eigen::Matrix3d matrix = gyroscope.imu.gyroscopeMatrix();
  AlignmentState state{start.imu_from_camera.toRotationMatrix(), start.time_offset_s,
                       gyroscope.imu.gyroscope_bias_rad_s, 1.0};
  std::vector<const WindowMotion*> used;
  for (const WindowMotion& window : windows)
    if (window.use == WindowUse::Used) used.push_back(&window);
  if (used.size() < static_cast<std::size_t>(kAlignmentNumbers))
    return failed("too few windows tell how the camera turns");
  // Those at the ends are lost to whatever the offset may be; only then the solution asks for all.
  std::vector<WindowMotion> searched = windows;
  std::vector<const WindowMotion*> inside = coveredWindows(searched, rates, start.time_offset_s);
  std::erase_if(inside, [&](const WindowMotion* window) {
    return !rates.covers(window->begin_s + start.time_offset_s - options.search_s,
                         window->end_s + start.time_offset_s + options.search_s);
  });
  if (inside.size() < static_cast<std::size_t>(kAlignmentNumbers))
    return failed("camera and gyroscope have too little time in common");
  const std::optional<AlignmentState> found = bestSolution(inside, rates, matrix, state, options.search_s);
  if (!found) return failed("no rotation and no time offset makes the camera turn as the gyroscope does");
  state = *found;
  AlignmentFit fit(coveredWindows(windows, rates, state.time_offset_s), rates, matrix);
  if (!fit.solve(state))
    return failed("no rotation and no time offset makes the camera turn as the gyroscope does");
  RotationAlignment out;
  const std::optional<AlignmentMatrix> covariance = blockCovariance(fit, state, options, out.blocks);
  const std::optional<Eigen::Vector4d> shift = shiftByTranslation(windows, rates, matrix, state);
  markOutOfLine(fit, windows);
  if (!covariance) return failed("too little of the recording tells how the camera turns");
  if (!shift) return failed("what translation does to the image cannot be told from rotation");
  out.turning_alone = *shift;
  out.imu_from_camera = Eigen::Quaterniond(state.imu_from_camera).normalized();
  out.time_offset_s = state.time_offset_s;
  out.gyroscope_bias_rad_s = state.bias_rad_s;
  out.scale = state.scale;
  const Eigen::Vector4d left = options.translation_left * out.turning_alone;
  out.covariance = covariance->topLeftCorner<4, 4>() + left * left.transpose();
  describe(fit, state, out);
  const SymmetricEigen eigen = symmetricEigen(out.covariance.topLeftCorner<3, 3>());
  out.weakest_in_camera = state.imu_from_camera.transpose() * eigen.vectors.col(2);
  return out;
}

}  // namespace evical
