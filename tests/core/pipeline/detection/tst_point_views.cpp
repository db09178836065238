#include "core/base/error.h"
#include "core/frames/frame_options.h"
#include "core/pipeline/detection/camera_views.h"
#include "tests/support/test_program.h"

#include <vector>

namespace {

using namespace evical;

Board squares() {
  Board board;
  board.type = BoardType::Checkerboard;
  board.rows = 3;
  board.cols = 4;
  board.radius_m = 0.0;
  return board;
}

// A session with one camera, and the views of its points.
struct Fixture {
  Session session;
  CameraLens lens;
  RunContext context;
  std::optional<PointViews> views;

  explicit Fixture(const std::optional<CameraIntrinsics>& intrinsics = {}, double point_sigma_px = 0.2);
  BoardObservations finish() { return views->finish(faults); }
  std::vector<RecordingFault> faults;
};

// The board's first points 2 px apart, displaced by this.
CameraBatch batchAt(double time_s, int points, float shift_px = 0.0F) {
  CameraBatch batch;
  batch.kind = CameraKind::Points;
  batch.opened_px = Resolution{100, 80};
  for (int i = 0; i < points; ++i)
    batch.points.push_back({static_cast<std::int64_t>(1e9 * time_s), i,
                            10.0F + 2.0F * static_cast<float>(i) + shift_px, 20.0F, 0.0F});
  return batch;
}

Fixture::Fixture(const std::optional<CameraIntrinsics>& intrinsics, double point_sigma_px)
    : lens(givenLens(intrinsics)) {
  session.board = squares();
  session.cameras.push_back({"camera", "points", {}, {}});
  session.options.frames.edit().point_sigma_px = point_sigma_px;
  views.emplace(batchAt(0.0, 0), ViewRequest{session, lens, context});
}

}  // namespace

class TestPointViews : public QObject {
  Q_OBJECT

 private slots:
  void pointsOfOneTime_areAView_withVelocities() {
    Fixture test;
    test.views->consume(batchAt(0.0, 12));
    test.views->consume(batchAt(0.1, 12, 3.0F));
    test.views->consume(batchAt(0.2, 5, 6.0F));
    const BoardObservations found = test.finish();
    QVERIFY(test.faults.empty());
    QCOMPARE(found.views.size(), std::size_t{3});
    QVERIFY(found.views[0].kind == ViewKind::Complete && found.views[2].kind == ViewKind::Partial);
    QVERIFY((found.views[1].circles[4].velocity_px_s - Eigen::Vector2d(30.0, 0.0)).norm() < 1e-4);
    QCOMPARE(found.views[0].circles[0].rows_below_middle, 20.0 - 39.5);
    QVERIFY(found.kind == CameraKind::Points);
  }

  // The same rays for any lens: ideal pixels of a lens without distortion are the sensor's.
  void pointsThroughALens_areInItsIdealPixels() {
    CameraIntrinsics lens{CameraModel::PinholeRadtan, {100, 80}, {90.0, 90.0}, {49.5, 39.5}, {}};
    lens.distortion[0] = -0.3;
    Fixture test(lens);
    test.views->consume(batchAt(0.0, 12));
    QVERIFY(test.finish().views[0].circles[0].centre_px.x() < 9.0);  // barrel distortion moved it inwards
  }

  void sigma_isWhatIsSaid_orTheOptions() {
    Fixture test({}, 0.3);
    CameraBatch batch = batchAt(0.0, 12);
    batch.points[1].sigma_px = 0.5F;
    test.views->consume(batch);
    const std::vector<CircleObservation> circles = test.finish().views[0].circles;
    QVERIFY(circles[0].covariance_px2.isApprox(0.09 * Eigen::Matrix2d::Identity()));
    QVERIFY(circles[1].covariance_px2.isApprox(0.25 * Eigen::Matrix2d::Identity()));
  }

  void fewStrayPoints_areLeftOutAndSaid() {
    Fixture test;
    CameraBatch batch = batchAt(0.0, 12);
    batch.points.push_back({0, 12, 50.0F, 50.0F, 0.0F});  // not a point of the board
    batch.points.push_back({0, 3, 200.0F, 50.0F, 0.0F});  // outside the sensor
    batch.points.push_back({0, 5, 50.0F, 50.0F, 0.0F});   // the second one
    test.views->consume(batch);
    QCOMPARE(test.finish().views[0].circles.size(), std::size_t{12});
    QCOMPARE(test.faults.size(), std::size_t{3});
  }

  void pointsOfAnotherBoard_areRefused() {
    Fixture test;
    try {
      for (int k = 0; k < 100; ++k) test.views->consume(batchAt(0.1 * k, 24));
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      QVERIFY2(QString(error.what()).contains("up to 23"), error.what());
    }
  }

  void tooFewPoints_areNoView() {
    Fixture test;
    test.views->consume(batchAt(0.0, 3));
    QVERIFY(test.views->soFar().windows[0].outcome == WindowOutcome::TooFewCircles);
    QVERIFY(test.finish().views.empty());
  }
};

EVICAL_TEST(TestPointViews)
#include "tst_point_views.moc"
