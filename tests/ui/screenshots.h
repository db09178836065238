// Folder in which tests of the window save pictures for inspection.
#pragma once

#include "tests/support/test_folders.h"

#include <QDir>
#include <QString>

namespace evical::ui::test {

// The path of a picture in the build folder's screenshots, which is created.
inline QString screenshotPath(const QString& name) {
  const QString folder = QString::fromStdString(evical::test::buildPath("screenshots"));
  QDir().mkpath(folder);
  return folder + '/' + name;
}

}  // namespace evical::ui::test
