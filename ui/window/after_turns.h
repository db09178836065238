// SPDX-License-Identifier: GPL-3.0-or-later
// Splits long work over several turns of the event loop, so that no single turn is noticeably long.
#pragma once

#include <QObject>
#include <QTimer>

#include <chrono>
#include <functional>

namespace evical::ui {

// Calls `act` after the given number of turns of the event loop; each turn handles the pending events,
// layouts and paintings.
inline void afterTurns(int turns, QObject* context, const std::function<void()>& act) {
  if (turns <= 0) return act();
  constexpr auto kNext = std::chrono::milliseconds(1);
  QTimer::singleShot(kNext, context, [turns, context, act] { afterTurns(turns - 1, context, act); });
}

}  // namespace evical::ui
