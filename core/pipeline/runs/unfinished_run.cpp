#include "core/pipeline/runs/unfinished_run.h"

#include "core/pipeline/runs/result_files.h"

#include <optional>
#include <system_error>

namespace evical {
namespace {

std::optional<QualityWarning> causeToTell(const CalibrationOutcome& outcome, bool folder_was_there) {
  if (outcome.error && outcome.error->kind() == ErrorKind::CalibrationFailed)
    return QualityWarning{outcome.error->what(), outcome.error->repair(), "failure"};
  if (outcome.status == RunStatus::Cancelled && folder_was_there)
    return QualityWarning{"cancelled", {}, "cancelled"};
  return std::nullopt;
}

}  // namespace

void writeUnfinishedRun(const std::filesystem::path& folder, bool folder_was_there, const Session& session,
                        const CalibrationOutcome& outcome, const std::string& version,
                        const std::string& log) {
  const std::optional<QualityWarning> cause = causeToTell(outcome, folder_was_there);
  std::error_code ignored;
  if (!cause || !std::filesystem::is_directory(folder, ignored)) return;
  // A failed run keeps an earlier result of the same folder: that is still valid for its recording.
  if (std::filesystem::exists(folder / "trajectory.csv", ignored)) return;
  writeFailure(folder, session, *cause, version, log, outcome.detections);
}

}  // namespace evical
