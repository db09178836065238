#include "core/frames/blink_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kBlinkFields{
    Field{"least_hz", &BlinkOptions::least_hz, 5.0, within(1.0, 100.0), "Hz",
          "A screen that flashes more slowly is not noticed."},
    Field{"most_hz", &BlinkOptions::most_hz, 500.0, within(10.0, 500.0), "Hz",
          "Nor is one that flashes faster."},
    Field{"least_peak", &BlinkOptions::least_peak, 0.4, within(0.05, 0.99), "",
          "Autocorrelation of brightening less darkening events, in bins of 1 ms, that a blink reaches one "
          "period "
          "later."},
    Field{"least_share", &BlinkOptions::least_share, 0.3, within(0.01, 1.0), "",
          "Share of the events that must come from pixels which brighten and darken in every period."},
    Field{"look_s", &BlinkOptions::look_s, 1.0, within(0.1, 10.0), "s",
          "So much of the recording is looked at together to notice a blink."},
    Field{"largest_move_px", &BlinkOptions::largest_move_px, 0.3, within(0.01, 10.0), "px",
          "Flashes are added up while the board moves by less."},
    Field{"still_px", &BlinkOptions::still_px, 0.5, within(0.0, 100.0), "px",
          "Views of a board that has moved by less since are one view: they have their errors in common."},
    Field{"smallest_side_px", &BlinkOptions::smallest_side_px, 512, within(64, 4096), "px",
          "Pictures of the flashes are enlarged until their longer side has so many pixels."}};
constexpr auto kBlinkDefaults = defaultsOf<BlinkOptions, kBlinkFields>();

}  // namespace

BlinkOptions::BlinkOptions() : BlinkOptions(kBlinkDefaults) {}

const OptionTable<BlinkOptions>& BlinkOptions::table() {
  static const OptionTable<BlinkOptions> table(kBlinkFields,
                                               Ordered{&BlinkOptions::least_hz, &BlinkOptions::most_hz});
  return table;
}

}  // namespace evical
