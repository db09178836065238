// run.data: what a run has found, bit by bit, as far as people's files of the result folder do not have it: splines,
// iterations, residuals, observations, the IMUs' samples. In parts, each an HDF5 file with a check sum; what a part of an
// older version lacks has its default.
#pragma once

#include "core/base/text_sink.h"
#include "core/format/hdf5_content.h"
#include "core/pipeline/rig/calibration_pipeline.h"

#include <filesystem>
#include <string>
#include <vector>

namespace evical {

std::string runData(const CalibrationRun& run);
// Part by part: never as a whole in memory.
void writeRunData(const CalibrationRun& run, const TextSink& sink);

struct ReadRunData {
  CalibrationRun run;  // parts that are missing are empty
  bool has_result = false, has_pass = false;
  std::vector<std::string> missing;  // in plain words, with the reason
};

// Never throws for what is in the file: parts that are damaged or contradict each other are missing.
ReadRunData readRunData(const std::filesystem::path& file);
ReadRunData parseRunData(const std::string& content);

// Its two steps: the datasets of all parts, "result/state/cameras/time_offset_s", and the run that they are of, without
// lists longer than `most`. The source throws CalibrationError (BadInput) for parts that are damaged or missing.
Hdf5Source runDatasets(const std::string& content);
ReadRunData runFrom(const Hdf5Source& datasets, std::size_t most);

}  // namespace evical
