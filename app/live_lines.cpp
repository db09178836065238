#include "app/live_lines.h"

#include "app/output.h"
#include "app/session_arguments.h"
#include "core/base/number.h"

#include <fmt/format.h>

namespace evical {

// When the instruction changes, and now and then.
void LiveLines::assessed(const LiveState& state) {
  constexpr double kBetweenLines_s = 5.0;
  const bool due = first_ || state.instruction != instruction_ ||
                   since_line_.elapsed_s() >= kBetweenLines_s || state.assessment.light == Light::Good;
  if (!due) return;
  first_ = false;
  instruction_ = state.instruction;
  since_line_ = Stopwatch();
  std::string line = fmt::format("{:.0f} s recorded", state.recorded_s);
  for (const ExpectedSigmas& sigmas : state.assessment.sigmas)
    line += fmt::format("; {}: \u00b1{:.2g} deg, \u00b1{:.2g} mm, \u00b1{:.2g} ms", sigmas.sensor,
                        sigmas.rotation_deg, sigmas.translation_mm, sigmas.time_offset_ms);
  if (state.assessment.light == Light::Good)
    line += "; good enough";
  else if (state.until_good_s && *state.until_good_s >= 1.0)
    line += fmt::format("; precise enough in about {:.0f} s at this pace", *state.until_good_s);
  if (state.behind_s >= 1.0) line += fmt::format("; the detection is {:.1f} s behind", state.behind_s);
  line += ".";
  if (!instruction_.empty()) line += " " + instruction_;
  console_.log(LogLevel::Info, line);
}

void printLiveSummary(const LiveRequest& request, const LiveSummary& made) {
  print("{:.1f} s, {}, {}{} in {} ({})\n", made.duration_s, counted(made.events, "event"),
        counted(made.imu_samples, "IMU sample"), made.frames > 0 ? ", " + counted(made.frames, "frame") : "",
        request.output.string(), made.format);
  printFaults(made.faults);
}

}  // namespace evical
