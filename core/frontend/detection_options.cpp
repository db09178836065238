#include "core/frontend/detection_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kBurstFields{Field{"min_events", &BurstOptions::min_events, 2, within(1, 20), "",
                                        "Smallest number of events of an edge at a pixel."},
                                  Field{"max_gap_s", &BurstOptions::max_gap_s, 0.15, within(1e-3, 1.0), "s",
                                        "Longest pause between events of a burst."},
                                  Field{"min_gap_s", &BurstOptions::min_gap_s, 0.004, within(0.0, 0.1), "s",
                                        "Pause up to which events always belong to the same burst."},
                                  Field{"gap_to_pace", &BurstOptions::gap_to_pace, 6.0, within(1.5, 100.0),
                                        "", "Pause that ends a burst, in mean intervals of the burst."},
                                  Field{"max_burst_s", &BurstOptions::max_burst_s, 1.0, within(1e-2, 1.0),
                                        "s", "Longest burst; longer ones are split."}};
constexpr auto kBurstDefaults = defaultsOf<BurstOptions, kBurstFields>();

constexpr std::tuple kDetectionFields{
    Choice{"method", &DetectionOptions::method, CandidateSource::NormalFlow,
           std::array{"ring_vote", "normal_flow"},
           "Source of circle candidates in a search without tracking.", Level::Public},
    Switch{"try_both", &DetectionOptions::try_both, true,
           "Use the other source of candidates if the method's source does not find the board.",
           Level::Expert},
    Field{"window_travel_px", &DetectionOptions::window_travel_px, 2.5, within(0.5, 20.0), "px",
          "Distance that the board's edges travel in one event window, approximately.", Level::Expert},
    Field{"min_window_s", &DetectionOptions::min_window_s, 0.005, within(1e-3, 0.1), "s",
          "Shortest event window.", Level::Expert},
    Field{"max_window_s", &DetectionOptions::max_window_s, 0.05, within(5e-3, 0.2), "s",
          "Longest event window.", Level::Expert},
    Field{"search_interval_s", &DetectionOptions::search_interval_s, 0.05, within(0.0, 2.0), "s",
          "Interval of searches in the whole image while the board is lost."},
    Field{"max_search_interval_s", &DetectionOptions::max_search_interval_s, 0.5, within(0.0, 10.0), "s",
          "Longest interval of searches; it grows while they fail. Windows in between are tracked backwards "
          "within history_s."},
    Field{"history_s", &DetectionOptions::history_s, 2.0, within(0.0, 30.0), "s",
          "Time over which a detected board is tracked backwards."},
    Field{"min_window_bursts", &DetectionOptions::min_window_bursts, 60, within(1, 100000), "",
          "Smallest number of edge bursts in an event window; others are skipped."},
    Field{"min_radius_px", &DetectionOptions::min_radius_px, 2.5, within(1.0, 100.0), "px",
          "Radius of the smallest circle in a search.", Level::Expert},
    Field{"max_radius_px", &DetectionOptions::max_radius_px, 80.0, within(3.0, 500.0), "px",
          "Radius of the largest circle in a search.", Level::Expert}};
constexpr auto kDetectionDefaults = defaultsOf<DetectionOptions, kDetectionFields>();

constexpr std::tuple kRingVoteFields{
    Field{"radius_step", &RingVoteOptions::radius_step, 1.12, within(1.02, 1.5), "",
          "Ratio of consecutive radii in the search."},
    Field{"ring_half_width_px", &RingVoteOptions::ring_half_width_px, 0.75, within(0.3, 3.0), "px",
          "Half the thickness of the ring of votes."},
    Field{"min_score", &RingVoteOptions::min_score, 0.18, within(0.02, 1.0), "",
          "Smallest signed vote of a candidate, relative to the ring's area."},
    Field{"min_support", &RingVoteOptions::min_support, 3, within(1, 9), "",
          "Smallest number of bursts of one polarity in the 3x3 neighbourhood of a voting burst, itself "
          "included."},
    Field{"max_candidates", &RingVoteOptions::max_candidates, 1500, within(10, 5000), "",
          "Largest number of fitted candidates, best first."},
    Field{"window_travel_px", &RingVoteOptions::window_travel_px, 2.5, within(0.5, 20.0), "px",
          "Distance that edges travel in a searched window, approximately."}};
constexpr auto kRingVoteDefaults = defaultsOf<RingVoteOptions, kRingVoteFields>();

constexpr std::tuple kMovingCircleFields{
    Field{"first_gate_px", &MovingCircleOptions::first_gate_px, 2.5, within(0.5, 10.0), "px",
          "Largest distance of fitted bursts from the edge, first iteration."},
    Field{"last_gate_px", &MovingCircleOptions::last_gate_px, 1.2, within(0.3, 10.0), "px",
          "Largest distance of fitted bursts from the edge, last iteration."},
    Field{"robust_scale_px", &MovingCircleOptions::robust_scale_px, 0.5, within(0.05, 5.0), "px",
          "Scale of the Cauchy weight."},
    Field{"max_rms_px", &MovingCircleOptions::max_rms_px, 0.8, within(0.1, 5.0), "px",
          "Largest residual RMS of an accepted fit."},
    Field{"min_bins", &MovingCircleOptions::min_bins, 8, within(1, 16), "",
          "Smallest number of the outline's 16 sectors with bursts."},
    Field{"min_bursts_per_polarity", &MovingCircleOptions::min_bursts_per_polarity, 4, within(0, 1000), "",
          "Smallest number of bursts on the leading and on the trailing arc."},
    Field{"min_polarity_cosine", &MovingCircleOptions::min_polarity_cosine, -0.2, within(-1.0, 1.0), "",
          "Smallest cosine between normal and motion for the burst's polarity; other bursts are excluded."},
    Field{"iterations", &MovingCircleOptions::iterations, 8, within(1, 50), "",
          "Gauss-Newton iterations of the fit."}};
constexpr auto kMovingCircleDefaults = defaultsOf<MovingCircleOptions, kMovingCircleFields>();

constexpr std::tuple kGridFields{
    Field{"min_step_radii", &GridOptions::min_step_radii, 2.2, within(2.0, 20.0), "radii",
          "Smallest distance of neighbours, in circle radii."},
    Field{"max_step_radii", &GridOptions::max_step_radii, 5.0, within(2.1, 40.0), "radii",
          "Largest distance of neighbours, in circle radii."},
    Field{"max_radius_ratio", &GridOptions::max_radius_ratio, 1.54, within(1.05, 4.0), "",
          "Largest ratio of the radii of neighbours."},
    Field{"step_tolerance", &GridOptions::step_tolerance, 0.22, within(0.05, 0.45), "steps",
          "Largest deviation of a neighbour from its predicted place."},
    Field{"min_sine", &GridOptions::min_sine, 0.6, within(0.1, 1.0), "",
          "Smallest sine of the angle between a lattice's two directions."},
    Field{"min_partial", &GridOptions::min_partial, 0.4, within(0.1, 1.0), "",
          "Smallest share of the circles in a partial grid.", Level::Expert},
    Field{"min_circles", &GridOptions::min_circles, 6, within(4, 1000), "",
          "Smallest number of circles in a grid.", Level::Expert},
    Field{"ambiguity_margin", &GridOptions::ambiguity_margin, 2, within(0, 100), "",
          "Number of circles by which a partial grid's placement must exceed the second-best one."},
    Field{"min_rival_overlap", &GridOptions::min_rival_overlap, 0.5, within(0.1, 1.0), "",
          "Smallest overlap of rival placements that are compared with the accepted one, as a share of the "
          "circles."},
    Field{"max_missing", &GridOptions::max_missing, 0.2, within(0.0, 1.0), "",
          "Largest ratio of missing to detected circles for an accepted board."},
    Field{"look_every_windows", &GridOptions::look_every_windows, 10, within(1, 10000), "",
          "Interval of placement checks after confirmation, in tracked windows; every window is checked "
          "before."},
    Field{"contradicting_looks", &GridOptions::contradicting_looks, 2, within(1, 1000), "",
          "Number of consecutive contradicting checks after which the placement is replaced."}};
constexpr auto kGridDefaults = defaultsOf<GridOptions, kGridFields>();

constexpr std::tuple kTrackingFields{
    Field{"fit_travel_px", &TrackingOptions::fit_travel_px, 3.0, within(0.5, 20.0), "px",
          "Distance that edges travel within the window of the motion fit."},
    Field{"max_fit_half_window_s", &TrackingOptions::max_fit_half_window_s, 0.06, within(1e-3, 0.5), "s",
          "Longest half window of the motion fit."},
    Field{"first_gate_px", &TrackingOptions::first_gate_px, 3.0, within(0.5, 20.0), "px",
          "Largest distance of fitted bursts from an edge, first iteration."},
    Field{"last_gate_px", &TrackingOptions::last_gate_px, 1.0, within(0.3, 20.0), "px",
          "Largest distance of fitted bursts from an edge, last iteration."},
    Field{"gate_ratio", &TrackingOptions::gate_ratio, 0.6, within(0.1, 1.0), "",
          "Ratio of the gates of consecutive iterations."},
    Field{"robust_scale_px", &TrackingOptions::robust_scale_px, 0.4, within(0.05, 5.0), "px",
          "Scale of the Cauchy weight."},
    Field{"iterations", &TrackingOptions::iterations, 8, within(2, 50), "",
          "Gauss-Newton iterations of the joint fit."},
    Field{"min_polarity_cosine", &TrackingOptions::min_polarity_cosine, 0.35, within(0.0, 1.0), "",
          "Smallest cosine between edge normal and motion; other edges graze pixels and are excluded."},
    Field{"full_polarity_cosine", &TrackingOptions::full_polarity_cosine, 0.7, within(0.0, 1.0), "",
          "Smallest cosine between edge normal and motion at which an edge has its full weight."},
    Field{"min_event_part", &TrackingOptions::min_event_part, 0.8, within(0.0, 1.0), "",
          "Smallest number of events relative to a typical burst; other bursts are of edges that graze the "
          "pixel, and excluded."},
    Field{"full_event_part", &TrackingOptions::full_event_part, 1.0, within(0.0, 1.0), "",
          "Smallest number of events relative to a typical burst at which a burst has its full weight."},
    Field{"min_arc", &TrackingOptions::min_arc, 0.25, within(0.05, 1.0), "",
          "Smallest share of a circle's 16 sectors with bursts."},
    Field{"min_circle_bursts", &TrackingOptions::min_circle_bursts, 8, within(3, 1000), "",
          "Smallest number of bursts of a circle."},
    Field{"min_inliers", &TrackingOptions::min_inliers, 0.6, within(0.0, 1.0), "",
          "Smallest share of inliers among the bursts around a circle's edge, within the robust scale."},
    Field{"max_centre_sigma_px", &TrackingOptions::max_centre_sigma_px, 0.5, within(0.05, 5.0), "px",
          "Largest sigma of a circle's centre; other circles are excluded."},
    Field{"max_centre_shift_px", &TrackingOptions::max_centre_shift_px, 1.5, within(0.2, 10.0), "px",
          "Largest distance of a circle from the board's fit; other circles are excluded."},
    Field{"radius_offset_sigma_px", &TrackingOptions::radius_offset_sigma_px, 0.15, within(0.01, 2.0), "px",
          "Prior sigma of one circle's radius offset relative to that of all circles."},
    Field{"prediction_sigma_px", &TrackingOptions::prediction_sigma_px, 4.0, within(0.1, 50.0), "px",
          "Prior sigma of the position predicted from the window before."},
    Field{"velocity_sigma_px_s", &TrackingOptions::velocity_sigma_px_s, 150.0, within(1.0, 1e5), "px/s",
          "Prior sigma of the predicted velocity."},
    Field{"acceleration_sigma_px_s2", &TrackingOptions::acceleration_sigma_px_s2, 1500.0, within(1.0, 1e6),
          "px/s^2", "Prior sigma of accelerations."},
    Field{"max_gap_s", &TrackingOptions::max_gap_s, 0.3, within(0.0, 5.0), "s",
          "Time over which a lost board is predicted before it is searched again."}};
constexpr auto kTrackingDefaults = defaultsOf<TrackingOptions, kTrackingFields>();

constexpr std::tuple kExtentFields{
    Field{"every_windows", &ExtentOptions::every_windows, 5, within(1, 1000), "",
          "Interval of the checks, in tracked windows."},
    Field{
        "min_line", &ExtentOptions::min_line, 0.6, within(0.3, 1.0), "",
        "Smallest share of a row or column in the image for a check, and smallest share of detected circles "
        "in it."},
    Field{"min_line_beyond", &ExtentOptions::min_line_beyond, 0.75, within(0.3, 1.0), "",
          "The same shares of a row or column beyond the board: discs of the background can look like a part "
          "of one."},
    Field{"min_circles_beyond", &ExtentOptions::min_circles_beyond, 3, within(2, 100), "",
          "Smallest number of circles of such a line, if it has as many."},
    Field{"alike_sigmas", &ExtentOptions::alike_sigmas, 4.0, within(1.0, 100.0), "sigma",
          "Largest deviation of such a circle from its place and size, in units of the spread of the board's "
          "own circles."},
    Field{"min_sigma_px", &ExtentOptions::min_sigma_px, 0.1, within(0.0, 10.0), "px",
          "Smallest value of that spread."},
    Field{"min_views", &ExtentOptions::min_views, 15, within(1, 100000), "",
          "Smallest number of checked views for a report."},
    Field{"max_share", &ExtentOptions::max_share, 0.25, within(0.0, 1.0), "",
          "Largest share of views that may contradict the session's rows or columns."}};
constexpr auto kExtentDefaults = defaultsOf<ExtentOptions, kExtentFields>();

}  // namespace

BurstOptions::BurstOptions() : BurstOptions(kBurstDefaults) {}

const OptionTable<BurstOptions>& BurstOptions::table() {
  static const OptionTable<BurstOptions> table(kBurstFields,
                                               Ordered{&BurstOptions::min_gap_s, &BurstOptions::max_gap_s});
  return table;
}

DetectionOptions::DetectionOptions() : DetectionOptions(kDetectionDefaults) {}

const OptionTable<DetectionOptions>& DetectionOptions::table() {
  static const OptionTable<DetectionOptions> table(
      kDetectionFields, Ordered{&DetectionOptions::min_window_s, &DetectionOptions::max_window_s},
      Ordered{&DetectionOptions::search_interval_s, &DetectionOptions::max_search_interval_s},
      Ordered{&DetectionOptions::min_radius_px, &DetectionOptions::max_radius_px});
  return table;
}

RingVoteOptions::RingVoteOptions() : RingVoteOptions(kRingVoteDefaults) {}

const OptionTable<RingVoteOptions>& RingVoteOptions::table() {
  static const OptionTable<RingVoteOptions> table(kRingVoteFields);
  return table;
}

MovingCircleOptions::MovingCircleOptions() : MovingCircleOptions(kMovingCircleDefaults) {}

const OptionTable<MovingCircleOptions>& MovingCircleOptions::table() {
  static const OptionTable<MovingCircleOptions> table(
      kMovingCircleFields, Ordered{&MovingCircleOptions::last_gate_px, &MovingCircleOptions::first_gate_px});
  return table;
}

GridOptions::GridOptions() : GridOptions(kGridDefaults) {}

const OptionTable<GridOptions>& GridOptions::table() {
  static const OptionTable<GridOptions> table(
      kGridFields, Ordered{&GridOptions::min_step_radii, &GridOptions::max_step_radii});
  return table;
}

TrackingOptions::TrackingOptions() : TrackingOptions(kTrackingDefaults) {}

const OptionTable<TrackingOptions>& TrackingOptions::table() {
  static const OptionTable<TrackingOptions> table(
      kTrackingFields, Ordered{&TrackingOptions::last_gate_px, &TrackingOptions::first_gate_px},
      Ordered{&TrackingOptions::min_polarity_cosine, &TrackingOptions::full_polarity_cosine},
      Ordered{&TrackingOptions::min_event_part, &TrackingOptions::full_event_part});
  return table;
}

ExtentOptions::ExtentOptions() : ExtentOptions(kExtentDefaults) {}

const OptionTable<ExtentOptions>& ExtentOptions::table() {
  static const OptionTable<ExtentOptions> table(kExtentFields);
  return table;
}

namespace {

constexpr std::tuple kNormalFlowFields{
    Field{"plane_radius_px", &NormalFlowOptions::plane_radius_px, 1, within(1, 5), "px",
          "Half width of the neighbourhood of the plane fit."},
    Field{"max_plane_error_px", &NormalFlowOptions::max_plane_error_px, 0.6, within(0.05, 5.0), "px",
          "Largest deviation of a neighbour from the plane, as a distance that the edge travels."},
    Field{"min_plane_inliers", &NormalFlowOptions::min_plane_inliers, 0.5, within(0.2, 1.0), "",
          "Smallest share of inliers in the neighbourhood."},
    Field{"fastest_px_s", &NormalFlowOptions::fastest_px_s, 4000.0, within(10.0, 1e6), "px/s",
          "Largest speed of edges; faster ones are noise."},
    Field{"dilation_px", &NormalFlowOptions::dilation_px, 1, within(0, 5), "px",
          "Dilation of flow pixels; pixels that touch after it are one cluster."},
    Field{"min_cluster_px", &NormalFlowOptions::min_cluster_px, 10, within(3, 10000), "px",
          "Smallest number of pixels in a cluster."},
    Field{"max_pair_angle_deg", &NormalFlowOptions::max_pair_angle_deg, 30.0, within(1.0, 90.0), "deg",
          "Largest angle between the directions of two paired arcs, and to the line that joins them."},
    Field{"window_travel_px", &NormalFlowOptions::window_travel_px, 3.5, within(0.5, 20.0), "px",
          "Distance that edges travel in a searched window, approximately."}};
constexpr std::tuple kSaddleFields{
    Field{"short_reach_px", &SaddleOptions::short_reach_px, 4.5, within(2.0, 30.0), "px",
          "Largest distance of votes from a corner, for small squares."},
    Field{"long_reach_px", &SaddleOptions::long_reach_px, 8.0, within(2.0, 60.0), "px",
          "Largest distance of votes from a corner, for large squares."},
    Field{"min_votes", &SaddleOptions::min_votes, 5.0, within(1.0, 1000.0), "",
          "Smallest sum of agreeing votes for a corner."},
    Field{"min_agreement", &SaddleOptions::min_agreement, 0.5, within(0.0, 1.0), "",
          "Smallest share of agreeing votes for a corner."},
    Field{"min_side", &SaddleOptions::min_side, 2, within(1, 100), "",
          "Smallest number of votes on either side of a corner, along one of its lines."},
    Field{"max_candidates", &SaddleOptions::max_candidates, 1500, within(10, 10000), "",
          "Largest number of corners in a search, best first."}};
constexpr auto kSaddleDefaults = defaultsOf<SaddleOptions, kSaddleFields>();

constexpr auto kNormalFlowDefaults = defaultsOf<NormalFlowOptions, kNormalFlowFields>();

}  // namespace

NormalFlowOptions::NormalFlowOptions() : NormalFlowOptions(kNormalFlowDefaults) {}

SaddleOptions::SaddleOptions() : SaddleOptions(kSaddleDefaults) {}

const OptionTable<SaddleOptions>& SaddleOptions::table() {
  static const OptionTable<SaddleOptions> table(
      kSaddleFields, Ordered{&SaddleOptions::short_reach_px, &SaddleOptions::long_reach_px});
  return table;
}

const OptionTable<NormalFlowOptions>& NormalFlowOptions::table() {
  static const OptionTable<NormalFlowOptions> table(kNormalFlowFields);
  return table;
}

FrontEndOptions forSingleEvents(FrontEndOptions options) {
  options.detection.window_travel_px = 5.0;
  options.detection.max_window_s = 0.1;
  options.grid.min_partial = 0.2;
  TrackingOptions& tracking = options.tracking;
  tracking.fit_travel_px = 5.0;
  tracking.max_fit_half_window_s = 0.15;
  tracking.last_gate_px = 1.5;
  tracking.robust_scale_px = 0.6;
  tracking.min_circle_bursts = 4;
  tracking.prediction_sigma_px = 2.0;  // each window is searched
  tracking.velocity_sigma_px_s = 50.0;
  tracking.acceleration_sigma_px_s2 = 200.0;
  return options;
}

}  // namespace evical
