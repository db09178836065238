// Lines about a live recording: what is missing, and what to do.
#pragma once

#include "app/console.h"
#include "core/base/time.h"
#include "core/pipeline/rig/live_watch.h"

#include <string>

namespace evical {

class LiveLines final : public LiveWatcher {
 public:
  explicit LiveLines(Console& console) : console_(console) {}
  void assessed(const LiveState& state) override;

 private:
  Console& console_;
  Stopwatch since_line_;
  std::string instruction_;
  bool first_ = true;
};

// "1.5 s, 3 events, ... in FILE (mcap)", and what was wrong.
void printLiveSummary(const LiveRequest& request, const LiveSummary& made);

}  // namespace evical
