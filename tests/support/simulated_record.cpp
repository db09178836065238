#include "tests/support/simulated_record.h"

#include "core/frontend/detection_options.h"
#include "core/pipeline/check/check_without_board.h"
#include "core/synthetic/event_simulator.h"
#include "tests/support/processor_time.h"

#include <vector>

namespace evical::test {

SimulatedRecord simulatedRecord(const Scenario& scenario, const CalibrationOptions& options) {
  SimulatedRecord seen;
  const SimulatedCamera& camera = scenario.cameras.front();
  CameraMotion motion(camera.intrinsics, options, scenario.start_ns);
  BurstExtractor bursts(camera.intrinsics.resolution_px, options.front_end->bursts);
  std::vector<EdgeCrossing> found;
  simulateEvents(
      scenario, 0,
      [&](EventSpan events) {
        const double before_s = threadCpu_s();
        found.clear();
        bursts.add(events, found);
        motion.add(found, bursts.completeUntil_ns());
        seen.processor_s += threadCpu_s() - before_s;
      },
      {}, 1);
  const double before_s = threadCpu_s();
  found.clear();
  bursts.finish(found);
  motion.add(found, bursts.completeUntil_ns());
  seen.record = motion.finish();
  seen.processor_s += threadCpu_s() - before_s;
  return seen;
}

}  // namespace evical::test
