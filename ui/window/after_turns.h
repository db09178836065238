// SPDX-License-Identifier: GPL-3.0-or-later
// Long work in pieces: what is done in turns of their own of the event loop does not add up
// to one that people notice.
#pragma once

#include <QObject>
#include <QTimer>

#include <chrono>
#include <functional>

namespace evical::ui {

// Acts when the event loop has gone round so often; each time it takes
// what waits: events, layouts, paintings.
inline void afterTurns(int turns, QObject* context, const std::function<void()>& act) {
  if (turns <= 0) return act();
  constexpr auto kNext = std::chrono::milliseconds(1);
  QTimer::singleShot(kNext, context, [turns, context, act] { afterTurns(turns - 1, context, act); });
}

}  // namespace evical::ui
