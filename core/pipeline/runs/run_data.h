// run.data: what a run has found, bit by bit, as far as people's files of the result folder do not have it: splines,
// iterations, residuals, observations, the IMUs' samples. In parts, each with a check sum.
#pragma once

#include "core/base/text_sink.h"
#include "core/pipeline/rig/calibration_pipeline.h"

#include <filesystem>
#include <string>
#include <vector>

namespace evical {

std::string runData(const CalibrationRun& run);
// Piece by piece: never as a whole in memory.
void writeRunData(const CalibrationRun& run, const TextSink& sink);

struct ReadRunData {
  CalibrationRun run;  // parts that are missing are empty
  bool has_result = false, has_pass = false;
  std::vector<std::string> missing;  // in plain words, with the reason
};

// Never throws for what is in the file: parts that are damaged, of another version or contradict each other are
// missing.
ReadRunData readRunData(const std::filesystem::path& file);
ReadRunData parseRunData(const std::string& content);

}  // namespace evical
