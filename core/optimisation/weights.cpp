#include "core/optimisation/weights.h"

#include "core/base/time.h"
#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <cmath>

namespace evical {
namespace {

constexpr double kMinMotion_sigma = 3.0;  // RMS about the mean, in sigmas of one sample

class Spread {
 public:
  void add(const Eigen::Vector3d& value) {
    const Eigen::Vector3d step = value - mean_;
    mean_ += step / ++count_;
    sum_ += step * (value - mean_).transpose();
  }
  std::vector<Eigen::Vector3d> axesWithout(double noise_sigma) const {
    const Eigen::Matrix3d covariance = sum_ / count_;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(0.5 * (covariance + covariance.transpose()));
    const double least = (1.0 + kMinMotion_sigma * kMinMotion_sigma) * noise_sigma * noise_sigma;
    std::vector<Eigen::Vector3d> axes;
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (solver.eigenvalues()[i] < least) axes.emplace_back(solver.eigenvectors().col(i));
    }
    return axes;
  }

 private:
  double count_ = 0.0;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d sum_ = Eigen::Matrix3d::Zero();
};

}  // namespace

std::vector<Eigen::Vector3d> UnexcitedAxes::axesWithoutRotation() const {
  if (gyroscope.size() == 2) return {gyroscope[0].cross(gyroscope[1])};
  return gyroscope.size() == 3 ? gyroscope : std::vector<Eigen::Vector3d>{};
}

UnexcitedAxes stillAxes(const CalibrationInput& input, const CalibrationState& state, const Weights& weights,
                        std::size_t imu) {
  const ImuData& data = input.imus[imu];
  Spread rates;
  for (std::size_t i = 0; i < data.samples.size(); ++i) {
    const ImuSample& sample = data.samples[i];
    const double imu_time_s = secondsSince(input.start_ns, sample.time_ns);
    const auto isWithin = [&](double time_s) { return state.world_from_imu_rotation.contains(time_s); };
    if (weights.used_samples[imu].gyroscope[i] && isWithin(referenceTime_s(state.imus[imu], imu_time_s)))
      rates.add(sample.angular_rate_rad_s - state.imus[imu].gyroscopeBiasAt_rad_s(imu_time_s));
  }
  return {rates.axesWithout(weights.scales.gyroscopes[imu] * data.gyroscopeSigma_rad_s())};
}

CircleSelection allCircles(const CalibrationInput& input) {
  CircleSelection used;
  for (const CameraData& camera : input.cameras) {
    auto& views = used.emplace_back();
    for (const BoardView& view : camera.observations.views)
      views.emplace_back(view.circles.size(), std::uint8_t{1});
  }
  return used;
}

Weights givenWeights(const CalibrationInput& input) {
  Weights weights;
  weights.scales.circles.assign(input.cameras.size(), 1.0);
  weights.scales.displacements.assign(input.cameras.size(), 1.0);
  weights.scales.gyroscopes.assign(input.imus.size(), 1.0);
  weights.scales.accelerometers.assign(input.imus.size(), 1.0);
  weights.used_circles = allCircles(input);
  for (const ImuData& imu : input.imus) weights.used_samples.push_back(fitSamples(imu.samples));
  weights.held_axes.resize(input.imus.size());
  return weights;
}

}  // namespace evical
