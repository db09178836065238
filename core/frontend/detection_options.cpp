#include "core/frontend/detection_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kBurstFields{Field{"least_events", &BurstOptions::least_events, 2, within(1, 20), "",
                                        "Events that an edge must fire at a pixel to count."},
                                  Field{"longest_gap_s", &BurstOptions::longest_gap_s, 0.15,
                                        within(1e-3, 1.0), "s", "A longer pause always ends a burst."},
                                  Field{"shortest_gap_s", &BurstOptions::shortest_gap_s, 0.004,
                                        within(0.0, 0.1), "s", "A shorter pause never ends a burst."},
                                  Field{"gap_to_pace", &BurstOptions::gap_to_pace, 6.0, within(1.5, 100.0),
                                        "", "A pause of this many mean intervals of the burst ends it."},
                                  Field{"longest_burst_s", &BurstOptions::longest_burst_s, 1.0,
                                        within(1e-2, 1.0), "s", "A burst that lasts longer is cut."}};
constexpr auto kBurstDefaults = defaultsOf<BurstOptions, kBurstFields>();

constexpr std::tuple kDetectionFields{
    Choice{"method", &DetectionOptions::method, CandidateSource::NormalFlow,
           std::array{"ring_vote", "normal_flow"},
           "Where circle candidates come from when nothing is tracked.", Level::Public},
    Switch{"try_both", &DetectionOptions::try_both, true,
           "Where the method's source does not show the board, try the other.", Level::Expert},
    Field{"window_travel_px", &DetectionOptions::window_travel_px, 2.5, within(0.5, 20.0), "px",
          "Windows are laid so that the board's edges travel about this far in one.", Level::Expert},
    Field{"shortest_window_s", &DetectionOptions::shortest_window_s, 0.005, within(1e-3, 0.1), "s",
          "No window is shorter.", Level::Expert},
    Field{"longest_window_s", &DetectionOptions::longest_window_s, 0.05, within(5e-3, 0.2), "s",
          "No window is longer.", Level::Expert},
    Field{"search_interval_s", &DetectionOptions::search_interval_s, 0.05, within(0.0, 2.0), "s",
          "While the board is lost, search the whole image this often."},
    Field{"longest_search_interval_s", &DetectionOptions::longest_search_interval_s, 0.5, within(0.0, 10.0),
          "s",
          "Searches that find nothing become rarer, up to this interval; history_s brings back what they "
          "miss."},
    Field{"history_s", &DetectionOptions::history_s, 2.0, within(0.0, 30.0), "s",
          "How far back a found board is tracked backwards in time."},
    Field{"least_window_bursts", &DetectionOptions::least_window_bursts, 60, within(1, 100000), "",
          "A window with fewer edge bursts is not looked at."},
    Field{"smallest_radius_px", &DetectionOptions::smallest_radius_px, 2.5, within(1.0, 100.0), "px",
          "Smallest circle looked for.", Level::Expert},
    Field{"largest_radius_px", &DetectionOptions::largest_radius_px, 80.0, within(3.0, 500.0), "px",
          "Largest circle looked for.", Level::Expert}};
constexpr auto kDetectionDefaults = defaultsOf<DetectionOptions, kDetectionFields>();

constexpr std::tuple kRingVoteFields{
    Field{"radius_step", &RingVoteOptions::radius_step, 1.12, within(1.02, 1.5), "",
          "Ratio of neighbouring radii."},
    Field{"ring_half_width_px", &RingVoteOptions::ring_half_width_px, 0.75, within(0.3, 3.0), "px",
          "Half the ring's thickness."},
    Field{"least_score", &RingVoteOptions::least_score, 0.18, within(0.02, 1.0), "",
          "Signed vote over ring area from which a place is a candidate."},
    Field{"least_support", &RingVoteOptions::least_support, 3, within(1, 9), "",
          "Bursts of one polarity in a 3x3 neighbourhood, itself included, for a burst to vote."},
    Field{"most_candidates", &RingVoteOptions::most_candidates, 1500, within(10, 5000), "",
          "Only the best this many are fitted."},
    Field{"window_travel_px", &RingVoteOptions::window_travel_px, 2.5, within(0.5, 20.0), "px",
          "Edges should travel about this far in a searched window."}};
constexpr auto kRingVoteDefaults = defaultsOf<RingVoteOptions, kRingVoteFields>();

constexpr std::tuple kMovingCircleFields{
    Field{"first_gate_px", &MovingCircleOptions::first_gate_px, 2.5, within(0.5, 10.0), "px",
          "Bursts this near the edge, at first."},
    Field{"last_gate_px", &MovingCircleOptions::last_gate_px, 1.2, within(0.3, 10.0), "px",
          "Bursts this near the edge, at last."},
    Field{"robust_scale_px", &MovingCircleOptions::robust_scale_px, 0.5, within(0.05, 5.0), "px",
          "Scale of the Cauchy weight."},
    Field{"largest_rms_px", &MovingCircleOptions::largest_rms_px, 0.8, within(0.1, 5.0), "px",
          "A worse fit is dropped."},
    Field{"least_bins", &MovingCircleOptions::least_bins, 8, within(1, 16), "",
          "Of 16 sectors that must hold bursts."},
    Field{"least_bursts_per_polarity", &MovingCircleOptions::least_bursts_per_polarity, 4, within(0, 1000),
          "", "Bursts that the leading and the trailing arc must have."},
    Field{"least_polarity_cosine", &MovingCircleOptions::least_polarity_cosine, -0.2, within(-1.0, 1.0), "",
          "Bursts on the wrong side of the motion by more than this are left out."},
    Field{"iterations", &MovingCircleOptions::iterations, 8, within(1, 50), "", "Gauss-Newton steps."}};
constexpr auto kMovingCircleDefaults = defaultsOf<MovingCircleOptions, kMovingCircleFields>();

constexpr std::tuple kGridFields{
    Field{"shortest_step_radii", &GridOptions::shortest_step_radii, 2.2, within(2.0, 20.0), "radii",
          "Nearest neighbours, at least."},
    Field{"longest_step_radii", &GridOptions::longest_step_radii, 5.0, within(2.1, 40.0), "radii",
          "Nearest neighbours, at most."},
    Field{"largest_radius_ratio", &GridOptions::largest_radius_ratio, 1.54, within(1.05, 4.0), "",
          "Between neighbours."},
    Field{"step_tolerance", &GridOptions::step_tolerance, 0.22, within(0.05, 0.45), "steps",
          "How far a neighbour may be off."},
    Field{"least_sine", &GridOptions::least_sine, 0.6, within(0.1, 1.0), "",
          "Of the angle between a lattice's two directions."},
    Field{"least_partial", &GridOptions::least_partial, 0.4, within(0.1, 1.0), "",
          "Part of the circles that makes a partial grid.", Level::Expert},
    Field{"least_circles", &GridOptions::least_circles, 6, within(4, 1000), "",
          "A grid with fewer circles is none.", Level::Expert},
    Field{"ambiguity_margin", &GridOptions::ambiguity_margin, 2, within(0, 100), "",
          "An incomplete grid needs this many circles more than its runner-up placement."},
    Field{"least_rival_overlap", &GridOptions::least_rival_overlap, 0.5, within(0.1, 1.0), "",
          "Other placements that share this part of the circles are held against the one that was found."},
    Field{"most_missing", &GridOptions::most_missing, 0.2, within(0.0, 1.0), "",
          "Circles that should be seen and are not, as part of those that are, for a board to be believed."},
    Field{"look_every_windows", &GridOptions::look_every_windows, 10, within(1, 10000), "",
          "Once circles have told how the board lies, one in so many tracked windows is asked again; every "
          "one before that."},
    Field{"contradicting_looks", &GridOptions::contradicting_looks, 2, within(1, 1000), "",
          "A board is laid anew where so many looks in a row show it laid another way."}};
constexpr auto kGridDefaults = defaultsOf<GridOptions, kGridFields>();

constexpr std::tuple kTrackingFields{
    Field{"fit_travel_px", &TrackingOptions::fit_travel_px, 3.0, within(0.5, 20.0), "px",
          "The board's motion is fitted to bursts while edges travel this far."},
    Field{"longest_fit_half_window_s", &TrackingOptions::longest_fit_half_window_s, 0.06, within(1e-3, 0.5),
          "s", "But to bursts no further away in time than this."},
    Field{"first_gate_px", &TrackingOptions::first_gate_px, 3.0, within(0.5, 20.0), "px",
          "Bursts this near an edge, at first."},
    Field{"last_gate_px", &TrackingOptions::last_gate_px, 1.0, within(0.3, 20.0), "px",
          "Bursts this near an edge, at last."},
    Field{"gate_ratio", &TrackingOptions::gate_ratio, 0.6, within(0.1, 1.0), "",
          "By which the gate narrows from step to step."},
    Field{"robust_scale_px", &TrackingOptions::robust_scale_px, 0.4, within(0.05, 5.0), "px",
          "Scale of the Cauchy weight."},
    Field{"iterations", &TrackingOptions::iterations, 8, within(2, 50), "",
          "Gauss-Newton steps of the joint fit."},
    Field{"least_polarity_cosine", &TrackingOptions::least_polarity_cosine, 0.35, within(0.0, 1.0), "",
          "Cosine between edge normal and motion below which an edge is left out: it grazes pixels."},
    Field{"full_polarity_cosine", &TrackingOptions::full_polarity_cosine, 0.7, within(0.0, 1.0), "",
          "Cosine from which an edge has its full weight."},
    Field{"least_event_part", &TrackingOptions::least_event_part, 0.8, within(0.0, 1.0), "",
          "Bursts with fewer events than this part of a typical one are left out: their edges graze the "
          "pixel."},
    Field{"full_event_part", &TrackingOptions::full_event_part, 1.0, within(0.0, 1.0), "",
          "Bursts from this part of the typical number of events have their full weight."},
    Field{"least_arc", &TrackingOptions::least_arc, 0.25, within(0.05, 1.0), "",
          "Part of a circle's 16 sectors that must hold bursts."},
    Field{"least_circle_bursts", &TrackingOptions::least_circle_bursts, 8, within(3, 1000), "",
          "Bursts that a circle must have."},
    Field{"least_inliers", &TrackingOptions::least_inliers, 0.6, within(0.0, 1.0), "",
          "Part of the bursts around a circle's edge that must lie on it, within the robust scale."},
    Field{"largest_centre_sigma_px", &TrackingOptions::largest_centre_sigma_px, 0.5, within(0.05, 5.0), "px",
          "A circle's centre less sure than this is left out."},
    Field{"largest_centre_shift_px", &TrackingOptions::largest_centre_shift_px, 1.5, within(0.2, 10.0), "px",
          "A circle this far off the board's fit is left out."},
    Field{"radius_offset_sigma_px", &TrackingOptions::radius_offset_sigma_px, 0.15, within(0.01, 2.0), "px",
          "How far one circle's radius may differ from what all show."},
    Field{"prediction_sigma_px", &TrackingOptions::prediction_sigma_px, 4.0, within(0.1, 50.0), "px",
          "How far the prediction from the window before is trusted."},
    Field{"velocity_sigma_px_s", &TrackingOptions::velocity_sigma_px_s, 150.0, within(1.0, 1e5), "px/s",
          "How far the velocity may differ from the prediction."},
    Field{"acceleration_sigma_px_s2", &TrackingOptions::acceleration_sigma_px_s2, 1500.0, within(1.0, 1e6),
          "px/s^2", "How large accelerations are."},
    Field{"longest_gap_s", &TrackingOptions::longest_gap_s, 0.3, within(0.0, 5.0), "s",
          "A lost board is predicted for this long before it is searched anew."}};
constexpr auto kTrackingDefaults = defaultsOf<TrackingOptions, kTrackingFields>();

constexpr std::tuple kExtentFields{
    Field{"every_windows", &ExtentOptions::every_windows, 5, within(1, 1000), "",
          "One in so many tracked windows is looked at."},
    Field{"least_line", &ExtentOptions::least_line, 0.6, within(0.3, 1.0), "",
          "Part of a row or column that must lie in the image to be judged, and of that part that must be "
          "seen to be there."},
    Field{"least_views", &ExtentOptions::least_views, 15, within(1, 100000), "",
          "Views looked at without which nothing is said."},
    Field{"largest_share", &ExtentOptions::largest_share, 0.25, within(0.0, 1.0), "",
          "Part of the views that may contradict the session's rows or columns."}};
constexpr auto kExtentDefaults = defaultsOf<ExtentOptions, kExtentFields>();

}  // namespace

BurstOptions::BurstOptions() : BurstOptions(kBurstDefaults) {}

const OptionTable<BurstOptions>& BurstOptions::table() {
  static const OptionTable<BurstOptions> table(
      kBurstFields, Ordered{&BurstOptions::shortest_gap_s, &BurstOptions::longest_gap_s});
  return table;
}

DetectionOptions::DetectionOptions() : DetectionOptions(kDetectionDefaults) {}

const OptionTable<DetectionOptions>& DetectionOptions::table() {
  static const OptionTable<DetectionOptions> table(
      kDetectionFields, Ordered{&DetectionOptions::shortest_window_s, &DetectionOptions::longest_window_s},
      Ordered{&DetectionOptions::search_interval_s, &DetectionOptions::longest_search_interval_s},
      Ordered{&DetectionOptions::smallest_radius_px, &DetectionOptions::largest_radius_px});
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
      kGridFields, Ordered{&GridOptions::shortest_step_radii, &GridOptions::longest_step_radii});
  return table;
}

TrackingOptions::TrackingOptions() : TrackingOptions(kTrackingDefaults) {}

const OptionTable<TrackingOptions>& TrackingOptions::table() {
  static const OptionTable<TrackingOptions> table(
      kTrackingFields, Ordered{&TrackingOptions::last_gate_px, &TrackingOptions::first_gate_px},
      Ordered{&TrackingOptions::least_polarity_cosine, &TrackingOptions::full_polarity_cosine},
      Ordered{&TrackingOptions::least_event_part, &TrackingOptions::full_event_part});
  return table;
}

ExtentOptions::ExtentOptions() : ExtentOptions(kExtentDefaults) {}

const OptionTable<ExtentOptions>& ExtentOptions::table() {
  static const OptionTable<ExtentOptions> table(kExtentFields);
  return table;
}

}  // namespace evical
