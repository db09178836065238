// The commands, one file each. Every function adds its command to the program; when that is chosen,
// its outcome goes to `exit_code`, which must outlive the parsing. What a command throws, main()
// turns into an exit code.
#pragma once

namespace evical {

class Command;

inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;      // failed or cancelled
inline constexpr int kBadInput = 2;    // usage, session or recording; nothing was written
inline constexpr int kChanged = 3;     // of a check, a maintenance, a repeat: what was compared differs
inline constexpr int kCannotTell = 4;  // of these: the data do not say

void addBatchCommand(Command& app, int& exit_code);
void addBoardCommand(Command& app, int& exit_code);
void addCalibrateCommand(Command& app, int& exit_code);
void addCheckCommand(Command& app, int& exit_code);
void addCompareCommand(Command& app, int& exit_code);
void addConvertCommand(Command& app, int& exit_code);
void addDetectCommand(Command& app, int& exit_code);
void addExportCommand(Command& app, int& exit_code);
void addImportCommand(Command& app, int& exit_code);
void addInitCommand(Command& app, int& exit_code);
void addIntrinsicsCommand(Command& app, int& exit_code);
void addMaintainCommand(Command& app, int& exit_code);
void addManualCommand(Command& app, int& exit_code);
void addOptionsCommand(Command& app, int& exit_code);
void addRepeatCommand(Command& app, int& exit_code);
void addSimulateCommand(Command& app, int& exit_code);

}  // namespace evical
