#include "core/frames/frame_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kFrameFields{
    Field{"rate_hz", &FrameOptions::rate_hz, 10.0, within(0.1, 1000.0), "Hz",
          "Largest rate of decoded frames; others are skipped.", Level::Public},
    Field{"max_blur_px", &FrameOptions::max_blur_px, 4.0, within(0.1, 100.0), "px",
          "Largest movement of the board during the exposure of a used frame.", Level::Expert},
    Field{"min_points", &FrameOptions::min_points, 0.25, within(0.01, 1.0), "",
          "Smallest share of the board's points in a used frame.", Level::Expert},
    Choice{"tag_border", &FrameOptions::tag_border, TagBorder::Automatic, std::array{"automatic", "1", "2"},
           "Width of an AprilGrid's black border in bits: Kalibr prints 2, most others 1.", Level::Public,
           Applies::WithAprilGrid},
    Choice{"markers", &FrameOptions::markers, MarkerFamily::Automatic,
           std::array{"automatic", "4x4", "5x5", "6x6", "7x7", "original"},
           "ArUco dictionary of a ChArUco board, by the size of its markers in bits.", Level::Public,
           Applies::WithCharuco},
    Field{"subpixel_window_px", &FrameOptions::subpixel_window_px, 5, within(2, 20), "px",
          "Half width of the window in which a corner is measured; smaller if the pattern requires it."},
    Field{"min_sigma_px", &FrameOptions::min_sigma_px, 0.05, within(0.001, 5.0), "px",
          "Sigma of errors from print, optics and pixels, in addition to a picture's noise."},
    Field{"point_sigma_px", &FrameOptions::point_sigma_px, 0.2, within(0.001, 100.0), "px",
          "Prior sigma of points from another program that does not specify one; their scatter is estimated "
          "in any case.",
          Level::Expert},
    Field{"max_move_px", &FrameOptions::max_move_px, 2.0, within(0.5, 20.0), "px",
          "Largest distance of a corner from its place according to the others; other corners are excluded."},
    Field{"min_contrast", &FrameOptions::min_contrast, 8.0, within(1.0, 200.0), "",
          "Smallest contrast between the dark and the bright fields around a corner, out of 255."},
    Field{"prediction_gate_px", &FrameOptions::prediction_gate_px, 6.0, within(1.0, 50.0), "px",
          "Largest distance from the prediction in tracking; beyond it the whole frame is searched."},
    Field{"search_every_frames", &FrameOptions::search_every_frames, 20, within(1, 10000), "",
          "Number of tracked frames after which the whole frame is searched again."},
    Field{
        "tag_neighbour_error", &FrameOptions::tag_neighbour_error, 0.35, within(0.01, 1.0), "",
        "Largest error of a neighbouring tag's place that agrees, relative to its distance; wrong places and "
        "rotations exceed 0.7."},
    Field{"min_tag_agreement", &FrameOptions::min_tag_agreement, 0.65, within(0.0, 1.0), "",
          "Smallest share of neighbouring tags that agree with an order and rotation of the tags.",
          Level::Tuning, Applies::WithAprilGrid},
    Field{"same_tag_agreement", &FrameOptions::same_tag_agreement, 0.1, within(0.0, 1.0), "",
          "Largest difference of that share between orders and rotations that are equally good.",
          Level::Tuning, Applies::WithAprilGrid},
    Field{"min_marker_agreement", &FrameOptions::min_marker_agreement, 0.4, within(0.0, 1.0), "",
          "Smallest share of neighbouring markers that agree with the board; false detections are "
          "neighbours, too.",
          Level::Tuning, Applies::WithCharuco}};
constexpr auto kFrameDefaults = defaultsOf<FrameOptions, kFrameFields>();

}  // namespace

FrameOptions::FrameOptions() : FrameOptions(kFrameDefaults) {}

const OptionTable<FrameOptions>& FrameOptions::table() {
  static const OptionTable<FrameOptions> table(kFrameFields);
  return table;
}

namespace {

constexpr std::tuple kBlinkFields{
    Field{"min_hz", &BlinkOptions::min_hz, 5.0, within(1.0, 100.0), "Hz",
          "Lowest flash rate that is detected."},
    Field{"max_hz", &BlinkOptions::max_hz, 500.0, within(10.0, 500.0), "Hz",
          "Highest flash rate that is detected."},
    Field{
        "min_peak", &BlinkOptions::min_peak, 0.4, within(0.05, 0.99), "",
        "Smallest autocorrelation of ON minus OFF events after one period, in bins of 1 ms, that counts as a "
        "blink."},
    Field{"min_share", &BlinkOptions::min_share, 0.3, within(0.01, 1.0), "",
          "Smallest share of events from pixels that brighten and darken in every period."},
    Field{"look_s", &BlinkOptions::look_s, 1.0, within(0.1, 10.0), "s",
          "Length of the time intervals that are searched for blinking."},
    Field{"max_move_px", &BlinkOptions::max_move_px, 0.3, within(0.01, 10.0), "px",
          "Largest movement of the board while flashes are summed to one picture."},
    Field{"still_px", &BlinkOptions::still_px, 0.5, within(0.0, 100.0), "px",
          "Largest movement of the board between views that are merged, since their errors are correlated."},
    Field{"min_side_px", &BlinkOptions::min_side_px, 512, within(64, 4096), "px",
          "Smallest longer side of the pictures of flashes; smaller pictures are enlarged."}};
constexpr auto kBlinkDefaults = defaultsOf<BlinkOptions, kBlinkFields>();

}  // namespace

BlinkOptions::BlinkOptions() : BlinkOptions(kBlinkDefaults) {}

const OptionTable<BlinkOptions>& BlinkOptions::table() {
  static const OptionTable<BlinkOptions> table(kBlinkFields,
                                               Ordered{&BlinkOptions::min_hz, &BlinkOptions::max_hz});
  return table;
}

}  // namespace evical
