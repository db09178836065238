// What a run has found of the board, kept beside its result, so that a later run of the same session starts from it
// instead of from the recording's events and frames: detections.csv and windows.csv hold views and windows,
// detections.yaml all else, and the IMUs' samples are read again.
#pragma once

#include "core/base/atomic_file.h"
#include "core/base/progress.h"
#include "core/data/intrinsics_result.h"
#include "core/pipeline/pass/recording_pass.h"
#include "core/pipeline/session/session.h"

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace evical {

// The three files of a pass. `intrinsics`: of lenses that were calibrated first, by camera; empty where none was.
std::vector<FileContent> detectionFiles(const Session& session, const DetectionResult& pass,
                                        std::span<const std::optional<IntrinsicsResult>> intrinsics);

struct RestoredDetections {
  DetectionResult pass;
  std::vector<std::optional<IntrinsicsResult>> intrinsics;  // as the run had them
};

// Throws CalibrationError (BadInput) where a file is missing or damaged, and where the detections are not those of
// this session: another board, a camera that is missing, another stream, resolution, lens or clock, or a longer
// time range. Cameras that the session does not have are left out.
RestoredDetections restoreDetections(const std::filesystem::path& folder, const Session& session,
                                     const RunContext& context);

}  // namespace evical
