// A run as a folder that opens again with all that was in it: the result's files (result_files.h), and beside them
//   run_session.yaml  the session that it was made from
//   run.data          what a run has found, bit by bit (run_data.h)
//   run.yaml          what a list of runs shows of it
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

// Of a folder the file with this name, of a file the file itself.
std::filesystem::path resultFileOf(const std::filesystem::path& path, const char* name = kResultFile);

// An old result from which something goes on: result.yaml, or the folder of a run. Throws CalibrationError (BadInput) where
// there is none or it failed; `what` is what should become of it: "checked".
NamedResult readOldResult(const std::filesystem::path& path, const std::string& what);

// The session that it was made from; nothing where none is kept beside it. Throws CalibrationError (BadInput).
std::optional<Session> sessionOfOldResult(const std::filesystem::path& path);

// What run.yaml says.
struct RunSummary {
  std::filesystem::path folder;
  std::string name;         // given by a person; empty: it goes by its date
  std::int64_t made_s = 0;  // since 1970, UTC
  CalibrationStatus status = CalibrationStatus::Ok;
  std::string reason;
  std::string recording;  // its file's name
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
  std::vector<std::string> missing;  // of a folder that is damaged or of an older version: what, and why
};

// The three files. `made_s`: since 1970.
std::vector<FileContent> runFiles(const std::filesystem::path& folder, const Session& session,
                                  const CalibrationRun& run, std::int64_t made_s);

// The folder of a run, without report and files for other programs: result.yaml, log.txt and the three files.
void keepRun(const std::filesystem::path& folder, const Session& session,
             const std::shared_ptr<const CalibrationRun>& run, const std::string& version,
             const std::string& log, std::int64_t made_s);

// Whether this is a folder with a result.yaml, or that file, or a run.yaml.
bool isSavedRun(const std::filesystem::path& path);

// Throws CalibrationError (BadInput) only where there is nothing to be shown: result.yaml is missing or damaged, and
// run.data is, too. All else that lacks is listed.
SavedRun readSavedRun(const std::filesystem::path& path);

// Throw CalibrationError (BadInput) where run.yaml is missing or damaged.
RunSummary readRunSummary(const std::filesystem::path& folder);
void renameRun(const std::filesystem::path& folder, const std::string& name);

// All runs in the folders of a folder, the oldest first; those that cannot be read are left out.
std::vector<RunSummary> listRuns(const std::filesystem::path& folder);

// The options of a run that are not as those of another: "grid.least_circles 9 (was 8)".
std::vector<std::string> differingFrom(const RunSummary& before, const RunSummary& run);

// Removes the oldest runs until no more than so many are left, of no more than so many bytes in all; those with a name
// go last, and the newest stays.
void removeOldRuns(std::vector<RunSummary> runs, std::size_t most, std::uintmax_t most_bytes);

}  // namespace evical
