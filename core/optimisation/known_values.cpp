#include "core/optimisation/known_values.h"

#include "core/optimisation/calibration_problem.h"
#include "core/optimisation/prior_cost.h"

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

Eigen::Matrix<double, 6, 1> upperTriangle(const Eigen::Matrix3d& mapping) {
  Eigen::Matrix<double, 6, 1> entries;
  parametersFromMapping(mapping, entries.data());
  return entries;
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

// Without a cost the value is given.
void CalibrationProblem::addKnown(double* block, ceres::CostFunction* cost) {
  if (cost != nullptr)
    blocks_.push_back({problem_->AddResidualBlock(cost, nullptr, block)});
  else if (problem_->HasParameterBlock(block))
    problem_->SetParameterBlockConstant(block);
}

void CalibrationProblem::addKnownPlace(const SensorPrior& prior, RigidTransform& pose,
                                       double& time_offset_s) {
  if (!problem_->HasParameterBlock(pose.rotation.coeffs().data())) return;  // the sensor is not in yet
  if (const auto& known = prior.rotation)
    addKnown(pose.rotation.coeffs().data(),
             known->isGiven() ? nullptr : new RotationPriorCost(known->value, *known->sigma));
  if (const auto& known = prior.translation)
    addKnown(pose.translation_m.data(),
             known->isGiven() ? nullptr : new PriorCost(known->value, *known->sigma));
  const std::optional<KnownNumber> offset =
      options_.free_time_offsets ? prior.time_offset : heldTimeOffset(prior);
  if (offset)
    addKnown(&time_offset_s, offset->isGiven() ? nullptr : new PriorCost(&offset->value, 1, *offset->sigma));
}

void CalibrationProblem::addKnownValues() {
  const auto addBias = [&](const std::optional<KnownVector>& known, Eigen::Vector3d& bias) {
    if (known) addKnown(bias.data(), known->isGiven() ? nullptr : new PriorCost(known->value, *known->sigma));
  };
  const auto addMapping = [&](const std::optional<KnownMapping>& known, std::array<double, 6>& mapping) {
    if (known)
      addKnown(mapping.data(),
               known->isGiven() ? nullptr
                                : new PriorCost(upperTriangle(known->value), upperTriangle(*known->sigma)));
  };
  for (std::size_t i = 0; i < state_.cameras.size(); ++i) {
    if (!input_.isReferenceCamera(i))
      addKnownPlace(input_.cameras[i].prior, state_.cameras[i].reference_from_camera,
                    state_.cameras[i].time_offset_s);
  }
  for (std::size_t i = 0; i < state_.imus.size(); ++i) {
    const ImuPrior& prior = input_.imus[i].prior;
    ImuState& imu = state_.imus[i];
    if (!problem_->HasParameterBlock(imu.gyroscope_bias_rad_s.data())) continue;
    if (!isReference(i)) addKnownPlace(prior, imu.reference_from_imu, imu.time_offset_s);
    addBias(prior.gyroscope_bias, imu.gyroscope_bias_rad_s);
    addBias(prior.accelerometer_bias, imu.accelerometer_bias_m_s2);
    addMapping(prior.gyroscope_mapping, gyroscope_mappings_[i]);
    addMapping(prior.accelerometer_mapping, accelerometer_mappings_[i]);
  }
}

}  // namespace evical
