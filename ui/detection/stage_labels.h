// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers in sentences, for threads without a translator.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>

namespace evical::ui {

// At most 399 characters. The attribute lets the compiler compare format and values.
[[gnu::format(printf, 1, 2)]] inline std::string print(const char* format, ...) {
  char text[400];
  std::va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  return text;
}

}  // namespace evical::ui
