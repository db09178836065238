// Cameras that are one sensor, as a DAVIS's events and frames: what they have in common is one quantity, whether they
// do have it in common is tested (Rao's score test, as of what is held), and how much later one stamps what both see follows.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/optimisation/optimisation_options.h"

#include <string>
#include <vector>

namespace evical {

struct ProjectedInformation;

// Which cameras do not see as the sensor they are said to be does; empty without any. `information` is of a solution
// with, or without, one pose and lens for both, and with those of both free.
std::string doubtOfSensors(const CalibrationInput& input, const CalibrationState& state,
                           const ProjectedInformation& information, const OptimisationOptions& options);

// With one quantity in place of two, where options ask for that.
ProjectedInformation withSharedSensors(const CalibrationInput& input, const OptimisationOptions& options,
                                       ProjectedInformation information);

// What the report says of a sensor holds for all cameras that are it.
void reportSharedSensors(const CalibrationInput& input, const OptimisationOptions& options,
                         UncertaintyReport& report);

std::vector<SensorLatency> sensorLatencies(const CalibrationInput& input, const CalibrationState& state,
                                           const UncertaintyReport& report);

}  // namespace evical
