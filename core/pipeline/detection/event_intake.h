// Processing of one camera's events between recording and front end: checked, sorted, converted into bursts;
// or passed on unchanged if the board blinks.
#pragma once

#include "core/data/event.h"
#include "core/data/recording.h"
#include "core/frontend/edge_crossings.h"
#include "core/pipeline/detection/camera_views.h"
#include "core/pipeline/session/session.h"
#include "core/recording/read_out_load.h"
#include "core/recording/stray_stamps.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace evical {

// Number of events that are sorted together, since the packets of formats have different lengths.
inline constexpr std::size_t kBatchEvents = 50'000;

enum class EventUse { Bursts, Raw };

class EventIntake {
 public:
  EventIntake(std::size_t camera, const SessionCamera& session, Resolution resolution_px,
              const BurstOptions& bursts, EventUse use)
      : camera_(camera),
        session_(session),
        burst_options_(bursts),
        resolution_px_(resolution_px),
        use_(use) {}

  // Absent if no event remains. Throws BadInput if too many are outside the resolution.
  std::optional<CameraBatch> consume(std::vector<Event>& events);
  std::optional<CameraBatch> flush();

  std::uint64_t eventCount() const { return count_; }
  double stampStep_s() const { return stamp_step_.step_s(); }
  void report(std::vector<RecordingFault>& faults) const;

 private:
  void putInOrder(std::vector<Event>& events);

  std::size_t camera_;
  const SessionCamera& session_;
  BurstOptions burst_options_;
  Resolution resolution_px_;
  EventUse use_;
  std::uint64_t count_ = 0;  // passed on
  StampStep stamp_step_;
  ReadOutLoad load_;
  std::optional<BurstExtractor> extractor_;
  std::int64_t last_ns_ = std::numeric_limits<std::int64_t>::min();
  std::uint64_t seen_ = 0, outside_ = 0, unsorted_ = 0, late_ = 0;
};

}  // namespace evical
