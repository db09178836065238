#include "core/optimisation/verdict_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kVerdictFields{
    Field{"correlation_time_s", &VerdictOptions::correlation_time_s, 0.2, within(0.001, 10.0), "s",
          "Residuals nearer in time than this may be correlated; the reported sigmas allow for it."},
    Field{"pixel_error_px", &VerdictOptions::pixel_error_px, 0.1, within(0.0, 10.0), "px",
          "Error of edges that repeats at the same pixel, so that motion over few pixels shows a wrong "
          "amplitude: part of the sigmas."},
    Field{"contradiction_sigmas", &VerdictOptions::contradiction_sigmas, 4.0, within(1.0, 1000.0), "sigma",
          "Known values that lie further than this from what the recording alone says are told of."},
    Field{"turned_gyroscope_sigmas", &VerdictOptions::turned_gyroscope_sigmas, 6.0, within(1.0, 1000.0),
          "sigma",
          "A gyroscope's turn that is not estimated is told of beyond this and needed_rotation_deg."},
    Field{"needed_rotation_deg", &VerdictOptions::needed_rotation_deg, 0.1, within(1e-4, 90.0), "deg",
          "Rotations less certain than this make the result doubtful.", Level::Common},
    Field{"needed_translation_mm", &VerdictOptions::needed_translation_mm, 1.0, within(1e-3, 1e4), "mm",
          "Translations less certain than this make the result doubtful.", Level::Common},
    Field{"needed_time_offset_ms", &VerdictOptions::needed_time_offset_ms, 0.1, within(1e-4, 1e4), "ms",
          "Time offsets less certain than this make the result doubtful.", Level::Common}};
constexpr auto kVerdictDefaults = defaultsOf<VerdictOptions, kVerdictFields>();

}  // namespace

VerdictOptions::VerdictOptions() : VerdictOptions(kVerdictDefaults) {}

const OptionTable<VerdictOptions>& VerdictOptions::table() {
  static const OptionTable<VerdictOptions> table(kVerdictFields);
  return table;
}

}  // namespace evical
