#include "core/recording/recording_server.h"

#include "core/recording/hdf5/hdf5_reader.h"
#include "core/recording/separate_reader.h"

#include <memory>
#include <sstream>
#include <string_view>
#include <utility>

namespace evical {
namespace {

constexpr const char* kServe = "--serve-recording";

std::vector<std::string>& command() {
  static std::vector<std::string> words;
  return words;
}

}  // namespace

void beRecordingServer(int argc, char** argv) {
  if (argc >= 3 && argc <= 4 && std::string_view(argv[1]) == kServe)
    serveRecording(argv[2], argc == 4 ? argv[3] : "");
  setRecordingServer({"/proc/self/exe", kServe});
}

void setRecordingServer(std::vector<std::string> words) {
  command() = std::move(words);
}

const std::vector<std::string>& recordingServer() {
  return command();
}

// Two lines for each stream.
std::string encodeNames(const ColumnNames& names) {
  std::string text;
  for (const auto& [stream, columns] : names) text += stream + '\n' + columns + '\n';
  return text;
}

void serveRecording(const std::filesystem::path& path, const std::string& names) {
  ColumnNames decoded;
  std::istringstream lines(names);
  for (std::string stream, columns; std::getline(lines, stream) && std::getline(lines, columns);)
    decoded[stream] = columns;
  serveReader(kServerSocket, [&] { return std::make_unique<Hdf5Reader>(path, decoded); });
}

}  // namespace evical
