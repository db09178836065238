// A part of a recording: what lies within time_range_s, and no more of the file than it takes.
#include "core/pipeline/recording_pass.h"
#include "core/pipeline/simulation.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <algorithm>

using namespace evical;

class TestTimeRange : public QObject {
  Q_OBJECT

 private slots:
  // A file that is cut off far behind the range gives the same as the whole one, and nothing is said of where it ends.
  void behindTheRange_nothingIsRead() {
    QTemporaryDir folder;
    Scenario scenario = readScenario(test::scenarioPath("davis346_10s"));
    scenario.duration_s = 5.0;
    const SimulationSummary made = simulate(scenario, folder.path().toStdString(), {});
    Session session = readSession(made.session);
    session.time_range_s = {0.5, 1.5};
    const RecordingPass whole = readAndDetect(session, {});
    std::filesystem::resize_file(made.recording, std::filesystem::file_size(made.recording) * 8 / 10);
    const RecordingPass part = readAndDetect(session, {});

    QVERIFY(whole.cameras[0].views.size() > 20);
    QCOMPARE(part.cameras[0].views.size(), whole.cameras[0].views.size());
    QCOMPARE(part.cameras[0].events, whole.cameras[0].events);
    QCOMPARE(part.imus[0].samples.size(), whole.imus[0].samples.size());
    for (const ImuSample& sample : part.imus[0].samples) {
      const double time_s = 1e-9 * static_cast<double>(sample.time_ns - part.start_ns);
      QVERIFY(time_s >= 0.5 && time_s <= 1.5);
    }
    for (const RecordingFault& fault : part.faults)
      QVERIFY2(fault.text.find("nothing behind it is read") == std::string::npos, fault.text.c_str());

    // It is where the range goes so far.
    session.time_range_s = {0.5, 5.0};
    const RecordingPass to_the_end = readAndDetect(session, {});
    QVERIFY(std::ranges::any_of(to_the_end.faults, [](const RecordingFault& fault) {
      return fault.text.find("nothing behind it is read") != std::string::npos;
    }));
  }
};

EVICAL_TEST(TestTimeRange)
#include "tst_time_range.moc"
