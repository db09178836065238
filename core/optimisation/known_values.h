// Values that the session gives, and values that it weighs, in the batch.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/data/quantity.h"
#include "core/optimisation/optimisation_options.h"

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace evical {

// Whether the options let a quantity be estimated. A gyroscope's rotation or a drift with a prior that is to
// be weighed needs no option of its own.
bool isReleased(const QuantityInfo& info, const OptimisationOptions& options, bool weighed);

// What a quantity is held at that is not released and has no prior; nothing where nobody asks for it.
template <class Known>
std::optional<Known> heldWithoutPrior([[maybe_unused]] const QuantityInfo& info) {
  if constexpr (std::is_same_v<Known, KnownNumber>)
    if (info.id == QuantityId::TimeOffset || info.id == QuantityId::AccelerometerDelay)
      return KnownNumber{0.0};
  if constexpr (std::is_same_v<Known, KnownMapping>) return KnownMapping{Eigen::Matrix3d::Identity()};
  return std::nullopt;
}

// What counts as known of a quantity: its prior, without sigmas where the quantity is not released.
template <class Known>
std::optional<Known> effectivePrior(const QuantityInfo& info, const OptimisationOptions& options,
                                    const std::optional<Known>& prior) {
  if (isReleased(info, options, prior && prior->sigma)) return prior;
  return prior ? std::optional(Known{prior->value, {}}) : heldWithoutPrior<Known>(info);
}

// What is given, and what groups that are not free stay at, in place of what the state has.
void setGivenValues(const CalibrationInput& input, const OptimisationOptions& options,
                    CalibrationState& state);

// What is held besides the reference's own place: "left.time_offset", "imu.gyroscope_bias".
std::vector<std::string> givenQuantities(const CalibrationInput& input, const OptimisationOptions& options);

}  // namespace evical
