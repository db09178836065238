// SPDX-License-Identifier: GPL-3.0-or-later
// A run on the detection screen: its original windows, even if the document's session changes, and its
// reprojections.
#include "core/geometry/camera_model.h"
#include "tests/support/test_program.h"
#include "tests/ui/recorded_windows.h"
#include "ui/detection/layers.h"
#include "ui/theme/theme.h"

#include <algorithm>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

// A camera half a metre in front of the board, facing it, for two seconds.
CalibrationState restingState(const CameraIntrinsics& lens) {
  CalibrationState state;
  state.world_from_imu_rotation = makeUniformSo3Spline(0.0, 2.0, 0.1);
  state.imu_in_world_m.start_s = state.world_from_imu_rotation.start_s;
  state.imu_in_world_m.knot_spacing_s = state.world_from_imu_rotation.knot_spacing_s;
  state.imu_in_world_m.control_points.assign(state.world_from_imu_rotation.control_points.size(),
                                             Eigen::Vector3d(0.05, 0.2, -0.5));
  state.cameras.resize(1);
  state.cameras[0].lens = givenLens(lens);
  return state;
}

// The first circle is at the board's origin: half a metre ahead, 5 cm to the left, 20 cm up.
const Eigen::Vector3d kFirstCircle(-0.05, -0.2, 0.5);

double distanceFrom_px(const QPolygonF& outline, const Eigen::Vector2d& pixel) {
  const QPointF middle = outline.boundingRect().center();
  return std::hypot(middle.x() - pixel.x(), middle.y() - pixel.y());
}

}  // namespace

class TestDetectionOfRun : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() { recorded_ = std::make_unique<Recorded>(); }

  void windows_areShownAsTheRunSawThem_data() {
    QTest::addColumn<bool>("given");
    QTest::newRow("lens given") << true;
    QTest::newRow("lens found first") << false;
  }
  void windows_areShownAsTheRunSawThem() {
    QFETCH(bool, given);
    Session session = recorded_->session;
    auto run = recorded_->run();
    if (!given) {
      session.cameras[0].intrinsics.reset();
      run->detections.lenses[0].given.reset();
    }
    DetectionScreen screen;
    screen.resize(1000, 650);
    screen.show();
    screen.setSession(session);
    screen.setRun(run, session);
    compareWindows(screen, 20);
  }

  void run_staysWhenTheSessionIsEditedAndUndone_data() {
    QTest::addColumn<int>("what");
    QTest::newRow("board") << 0;
    QTest::newRow("lens") << 1;
    QTest::newRow("lens left out") << 2;
    QTest::newRow("stream") << 3;
  }
  void run_staysWhenTheSessionIsEditedAndUndone() {
    QFETCH(int, what);
    DetectionScreen screen;
    screen.resize(1000, 650);
    screen.show();
    screen.setSession(recorded_->session);
    screen.setRun(recorded_->run(), recorded_->session);
    Session edited = recorded_->session;
    if (what == 0) edited.board.spacing_m *= 2.0;
    if (what == 1) edited.cameras[0].intrinsics->focal_length_px *= 1.5;
    if (what == 2) edited.cameras[0].intrinsics.reset();
    if (what == 3) edited.cameras[0].stream = "/another";
    screen.setSession(edited);
    const std::size_t windows = recorded_->detections.cameras[0].windows.size();
    // Events of another stream were not part of the run.
    QCOMPARE(screen.timeline().windows().size(), what == 3 ? 0 : windows);
    if (what != 3) compareWindows(screen, 60);
    screen.setSession(recorded_->session);
    QCOMPARE(screen.timeline().windows().size(), windows);
    compareWindows(screen, 60);
  }

  void withoutARun_theSessionsBoardIsLookedFor() {
    DetectionScreen screen;
    showGoodWindow(screen, *recorded_);
    QCOMPARE(screen.analysis()->outcome, WindowOutcome::Complete);
    Session other = recorded_->session;
    other.board.rows += 4;
    screen.setSession(other);
    QTRY_VERIFY_WITH_TIMEOUT(screen.analysis() && screen.analysis()->outcome != WindowOutcome::Complete,
                             20000 * kSlowdown);
    screen.setSession(recorded_->session);
    QTRY_COMPARE_WITH_TIMEOUT(screen.analysis()->outcome, WindowOutcome::Complete, 20000 * kSlowdown);
  }

  void reprojection_isWhereTheCameraSeesTheBoard() {
    const CameraIntrinsics& camera = *recorded_->session.cameras.front().intrinsics;
    const CalibrationState state = restingState(camera);
    const auto outlines = reprojectBoard(state, 0, {recorded_->session.board}, 1.0);
    QCOMPARE(outlines.size(), static_cast<std::size_t>(recorded_->session.board.pointCount()));
    QVERIFY(distanceFrom_px(outlines.front(), *project(camera, kFirstCircle)) < 0.5);
    QVERIFY(reprojectBoard(state, 0, {recorded_->session.board}, 5.0).empty());
  }

  void reprojection_isThroughTheLensThatWasSolvedFor() {
    const CameraIntrinsics& given = *recorded_->session.cameras.front().intrinsics;
    CalibrationState state = restingState(given);
    CameraIntrinsics solved = given;
    solved.focal_length_px *= 1.05;
    state.cameras[0].lens.solved = solved;
    const auto outlines = reprojectBoard(state, 0, {recorded_->session.board}, 1.0);
    QVERIFY(distanceFrom_px(outlines.front(), *project(solved, kFirstCircle)) < 0.5);
    QVERIFY(distanceFrom_px(outlines.front(), *project(given, kFirstCircle)) > 2.0);
  }

  void reprojection_leadsAsTheMeasuredEdgesDo() {
    const Session& session = recorded_->session;
    const CameraIntrinsics& camera = *session.cameras.front().intrinsics;
    CalibrationState state = restingState(camera);
    state.cameras[0].edge_localisation_bias_px = 0.8;
    BoardView view;
    CircleObservation moving;  // the board's first circle, at 100 px/s to the right
    moving.circle = 0;
    moving.centre_px = *idealPixel(camera, *project(camera, kFirstCircle));
    moving.velocity_px_s = {100.0, 0.0};
    moving.edge_localisation_bias_effect = {1.0, 0.0};
    view.circles = {moving};
    const auto at_rest = reprojectBoard(state, 0, {session.board}, 1.0);
    const auto leading = reprojectBoard(state, 0, {session.board}, 1.0, view, 0.0);
    QCOMPARE(leading.size(), at_rest.size());
    const QPointF shift = leading[0].boundingRect().center() - at_rest[0].boundingRect().center();
    QVERIFY2(shift.x() > 0.4 && shift.x() < 0.9 && std::abs(shift.y()) < 0.2,
             qPrintable(QString("%1 %2").arg(shift.x()).arg(shift.y())));
    QCOMPARE(leading[1], at_rest[1]);  // not measured
  }

  void screen_drawsTheReprojectionOfARun_data() {
    QTest::addColumn<bool>("given");
    QTest::newRow("lens given") << true;
    QTest::newRow("lens found first") << false;
  }
  void screen_drawsTheReprojectionOfARun() {
    QFETCH(bool, given);
    Session session = recorded_->session;
    auto run = recorded_->run();
    run->result.state = restingState(*session.cameras.front().intrinsics);
    if (!given) {
      session.cameras.front().intrinsics.reset();
      run->detections.lenses[0].given.reset();
      run->result.state.cameras[0].lens.given.reset();
    }
    DetectionScreen screen;
    screen.resize(1000, 650);
    screen.show();
    screen.setSession(session);
    screen.setRun(run, session);
    QCOMPARE(screen.timeline().windows().size(), recorded_->detections.cameras.front().windows.size());
    screen.setTime(recorded_->goodWindow().time_s);
    settle(screen);
    const int without = pixelsOf(screen.view().grab().toImage(), theme().accent);
    screen.setLayerVisible(Layer::Reprojection, true);
    QVERIFY(pixelsOf(screen.view().grab().toImage(), theme().accent) > without + 100);
  }

 private:
  // Every n-th view of the run: the same outcome, the same circles.
  void compareWindows(DetectionScreen& screen, std::size_t every) const {
    const BoardObservations& seen = recorded_->detections.cameras[0];
    for (std::size_t k = every; k < seen.views.size(); k += every) {
      const double time_s = seen.views[k].time_s;
      screen.setTime(time_s);
      settle(screen);
      const auto report = std::find_if(seen.windows.begin(), seen.windows.end(), [&](const WindowReport& w) {
        return std::abs(w.time_s - time_s) < 1e-9;
      });
      QVERIFY(report != seen.windows.end());
      QCOMPARE(screen.analysis()->trace().circles.size(), seen.views[k].circles.size());
      QCOMPARE(screen.analysis()->outcome, report->outcome);
    }
  }

  std::unique_ptr<Recorded> recorded_;
};

EVICAL_TEST(TestDetectionOfRun)
#include "tst_detection_of_run.moc"
