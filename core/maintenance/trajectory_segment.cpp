#include "core/maintenance/trajectory_segment.h"

#include "core/geometry/so3.h"
#include "core/numerics/band_cholesky.h"
#include "core/numerics/chi_squared.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace evical {

// The rows of a segment, axis by axis; and the covariance of an axis, from noise of positions and of the
// accelerometer.
struct LagRows {
  std::array<Eigen::MatrixXd, 3> jacobian;
  std::array<Eigen::VectorXd, 3> measured;
  std::vector<double> lengths_s;  // of intervals

  BandCholesky covariance(double position_noise_m, double density) const {
    const auto count = static_cast<Eigen::Index>(lengths_s.size()) - 1;
    BandCholesky band(count, 2);
    const double position = position_noise_m * position_noise_m, force = density * density;
    const auto ends = [&](Eigen::Index i) {
      const double before = 1.0 / lengths_s[static_cast<std::size_t>(i)],
                   after = 1.0 / lengths_s[static_cast<std::size_t>(i) + 1];
      return std::array{before, -before - after, after};
    };
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index k = 0; k <= std::min<Eigen::Index>(2, i); ++k) {
        double sum = 0.0;
        for (Eigen::Index j = 0; j + k < 3; ++j)
          sum += ends(i)[static_cast<std::size_t>(j)] * ends(i - k)[static_cast<std::size_t>(j + k)];
        double noise = position * sum;
        const double length = lengths_s[static_cast<std::size_t>(i)];
        if (k == 0) noise += force * (length + lengths_s[static_cast<std::size_t>(i) + 1]) / 3.0;
        if (k == 1) noise += force * length / 6.0;
        band.add(i, i - k, noise);
      }
    return band;
  }
};

namespace {

constexpr Eigen::Index kUnknowns = kAccelerometerNumbers + 6;  // followed by gravity and lever
constexpr Eigen::Index kGravity = kAccelerometerNumbers, kLever = kAccelerometerNumbers + 3;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using UnknownsMatrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

// Parameters in which accelerations are linear: force = A f - c, A = M^-1, c = A b. c first, then
// kMappingEntries.
AccelerometerVector linearFrom(const AccelerometerVector& numbers) {
  ImuState imu;
  setAccelerometerNumbers(numbers, imu);
  imu.accelerometer_scale_misalignment = imu.accelerometer_scale_misalignment.inverse().eval();
  imu.accelerometer_bias_m_s2 = imu.accelerometer_scale_misalignment * imu.accelerometer_bias_m_s2;
  return accelerometerNumbers(imu);
}
AccelerometerVector numbersFrom(const AccelerometerVector& linear) {
  ImuState imu;
  setAccelerometerNumbers(linear, imu);
  imu.accelerometer_scale_misalignment = imu.accelerometer_scale_misalignment.inverse().eval();
  imu.accelerometer_bias_m_s2 = imu.accelerometer_scale_misalignment * imu.accelerometer_bias_m_s2;
  return accelerometerNumbers(imu);
}

template <class Function>
AccelerometerMatrix derivative(const Function& function, const AccelerometerVector& at) {
  constexpr double kStep = 1e-5;
  AccelerometerMatrix jacobian;
  for (Eigen::Index i = 0; i < kAccelerometerNumbers; ++i) {
    const AccelerometerVector step = kStep * AccelerometerVector::Unit(i);
    jacobian.col(i) = (function(at + step) - function(at - step)) / (2.0 * kStep);
  }
  return jacobian;
}

// Derivative of A f - c by c and the entries of A.
Eigen::Matrix<double, 3, kAccelerometerNumbers> forceRow(const Eigen::Vector3d& force) {
  Eigen::Matrix<double, 3, kAccelerometerNumbers> row =
      Eigen::Matrix<double, 3, kAccelerometerNumbers>::Zero();
  row.leftCols<3>() = -Eigen::Matrix3d::Identity();
  for (std::size_t e = 0; e < kMappingEntries.size(); ++e)
    row(kMappingEntries[e][0], 3 + static_cast<Eigen::Index>(e)) = force[kMappingEntries[e][1]];
  return row;
}

struct LagSolution {
  UnknownsMatrix information = UnknownsMatrix::Zero();
  Unknowns score = Unknowns::Zero(), solution = Unknowns::Zero();  // the score at `about`
  double squares = 0.0, freedom = 0.0;
};

// Weak prior as information: sigmas of 1 m/s^2 for the bias and 10 % for scales.
AccelerometerVector weaklyHeld() {
  constexpr double kOpenBias_m_s2 = 1.0, kOpenScale = 0.1;
  AccelerometerVector information;
  information.head<3>().setConstant(1.0 / (kOpenBias_m_s2 * kOpenBias_m_s2));
  information.tail<6>().setConstant(1.0 / (kOpenScale * kOpenScale));
  return information;
}

// Adds the weak prior, and the known norm of gravity.
void hold(const Unknowns& about, double gravity_m_s2, UnknownsMatrix& whole, Unknowns& right) {
  constexpr double kOpenLever_m = 1.0, kNorm_m_s2 = 1e-3;
  whole.diagonal().head<kAccelerometerNumbers>() += weaklyHeld();
  whole.diagonal().segment<3>(kLever).array() += 1.0 / (kOpenLever_m * kOpenLever_m);
  const Eigen::Vector3d gravity = about.segment<3>(kGravity);
  if (gravity.norm() < 0.1) return;
  const Eigen::Vector3d down = gravity.normalized();
  whole.block<3, 3>(kGravity, kGravity) += down * down.transpose() / (kNorm_m_s2 * kNorm_m_s2);
  right.segment<3>(kGravity) += down * (gravity_m_s2 - gravity.norm()) / (kNorm_m_s2 * kNorm_m_s2);
}

LagSolution solve(const LagRows& rows, const Unknowns& about, double position_noise_m, double density,
                  double gravity_m_s2) {
  LagSolution found;
  BandCholesky band = rows.covariance(position_noise_m, density);
  band.factorise();
  std::array<Eigen::VectorXd, 3> left;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Eigen::MatrixXd& jacobian = rows.jacobian[axis];
    left[axis] = rows.measured[axis] - jacobian * about;
    Eigen::MatrixXd solved(jacobian.rows(), kUnknowns + 1);
    solved << jacobian, left[axis];
    band.solveInPlace(solved);
    found.information += jacobian.transpose() * solved.leftCols<kUnknowns>();
    found.score += jacobian.transpose() * solved.col(kUnknowns);
    found.squares += left[axis].dot(solved.col(kUnknowns));
    found.freedom += static_cast<double>(jacobian.rows());
  }
  UnknownsMatrix whole = found.information;
  Unknowns right = found.score;
  hold(about, gravity_m_s2, whole, right);
  const Unknowns change = whole.ldlt().solve(right);
  found.squares += change.dot(found.information * change) - 2.0 * change.dot(found.score);
  found.freedom -= static_cast<double>(kUnknowns);
  found.solution = about + change;
  return found;
}

// The noise of positions is estimated from the residuals.
LagEstimate estimate(const LagRows& rows, const AccelerometerVector& old_numbers, double gravity_m_s2,
                     double density) {
  Unknowns about = Unknowns::Zero();
  about.head<kAccelerometerNumbers>() = linearFrom(old_numbers);
  double noise_m = 1e-3;
  LagSolution found;
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds; ++round) {
    found = solve(rows, about, noise_m, density, gravity_m_s2);
    about.segment<3>(kGravity) = found.solution.segment<3>(kGravity);
    const double share = std::max(found.squares, 1e-12) / std::max(found.freedom, 1.0);
    if (round + 1 < kRounds) noise_m = std::clamp(noise_m * std::sqrt(share), 1e-7, 1e3);
  }
  UnknownsMatrix whole = found.information;
  Unknowns ignored = Unknowns::Zero();
  hold(about, gravity_m_s2, whole, ignored);
  const UnknownsMatrix covariance = whole.ldlt().solve(UnknownsMatrix::Identity());
  const AccelerometerVector linear = found.solution.head<kAccelerometerNumbers>();
  const AccelerometerMatrix of_linear =
      covariance.topLeftCorner<kAccelerometerNumbers, kAccelerometerNumbers>();
  const AccelerometerMatrix to_numbers = derivative(numbersFrom, linear),
                            from_numbers = derivative(linearFrom, old_numbers);
  // Gravity and lever are separate for each segment; the weak prior is removed from the information.
  AccelerometerMatrix information = of_linear.inverse();
  information.diagonal() -= weaklyHeld();
  LagEstimate lag;
  lag.now = numbersFrom(linear);
  lag.covariance = to_numbers * of_linear * to_numbers.transpose();
  lag.information = from_numbers.transpose() * information * from_numbers;
  lag.score = from_numbers.transpose() * information * (linear - linearFrom(old_numbers));
  lag.gravity_m_s2 = found.solution.segment<3>(kGravity);
  lag.lever_m = found.solution.segment<3>(kLever);
  lag.lever_sigma_m = covariance.diagonal().segment<3>(kLever).cwiseMax(0.0).cwiseSqrt();
  lag.position_noise_m = noise_m;
  return lag;
}

}  // namespace

TrajectorySegment::TrajectorySegment(std::vector<TimedPose> poses, const ImuState& before,
                                     double gravity_m_s2, double accelerometer_density,
                                     const MaintenanceOptions& options)
    : poses_(std::move(poses)),
      before_(before),
      gravity_m_s2_(gravity_m_s2),
      density_(accelerometer_density),
      options_(options) {
  to_ = nextPose(0);
}

// The first pose at the required interval; beyond the end if there is none, or if poses are missing.
std::size_t TrajectorySegment::nextPose(std::size_t from) const {
  std::size_t next = from + 1;
  while (next < poses_.size() && poses_[next].time_s - poses_[from].time_s < 0.999 * options_.pose_interval_s)
    ++next;
  return next;
}

void TrajectorySegment::add(double time_s, const ImuSample& sample) {
  if (to_ >= poses_.size()) return;
  if (!times_s_.empty() && time_s <= times_s_.back()) return;
  times_s_.push_back(time_s);
  samples_.push_back(sample);
  while (to_ < poses_.size() && time_s > lastStamp_s(poses_[to_].time_s)) {
    close();
    from_ = to_;
    to_ = nextPose(from_);
    // The next interval needs the last sample before its first stamp.
    const auto next = std::ranges::upper_bound(times_s_, firstStamp_s(poses_[from_].time_s));
    const std::ptrdiff_t unused = std::max<std::ptrdiff_t>(next - times_s_.begin() - 1, 0);
    samples_.erase(samples_.begin(), samples_.begin() + unused);
    times_s_.erase(times_s_.begin(), times_s_.begin() + unused);
  }
}

// Forces at a time have stamps that are later by the accelerometer's delay.
double TrajectorySegment::firstStamp_s(double time_s) const {
  return time_s + std::min(0.0, before_.accelerometer_delay_s);
}
double TrajectorySegment::lastStamp_s(double time_s) const {
  return time_s + std::max(0.0, before_.accelerometer_delay_s);
}

bool TrajectorySegment::isWhole() const {
  const TimedPose &from = poses_[from_], &to = poses_[to_];
  constexpr double kGap = 0.3;  // relative to the interval of poses
  if (samples_.size() < 3 || times_s_.front() > firstStamp_s(from.time_s) ||
      times_s_.back() < lastStamp_s(to.time_s))
    return false;
  // Sensors with separate samples have separate gaps.
  double rate_s = times_s_.front(), force_s = times_s_.front(), longest_s = 0.0;
  for (std::size_t k = 1; k < times_s_.size(); ++k) {
    longest_s = std::max({longest_s, times_s_[k] - rate_s, times_s_[k] - force_s});
    if (measuresRate(samples_[k])) rate_s = times_s_[k];
    if (measuresForce(samples_[k])) force_s = times_s_[k];
  }
  if (longest_s > kGap * options_.pose_interval_s) return false;
  return to.time_s - from.time_s < options_.trajectory_gap * options_.pose_interval_s;
}

// Nodes at the samples between two poses, and at the poses' times; rotated from the first pose by the
// gyroscope.
std::vector<TrajectorySegment::Node> TrajectorySegment::nodes() const {
  const TimedPose &from = poses_[from_], &to = poses_[to_];
  const Eigen::Matrix3d rates = before_.gyroscopeMatrix().inverse();
  const auto at = [&](double time_s, auto member) -> Eigen::Vector3d {
    const auto next = std::upper_bound(times_s_.begin() + 1, times_s_.end() - 1, time_s);
    const auto k = static_cast<std::size_t>(next - times_s_.begin() - 1);
    const double share = (time_s - times_s_[k]) / (times_s_[k + 1] - times_s_[k]);
    return (1.0 - share) * samples_[k].*member + share * samples_[k + 1].*member;
  };
  std::vector<Node> all;
  const auto add = [&](double time_s) {
    const Eigen::Vector3d rate =
        rates * (at(time_s, &ImuSample::angular_rate_rad_s) - before_.gyroscope_bias_rad_s);
    Eigen::Quaterniond rotation = from.world_from_imu;
    if (!all.empty())
      rotation = all.back().rotation *
                 quaternionExp(0.5 * (rate + all.back().rate_rad_s) * (time_s - all.back().time_s));
    all.push_back({time_s, rate, at(time_s + before_.accelerometer_delay_s, &ImuSample::specific_force_m_s2),
                   rotation});
  };
  for (std::size_t k = 0; k + 1 < times_s_.size(); ++k) {
    if (times_s_[k + 1] <= from.time_s || times_s_[k] >= to.time_s) continue;
    add(std::max(times_s_[k], from.time_s));
    if (times_s_[k + 1] >= to.time_s) add(to.time_s);
  }
  return all;
}

// Trapezoidal integration; the gyroscope's error at the second pose is distributed evenly.
TrajectorySegment::Interval TrajectorySegment::integrated() const {
  const TimedPose &from = poses_[from_], &to = poses_[to_];
  const std::vector<Node> all = nodes();
  const Eigen::Vector3d missed = quaternionLog(all.back().rotation.conjugate() * to.world_from_imu);
  Interval interval;
  interval.from_s = from.time_s;
  interval.length_s = to.time_s - from.time_s;
  interval.velocity.setZero();
  interval.position.setZero();
  interval.from_m = from.position_m;
  interval.to_m = to.position_m;
  interval.from_rotation = from.world_from_imu.toRotationMatrix();
  interval.to_rotation = to.world_from_imu.toRotationMatrix();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double share = (all[k].time_s - from.time_s) / interval.length_s;
    const double before_s = k > 0 ? all[k].time_s - all[k - 1].time_s : 0.0,
                 after_s = k + 1 < all.size() ? all[k + 1].time_s - all[k].time_s : 0.0;
    const Eigen::Matrix<double, 3, kAccelerometerNumbers> row =
        0.5 * (before_s + after_s) * (all[k].rotation * quaternionExp(share * missed)).toRotationMatrix() *
        forceRow(all[k].force_m_s2);
    interval.velocity += row;
    interval.position += (to.time_s - all[k].time_s) * row;
  }
  return interval;
}

void TrajectorySegment::close() {
  if (!isWhole()) {
    endLag();
    return;
  }
  intervals_.push_back(integrated());
  if (poses_[to_].time_s - intervals_.front().from_s >= options_.lag_s) endLag();
}

void TrajectorySegment::finish() {
  endLag();
}

// v_i = (p_i+1 - p_i - S_i) / T_i and v_i = v_i-1 + V_i-1, so that
//   (p_i+1 - p_i) / T_i - (p_i - p_i-1) / T_i-1 = S_i / T_i - S_i-1 / T_i-1 + V_i-1
LagRows TrajectorySegment::rows() const {
  const auto count = static_cast<Eigen::Index>(intervals_.size()) - 1;
  LagRows rows;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    rows.jacobian[axis] = Eigen::MatrixXd(count, kUnknowns);
    rows.measured[axis] = Eigen::VectorXd(count);
  }
  for (const Interval& each : intervals_) rows.lengths_s.push_back(each.length_s);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Interval &before = intervals_[static_cast<std::size_t>(i)],
                   &after = intervals_[static_cast<std::size_t>(i) + 1];
    const double t0 = before.length_s, t1 = after.length_s;
    Eigen::Matrix<double, 3, kUnknowns> jacobian;
    jacobian << after.position / t1 - before.position / t0 + before.velocity,
        0.5 * (t0 + t1) * Eigen::Matrix3d::Identity(),
        // The IMU is at p + R lever.
        -((after.to_rotation - after.from_rotation) / t1 - (before.to_rotation - before.from_rotation) / t0);
    const Eigen::Vector3d measured = (after.to_m - after.from_m) / t1 - (before.to_m - before.from_m) / t0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      rows.jacobian[static_cast<std::size_t>(axis)].row(i) = jacobian.row(axis);
      rows.measured[static_cast<std::size_t>(axis)][i] = measured[axis];
    }
  }
  return rows;
}

void TrajectorySegment::endLag() {
  constexpr double kShortest = 0.5;  // relative to a lag
  constexpr std::size_t kFewest = 10;
  if (intervals_.size() >= kFewest &&
      intervals_.back().from_s - intervals_.front().from_s >= kShortest * options_.lag_s) {
    LagEstimate lag = estimate(rows(), accelerometerNumbers(before_), gravity_m_s2_, density_);
    lag.from_s = intervals_.front().from_s;
    lag.to_s = intervals_.back().from_s + intervals_.back().length_s;
    lags_.push_back(lag);
  }
  intervals_.clear();
}

LagSum sumOfLags(const std::vector<LagEstimate>& lags, const AccelerometerVector& before) {
  LagSum sum;
  for (const LagEstimate& lag : lags) {
    sum.information += lag.information;
    sum.score += lag.score;
  }
  AccelerometerMatrix whole = sum.information;
  whole.diagonal() += weaklyHeld();
  const Eigen::LDLT<AccelerometerMatrix> solver(whole);
  sum.covariance = solver.solve(AccelerometerMatrix::Identity());
  const AccelerometerVector change = solver.solve(sum.score);
  sum.now = before + change;
  // Errors of a trajectory are correlated in time; differences between segments beyond chance reveal them.
  double squares = 0.0;
  for (const LagEstimate& lag : lags) {
    const AccelerometerVector off = lag.now - sum.now;
    squares += off.dot(lag.covariance.ldlt().solve(off));
  }
  const double freedom =
      static_cast<double>(kAccelerometerNumbers) * (static_cast<double>(lags.size()) - 1.0);
  constexpr double kByChance = 0.01;
  if (freedom > 0.0 && squares > chiSquaredLimit(kByChance, static_cast<int>(freedom)))
    sum.inflation = squares / freedom;
  sum.information /= sum.inflation;
  sum.score /= sum.inflation;
  sum.covariance *= sum.inflation;
  return sum;
}

TurnAgreement turnAgreement(const std::vector<Eigen::Vector3d>& of_body,
                            const std::vector<Eigen::Vector3d>& of_imu) {
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  double body = 0.0, imu = 0.0;
  for (std::size_t k = 0; k < of_body.size(); ++k) {
    products += of_imu[k] * of_body[k].transpose();
    body += of_body[k].squaredNorm();
    imu += of_imu[k].squaredNorm();
  }
  const Eigen::Matrix3d rotation = bestRotation(products).matrix;
  TurnAgreement agreement;
  agreement.imu_from_body = Eigen::Quaterniond(rotation);
  const double scale = std::sqrt(body * imu);
  agreement.correlation = scale > 0.0 ? (rotation.transpose() * products).trace() / scale : 0.0;
  return agreement;
}

}  // namespace evical
