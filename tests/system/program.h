// The program as users run it, and recordings that are simulated once for all of these tests.
#pragma once

#include <QByteArray>
#include <QRegularExpression>
#include <QString>
#include <QStringList>
#include <QtTest>

#include <functional>

namespace evical::test {

struct Outcome {
  int exit_code = -1;  // -1: crashed, or did not end in time
  QString output, errors;

  QString reason() const;  // last line on stderr
};

Outcome runProgram(const QStringList& arguments, int patience_s = 120);

// The same if the parent process ignores SIGCHLD, like some init systems and job runners.
Outcome runProgramWithoutChildSignals(const QStringList& arguments, int patience_s = 120);

// The same with standard streams as a shell redirects them: "2>&-".
Outcome runProgramRedirected(const QString& redirection, const QStringList& arguments, int patience_s = 30);

// The same with the largest file it may write, as `ulimit -f` sets it; for full disks.
Outcome runProgramWithFileLimit(const QStringList& arguments, int blocks_of_1024);

// The program with what a shell command writes as its standard input.
Outcome runProgramOn(const QString& shell_command, const QStringList& arguments, int patience_s = 60);
// The same with a signal after some time.
Outcome signalProgramOn(const QString& shell_command, const QStringList& arguments, int signal, int after_ms);

// Starts it, sends the signal when `ready` accepts its output on stderr (or after `patience_s`), and waits
// for its end.
Outcome interruptProgram(const QStringList& arguments, int signal,
                         const std::function<bool(const QString&)>& ready, int patience_s = 60);

// Folders of the simulated recordings: "blinking", "intrinsics", "mistakes", "second" (the short one's rig),
// "short" (text), "short_bag", "still".
QString simulated(const QString& name);

// The path of one of the project's own files, relative to its root.
QString inSources(const QString& below);

QByteArray readFile(const QString& path);
void writeFile(const QString& path, const QByteArray& content);

// The names in a folder, sorted, including hidden and temporary ones.
QStringList filesIn(const QString& folder);

}  // namespace evical::test

// Shows the program's output if it ended differently.
#define VERIFY_OUTCOME(outcome, code)                                                                \
  QVERIFY2((outcome).exit_code == (code),                                                            \
           qPrintable(QStringLiteral("exit code %1\n").arg((outcome).exit_code) + (outcome).output + \
                      (outcome).errors))
// The last line on stderr.
#define VERIFY_SAYS(outcome, part) \
  QVERIFY2((outcome).reason().contains(QRegularExpression(part)), qPrintable("reason: " + (outcome).reason()))
// Any text.
#define VERIFY_TEXT(text, part) \
  QVERIFY2(QString(text).contains(QRegularExpression(part)), qPrintable("it says: " + QString(text)))
