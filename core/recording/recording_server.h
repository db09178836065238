// Separate process that reads HDF5 files: this program again, or the interpreter of the Python module. A
// program that sets no server forks instead, which is safe only before it starts threads.
#pragma once

#include "core/recording/recording_reader.h"

#include <filesystem>
#include <string>
#include <vector>

namespace evical {

// Call this first in main(). If the arguments ask for a server, it serves a recording and does not return.
// Otherwise it registers this program as the server.
void beRecordingServer(int argc, char** argv);

// The command without the path of the recording; empty if there is none.
void setRecordingServer(std::vector<std::string> command);
const std::vector<std::string>& recordingServer();

// `names` as from encodeNames().
[[noreturn]] void serveRecording(const std::filesystem::path& path, const std::string& names = {});

// Column names as one argument of a command.
std::string encodeNames(const ColumnNames& names);

}  // namespace evical
