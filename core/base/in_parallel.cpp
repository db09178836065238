#include "core/base/in_parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace evical {

void inParallel(int threads, std::size_t parts, const std::function<void(std::size_t part)>& work) {
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::mutex failing;
  const auto run = [&] {
    try {
      for (std::size_t part = next++; part < parts; part = next++) work(part);
    } catch (...) {
      next = parts;
      const std::lock_guard lock(failing);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    const auto count = std::min(parts, static_cast<std::size_t>(std::max(1, threads)));
    for (std::size_t i = 1; i < count; ++i) others.emplace_back(run);
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace evical

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace evical {

namespace {

void beNice([[maybe_unused]] int niceness) {
#ifdef __linux__
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness);
#endif
}

}  // namespace

void makeThreadModest() {
  constexpr int kBesideAWindow = 5;
  beNice(kBesideAWindow);
}

void makeThreadLast() {
  constexpr int kBehindAll = 10;
  beNice(kBehindAll);
}

}  // namespace evical
