// run.data: lossless data of a run that the other files of the result folder do not contain: splines,
// iterations, residuals, observations, IMU samples. Each part is an HDF5 file with a checksum; fields missing
// in older versions have their defaults. result.yaml is the truth and run.data its cache: a checksum ties
// them.
#pragma once

#include "core/base/atomic_file.h"
#include "core/format/hdf5_content.h"
#include "core/pipeline/rig/calibration_pipeline.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

std::string runData(const CalibrationRun& run);
// Written part by part, to limit the memory. `result_yaml`: content of the file with the same run.
void writeRunData(const CalibrationRun& run, const std::string& result_yaml, const TextSink& sink);

struct ReadRunData {
  CalibrationRun run;  // parts that are missing are empty
  bool has_result = false, has_pass = false;
  std::vector<std::string> missing;  // descriptions with reasons
};

// Does not throw for the file's content: parts that are damaged or inconsistent are missing. All are, if the
// file was not written with this `result_yaml`. Older versions did not write the checksum.
ReadRunData readRunData(const std::filesystem::path& file,
                        const std::optional<std::string>& result_yaml = std::nullopt);
ReadRunData parseRunData(const std::string& content);

// Why run.data next to a result.yaml is not used: the two differ. Absent if they agree, or if there is none.
std::optional<std::string> whyRunDataIsForeign(const std::filesystem::path& result_file);

// The two steps of reading: the datasets of all parts, such as "result/state/cameras/time_offset_s", and the
// run from them, without lists longer than `most`. The source throws CalibrationError (BadInput) for parts
// that are damaged or missing.
Hdf5Source runDatasets(const std::string& content);
ReadRunData runFrom(const Hdf5Source& datasets, std::size_t most);

}  // namespace evical
