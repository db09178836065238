// Detections of a run, stored with its result, from which a later run of the same session can start instead
// of from the recording's events and frames. detections.csv and windows.csv contain views and windows,
// detections.yaml the rest; IMU samples are read again.
#pragma once

#include "core/base/atomic_file.h"
#include "core/base/progress.h"
#include "core/base/yaml_node.h"
#include "core/data/intrinsics_result.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/session/session.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace evical {

// The three files of a pass. `intrinsics`: lenses that were calibrated first, by camera; empty if none.
std::vector<FileContent> detectionFiles(const Session& session, const DetectionResult& detections,
                                        std::span<const std::optional<IntrinsicsResult>> intrinsics);

struct RestoredDetections {
  DetectionResult detections;
  std::vector<std::optional<IntrinsicsResult>> intrinsics;  // of the run
};

// Throws CalibrationError (BadInput) if a file is missing or damaged, and if the detections do not match this
// session: another board, a missing camera, another stream, resolution, lens or clock, or a longer time
// range. Cameras that the session does not have are ignored.
RestoredDetections restoreDetections(const std::filesystem::path& folder, const Session& session,
                                     const RunContext& context);

// Intrinsics that were calibrated first, with all data for reports, as YAML.

// Without the intrinsics themselves. One key per line, each indented by `indent` blanks.
std::string foundIntrinsicsYaml(const IntrinsicsResult& found, int indent);
IntrinsicsResult foundIntrinsicsFrom(const YamlNode& map, const CameraIntrinsics& intrinsics);

}  // namespace evical
