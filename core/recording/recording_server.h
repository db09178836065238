// The program that reads HDF5 files for this one, in a process of its own: this program again, or, of Python, the interpreter. What
// has no server reads them in a copy of itself (fork), which is sound only before other threads have begun.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace evical {

// First in main(): where the arguments ask for it, this process serves a recording and never returns; else it is known from now
// on that it can.
void beRecordingServer(int argc, char** argv);

// The command, without the path that is added; empty: none.
void setRecordingServer(std::vector<std::string> command);
const std::vector<std::string>& recordingServer();

[[noreturn]] void serveRecording(const std::filesystem::path& path);

}  // namespace evical
