// Given values and priors of the session, in the batch.
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

// True if the options allow a quantity to be estimated. A gyroscope's rotation or a drift with a prior that
// has a sigma needs no option.
bool isReleased(const QuantityInfo& info, const OptimisationOptions& options, bool weighed);

// Value of a quantity that is neither released nor has a prior; nullopt if nobody requests one.
template <class Known>
std::optional<Known> heldWithoutPrior([[maybe_unused]] const QuantityInfo& info) {
  if constexpr (std::is_same_v<Known, KnownNumber>)
    if (info.id == QuantityId::TimeOffset || info.id == QuantityId::AccelerometerDelay)
      return KnownNumber{0.0};
  if constexpr (std::is_same_v<Known, KnownMapping>) return KnownMapping{Eigen::Matrix3d::Identity()};
  return std::nullopt;
}

// A quantity's prior, without sigmas if the quantity is not released.
template <class Known>
std::optional<Known> effectivePrior(const QuantityInfo& info, const OptimisationOptions& options,
                                    const std::optional<Known>& prior) {
  if (isReleased(info, options, prior && prior->sigma)) return prior;
  return prior ? std::optional(Known{prior->value, {}}) : heldWithoutPrior<Known>(info);
}

// Replaces values of the state by given ones, and by the fixed values of groups that are not free.
void setGivenValues(const CalibrationInput& input, const OptimisationOptions& options,
                    CalibrationState& state);

// Fixed quantities, except the reference's own pose: "left.time_offset", "imu.gyroscope_bias".
std::vector<std::string> givenQuantities(const CalibrationInput& input, const OptimisationOptions& options);

}  // namespace evical
