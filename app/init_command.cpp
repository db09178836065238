#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/output.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/base/plain_text.h"
#include "core/pipeline/session/session_guess.h"
#include "core/recording/recording_reader.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <vector>

namespace evical {
namespace {

struct InitArguments {
  std::vector<std::filesystem::path> recordings;
  std::filesystem::path output;
  bool quiet = false;
};

std::vector<InspectedRecording> inspectAll(const InitArguments& arguments, const RunContext& context) {
  std::vector<InspectedRecording> inspected;
  for (const std::filesystem::path& recording : arguments.recordings) {
    context.progress.stageStarted("inspect " + recording.filename().string());
    const std::unique_ptr<RecordingReader> reader = openRecording(recording);
    inspected.push_back({recording, inspectRecording(*reader, {}, context)});
    for (const RecordingFault& fault : inspected.back().inspection.faults)
      context.progress.log(LogLevel::Warning, fault.text);
  }
  return inspected;
}

int run(const InitArguments& arguments) {
  // Entries of the user must not be lost.
  if (pathExists(arguments.output))
    throw badInput(arguments.output.string(), "exists already", "Choose another name, or remove the file");
  Console console(arguments.quiet);
  const std::vector<InspectedRecording> recordings = inspectAll(arguments, {console, stopOnSignals()});
  const auto folder =
      arguments.output.has_parent_path() ? arguments.output.parent_path() : std::filesystem::path(".");
  const SessionDraft draft = draftSession(recordings, folder);
  writeFileWhole(arguments.output, draft.yaml);
  console.stageStarted("done");
  print("{}\n", arguments.output.string());
  if (arguments.quiet) return kDone;
  for (const std::string& note : draft.notes) print("{}\n", note);
  const bool one_camera = draft.session.imus.empty() && draft.session.cameras.size() == 1;
  print("Then run: evical {} {} -o result\n", one_camera ? "intrinsics" : "calibrate",
        shellWord(arguments.output.string()));
  return kDone;
}

}  // namespace

void addInitCommand(Command& app, int& exit_code) {
  const auto arguments = std::make_shared<InitArguments>();
  Command command = app.command("init", "Write a session to fill in, from the streams of recordings");
  command
      .option("RECORDING", arguments->recordings,
              "Recordings in any format that `evical inspect` reads; several if sensors have separate files")
      .required();
  command.option("-o,--output", arguments->output, "Session file; it must not exist yet").required();
  command.flag("--quiet", arguments->quiet, "Print only the file's name and errors");
  command.example("evical init recording.bag -o session.yaml");
  command.action([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace evical
