// SPDX-License-Identifier: GPL-3.0-or-later
// Core refers to user actions by HowTo; the window describes them in its own terms, without commands.
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"
#include "ui/jobs/window_how_to.h"

#include <QDirIterator>
#include <QFile>
#include <QRegularExpression>

#include <algorithm>

using namespace evical;

class TestWindowWords : public QObject {
  Q_OBJECT

 private slots:
  void everyWay_hasWordsWithoutCommands() {
    for (int k = 0; k < kHowTos; ++k) {
      const QString words = ui::windowHowTo(static_cast<HowTo>(k));
      QVERIFY2(!words.isEmpty() && !words.contains("evical ") && !words.contains("--"), qPrintable(words));
      QVERIFY(!QString(commandLineWords(static_cast<HowTo>(k))).isEmpty());
    }
  }

  void howTo_isSaidByTheFrontEnd() {
    QCOMPARE(howTo(HowTo::Inspect), std::string("with 'evical inspect'"));
    QCOMPARE(howTo(HowTo::NameLogOfImu, {"left", "log.csv"}), std::string("--imu left=log.csv"));
    speakWith(ui::windowHowTo);
    QCOMPARE(howTo(HowTo::Inspect), std::string("on the Recording page"));
    QCOMPARE(howTo(HowTo::NameLogOfImu, {"left", "log.csv"}), std::string("left=log.csv under Streams"));
    speakWith(commandLineWords);
  }

  // Evical's commands and options belong in how_to.cpp. Other programs' options are in core/export and
  // core/foreign.
  void core_namesNoCommandsItself() {
    const QString core = QString::fromStdString(evical::test::sourcePath("core"));
    const QRegularExpression comment("^ *//.*$", QRegularExpression::MultilineOption),
        between("\"\\s*\n\\s*\""), literal("\"(?:[^\"\\\\\n]|\\\\.)*\""),
        command(
            "\\bevical "
            "(batch|board|calibrate|check|compare|convert|detect|export|import|init|inspect|intrinsics|"
            "maintain|options|record|repeat|simulate|watch)\\b|--[a-z]");
    const QStringList allowed = {
        "/base/how_to.cpp",
        "/batch/batch_run.cpp",             // starts programs
        "/recording/recording_server.cpp",  // likewise
        "/session/option_pages.cpp",        // the output of a command
        "/html/number_sections.cpp",        // a report is for both front ends, and mentions both
    };
    int literals = 0;
    QDirIterator files(core, {"*.cpp"}, QDir::Files, QDirIterator::Subdirectories);
    while (files.hasNext()) {
      const QString path = files.next();
      const auto isEnd = [&](const QString& end) { return path.endsWith(end); };
      if (path.contains("/export/") || path.contains("/foreign/") || std::ranges::any_of(allowed, isEnd))
        continue;
      QFile file(path);
      QVERIFY(file.open(QIODevice::ReadOnly));
      const QString text = QString::fromUtf8(file.readAll()).replace(comment, "").replace(between, "");
      for (auto found = literal.globalMatch(text); found.hasNext(); ++literals) {
        const QString said = found.next().captured();
        QVERIFY2(!said.contains(command), qPrintable(path + ": " + said));
      }
    }
    QVERIFY(literals > 2000);
  }
};

EVICAL_TEST(TestWindowWords)
#include "tst_window_how_to.moc"
