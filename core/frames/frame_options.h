// Options of the detection of boards in frames.
#pragma once

#include "core/base/option_row.h"

namespace evical {

enum class TagBorder { Automatic, One, Two };
enum class MarkerFamily { Automatic, Of4x4, Of5x5, Of6x6, Of7x7, Original };

struct FrameOptions {
  double rate_hz;
  double max_blur_px;
  double min_points;
  TagBorder tag_border;
  MarkerFamily markers;
  int subpixel_window_px;
  double min_sigma_px;
  double point_sigma_px;
  double max_move_px;
  double min_contrast;
  double prediction_gate_px;
  int search_every_frames;
  double tag_neighbour_error;
  double min_tag_agreement;
  double same_tag_agreement;
  double min_marker_agreement;

  FrameOptions();  // the defaults
  constexpr explicit FrameOptions(NoDefaults) {}
  bool operator==(const FrameOptions&) const = default;
  static const OptionTable<FrameOptions>& table();
};

// Options of the detection of blinking boards.
struct BlinkOptions {
  double min_hz, max_hz;
  double min_peak, min_share;
  double look_s;
  double max_move_px, still_px;
  int min_side_px;

  BlinkOptions();  // the defaults
  constexpr explicit BlinkOptions(NoDefaults) {}
  bool operator==(const BlinkOptions&) const = default;
  static const OptionTable<BlinkOptions>& table();
};

}  // namespace evical
