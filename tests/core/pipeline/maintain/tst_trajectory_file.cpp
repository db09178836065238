// Trajectories of other programs, as `maintain` reads them.
#include "core/base/error.h"
#include "core/pipeline/maintain/maintained_trajectory.h"
#include "tests/support/test_program.h"

#include <QFile>
#include <QTemporaryDir>

using namespace evical;

class TestTrajectoryFile : public QObject {
  Q_OBJECT

 private slots:
  void tumFormat_isRead() {
    const std::vector<TimedPose> poses = readTrajectory(written("# time x y z qx qy qz qw\n", lines(30)), 0);
    QCOMPARE(poses.size(), std::size_t{30});
    QCOMPARE(poses[3].time_s, 1.3);
    QVERIFY(poses[3].position_m.isApprox(Eigen::Vector3d(3.0, 0.5, -0.25)));
    QVERIFY(poses[3].world_from_imu.isApprox(Eigen::Quaterniond(0.0, 0.0, 1.0, 0.0)));
  }

  void timesSince1970_startWithTheLog() {
    QString text;
    for (int k = 0; k < 25; ++k) text += QString("17000000%1.5 0 0 0 0 0 0 1\n").arg(k, 2, 10, QChar('0'));
    const std::vector<TimedPose> poses =
        readTrajectory(written("", text), std::int64_t{1'700'000'000} * 1'000'000'000);
    QCOMPARE(poses.front().time_s, 0.5);
    QCOMPARE(poses.back().time_s, 24.5);
  }

  void fault_isRefusedWithItsLine_data() {
    QTest::addColumn<QString>("text");
    QTest::addColumn<QString>("says");
    QTest::newRow("seven numbers") << lines(25) + "5 0 0 0 0 0 0\n"
                                   << "eight numbers";
    QTest::newRow("a word") << lines(25) + "5 0 0 zero 0 0 0 1\n"
                            << "eight numbers";
    QTest::newRow("no rotation") << lines(25) + "5 0 0 0 1 1 1 1\n"
                                 << "not a rotation";
    QTest::newRow("backwards") << lines(25) + "1.5 0 0 0 0 0 0 1\n"
                               << "backwards";
    QTest::newRow("few poses") << lines(5) << "only 5 poses";
  }
  void fault_isRefusedWithItsLine() {
    QFETCH(QString, text);
    QFETCH(QString, says);
    const std::filesystem::path file = written("", text);
    try {
      readTrajectory(file, 0);
      QFAIL("was read");
    } catch (const CalibrationError& error) {
      QVERIFY2(QString(error.what()).contains(says), error.what());
      QVERIFY2(QString(error.what()).contains("trajectory.txt"), error.what());
    }
  }

  void missingFile_isRefused() {
    QVERIFY_THROWS_EXCEPTION(CalibrationError, readTrajectory(folder_.filePath("none").toStdString(), 0));
  }

 private:
  // Poses every 0.1 s from 1 s on.
  static QString lines(int count) {
    QString text;
    for (int k = 0; k < count; ++k) text += QString("%1 %2 0.5 -0.25 0 1 0 0\n").arg(1.0 + 0.1 * k).arg(k);
    return text;
  }
  std::filesystem::path written(const QString& header, const QString& text) const {
    QFile file(folder_.filePath("trajectory.txt"));
    if (file.open(QIODevice::WriteOnly)) file.write((header + text).toUtf8());
    return file.fileName().toStdString();
  }

  QTemporaryDir folder_;
};

EVICAL_TEST(TestTrajectoryFile)
#include "tst_trajectory_file.moc"
