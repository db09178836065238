// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace evical::ui {

// Under sanitizers everything takes longer: limits and waiting times of tests are multiplied by this.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr int kSlowdown = 20;
#else
inline constexpr int kSlowdown = 1;
#endif

}  // namespace evical::ui
