// Inputs that the recording contradicts by a factor: units, sizes, lenses, noise densities
// (docs/maths.md, 10.7). A calibration with such an input converges to wrong values or fails later, with a
// symptom as its reason.
#pragma once

#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/data/calibration_result.h"
#include "core/data/quality_warning.h"
#include "core/initialisation/initialise.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "core/pipeline/session/session.h"

#include <optional>
#include <vector>

namespace evical {

// Units of an IMU's numbers that are `times` too large. If the session states no unit, the recording's format
// has one.
LikelyUnit likelyUnitOfRates(const SessionImu* imu, double times, double tolerance);
LikelyUnit likelyUnitOfForces(const SessionImu* imu, double times, double tolerance);

// The wrong input that caused a failure; the error itself if there is none. Looks for the lens in the
// recording if `recording_is_there`: this takes as long as a calibration of the lens.
CalibrationError withWrongInput(const CalibrationError& error, const Session& session,
                                const CalibrationInput& input, const Initialisation& initial,
                                bool recording_is_there, const RunContext& context);

// A wrong unit behind a solution: of accelerations by their norm, which the batch's scales may absorb, and
// behind a doubtful solution also of rates. If another input is wrong, only a ratio that a unit explains
// counts: a wrong lens changes rates, too.
std::optional<QualityWarning> wrongUnit(const Session& session, const CalibrationInput& input,
                                        const CalibrationResult& result, const RunContext& context);

// Wrong inputs of a solution, each with the value that would agree. They make any result doubtful.
std::vector<QualityWarning> wrongInputs(const Session& session, const CalibrationInput& input,
                                        const Initialisation& initial, const BatchSolution& solution,
                                        const UncertaintyEstimate& uncertainty);

// Noise densities that the recording contradicts: too small ones only with a misfit.
std::vector<QualityWarning> wrongNoise(const Session& session, const CalibrationInput& input,
                                       const BatchSolution& solution);

}  // namespace evical
