#include "core/egomotion/alignment_fit.h"

#include "core/base/time.h"
#include "core/geometry/so3.h"
#include "core/numerics/robust.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace evical {

SummedRates::SummedRates(std::span<const ImuSample> samples, std::int64_t start_ns) {
  std::vector<double> steps_s;
  for (const ImuSample& sample : samples) {
    const double time_s = secondsSince(start_ns, sample.time_ns);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    if (!times_s_.empty()) {
      const double step_s = time_s - times_s_.back();
      if (!(step_s > 0.0)) continue;
      steps_s.push_back(step_s);
      sum = sums_rad_.back() + 0.5 * step_s * (rates_rad_s_.back() + sample.angular_rate_rad_s);
    }
    times_s_.push_back(time_s);
    rates_rad_s_.push_back(sample.angular_rate_rad_s);
    sums_rad_.push_back(sum);
  }
  constexpr double kGapSteps = 5.0, kMinGap_s = 0.01;
  const double gap_s = std::max(kMinGap_s, kGapSteps * medianOf(steps_s));
  for (std::size_t k = 1; k < times_s_.size(); ++k) {
    if (times_s_[k] - times_s_[k - 1] > gap_s) gaps_s_.push_back(times_s_[k - 1]);
  }
}

std::size_t SummedRates::after(double time_s) const {
  const auto found = std::upper_bound(times_s_.begin(), times_s_.end(), time_s) - times_s_.begin();
  return std::clamp<std::size_t>(static_cast<std::size_t>(found), 1, times_s_.size() - 1);
}

bool SummedRates::covers(double from_s, double to_s) const {
  if (times_s_.size() < 2 || from_s < times_s_.front() || to_s > times_s_.back()) return false;
  // The last gap that begins before the end must have ended before the beginning.
  const auto gap = std::lower_bound(gaps_s_.begin(), gaps_s_.end(), to_s);
  return gap == gaps_s_.begin() || times_s_[after(*(gap - 1))] <= from_s;
}

Eigen::Vector3d SummedRates::rateAt_rad_s(double time_s) const {
  const std::size_t k = after(time_s);
  const double part = (time_s - times_s_[k - 1]) / (times_s_[k] - times_s_[k - 1]);
  return rates_rad_s_[k - 1] + part * (rates_rad_s_[k] - rates_rad_s_[k - 1]);
}

Eigen::Vector3d SummedRates::sumUntil(double time_s) const {
  const std::size_t k = after(time_s);
  const double since_s = time_s - times_s_[k - 1];
  return sums_rad_[k - 1] + 0.5 * since_s * (rates_rad_s_[k - 1] + rateAt_rad_s(time_s));
}

namespace {

constexpr double kMedianOfChi2With3 = 2.3659738843753377;
constexpr double kCauchySquares =
    9.0;  // squared scale; errors of one sigma in three numbers are far below it

}  // namespace

AlignmentFit::AlignmentFit(std::vector<const WindowMotion*> windows, const SummedRates& rates,
                           const Eigen::Matrix3d& gyroscope_matrix)
    : windows_(std::move(windows)), rates_(rates), imu_from_measured_(gyroscope_matrix.inverse()) {}

Eigen::Vector3d AlignmentFit::imuRate_rad_s(const WindowMotion& window, const AlignmentState& state,
                                            Eigen::Vector3d* by_time) const {
  constexpr auto kParts = static_cast<double>(WindowMotion::kParts);
  const double part_s = (window.end_s - window.begin_s) / kParts;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), slope = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < WindowMotion::kParts; ++k) {
    const double weight = window.part_weights[k];
    if (weight == 0.0) continue;
    const double from_s = window.begin_s + static_cast<double>(k) * part_s + state.time_offset_s;
    mean += weight * rates_.mean_rad_s(from_s, from_s + part_s);
    if (by_time)
      slope += weight / part_s * (rates_.rateAt_rad_s(from_s + part_s) - rates_.rateAt_rad_s(from_s));
  }
  if (by_time) *by_time = imu_from_measured_ * slope;
  return imu_from_measured_ * (mean - state.bias_rad_s);
}

AlignmentFit::Equation AlignmentFit::equationOf(std::size_t k, const AlignmentState& state) const {
  const WindowMotion& window = *windows_[k];
  Eigen::Vector3d by_time;
  const Eigen::Vector3d in_imu = imuRate_rad_s(window, state, &by_time);
  const Eigen::Matrix3d camera_from_imu = state.scale * state.imu_from_camera.transpose();
  Equation equation;
  equation.error = camera_from_imu * in_imu - window.rate_rad_s;
  equation.jacobian.leftCols<3>() = camera_from_imu * skew(in_imu);
  equation.jacobian.col(3) = camera_from_imu * by_time;
  equation.jacobian.block<3, 3>(0, 4) = -camera_from_imu * imu_from_measured_;
  equation.jacobian.col(7) = state.imu_from_camera.transpose() * in_imu;
  return equation;
}

Eigen::Matrix3d AlignmentFit::weightOf(std::size_t k, const Eigen::Vector3d& error, double* square) const {
  const Eigen::Matrix3d covariance =
      windows_[k]->covariance + floor_rad_s_ * floor_rad_s_ * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d information = covariance.inverse() / (scale_ * scale_);
  const double size = error.dot(information * error);
  if (square) *square = size;
  return cauchyWeight(size / kCauchySquares) * information;
}

// The windows' own sigmas are valid for few edges; for many edges, model errors dominate.
void AlignmentFit::findScales(const AlignmentState& state) {
  std::vector<double> sizes, squares;
  std::vector<Eigen::Vector3d> errors;
  for (std::size_t k = 0; k < windows_.size(); ++k) {
    errors.push_back(equationOf(k, state).error);
    for (const double error : errors.back()) sizes.push_back(std::abs(error));
  }
  median_error_rad_s_ = medianOf(std::move(sizes));
  constexpr double kShare = 0.5;
  floor_rad_s_ = std::max(kShare * kMadToSigma * median_error_rad_s_, 1e-6);
  scale_ = 1.0;
  squares_.resize(windows_.size());
  for (std::size_t k = 0; k < windows_.size(); ++k) weightOf(k, errors[k], &squares_[k]);
  scale_ = std::sqrt(std::max(medianOf(std::vector<double>(squares_)) / kMedianOfChi2With3, 1e-12));
  for (double& square : squares_) square /= scale_ * scale_;
}

AlignmentFit::NormalEquations AlignmentFit::normalEquations(const AlignmentState& state) const {
  NormalEquations all;
  for (std::size_t k = 0; k < windows_.size(); ++k) {
    const Equation equation = equationOf(k, state);
    const Eigen::Matrix3d weight = weightOf(k, equation.error);
    all.normal += equation.jacobian.transpose() * weight * equation.jacobian;
    all.gradient += equation.jacobian.transpose() * (weight * equation.error);
  }
  return all;
}

bool AlignmentFit::solve(AlignmentState& state) {
  constexpr int kIterations = 20;
  constexpr double kLargestTurn_rad = 0.5, kLargestDelay_s = 0.02, kDone = 1e-9;
  for (int k = 0; k < kIterations; ++k) {
    findScales(state);
    const NormalEquations all = normalEquations(state);
    AlignmentVector step = -all.normal.ldlt().solve(all.gradient);
    if (!step.allFinite()) return false;
    const double turn_rad = step.head<3>().norm();
    step *= std::min({1.0, kLargestTurn_rad / std::max(turn_rad, 1e-12),
                      kLargestDelay_s / std::max(std::abs(step[3]), 1e-12)});
    state.imu_from_camera = so3Exp(step.head<3>()) * state.imu_from_camera;
    state.time_offset_s += step[3];
    state.bias_rad_s += step.segment<3>(4);
    state.scale += step[7];
    if (!(state.scale > 0.0)) return false;
    if (step.norm() < kDone) break;
  }
  findScales(state);
  return true;
}

namespace {

constexpr double kStep_s = 0.005;
constexpr std::size_t kMaxPeaks = 4;

struct Correlation {
  double offset_s = 0.0, value = -1.0;
};

// Correlation of the magnitudes of both rates, over the windows that the gyroscope covers at this offset.
Correlation correlationAt(double offset_s, const std::vector<const WindowMotion*>& windows,
                          const SummedRates& rates, const AlignmentState& start,
                          const Eigen::Matrix3d& imu_from_measured) {
  constexpr double kMinShare = 0.5;
  double n = 0.0, a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
  for (const WindowMotion* window : windows) {
    if (!rates.covers(window->begin_s + offset_s, window->end_s + offset_s)) continue;
    const Eigen::Vector3d mean = rates.mean_rad_s(window->begin_s + offset_s, window->end_s + offset_s);
    const double camera = window->rate_rad_s.norm(),
                 imu = (imu_from_measured * (mean - start.bias_rad_s)).norm();
    n += 1.0;
    a += camera;
    b += imu;
    aa += camera * camera;
    bb += imu * imu;
    ab += camera * imu;
  }
  if (n < kMinShare * static_cast<double>(windows.size()) || n < 3.0) return {offset_s, -1.0};
  const double variance = (aa - a * a / n) * (bb - b * b / n);
  return {offset_s, variance > 0.0 ? (ab - a * b / n) / std::sqrt(variance) : -1.0};
}

Eigen::Matrix3d rotationOf(const std::vector<const WindowMotion*>& windows, const AlignmentFit& fit,
                           const SummedRates& rates, const AlignmentState& state) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const WindowMotion* window : windows) {
    if (!rates.covers(window->begin_s + state.time_offset_s, window->end_s + state.time_offset_s)) continue;
    const Eigen::Vector3d imu = fit.imuRate_rad_s(*window, state);
    const double size = std::max(imu.norm() * window->rate_rad_s.norm(), 1e-6);
    sum += imu * window->rate_rad_s.transpose() / std::sqrt(size);
  }
  return bestRotation(sum).matrix;
}

}  // namespace

std::vector<AlignmentState> alignmentStarts(const std::vector<const WindowMotion*>& windows,
                                            const AlignmentFit& fit, const SummedRates& rates,
                                            const AlignmentState& start, double search_s) {
  std::vector<AlignmentState> starts = {start};
  std::vector<Correlation> all, peaks;
  const int steps = static_cast<int>(std::floor(search_s / kStep_s));
  for (int k = -steps; k <= steps; ++k)
    all.push_back(
        correlationAt(start.time_offset_s + k * kStep_s, windows, rates, start, fit.imuFromMeasured()));
  for (std::size_t k = 0; k < all.size(); ++k) {
    const bool above_left = k == 0 || all[k].value >= all[k - 1].value;
    const bool above_right = k + 1 == all.size() || all[k].value > all[k + 1].value;
    if (above_left && above_right && all[k].value > 0.0) peaks.push_back(all[k]);
  }
  std::sort(peaks.begin(), peaks.end(),
            [](const Correlation& a, const Correlation& b) { return a.value > b.value; });
  peaks.resize(std::min(peaks.size(), kMaxPeaks));
  for (const Correlation& peak : peaks) {
    AlignmentState state = start;
    state.time_offset_s = peak.offset_s;
    state.imu_from_camera = rotationOf(windows, fit, rates, state);
    starts.push_back(state);
  }
  return starts;
}

}  // namespace evical
