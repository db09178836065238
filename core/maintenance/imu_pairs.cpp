#include "core/maintenance/imu_pairs.h"

#include "core/geometry/so3.h"
#include "core/maintenance/maintenance_options.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace evical {

void GaussianSmoother::add(double time_s, const Eigen::Vector3d& rate_rad_s,
                           const Eigen::Vector3d& force_m_s2, MeasuredBy measured_by) {
  const auto take = [time_s](std::deque<Sample>& samples, const Eigen::Vector3d& value) {
    if (samples.empty() || time_s > samples.back().time_s) samples.push_back({time_s, value});
  };
  if (measured_by != MeasuredBy::Accelerometer) take(rates_, rate_rad_s);
  if (measured_by != MeasuredBy::Gyroscope) take(forces_, force_m_s2);
}

void GaussianSmoother::forgetBefore(double time_s) {
  for (std::deque<Sample>* samples : {&rates_, &forces_})
    while (!samples->empty() && samples->front().time_s < time_s - 2.0 * reach_s()) samples->pop_front();
}

std::optional<GaussianSmoother::Smoothed> GaussianSmoother::at(double time_s,
                                                               const std::deque<Sample>& samples) const {
  constexpr double kMissing = 0.02;  // share of the Gaussian without samples
  const auto earlier = [](const Sample& sample, double time) { return sample.time_s < time; };
  const auto first = std::lower_bound(samples.begin(), samples.end(), time_s - reach_s(), earlier);
  const auto last = std::lower_bound(samples.begin(), samples.end(), time_s + reach_s(), earlier);
  if (first == samples.begin() || last == samples.end() || last - first < 5) return std::nullopt;
  double sum = 0.0, moment = 0.0;
  Smoothed found;
  const double height = 1.0 / (sigma_s_ * std::sqrt(2.0 * std::numbers::pi));
  for (auto it = first; it != last; ++it) {
    const double u = (it->time_s - time_s) / sigma_s_;
    // Each sample represents the time halfway to its neighbours.
    const double weight =
        height * std::exp(-0.5 * u * u) * 0.5 * (std::next(it)->time_s - std::prev(it)->time_s);
    const double slope = weight * u / sigma_s_;
    sum += weight;
    moment += slope;
    found.mean += weight * it->value;
    found.slope += slope * it->value;
    found.products += weight * it->value * it->value.transpose();
    if (std::next(it)->time_s - it->time_s > 2.5 * sigma_s_) return std::nullopt;
  }
  if (std::abs(sum - 1.0) > kMissing) return std::nullopt;
  found.mean /= sum;
  found.products /= sum;
  found.slope -= moment * found.mean;
  return found;
}

std::optional<SmoothPoint> GaussianSmoother::at(double time_s) const {
  const std::optional<Smoothed> rate = at(time_s, rates_);
  const std::optional<Smoothed> force = rate ? at(time_s, forces_) : std::nullopt;
  if (!force) return std::nullopt;
  return SmoothPoint{rate->mean, rate->slope, force->mean, force->slope, rate->products};
}

namespace {

// Points at this distance, in sigmas of the smoothing, share a tenth of their noise.
constexpr double kPointsApart = 3.0;
// An IMU that is this far behind the others has a gap, or its log has ended.
constexpr double kBehind_s = 3.0;

}  // namespace

void PairEquations::add(const Eigen::Matrix<double, 3, kPairNumbers>& jacobian,
                        const Eigen::Vector3d& residual) {
  information.noalias() += jacobian.transpose() * jacobian;
  score.noalias() += jacobian.transpose() * residual;
  squares += residual.squaredNorm();
  count += 3;
}

double smoothingFor(double slowest_rate_hz, const MaintenanceOptions& options) {
  return std::max(options.smoothing_s, slowest_rate_hz > 0.0 ? 2.0 / slowest_rate_hz : 0.0);
}

ImuPairs::ImuPairs(std::vector<ImuState> imus, std::vector<PairNominal> nominal, double smoothing_s,
                   const MaintenanceOptions& options)
    : imus_(std::move(imus)),
      nominal_(std::move(nominal)),
      window_s_(options.window_s),
      interval_s_(kPointsApart * smoothing_s),
      smoothers_(imus_.size(), GaussianSmoother(smoothing_s)),
      windows_(imus_.size()) {}

void ImuPairs::add(std::size_t imu, double time_s, const ImuSample& sample) {
  const ImuState& state = imus_[imu];
  const Eigen::Vector3d rate =
      state.gyroscopeMatrix().inverse() * (sample.angular_rate_rad_s - state.gyroscope_bias_rad_s);
  const Eigen::Vector3d force = state.accelerometer_scale_misalignment.inverse() *
                                (sample.specific_force_m_s2 - state.accelerometer_bias_m_s2);
  // All data are kept on the reference's clock, so that windows are the same for all IMUs.
  const PairNominal& clock = nominal_[imu];
  const double common_s =
      time_s + clock.time_offset_s + 1e-6 * clock.time_offset_drift_ppm * (time_s - clock.time_offset_at_s);
  if (measuresRate(sample)) smoothers_[imu].add(common_s, rate, force, MeasuredBy::Gyroscope);
  if (measuresForce(sample))
    smoothers_[imu].add(common_s - state.accelerometer_delay_s, rate, force, MeasuredBy::Accelerometer);
  double earliest = std::numeric_limits<double>::infinity(), latest = -earliest;
  for (const GaussianSmoother& smoother : smoothers_) {
    const double own = smoother.empty() ? -std::numeric_limits<double>::infinity() : smoother.latest_s();
    earliest = std::min(earliest, own);
    latest = std::max(latest, own);
  }
  advance(std::max(earliest, latest - kBehind_s));
}

void ImuPairs::finish() {
  double latest = -std::numeric_limits<double>::infinity();
  for (const GaussianSmoother& smoother : smoothers_)
    if (!smoother.empty()) latest = std::max(latest, smoother.latest_s());
  advance(latest);
}

void ImuPairs::advance(double until_s) {
  const double reach_s = smoothers_.front().reach_s();
  if (!std::isfinite(until_s)) return;
  if (!started_) {
    started_ = true;
    next_s_ = std::ceil((until_s - kBehind_s) / interval_s_) * interval_s_;
  }
  if (next_s_ > until_s - reach_s) return;
  // If all IMUs have a gap, skips the time in it.
  for (; next_s_ <= until_s - reach_s; next_s_ += interval_s_) {
    compare(next_s_);
    for (GaussianSmoother& smoother : smoothers_) smoother.forgetBefore(next_s_);
    const bool any = std::any_of(smoothers_.begin(), smoothers_.end(), [&](const GaussianSmoother& smoother) {
      return !smoother.empty() && smoother.latest_s() > next_s_;
    });
    if (!any) break;
  }
}

void ImuPairs::compare(double time_s) {
  const std::optional<SmoothPoint> reference = smoothers_.front().at(time_s);
  if (!reference) return;
  for (std::size_t imu = 1; imu < imus_.size(); ++imu)
    if (const std::optional<SmoothPoint> own = smoothers_[imu].at(time_s))
      addPoint(imu, time_s, *reference, *own);
}

// Residuals of rate = R^T rate_ref and force = R^T (force_ref + (alpha x + Omega) lever), with R =
// reference_from_imu; alpha is the slope of the rate, Omega l = w x (w x l).
void ImuPairs::addPoint(std::size_t imu, double time_s, const SmoothPoint& reference,
                        const SmoothPoint& own) {
  std::vector<PairWindow>& windows = windows_[imu];
  const double begin_s = std::floor(time_s / window_s_) * window_s_;
  if (windows.empty() || windows.back().time_s < begin_s - 1e-6) windows.push_back({begin_s, {}, {}});
  const Eigen::Matrix3d own_from_reference =
      nominal_[imu].reference_from_imu.rotation.conjugate().toRotationMatrix();
  const Eigen::Matrix3d by_lever = skew(reference.rate_slope_rad_s2) + reference.rate_products -
                                   reference.rate_products.trace() * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d force_there =
      reference.force_m_s2 + by_lever * nominal_[imu].reference_from_imu.translation_m;
  Eigen::Matrix<double, 3, kPairNumbers> jacobian = Eigen::Matrix<double, 3, kPairNumbers>::Zero();
  jacobian.block<3, 3>(0, 0) = own_from_reference * skew(reference.rate_rad_s);
  jacobian.col(6) = own_from_reference * reference.rate_slope_rad_s2;
  jacobian.block<3, 3>(0, 7).setIdentity();
  windows.back().gyroscope.add(jacobian, own.rate_rad_s - own_from_reference * reference.rate_rad_s);
  jacobian.setZero();
  jacobian.block<3, 3>(0, 0) = own_from_reference * skew(force_there);
  jacobian.block<3, 3>(0, 3) = own_from_reference * by_lever;
  jacobian.col(6) = own.force_slope_m_s3;
  jacobian.block<3, 3>(0, 10).setIdentity();
  windows.back().accelerometer.add(jacobian, own.force_m_s2 - own_from_reference * force_there);
}

}  // namespace evical
