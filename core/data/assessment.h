// Comparison of new data with an old result, quantity by quantity: the common part of `evical check`, `evical
// maintain` and `evical repeat`.
#pragma once

#include <cmath>
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
  std::string sensor, against;        // `against`: the sensor that it is relative to; may be empty
  std::string quantity, title, unit;  // "translation", "lever arm", "mm"
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

}  // namespace evical
