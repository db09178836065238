#include "app/commands.h"
#include "app/console.h"
#include "app/session_arguments.h"
#include "app/version.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/pipeline/intrinsics_calibration.h"
#include "core/report/csv.h"
#include "core/report/intrinsics_report.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <vector>

namespace evical {
namespace {

struct IntrinsicsArguments : SessionArguments {
  std::string camera;
};

// The cameras that were asked for: one by name, or all.
std::vector<std::size_t> chosenCameras(const Session& session, const std::string& name) {
  std::vector<std::size_t> chosen;
  std::string known;
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    if (name.empty() || session.cameras[k].name == name) chosen.push_back(k);
    known += (known.empty() ? "" : ", ") + session.cameras[k].name;
  }
  if (chosen.empty())
    throw badInput("--camera " + name, "is no camera of the session", "There are: " + known);
  return chosen;
}

std::vector<FileContent> filesOf(const std::filesystem::path& folder, const NamedIntrinsics& named) {
  const CameraIntrinsics& camera = named.result.intrinsics;
  return {{folder / "intrinsics.yaml", intrinsicsResultYaml(named)},
          {folder / "camera_info.yaml", cameraInfoYaml(named.camera, camera)},
          {folder / "camchain.yaml", camchainYaml(named.stream, camera)},
          {folder / "projection_std.csv", imageMapCsv(named.result.image)}};
}

int run(const IntrinsicsArguments& arguments) {
  const Session session = sessionFrom(arguments);
  const std::vector<std::size_t> cameras = chosenCameras(session, arguments.camera);
  Console console(arguments.quiet);
  const bool folder_was_there = std::filesystem::exists(arguments.output);
  makeOutputFolder(arguments.output);
  const RunContext context{console, stopOnSignals()};
  try {
    std::vector<FileContent> files;
    std::string tables;
    for (const std::size_t camera : cameras) {
      const SessionCamera& own = session.cameras[camera];
      const IntrinsicsRun found = calibrateIntrinsics(session, camera, context);
      for (const RecordingFault& fault : found.pass.faults) console.log(LogLevel::Warning, fault.text);
      const NamedIntrinsics named{own.name, own.stream, kVersion, found.result};
      std::filesystem::path folder = arguments.output;
      if (cameras.size() > 1) makeOutputFolder(folder /= own.name);
      for (FileContent& file : filesOf(folder, named)) files.push_back(std::move(file));
      files.push_back({folder / "detections.csv", detectionsCsv(found.pass.cameras)});
      tables += intrinsicsTable(named);
    }
    files.push_back({std::filesystem::path(arguments.output) / "log.txt", console.logText()});
    writeFilesWhole(files);
    console.stageStarted("done");
    fmt::print("{}", tables);
    if (!arguments.quiet) fmt::print("Files are in {}\n", arguments.output);
    return kDone;
  } catch (...) {
    std::error_code ignored;
    if (!folder_was_there) std::filesystem::remove(arguments.output, ignored);  // only if empty
    throw;
  }
}

}  // namespace

void addIntrinsicsCommand(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<IntrinsicsArguments>();
  CLI::App* const command =
      app.add_subcommand("intrinsics", "Calibrate the intrinsics of a session's cameras");
  addSessionArguments(*command, *arguments);
  command->add_option("--camera", arguments->camera, "Only this one of the session's cameras");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace evical
