#include "core/pipeline/runs/result_files.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/files_together.h"
#include "core/base/progress.h"
#include "core/export/export_target.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/detection/saved_detections.h"
#include "core/pipeline/runs/saved_run.h"
#include "core/report/csv.h"
#include "core/report/html/html_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>
#include <set>
#include <span>
#include <vector>

namespace evical {
namespace {

std::vector<SeenBoard> seenBoards(const Session& session) {
  std::vector<SeenBoard> boards;
  for (std::size_t k = 0; k < session.cameras.size(); ++k) boards.push_back(session.seenBoard(k));
  return boards;
}

}  // namespace

std::vector<FileContent> reportOf(const Session& session, const NamedResult& named,
                                  const DetectionResult& detections,
                                  std::span<const std::optional<IntrinsicsResult>> intrinsics,
                                  const CalibrationCheck* check) {
  const OptimisationOptions& options = *session.options.optimisation;
  const ReportData data{
      named,
      session.recording.filename().string(),
      seenBoards(session),
      detections.start_ns,
      detections.cameras,
      detections.lenses,
      detections.imus,
      detections.resolutions_px,
      detections.faults,
      {options.needed_rotation_deg, options.needed_translation_mm, options.needed_time_offset_ms},
      intrinsics,
      check};
  std::vector<FileContent> files;
  for (ReportFile& file : reportFiles(data)) files.push_back({file.name, std::move(file.content)});
  return files;
}

namespace {

void addReport(const Session& session, const NamedResult& named, const DetectionResult& detections,
               std::vector<FileContent>& files,
               std::span<const std::optional<IntrinsicsResult>> intrinsics = {}) {
  for (FileContent& file : reportOf(session, named, detections, intrinsics)) files.push_back(std::move(file));
}

// Failing exports are reported and do not affect the result.
ExportRemarks addExports(const NamedResult& named, const Session& session, std::vector<FileContent>& files) {
  std::set<std::string> targets(session.exports.begin(), session.exports.end());
  targets.insert("kalibr");
  const std::vector<std::string> names(targets.begin(), targets.end());
  try {
    ExportedFiles exported = exportWhatCanBe(named, names);
    std::move(exported.files.begin(), exported.files.end(), std::back_inserter(files));
    return {std::move(exported.notes), std::move(exported.refused), std::move(exported.targets)};
  } catch (const CalibrationError& refusal) {
    return {{}, {fmt::format("{}: not exported: {}", fmt::join(names, ", "), refusal.what())}, {}};
  }
}

}  // namespace

NamedResult namedResult(const Session& session, std::shared_ptr<const CalibrationResult> result,
                        const std::string& version) {
  NamedResult named;
  named.reference = session.reference;
  for (const SessionCamera& camera : session.cameras) named.cameras.push_back({camera.name, camera.stream});
  for (const SessionImu& imu : session.imus) {
    named.imus.push_back({imu.name, imu.stream, imu.noise});
    named.imus.back().accelerometer_stream = imu.accelerometer_stream;
  }
  named.boards = {session.board_name};
  for (const AdditionalBoard& further : session.further_boards) named.boards.push_back(further.name);
  named.version = version;
  named.options = differingOptions(session.options);
  named.result = std::move(result);
  return named;
}

NamedResult namedRun(const Session& session, const std::shared_ptr<const CalibrationRun>& run,
                     const std::string& version) {
  NamedResult named = namedResult(session, resultOf(run), version);
  for (std::size_t i = 0; i < named.imus.size() && i < run->detections.imus.size(); ++i)
    named.imus[i].rate_hz = run->detections.imus[i].rate_hz();
  for (std::size_t i = 0; i < named.cameras.size() && i < run->detections.cameras.size(); ++i)
    named.cameras[i].kind = run->detections.cameras[i].kind;
  return named;
}

std::shared_ptr<const CalibrationResult> resultOf(const std::shared_ptr<const CalibrationRun>& run) {
  return {run, &run->result};
}

ExportRemarks writeResultFiles(const std::filesystem::path& folder, const Session& session,
                               const std::shared_ptr<const CalibrationRun>& shared_run,
                               const std::string& version, const std::string& log) {
  const CalibrationRun& run = *shared_run;
  const NamedResult named = namedRun(session, shared_run, version);
  // Tables of long recordings are large: each is written before the next is created.
  FilesTogether files;
  const auto write = [&](const FileContent& file) { files.writeInto(folder, file); };
  const auto writeAll = [&](const std::vector<FileContent>& contents) {
    std::for_each(contents.begin(), contents.end(), write);
  };
  writeAll(detectionFiles(session, run.detections, run.intrinsics));
  write({"trajectory.csv", trajectoryCsv(run.result.state)});
  const std::string biases = biasesCsv(named);
  if (!biases.empty()) write({"biases.csv", biases});
  writeAll(reportOf(session, named, run.detections, run.intrinsics));
  std::vector<FileContent> exported;
  ExportRemarks remarks = addExports(named, session, exported);
  writeAll(exported);
  std::string full_log = log;
  for (const auto& texts : {remarks.notes, remarks.refused})
    for (const std::string& text : texts) full_log += text + "\n";
  write({"log.txt", full_log});
  write({"residuals.csv", {}, [&](const TextSink& sink) {
           residualsCsv(named, run.result.circle_residuals, sink);
         }});
  const auto now_s =
      std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch());
  const std::string result_yaml = resultYaml(named);
  writeAll(runFiles(folder, session, run, result_yaml, now_s.count()));
  write({kResultFile, result_yaml});  // written last: marks a complete result
  files.place();
  return remarks;
}

std::vector<ExportCheck> checkExports(const std::filesystem::path& folder,
                                      std::span<const std::string> targets, const std::stop_token& stop) {
  const NamedResult written = readResultYaml(folder / "result.yaml");
  std::vector<ExportCheck> checks;
  for (const std::string& target : targets) {
    if (stop.stop_requested()) throw Cancelled{};
    checks.push_back(checkExport(written, exportTarget(target, "exports"), folder));
  }
  return checks;
}

void writeDetectionFiles(const std::filesystem::path& folder, const Session& session,
                         const DetectionResult& detections, const std::string& log) {
  std::vector<FileContent> files = {{"log.txt", log}};
  for (FileContent& file : detectionFiles(session, detections, {})) files.push_back(std::move(file));
  for (FileContent& file : files) file.path = folder / file.path;
  writeFilesWhole(files);
}

void writeFailure(const std::filesystem::path& folder, const Session& session, const QualityWarning& cause,
                  const std::string& version, const std::string& log, const DetectionResult& detections) {
  const auto failed = std::make_shared<CalibrationResult>();
  failed->status = CalibrationStatus::Failed;
  failed->reason = cause.text;
  failed->repair = cause.repair;
  failed->causes = {cause};
  if (!detections.cameras.empty() || !detections.imus.empty()) failed->start_ns = detections.start_ns;
  failed->timing.read_s = detections.read_s;
  failed->timing.detect_s = detections.detect_s;
  const NamedResult named = namedResult(session, failed, version);
  std::vector<FileContent> files = {{"log.txt", log}};
  addReport(session, named, detections, files);
  files.push_back({"result.yaml", resultYaml(named)});
  writeExportedFiles(folder, files);
}

}  // namespace evical
