#include "core/frames/blink_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kBlinkFields{
    Field{"least_hz", &BlinkOptions::least_hz, 5.0, within(1.0, 100.0), "Hz",
          "Lowest flash rate that is detected."},
    Field{"most_hz", &BlinkOptions::most_hz, 500.0, within(10.0, 500.0), "Hz",
          "Highest flash rate that is detected."},
    Field{
        "least_peak", &BlinkOptions::least_peak, 0.4, within(0.05, 0.99), "",
        "Smallest autocorrelation of ON minus OFF events after one period, in bins of 1 ms, that counts as a "
        "blink."},
    Field{"least_share", &BlinkOptions::least_share, 0.3, within(0.01, 1.0), "",
          "Smallest share of events from pixels that brighten and darken in every period."},
    Field{"look_s", &BlinkOptions::look_s, 1.0, within(0.1, 10.0), "s",
          "Length of the time intervals that are searched for blinking."},
    Field{"largest_move_px", &BlinkOptions::largest_move_px, 0.3, within(0.01, 10.0), "px",
          "Largest movement of the board while flashes are summed to one picture."},
    Field{"still_px", &BlinkOptions::still_px, 0.5, within(0.0, 100.0), "px",
          "Largest movement of the board between views that are merged, since their errors are correlated."},
    Field{"smallest_side_px", &BlinkOptions::smallest_side_px, 512, within(64, 4096), "px",
          "Smallest longer side of the pictures of flashes; smaller pictures are enlarged."}};
constexpr auto kBlinkDefaults = defaultsOf<BlinkOptions, kBlinkFields>();

}  // namespace

BlinkOptions::BlinkOptions() : BlinkOptions(kBlinkDefaults) {}

const OptionTable<BlinkOptions>& BlinkOptions::table() {
  static const OptionTable<BlinkOptions> table(kBlinkFields,
                                               Ordered{&BlinkOptions::least_hz, &BlinkOptions::most_hz});
  return table;
}

}  // namespace evical
