// Reader in a separate process, for libraries that can crash on a damaged file: only that process ends, and
// the recording is read up to this point.
#pragma once

#include "core/recording/recording_reader.h"

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

// The file descriptor of a server's socket.
inline constexpr int kServerSocket = 3;

// Ends waits of this thread for other processes when a stop is requested, while it exists: reads end as at
// the end of the file, and opening throws Cancelled. Otherwise a process that hangs would delay the stop. A
// token without a source changes nothing.
class StopWaiting {
 public:
  explicit StopWaiting(std::stop_token stop);
  ~StopWaiting();
  StopWaiting(const StopWaiting&) = delete;
  StopWaiting& operator=(const StopWaiting&) = delete;

  static bool isRequested();  // in this thread

 private:
  std::stop_token before_;
};

class SeparateReader : public RecordingReader {
 public:
  using Open = std::function<std::unique_ptr<RecordingReader>()>;
  // A process that does not answer for longer is considered hanging and is killed. Sleeping disks and
  // networks are faster.
  static inline int longest_silence_ms = 30'000;

  // Calls `open` in a copy of this process; its exceptions are thrown here. `path`: for messages.
  SeparateReader(const std::filesystem::path& path, const Open& open);
  // Starts `server`, a command that is given the path and, unless it is empty, `names`, and serves a reader
  // at kServerSocket (recording_server.h).
  SeparateReader(const std::filesystem::path& path, const std::vector<std::string>& server,
                 const std::string& names = {});
  ~SeparateReader() override;
  SeparateReader(const SeparateReader&) = delete;
  SeparateReader& operator=(const SeparateReader&) = delete;

  const std::vector<StreamInfo>& streams() const override { return streams_; }
  void select(const std::vector<std::size_t>& streams) override;
  bool read(Packet& packet) override;
  double fractionRead() const override { return fraction_read_; }
  const std::vector<RecordingFault>& faults() const override { return faults_; }
  std::string format() const override { return format_; }

 private:
  void begin(const std::function<pid_t(int own, int other)>& start);
  void takeFirstState();
  void end();
  bool ask();
  void takeState(std::string_view message);
  void takePacket(std::string_view message, Packet& packet);
  struct End {
    // Killed: by another process. Silent: no answer in time, and killed by this process.
    enum class Kind { Exit, Signal, Killed, Silent } kind;
    std::string reason;
  };
  End howItEnded(bool silent);
  void throwIfKilled(const End& end) const;

  std::filesystem::path path_;
  pid_t process_ = -1;
  int socket_ = -1;
  bool finished_ = false, asked_ = false;
  double fraction_read_ = 0.0;
  std::vector<StreamInfo> streams_;
  std::vector<RecordingFault> faults_;
  std::string format_, message_;
};

// In the other process: answers requests until the socket is closed, then exits.
[[noreturn]] void serveReader(int socket, const SeparateReader::Open& open);

// True in the process of serveReader.
bool isReaderProcess();

}  // namespace evical
