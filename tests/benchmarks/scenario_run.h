// A simulated recording calibrated in memory as by `evical calibrate`, against its truth.
#pragma once

#include "core/data/calibration_result.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/session/session.h"
#include "core/report/truth_comparison.h"
#include "core/synthetic/scenario.h"

#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>

namespace evical {

struct Outcome {
  std::string verdict, weakest, reason;
  double windows_found = 0.0;  // of those with enough of the board in view
  double events_per_s = 0.0;
  double detect_s = 0.0, solve_s = 0.0;
  std::optional<TruthComparison> comparison;
  std::optional<CameraUncertainty> uncertainty;  // of the camera whose translation is least certain
  std::optional<CalibrationResult> result;       // empty if it failed

  std::string verdictText() const { return verdict == "ok" ? verdict : verdict + ": " + reason; }
};

// `change` modifies the session that matches the scenario, before the calibration.
using SessionChange = std::function<void(Session&)>;
Outcome runScenario(const Scenario& scenario, const SessionChange& change = {});
// Its two steps. The first one uses the front end's default options.
DetectionResult detectScenario(const Scenario& scenario);
Outcome calibrateScenario(const Scenario& scenario, DetectionResult detections,
                          const SessionChange& change = {});
Outcome calibrateSession(const Scenario& scenario, const Session& session, DetectionResult detections);

// Errors over sigmas of many recordings. Their RMS is 1 if the sigmas are right.
struct NormalisedErrors {
  struct Sum {
    double squares = 0.0;
    int count = 0;
    double rms() const { return count == 0 ? 1.0 : std::sqrt(squares / count); }
  };
  Sum rotation, translation, time_offset, all;
  std::size_t recordings = 0;

  explicit NormalisedErrors(std::span<const Outcome> outcomes);
  bool areRight() const;  // false if an RMS of 20 recordings or more is outside 0.7 to 1.4
  bool print() const;     // returns that, too
};

// True for a number of this vector: ".rotation.", ".translation." or ".time_offset", which is not its drift.
bool isOf(const char* part, const QuantityDifference& number);

// All events are late by the delay of the pixels, and so is the estimated time offset: no data show it.
void subtractPixelDelay(double delay_s, Outcome& outcome);

// Error of the sensor with the largest one, in the report's units.
struct PartError {
  double size = 0.0, sigma = 0.0;
  double sigmas = 0.0;  // of the worst number
};
PartError rotationError_deg(const TruthComparison& comparison);
PartError translationError_mm(const TruthComparison& comparison);
PartError timeOffsetError_ms(const TruthComparison& comparison);

// A result is wrong if a number has an error of more than kWrongSigmas, and its vector one that matters.
inline constexpr double kWrongSigmas = 4.0;
inline constexpr double kWrongRotation_deg = 0.1, kWrongTranslation_mm = 3.0, kWrongTimeOffset_ms = 1.0;
bool isWrong(const Outcome& outcome);
bool isWrongOk(const Outcome& outcome);

void printQuantities(const Outcome& outcome);

CalibrationState trueState(const Scenario& scenario);

// Fraction of the distance from the principal point to the furthest image corner at which a lens of 190
// degrees ends.
double shareOfImageCircle(const CameraIntrinsics& camera);

}  // namespace evical
