// run.data: lossless data of a run that the other files of the result folder do not contain: splines,
// iterations, residuals, observations, IMU samples. Each part is an HDF5 file with a checksum; fields missing
// in older versions have their defaults.
#pragma once

#include "core/base/text_sink.h"
#include "core/format/hdf5_content.h"
#include "core/pipeline/rig/calibration_pipeline.h"

#include <filesystem>
#include <string>
#include <vector>

namespace evical {

std::string runData(const CalibrationRun& run);
// Written part by part, to limit the memory.
void writeRunData(const CalibrationRun& run, const TextSink& sink);

struct ReadRunData {
  CalibrationRun run;  // parts that are missing are empty
  bool has_result = false, has_pass = false;
  std::vector<std::string> missing;  // descriptions with reasons
};

// Does not throw for the file's content: parts that are damaged or inconsistent are missing.
ReadRunData readRunData(const std::filesystem::path& file);
ReadRunData parseRunData(const std::string& content);

// The two steps of reading: the datasets of all parts, such as "result/state/cameras/time_offset_s", and the
// run from them, without lists longer than `most`. The source throws CalibrationError (BadInput) for parts
// that are damaged or missing.
Hdf5Source runDatasets(const std::string& content);
ReadRunData runFrom(const Hdf5Source& datasets, std::size_t most);

}  // namespace evical
