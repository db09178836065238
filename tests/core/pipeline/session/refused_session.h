// Error messages for a session file with a mistake in it.
#pragma once

#include "core/base/error.h"

#include <QStringList>
#include <QtTest>

namespace evical::test {

// A user's mistake in session.yaml, and the texts that the message must contain.
inline void verifyRefusal(const CalibrationError& error, const QStringList& said) {
  QVERIFY(error.kind() == ErrorKind::BadInput);
  QVERIFY2(QString(error.what()).contains("session.yaml"), error.what());
  for (const QString& part : said) QVERIFY2(QString(error.what()).contains(part), error.what());
}

}  // namespace evical::test
