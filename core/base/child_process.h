// A program that runs beside this one, as a process of its own: what it prints goes to a file, how it ended and how much
// memory it took is told.
#pragma once

#include "core/base/stopwatch.h"

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

struct ProcessEnd {
  int exit_code = -1;  // -1: by a signal
  int signal = 0;
  double wall_s = 0.0, peak_memory_mb = 0.0;
};

struct ProcessStart {
  std::vector<std::string> command;     // the program, searched for as shells do, and its arguments
  std::filesystem::path output;         // what it prints, both streams; an older file goes
  std::int64_t memory_limit_bytes = 0;  // of what it may write to; 0: none
  int kept_descriptor = -1;             // one that it inherits; -1: none but the standard ones
};

class ChildProcess {
 public:
  // Throws CalibrationError (CalibrationFailed) if it cannot be started.
  explicit ChildProcess(const ProcessStart& start);
  ~ChildProcess();  // kills what still runs
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;

  std::optional<ProcessEnd> ended();  // does not wait
  ProcessEnd wait();

  // Asks it to end, as Ctrl-C does; kills it if it was asked `patience_s` ago.
  void stop(double patience_s);
  double elapsed_s() const { return since_start_.elapsed_s(); }

 private:
  std::optional<ProcessEnd> collected(int wait_options);

  pid_t process_ = -1;
  Stopwatch since_start_;
  std::optional<Stopwatch> since_asked_;
  std::optional<ProcessEnd> end_;
};

}  // namespace evical
