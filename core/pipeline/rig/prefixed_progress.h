// Progress of one part of a long run; prefixes distinguish it from parts with the same stage names.
#pragma once

#include "core/base/progress.h"

#include <string>
#include <string_view>
#include <utility>

namespace evical {

class PrefixedProgress final : public ProgressSink {
 public:
  PrefixedProgress(ProgressSink& progress, std::string part) : progress_(progress), part_(std::move(part)) {}

  void stageStarted(const ProgressStage& stage) override { progress_.stageStarted({stage.name, part_}); }
  void stageProgress(double fraction_of_stage) override { progress_.stageProgress(fraction_of_stage); }
  void log(LogLevel level, std::string_view text) override {
    progress_.log(level, part_ + ": " + std::string(text));
  }

 private:
  ProgressSink& progress_;
  std::string part_;
};

}  // namespace evical
