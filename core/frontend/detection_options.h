// The front end's options, one table per stage. Lengths in px are the sensor's own pixels.
#pragma once

#include "core/base/option_row.h"

namespace evical {

// Edge timing (docs/maths.md, 4).
struct BurstOptions {
  int min_events;
  double max_gap_s;
  double min_gap_s;
  double gap_to_pace;
  double max_burst_s;
  // Not an option: edges with fewer events are handed out, too, as crossings of 0 events (burstsFor).
  bool single_events = false;

  BurstOptions();  // the defaults
  constexpr explicit BurstOptions(NoDefaults) {}
  bool operator==(const BurstOptions&) const = default;
  static const OptionTable<BurstOptions>& table();
};

enum class CandidateSource { RingVote, NormalFlow };

// The front end as a whole: source of candidates, length and interval of windows.
struct DetectionOptions {
  CandidateSource method;
  bool try_both;
  double window_travel_px;
  double min_window_s;
  double max_window_s;
  double search_interval_s;
  double max_search_interval_s;
  double history_s;
  int min_window_bursts;
  double min_radius_px;
  double max_radius_px;

  DetectionOptions();  // the defaults
  constexpr explicit DetectionOptions(NoDefaults) {}
  bool operator==(const DetectionOptions&) const = default;
  static const OptionTable<DetectionOptions>& table();
};

// Candidates from a ring vote (docs/maths.md, 5.1).
struct RingVoteOptions {
  double radius_step;
  double ring_half_width_px;
  double min_score;
  int min_support;
  int max_candidates;
  double window_travel_px;

  RingVoteOptions();  // the defaults
  constexpr explicit RingVoteOptions(NoDefaults) {}
  bool operator==(const RingVoteOptions&) const = default;
  static const OptionTable<RingVoteOptions>& table();
};

// Separate fits of moving circles (docs/maths.md, 5.3).
struct MovingCircleOptions {
  double first_gate_px;
  double last_gate_px;
  double robust_scale_px;
  double max_rms_px;
  int min_bins;
  int min_bursts_per_polarity;
  double min_polarity_cosine;
  int iterations;

  MovingCircleOptions();  // the defaults
  constexpr explicit MovingCircleOptions(NoDefaults) {}
  bool operator==(const MovingCircleOptions&) const = default;
  static const OptionTable<MovingCircleOptions>& table();
};

// From circles to the board (docs/maths.md, 5.4).
struct GridOptions {
  double min_step_radii;
  double max_step_radii;
  double max_radius_ratio;
  double step_tolerance;
  double min_sine;
  double min_partial;
  int min_circles;
  int ambiguity_margin;
  double max_missing;
  double min_rival_overlap;
  int look_every_windows;
  int contradicting_looks;

  GridOptions();  // the defaults
  constexpr explicit GridOptions(NoDefaults) {}
  bool operator==(const GridOptions&) const = default;
  static const OptionTable<GridOptions>& table();
};

// Joint fit of all circles in a window, and tracking from window to window.
struct TrackingOptions {
  double fit_travel_px;
  double max_fit_half_window_s;
  double first_gate_px;
  double last_gate_px;
  double gate_ratio;
  double robust_scale_px;
  int iterations;
  double min_polarity_cosine;
  double full_polarity_cosine;
  double min_event_part;
  double full_event_part;
  double min_arc;
  int min_circle_bursts;
  double min_inliers;
  double max_centre_sigma_px;
  double max_centre_shift_px;
  double radius_offset_sigma_px;
  double prediction_sigma_px;
  double velocity_sigma_px_s;
  double acceleration_sigma_px_s2;
  double max_gap_s;

  TrackingOptions();  // the defaults
  constexpr explicit TrackingOptions(NoDefaults) {}
  bool operator==(const TrackingOptions&) const = default;
  static const OptionTable<TrackingOptions>& table();
};

// Check of the board's rows and columns against the session.
struct ExtentOptions {
  int every_windows;
  double min_line;
  double min_line_beyond;
  int min_circles_beyond;
  double alike_sigmas;
  double min_sigma_px;
  int min_views;
  double max_share;

  ExtentOptions();  // the defaults
  constexpr explicit ExtentOptions(NoDefaults) {}
  bool operator==(const ExtentOptions&) const = default;
  static const OptionTable<ExtentOptions>& table();
};

// Thresholds of the published candidate source (docs/maths.md, 5.2). Lengths are the sensor's own pixels.
struct NormalFlowOptions {
  int plane_radius_px;
  double max_plane_error_px;
  double min_plane_inliers;
  double fastest_px_s;
  int dilation_px;
  int min_cluster_px;
  double max_pair_angle_deg;
  double window_travel_px;

  NormalFlowOptions();  // the defaults
  constexpr explicit NormalFlowOptions(NoDefaults) {}
  bool operator==(const NormalFlowOptions&) const = default;
  static const OptionTable<NormalFlowOptions>& table();
};

// Corners of boards of squares in a search (docs/maths.md, 5.8).
struct SaddleOptions {
  double short_reach_px;
  double long_reach_px;
  double min_votes;
  double min_agreement;
  int min_side;
  int max_candidates;

  SaddleOptions();  // the defaults
  constexpr explicit SaddleOptions(NoDefaults) {}
  bool operator==(const SaddleOptions&) const = default;
  static const OptionTable<SaddleOptions>& table();
};

// All options of the front end, one struct per stage.
struct FrontEndOptions {
  DetectionOptions detection;
  BurstOptions bursts;
  RingVoteOptions ring_vote;
  NormalFlowOptions normal_flow;
  MovingCircleOptions moving_circle;
  GridOptions grid;
  SaddleOptions saddle;
  TrackingOptions tracking;
  ExtentOptions extent;
  bool operator==(const FrontEndOptions&) const = default;
};

// For pixels that fire about one event per edge: there are fewer crossings, and they are less exact.
FrontEndOptions forSingleEvents(FrontEndOptions options);

}  // namespace evical
