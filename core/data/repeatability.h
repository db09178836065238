// Repeatability of a calibration over several recordings of one rig, and their joint solution.
#pragma once

#include "core/data/assessment.h"
#include "core/data/calibration_status.h"

#include <string>
#include <vector>

namespace evical {

// One number of a quantity, in display units; lists by calibrated recording. If a recording does not
// determine it, value and sigma are NaN.
struct RepeatedNumber {
  std::string name, unit;  // "rotation.x", "deg"
  std::vector<double> values, sigmas;
  int count = 0;  // recordings that fit and determine it: the following values are of these
  double mean = 0.0;
  double deviation = 0.0;   // over recordings; 0 with fewer than two
  double mean_sigma = 0.0;  // expected deviation: RMS of sigmas, without priors common to all recordings
  double joint = 0.0, joint_sigma = 0.0;  // of the joint solution; sigma 0: none

  // Ratio of deviation and sigma: near 1 over enough recordings if sigmas are calibrated.
  double ratio() const { return mean_sigma > 0.0 ? deviation / mean_sigma : 0.0; }
};

struct RepeatedQuantity {
  std::string sensor, name, title;
  bool common = true;  // false: separate for each recording
  std::vector<RepeatedNumber> numbers;
};

enum class RepeatOutcome { Fits, DoesNotFit, Failed };

struct RepeatedRecording {
  std::string name, file;
  RepeatOutcome outcome = RepeatOutcome::Fits;
  CalibrationStatus status = CalibrationStatus::Ok;  // of its separate calibration
  std::string reason;                                // why it failed or is doubtful
  // Test against all others that fit; the limit follows from the false alarm rate (false_alarms).
  double chi_square = 0.0, limit = 0.0;
  int freedom = 0;                // 0: no comparison is possible
  std::vector<Finding> findings;  // differences from the others; `before` is their value
};

// Unchanged: the recordings agree. Cannot tell: there are fewer than two of them.
struct Repeatability : Assessment {
  std::vector<RepeatedRecording> recordings;
  std::vector<std::string> columns;  // calibrated recordings, in the order of the lists of numbers
  std::vector<RepeatedQuantity> quantities;
  double rms_ratio = 0.0;     // over all numbers that the recordings determine
  std::string own_values_of;  // recording whose biases, gravity and time offsets are in the joint result
  double took_s = 0.0;
};

}  // namespace evical
