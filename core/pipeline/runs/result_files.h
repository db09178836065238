// Files of a run. They are written together or not at all.
#pragma once

#include "core/base/atomic_file.h"
#include "core/data/assessment.h"
#include "core/export/read_back.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/report/result_yaml.h"

#include <filesystem>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace evical {

// Result with the session's names and data.
NamedResult namedResult(const Session& session, std::shared_ptr<const CalibrationResult> result,
                        const std::string& version);

// The same for a run, with data of its sensors from the recording.
NamedResult namedRun(const Session& session, const std::shared_ptr<const CalibrationRun>& run,
                     const std::string& version);

// Shares ownership of the run.
std::shared_ptr<const CalibrationResult> resultOf(const std::shared_ptr<const CalibrationRun>& run);

// report.html with its plots/*.csv. `check`: check of an older result with this recording.
std::vector<FileContent> reportOf(const Session& session, const NamedResult& named,
                                  const DetectionResult& detections,
                                  std::span<const std::optional<IntrinsicsResult>> intrinsics,
                                  const CalibrationCheck* check = nullptr);

// Remarks on files for other programs, and targets without files with their reasons.
struct ExportRemarks {
  std::vector<std::string> notes, refused;
  std::vector<std::string> targets = {};  // those that have files
};

// Writes report.html with its plots/*.csv, result.yaml, trajectory.csv, residuals.csv, the files of
// saved_detections.h and saved_run.h, log.txt, and a folder for each target: kalibr and the session's
// targets. The remarks are also in log.txt.
ExportRemarks writeResultFiles(const std::filesystem::path& folder, const Session& session,
                               const std::shared_ptr<const CalibrationRun>& run, const std::string& version,
                               const std::string& log);

// Reads the files of these targets as their programs do, and compares them with result.yaml in the same
// folder. Throws CalibrationError if there is no such result, and Cancelled.
std::vector<ExportCheck> checkExports(const std::filesystem::path& folder,
                                      std::span<const std::string> targets, const std::stop_token& stop);

// Writes the files of saved_detections.h, and log.txt.
void writeDetectionFiles(const std::filesystem::path& folder, const Session& session,
                         const DetectionResult& detections, const std::string& log);

// Writes result.yaml with status failed and the reason, a report of the data in `detections`, and log.txt;
// only if the folder exists.
void writeFailure(const std::filesystem::path& folder, const Session& session, const QualityWarning& cause,
                  const std::string& version, const std::string& log, const DetectionResult& detections = {});

}  // namespace evical
