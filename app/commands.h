// The commands, one file each. Every function adds its command to the program; when that is chosen,
// its outcome goes to `exit_code`, which must outlive the parsing. What a command throws, main()
// turns into an exit code.
#pragma once

namespace CLI {
class App;
}

namespace evical {

inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;    // failed or cancelled
inline constexpr int kBadInput = 2;  // usage, session or recording; nothing was written
inline constexpr int kChanged =
    3;  // of a check: the old result does not hold; of a repeat: recordings differ
inline constexpr int kCannotTell = 4;  // of a check: this recording does not say

void addBatchCommand(CLI::App& app, int& exit_code);
void addBoardCommand(CLI::App& app, int& exit_code);
void addCalibrateCommand(CLI::App& app, int& exit_code);
void addCheckCommand(CLI::App& app, int& exit_code);
void addCompareCommand(CLI::App& app, int& exit_code);
void addConvertCommand(CLI::App& app, int& exit_code);
void addDetectCommand(CLI::App& app, int& exit_code);
void addExportCommand(CLI::App& app, int& exit_code);
void addImportCommand(CLI::App& app, int& exit_code);
void addInitCommand(CLI::App& app, int& exit_code);
void addIntrinsicsCommand(CLI::App& app, int& exit_code);
void addMaintainCommand(CLI::App& app, int& exit_code);
void addManualCommand(CLI::App& app, int& exit_code);
void addOptionsCommand(CLI::App& app, int& exit_code);
void addRepeatCommand(CLI::App& app, int& exit_code);
void addSimulateCommand(CLI::App& app, int& exit_code);

}  // namespace evical
