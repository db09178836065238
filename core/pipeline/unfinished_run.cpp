#include "core/pipeline/unfinished_run.h"

#include "core/pipeline/result_files.h"

#include <optional>
#include <system_error>

namespace evical {
namespace {

std::optional<std::string> reasonToTell(const CalibrationOutcome& outcome, bool folder_was_there) {
  if (outcome.error && outcome.error->kind() == ErrorKind::CalibrationFailed) return outcome.error->what();
  if (outcome.status == RunStatus::Cancelled && folder_was_there) return "cancelled";
  return std::nullopt;
}

}  // namespace

void writeUnfinishedRun(const std::filesystem::path& folder, bool folder_was_there, const Session& session,
                        const CalibrationOutcome& outcome, const std::string& version,
                        const std::string& log) {
  const std::optional<std::string> reason = reasonToTell(outcome, folder_was_there);
  std::error_code ignored;
  if (!reason || !std::filesystem::is_directory(folder, ignored)) return;
  // A failed run keeps an earlier result of the same folder: it is still true of its own recording.
  if (std::filesystem::exists(folder / "trajectory.csv", ignored)) return;
  writeFailure(folder, session, *reason, version, log, outcome.pass);
}

}  // namespace evical
