#include "core/base/modest_thread.h"

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
