// If the desktop's numbers have decimal commas, files are read and written with decimal points.
#include "core/pipeline/maintain/maintained_trajectory.h"
#include "core/pipeline/session/session.h"
#include "core/recording/recording_reader.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/german_locale.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QFile>
#include <QTemporaryDir>

using namespace evical;

class TestLocale : public QObject {
  Q_OBJECT

  QTemporaryDir folder_;

  std::filesystem::path write(const char* name, const QByteArray& content) const {
    QFile file(folder_.filePath(name));
    if (!file.open(QIODevice::WriteOnly)) qFatal("%s cannot be written", name);
    file.write(content);
    return file.fileName().toStdString();
  }

 private slots:
  void files_areReadAsEverywhere() {
    const Session session = test::simulatePass(2.0).session;
    const std::string yaml = sessionYaml(session, ".");
    const test::GermanLocale german;
    if (!german.isInstalled())
      QSKIP("localedef cannot create the locale de_DE: the package locales is missing");

    QCOMPARE(sessionYaml(session, "."), yaml);
    QVERIFY(readScenario(test::scenarioPath("davis346_10s")).board.spacing_m > 0.01);

    QByteArray trajectory = "time_s,x,y,z,qx,qy,qz,qw\n";
    for (int k = 0; k < 40; ++k)
      trajectory += QByteArray::number(0.5 + 0.25 * k) + ",1.25,2.5,3.75,0,0,0,1\n";
    const std::vector<TimedPose> poses = readTrajectory(write("trajectory.csv", trajectory), 0);
    QCOMPARE(poses.size(), std::size_t{40});
    QCOMPARE(poses[0].time_s, 0.5);
    QVERIFY((poses[0].position_m == Eigen::Vector3d(1.25, 2.5, 3.75)));

    const auto reader =
        openRecording(write("imu.csv", "t_s,ax,ay,az,gx,gy,gz\n0.5,1.25,2.5,9.5,0.125,0.25,0.375\n"));
    Packet packet;
    QVERIFY(reader->read(packet));
    QVERIFY((packet.imu_samples.at(0).specific_force == Eigen::Vector3d(1.25, 2.5, 9.5)));
    QCOMPARE(qint64(packet.imu_samples[0].time_ns), qint64(500'000'000));
  }
};

EVICAL_TEST(TestLocale)
#include "tst_locale.moc"
