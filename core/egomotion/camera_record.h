// One camera's data from a recording: the motion of every window, and edges for the joint fit.
#pragma once

#include "core/egomotion/egomotion_options.h"
#include "core/egomotion/lens_rays.h"

#include "core/data/edge_slope.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace evical {

// The camera's motion in a short window of time, from the speed of edges along their normals
// (docs/maths.md, 16.2). The image of a point at (x, y) = (X/Z, Y/Z) moves by A(x, y) w + B(x, y) v / Z, and
// the time at which an edge passes has the slope g with g . (A w + B v / Z) = 1. This is valid for any static
// scene.

// Outcome of a window. In the order of windowUseWords.
enum class WindowUse {
  Used,
  FewEdges,      // too few with a speed
  HardlyMoving,  // the image is nearly at rest
  NotExplained,  // most edges do not move as in a static scene
  Uncertain,     // no direction of the rotation is determined
  NoGyroscope,   // the IMU has no samples at that time
  OutOfLine,     // contradicts the other windows by more than their scatter
};
inline constexpr std::size_t kWindowUses = 7;
const char* windowUseWords(WindowUse use);

struct WindowMotion {
  static constexpr std::size_t kParts = 8;

  WindowUse use = WindowUse::FewEdges;
  double begin_s = 0.0, end_s = 0.0;             // on the camera's clock since the recording's start
  std::array<double, kParts> part_weights = {};  // of equal parts of the window; their sum is 1
  std::size_t slopes = 0;
  double inliers = 0.0;                                  // share of slopes that the motion explains
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();  // of the camera, in its frame
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  bool rotation_alone = false;  // rotation alone explains the edges equally well

  double middle_s() const { return 0.5 * (begin_s + end_s); }
};

struct WindowTime {
  std::int64_t start_ns = 0;  // of the recording
  std::int64_t begin_ns = 0;  // of the window
};

// `use` is Used, or the reason why it is not used.
WindowMotion estimateWindowMotion(std::span<const EdgeSlope> slopes, const LensRays& lens, WindowTime time,
                                  const EgomotionOptions& options);

// Slopes of windows, in bounded memory: if a window has more than options.kept_slopes, every second, third,
// ... is kept; with more than options.kept_windows windows, every second, fourth, ... window.
class KeptSlopes {
 public:
  struct Window {
    std::size_t index = 0;  // in the recording
    std::int64_t begin_ns = 0;
    std::vector<EdgeSlope> slopes;
  };

  // Windows in order.
  void add(std::size_t index, std::int64_t begin_ns, std::span<const EdgeSlope> slopes,
           const EgomotionOptions& options);
  const std::vector<Window>& windows() const { return windows_; }

 private:
  std::size_t every_ = 1;
  std::vector<Window> windows_;
};

struct CameraRecord {
  std::vector<WindowMotion> windows;
  KeptSlopes slopes;
};

}  // namespace evical
