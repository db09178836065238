#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/output.h"
#include "app/session_arguments.h"
#include "app/version.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/pipeline/detection/session_recording.h"
#include "core/pipeline/lens/intrinsics_calibration.h"
#include "core/pipeline/lens/intrinsics_files.h"
#include "core/report/intrinsics_report.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace evical {
namespace {

struct IntrinsicsArguments : SessionArguments {
  std::string camera;
};

// Indices of the requested cameras: one by name, or all.
std::vector<std::size_t> chosenCameras(const Session& session, const std::string& name) {
  std::vector<std::size_t> chosen;
  std::string known;
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    if (name.empty() || session.cameras[k].name == name) chosen.push_back(k);
    known += (known.empty() ? "" : ", ") + session.cameras[k].name;
  }
  if (chosen.empty())
    throw badInput("--camera " + name, "is not a camera of the session", "Choose one of: " + known);
  return chosen;
}

// Reports a missing stream at once, not after minutes of work on other cameras.
void checkStreams(Session session) {
  session.imus.clear();
  SessionRecording{session};
}

struct Found {
  std::vector<FileContent> files;
  std::string tables, names;
};

void addCamera(const std::filesystem::path& folder, const SessionCamera& camera, const IntrinsicsRun& run,
               const RunContext& context, Found& found) {
  for (const RecordingFault& fault : run.detections.faults)
    context.progress.log(LogLevel::Warning, fault.text);
  const NamedIntrinsics named = namedIntrinsics(camera, run, kVersion);
  for (FileContent& file : intrinsicsFiles(folder, named, run.detections.cameras))
    found.files.push_back(std::move(file));
  found.tables += intrinsicsTable(named);
  found.names += (found.names.empty() ? "" : ", ") + camera.name;
}

int run(const IntrinsicsArguments& arguments) {
  const Session session = sessionFrom(arguments);
  const std::vector<std::size_t> cameras = chosenCameras(session, arguments.camera);
  if (cameras.size() > 1) checkStreams(session);
  Console console(arguments.quiet);
  const auto folderOf = [&](std::size_t camera) {
    return std::filesystem::path(arguments.output) /
           (cameras.size() > 1 ? foldersOfCameras(session)[camera] : "");
  };
  for (const std::size_t camera : cameras) console.announceReplacement(folderOf(camera), {"intrinsics.yaml"});
  const NewFolder folder(arguments.output);
  const RunContext context{console, stopOnSignals()};
  Found found;
  std::optional<CalibrationError> failure;  // of the first camera that failed
  for (const std::size_t camera : cameras) {
    try {
      const IntrinsicsRun one = calibrateIntrinsics(session, camera, context);
      if (cameras.size() > 1) makeFolderWithin(arguments.output, foldersOfCameras(session)[camera]);
      addCamera(folderOf(camera), session.cameras[camera], one, context, found);
    } catch (const CalibrationError& error) {
      if (error.kind() == ErrorKind::BadInput) throw;
      if (cameras.size() > 1) console.log(LogLevel::Warning, error.what());
      if (!failure) failure = error;
    }
  }
  if (found.names.empty()) throw *failure;
  found.files.push_back({std::filesystem::path(arguments.output) / "log.txt", console.logText()});
  writeFilesWhole(found.files);
  console.stageStarted("done");
  print("{}", found.tables);
  if (!arguments.quiet) print("Files of {} are in {}\n", found.names, arguments.output);
  if (failure) throw *failure;
  return kDone;
}

}  // namespace

void addIntrinsicsCommand(Command& app, int& exit_code) {
  auto arguments = std::make_shared<IntrinsicsArguments>();
  Command command = app.command("intrinsics", "Calibrate the intrinsics of a session's cameras");
  addSessionArguments(command, *arguments);
  command.option("--camera", arguments->camera, "Name of the only camera to calibrate; by default all");
  command.example("evical intrinsics session.yaml -o lens");
  command.action([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace evical
