#include "core/recording/live/growth.h"

#include "core/recording/separate_reader.h"

#include <chrono>
#include <system_error>
#include <thread>

namespace evical {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook{2};

}  // namespace

std::uint64_t Growth::bytes() const {
  std::error_code gone;
  const std::uintmax_t size = std::filesystem::file_size(path_, gone);
  return gone ? 0 : size;
}

std::uint64_t Growth::waitFor(std::uint64_t bytes) {
  ++waiting_;
  std::uint64_t size = 0;
  Clock::time_point grown = Clock::now();
  for (;;) {
    const bool ended = ended_;  // before the size: nothing is added afterwards
    const std::uint64_t now = this->bytes();
    if (now != size) grown = Clock::now();
    size = now;
    if (ended || size >= bytes || StopWaiting::isRequested()) break;
    const std::chrono::duration<double> silent = Clock::now() - grown;
    if (ends_by_ == EndsBy::Silence && silent.count() >= kSilence_s) end();
    std::this_thread::sleep_for(kLook);
  }
  --waiting_;
  return size;
}

}  // namespace evical
