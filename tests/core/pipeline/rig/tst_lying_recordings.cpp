// Valid recordings with false contents: for any times and values, a calibration ends in a result or an error
// message.
#include "core/base/error.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/scenario_session.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QElapsedTimer>

#include <cmath>
#include <random>

namespace {

using namespace evical;

// Two or three disturbances of any size.
class Liar {
 public:
  explicit Liar(unsigned seed) : random_(seed) {}

  QStringList spoil(DetectionResult& detections) {
    QStringList told;
    const int lies = 1 + whole(3);
    for (int k = 0; k < lies; ++k) {
      std::vector<ImuSample>& samples = detections.imus[0].samples;
      std::vector<BoardView>& views = detections.cameras[0].views;
      if (samples.empty() || views.empty()) break;
      told << tell(samples, views);
    }
    const auto earlier = [](const auto& a, const auto& b) { return a.time_ns < b.time_ns; };
    std::stable_sort(detections.imus[0].samples.begin(), detections.imus[0].samples.end(), earlier);
    std::stable_sort(detections.cameras[0].views.begin(), detections.cameras[0].views.end(),
                     [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
    return told;
  }

 private:
  int whole(int below) { return static_cast<int>(random_() % static_cast<unsigned>(below)); }
  double size() { return std::pow(10.0, whole(14) - 6) * (whole(2) ? 1.0 : -1.0); }
  double part() { return std::uniform_real_distribution<double>()(random_); }

  QString tell(std::vector<ImuSample>& samples, std::vector<BoardView>& views) {
    const std::size_t begin = static_cast<std::size_t>(part() * static_cast<double>(samples.size())),
                      end = begin +
                            static_cast<std::size_t>(part() * static_cast<double>(samples.size() - begin));
    const std::size_t first = static_cast<std::size_t>(part() * static_cast<double>(views.size())),
                      last = first +
                             static_cast<std::size_t>(part() * static_cast<double>(views.size() - first));
    const double by = size();
    const int axis = whole(3);
    switch (whole(10)) {
      case 0:
        for (std::size_t i = begin; i < end; ++i) samples[i].angular_rate_rad_s[axis] *= by;
        return QString("rates times %1").arg(by);
      case 1:
        for (std::size_t i = begin; i < end; ++i) samples[i].specific_force_m_s2[axis] += by;
        return QString("forces plus %1").arg(by);
      case 2:
        for (std::size_t i = begin; i < end; ++i) samples[i].angular_rate_rad_s.setZero();
        return "rates zero";
      case 3:
        for (std::size_t i = begin; i < end; ++i)
          samples[i].specific_force_m_s2 = samples[begin].specific_force_m_s2;
        return "constant forces";
      case 4:
        for (std::size_t i = begin; i < samples.size(); ++i)
          samples[i].time_ns += static_cast<std::int64_t>(1e9 * std::clamp(by, -100.0, 100.0));
        return QString("IMU's clock by %1").arg(by);
      case 5:
        samples.erase(samples.begin() + static_cast<std::ptrdiff_t>(begin),
                      samples.begin() + static_cast<std::ptrdiff_t>(end));
        return "samples gone";
      case 6:
        views.erase(views.begin() + static_cast<std::ptrdiff_t>(first),
                    views.begin() + static_cast<std::ptrdiff_t>(last));
        return "views gone";
      case 7:
        for (std::size_t i = first; i < last; ++i)
          for (CircleObservation& circle : views[i].circles) circle.centre_px[axis % 2] += by;
        return QString("centres by %1 px").arg(by);
      case 8:
        for (std::size_t i = first; i < views.size(); ++i) {
          views[i].time_s += std::clamp(by, -100.0, 100.0);
          for (CircleObservation& circle : views[i].circles) circle.time_s += std::clamp(by, -100.0, 100.0);
        }
        return QString("camera's clock by %1").arg(by);
      default:
        for (std::size_t i = first; i < last; ++i)
          for (CircleObservation& circle : views[i].circles) circle.covariance_px2 *= std::abs(by);
        return QString("covariances times %1").arg(std::abs(by));
    }
  }

  std::mt19937 random_;
};

class TestLyingRecordings : public QObject {
  Q_OBJECT

 private slots:
  void everything_endsInAResultOrInWords();
};

void TestLyingRecordings::everything_endsInAResultOrInWords() {
  constexpr unsigned kRecordings = 20;
  constexpr int kPatience_ms = 60'000;  // one takes a second
  Scenario scenario = readScenario(test::scenarioPath("davis346"));
  scenario.duration_s = 5.0;
  Session session = test::sessionFor(scenario);
  const DetectionResult good = test::perfectPass(scenario, 0.05, 0.03);
  int results = 0;
  for (unsigned seed = 1; seed <= kRecordings; ++seed) {
    DetectionResult detections = good;
    const QString told = Liar(seed).spoil(detections).join(", ");
    QElapsedTimer timer;
    timer.start();
    try {
      const CalibrationRun run = calibrate(session, std::move(detections), RunContext{});
      const CameraState& camera = run.result.state.cameras.front();
      QVERIFY2(camera.reference_from_camera.translation_m.allFinite() && std::isfinite(camera.time_offset_s),
               qPrintable(told));
      ++results;
    } catch (const CalibrationError& error) {
      QVERIFY2(!std::string(error.what()).empty(), qPrintable(told));
    }
    QVERIFY2(timer.elapsed() < kPatience_ms, qPrintable(QString("%1: %2 ms").arg(told).arg(timer.elapsed())));
  }
  QVERIFY2(results > 3, qPrintable(QString::number(results)));  // otherwise no run got far
}

}  // namespace

EVICAL_TEST(TestLyingRecordings)
#include "tst_lying_recordings.moc"
