// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace evical::ui {

// Limits and waiting times of tests are multiplied by this: sanitizers and debug builds take longer.
#ifdef EVICAL_SLOW_BUILD
inline constexpr int kSlowdown = 20;
#else
inline constexpr int kSlowdown = 1;
#endif

}  // namespace evical::ui
