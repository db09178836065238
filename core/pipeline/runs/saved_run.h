// Folder of a run that can be opened again completely: the files of result_files.h, and
//   run_session.yaml  its session
//   run.data          lossless data of the run (run_data.h)
//   run.yaml          its entry in lists of runs
#pragma once

#include "core/base/atomic_file.h"
#include "core/base/option_row.h"
#include "core/base/progress.h"
#include "core/data/calibration_status.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/report/result_yaml.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// Files of a result's folder.
inline constexpr const char *kResultFile = "result.yaml", *kSessionFile = "run_session.yaml";

// File with this name in a folder; a file is returned unchanged.
std::filesystem::path resultFileOf(const std::filesystem::path& path, const char* name = kResultFile);

// Reads an old result for further use: result.yaml, or the folder of a run. Throws CalibrationError
// (BadInput) if it is missing or failed; `what` is the participle for the message: "checked".
NamedResult readOldResult(const std::filesystem::path& path, const std::string& what);

// Session of an old result; absent if it is not stored with the result. Throws CalibrationError (BadInput).
std::optional<Session> sessionOfOldResult(const std::filesystem::path& path);

// Content of run.yaml.
struct RunSummary {
  std::filesystem::path folder;
  std::string name;         // set by the user; empty: the date is displayed
  std::int64_t made_s = 0;  // since 1970, UTC
  CalibrationStatus status = CalibrationStatus::Ok;
  std::string reason;
  std::string recording;  // name of its file
  double took_s = 0.0;
  int rejected_windows = 0;        // by hand
  std::vector<OptionRow> options;  // that differ from their defaults

  bool operator==(const RunSummary& other) const {
    return folder == other.folder && name == other.name && made_s == other.made_s;
  }
};

struct SavedRun {
  RunSummary summary;
  Session session;
  std::shared_ptr<const CalibrationRun> run;
  std::string log;
  std::vector<std::string>
      missing;  // for a damaged folder or one of an older version: missing data with reasons
};

// The three files above. `result_yaml`: content of the run's result.yaml; `made_s`: since 1970.
std::vector<FileContent> runFiles(const std::filesystem::path& folder, const Session& session,
                                  const CalibrationRun& run, const std::string& result_yaml,
                                  std::int64_t made_s);

// Writes the folder of a run without report and exports: result.yaml, log.txt and the three files.
void keepRun(const std::filesystem::path& folder, const Session& session,
             const std::shared_ptr<const CalibrationRun>& run, const std::string& version,
             const std::string& log, std::int64_t made_s);

// Visits the session's recordings, then those of sensors.
template <class Sessions, class Visit>
void forEachRecording(Sessions& session, Visit&& visit) {
  visit(session.recording);
  for (auto& more : session.more_recordings) visit(more);
  for (auto& camera : session.cameras)
    if (!camera.recording.empty()) visit(camera.recording);
  for (auto& imu : session.imus)
    for (auto* const file : {&imu.recording, &imu.accelerometer_recording})
      if (!file->empty()) visit(*file);
}

// True for a folder with a result.yaml, for that file, and for a run.yaml.
bool isSavedRun(const std::filesystem::path& path);

// Throws CalibrationError (BadInput) only if there is nothing to display: both result.yaml and run.data are
// missing or damaged. Other missing data are listed. Numbers are those of result.yaml: run.data is not used
// if the two differ.
SavedRun readSavedRun(const std::filesystem::path& path);

// Throw CalibrationError (BadInput) if run.yaml is missing or damaged.
RunSummary readRunSummary(const std::filesystem::path& folder);
void renameRun(const std::filesystem::path& folder, const std::string& name);

// All runs in subfolders, the oldest first; unreadable ones are omitted.
std::vector<RunSummary> listRuns(const std::filesystem::path& folder);

// Options of a run that differ from those of another: "grid.min_circles 9 (was 8)".
std::vector<std::string> differingFrom(const RunSummary& before, const RunSummary& run);

// Removes the oldest runs until at most `most` runs with at most `max_bytes` in total remain; named runs are
// removed last, the newest is kept.
void removeOldRuns(std::vector<RunSummary> runs, std::size_t most, std::uintmax_t max_bytes);

// Files of a run without a result: the reason, if this does not overwrite an earlier result.

// `folder_was_there`: before this run. A failed run writes the reason. A cancelled run removes a folder that
// it has created; a run with bad input writes nothing.
void writeUnfinishedRun(const std::filesystem::path& folder, bool folder_was_there, const Session& session,
                        const CalibrationOutcome& outcome, const std::string& version,
                        const std::string& log);

}  // namespace evical
