#include "core/egomotion/rotation_alignment.h"

#include "core/egomotion/alignment_fit.h"
#include "core/egomotion/joint_fit.h"
#include "core/geometry/so3.h"
#include "core/numerics/dense.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace evical {
namespace {

constexpr const char* kWalkLess =
    "Stay further away from walls and furniture, walk more slowly, and rotate more: near objects move in "
    "the image while you walk";

RotationAlignment failed(std::string reason, std::vector<std::string> advice = {}) {
  RotationAlignment out;
  out.failure = std::move(reason);
  out.advice = std::move(advice);
  return out;
}

RotationAlignment noSolution() {
  return failed("no rotation and time offset aligns the camera's motion with the gyroscope's",
                {kWalkLess, "Check that camera, lens and IMU belong to one rig"});
}

bool isUsed(const WindowMotion& window) {
  return window.use == WindowUse::Used;
}

// Used windows that the gyroscope covers, with a margin for later changes of the offset.
std::vector<const WindowMotion*> coveredWindows(std::vector<WindowMotion>& windows, const SummedRates& rates,
                                                double offset_s) {
  constexpr double kMargin_s = 0.05;
  std::vector<const WindowMotion*> covered;
  for (WindowMotion& window : windows) {
    if (!isUsed(window)) continue;
    const double from_s = window.begin_s + offset_s, to_s = window.end_s + offset_s;
    if (rates.covers(from_s - kMargin_s, to_s + kMargin_s)) {
      covered.push_back(&window);
    } else {
      window.use = WindowUse::NoGyroscope;
    }
  }
  return covered;
}

// The delete-a-block jackknife, to first order: the change of the estimate without each block. With few
// blocks, their scatter itself is uncertain, which Student's distribution describes. The noise of edges is
// added for numbers that no block determines well.
std::optional<JointMatrix> blockCovariance(const JointFit& fit, const EgomotionOptions& options,
                                           int& blocks) {
  std::map<double, JointFit::Part> sums;
  for (const JointFit::Part& part : fit.parts()) {
    JointFit::Part& sum = sums[std::floor(part.middle_s / options.block_s)];
    sum.normal += part.normal;
    sum.right += part.right;
  }
  blocks = static_cast<int>(sums.size());
  if (blocks < options.min_blocks) return std::nullopt;
  std::vector<JointVector> moves;
  JointVector mean = JointVector::Zero();
  for (const auto& [time, block] : sums) {
    moves.push_back((fit.normal() - block.normal).ldlt().solve(block.right));
    mean += moves.back() / static_cast<double>(blocks);
  }
  JointMatrix sum = JointMatrix::Zero();
  for (const JointVector& move : moves) sum += (move - mean) * (move - mean).transpose();
  const double n = blocks, student = (n - 1.0) / (n - 3.0 + 0.5);
  const JointMatrix covariance = student * (n - 1.0) / n * sum + fit.normal().inverse();
  if (!covariance.allFinite() || !(covariance.diagonal().array() > 0.0).all()) return std::nullopt;
  return covariance;
}

// Result of another fit, minus the numbers of `state`.
std::optional<Eigen::Vector4d> shiftBy(JointFit fit, const AlignmentState& state, double from, double to) {
  AlignmentState there = state;
  if (!fit.solve(there, from, to)) return std::nullopt;
  Eigen::Vector4d shift;
  shift.head<3>() = so3Log(there.imu_from_camera * state.imu_from_camera.transpose());
  shift[3] = there.time_offset_s - state.time_offset_s;
  return shift;
}

EgomotionOptions withCoarserDepths(EgomotionOptions options) {
  options.depth_columns = (options.depth_columns + 1) / 2;
  options.depth_rows = (options.depth_rows + 1) / 2;
  return options;
}

void markOutOfLine(const AlignmentFit& fit, double far_sigmas, std::vector<WindowMotion>& windows) {
  for (std::size_t k = 0; k < fit.windowCount(); ++k) {
    if (fit.squares()[k] <= far_sigmas * far_sigmas) continue;
    const auto place = static_cast<std::size_t>(&fit.window(k) - windows.data());
    windows[place].use = WindowUse::OutOfLine;
  }
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
    misfits += (expected - fit.window(k).rate_rad_s).squaredNorm();
  }
  const double n = static_cast<double>(std::max<std::size_t>(1, fit.windowCount()));
  out.rate_rms_rad_s = std::sqrt(rates / n);
  out.misfit_rms_rad_s = std::sqrt(misfits / n);
}

// Sets the estimates and their covariance: scatter of blocks, plus remaining errors of depths and
// translation.
void take(const AlignmentState& state, const Eigen::Matrix4d& by_blocks, const EgomotionOptions& options,
          RotationAlignment& out) {
  out.imu_from_camera = Eigen::Quaterniond(state.imu_from_camera).normalized();
  out.time_offset_s = state.time_offset_s;
  out.gyroscope_bias_rad_s = state.bias_rad_s;
  out.scale = state.scale;
  const Eigen::Vector4d depths = options.depths_left * out.by_coarser_depths,
                        translation = options.translation_left * out.by_turning_alone;
  out.covariance = by_blocks + depths * depths.transpose() + translation * translation.transpose();
  const SymmetricEigen eigen = symmetricEigen(out.covariance.topLeftCorner<3, 3>());
  out.weakest_in_camera = state.imu_from_camera.transpose() * eigen.vectors.col(2);
}

// Solution from the windows' own rates: the start value of the joint fit. Marks windows that contradict the
// others.
std::optional<AlignmentState> startingSolution(std::vector<WindowMotion>& windows, const SummedRates& rates,
                                               const Eigen::Matrix3d& matrix, const AlignmentState& before,
                                               const EgomotionOptions& options, RotationAlignment& out) {
  // The search range of the offset excludes windows at the ends; the final solution uses them again.
  std::vector<WindowMotion> searched = windows;
  std::vector<const WindowMotion*> inside = coveredWindows(searched, rates, before.time_offset_s);
  std::erase_if(inside, [&](const WindowMotion* window) {
    return !rates.covers(window->begin_s + before.time_offset_s - options.search_s,
                         window->end_s + before.time_offset_s + options.search_s);
  });
  if (inside.size() < static_cast<std::size_t>(kAlignmentNumbers)) {
    out = failed("the recordings of camera and gyroscope overlap too little in time");
    return std::nullopt;
  }
  std::optional<AlignmentState> state = bestSolution(inside, rates, matrix, before, options.search_s);
  if (state) {
    AlignmentFit fit(coveredWindows(windows, rates, state->time_offset_s), rates, matrix);
    if (fit.solve(*state)) {
      markOutOfLine(fit, options.far_sigmas, windows);
      return state;
    }
  }
  out = noSolution();
  return std::nullopt;
}

}  // namespace

RotationAlignment alignRotation(CameraRecord& record, const LensRays& lens, const GyroscopeRecord& gyroscope,
                                const AlignmentStart& start, const EgomotionOptions& options, int threads,
                                const RunContext& context) {
  const SummedRates rates(gyroscope.samples, gyroscope.start_ns);
  const Eigen::Matrix3d matrix = gyroscope.imu.gyroscopeMatrix();
  std::vector<WindowMotion>& windows = record.windows;
  if (std::count_if(windows.begin(), windows.end(), isUsed) < kAlignmentNumbers)
    return failed("too few event windows determine the camera's rotation");
  const AlignmentState before{start.imu_from_camera.toRotationMatrix(), start.time_offset_s,
                              gyroscope.imu.gyroscope_bias_rad_s};
  RotationAlignment out;
  const std::optional<AlignmentState> rough = startingSolution(windows, rates, matrix, before, options, out);
  if (!rough) return out;
  AlignmentState state = *rough;
  const JointInput input{record, lens, rates, matrix.inverse(), gyroscope.start_ns, threads, context};
  JointFit fit(input, options);
  if (!fit.solve(state, 0.0, 0.4)) return noSolution();
  const std::optional<JointMatrix> covariance = blockCovariance(fit, options, out.blocks);
  if (!covariance)
    return failed("too little of the recording determines the camera's rotation",
                  {"Record for a minute, and rotate about all axes", kWalkLess});
  const std::optional<Eigen::Vector4d> coarser = shiftBy(JointFit(input, withCoarserDepths(options)), state,
                                                         0.4, 0.7),
                                       still = shiftBy(JointFit(input, options, true), state, 0.7, 1.0);
  if (!coarser || !still)
    return failed("rotation cannot be separated from translation in the image", {kWalkLess});
  out.by_coarser_depths = *coarser;
  out.by_turning_alone = *still;
  take(state, covariance->topLeftCorner<4, 4>(), options, out);
  describe(AlignmentFit(coveredWindows(windows, rates, state.time_offset_s), rates, matrix), state, out);
  return out;
}

}  // namespace evical
