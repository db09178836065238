// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of a screen, light and dark, in all required sizes.
#pragma once

#include "tests/ui/screenshots.h"

#include <QApplication>
#include <QPalette>
#include <QStyleFactory>
#include <QWidget>

#include <functional>

namespace evical::test {

inline void setPalette(bool dark) {
  QApplication::setStyle(QStyleFactory::create("Fusion"));
  const QColor window = dark ? QColor(0x1f, 0x22, 0x27) : QColor(0xf5, 0xf6, 0xf8);
  QPalette palette(dark ? QColor(0x2b, 0x2f, 0x36) : QColor(0xe9, 0xeb, 0xee), window);
  palette.setColor(QPalette::Base, dark ? QColor(0x17, 0x19, 0x1d) : QColor(0xff, 0xff, 0xff));
  palette.setColor(QPalette::Highlight, dark ? QColor(0x5a, 0xa9, 0xf5) : QColor(0x1f, 0x6f, 0xc4));
  QApplication::setPalette(palette);
}

// `settle` is called after each change, and returns when the screen has been drawn.
inline void takePictures(QWidget& screen, const QString& name, const std::function<void()>& settle) {
  for (const bool dark : {false, true}) {
    setPalette(dark);
    for (const QSize size : {QSize(1000, 650), QSize(1640, 930)}) {
      screen.resize(size);
      settle();
      screen.grab().save(evical::ui::test::screenshotPath("%1_%2_%3.png")
                             .arg(name, dark ? "dark" : "light")
                             .arg(size.width()));
    }
  }
  setPalette(false);
}

}  // namespace evical::test
