// The commands, one file each. Every function adds its command to the program; the outcome of the chosen
// command is written to `exit_code`, which must outlive the parsing. main() converts exceptions into exit
// codes.
#pragma once

namespace evical {

class Command;

inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;      // failed or cancelled
inline constexpr int kBadInput = 2;    // usage, session or recording; nothing was written
inline constexpr int kChanged = 3;     // check, maintain, repeat: a difference was found
inline constexpr int kCannotTell = 4;  // check, maintain, repeat: the data are insufficient

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
void addRecordCommand(Command& app, int& exit_code);
void addRepeatCommand(Command& app, int& exit_code);
void addSimulateCommand(Command& app, int& exit_code);
void addWatchCommand(Command& app, int& exit_code);

}  // namespace evical
