// Follows the board from frame to frame: where the last two views put it, or by a search of all of the frame.
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

// When a frame was taken, on the camera's clock since the recording's start.
struct FrameTime {
  double time_s = 0.0;
  double exposure_s = 0.0;  // 0: not known
};

class FrameTracker {
 public:
  // Throws CalibrationError (BadInput) where the board's numbers make no board.
  FrameTracker(std::string camera, const Board& board, const FrameOptions& options);

  // Whether a frame of this time is wanted, at the rate of the options: asked of every frame, in order of time,
  // before it is decoded.
  bool isDue(double time_s);

  // The next frame, later than those before it; one that could not be decoded.
  void track(const GrayImage& image, const FrameTime& time);
  void skipUnreadable(const FrameTime& time);

  // What was seen: the points in the sensor's own pixels, with velocities that neighbouring views tell and
  // covariances that hold the motion while the frame was exposed. Views that are too blurred are left out, with
  // an outcome that says so. The tracker is empty afterwards.
  BoardObservations finish();

  // Of the finder, in a sentence; empty where nothing speaks against the board's numbers.
  std::string doubt() const { return finder_.doubt(); }

 private:
  struct Seen {
    FrameTime time;
    FoundPoints points;
    std::size_t window = 0;  // its report
  };

  std::optional<PlaneMap> predicted(double time_s) const;
  FoundPoints follow(const GrayImage& image, double time_s) const;
  FoundPoints search(const GrayImage& image, double time_s);
  void report(const FrameTime& time, FoundPoints points, bool tracked);

  std::string camera_;
  Board board_;
  FrameOptions options_;
  BoardFinder finder_;
  std::vector<Seen> seen_;
  std::vector<WindowReport> windows_;
  std::optional<double> due_s_;
  int followed_ = 0;  // frames since the last search
};

}  // namespace evical
