#include "core/base/progress.h"

#include "core/base/error.h"

namespace evical {
namespace {

class SilentProgress final : public ProgressSink {
 public:
  void stageStarted(const ProgressStage&) override {}
  void stageProgress(double) override {}
  void log(LogLevel, std::string_view) override {}
};

}  // namespace

const char* levelName(LogLevel level) {
  switch (level) {
    case LogLevel::Debug:
      return "debug";
    case LogLevel::Info:
      return "info";
    case LogLevel::Warning:
      return "warning";
  }
  return "";
}

ProgressSink& silentProgress() {
  static SilentProgress sink;
  return sink;
}

void RunContext::throwIfStopped() const {
  if (stop.stop_requested()) throw Cancelled{};
}

}  // namespace evical
