// What was found of the board: its points over time, each with its own time, covariance and velocity. They are
// called circles, as which event cameras see them; corners are circles of radius 0.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// One circle in one window. All pixel quantities are *ideal* pixels (camera_model.h) where the camera's
// intrinsics are known, and the sensor's own otherwise.
struct CircleObservation {
  int circle = 0;  // index on the board, Board::index
  double time_s =
      0.0;  // camera clock, since the recording's start: where centre and velocity are uncorrelated
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  // of the ellipse
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Identity();
  Eigen::Vector2d velocity_px_s = Eigen::Vector2d::Zero();
  // How far the centre moves (ideal pixels) for each pixel by which edges are seen ahead of where they are.
  Eigen::Vector2d edge_lead_effect = Eigen::Vector2d::Zero();
  Eigen::Vector2d semi_axes_px = Eigen::Vector2d::Zero();  // major, minor
  double angle_rad = 0.0;                                  // of the major axis, from x towards y
  int events = 0;                                          // edge bursts that the fit rests on
  double residual_rms_px = 0.0;                            // of those, normal to the ellipse
  // Of frames: the sensor's row less the middle one. Lines are exposed one after the other, and time_s is the middle's.
  double rows_below_middle = 0.0;
  // Of frames: their exposure less the mean of all; 0 where it is not known.
  double longer_exposed_s = 0.0;
};

enum class ViewKind { Complete, Partial };

// The board in one window.
struct BoardView {
  double time_s = 0.0;  // middle of the window
  ViewKind kind = ViewKind::Complete;
  std::vector<CircleObservation> circles;  // in order of circle index; some may be missing
};

// Why a window has no board: the first stage at which it was lost.
enum class WindowOutcome {
  Complete,
  Partial,
  TooFewEvents,      // near standstill, or nothing in view
  TooFewCircles,     // fewer candidates than a partial grid needs
  NoLattice,         // candidates that make no lattice
  TooFewInGrid,      // lattice found, too few circles on it
  Ambiguous,         // several placements on the board fit as well
  RefinementFailed,  // circles lost when all were fitted together
  Blurred,           // of a frame: the board moved too far while it was exposed
  Unreadable,        // of a frame: its picture is damaged
  RejectedByHand,    // the board was found; a person left it out after a look at its residuals
};
inline constexpr std::size_t kWindowOutcomeCount = 11;
const char* windowOutcomeName(WindowOutcome outcome);  // in plain words, for tables and logs

struct WindowReport {
  double time_s = 0.0;  // middle
  double half_width_s = 0.0;
  WindowOutcome outcome = WindowOutcome::TooFewEvents;
  int events = 0;        // bursts in it
  int candidates = 0;    // circles proposed
  int circles = 0;       // in the final grid
  bool tracked = false;  // found from its neighbour in time instead of from nothing
};

// Whether the lattice of circles ends where the board does, along its rows or along its columns. Views are
// counted in which the image shows a place that decides it: the lines of circles one step beyond the board,
// and the board's own outermost lines.
struct LatticeEnds {
  int beyond_in_view = 0, beyond_seen = 0;  // circles where the board has none: it is larger
  int edge_in_view = 0, edge_missing = 0;   // no circles where the board has some: it is smaller
};
struct BoardExtent {
  LatticeEnds rows, cols;
};

// How much later a camera's pixels tell of edges that brighten them than of edges that darken them; a camera clock's
// time offset holds the mean of both.
struct PolarityDelay {
  double later_s = 0.0, std_s = 0.0;
};

// What measured the points: the front end from events, ours from frames, or another program.
enum class CameraKind { Events, Frames, Points };

struct BoardObservations {
  std::string camera;
  CameraKind kind = CameraKind::Events;
  std::vector<BoardView> views;       // in time order
  std::vector<WindowReport> windows;  // all of them, in time order
  BoardExtent extent;
  std::uint64_t events = 0;                          // read; or frames, or points
  std::optional<PolarityDelay> polarity_delay = {};  // of events, where speeds differ enough to tell
  double stamp_step_s = 0.0;  // of events whose time stamps are rounded; 0: they are fine
};

}  // namespace evical
