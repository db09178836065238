// Users' mistakes with `evical calibrate`: a separate session on a simulated recording, with one change per
// test. The exit code shows the kind of error, the last line states what, where and what to do, and no
// incomplete result remains.
#pragma once

#include "tests/support/test_program.h"
#include "tests/system/program.h"

#include <QDir>
#include <QRegularExpression>
#include <QTemporaryDir>

#include <functional>

namespace evical::test {

// A separate session with links to a simulated recording; each test makes one change.
class SessionCase {
 public:
  explicit SessionCase(const QString& recording = "short") {
    for (const QString& file : filesIn(simulated(recording)))
      if (file != "session.yaml") QFile::link(simulated(recording) + "/" + file, path(file));
    session_ = readFile(simulated(recording) + "/session.yaml");
    writeFile(session(), session_);
  }

  QString path(const QString& name) const { return folder_.filePath(name); }
  QString session() const { return path("session.yaml"); }
  QString result() const { return path("result"); }

  void change(const QString& from, const QString& to) {
    QString text = QString::fromUtf8(session_);
    QVERIFY2(text.contains(from), qPrintable("the session has no '" + from + "'"));
    session_ = text.replace(from, to).toUtf8();
    writeFile(session(), session_);
  }
  void append(const QString& text) {
    session_ += text.toUtf8();
    writeFile(session(), session_);
  }
  void replace(const QString& file, const QByteArray& content) {
    QFile::remove(path(file));
    writeFile(path(file), content);
  }
  // Passes each line's numbers to `edit`, which may clear a line to drop it.
  void editLines(const QString& file, const std::function<void(QList<double>&)>& edit) {
    QByteArray edited;
    for (const QByteArray& line : readFile(path(file)).split('\n')) {
      QList<double> numbers;
      for (const QByteArray& number : line.simplified().split(' '))
        if (!number.isEmpty()) numbers.append(number.toDouble());
      if (!numbers.isEmpty()) edit(numbers);
      if (numbers.isEmpty()) continue;
      for (int i = 0; i < numbers.size(); ++i)
        edited += (i == 0 ? "" : " ") + QByteArray::number(numbers[i], 'f', 9);
      edited += '\n';
    }
    replace(file, edited);
  }

  Outcome calibrate(const QStringList& more = {}) const {
    return runProgram(QStringList{"calibrate", session(), "-o", result()} + more);
  }

 private:
  QTemporaryDir folder_;
  QByteArray session_;
};

}  // namespace evical::test

// Rejected before any file is written.
#define VERIFY_REJECTED(test, outcome, part) \
  VERIFY_OUTCOME(outcome, 2);                \
  VERIFY_SAYS(outcome, part);                \
  QVERIFY2(!QDir((test).result()).exists(), "a folder for results was created")

// Failed during the calibration: the folder, if there is one, contains the reason and no incomplete files.
#define VERIFY_FAILED(test, outcome, part)                                        \
  VERIFY_OUTCOME(outcome, 1);                                                     \
  VERIFY_SAYS(outcome, part);                                                     \
  QVERIFY(!QDir((test).result()).exists() ||                                      \
          readFile((test).result() + "/result.yaml").contains("status: failed")); \
  for (const QString& file : filesIn((test).result()))                            \
  QVERIFY2((QStringList{"result.yaml", "log.txt", "report.html", "plots"}).contains(file), qPrintable(file))
