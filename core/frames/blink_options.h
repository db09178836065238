// Options of the detection of blinking boards.
#pragma once

#include "core/base/option_struct.h"

namespace evical {

struct BlinkOptions {
  double least_hz, most_hz;
  double least_peak, least_share;
  double look_s;
  double largest_move_px, still_px;
  int smallest_side_px;

  BlinkOptions();  // the defaults
  constexpr explicit BlinkOptions(NoDefaults) {}
  bool operator==(const BlinkOptions&) const = default;
  static const OptionTable<BlinkOptions>& table();
};

}  // namespace evical
