// Connections that break are opened again, and the gap is reported.
#pragma once

#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/recording/live/live_source.h"
#include "core/recording/live/spool.h"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <stop_token>
#include <thread>

namespace evical {

enum class Ended { Closed, Broken, NothingCame };

// connect() returns a Connection, or throws CalibrationError; use(connection) works with it until it ends. A
// server that closes may have restarted.
template <class Connection, class Connect, class Use>
void keepConnected(Spool& spool, const std::stop_token& stop, const Connect& connect, const Use& use) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kAgain{100};
  const Clock::time_point begin = Clock::now();
  std::optional<Connection> connection(connect());
  for (;;) {
    const Ended ended = use(*connection);
    connection.reset();
    if (stop.stop_requested() || ended == Ended::NothingCame) return;
    const Clock::time_point broke = Clock::now();
    while (!connection && !stop.stop_requested() && Clock::now() - broke < LivePatience::again) {
      std::this_thread::sleep_for(kAgain);
      try {
        connection.emplace(connect());
      } catch (const CalibrationError&) {  // not yet
      } catch (const Cancelled&) {
      }
    }
    if (!connection && ended == Ended::Broken && !stop.stop_requested())
      spool.note(FaultKind::Truncated, "The connection broke, and the server did not answer again.");
    if (!connection) return;
    const auto seconds = [](Clock::duration time) { return std::chrono::duration<double>(time).count(); };
    spool.note(
        FaultKind::LostMessages,
        fmt::format("The connection broke {:.1f} s after its beginning, and was opened again {:.1f} s later.",
                    seconds(broke - begin), seconds(Clock::now() - broke)));
  }
}

}  // namespace evical
