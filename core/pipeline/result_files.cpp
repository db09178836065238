#include "core/pipeline/result_files.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/report/csv.h"
#include "core/report/html/html_report.h"

#include <system_error>
#include <vector>

namespace evical {
namespace {

void addReport(const std::filesystem::path& folder, const Session& session, const NamedResult& named,
               const RecordingPass& pass, std::vector<FileContent>& files) {
  const OptimisationOptions& options = session.options.optimisation;
  const ReportData data{
      named,
      session.recording.filename().string(),
      session.board,
      pass.start_ns,
      pass.cameras,
      pass.imus,
      pass.resolutions_px,
      pass.faults,
      {options.needed_rotation_deg, options.needed_translation_mm, options.needed_time_offset_ms}};
  for (ReportFile& file : reportFiles(data)) files.push_back({folder / file.name, std::move(file.content)});
}

// The report's plots have a folder of their own, which goes again if nothing could be written.
void writeWithPlots(const std::filesystem::path& folder, const std::vector<FileContent>& files) {
  makeOutputFolder(folder / "plots");
  try {
    writeFilesWhole(files);
  } catch (const CalibrationError&) {
    std::error_code ignored;
    std::filesystem::remove(folder / "plots", ignored);  // only if empty
    throw;
  }
}

}  // namespace

NamedResult namedResult(const Session& session, const CalibrationResult& result, const std::string& version) {
  NamedResult named;
  named.result = result;
  named.names.reference = session.reference;
  for (const SessionCamera& camera : session.cameras) {
    named.names.cameras.push_back(camera.name);
    named.names.intrinsics.push_back(camera.intrinsics);
  }
  for (const SessionImu& imu : session.imus) named.names.imus.push_back(imu.name);
  named.names.version = version;
  named.names.options = differingOptions(session.options);
  return named;
}

void writeResultFiles(const std::filesystem::path& folder, const Session& session, const CalibrationRun& run,
                      const std::string& version, const std::string& log) {
  const NamedResult named = namedResult(session, run.result, version);
  std::vector<FileContent> files = {{folder / "result.yaml", resultYaml(named)},
                                    {folder / "trajectory.csv", trajectoryCsv(run.result.state)},
                                    {folder / "detections.csv", detectionsCsv(run.pass.cameras)},
                                    {folder / "windows.csv", windowsCsv(run.pass.cameras)},
                                    {folder / "log.txt", log}};
  addReport(folder, session, named, run.pass, files);
  writeWithPlots(folder, files);
}

void writeDetectionFiles(const std::filesystem::path& folder, const RecordingPass& pass,
                         const std::string& log) {
  const std::vector<FileContent> files = {{folder / "detections.csv", detectionsCsv(pass.cameras)},
                                          {folder / "windows.csv", windowsCsv(pass.cameras)},
                                          {folder / "log.txt", log}};
  writeFilesWhole(files);
}

void writeFailure(const std::filesystem::path& folder, const Session& session, const std::string& reason,
                  const std::string& version, const std::string& log, const RecordingPass& pass) {
  CalibrationResult failed;
  failed.status = CalibrationStatus::Failed;
  failed.reason = reason;
  if (!pass.cameras.empty() || !pass.imus.empty()) failed.start_ns = pass.start_ns;
  failed.timing.read_s = pass.read_s;
  failed.timing.detect_s = pass.detect_s;
  const NamedResult named = namedResult(session, failed, version);
  std::vector<FileContent> files = {{folder / "result.yaml", resultYaml(named)}, {folder / "log.txt", log}};
  addReport(folder, session, named, pass, files);
  writeWithPlots(folder, files);
}

}  // namespace evical
