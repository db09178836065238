// What a run leaves in its folder. All files appear together, or none of them.
#pragma once

#include "core/base/atomic_file.h"
#include "core/data/calibration_check.h"
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

// What `session` gives, with the session's names.
NamedResult namedResult(const Session& session, std::shared_ptr<const CalibrationResult> result,
                        const std::string& version);

// The same of a run, with what its recording says of the sensors.
NamedResult namedRun(const Session& session, const std::shared_ptr<const CalibrationRun>& run,
                     const std::string& version);

// Keeps the run alive.
std::shared_ptr<const CalibrationResult> resultOf(const std::shared_ptr<const CalibrationRun>& run);

// report.html with its plots/*.csv. `check`: of an older result by this recording.
std::vector<FileContent> reportOf(const Session& session, const NamedResult& named,
                                  const DetectionResult& pass,
                                  std::span<const std::optional<IntrinsicsResult>> intrinsics,
                                  const CalibrationCheck* check = nullptr);

// What to know of files for other programs, and the targets that got none, each with the reason.
struct ExportRemarks {
  std::vector<std::string> notes, refused;
  std::vector<std::string> targets = {};  // those that have files
};

// report.html with its plots/*.csv, result.yaml, trajectory.csv, residuals.csv, the files of saved_detections.h and
// saved_run.h, log.txt, and a
// folder a target: kalibr and what the session asks for. The remarks are in log.txt too.
ExportRemarks writeResultFiles(const std::filesystem::path& folder, const Session& session,
                               const std::shared_ptr<const CalibrationRun>& run, const std::string& version,
                               const std::string& log);

// What writeResultFiles has written for these targets, read as the targets' programs do, and held against result.yaml
// beside it. Throws CalibrationError where there is no such result, and Cancelled.
std::vector<ExportCheck> checkExports(const std::filesystem::path& folder,
                                      std::span<const std::string> targets, const std::stop_token& stop);

// The files of saved_detections.h, and log.txt.
void writeDetectionFiles(const std::filesystem::path& folder, const Session& session,
                         const DetectionResult& pass, const std::string& log);

// result.yaml with status failed and the reason, a report of what there is in `pass`, and log.txt; only where
// the folder is there already.
void writeFailure(const std::filesystem::path& folder, const Session& session, const QualityWarning& cause,
                  const std::string& version, const std::string& log, const DetectionResult& pass = {});

}  // namespace evical
