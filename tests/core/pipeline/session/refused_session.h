// What is said of a session file with a mistake in it.
#pragma once

#include "core/base/error.h"

#include <QStringList>
#include <QtTest>

namespace evical::test {

// A mistake of the user's, in session.yaml, with all these words.
inline void verifyRefusal(const CalibrationError& error, const QStringList& said) {
  QVERIFY(error.kind() == ErrorKind::BadInput);
  QVERIFY2(QString(error.what()).contains("session.yaml"), error.what());
  for (const QString& part : said) QVERIFY2(QString(error.what()).contains(part), error.what());
}

}  // namespace evical::test
