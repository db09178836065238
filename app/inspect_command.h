// `evical inspect RECORDING [--json] [--checksum]`: what a recording holds, and what is wrong with it.
#pragma once

namespace evical {

class Command;

// As the functions of commands.h: throws what main() turns into an exit code, else sets `exit_code` to 0.
void addInspectCommand(Command& app, int& exit_code);

}  // namespace evical
