#include "app/calibrate_command.h"
#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/output.h"
#include "app/session_arguments.h"
#include "app/version.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/base/run_trace.h"
#include "core/data/calibration_observer.h"
#include "core/pipeline/detection/saved_detections.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/runs/result_files.h"
#include "core/pipeline/runs/saved_run.h"
#include "core/report/result_table.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace evical {
namespace {

void reportEnd(const SessionArguments& arguments, const Session& session, const CalibrationOutcome& outcome,
               const Console& console, const NewFolder& folder) {
  writeUnfinishedRun(arguments.output, folder.wasThere(), session, outcome, kVersion, console.logText());
  if (outcome.error && outcome.error->repair()) printError(tryText(arguments, *outcome.error->repair()));
}

void printResult(const SessionArguments& arguments, const Session& session,
                 const std::shared_ptr<const CalibrationRun>& run, Console& console) {
  const NamedResult named = namedResult(session, resultOf(run), kVersion);
  const ExportRemarks remarks = writeResultFiles(arguments.output, session, run, kVersion, console.logText());
  console.stageStarted("done");
  print("{}", resultTable(named));
  if (const std::optional<Repair>& repair = run->result.repair) print("{}", tryText(arguments, *repair));
  // Without requested targets, notes on Kalibr's files are only in log.txt.
  if (!arguments.quiet && !session.exports.empty())
    for (const std::string& note : remarks.notes) print("{}\n", note);
  for (const std::string& refusal : remarks.refused) printError(refusal + "\n");
  if (!arguments.quiet) print("Files are in {}\n", arguments.output);
}

CalibrationOutcome calibrated(const SessionArguments& arguments, const Session& session,
                              const RunContext& context) {
  if (arguments.detections.empty()) return runCalibration(session, context);
  context.progress.stageStarted(nameOf(CalibrationStage::Detect));
  RestoredDetections restored = restoreDetections(arguments.detections, session, context);
  return runCalibration(session, std::move(restored.detections), context, std::move(restored.intrinsics));
}

// The profile is written even after a failure.
CalibrationOutcome calibrated(const SessionArguments& arguments, const Session& session, Console& console) {
  const std::stop_token stop = stopOnSignals();  // before other threads start
  if (arguments.profile.empty()) return calibrated(arguments, session, RunContext{console, stop});
  RunTrace trace(console);
  CalibrationOutcome outcome = calibrated(arguments, session, RunContext{trace, stop});
  writeFileWhole(arguments.profile, trace.json());
  return outcome;
}

int run(const SessionArguments& arguments) {
  const Session session = sessionFrom(arguments);
  Console console(arguments.quiet);
  console.announceReplacement(arguments.output, {"result.yaml"});
  const NewFolder folder(arguments.output);
  return finishCalibration(arguments, session, calibrated(arguments, session, console), console, folder);
}

}  // namespace

int finishCalibration(const SessionArguments& arguments, const Session& session, CalibrationOutcome outcome,
                      Console& console, const NewFolder& folder) {
  if (outcome.status != RunStatus::Done) reportEnd(arguments, session, outcome, console, folder);
  const auto run = std::make_shared<const CalibrationRun>(std::move(outcome).runOrThrow());
  printResult(arguments, session, run, console);
  return kDone;
}

void addCalibrateCommand(Command& app, int& exit_code) {
  auto arguments = std::make_shared<SessionArguments>();
  Command command = app.command("calibrate", "Calibrate cameras and IMUs of a session");
  addSessionArguments(command, *arguments);
  command.option(
      "--detections", arguments->detections,
      "Result folder of an earlier run of this session: its detections are used, and only IMU data "
      "are read again");
  command.option("--profile", arguments->profile,
                 "File for a profile of the run (stages, threads, processors, memory), readable by "
                 "ui.perfetto.dev and chrome://tracing");
  command.example("evical calibrate session.yaml -o result");
  command.action([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace evical
