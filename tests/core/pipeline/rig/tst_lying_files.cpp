// Valid files with false contents: for any times and values, the whole pipeline ends in a result or an error
// message, soon and in bounded memory. The fuzz target `calibrate` covers more of them.
#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "tests/support/lying_recording.h"
#include "tests/support/test_program.h"

#include <QElapsedTimer>
#include <QTemporaryDir>

#include <random>

namespace {

using namespace evical;

constexpr double kMaxMemory_mb = 1500.0;
constexpr int kPatience_ms = 60'000;  // one takes some seconds

class TestLyingFiles : public QObject {
  Q_OBJECT

 private slots:
  void withoutALie_thereIsAResult() {
    const CalibrationRun run = calibrate(lying_.tell({}), RunContext{});
    QVERIFY(run.result.status != CalibrationStatus::Failed);
    QVERIFY(run.detections.cameras.front().views.size() > 50);
  }
  void lies_endInAResultOrInWords() {
    constexpr unsigned kRecordings = 30;
    std::mt19937 random(1);
    for (unsigned k = 0; k < kRecordings; ++k) {
      std::vector<std::uint8_t> lies(6 * (1 + random() % 2));
      for (std::uint8_t& byte : lies) byte = static_cast<std::uint8_t>(random());
      const QByteArray told(reinterpret_cast<const char*>(lies.data()), static_cast<int>(lies.size()));
      QElapsedTimer timer;
      timer.start();
      try {
        const CalibrationRun run = calibrate(lying_.tell(lies), RunContext{});
        const CameraState& camera = run.result.state.cameras.front();
        QVERIFY2(camera.reference_from_camera.translation_m.allFinite(), told.toHex().constData());
      } catch (const CalibrationError& error) {
        QVERIFY2(!std::string(error.what()).empty(), told.toHex().constData());
      }
      QVERIFY2(timer.elapsed() < kPatience_ms, told.toHex().constData());
      QVERIFY2(peakMemory_mb() < kMaxMemory_mb, told.toHex().constData());
    }
  }

 private:
  QTemporaryDir folder_;
  test::LyingRecording lying_{folder_.path().toStdString()};
};

}  // namespace

EVICAL_TEST(TestLyingFiles)
#include "tst_lying_files.moc"
