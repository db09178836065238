// What could explain a misfit is tried: the batch is solved once more with each of some things free that it holds
// (docs/maths.md, 10.7), and the one that explains most of the misfit is told, with its number.
#pragma once

#include "core/base/progress.h"
#include "core/base/repair.h"
#include "core/data/calibration_setup.h"
#include "core/optimisation/batch_optimiser.h"

#include <optional>
#include <string>

namespace evical {

enum class CauseKind { GyroscopeTurned, Lens, BentBoard };

struct Cause {
  CauseKind kind;
  std::string text;
  Repair repair;
  double explains = 0.0;  // the share of the misfit's logarithm that is gone where it is let free
};
const char* causeName(CauseKind kind);
// What sets free that is held otherwise.
extern const Repair kFreeLenses, kFreeTurn, kFreeBow;

// Nothing where none of them explains much.
std::optional<Cause> findCause(const CalibrationInput& input, const BatchSolution& solution,
                               const OptimisationOptions& options, const RunContext& context);

}  // namespace evical
