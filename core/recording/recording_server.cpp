#include "core/recording/recording_server.h"

#include "core/recording/hdf5/hdf5_reader.h"
#include "core/recording/separate_reader.h"

#include <memory>
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
  if (argc == 3 && std::string_view(argv[1]) == kServe) serveRecording(argv[2]);
  setRecordingServer({"/proc/self/exe", kServe});
}

void setRecordingServer(std::vector<std::string> words) {
  command() = std::move(words);
}

const std::vector<std::string>& recordingServer() {
  return command();
}

void serveRecording(const std::filesystem::path& path) {
  serveReader(kServerSocket, [&] { return std::make_unique<Hdf5Reader>(path); });
}

}  // namespace evical
