#include "core/pipeline/result_files.h"

#include "core/base/atomic_file.h"
#include "core/report/csv.h"

#include <vector>

namespace evical {

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
  const std::vector<FileContent> files = {
      {folder / "result.yaml", resultYaml(namedResult(session, run.result, version))},
      {folder / "trajectory.csv", trajectoryCsv(run.result.state)},
      {folder / "detections.csv", detectionsCsv(run.pass.cameras)},
      {folder / "windows.csv", windowsCsv(run.pass.cameras)},
      {folder / "log.txt", log}};
  writeFilesWhole(files);
}

void writeDetectionFiles(const std::filesystem::path& folder, const RecordingPass& pass,
                         const std::string& log) {
  const std::vector<FileContent> files = {{folder / "detections.csv", detectionsCsv(pass.cameras)},
                                          {folder / "windows.csv", windowsCsv(pass.cameras)},
                                          {folder / "log.txt", log}};
  writeFilesWhole(files);
}

void writeFailure(const std::filesystem::path& folder, const Session& session, const std::string& reason,
                  const std::string& version, const std::string& log) {
  CalibrationResult failed;
  failed.status = CalibrationStatus::Failed;
  failed.reason = reason;
  const std::vector<FileContent> files = {
      {folder / "result.yaml", resultYaml(namedResult(session, failed, version))}, {folder / "log.txt", log}};
  writeFilesWhole(files);
}

}  // namespace evical
