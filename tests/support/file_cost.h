// Time and memory needed to read a file from a stranger, in a separate process: a bomb cannot harm the test.
#pragma once

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <QRegularExpression>
#include <QString>

#include <array>
#include <exception>
#include <functional>

namespace evical::test {

struct FileCost {
  double processor_s = 0.0, peak_mb = 0.0;
  QString said;  // by the reader, or the message of what it threw

  // True for a file that is refused or read within these limits.
  bool isBearable() const { return processor_s < 10.0 && peak_mb < 512.0; }
  QString text() const {
    return QStringLiteral("%1 s, %2 MB: %3").arg(processor_s, 0, 'f', 2).arg(peak_mb, 0, 'f', 0).arg(said);
  }
};

inline FileCost costOf(const std::function<std::string()>& read) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return {};
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit patience{60, 60};
    ::setrlimit(RLIMIT_CPU, &patience);
    std::string said;
    try {
      said = read();
    } catch (const std::exception& error) {
      said = error.what();
    }
    static_cast<void>(!::write(ends[1], said.data(), said.size()));
    ::_exit(0);
  }
  ::close(ends[1]);
  FileCost cost;
  std::array<char, 4096> part{};
  QByteArray said;
  for (ssize_t got = 0; (got = ::read(ends[0], part.data(), part.size())) > 0;) said.append(part.data(), got);
  ::close(ends[0]);
  int status = 0;
  rusage used{};
  ::wait4(child, &status, 0, &used);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  cost.processor_s = seconds(used.ru_utime) + seconds(used.ru_stime);
  cost.peak_mb = static_cast<double>(used.ru_maxrss) / 1024.0;
  cost.said = WIFEXITED(status) ? QString::fromUtf8(said) : QStringLiteral("signal %1").arg(WTERMSIG(status));
  return cost;
}

}  // namespace evical::test

// Says what the file cost, also if it is bearable.
#define VERIFY_COST(cost, part)                             \
  qInfo("%s", qPrintable((cost).text()));                   \
  QVERIFY2((cost).isBearable(), qPrintable((cost).text())); \
  QVERIFY2((cost).said.contains(QRegularExpression(part)), qPrintable((cost).said))
