// An open recording. Any thread may read the next packet.
#pragma once

#include "core/recording/recording_reader.h"

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace evical::python {

class OpenRecording {
 public:
  // `streams`: names, or "events", "imu", "frames", "points"; empty: all of these types that can be read. Throws
  // CalibrationError (BadInput).
  OpenRecording(std::filesystem::path path, const std::vector<std::string>& streams);

  // Null at the end. Throws Closed. Call without the interpreter's lock: threads take turns here.
  struct Closed {};
  std::shared_ptr<Packet> read();
  void close();

  // After close(), these return the last values.
  bool closed() const;
  std::string path() const { return path_.string(); }
  const std::string& format() const { return format_; }
  std::vector<StreamInfo> streams() const;
  StreamInfo stream(std::size_t index) const { return streams().at(index); }
  std::vector<RecordingFault> faults() const;
  double fractionRead() const;

 private:
  std::filesystem::path path_;
  mutable std::mutex mutex_;
  std::unique_ptr<RecordingReader> reader_;  // null: closed
  std::string format_;
  std::vector<StreamInfo> streams_;
  std::vector<RecordingFault> faults_;
  double fraction_read_ = 0.0;
};

}  // namespace evical::python
