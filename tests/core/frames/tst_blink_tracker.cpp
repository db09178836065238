// Flashing boards of every kind, with events of pixels of different thresholds: their views against the
// truth.
#include "core/base/error.h"
#include "core/frames/blink_tracker.h"
#include "core/frames/corner_measurement.h"
#include "core/frames/views_from_frames.h"
#include "core/geometry/camera_model.h"
#include "tests/support/rendered_board.h"
#include "tests/support/test_program.h"

#include <opencv2/aruco.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using namespace evical;

constexpr double kRate_hz = 20.0;

CameraIntrinsics aCameraForBlinkTracker() {
  CameraIntrinsics camera;
  camera.resolution_px = {240, 180};
  camera.focal_length_px = {200.0, 199.0};
  camera.principal_point_px = {118.0, 92.0};
  camera.distortion = {-0.2, 0.05, 0.0, 0.0, 0.0};
  return camera;
}

PrintedBoard boardOfBlinkTracker(BoardType type, int rows, int cols, double spacing_m, double radius_m,
                                 double tag_size_m) {
  PrintedBoard printed;
  printed.board.type = type;
  printed.board.rows = rows;
  printed.board.cols = cols;
  printed.board.spacing_m = spacing_m;
  printed.board.radius_m = radius_m;
  printed.board.tag_size_m = tag_size_m;
  printed.dictionary = cv::aruco::DICT_4X4_50;
  return printed;
}

PrintedBoard checkerboardForBlinkTracker() {
  return boardOfBlinkTracker(BoardType::Checkerboard, 6, 9, 0.06, 0.0, 0.0);
}

// Pixels fire at steps of log intensity with individual thresholds, in bursts when the light switches.
class Flashes {
 public:
  Flashes(const PrintedBoard& printed, Flashing flashing) : printed_(printed), flashing_(flashing) {
    std::normal_distribution<double> normal;
    const int pixels = aCameraForBlinkTracker().resolution_px.pixelCount();
    for (int k = 0; k < pixels; ++k) steps_.push_back(0.3 * (1.0 + 0.1 * normal(random_)));
  }

  // Simulates this many half periods, seen from this pose.
  void show(const RigidTransform& camera_from_board, int half_periods, std::vector<Event>& events) {
    Exposure exposure;
    exposure.noise = 0.0;
    const CameraIntrinsics camera = aCameraForBlinkTracker();
    const GrayImage seen = renderBoard(printed_, camera, camera_from_board, exposure);
    const double plain = flashing_ == Flashing::Ink ? exposure.bright : exposure.dark;
    std::uniform_real_distribution<double> part(0.0, 1.0);
    for (int k = 0; k < half_periods; ++k, ++half_periods_) {
      const auto begin = static_cast<std::ptrdiff_t>(events.size());
      for (std::size_t pixel = 0; pixel < seen.pixels.size(); ++pixel) {
        const double change = std::abs(std::log(seen.pixels[pixel] / plain)) / steps_[pixel];
        const int count = static_cast<int>(change + part(random_));
        for (int n = 0; n < count; ++n)
          events.push_back(
              {static_cast<std::int64_t>(1e9 * (0.5 * half_periods_ / kRate_hz + 1e-3 * (n + part(random_)))),
               static_cast<std::uint16_t>(pixel % 240), static_cast<std::uint16_t>(pixel / 240),
               half_periods_ % 2 == 0});
      }
      std::sort(events.begin() + begin, events.end(),
                [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; });
    }
  }

 private:
  PrintedBoard printed_;
  Flashing flashing_;
  std::mt19937 random_{7};
  std::vector<double> steps_;
  int half_periods_ = 0;
};

struct BlinkTrackerErrors {
  int found = 0, wrong = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double squares = 0.0, stated = 0.0;
  double rms_px() const { return std::sqrt(squares / (2.0 * found)); }
  double sigma_px() const { return std::sqrt(stated / found); }
};

// Points of a view are matched by position: on a board with rotational symmetry, they may be numbered from
// either end.
void compareForBlinkTracker(const BoardView& view, const Board& board, const RigidTransform& pose,
                            BlinkTrackerErrors& errors) {
  for (const CircleObservation& point : view.circles) {
    Eigen::Vector2d nearest = Eigen::Vector2d::Constant(1e9);
    for (int k = 0; k < board.pointCount(); ++k)
      if (const auto truth = truePoint(board, k, aCameraForBlinkTracker(), pose))
        if ((*truth - point.centre_px).norm() < nearest.norm()) nearest = *truth - point.centre_px;
    if (nearest.norm() > 1.5) {
      ++errors.wrong;
      continue;
    }
    ++errors.found;
    errors.sum += nearest;
    errors.squares += nearest.squaredNorm();
    errors.stated += 0.5 * point.covariance_px2.trace();
  }
}

BoardObservations track(const Board& board, const std::vector<Event>& events) {
  BlinkTracker tracker("camera", board, aCameraForBlinkTracker().resolution_px, FrameOptions{},
                       BlinkOptions{}, 0);
  for (std::size_t k = 0; k < events.size(); k += 5000)
    tracker.add(EventSpan(events).subspan(k, std::min<std::size_t>(5000, events.size() - k)));
  return tracker.finish();
}

class TestBlinkTracker : public QObject {
  Q_OBJECT
 private slots:
  void boardOfAnyKind_isFoundWithoutBias_data();
  void boardOfAnyKind_isFoundWithoutBias();
  void boardThatStandsStill_isOneView();
  void boardThatMoves_isSeenWhereItIsAtTheTime();
  void partOfACheckerboard_isEnough_data();
  void partOfACheckerboard_isEnough();
  void largerCheckerboardThanSaid_isDoubted();
  void sceneThatDoesNotBlink_isRefused();
  void fewEvents_showNothing();
  void saddle_isAtTheCornerWhateverTheTones();
  void viewsCountedOtherwise_areJoined();
};

void TestBlinkTracker::boardOfAnyKind_isFoundWithoutBias_data() {
  QTest::addColumn<PrintedBoard>("printed");
  QTest::addColumn<double>("distance_m");
  QTest::addColumn<Flashing>("flashing");
  const PrintedBoard circles = boardOfBlinkTracker(BoardType::AsymmetricCircles, 7, 4, 0.05, 0.02, 0.0),
                     grid = boardOfBlinkTracker(BoardType::AprilGrid, 2, 3, 0.13, 0.0, 0.1),
                     charuco = boardOfBlinkTracker(BoardType::Charuco, 4, 6, 0.08, 0.0, 0.05);
  for (const auto& [flashing, name] :
       {std::pair{Flashing::Ink, "ink"}, std::pair{Flashing::Paper, "paper"}}) {
    QTest::addRow("checkerboard, %s", name) << checkerboardForBlinkTracker() << 0.75 << flashing;
    QTest::addRow("circles, %s", name) << circles << 0.55 << flashing;
    QTest::addRow("aprilgrid, %s", name) << grid << 0.5 << flashing;
    QTest::addRow("charuco, %s", name) << charuco << 0.6 << flashing;
    PrintedBoard rotated = charuco;
    rotated.clockwise_turns = 1;
    QTest::addRow("charuco, rotated markers, %s", name) << rotated << 0.6 << flashing;
    rotated = grid;
    rotated.clockwise_turns = 2;
    QTest::addRow("aprilgrid, rotated tags, %s", name) << rotated << 0.5 << flashing;
  }
}

void TestBlinkTracker::boardOfAnyKind_isFoundWithoutBias() {
  QFETCH(const PrintedBoard, printed);
  QFETCH(const double, distance_m);
  QFETCH(const Flashing, flashing);
  BlinkTrackerErrors errors;
  int views = 0;
  for (const Eigen::Vector3d& turn : {Eigen::Vector3d(0.2, -0.1, 0.05), Eigen::Vector3d(-0.3, 0.2, -0.2),
                                      Eigen::Vector3d(0.1, 0.35, 0.3)}) {
    const RigidTransform pose = lookAt(printed.board, distance_m, turn, {0.01, 0.004});
    std::vector<Event> events;
    Flashes(printed, flashing).show(pose, 16, events);
    const BoardObservations seen = track(printed.board, events);
    views += static_cast<int>(seen.views.size());
    for (const BoardView& view : seen.views) compareForBlinkTracker(view, printed.board, pose, errors);
  }
  QCOMPARE(views, 3);
  QVERIFY(errors.wrong == 0);
  QVERIFY2(errors.found >= 0.85 * 3 * printed.board.pointCount(), QByteArray::number(errors.found));
  const Eigen::Vector2d bias = errors.sum / errors.found;
  qInfo("%d points, %.3f px RMS, %.3f stated, bias %.3f %.3f px", errors.found, errors.rms_px(),
        errors.sigma_px(), bias.x(), bias.y());
  // Half a pixel of the enlarged picture, three times as large, would be 0.17 px in x and y.
  QVERIFY2(bias.norm() < 0.06, QByteArray::number(bias.norm()));
  QVERIFY2(errors.rms_px() < 0.2, QByteArray::number(errors.rms_px()));
  QVERIFY2(errors.rms_px() < 2.0 * errors.sigma_px(), QByteArray::number(errors.sigma_px()));
}

void TestBlinkTracker::boardThatStandsStill_isOneView() {
  std::vector<Event> events;
  Flashes flashes(checkerboardForBlinkTracker(), Flashing::Ink);
  flashes.show(lookAt(checkerboardForBlinkTracker().board, 0.75, {0.2, 0.1, 0.0}), 30, events);
  flashes.show(lookAt(checkerboardForBlinkTracker().board, 0.75, {-0.2, 0.1, 0.0}), 30, events);
  const BoardObservations seen = track(checkerboardForBlinkTracker().board, events);
  QCOMPARE(static_cast<int>(seen.views.size()), 2);
  QVERIFY(seen.windows.size() > 10);
  QVERIFY(std::abs(seen.views.front().time_s - 0.375) < 0.1);
}

// 8 px/s: during a slot of two half periods it moves by 0.8 px, and only one of them may be used.
void TestBlinkTracker::boardThatMoves_isSeenWhereItIsAtTheTime() {
  const Board board = checkerboardForBlinkTracker().board;
  constexpr double kSpeed_m_s = 0.03, kDistance_m = 0.75;
  const auto poseAt = [&](double time_s) {
    return lookAt(board, kDistance_m, {0.2, 0.1, 0.0}, {kSpeed_m_s * time_s, 0.0});
  };
  std::vector<Event> events;
  Flashes flashes(checkerboardForBlinkTracker(), Flashing::Ink);
  for (int half = 0; half < 60; ++half) flashes.show(poseAt(0.5 * half / kRate_hz), 1, events);
  const BoardObservations seen = track(board, events);
  QVERIFY2(seen.views.size() >= 10, QByteArray::number(static_cast<int>(seen.views.size())));
  for (const BoardView& view : seen.views) {
    BlinkTrackerErrors errors;
    compareForBlinkTracker(view, board, poseAt(view.time_s), errors);
    QVERIFY(errors.found > 40);
    // Flashes take a few ms at the beginning of a half period: the view's time is up to half of one earlier.
    QVERIFY2(std::abs(errors.sum.x() / errors.found) < 8.0 * 0.5 / kRate_hz,
             QByteArray::number(errors.sum.x()));
  }
}

void TestBlinkTracker::partOfACheckerboard_isEnough_data() {
  QTest::addColumn<int>("rows");
  QTest::addColumn<int>("cols");
  QTest::newRow("a row and a column are missing") << 7 << 10;
  QTest::newRow("said the other way round") << 10 << 7;
  QTest::newRow("odd and odd") << 7 << 9;
  QTest::newRow("a column is missing") << 6 << 10;
}

void TestBlinkTracker::partOfACheckerboard_isEnough() {
  QFETCH(const int, rows);
  QFETCH(const int, cols);
  const RigidTransform pose = lookAt(checkerboardForBlinkTracker().board, 0.75, {0.2, 0.1, 0.1});
  std::vector<Event> events;
  Flashes(checkerboardForBlinkTracker(), Flashing::Ink).show(pose, 16, events);
  Board said = checkerboardForBlinkTracker().board;
  said.rows = rows;
  said.cols = cols;
  const BoardObservations seen = track(said, events);
  QCOMPARE(static_cast<int>(seen.views.size()), 1);
  BlinkTrackerErrors errors;
  compareForBlinkTracker(seen.views.front(), checkerboardForBlinkTracker().board, pose, errors);
  QVERIFY2(errors.found >= 0.9 * checkerboardForBlinkTracker().board.pointCount(),
           QByteArray::number(errors.found));
  QCOMPARE(errors.wrong, 0);
  // Neighbours in the image are neighbours on the board, in squares of its size.
  const auto& points = seen.views.front().circles;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const double on_board_m = (said.point_m(points[k].circle) - said.point_m(points[k - 1].circle)).norm();
    if (std::abs(on_board_m - said.spacing_m) > 1e-9) continue;
    const double apart_px = (points[k].centre_px - points[k - 1].centre_px).norm();
    QVERIFY2(apart_px > 10.0 && apart_px < 22.0, QByteArray::number(apart_px));
  }
}

void TestBlinkTracker::largerCheckerboardThanSaid_isDoubted() {
  std::vector<Event> events;
  Flashes(checkerboardForBlinkTracker(), Flashing::Ink)
      .show(lookAt(checkerboardForBlinkTracker().board, 0.75, {0.2, 0.1, 0.1}), 16, events);
  Board said = checkerboardForBlinkTracker().board;
  said.rows = 4;
  said.cols = 5;
  BlinkTracker tracker("camera", said, aCameraForBlinkTracker().resolution_px, FrameOptions{}, BlinkOptions{},
                       0);
  tracker.add(events);
  tracker.finish();
  const QString doubt = QString::fromStdString(tracker.doubt());
  QVERIFY2(doubt.contains("6 x 9") || doubt.contains("9 x 6"), qPrintable(doubt));
}

void TestBlinkTracker::sceneThatDoesNotBlink_isRefused() {
  std::mt19937 random(1);
  std::vector<Event> events;
  for (int k = 0; k < 100'000; ++k)
    events.push_back({k * 20'000, static_cast<std::uint16_t>(random() % 240),
                      static_cast<std::uint16_t>(random() % 180), random() % 2 == 0});
  try {
    track(checkerboardForBlinkTracker().board, events);
    QFAIL("accepted");
  } catch (const CalibrationError& error) {
    QVERIFY(error.kind() == ErrorKind::CalibrationFailed);
    QVERIFY2(QString(error.what()).contains("no blinking"), error.what());
    QVERIFY2(QString(error.what()).contains("evical board --blink"), error.what());
  }
}

void TestBlinkTracker::fewEvents_showNothing() {
  QVERIFY_THROWS_EXCEPTION(CalibrationError, track(checkerboardForBlinkTracker().board, {}));
  QVERIFY_THROWS_EXCEPTION(CalibrationError,
                           track(checkerboardForBlinkTracker().board, {Event{0, 1, 1, true}}));
}

void TestBlinkTracker::saddle_isAtTheCornerWhateverTheTones() {
  const PrintedBoard printed = checkerboardForBlinkTracker();
  const RigidTransform pose = lookAt(printed.board, 0.75, {0.1, -0.2, 0.1});
  Exposure exposure;
  exposure.noise = 0.0;
  GrayImage image = renderBoard(printed, aCameraForBlinkTracker(), pose, exposure);
  for (std::uint8_t& pixel : image.pixels)  // nonlinear, due to the logarithm
    pixel = static_cast<std::uint8_t>(std::lround(255.0 * std::log(pixel / 30.0) / std::log(230.0 / 30.0)));
  for (int k = 0; k < printed.board.pointCount(); ++k) {
    const Eigen::Vector2d truth = *truePoint(printed.board, k, aCameraForBlinkTracker(), pose);
    const auto corner = measureSaddle(image, truth + Eigen::Vector2d(0.6, -0.4), 1.5, 3.0, 3.0, 1.0);
    QVERIFY(corner);
    QVERIFY2((corner->at_px - truth).norm() < 0.08, QByteArray::number((corner->at_px - truth).norm()));
    QVERIFY(corner->covariance_px2(0, 0) > 0.0 && corner->covariance_px2(0, 0) < 0.01);
  }
  QVERIFY(!measureSaddle(image, {2.0, 2.0}, 1.5, 3.0, 3.0, 1.0));  // runs out of the picture
}

void TestBlinkTracker::viewsCountedOtherwise_areJoined() {
  PointsInFrame first{0.0, 0.0, {}}, turned{0.1, 0.0, {}}, elsewhere{0.2, 0.0, {}};
  for (int k = 0; k < 12; ++k) {
    FoundPoint point;
    point.point = k;
    point.at_px = Eigen::Vector2d(10.0 * (k % 4), 10.0 * (k / 4));
    point.covariance_px2 = 0.02 * Eigen::Matrix2d::Identity();
    first.points.push_back(point);
    point.at_px.x() += 0.2;
    point.point = 11 - k;
    turned.points.insert(turned.points.begin(), point);
    point.at_px.x() += 3.0;
    elsewhere.points.insert(elsewhere.points.begin(), point);
  }
  const std::vector<PointsInFrame> joined = joinedWhileStill({first, turned, elsewhere}, 0.5, 0.1);
  QCOMPARE(static_cast<int>(joined.size()), 2);
  QCOMPARE(static_cast<int>(joined.front().points.size()), 12);
  QVERIFY((joined.front().points.front().at_px - Eigen::Vector2d(0.1, 0.0)).norm() < 1e-9);
  QVERIFY(std::abs(joined.front().points.front().covariance_px2(0, 0) - 0.015) < 1e-9);  // 0.01 in common
  QVERIFY(std::abs(joined.front().time_s - 0.05) < 1e-12);
  QVERIFY(std::abs(*movement_px(first.points, first.points)) < 1e-12);
  QVERIFY(!movement_px(first.points, {}));
}

}  // namespace

EVICAL_TEST(TestBlinkTracker)
#include "tst_blink_tracker.moc"
