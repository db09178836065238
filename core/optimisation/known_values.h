// Values that the session gives, and values that it weighs, in the batch.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/optimisation/optimisation_options.h"

#include <string>
#include <vector>

namespace evical {

// What is given, and what groups that are not free stay at, in place of what the state has.
void setGivenValues(const CalibrationInput& input, const OptimisationOptions& options,
                    CalibrationState& state);

// What is held besides the reference's own place: "left.time_offset", "imu.gyroscope_mapping".
std::vector<std::string> givenQuantities(const CalibrationInput& input, const OptimisationOptions& options);

}  // namespace evical
