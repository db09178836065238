// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of a page of the window for inspection. No text may be clipped in them.
#pragma once

#include "tests/ui/clipped_text.h"
#include "tests/ui/screenshots.h"
#include "tests/ui/window_fixture.h"

#include <QTest>

namespace evical::ui::test {

// At all usual sizes: NAME_1024.png and so on.
inline void keepPictures(WindowFixture& test, const QString& name) {
  for (const QSize size : {QSize(1024, 700), QSize(1280, 800), QSize(1920, 1080)}) {
    test.window.resize(size);
    spin(200);
    const QStringList clipped = clippedTexts(test.window);
    QVERIFY2(clipped.isEmpty(), qPrintable(clipped.join('\n')));
    QVERIFY(test.window.grab().save(screenshotPath("%1_%2.png").arg(name).arg(size.width())));
  }
}

}  // namespace evical::ui::test
