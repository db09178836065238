#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/output.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/pipeline/session/import_session.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>

namespace evical {
namespace {

struct ImportArguments {
  ImportRequest request;
  std::filesystem::path output;
};

int run(const ImportArguments& arguments) {
  const std::stop_token stop = stopOnSignals();  // files are written completely or not at all
  const ImportedFiles imported = importFiles(arguments.request, arguments.output);
  if (stop.stop_requested()) throw Cancelled{};
  // Entries of the user in a session must not be lost.
  for (const FileContent& session : imported.files)
    if (session.content.starts_with("evical_session") && pathExists(session.path))
      throw badInput(session.path.string(), "exists already", "Choose another name, or remove the file");
  writeFilesWhole(imported.files);
  for (const FileContent& written : imported.files) print("{}\n", written.path.string());
  for (const std::string& note : imported.notes) print("{}\n", note);
  return kDone;
}

}  // namespace

void addImportCommand(Command& app, int& exit_code) {
  const auto arguments = std::make_shared<ImportArguments>();
  Command command =
      app.command("import", "Import a session or camera intrinsics from files of other programs");
  command
      .option("FILES", arguments->request.files,
              "eKalibr configuration; Kalibr's target, imu and camchain files in any order; or files with "
              "camera intrinsics only")
      .required();
  command.option("-o,--output", arguments->output, "File of the session, or of the intrinsics").required();
  command.option("--from", arguments->request.from, "Program of the files: kalibr, ekalibr or ros");
  command.option("--recording", arguments->request.recording, "Recording, if the files do not name it");
  command.option("--radius-m", arguments->request.radius_m,
                 "Radius of the board's circles in metres, if the files do not contain it");
  command.example("evical import target.yaml imu.yaml --recording recording.bag -o session.yaml");
  command.action([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace evical
