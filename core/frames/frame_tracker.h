// Tracking of the board from frame to frame: near its prediction from the last two views, or by a search of
// the whole frame.
#pragma once

#include "core/data/board_observations.h"
#include "core/frames/board_finder.h"
#include "core/frames/frame_options.h"
#include "core/frames/gray_image.h"
#include "core/geometry/board.h"

#include <optional>
#include <string>
#include <vector>

namespace evical {

// Time of a frame, on the camera's clock since the recording's start.
struct FrameTime {
  double time_s = 0.0;
  double exposure_s = 0.0;  // 0: unknown
};

// Chooses the frames that are needed for the rate of the options.
class FrameRate {
 public:
  explicit FrameRate(const FrameOptions& options) : period_s_(1.0 / options.rate_hz) {}

  // True if the frame at this time is needed. Called for every frame, in order of time, before it is decoded.
  bool isDue(double time_s);

 private:
  double period_s_;
  std::optional<double> due_s_;
};

class FrameTracker {
 public:
  // Throws CalibrationError (BadInput) if the board is invalid.
  FrameTracker(std::string camera, const Board& board, const FrameOptions& options);

  // Processes the next frame, later than those before it; or one that could not be decoded.
  void track(const GrayImage& image, const FrameTime& time);
  void skipUnreadable(const FrameTime& time);

  // The observations: points in the sensor's own pixels, with velocities from neighbouring views, and
  // covariances that include the motion during the exposure. Views that are too blurred are excluded, with
  // that outcome. The tracker is empty afterwards.
  BoardObservations finish();

  // The finder's doubt about the board's parameters, and its remark on the print, as sentences; may be empty.
  std::string doubt() const { return finder_.doubt(); }
  std::string remark() const { return finder_.remark(); }

 private:
  struct Seen {
    FrameTime time;
    FoundPoints points;
    std::size_t window = 0;  // index of its report
  };

  std::optional<PlaneMap> predicted(double time_s) const;
  FoundPoints follow(const GrayImage& image, double time_s) const;
  FoundPoints search(const GrayImage& image, double time_s);
  void dropEarlier();  // views whose points have wrong numbers
  void report(const FrameTime& time, FoundPoints points, bool tracked);

  std::string camera_;
  Board board_;
  FrameOptions options_;
  BoardFinder finder_;
  std::vector<Seen> seen_;
  std::vector<WindowReport> windows_;
  int followed_ = 0;  // frames since the last search
};

}  // namespace evical
