// Several recordings of one rig: each calibrated alone, then all together; and which of them do not fit the others.
#pragma once

#include "core/base/progress.h"
#include "core/data/repeatability.h"
#include "core/pipeline/repeat/repeat_session.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/report/result_yaml.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace evical {

struct RepeatRun {
  Repeatability repeatability;
  // Of all that fit; as a result it is read, compared and exported like any other.
  std::optional<NamedResult> joint;
  std::size_t own_values_of = 0;  // the recording that the joint result has biases, gravity and offsets of
};

// Its stages, as progress tells them: those of a calibration of each recording as a part, then
// the comparison.
std::string partOfRepeat(const RepeatInput& input, std::size_t recording);
inline constexpr const char* kComparingStage = "compare";

// The session as each recording is calibrated; that a short one leaves sigmas large is judged of all together.
Session sessionOfRepeat(Session session);

// How one recording is calibrated: of its number, and the session that it is calibrated with.
using CalibrateOne = std::function<CalibrationOutcome(std::size_t, const Session&, const RunContext&)>;
// Told of each that is done, before the next one begins.
using RecordingDone =
    std::function<void(std::size_t, const Session&, const std::shared_ptr<const CalibrationRun>&)>;

// A recording that cannot be calibrated is listed with its reason, and the others go on. Throws Cancelled.
RepeatRun repeatCalibration(const RepeatInput& input, const CalibrateOne& calibrate,
                            const RecordingDone& done, const RunContext& context);

// From recordings.
RepeatRun repeatCalibration(const RepeatInput& input, const RecordingDone& done, const RunContext& context);

}  // namespace evical
