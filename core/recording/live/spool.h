// The temporary file of a live stream: a thread fills it, readers follow it.
#pragma once

#include "core/data/recording.h"
#include "core/recording/live/growth.h"

#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace evical {

class Spool {
 public:
  // Runs in a thread until the stream's end or a stop. Its exception is thrown by check().
  using Fill = std::function<void(Spool& spool, const std::stop_token& stop)>;

  // Throws CalibrationError if the folder cannot be written.
  Spool(const std::filesystem::path& folder, Fill fill);
  ~Spool();
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;

  // For the filling thread. Throws CalibrationError, e.g. on a full disk.
  void append(std::string_view bytes);
  void note(FaultKind kind, std::string text);

  // Valid while this object exists.
  const std::filesystem::path& path() const { return path_; }
  const std::shared_ptr<Growth>& growth() const { return growth_; }

  void stop() { thread_.request_stop(); }
  // Throws what ended the stream, once.
  void check();
  std::vector<RecordingFault> notes() const;

 private:
  std::filesystem::path folder_, path_;
  int file_ = -1;
  std::shared_ptr<Growth> growth_;
  mutable std::mutex mutex_;
  std::exception_ptr error_;
  std::vector<RecordingFault> notes_;
  std::jthread thread_;
};

}  // namespace evical
