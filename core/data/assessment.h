// Comparison of new data with an old result, quantity by quantity: the common part of `evical check`, `evical
// maintain` and `evical repeat`.
#pragma once

#include "core/data/calibration_status.h"
#include "core/data/quantity_address.h"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace evical {

enum class Verdict { Unchanged, Changed, CannotTell };

// An optional number. Its sigma is 0 if the number was given.
struct ValueWithSigma {
  double value = std::numeric_limits<double>::quiet_NaN(), sigma = 0.0;

  bool isKnown() const { return !std::isnan(value); }
};

// One number of a quantity, in shown units.
struct ComparedNumber {
  std::string name, unit;      // "rotation.x", "deg"
  ValueWithSigma before = {};  // in the old result
  ValueWithSigma now = {};     // from the new data alone
  ValueWithSigma joint = {};   // from the new data with the old result as prior
  ValueWithSigma change = {};  // of a step, which has no other values
};

// Data that a finding is based on.
enum class FindingSource { Recording, Stops, Trajectory, OtherImu };

// A quantity of one sensor: its change has a size in one unit; for a lens it is the RMS over its image.
struct Finding {
  std::string sensor, against;  // `against`: the sensor that it is relative to; may be empty
  QuantityId id = QuantityId::Rotation;
  std::string quantity, title, unit;  // as shown: "translation", "lever arm", "mm"
  FindingSource source = FindingSource::Recording;
  std::vector<ComparedNumber> numbers;
  // The change if only this quantity has changed, and all others at most by the allowed drift.
  double change = 0.0, change_sigma = 0.0;
  double sigmas = 0.0;                      // size of the change relative to its covariance
  double limit_sigmas = 0.0;                // limit of `sigmas`, which allows for `allowed_drift`
  double edge_px = 0.0;                     // largest shift at the image's edge; 0: none, or not of a camera
  double smallest_detectable_change = 0.0;  // detected with a probability of 95 %, in any direction
  double allowed_drift = 0.0;               // changes up to this size are ignored
  double required_detectability = 0.0;      // size of change that the verdict must be able to exclude; 0: any
  bool changed = false;
  std::vector<std::string> alternatives;  // other quantities whose change explains the data equally well

  bool isConclusive() const {
    return required_detectability <= 0.0 || smallest_detectable_change <= required_detectability;
  }
  Verdict verdict() const {
    if (changed) return Verdict::Changed;
    return isConclusive() ? Verdict::Unchanged : Verdict::CannotTell;
  }
};

struct Assessment {
  Verdict verdict = Verdict::CannotTell;
  std::string reason;  // a sentence without full stop
  std::vector<Finding> findings;
  std::vector<std::string> advice;  // what to do
  std::vector<std::string> notes;
  double false_alarms = 0.0;  // upper bound on the share of unchanged cases that are reported as changed
  std::string before;         // name of the old result; may be empty
  std::vector<std::string> inputs;  // names of recordings or logs
  std::string version;
};

// Check of an old calibration with a new recording.

// Use of the windows of a recording without a board.
struct CheckedWindows {
  struct LeftOut {
    std::string key, words;
    std::size_t windows = 0;
  };
  std::string sensor;
  std::size_t all = 0, used = 0;
  std::size_t turning_alone = 0;  // used windows in which a translation does not improve the fit
  std::vector<LeftOut> left_out;  // by reason
};

struct CalibrationCheck : Assessment {
  bool without_board = false;           // if true, `windows` has the data used
  std::vector<CheckedWindows> windows;  // by event camera
};

// Result of the maintenance of calibrated IMUs with a log: changes since the calibration, changes during the
// log with their times, and the smallest detectable change.

// A change during the log; `against` is empty if several IMUs identify the one that changed.
struct MaintenanceStep : Finding {
  double at_s = 0.0, noticed_s = 0.0;  // since the log's start, on the reference IMU's clock
};

struct MaintainedStop {
  double from_s = 0.0, to_s = 0.0;
  Eigen::Vector3d force_m_s2 = Eigen::Vector3d::Zero(),
                  rate_rad_s = Eigen::Vector3d::Zero();  // means, as measured
  double residual_m_s2 = 0.0,
         sigma_m_s2 = 0.0;  // of |M^-1 (f - b)| minus gravity, with the current parameters
  bool used = true;
};

// Data of one IMU.
struct MaintainedImu {
  std::string name, stream;
  double from_s = 0.0, to_s = 0.0, rate_hz = 0.0;
  std::vector<MaintainedStop> stops;
  std::string weakest;  // the direction that stops constrain least; empty without stops
  double weakest_sigma = 0.0;
  double misfit = 0.0;  // RMS of the stops' normalised residuals; 0: too few stops
};

// A quantity over time, number by number.
struct TrackedNumber {
  std::string name;  // "x"; empty for scalar quantities
  std::vector<double> values, sigmas;
};
struct TrackedQuantity {
  std::string name, title, unit;
  std::vector<TrackedNumber> numbers;
};
struct MaintenanceTrack {
  std::string sensor, against;
  std::vector<double> times_s;
  std::vector<TrackedQuantity> quantities;
};

// True if a step is visible in a track: a step of the same pair, or of the IMU that the track is relative to.
inline bool isIn(const MaintenanceStep& step, const MaintenanceTrack& track) {
  return step.sensor == track.sensor ? step.against == track.against
                                     : step.against.empty() && step.sensor == track.against;
}

struct Maintenance : Assessment {
  std::vector<MaintainedImu> imus;
  std::vector<MaintenanceStep> steps;
  std::vector<MaintenanceTrack> tracks;
  double duration_s = 0.0, took_s = 0.0, memory_peak_mb = 0.0;
};

// Repeatability of a calibration over several recordings of one rig, and their joint solution.

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
