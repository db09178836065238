// The end of a calibration, for commands that calibrate.
#pragma once

#include "app/console.h"
#include "app/session_arguments.h"
#include "core/base/file_places.h"
#include "core/pipeline/rig/calibration_pipeline.h"

namespace evical {

// Writes the result, or what there is of it, and prints it. Returns the exit code; throws as runOrThrow().
int finishCalibration(const SessionArguments& arguments, const Session& session, CalibrationOutcome outcome,
                      Console& console, const NewFolder& folder);

}  // namespace evical
