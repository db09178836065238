// Child process that runs in parallel: its output goes to a file; its exit status and peak memory are
// reported.
#pragma once

#include "core/base/time.h"

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

struct ProcessEnd {
  int exit_code = -1;  // -1: ended by a signal
  int signal = 0;
  double wall_s = 0.0, peak_memory_mb = 0.0;
};

struct ProcessStart {
  std::vector<std::string> command;     // the program, searched in PATH, and its arguments
  std::filesystem::path output;         // standard output and error; replaces an older file
  std::int64_t memory_limit_bytes = 0;  // limit of writable memory; 0: none
  int kept_descriptor = -1;             // an inherited descriptor; -1: only the standard ones
};

class ChildProcess {
 public:
  // Throws CalibrationError (CalibrationFailed) if it cannot be started.
  explicit ChildProcess(const ProcessStart& start);
  ~ChildProcess();  // kills a running process
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;

  std::optional<ProcessEnd> ended();  // does not wait
  ProcessEnd wait();

  // Requests termination, as Ctrl-C does; kills the process if that was requested `patience_s` ago.
  void stop(double patience_s);
  double elapsed_s() const { return since_start_.elapsed_s(); }

 private:
  std::optional<ProcessEnd> collected(int wait_options);

  pid_t process_ = -1;
  Stopwatch since_start_;
  std::optional<Stopwatch> since_asked_;
  std::optional<ProcessEnd> end_;
};

// The memory of this process.

// Peak memory use in MB (10^6 bytes); 0 if the system does not report it.
double peakMemory_mb();

// For programs, at their start: freed memory is used again instead of being returned to the system, which
// takes a tenth of a calibration's time to clear and map it again.
void keepFreedMemory();

// Returns free heap memory to the system. The allocator keeps most of it if used blocks are in between.
void giveBackFreeMemory();

}  // namespace evical
