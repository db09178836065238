#include "core/optimisation/known_values.h"

namespace evical {
namespace {

// visit(row, given value) of a sensor's given quantities; a reference has no pose.
template <class Rows, class Prior, class Visitor>
void forEachGiven(const Rows& rows, const OptimisationOptions& options, bool reference, const Prior& prior,
                  Visitor&& visit) {
  forEachPriorQuantity(rows, [&](const auto& row) {
    if (reference && row.info.relative) return;
    const auto known = effectivePrior(row.info, options, row.prior(prior));
    if (isGiven(known)) visit(row, *known);
  });
}

}  // namespace

bool isReleased(const QuantityInfo& info, const OptimisationOptions& options, bool weighed) {
  switch (info.release) {
    case QuantityRelease::Always:
      return true;
    case QuantityRelease::TimeOffsets:
      return options.free_time_offsets;
    case QuantityRelease::ImuIntrinsics:
      return options.free_imu_intrinsics;
    case QuantityRelease::GyroscopeRotation:
      return options.free_imu_intrinsics && (options.estimatesGyroscopeRotations() || weighed);
    case QuantityRelease::BoardSize:
      return options.free_board_size;
    case QuantityRelease::BoardBow:
      return options.board_bow;
    case QuantityRelease::LineDelay:
      return true;  // if the shutter rolls
    case QuantityRelease::ExposureShare:
      return true;  // if exposures vary
    case QuantityRelease::TimeOffsetDrift:
      break;
  }
  return options.free_time_offsets && (options.time_offset_drift || weighed);
}

void setGivenValues(const CalibrationInput& input, const OptimisationOptions& options,
                    CalibrationState& state) {
  for (std::size_t i = 0; i < state.cameras.size(); ++i)
    forEachGiven(kCameraQuantities, options, input.isReferenceCamera(i), input.cameras[i].prior,
                 [&](const auto& row, const auto& known) { row.value(state.cameras[i]) = known.value; });
  for (std::size_t i = 0; i < state.imus.size(); ++i)
    forEachGiven(kImuQuantities, options, i == input.reference_imu, input.imus[i].prior,
                 [&](const auto& row, const auto& known) { row.value(state.imus[i]) = known.value; });
}

std::vector<std::string> givenQuantities(const CalibrationInput& input, const OptimisationOptions& options) {
  std::vector<std::string> names;
  const auto nameOf = [&](const std::string& sensor) {
    return [&names, &sensor](const auto& row, const auto&) { names.push_back(sensor + "." + row.info.name); };
  };
  for (std::size_t i = 0; i < input.cameras.size(); ++i)
    forEachGiven(kCameraQuantities, options, input.isReferenceCamera(i), input.cameras[i].prior,
                 nameOf(input.cameras[i].name));
  for (std::size_t i = 0; i < input.imus.size(); ++i)
    forEachGiven(kImuQuantities, options, i == input.reference_imu, input.imus[i].prior,
                 nameOf(input.imus[i].name));
  return names;
}

}  // namespace evical
