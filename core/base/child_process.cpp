#include "core/base/child_process.h"

#include "core/base/error.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <utility>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX requires programs to declare it

namespace evical {
namespace {

// Files and signals as a shell sets them: no blocked signals; a separate process group, so that Ctrl-C
// reaches only us.
class SpawnSettings {
 public:
  explicit SpawnSettings(const ProcessStart& start) {
    posix_spawn_file_actions_init(&files_);
    posix_spawnattr_init(&attributes_);
    posix_spawn_file_actions_addopen(&files_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    constexpr mode_t kReadableByAll = 0644;
    posix_spawn_file_actions_addopen(&files_, STDOUT_FILENO, start.output.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC | O_APPEND, kReadableByAll);
    posix_spawn_file_actions_adddup2(&files_, STDOUT_FILENO, STDERR_FILENO);
    if (start.kept_descriptor >= 0)  // duplicated onto itself, so that it stays open
      posix_spawn_file_actions_adddup2(&files_, start.kept_descriptor, start.kept_descriptor);
    sigset_t none, children;
    sigemptyset(&none);
    sigemptyset(&children);
    sigaddset(&children, SIGCHLD);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &children);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_,
                             POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&files_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  const posix_spawn_file_actions_t* files() const { return &files_; }
  const posix_spawnattr_t* attributes() const { return &attributes_; }

 private:
  posix_spawn_file_actions_t files_{};
  posix_spawnattr_t attributes_{};
};

}  // namespace

ChildProcess::ChildProcess(const ProcessStart& start) {
  const SpawnSettings settings(start);
  std::vector<std::string> words = start.command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int error = posix_spawnp(&process_, arguments.front(), settings.files(), settings.attributes(),
                                 arguments.data(), environ);
  if (error != 0) {
    process_ = -1;
    throw calibrationFailed(start.command.front(), std::string("cannot be started: ") + std::strerror(error),
                            error == ENOENT ? "Install it, or add its folder to PATH" : "");
  }
  if (start.memory_limit_bytes <= 0) return;
  const auto limit = static_cast<rlim_t>(start.memory_limit_bytes);
  const rlimit memory{limit, limit};
  prlimit(process_, RLIMIT_DATA, &memory, nullptr);
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      since_start_(other.since_start_),
      since_asked_(other.since_asked_),
      end_(other.end_) {}

ChildProcess::~ChildProcess() {
  if (process_ <= 0 || end_) return;
  ::kill(-process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

std::optional<ProcessEnd> ChildProcess::collected(int wait_options) {
  if (end_) return end_;
  int status = 0;
  rusage usage{};
  const pid_t found = ::wait4(process_, &status, wait_options, &usage);
  if (found == 0 || (found < 0 && errno == EINTR)) return std::nullopt;
  if (found < 0) {  // the exit status is unavailable, for example if SIGCHLD is ignored
    end_ = ProcessEnd{-1, 0, since_start_.elapsed_s(), 0.0};
    return end_;
  }
  constexpr double kKilobytesPerMegabyte = 1e3;
  end_ = ProcessEnd{WIFEXITED(status) ? WEXITSTATUS(status) : -1, WIFSIGNALED(status) ? WTERMSIG(status) : 0,
                    since_start_.elapsed_s(), static_cast<double>(usage.ru_maxrss) / kKilobytesPerMegabyte};
  return end_;
}

std::optional<ProcessEnd> ChildProcess::ended() {
  return collected(WNOHANG);
}

ProcessEnd ChildProcess::wait() {
  while (true)
    if (const std::optional<ProcessEnd> end = collected(0)) return *end;
}

void ChildProcess::stop(double patience_s) {
  if (end_) return;
  if (!since_asked_) {
    since_asked_.emplace();
    ::kill(process_, SIGTERM);
  } else if (since_asked_->elapsed_s() > patience_s) {
    ::kill(-process_, SIGKILL);
  }
}

}  // namespace evical

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace evical {

double peakMemory_mb() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0.0;
  constexpr double kBytesPerUnit = 1024.0, kBytesPerMb = 1e6;  // Linux counts in KiB
  return static_cast<double>(usage.ru_maxrss) * kBytesPerUnit / kBytesPerMb;
}

void keepFreedMemory() {
#ifdef __GLIBC__
  constexpr int kLargestBlock_bytes = 1 << 30, kKept_bytes = 1 << 29;
  mallopt(M_ARENA_MAX, 2);  // otherwise memory freed by a thread is not reused by others
  mallopt(M_MMAP_THRESHOLD, kLargestBlock_bytes);
  mallopt(M_TRIM_THRESHOLD, kKept_bytes);
#endif
}

void giveBackFreeMemory() {
#ifdef __GLIBC__
  constexpr std::size_t kWorthIt_bytes = 1 << 26;
  if (mallinfo2().fordblks > kWorthIt_bytes)
    malloc_trim(0);  // interrupts the other processors for each block
#endif
}

}  // namespace evical
