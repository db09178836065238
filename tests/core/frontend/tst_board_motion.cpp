#include "core/frontend/board_motion.h"

#include "core/geometry/camera_model.h"

#include "tests/core/frontend/synthetic_bursts.h"
#include "tests/support/test_program.h"

namespace {

using namespace evical;
using namespace evical::test;

const ImageFrame kFrame = {{150.0, 120.0}, 80.0};

PlaneFlow someFlow() {
  return (PlaneFlow() << 50, -8, 12, -30, 5, 9, 6, -4).finished();
}

Eigen::Vector2d apply(const Eigen::Matrix3d& h, const Eigen::Vector2d& p) {
  return (h * p.homogeneous()).hnormalized();
}

class TestBoardMotion : public QObject {
  Q_OBJECT
 private slots:
  void imageOfCircle_holdsImagesOfItsPoints();
  void imageOfCircle_behindTheCamera_isNothing();
  void sensorPixels_followDistortion();
  void distanceToEdge_isThatOfTheCircle();
  void flowBasis_matchesMovedHomography();
  void gradient_matchesDifferences();
  void prediction_keepsTheField();
  void prediction_movesTheBoard();
  void insideImage_wantsTheWholeCircle();
  void crossingWeight_leavesOutGrazingEdges();
  void fit_withoutNoise_recoversMotion_data();
  void fit_withoutNoise_recoversMotion();
  void fit_measuresRadiusOffset();
  void fit_withoutBursts_isNothing();
};

void TestBoardMotion::imageOfCircle_holdsImagesOfItsPoints() {
  const MovingBoard moving;
  const Eigen::Matrix3d h = moving.homographyAt(0.0);
  for (int i = 0; i < moving.board.pointCount(); ++i) {
    const OutlineImage image = moving.imageAt(i, 0.0);
    double largest_px = 0.0;
    for (int k = 0; k < 72; ++k) {
      const double angle = 2.0 * M_PI * k / 72;
      const Eigen::Vector2d point =
          moving.board.point_m(i) + moving.board.radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const Eigen::Vector2d q = apply(h, point) - image.centre_px;
      QVERIFY(std::abs(q.dot(image.shape * q) - 1.0) < 1e-9);
      QVERIFY(std::abs(distanceToEdge(image, apply(h, point)).distance_px) < 1e-8);
      largest_px = std::max(largest_px, q.norm());
    }
    QVERIFY(std::abs(largest_px - image.max_radius_px) < 0.01);
  }
}

void TestBoardMotion::imageOfCircle_behindTheCamera_isNothing() {
  MovingBoard moving;
  moving.middle_m = {0.0, 0.0, -0.5};
  Eigen::Matrix3d h = moving.homographyAt(0.0);
  if (h(2, 2) > 0.0) h = -h;  // third coordinate is the depth
  QVERIFY(!imageOfCircle(h, moving.scene(), 0));
}

void TestBoardMotion::sensorPixels_followDistortion() {
  const MovingBoard moving;
  CameraIntrinsics camera;
  camera.resolution_px = kDavis_px;
  camera.focal_length_px = {260.0, 260.0};
  camera.principal_point_px = {172.5, 129.5};
  camera.distortion = {-0.3, 0.08, 0.0, 0.0, 0.0};
  const auto image = imageOfCircle(moving.homographyAt(0.0), BoardScene(moving.board, kDavis_px, camera), 0);
  QVERIFY(image.has_value());
  QVERIFY((image->sensor_centre_px - pixelFromIdeal(camera, image->centre_px)).norm() < 1e-9);
  QVERIFY(image->sensor_radius_px < image->max_radius_px);  // barrel distortion shrinks the border
}

void TestBoardMotion::distanceToEdge_isThatOfTheCircle() {
  OutlineImage image;
  image.centre_px = {100.0, 80.0};
  image.shape = Eigen::Matrix2d::Identity() / 81.0;
  image.max_radius_px = 9.0;
  for (const double distance_px : {-3.0, -0.5, 0.0, 0.5, 4.0}) {
    const Eigen::Vector2d n = Eigen::Vector2d(3.0, 4.0) / 5.0;
    const EdgeDistance edge = distanceToEdge(image, image.centre_px + (9.0 + distance_px) * n);
    QVERIFY(std::abs(edge.distance_px - distance_px) < 1e-9);
    QVERIFY((edge.normal - n).norm() < 1e-9);
  }
}

void TestBoardMotion::flowBasis_matchesMovedHomography() {
  const Eigen::Matrix3d h = MovingBoard().homographyAt(0.0);
  constexpr double kStep_px = 1e-4;
  for (int term = 0; term < 8; ++term) {
    const PlaneFlow step = kStep_px * PlaneFlow::Unit(term);
    const Eigen::Matrix3d ahead = warped(h, kFrame, step), behind = warped(h, kFrame, -step);
    for (const Eigen::Vector2d& p :
         {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.2, 0.1), Eigen::Vector2d(0.05, 0.3)}) {
      const Eigen::Vector2d difference = (apply(ahead, p) - apply(behind, p)) / (2.0 * kStep_px);
      const Eigen::Vector2d expected = kFrame.basis(apply(h, p)).col(term);
      QVERIFY((difference - expected).norm() < 1e-6);
      QVERIFY((kFrame.flow(PlaneFlow::Unit(term), apply(h, p)) - expected).norm() < 1e-12);
    }
  }
}

void TestBoardMotion::gradient_matchesDifferences() {
  constexpr double kStep_px = 1e-4;
  const Eigen::Vector2d at(201.0, 63.0);
  const Eigen::Matrix2d gradient = kFrame.gradient(someFlow(), at);
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d step = kStep_px * Eigen::Vector2d::Unit(axis);
    const Eigen::Vector2d difference =
        (kFrame.flow(someFlow(), at + step) - kFrame.flow(someFlow(), at - step)) / (2.0 * kStep_px);
    QVERIFY((difference - gradient.col(axis)).norm() < 1e-6);
  }
}

BoardMotion someMotion() {
  BoardMotion motion = MovingBoard().motionAt(0.0);
  motion.frame = kFrame;
  motion.velocity_px_s = someFlow();
  return motion;
}

void TestBoardMotion::prediction_keepsTheField() {
  const BoardMotion motion = someMotion();
  const BoardMotion next = predicted(motion, 50'000'000);
  QVERIFY(next.frame.centre_px != motion.frame.centre_px);
  for (const Eigen::Vector2d& at :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(340, 20), Eigen::Vector2d(130, 250)})
    QVERIFY((next.velocityAt(at) - motion.velocityAt(at)).norm() < 1e-9);
}

void TestBoardMotion::prediction_movesTheBoard() {
  BoardMotion motion = someMotion();
  motion.acceleration_px_s2 = 10.0 * someFlow();
  const BoardMotion next = predicted(motion, 10'000'000);
  QCOMPARE(next.time_ns, 10'000'000);
  const Board board = MovingBoard().board;
  for (int i = 0; i < board.pointCount(); ++i) {
    const Eigen::Vector2d before = apply(motion.ideal_from_board, board.point_m(i));
    const Eigen::Vector2d after = apply(next.ideal_from_board, board.point_m(i));
    // The error is of second order in a movement of half a pixel over 80 px.
    QVERIFY((after - before - motion.travel(before, 0.01)).norm() < 0.01);
    QVERIFY((next.velocityAt(after) - motion.velocityAt(after) - 0.01 * motion.accelerationAt(after)).norm() <
            1e-6);
  }
}

void TestBoardMotion::insideImage_wantsTheWholeCircle() {
  OutlineImage image;
  image.sensor_radius_px = 5.0;
  image.sensor_centre_px = {6.0, 100.0};
  QVERIFY(insideImage(image, kDavis_px));
  image.sensor_centre_px = {4.0, 100.0};
  QVERIFY(!insideImage(image, kDavis_px));
  image.sensor_centre_px = {100.0, 256.0};
  QVERIFY(!insideImage(image, kDavis_px));
}

void TestBoardMotion::crossingWeight_leavesOutGrazingEdges() {
  const TrackingOptions options;
  QCOMPARE(crossingWeight(1.0, 8.0, 8.0, options), 1.0);
  QCOMPARE(crossingWeight(0.9 * options.min_polarity_cosine, 8.0, 8.0, options), 0.0);
  QCOMPARE(crossingWeight(-1.0, 8.0, 8.0, options), 0.0);
  QCOMPARE(crossingWeight(1.0, 0.9 * options.min_event_part * 8.0, 8.0, options), 0.0);
  QCOMPARE(crossingWeight(1.0, 1.0, 0.0, options), 1.0);  // typical value not known yet
}

void TestBoardMotion::fit_withoutNoise_recoversMotion_data() {
  QTest::addColumn<bool>("dark");
  QTest::addColumn<double>("speed_factor");
  QTest::newRow("dark") << true << 1.0;
  QTest::newRow("bright") << false << 1.0;
  QTest::newRow("slow") << true << 0.4;
  QTest::newRow("fast") << true << 5.0;
}

void TestBoardMotion::fit_withoutNoise_recoversMotion() {
  QFETCH(bool, dark);
  QFETCH(double, speed_factor);
  std::mt19937 random(20);
  MovingBoard moving;
  moving.board.circles = dark ? CircleShade::Dark : CircleShade::Bright;
  moving.angular_rates_rad_s *= speed_factor;
  moving.velocity_m_s *= speed_factor;
  const SyntheticWindow synthetic(burstsOf(moving, std::min(0.02 / speed_factor, 0.05), 0.0, random),
                                  moving.board.circles);
  BoardMotion start = moving.motionAt(0.0);
  start.ideal_from_board = warped(start.ideal_from_board, start.frame,
                                  (PlaneFlow() << 1.2, 0.5, -0.4, -0.9, 0.3, 0.5, 0, 0).finished());
  start.velocity_px_s *= 0.8;
  const TrackingOptions options;
  const auto fit = fitBoardMotion(synthetic.window, start, moving.scene(), options.first_gate_px, options);
  QVERIFY(fit.has_value());
  for (int i = 0; i < moving.board.pointCount(); ++i) {
    const Eigen::Vector2d truth = moving.imageAt(i, 0.0).centre_px;
    const Eigen::Vector2d found = imageOfCircle(fit->ideal_from_board, moving.scene(), i)->centre_px;
    QVERIFY2((found - truth).norm() < 0.02, qPrintable(QString::number((found - truth).norm())));
    const double error_px_s = (fit->velocityAt(truth) - moving.velocityAt(i, 0.0)).norm();
    QVERIFY2(error_px_s < 1.0 * std::max(1.0, speed_factor), qPrintable(QString::number(error_px_s)));
  }
  QVERIFY(std::abs(fit->radius_offset_px) < 0.02);
  QVERIFY(fit->residual_rms_px < 0.02);
}

void TestBoardMotion::fit_measuresRadiusOffset() {
  std::mt19937 random(21);
  const MovingBoard moving;
  MovingBoard larger = moving;
  larger.board.radius_m *= 1.05;
  const SyntheticWindow synthetic(burstsOf(larger, 0.02, 0.0, random));
  const TrackingOptions options;
  const auto fit =
      fitBoardMotion(synthetic.window, moving.motionAt(0.0), moving.scene(), options.first_gate_px, options);
  QVERIFY(fit.has_value());
  const double expected_px = 0.05 * moving.imageAt(21, 0.0).max_radius_px;
  QVERIFY2(std::abs(fit->radius_offset_px - expected_px) < 0.05,
           qPrintable(QString::number(fit->radius_offset_px)));
}

void TestBoardMotion::fit_withoutBursts_isNothing() {
  const MovingBoard moving;
  const SyntheticWindow synthetic({});
  const TrackingOptions options;
  QVERIFY(!fitBoardMotion(synthetic.window, moving.motionAt(0.0), moving.scene(), options.first_gate_px,
                          options));
}

}  // namespace

EVICAL_TEST(TestBoardMotion)
#include "tst_board_motion.moc"
