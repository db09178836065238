#include "core/optimisation/known_values.h"

namespace evical {
namespace {

template <class Known, class Value>
void setIfGiven(const std::optional<Known>& known, Value& value) {
  if (isGiven(known)) value = known->value;
}

void setPlace(const SensorPrior& prior, bool offset_is_free, RigidTransform& pose, double& time_offset_s) {
  setIfGiven(prior.rotation, pose.rotation);
  setIfGiven(prior.translation, pose.translation_m);
  setIfGiven(offset_is_free ? prior.time_offset : heldTimeOffset(prior), time_offset_s);
}

Eigen::Matrix3d heldMapping(const std::optional<KnownMapping>& known) {
  return known ? known->value : Eigen::Matrix3d::Identity();
}

void appendPlace(const std::string& sensor, const SensorPrior& prior, bool offset_is_free,
                 std::vector<std::string>& names) {
  if (isGiven(prior.rotation)) names.push_back(sensor + ".rotation");
  if (isGiven(prior.translation)) names.push_back(sensor + ".translation");
  if (!offset_is_free || isGiven(prior.time_offset)) names.push_back(sensor + ".time_offset");
}

}  // namespace

void setGivenValues(const CalibrationInput& input, const OptimisationOptions& options,
                    CalibrationState& state) {
  for (std::size_t i = 0; i < state.cameras.size(); ++i) {
    if (!input.isReferenceCamera(i))
      setPlace(input.cameras[i].prior, options.free_time_offsets, state.cameras[i].reference_from_camera,
               state.cameras[i].time_offset_s);
  }
  for (std::size_t i = 0; i < state.imus.size(); ++i) {
    const ImuPrior& prior = input.imus[i].prior;
    ImuState& imu = state.imus[i];
    if (i != input.reference_imu)
      setPlace(prior, options.free_time_offsets, imu.reference_from_imu, imu.time_offset_s);
    setIfGiven(prior.gyroscope_bias, imu.gyroscope_bias_rad_s);
    setIfGiven(prior.accelerometer_bias, imu.accelerometer_bias_m_s2);
    setIfGiven(prior.gyroscope_mapping, imu.gyroscope_mapping);
    setIfGiven(prior.accelerometer_mapping, imu.accelerometer_mapping);
    if (options.free_imu_intrinsics) continue;
    imu.gyroscope_mapping = heldMapping(prior.gyroscope_mapping);
    imu.accelerometer_mapping = heldMapping(prior.accelerometer_mapping);
  }
}

std::vector<std::string> givenQuantities(const CalibrationInput& input, const OptimisationOptions& options) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < input.cameras.size(); ++i) {
    if (!input.isReferenceCamera(i))
      appendPlace(input.cameras[i].name, input.cameras[i].prior, options.free_time_offsets, names);
  }
  for (std::size_t i = 0; i < input.imus.size(); ++i) {
    const ImuData& imu = input.imus[i];
    if (i != input.reference_imu) appendPlace(imu.name, imu.prior, options.free_time_offsets, names);
    if (isGiven(imu.prior.gyroscope_bias)) names.push_back(imu.name + ".gyroscope_bias");
    if (isGiven(imu.prior.accelerometer_bias)) names.push_back(imu.name + ".accelerometer_bias");
    if (!options.free_imu_intrinsics || isGiven(imu.prior.gyroscope_mapping))
      names.push_back(imu.name + ".gyroscope_mapping");
    if (!options.free_imu_intrinsics || isGiven(imu.prior.accelerometer_mapping))
      names.push_back(imu.name + ".accelerometer_mapping");
  }
  return names;
}

}  // namespace evical
