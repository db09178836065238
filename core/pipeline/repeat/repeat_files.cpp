#include "core/pipeline/repeat/repeat_files.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/pipeline/runs/result_files.h"
#include "core/pipeline/runs/saved_run.h"
#include "core/report/assessment_report.h"
#include "core/report/html/html_report.h"

#include <system_error>
#include <utility>
#include <vector>

namespace evical {
namespace {

constexpr const char* kRepeat = "repeat.yaml";

}  // namespace

void checkRepeatFolder(const std::filesystem::path& folder) {
  if (pathExists(folder / kResultFile) && !pathExists(folder / kRepeat))
    throw badInput(folder.string(), "contains the result of a calibration, which the repeat would overwrite",
                   "Choose another folder");
}

std::filesystem::path folderOf(const std::filesystem::path& folder, const RepeatInput& input,
                               std::size_t recording) {
  return folder / "recordings" / input.names.at(recording);
}

void writeRepeatFiles(const std::filesystem::path& folder, const RepeatInput& input, const RepeatRun& repeat,
                      const std::string& log) {
  std::vector<FileContent> files = {{"log.txt", log}, {"repeat.csv", repeatCsv(repeat.repeatability)}};
  for (ReportFile& file : reportFiles(repeat.repeatability))
    files.push_back({file.name, std::move(file.content)});
  if (repeat.joint) {
    const Session session = sessionOfRepeat(input.sessions.at(repeat.own_values_of));
    files.push_back({kSessionFile, sessionYaml(session, folder)});
    files.push_back({kResultFile, resultYaml(*repeat.joint)});
  } else {
    std::error_code ignored;
    std::filesystem::remove(folder / kResultFile, ignored);
  }
  files.push_back({kRepeat, assessmentYaml(repeat.repeatability)});  // written last: marks a complete result
  writeExportedFiles(folder, files);
}

RepeatRun repeatInto(const std::filesystem::path& folder, const RepeatInput& input,
                     const std::string& version, const std::function<std::string()>& log,
                     const RunContext& context) {
  checkRepeatFolder(folder);
  const NewFolder made(folder);
  std::size_t logged = 0;  // of the previous recordings
  const auto keep = [&](std::size_t k, const Session& session,
                        const std::shared_ptr<const CalibrationRun>& one) {
    const std::filesystem::path of_one = folderOf(folder, input, k);
    makeFolderWithin(folder, of_one.lexically_relative(folder));
    const std::string all = log();
    writeResultFiles(of_one, session, one, version, all.substr(logged));
    logged = all.size();
  };
  RepeatRun repeat = repeatCalibration(input, keep, context);
  repeat.repeatability.version = version;
  if (repeat.joint) repeat.joint->version = version;
  writeRepeatFiles(folder, input, repeat, log());
  return repeat;
}

}  // namespace evical
