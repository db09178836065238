// Residuals of a result against the views of its pass, if the batch used only some views, or changed them.
#include "core/pipeline/detection/view_rejection.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/rig/tag_corners.h"
#include "core/report/report_options.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace evical;
using namespace evical::test;

namespace {

// Each residual has the time and the place of a circle of its view in the pass.
void verifyOfPass(const CalibrationRun& run) {
  QVERIFY(!run.result.circle_residuals.empty());
  for (const CircleResidual& residual : run.result.circle_residuals) {
    const std::vector<BoardView>& views =
        run.detections.cameras.at(static_cast<std::size_t>(residual.camera)).views;
    const std::vector<CircleObservation>& circles = views.at(static_cast<std::size_t>(residual.view)).circles;
    const auto own = std::ranges::find(circles, residual.circle, &CircleObservation::circle);
    QVERIFY(own != circles.end());
    QCOMPARE(residual.time_s, own->time_s);
    QVERIFY(residual.centre_px == own->centre_px);
  }
}

}  // namespace

class TestResidualViews : public QObject {
  Q_OBJECT

 private slots:
  // The views on the shorter side of a step of the camera's clock are not used.
  void clockStep_leavesTheNumbersOfViews_data() {
    QTest::addColumn<double>("at_s");
    QTest::newRow("early") << 5.0;
    QTest::newRow("late") << 11.0;
  }
  void clockStep_leavesTheNumbersOfViews() {
    QFETCH(const double, at_s);
    SimulatedPass stepped = simulatePass(16.0);
    for (BoardView& view : stepped.detections.cameras[0].views) {
      if (view.time_s < at_s) continue;
      view.time_s += 0.05;
      for (CircleObservation& circle : view.circles) circle.time_s += 0.05;
    }
    for (WindowReport& window : stepped.detections.cameras[0].windows)
      if (window.time_s >= at_s) window.time_s += 0.05;
    stepped.session.options.report.edit().split_half_check = false;
    const CalibrationRun run = calibrate(stepped.session, stepped.detections, {});
    QVERIFY2(run.result.reason.find("steps by") != std::string::npos, run.result.reason.c_str());
    QCOMPARE(run.detections.cameras[0].views.size(), stepped.detections.cameras[0].views.size());
    verifyOfPass(run);
    // A user who rejects the window of a residual rejects this one.
    const CircleResidual& any = run.result.circle_residuals[run.result.circle_residuals.size() / 2];
    const DetectionResult without = withoutViews(run.detections, 0, std::vector{any.view});
    QVERIFY(without.rejected_views[0].size() == 1);
    QVERIFY(std::abs(without.rejected_views[0].front().time_s - any.time_s) < 0.03);
  }

  // Corners that were measured towards the middle of their tag are moved for the batch only.
  void tagCorners_areTheMeasuredOnes() {
    Scenario scenario = simulatePass(1.0).truth;
    Board& board = scenario.board;
    board = {};
    board.type = BoardType::AprilGrid;
    board.rows = board.cols = 5;
    board.spacing_m = 0.07;
    board.tag_size_m = 0.054;
    board.radius_m = 0.0;
    scenario.cameras[0].frames.emplace();
    SimulatedPass tags = simulatePass(12.0, scenario);
    moveTagCorners(-0.3, tags.detections.cameras[0].views);
    tags.session.options.report.edit().split_half_check = false;
    const CalibrationRun run = calibrate(tags.session, tags.detections, {});
    const auto told = [](const std::string& note) { return note.find("tag corners") != std::string::npos; };
    QVERIFY(std::ranges::any_of(run.result.notes, told));
    verifyOfPass(run);
    const TagCornerShift left = tagCornerShift(0, run.result.circle_residuals);
    QVERIFY2(std::abs(left.outwards_px) < 0.05, qPrintable(QString::number(left.outwards_px)));
  }
};

EVICAL_TEST(TestResidualViews)
#include "tst_residual_views.moc"
