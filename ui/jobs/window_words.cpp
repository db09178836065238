// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/window_words.h"

#include <array>

namespace evical::ui {
namespace {

struct Words {
  const char *of_core, *of_window;
};

// In this order: longer ones before what they contain.
constexpr std::array kWords = {
    Words{"; 'evical detect --images' draws what is seen", "; the Detection page shows what is seen"},
    Words{"say blinking: true in the session's board and use 'evical intrinsics'",
          "tick that it flashes in the Board form and calibrate the camera alone"},
    Words{
        "or, for 'evical intrinsics', show this board on a screen that flashes ('evical board --blink') and "
        "say blinking: true in the session's board",
        "or calibrate the camera alone: show this board on a screen that flashes, and tick that it does in "
        "the "
        "Board form"},
    Words{"say blinking: true in the board if it does", "tick that it flashes in the Board form if it does"},
    Words{"for its intrinsics alone there is 'evical intrinsics'", "or calibrate the camera alone"},
    Words{"Give resolution_px: [width, height] for this camera in the session",
          "Give its resolution in the camera's form on the Recording page"},
    Words{"Check the recording with 'evical inspect'", "Look at its streams on the Recording page"},
    Words{"rows, cols and", "rows, columns and"},
    Words{"Check type, rows and cols of the session's board",
          "Check the type, rows and columns of the board"},
    Words{"rows and cols", "rows and columns"},
    Words{"Name both streams in the session, in place of stream: gyroscope:",
          "Choose the role IMU for both streams on the Recording page, gyroscope:"},
    Words{" in time_range_s", " in the time range"},
    Words{" in the session", " on the Recording page"},
};

}  // namespace

QString inWindowWords(QString text) {
  for (const Words& words : kWords) text.replace(words.of_core, words.of_window);
  return text;
}

QStringList piecesOfCoresMessages() {
  QStringList pieces;
  for (const Words& words : kWords) pieces << words.of_core;
  return pieces;
}

}  // namespace evical::ui
