// How well a calibration comes out the same from several recordings of one rig, and what they say together.
#pragma once

#include "core/data/assessment.h"
#include "core/data/calibration_status.h"

#include <string>
#include <vector>

namespace evical {

// One number of a quantity, in shown units; lists by recording, those that were calibrated. Where a recording does not
// tell it, value and sigma are NaN.
struct RepeatedNumber {
  std::string name, unit;  // "rotation.x", "deg"
  std::vector<double> values, sigmas;
  int count = 0;  // of recordings that fit and tell it: what follows is of these
  double mean = 0.0;
  double deviation = 0.0;   // over recordings; 0 with fewer than two
  double mean_sigma = 0.0;  // what the sigmas say of that: RMS, without what all recordings were told alike
  double joint = 0.0, joint_sigma = 0.0;  // of the solution of all together; sigma 0: there is none

  // How honest sigmas are: near 1 over enough recordings.
  double ratio() const { return mean_sigma > 0.0 ? deviation / mean_sigma : 0.0; }
};

struct RepeatedQuantity {
  std::string sensor, name, title;
  bool common = true;  // else each recording has its own
  std::vector<RepeatedNumber> numbers;
};

enum class RepeatOutcome { Fits, DoesNotFit, Failed };

struct RepeatedRecording {
  std::string name, file;
  RepeatOutcome outcome = RepeatOutcome::Fits;
  CalibrationStatus status = CalibrationStatus::Ok;  // of its calibration alone
  std::string reason;                                // why it failed or is doubtful, in plain words
  // Against all others that fit: by chance it is above the limit as seldom as repeat says (false_alarms).
  double chi_square = 0.0, limit = 0.0;
  int freedom = 0;                // 0: there is nothing to compare it with
  std::vector<Finding> findings;  // what differs from the others; `before` is theirs
};

// Unchanged: the recordings agree. Cannot tell: there are fewer than two of them.
struct Repeatability : Assessment {
  std::vector<RepeatedRecording> recordings;
  std::vector<std::string> columns;  // those that were calibrated, as the lists of numbers have them
  std::vector<RepeatedQuantity> quantities;
  double rms_ratio = 0.0;     // over all numbers that the recordings tell
  std::string own_values_of;  // the recording whose biases, gravity and time offsets the joint result has
  double took_s = 0.0;
};

}  // namespace evical
