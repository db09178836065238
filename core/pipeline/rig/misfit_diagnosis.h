// Diagnosis of a misfit (docs/maths.md, 10.7): the batch is solved again with one fixed group of parameters
// free at a time. The group that explains most of the misfit is reported with its estimate.
#pragma once

#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/optimisation/batch_optimiser.h"

#include <optional>
#include <string>

namespace evical {

enum class CauseKind { GyroscopeTurned, Lens, BentBoard, LateAccelerometer };

struct Cause {
  CauseKind kind;
  std::string text;
  Repair repair;
  double explains = 0.0;  // share of the misfit's logarithm that freeing it removes
};
const char* causeName(CauseKind kind);
// Settings that free parameters which are fixed by default.
extern const Repair kFreeLenses, kFreeTurn, kFreeBow, kFreeDelay, kFreeLineDelays;

// Absent if none of the groups explains a large share.
std::optional<Cause> findCause(const CalibrationInput& input, const BatchSolution& solution,
                               const OptimisationOptions& options, const RunContext& context);

// The one place that ranks the reasons of a verdict: causes come before their symptoms, and symptoms of a
// wrong input are removed. Sets the result's reason, repair and causes.
void rankReasons(CalibrationResult& result);

}  // namespace evical
