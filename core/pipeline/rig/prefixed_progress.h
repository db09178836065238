// A part of long work whose stages have the names that other parts have, too: which part it is stands before them.
#pragma once

#include "core/base/progress.h"

#include <string>
#include <string_view>
#include <utility>

namespace evical {

inline std::string prefixedStage(std::string_view prefix, std::string_view stage) {
  return std::string(prefix).append(": ").append(stage);
}

class PrefixedProgress final : public ProgressSink {
 public:
  PrefixedProgress(ProgressSink& progress, std::string prefix)
      : progress_(progress), prefix_(std::move(prefix)) {}

  void stageStarted(std::string_view stage) override {
    progress_.stageStarted(prefixedStage(prefix_, stage));
  }
  void stageProgress(double fraction_of_stage) override { progress_.stageProgress(fraction_of_stage); }
  void log(LogLevel level, std::string_view text) override {
    progress_.log(level, prefixedStage(prefix_, text));
  }

 private:
  ProgressSink& progress_;
  std::string prefix_;
};

}  // namespace evical
