#include "core/recording/imu_statistics.h"

#include "core/base/time.h"
#include "core/geometry/so3.h"
#include "core/numerics/robust.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical {
namespace {

const Eigen::Vector3d& forceOf(const ImuSample& sample) {
  return sample.specific_force_m_s2;
}
const Eigen::Vector3d& forceOf(const RawImuSample& sample) {
  return sample.specific_force;
}
const Eigen::Vector3d& rateOf(const ImuSample& sample) {
  return sample.angular_rate_rad_s;
}
const Eigen::Vector3d& rateOf(const RawImuSample& sample) {
  return sample.angular_rate;
}

template <class Sample>
double medianIntervalOf(const std::vector<Sample>& samples) {
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < samples.size(); ++i)
    intervals_s.push_back(secondsSince(samples[i - 1].time_ns, samples[i].time_ns));
  return medianOf(std::move(intervals_s));
}

template <class Sample>
double medianForceNormOf(const std::vector<Sample>& samples) {
  std::vector<double> norms;
  for (const Sample& sample : samples) {
    const double norm = forceOf(sample).norm();
    if (std::isfinite(norm)) norms.push_back(norm);
  }
  return medianOf(std::move(norms));
}

template <class Sample>
double largestRateOf(const std::vector<Sample>& samples) {
  double largest = 0.0;
  for (const Sample& sample : samples) {
    const double rate = rateOf(sample).cwiseAbs().maxCoeff();
    if (std::isfinite(rate)) largest = std::max(largest, rate);
  }
  return largest;
}

}  // namespace

double medianInterval_s(const std::vector<ImuSample>& samples) {
  return medianIntervalOf(samples);
}

double medianInterval_s(const std::vector<RawImuSample>& samples) {
  return medianIntervalOf(samples);
}

double medianForceNorm(const std::vector<ImuSample>& samples) {
  return medianForceNormOf(samples);
}

double medianForceNorm(const std::vector<RawImuSample>& samples) {
  return medianForceNormOf(samples);
}

std::optional<double> steadyForceNorm(const std::vector<ImuSample>& samples) {
  constexpr double kPiece_s = 2.0, kLongestGap_s = 0.1;
  std::vector<double> norms;
  Eigen::Quaterniond turned =
      Eigen::Quaterniond::Identity();  // first frame of the piece from the current frame
  Eigen::Vector3d sum_m_s = Eigen::Vector3d::Zero();
  double length_s = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double interval_s = secondsSince(samples[i - 1].time_ns, samples[i].time_ns);
    if (interval_s <= 0.0 || interval_s > kLongestGap_s || length_s >= kPiece_s) {
      if (length_s >= kPiece_s) norms.push_back((sum_m_s / length_s).norm());
      turned.setIdentity();
      sum_m_s.setZero();
      length_s = 0.0;
      continue;
    }
    turned = (turned * quaternionExp(interval_s * samples[i].angular_rate_rad_s)).normalized();
    sum_m_s += turned * (interval_s * samples[i].specific_force_m_s2);
    length_s += interval_s;
  }
  if (norms.empty()) return std::nullopt;
  return medianOf(std::move(norms));
}

bool isGravity(double norm_m_s2, const InspectionOptions& options) {
  return std::abs(norm_m_s2 - kStandardGravity_m_s2) <= options.gravity_tolerance_m_s2;
}

double largestRate(const std::vector<ImuSample>& samples) {
  return largestRateOf(samples);
}

double largestRate(const std::vector<RawImuSample>& samples) {
  return largestRateOf(samples);
}

}  // namespace evical
