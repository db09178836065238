#include "tests/system/program.h"

#include "tests/support/test_folders.h"

#include <QDir>
#include <QElapsedTimer>
#include <QFile>
#include <QProcess>

#include <csignal>
#include <stdexcept>

namespace evical::test {
namespace {

const QString kProgram = QStringLiteral(EVICAL_PROGRAM);

Outcome finished(QProcess& process, int patience_s, QString errors = {}) {
  Outcome outcome;
  const bool ended = process.waitForFinished(1000 * patience_s);
  if (!ended) {
    process.kill();
    process.waitForFinished();
  }
  if (ended && process.exitStatus() == QProcess::NormalExit) outcome.exit_code = process.exitCode();
  outcome.output = QString::fromUtf8(process.readAllStandardOutput());
  outcome.errors = errors + QString::fromUtf8(process.readAllStandardError());
  return outcome;
}

}  // namespace

QString Outcome::reason() const {
  const QStringList lines = errors.split('\n', Qt::SkipEmptyParts);
  return lines.isEmpty() ? QString() : lines.last();
}

Outcome runProgram(const QStringList& arguments, int patience_s) {
  QProcess process;
  process.start(kProgram, arguments);
  return finished(process, patience_s);
}

Outcome runProgramWithoutChildSignals(const QStringList& arguments, int patience_s) {
  QProcess process;
  process.setChildProcessModifier([] { std::signal(SIGCHLD, SIG_IGN); });
  process.start(kProgram, arguments);
  return finished(process, patience_s);
}

Outcome runProgramRedirected(const QString& redirection, const QStringList& arguments, int patience_s) {
  QProcess process;
  const QStringList shell = {"-c", QStringLiteral("exec \"$@\" %1").arg(redirection), "bash", kProgram};
  process.start("bash", shell + arguments);
  return finished(process, patience_s);
}

Outcome runProgramWithFileLimit(const QStringList& arguments, int blocks_of_1024) {
  QProcess process;
  QStringList shell = {"-c", QStringLiteral("ulimit -f %1; exec \"$@\"").arg(blocks_of_1024), "bash",
                       kProgram};
  process.start("bash", shell + arguments);
  return finished(process, 120);
}

Outcome runProgramOn(const QString& shell_command, const QStringList& arguments, int patience_s) {
  QProcess process;
  process.start("bash", QStringList{"-c", "(" + shell_command + ") | \"$@\"", "bash", kProgram} + arguments);
  return finished(process, patience_s);
}

Outcome signalProgramOn(const QString& shell_command, const QStringList& arguments, int signal,
                        int after_ms) {
  QProcess sender, process;
  sender.setStandardOutputProcess(&process);
  sender.start("bash", {"-c", shell_command});
  process.start(kProgram, arguments);
  process.waitForStarted();
  process.waitForFinished(after_ms);
  if (const auto number = static_cast<pid_t>(process.processId()); number > 0) ::kill(number, signal);
  const Outcome outcome = finished(process, 30);
  sender.kill();
  sender.waitForFinished();
  return outcome;
}

Outcome interruptProgram(const QStringList& arguments, int signal,
                         const std::function<bool(const QString&)>& ready, int patience_s) {
  QProcess process;
  process.start(kProgram, arguments);
  process.waitForStarted();
  QElapsedTimer timer;
  timer.start();
  QString errors;
  while (!ready(errors) && timer.elapsed() < 1000 * patience_s && process.state() == QProcess::Running) {
    process.waitForReadyRead(20);
    errors += QString::fromUtf8(process.readAllStandardError());
  }
  // A process that has ended has the id 0, which would signal the whole process group.
  if (const auto number = static_cast<pid_t>(process.processId()); number > 0) ::kill(number, signal);
  return finished(process, patience_s, errors);
}

QString simulated(const QString& name) {
  return QString::fromStdString(buildPath("tests/system/simulated/")) + name;
}

QString inSources(const QString& below) {
  return QString::fromStdString(sourcePath(below.toStdString()));
}

QByteArray readFile(const QString& path) {
  QFile file(path);
  if (!file.open(QIODevice::ReadOnly)) throw std::runtime_error("cannot read " + path.toStdString());
  return file.readAll();
}

void writeFile(const QString& path, const QByteArray& content) {
  QFile file(path);
  if (!file.open(QIODevice::WriteOnly) || file.write(content) != content.size())
    throw std::runtime_error("cannot write " + path.toStdString());
}

QStringList filesIn(const QString& folder) {
  return QDir(folder).entryList(QDir::AllEntries | QDir::Hidden | QDir::NoDotAndDotDot, QDir::Name);
}

}  // namespace evical::test
