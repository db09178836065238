#include "core/optimisation/known_values.h"

namespace evical {
namespace {

// visit(kind, sensor's index, row, given value) of all given quantities; a reference has no pose.
template <class Visitor>
void forEachGiven(const CalibrationInput& input, const OptimisationOptions& options, Visitor&& visit) {
  forEachSensorKind([&](auto kind) {
    for (std::size_t i = 0; i < kind.of(input).size(); ++i)
      forEachPriorQuantity(kind.rows(), [&](const auto& row) {
        if (row.info.relative && kind.isReference(input, i)) return;
        const auto known = effectivePrior(row.info, options, row.prior(kind.of(input)[i].prior));
        if (isGiven(known)) visit(kind, i, row, *known);
      });
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
  forEachGiven(input, options, [&](auto kind, std::size_t i, const auto& row, const auto& known) {
    row.value(kind.of(state)[i]) = known.value;
  });
}

std::vector<std::string> givenQuantities(const CalibrationInput& input, const OptimisationOptions& options) {
  std::vector<std::string> names;
  forEachGiven(input, options, [&](auto kind, std::size_t i, const auto& row, const auto&) {
    names.push_back(kind.of(input)[i].name + "." + row.info.name);
  });
  return names;
}

}  // namespace evical
