// An open recording. Any thread may read the next packet.
#pragma once

#include "core/recording/recording_reader.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace evical::python {

// Absolute for folders: readers open some of their files later, when the current folder may be another.
std::filesystem::path pathForReading(const std::filesystem::path& path);

class OpenRecording {
 public:
  // `streams`: names, or "events", "imu", "frames", "points"; absent: all of these types that can be read.
  // Throws CalibrationError (BadInput).
  OpenRecording(std::filesystem::path path, const std::optional<std::vector<std::string>>& streams);
  ~OpenRecording();

  // A forked child has the parent's position in the file, and its connection to a separate reader: using them
  // would take the parent's data. There, read(), streams(), faults() and fractionRead() throw
  // CalibrationError (BadInput).
  bool isOfOtherProcess() const;

  // Null at the end; absent if another thread does not end its turn within `longest`. Throws Closed. Call
  // without the interpreter's lock: threads take turns here.
  struct Closed {};
  std::optional<std::shared_ptr<Packet>> read(std::chrono::milliseconds longest);
  bool close(std::chrono::milliseconds longest);  // false: as above

  // These do not wait for a thread that reads, but return the values at the end of an earlier turn. After
  // close(), they return the last ones.
  bool closed() const;
  std::vector<StreamInfo> streams() const;
  StreamInfo stream(std::size_t index) const { return streams().at(index); }
  std::vector<RecordingFault> faults() const;
  double fractionRead() const;

  std::string path() const { return path_.string(); }
  const std::string& format() const { return format_; }

 private:
  // Time that runs backwards between packets.
  struct Order {
    std::optional<std::int64_t> last_ns;
    std::uint64_t steps = 0;
    std::int64_t largest_ns = 0;
  };
  struct State {
    bool closed = false;
    std::vector<StreamInfo> streams;
    std::vector<RecordingFault> faults;
    double fraction_read = 0.0;
  };

  void requireOwnProcess() const;
  void note(const Packet& packet);
  State stateNow() const;  // call with a turn
  State state() const;

  std::filesystem::path path_;
  int process_;
  mutable std::timed_mutex turn_;
  std::unique_ptr<RecordingReader> reader_;  // null: closed
  std::map<std::size_t, Order> orders_;      // by stream
  std::string format_;
  mutable std::mutex last_mutex_;
  mutable State last_;  // at the end of a turn
};

}  // namespace evical::python
