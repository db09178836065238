// Repeated calibration of one rig: each recording alone, then all jointly; recordings that do not fit the
// others are identified.
#pragma once

#include "core/base/progress.h"
#include "core/data/assessment.h"
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
  // Joint result of all recordings that fit; it can be read, compared and exported like any other.
  std::optional<NamedResult> joint;
  std::size_t own_values_of = 0;  // recording of the joint result's biases, gravity and time offsets
};

// Name of a recording's part in progress: each part has the stages of a calibration, then the comparison
// follows.
std::string partOfRepeat(const RepeatInput& input, std::size_t recording);
inline constexpr const char* kComparingStage = "compare";

// Session for the calibration of each recording; large sigmas are judged only in the joint result.
Session sessionOfRepeat(Session session);

// Calibrates one recording, given its index and session.
using CalibrateOne = std::function<CalibrationOutcome(std::size_t, const Session&, const RunContext&)>;
// Called after each recording, before the next one begins.
using RecordingDone =
    std::function<void(std::size_t, const Session&, const std::shared_ptr<const CalibrationRun>&)>;

// A recording that cannot be calibrated is listed with its reason, and the others go on. Throws Cancelled.
RepeatRun repeatCalibration(const RepeatInput& input, const CalibrateOne& calibrate,
                            const RecordingDone& done, const RunContext& context);

// The same with the standard calibration of each recording.
RepeatRun repeatCalibration(const RepeatInput& input, const RecordingDone& done, const RunContext& context);

}  // namespace evical
