// Whether an old calibration still holds, as a new recording tells it: what came out before and now of each quantity,
// by how much it has changed, and how small a change the recording would have shown.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace evical {

enum class CheckVerdict { StillGood, Changed, CannotTell };

// One number of a quantity, in shown units. Sigmas are 0 where it was given.
struct CheckedNumber {
  std::string name, unit;                       // "rotation.x", "deg"
  double before = 0.0, before_sigma = 0.0;      // as the old result has it
  double now = 0.0, now_sigma = 0.0;            // of the new recording alone
  double together = 0.0, together_sigma = 0.0;  // of the new recording with the old result as prior
};

// A quantity of a sensor as a whole: its change has a size in one unit, of a lens the RMS over its image.
struct CheckedQuantity {
  std::string sensor, name, title, unit;
  std::vector<CheckedNumber> numbers;
  // If this alone has changed, and all else no more than it does by itself.
  double change = 0.0, change_sigma = 0.0;
  double sigmas = 0.0;        // the change by its covariance
  double limit_sigmas = 0.0;  // a change that is that far beyond `stability` is no chance
  double edge_px = 0.0;  // what it moves at most at the image's edge; 0: nothing, or not that of a camera
  double would_notice =
      0.0;                 // the smallest change that is found with a probability of 95 %, in any direction
  double stability = 0.0;  // changes up to here are none
  double matters = 0.0;    // the verdict asks that this would be noticed; 0: it does not ask
  bool changed = false;

  bool toldEnough() const { return matters <= 0.0 || would_notice <= matters; }
};

// What became of the windows of a recording without a board.
struct CheckedWindows {
  struct LeftOut {
    std::string key, words;
    std::size_t windows = 0;
  };
  std::string sensor;
  std::size_t all = 0, used = 0;
  std::size_t turning_alone = 0;  // used ones in which translation explains no more
  std::vector<LeftOut> left_out;  // for each reason
};

struct CalibrationCheck {
  CheckVerdict verdict = CheckVerdict::CannotTell;
  std::string reason;  // a sentence without its full stop
  std::vector<CheckedQuantity> quantities;
  std::vector<std::string> or_else;  // what explains the recording as well as what is said to have changed
  std::vector<std::string> advice;   // what to do, where nothing can be told
  std::vector<std::string> notes;
  bool without_board = false;              // then `windows` says what it rests on
  std::vector<CheckedWindows> windows;     // by event camera
  double false_alarms = 0.0;               // how often a calibration that has not changed is called changed
  std::string before, recording, version;  // result and recording as people know them
};

}  // namespace evical
