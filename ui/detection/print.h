// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers in sentences, for threads without a translator.
#pragma once

#include <cstdio>
#include <string>

namespace evical::ui {

template <class... Values>
std::string print(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace evical::ui
