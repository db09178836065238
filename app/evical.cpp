// The command line program: parses, runs one command, and returns its outcome as the exit code.
#include <fmt/format.h>
#include "app/command_line.h"
#include "app/commands.h"
#include "app/inspect_command.h"
#include "app/output.h"
#include "app/version.h"
#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/recording/recording_server.h"

#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <string_view>

namespace evical {
namespace {

int fail(int exit_code, std::string_view reason) {
  std::fflush(stdout);
  printError(fmt::format("{}\n", reason));
  return exit_code;
}

void addCommands(Command& app, int& exit_code) {
  addInitCommand(app, exit_code);
  addCalibrateCommand(app, exit_code);
  addCheckCommand(app, exit_code);
  addMaintainCommand(app, exit_code);
  addRecordCommand(app, exit_code);
  addRepeatCommand(app, exit_code);
  addBatchCommand(app, exit_code);
  addIntrinsicsCommand(app, exit_code);
  addDetectCommand(app, exit_code);
  addInspectCommand(app, exit_code);
  addConvertCommand(app, exit_code);
  addSimulateCommand(app, exit_code);
  addWatchCommand(app, exit_code);
  addCompareCommand(app, exit_code);
  addBoardCommand(app, exit_code);
  addExportCommand(app, exit_code);
  addImportCommand(app, exit_code);
  addOptionsCommand(app, exit_code);
  addManualCommand(app, exit_code);
}

int run(int argc, char** argv) {
  CommandLine app(
      "Calibrates event cameras, frame cameras and IMUs from one recording of a board: a circle grid, an "
      "AprilGrid, a "
      "checkerboard or a ChArUco board. Start with `evical init RECORDING -o session.yaml`, complete the "
      "session, then "
      "run `evical calibrate session.yaml -o result`.",
      "evical");
  app.version(std::string("evical ") + kVersion);
  app.requireCommand();
  int exit_code = kDone;
  addCommands(app, exit_code);
  // After the commands, which would inherit it.
  app.footer(
      "Exit codes: 0 done; 1 failed or cancelled, the last line gives the reason; 2 bad usage, session or "
      "recording, nothing was written. The help of a command lists its other codes: evical COMMAND --help");
  try {
    return app.parse(argc, argv) ? exit_code : kDone;
  } catch (const UsageError& error) {
    const std::string_view reason = error.what();
    return fail(kBadInput, fmt::format("{}{} See `evical --help` and `evical COMMAND --help`", reason,
                                       reason.ends_with('?') ? "" : "."));
  }
}

int runOrFail(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const CalibrationError& error) {
    return fail(error.kind() == ErrorKind::BadInput ? kBadInput : kFailed, error.what());
  } catch (const Cancelled&) {
    return fail(kFailed, "cancelled");
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(kBadInput,
                fmt::format("{}: cannot be used: {}", error.path1().string(), error.code().message()));
  } catch (const std::bad_alloc&) {
    return fail(kFailed, "not enough memory");
  } catch (const std::exception& error) {
    return fail(kFailed, fmt::format("internal error: {}", error.what()));
  }
}

}  // namespace
}  // namespace evical

int main(int argc, char** argv) {
  using namespace evical;
  beRecordingServer(argc, argv);
  keepFreedMemory();
  holdStandardStreams();
  // Exceeding a file size limit is an error of write(), like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  // A parent that ignores SIGCHLD would pass this on, and the exit codes of jobs would be lost.
  std::signal(SIGCHLD, SIG_DFL);
  const int exit_code = runOrFail(argc, argv);
  const std::string lost = lostOutput();
  return lost.empty() || exit_code != kDone ? exit_code : fail(kFailed, lost);
}
