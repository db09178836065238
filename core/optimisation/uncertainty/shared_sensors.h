// Cameras that are one sensor, as a DAVIS's events and frames: common quantities are estimated once. A score
// test (Rao) checks whether they are equal, and the latency between both streams is computed.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/optimisation/optimisation_options.h"

#include <string>
#include <vector>

namespace evical {

struct ProjectedInformation;

// Cameras that contradict their declaration as one sensor; empty without any. `information` is of a solution
// with, or without, one pose and lens for both, and with those of both free.
std::string doubtOfSensors(const CalibrationInput& input, const CalibrationState& state,
                           const ProjectedInformation& information, const OptimisationOptions& options);

// Merges the two quantities into one, if options request it.
ProjectedInformation withSharedSensors(const CalibrationInput& input, const OptimisationOptions& options,
                                       ProjectedInformation information);

// Copies the sensor's report to all of its cameras.
void reportSharedSensors(const CalibrationInput& input, const OptimisationOptions& options,
                         UncertaintyReport& report);

std::vector<SensorLatency> sensorLatencies(const CalibrationInput& input, const CalibrationState& state,
                                           const UncertaintyReport& report);

}  // namespace evical
