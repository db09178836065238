// Observations of the board: its points over time, each with its own time, covariance and velocity. All
// points are called circles, which is what event cameras detect; corners are circles of radius 0.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// One circle in one window. All pixel quantities are *ideal* pixels (camera_model.h) if the camera's
// intrinsics are known, else the sensor's own pixels.
struct CircleObservation {
  int circle = 0;  // index on the board, Board::index
  double time_s =
      0.0;  // camera clock, since the recording's start: where centre and velocity are uncorrelated
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  // of the ellipse
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Identity();
  Eigen::Vector2d velocity_px_s = Eigen::Vector2d::Zero();
  // Shift of the centre (ideal pixels) per pixel of edge localisation bias.
  Eigen::Vector2d edge_localisation_bias_effect = Eigen::Vector2d::Zero();
  Eigen::Vector2d semi_axes_px = Eigen::Vector2d::Zero();  // major, minor
  double angle_rad = 0.0;                                  // of the major axis, from x towards y
  int events = 0;                                          // edge bursts in the fit
  double residual_rms_px = 0.0;                            // of those, normal to the ellipse
  // Frames only: the sensor's row minus the middle row. Lines are exposed one after the other; time_s is the
  // middle row's.
  double rows_below_middle = 0.0;
  // Exposure minus the mean exposure, frames only; 0 if unknown.
  double longer_exposed_s = 0.0;
};

// Corners are measured from their edges. If the motion was along one of the two lines, the place along the
// other one is unknown, and its sigma is many pixels. The direction in which such a corner is known; empty if
// it is known in all directions.
std::optional<Eigen::Vector2d> onlyKnownDirection(const Eigen::Matrix2d& covariance_px2);

enum class ViewKind { Complete, Partial };

// The board in one window.
struct BoardView {
  double time_s = 0.0;  // middle of the window
  ViewKind kind = ViewKind::Complete;
  std::vector<CircleObservation> circles;  // in order of circle index; some may be missing
};

// Why a window has no board: the first stage that failed.
enum class WindowOutcome {
  Complete,
  Partial,
  TooFewEvents,      // near standstill, or no board in view
  TooFewCircles,     // fewer candidates than a partial grid needs
  NoLattice,         // candidates do not form a lattice
  TooFewInGrid,      // lattice found, too few circles on it
  Ambiguous,         // several placements on the board fit equally well
  RefinementFailed,  // circles lost in the joint fit
  Blurred,           // frame: the board moved too far during the exposure
  Unreadable,        // frame: its picture is damaged
  RejectedByHand,    // the board was found; rejected by a user because of its residuals
  TooSmall,          // the board was found, but most of its edges are too close together in the image
  OtherPattern,      // corners were found, but the tags between them are others
};
inline constexpr std::size_t kWindowOutcomeCount = 13;
const char* windowOutcomeName(WindowOutcome outcome);  // for tables and logs

struct WindowReport {
  double time_s = 0.0;  // middle
  double half_width_s = 0.0;
  WindowOutcome outcome = WindowOutcome::TooFewEvents;
  int events = 0;        // bursts in it
  int candidates = 0;    // circles proposed
  int circles = 0;       // in the final grid
  bool tracked = false;  // predicted from an adjacent window instead of searched
};

// Evidence for whether the lattice of circles has the board's size, along its rows or its columns. The counts
// are of views that show a decisive place: the lines of circles one step beyond the board, and the board's
// own outermost lines.
struct LatticeEnds {
  int beyond_in_view = 0, beyond_seen = 0;  // circles beyond the board: it is larger
  int edge_in_view = 0, edge_missing = 0;   // missing circles on the board: it is smaller
  int lines = 0, lines_lead = 0;  // number of lines in most views that show both ends, by so many views more
};
struct BoardExtent {
  LatticeEnds rows, cols;
};

// Additional delay of ON edges compared with OFF edges in a camera's pixels; the camera's time offset
// contains the mean of both.
struct PolarityDelay {
  double later_s = 0.0, std_s = 0.0;
};

// Source of the points: the front end for events, the one for frames, or another program.
enum class CameraKind { Events, Frames, Points };

struct BoardObservations {
  std::string camera;
  CameraKind kind = CameraKind::Events;
  std::vector<BoardView> views;       // in time order
  std::vector<WindowReport> windows;  // all of them, in time order
  BoardExtent extent;
  std::uint64_t events = 0;                          // number of events, frames or points read
  std::optional<PolarityDelay> polarity_delay = {};  // of events, if speeds vary enough to determine it
  double narrowest_px =
      0.0;  // largest width in which windows that are TooSmall showed the narrowest dark lines
  bool single_events = false;  // of events: edges fire about one event per pixel
  double stamp_step_s = 0.0;   // of events with rounded time stamps; 0: not rounded
};

}  // namespace evical
