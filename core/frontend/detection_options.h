// The front end's options, one table a stage. Lengths in px are the sensor's own pixels.
#pragma once

#include "core/base/option_field.h"

#include <array>
#include <tuple>

namespace evical {

// Edge timing (docs/maths.md, 4).
struct BurstOptions {
  int least_events = 2;
  double longest_gap_s = 0.15;
  double shortest_gap_s = 0.004;
  double gap_to_pace = 6.0;
  double longest_burst_s = 1.0;
  bool operator==(const BurstOptions&) const = default;
};
inline constexpr auto kBurstFields =
    std::tuple{Field{"least_events", &BurstOptions::least_events, 1, 20, "",
                     "Events that an edge must fire at a pixel to count."},
               Field{"longest_gap_s", &BurstOptions::longest_gap_s, 1e-3, 1.0, "s",
                     "A longer pause always ends a burst."},
               Field{"shortest_gap_s", &BurstOptions::shortest_gap_s, 0.0, 0.1, "s",
                     "A shorter pause never ends a burst."},
               Field{"gap_to_pace", &BurstOptions::gap_to_pace, 1.5, 100.0, "",
                     "A pause of this many mean intervals of the burst ends it."},
               Field{"longest_burst_s", &BurstOptions::longest_burst_s, 1e-2, 1.0, "s",
                     "A burst that lasts longer is cut."}};
static_assert(fieldCount<BurstOptions>() == std::tuple_size_v<decltype(kBurstFields)>);

enum class CandidateSource { RingVote, NormalFlow };

// The front end as a whole: where candidates come from, how windows are laid.
struct DetectionOptions {
  CandidateSource method = CandidateSource::NormalFlow;
  bool try_both = true;
  double window_travel_px = 2.5;
  double shortest_window_s = 0.005;
  double longest_window_s = 0.05;
  double search_interval_s = 0.05;
  double longest_search_interval_s = 0.5;
  double history_s = 2.0;
  int least_window_bursts = 60;
  bool operator==(const DetectionOptions&) const = default;
};
inline constexpr auto kDetectionFields = std::tuple{
    Choice{"method", &DetectionOptions::method, std::array{"ring_vote", "normal_flow"},
           "Where circle candidates come from when nothing is tracked."},
    Switch{"try_both", &DetectionOptions::try_both,
           "Where that source does not show the board, try the other."},
    Field{"window_travel_px", &DetectionOptions::window_travel_px, 0.5, 20.0, "px",
          "Windows are laid so that the board's edges travel about this far in one."},
    Field{"shortest_window_s", &DetectionOptions::shortest_window_s, 1e-3, 0.1, "s", "No window is shorter."},
    Field{"longest_window_s", &DetectionOptions::longest_window_s, 5e-3, 0.2, "s", "No window is longer."},
    Field{"search_interval_s", &DetectionOptions::search_interval_s, 0.0, 2.0, "s",
          "While the board is lost, search the whole image this often."},
    Field{"longest_search_interval_s", &DetectionOptions::longest_search_interval_s, 0.0, 10.0, "s",
          "Searches that find nothing become rarer, up to this interval; history_s brings back what they "
          "miss."},
    Field{"history_s", &DetectionOptions::history_s, 0.0, 30.0, "s",
          "How far back a found board is tracked backwards in time."},
    Field{"least_window_bursts", &DetectionOptions::least_window_bursts, 1, 100000, "",
          "A window with fewer edge bursts is not looked at."}};
static_assert(fieldCount<DetectionOptions>() == std::tuple_size_v<decltype(kDetectionFields)>);

// Candidates from a ring vote (docs/maths.md, 5.1).
struct RingVoteOptions {
  double smallest_radius_px = 2.5;
  double largest_radius_px = 80.0;
  double radius_step = 1.12;
  double ring_half_width_px = 0.75;
  double least_score = 0.18;
  int least_support = 3;
  int most_candidates = 1500;
  double window_travel_px = 2.5;
  bool operator==(const RingVoteOptions&) const = default;
};
inline constexpr auto kRingVoteFields = std::tuple{
    Field{"smallest_radius_px", &RingVoteOptions::smallest_radius_px, 1.0, 100.0, "px",
          "Smallest circle looked for."},
    Field{"largest_radius_px", &RingVoteOptions::largest_radius_px, 3.0, 500.0, "px",
          "Largest circle looked for."},
    Field{"radius_step", &RingVoteOptions::radius_step, 1.02, 1.5, "", "Ratio of neighbouring radii."},
    Field{"ring_half_width_px", &RingVoteOptions::ring_half_width_px, 0.3, 3.0, "px",
          "Half the ring's thickness."},
    Field{"least_score", &RingVoteOptions::least_score, 0.02, 1.0, "",
          "Signed vote over ring area from which a place is a candidate."},
    Field{"least_support", &RingVoteOptions::least_support, 1, 9, "",
          "Bursts of one polarity in a 3x3 neighbourhood, itself included, for a burst to vote."},
    Field{"most_candidates", &RingVoteOptions::most_candidates, 10, 5000, "",
          "Only the best this many are fitted."},
    Field{"window_travel_px", &RingVoteOptions::window_travel_px, 0.5, 20.0, "px",
          "Edges should travel about this far in a searched window."}};
static_assert(fieldCount<RingVoteOptions>() == std::tuple_size_v<decltype(kRingVoteFields)>);

// Moving circles, one by one (docs/maths.md, 5.3).
struct MovingCircleOptions {
  double first_gate_px = 2.5;
  double last_gate_px = 1.2;
  double robust_scale_px = 0.5;
  double largest_rms_px = 0.8;
  int least_bins = 8;
  int least_bursts_per_polarity = 4;
  double least_polarity_cosine = -0.2;
  int iterations = 8;
  bool operator==(const MovingCircleOptions&) const = default;
};
inline constexpr auto kMovingCircleFields = std::tuple{
    Field{"first_gate_px", &MovingCircleOptions::first_gate_px, 0.5, 10.0, "px",
          "Bursts this near the edge, at first."},
    Field{"last_gate_px", &MovingCircleOptions::last_gate_px, 0.3, 10.0, "px",
          "Bursts this near the edge, at last."},
    Field{"robust_scale_px", &MovingCircleOptions::robust_scale_px, 0.05, 5.0, "px",
          "Scale of the Cauchy weight."},
    Field{"largest_rms_px", &MovingCircleOptions::largest_rms_px, 0.1, 5.0, "px", "A worse fit is dropped."},
    Field{"least_bins", &MovingCircleOptions::least_bins, 1, 16, "", "Of 16 sectors that must hold bursts."},
    Field{"least_bursts_per_polarity", &MovingCircleOptions::least_bursts_per_polarity, 0, 1000, "",
          "Bursts that the leading and the trailing arc must have."},
    Field{"least_polarity_cosine", &MovingCircleOptions::least_polarity_cosine, -1.0, 1.0, "",
          "Bursts on the wrong side of the motion by more than this are left out."},
    Field{"iterations", &MovingCircleOptions::iterations, 1, 50, "", "Gauss-Newton steps."}};
static_assert(fieldCount<MovingCircleOptions>() == std::tuple_size_v<decltype(kMovingCircleFields)>);

// From circles to the board (docs/maths.md, 5.4).
struct GridOptions {
  double shortest_step_radii = 2.2;
  double longest_step_radii = 5.0;
  double largest_radius_ratio = 1.54;
  double step_tolerance = 0.22;
  double least_sine = 0.6;
  double least_partial = 0.4;
  int least_circles = 6;
  int ambiguity_margin = 2;
  double most_missing = 0.2;
  double least_rival_overlap = 0.5;
  bool operator==(const GridOptions&) const = default;
};
inline constexpr auto kGridFields = std::tuple{
    Field{"shortest_step_radii", &GridOptions::shortest_step_radii, 2.0, 20.0, "radii",
          "Nearest neighbours, at least."},
    Field{"longest_step_radii", &GridOptions::longest_step_radii, 2.1, 40.0, "radii",
          "Nearest neighbours, at most."},
    Field{"largest_radius_ratio", &GridOptions::largest_radius_ratio, 1.05, 4.0, "", "Between neighbours."},
    Field{"step_tolerance", &GridOptions::step_tolerance, 0.05, 0.45, "steps",
          "How far a neighbour may be off."},
    Field{"least_sine", &GridOptions::least_sine, 0.1, 1.0, "",
          "Of the angle between a lattice's two directions."},
    Field{"least_partial", &GridOptions::least_partial, 0.1, 1.0, "",
          "Part of the circles that makes a partial grid."},
    Field{"least_circles", &GridOptions::least_circles, 4, 1000, "", "A grid with fewer circles is none."},
    Field{"ambiguity_margin", &GridOptions::ambiguity_margin, 0, 100, "",
          "An incomplete grid needs this many circles more than its runner-up placement."},
    Field{"least_rival_overlap", &GridOptions::least_rival_overlap, 0.1, 1.0, "",
          "Other placements that share this part of the circles are held against the one that was found."},
    Field{"most_missing", &GridOptions::most_missing, 0.0, 1.0, "",
          "Circles that should be seen and are not, as part of those that are, for a board to be believed."}};
static_assert(fieldCount<GridOptions>() == std::tuple_size_v<decltype(kGridFields)>);

// All circles of a window together, and from window to window.
struct TrackingOptions {
  double fit_travel_px = 3.0;
  double longest_fit_half_window_s = 0.06;
  double first_gate_px = 3.0;
  double last_gate_px = 1.0;
  double gate_ratio = 0.6;
  double robust_scale_px = 0.4;
  int iterations = 8;
  double least_polarity_cosine = 0.35;
  double full_polarity_cosine = 0.7;
  double least_event_part = 0.8;
  double full_event_part = 1.0;
  double least_arc = 0.25;
  int least_circle_bursts = 8;
  double least_inliers = 0.6;
  double largest_centre_sigma_px = 0.5;
  double largest_centre_shift_px = 1.5;
  double radius_offset_sigma_px = 0.15;
  double prediction_sigma_px = 4.0;
  double velocity_sigma_px_s = 150.0;
  double acceleration_sigma_px_s2 = 1500.0;
  double longest_gap_s = 0.3;
  bool operator==(const TrackingOptions&) const = default;
};
inline constexpr auto kTrackingFields = std::tuple{
    Field{"fit_travel_px", &TrackingOptions::fit_travel_px, 0.5, 20.0, "px",
          "The board's motion is fitted to bursts while edges travel this far."},
    Field{"longest_fit_half_window_s", &TrackingOptions::longest_fit_half_window_s, 1e-3, 0.5, "s",
          "But to bursts no further away in time than this."},
    Field{"first_gate_px", &TrackingOptions::first_gate_px, 0.5, 20.0, "px",
          "Bursts this near an edge, at first."},
    Field{"last_gate_px", &TrackingOptions::last_gate_px, 0.3, 20.0, "px",
          "Bursts this near an edge, at last."},
    Field{"gate_ratio", &TrackingOptions::gate_ratio, 0.1, 1.0, "",
          "By which the gate narrows from step to step."},
    Field{"robust_scale_px", &TrackingOptions::robust_scale_px, 0.05, 5.0, "px",
          "Scale of the Cauchy weight."},
    Field{"iterations", &TrackingOptions::iterations, 2, 50, "", "Gauss-Newton steps of the joint fit."},
    Field{"least_polarity_cosine", &TrackingOptions::least_polarity_cosine, 0.0, 1.0, "",
          "Cosine between edge normal and motion below which an edge is left out: it grazes pixels."},
    Field{"full_polarity_cosine", &TrackingOptions::full_polarity_cosine, 0.0, 1.0, "",
          "Cosine from which an edge has its full weight."},
    Field{"least_event_part", &TrackingOptions::least_event_part, 0.0, 1.0, "",
          "Bursts with fewer events than this part of a typical one are left out: their edges graze the "
          "pixel."},
    Field{"full_event_part", &TrackingOptions::full_event_part, 0.0, 1.0, "",
          "Bursts from this part of the typical number of events have their full weight."},
    Field{"least_arc", &TrackingOptions::least_arc, 0.05, 1.0, "",
          "Part of a circle's 16 sectors that must hold bursts."},
    Field{"least_circle_bursts", &TrackingOptions::least_circle_bursts, 3, 1000, "",
          "Bursts that a circle must have."},
    Field{"least_inliers", &TrackingOptions::least_inliers, 0.0, 1.0, "",
          "Part of the bursts around a circle's edge that must lie on it, within the robust scale."},
    Field{"largest_centre_sigma_px", &TrackingOptions::largest_centre_sigma_px, 0.05, 5.0, "px",
          "A circle's centre less sure than this is left out."},
    Field{"largest_centre_shift_px", &TrackingOptions::largest_centre_shift_px, 0.2, 10.0, "px",
          "A circle this far off the board's fit is left out."},
    Field{"radius_offset_sigma_px", &TrackingOptions::radius_offset_sigma_px, 0.01, 2.0, "px",
          "How far one circle's radius may differ from what all show."},
    Field{"prediction_sigma_px", &TrackingOptions::prediction_sigma_px, 0.1, 50.0, "px",
          "How far the prediction from the window before is trusted."},
    Field{"velocity_sigma_px_s", &TrackingOptions::velocity_sigma_px_s, 1.0, 1e5, "px/s",
          "How far the velocity may differ from the prediction."},
    Field{"acceleration_sigma_px_s2", &TrackingOptions::acceleration_sigma_px_s2, 1.0, 1e6, "px/s^2",
          "How large accelerations are."},
    Field{"longest_gap_s", &TrackingOptions::longest_gap_s, 0.0, 5.0, "s",
          "A lost board is predicted for this long before it is searched anew."}};
static_assert(fieldCount<TrackingOptions>() == std::tuple_size_v<decltype(kTrackingFields)>);

// Does the board have the rows and columns that the session says?
struct ExtentOptions {
  int every_windows = 5;
  double least_line = 0.6;
  int least_views = 15;
  double largest_share = 0.25;
  bool operator==(const ExtentOptions&) const = default;
};
inline constexpr auto kExtentFields = std::tuple{
    Field{"every_windows", &ExtentOptions::every_windows, 1, 1000, "",
          "One in so many tracked windows is looked at."},
    Field{"least_line", &ExtentOptions::least_line, 0.3, 1.0, "",
          "Part of a row or column that must lie in the image to be judged, and of that part that must be "
          "seen to be there."},
    Field{"least_views", &ExtentOptions::least_views, 1, 100000, "",
          "Views looked at without which nothing is said."},
    Field{"largest_share", &ExtentOptions::largest_share, 0.0, 1.0, "",
          "Part of the views that may contradict the session's rows or columns."}};
static_assert(fieldCount<ExtentOptions>() == std::tuple_size_v<decltype(kExtentFields)>);

}  // namespace evical
