#include "core/frames/frame_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kFrameFields{
    Field{"rate_hz", &FrameOptions::rate_hz, 10.0, within(0.1, 1000.0), "Hz",
          "Frames are thinned to this rate before they are decoded.", Level::Public},
    Field{"largest_blur_px", &FrameOptions::largest_blur_px, 4.0, within(0.1, 100.0), "px",
          "A frame in which the board moves further while it is exposed is not used.", Level::Expert},
    Field{"least_points", &FrameOptions::least_points, 0.25, within(0.01, 1.0), "",
          "Part of the board's points that a frame must show.", Level::Expert},
    Choice{"tag_border", &FrameOptions::tag_border, TagBorder::Automatic, std::array{"automatic", "1", "2"},
           "Width of an AprilGrid's black border in bits: Kalibr prints 2, most others 1.", Level::Public,
           Applies::WithAprilGrid},
    Choice{"markers", &FrameOptions::markers, MarkerFamily::Automatic,
           std::array{"automatic", "4x4", "5x5", "6x6", "7x7", "original"},
           "ArUco dictionary of a ChArUco board, by its bits.", Level::Public, Applies::WithCharuco},
    Field{"subpixel_window_px", &FrameOptions::subpixel_window_px, 5, within(2, 20), "px",
          "Half width of the window in which a corner is measured, where the pattern leaves that much room."},
    Field{"smallest_sigma_px", &FrameOptions::smallest_sigma_px, 0.05, within(0.001, 5.0), "px",
          "Added to what a picture's noise makes of a point's uncertainty: print, optics, pixels."},
    Field{"point_sigma_px", &FrameOptions::point_sigma_px, 0.2, within(0.001, 100.0), "px",
          "Of points that another program measured, where it does not say how well; what they scatter is "
          "found anyway.",
          Level::Expert},
    Field{"largest_move_px", &FrameOptions::largest_move_px, 2.0, within(0.5, 20.0), "px",
          "A corner that is measured further from where the others put it is dropped."},
    Field{"least_contrast", &FrameOptions::least_contrast, 8.0, within(1.0, 200.0), "",
          "Between the dark and the bright fields around a corner, of 255."},
    Field{"prediction_gate_px", &FrameOptions::prediction_gate_px, 6.0, within(1.0, 50.0), "px",
          "How far from its prediction the board is looked for before all of the frame is searched."},
    Field{"search_every_frames", &FrameOptions::search_every_frames, 20, within(1, 10000), "",
          "All of the frame is searched again after so many in which the board was followed."}};
constexpr auto kFrameDefaults = defaultsOf<FrameOptions, kFrameFields>();

}  // namespace

FrameOptions::FrameOptions() : FrameOptions(kFrameDefaults) {}

const OptionTable<FrameOptions>& FrameOptions::table() {
  static const OptionTable<FrameOptions> table(kFrameFields);
  return table;
}

}  // namespace evical
