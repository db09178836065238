#include "core/pipeline/detection/view_rejection.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/rig/detected_recording.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace evical;
using namespace evical::test;

class TestViewRejection : public QObject {
  Q_OBJECT

  SimulatedPass simulated_;

 private slots:
  void initTestCase() { simulated_ = simulatePass(4.0); }

  void views_areGoneAndTheOthersStayInOrder() {
    const std::vector<BoardView>& before = simulated_.detections.cameras[0].views;
    const int last = static_cast<int>(before.size()) - 1;
    const DetectionResult kept = withoutViews(simulated_.detections, 0, std::vector{last, 0, 3, 3});
    const std::vector<BoardView>& after = kept.cameras[0].views;
    QCOMPARE(after.size(), before.size() - 3);
    QCOMPARE(after[0].time_s, before[1].time_s);
    QCOMPARE(after[2].time_s, before[4].time_s);
    QCOMPARE(after[2].circles.size(), before[4].circles.size());
    QCOMPARE(after.back().time_s, before[before.size() - 2].time_s);
    QCOMPARE(kept.cameras[0].windows.size(), simulated_.detections.cameras[0].windows.size());
    QCOMPARE(kept.imus[0].samples.size(), simulated_.detections.imus[0].samples.size());
  }

  void noViews_leaveThePassAsItWas() {
    const DetectionResult kept = withoutViews(simulated_.detections, 0, {});
    QCOMPARE(kept.cameras[0].views.size(), simulated_.detections.cameras[0].views.size());
  }

  void rejectedViews_comeBackAsTheyWere() {
    const std::vector<BoardView>& before = simulated_.detections.cameras[0].views;
    const DetectionResult without = withoutViews(simulated_.detections, 0, std::vector{5, 2, 9});
    QCOMPARE(rejectedTimes_s(without)[0],
             (std::vector{before[2].time_s, before[5].time_s, before[9].time_s}));
    // One of them is included again, and another one excluded.
    const DetectionResult changed =
        withRejected(without, {{before[2].time_s, before[3].time_s, before[9].time_s}});
    QCOMPARE(rejectedTimes_s(changed)[0],
             (std::vector{before[2].time_s, before[3].time_s, before[9].time_s}));
    QCOMPARE(changed.cameras[0].views.size(), before.size() - 3);
    QCOMPARE(changed.cameras[0].views[3].time_s, before[5].time_s);
    QCOMPARE(changed.cameras[0].views[3].circles.size(), before[5].circles.size());
    const DetectionResult all = withRejected(changed, {{}});
    QCOMPARE(all.cameras[0].views.size(), before.size());
    for (std::size_t k = 0; k < all.cameras[0].windows.size(); ++k)
      QCOMPARE(all.cameras[0].windows[k].outcome, simulated_.detections.cameras[0].windows[k].outcome);
  }

  // Another detection of the same recording may have windows with other centres.
  void times_meanTheWindowsThatContainThem() {
    const BoardObservations& camera = simulated_.detections.cameras[0];
    const double third_s = camera.views[3].time_s;
    const auto window = std::find_if(camera.windows.begin(), camera.windows.end(),
                                     [&](const WindowReport& each) { return each.time_s == third_s; });
    const double within_s = 0.4 * std::min(window->half_width_s, camera.views[4].time_s - third_s);
    QVERIFY(within_s > 0.0);
    const DetectionResult changed =
        withRejected(simulated_.detections, {{third_s + within_s, camera.windows.back().time_s + 10.0}});
    QCOMPARE(rejectedTimes_s(changed)[0], std::vector{third_s});
    QCOMPARE(changed.cameras[0].views.size(), camera.views.size() - 1);
  }

  // Together with those that are rejected in the detections, as in those of an earlier run.
  void windowsOfTheSession_areExcluded() {
    const std::vector<BoardView>& views = simulated_.detections.cameras[0].views;
    Session session = simulated_.session;
    session.cameras[0].rejected_windows_s = {views[3].time_s + 1e-4, views[9].time_s, 1e4};
    const CalibrationRun run =
        calibrate(session, withoutViews(simulated_.detections, 0, std::vector{5, 9}), {});
    QCOMPARE(rejectedTimes_s(run.detections)[0],
             (std::vector{views[3].time_s, views[5].time_s, views[9].time_s}));
    QCOMPARE(run.result.rejected_windows.size(), std::size_t{3});
    QCOMPARE(run.detections.rejected_views[0].size(), std::size_t{3});
    QVERIFY(detectsTheSame(session, simulated_.session));
    const auto told = std::ranges::count_if(run.detections.faults, [](const RecordingFault& fault) {
      return fault.text.ends_with(
          "not found at 1 of its 3 times in rejected_windows_s, first at 10000.000 s");
    });
    QCOMPARE(told, 1);
  }

  void allWindowsRejected_isNamed() {
    Session session = simulated_.session;
    for (const BoardView& view : simulated_.detections.cameras[0].views)
      session.cameras[0].rejected_windows_s.push_back(view.time_s);
    try {
      calibrate(session, simulated_.detections, {});
      QFAIL("calibrated");
    } catch (const CalibrationError& error) {
      QVERIFY2(error.problem().find("with the board are rejected by hand") != std::string::npos,
               error.problem().c_str());
    }
  }

  void badViews_leftOutCalibrateAsIfTheyHadNeverBeen() {
    // Shifted as a whole by a fraction of a pixel: too little for the optimiser's own outlier test to drop
    // the window.
    DetectionResult spoilt = simulated_.detections;
    std::vector<int> bad;
    for (int view = 20; view < 60; view += 2) {
      bad.push_back(view);
      for (CircleObservation& circle : spoilt.cameras[0].views[static_cast<std::size_t>(view)].circles)
        circle.centre_px += Eigen::Vector2d(0.15, 0.1);
    }
    const CalibrationRun with = calibrate(simulated_.session, spoilt, {});
    const CalibrationRun without = calibrate(simulated_.session, withoutViews(spoilt, 0, bad), {});
    const CalibrationRun clean =
        calibrate(simulated_.session, withoutViews(simulated_.detections, 0, bad), {});
    QVERIFY(without.result.cameras[0].reprojection_rms_px < 0.9 * with.result.cameras[0].reprojection_rms_px);
    const double rms_px = clean.result.cameras[0].reprojection_rms_px;
    QVERIFY(std::abs(without.result.cameras[0].reprojection_rms_px - rms_px) < 1e-6 * rms_px);
  }
};

EVICAL_TEST(TestViewRejection)
#include "tst_view_rejection.moc"
