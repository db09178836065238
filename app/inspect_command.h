// `evical inspect RECORDING [--json] [--checksum]`: lists the streams and faults of a recording.
#pragma once

namespace evical {

class Command;

// Like the functions of commands.h: main() converts exceptions into exit codes; otherwise `exit_code` is 0.
void addInspectCommand(Command& app, int& exit_code);

}  // namespace evical
