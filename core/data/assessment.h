// Comparison of new data with an old result, quantity by quantity: the common part of `evical check`, `evical maintain` and
// `evical repeat`.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace evical {

enum class Verdict { Unchanged, Changed, CannotTell };

// A number that may be missing. Its sigma is 0 where the number was given.
struct ValueWithSigma {
  double value = std::numeric_limits<double>::quiet_NaN(), sigma = 0.0;

  bool isThere() const { return !std::isnan(value); }
};

// One number of a quantity, in shown units.
struct ComparedNumber {
  std::string name, unit;      // "rotation.x", "deg"
  ValueWithSigma before = {};  // as the old result has it
  ValueWithSigma now = {};     // of the new data alone
  ValueWithSigma joint = {};   // of the new data with the old result as prior
  ValueWithSigma change = {};  // of a step, which has nothing else
};

// Data that a finding is based on.
enum class FindingSource { Recording, Stops, Trajectory, OtherImu };

// A quantity of a sensor as a whole: its change has a size in one unit, of a lens the RMS over its image.
struct Finding {
  std::string sensor, against;        // `against`: the sensor that it is relative to; empty: none is named
  std::string quantity, title, unit;  // "translation", "lever arm", "mm"
  FindingSource source = FindingSource::Recording;
  std::vector<ComparedNumber> numbers;
  // If only this has changed, and all others by no more than they may.
  double change = 0.0, change_sigma = 0.0;
  double sigmas = 0.0;        // the change by its covariance
  double limit_sigmas = 0.0;  // significant beyond `allowed_drift`
  double edge_px = 0.0;  // what it moves at most at the image's edge; 0: nothing, or not that of a camera
  double smallest_detectable_change = 0.0;  // found with a probability of 95 %, in any direction
  double allowed_drift = 0.0;               // changes up to this size are ignored
  double required_detectability = 0.0;      // a change that the verdict must be able to exclude; 0: any
  bool changed = false;
  std::vector<std::string> alternatives;  // other quantities whose change explains the data as well

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
  std::string reason;  // a sentence without its full stop
  std::vector<Finding> findings;
  std::vector<std::string> advice;  // what to do
  std::vector<std::string> notes;
  double false_alarms = 0.0;        // upper bound of the share of unchanged cases that are called changed
  std::string before;               // the old result as people know it; empty: there is none
  std::vector<std::string> inputs;  // recordings or logs as people know them
  std::string version;
};

}  // namespace evical
