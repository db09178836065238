// Checkerboards, AprilGrids and ChArUco boards in simulated events.
#include "core/frontend/board_tracker.h"
#include "core/synthetic/board_truth.h"
#include "core/synthetic/event_simulator.h"
#include "tests/support/test_program.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>

namespace {

using namespace evical;

Board squares(BoardType type) {
  Board board;
  board.type = type;
  board.radius_m = 0.0;
  board.rows = type == BoardType::Charuco ? 5 : 6;
  board.cols = type == BoardType::Checkerboard ? 9 : type == BoardType::AprilGrid ? 6 : 7;
  board.spacing_m = type == BoardType::Checkerboard ? 0.05 : type == BoardType::AprilGrid ? 0.0715 : 0.07;
  board.tag_size_m = type == BoardType::AprilGrid ? 0.055 : type == BoardType::Charuco ? 0.052 : 0.0;
  return board;
}

// A DAVIS346 in front of the board, with clutter behind it.
Scenario davis346Before(const Board& board, const TagPrint& print) {
  Scenario scenario;
  scenario.seed = 11;
  scenario.duration_s = 1.5;
  scenario.board = board;
  scenario.tag_print = print;
  scenario.motion.distance_m = 0.6;
  scenario.motion.roll_rad = 0.0;
  scenario.motion.image_speed_px_s = 70.0;
  SimulatedCamera camera;
  camera.intrinsics.resolution_px = {346, 260};
  camera.intrinsics.focal_length_px = {262.0, 262.0};
  camera.intrinsics.principal_point_px = {172.5, 129.5};
  camera.intrinsics.distortion = {-0.3, 0.08, 0.0, 0.0, 0.0};
  scenario.cameras.push_back(camera);
  scenario.imus.emplace_back();
  return scenario;
}

// The front end's observations of `shown` if the session states this board; and what it noticed about it.
struct Noticed {
  std::string doubt, remark;
};
BoardObservations detect(const Scenario& shown, const Board& stated, Noticed* noticed = nullptr) {
  const CameraIntrinsics& lens = shown.cameras[0].intrinsics;
  BoardTracker tracker(stated, lens.resolution_px, lens, FrontEndOptions(), shown.start_ns);
  simulateEvents(shown, 0, [&](EventSpan span) { tracker.add(span); });
  BoardObservations observations = tracker.finish();
  if (noticed != nullptr) *noticed = {tracker.doubt(), tracker.remark()};
  return observations;
}

double shareOf(const BoardObservations& observations, std::initializer_list<WindowOutcome> outcomes) {
  const auto count =
      std::count_if(observations.windows.begin(), observations.windows.end(), [&](const auto& w) {
        return std::find(outcomes.begin(), outcomes.end(), w.outcome) != outcomes.end();
      });
  return static_cast<double>(count) / std::max(1.0, static_cast<double>(observations.windows.size()));
}

double foundShare(const BoardObservations& observations) {
  return shareOf(observations, {WindowOutcome::Complete, WindowOutcome::Partial});
}

// Errors of corners along the directions in which they are known.
struct CornerErrors {
  double rms_px = 0.0, max_px = 0.0;
  int corners = 0;
};
CornerErrors errorsOf(const Scenario& scenario, const BoardObservations& observations) {
  const SinusoidMotion motion(scenario);
  struct Known {
    Eigen::Vector2d error, lead;  // whitened; zero along unknown directions
    Eigen::Vector2d px, lead_px;  // along known directions
  };
  std::vector<Known> all;
  double directions = 0.0, by_lead = 0.0, leads = 0.0;
  CornerErrors errors;
  for (const BoardView& view : observations.views) {
    for (const CircleObservation& corner : view.circles) {
      const std::vector<TrueCircle> truths = trueBoardView(motion, scenario, 0, corner.time_s);
      const auto truth = std::find_if(truths.begin(), truths.end(),
                                      [&](const TrueCircle& each) { return each.circle == corner.circle; });
      if (truth == truths.end()) continue;
      const Eigen::Vector2d error = corner.centre_px - truth->centre_px;
      const Eigen::Matrix2d whitening =
          corner.covariance_px2.llt().matrixL().solve(Eigen::Matrix2d::Identity());
      const auto known = onlyKnownDirection(corner.covariance_px2);
      directions += known ? 1.0 : 2.0;
      const auto knownPart = [&](const Eigen::Vector2d& of) -> Eigen::Vector2d {
        return known ? Eigen::Vector2d(known->dot(of) * *known) : of;
      };
      const Eigen::Vector2d& lead = corner.edge_localisation_bias_effect;
      all.push_back({whitening * error, whitening * lead, knownPart(error), knownPart(lead)});
      by_lead += all.back().lead.dot(all.back().error);
      leads += all.back().lead.squaredNorm();
      ++errors.corners;
    }
  }
  // Bursts lead their edges by the same length everywhere, which the estimator determines.
  const double lead_px = by_lead / std::max(leads, 1e-12);
  for (const Known& each : all) {
    const double left_px = (each.px - lead_px * each.lead_px).norm();
    errors.rms_px += left_px * left_px;
    errors.max_px = std::max(errors.max_px, left_px);
  }
  errors.rms_px = std::sqrt(errors.rms_px / std::max(directions, 1.0));
  return errors;
}

class TestSquares : public QObject {
  Q_OBJECT
 private slots:
  void board_isFound_data();
  void board_isFound();
  void wrongSession_isNamed_data();
  void wrongSession_isNamed();
  void boardOfOtherSize_isSeen_data();
  void boardOfOtherSize_isSeen();
  void motionAlongOneLine_leavesCornersUnknownAlongIt();
  void singleEvents_showCheckerboard();
};

void TestSquares::board_isFound_data() {
  QTest::addColumn<int>("type");
  QTest::addColumn<int>("border");
  QTest::addColumn<int>("turns");
  QTest::addColumn<QString>("markers");
  QTest::addColumn<int>("order");
  const auto row = [](const char* name, BoardType type, int border, int turns, const char* markers,
                      TagOrder order = TagOrder::RowsUp) {
    QTest::newRow(name) << static_cast<int>(type) << border << turns << QString(markers)
                        << static_cast<int>(order);
  };
  row("checkerboard", BoardType::Checkerboard, 2, 0, kUsualMarkers);
  row("aprilgrid", BoardType::AprilGrid, 2, 0, kUsualMarkers);
  row("aprilgrid, tags turned", BoardType::AprilGrid, 2, 3, kUsualMarkers);
  row("aprilgrid, numbered down", BoardType::AprilGrid, 2, 2, kUsualMarkers, TagOrder::RowsDown);
  row("charuco", BoardType::Charuco, 2, 0, kUsualMarkers);
  row("charuco, 4x4 markers, turned", BoardType::Charuco, 2, 1, "4x4");
}

void TestSquares::board_isFound() {
  QFETCH(int, type);
  QFETCH(int, border);
  QFETCH(int, turns);
  QFETCH(QString, markers);
  QFETCH(int, order);
  const Scenario scenario =
      davis346Before(squares(static_cast<BoardType>(type)), {.border_bits = border,
                                                             .markers = markers.toStdString(),
                                                             .quarter_turns = turns,
                                                             .order = static_cast<TagOrder>(order)});
  Noticed noticed;
  const BoardObservations found = detect(scenario, scenario.board, &noticed);
  QCOMPARE(noticed.remark.empty(), turns == 0 && order == static_cast<int>(TagOrder::RowsUp));
  QCOMPARE(noticed.doubt, std::string());
  QVERIFY(found.windows.size() > 20);
  QVERIFY2(foundShare(found) >= 0.95, qPrintable(QString::number(foundShare(found))));
  const CornerErrors errors = errorsOf(scenario, found);
  QVERIFY(errors.corners > 300);
  QVERIFY2(errors.rms_px < 0.08, qPrintable(QString::number(errors.rms_px)));
  QVERIFY2(errors.max_px < 1.0, qPrintable(QString::number(errors.max_px)));
}

void TestSquares::wrongSession_isNamed_data() {
  QTest::addColumn<int>("first_tag");
  QTest::addColumn<double>("distance_m");
  QTest::addColumn<int>("outcome");
  QTest::newRow("other numbers") << 40 << 0.6 << static_cast<int>(WindowOutcome::OtherPattern);
  QTest::newRow("too far away") << 0 << 1.3 << static_cast<int>(WindowOutcome::TooSmall);
}

void TestSquares::wrongSession_isNamed() {
  QFETCH(int, first_tag);
  QFETCH(double, distance_m);
  QFETCH(int, outcome);
  Scenario scenario = davis346Before(squares(BoardType::AprilGrid), {});
  scenario.motion.distance_m = distance_m;
  Board stated = scenario.board;
  stated.first_tag = first_tag;
  Noticed noticed;
  const BoardObservations found = detect(scenario, stated, &noticed);
  QCOMPARE(foundShare(found), 0.0);
  if (outcome == static_cast<int>(WindowOutcome::OtherPattern)) {
    QVERIFY(shareOf(found, {WindowOutcome::OtherPattern}) > 0.8);
    QVERIFY2(noticed.doubt.starts_with("tags 0 to 35 were detected"), noticed.doubt.c_str());
  }
  Scenario numbered = scenario;
  numbered.board.first_tag = first_tag;
  if (first_tag > 0) QVERIFY(foundShare(detect(numbered, stated)) > 0.95);
}

void TestSquares::boardOfOtherSize_isSeen_data() {
  QTest::addColumn<int>("type");
  QTest::addColumn<int>("more_rows");
  for (const BoardType type : {BoardType::Checkerboard, BoardType::AprilGrid, BoardType::Charuco})
    for (const int more : {-1, 0, 2})
      QTest::addRow("%s, rows %+d", boardTypeName(type), more) << static_cast<int>(type) << more;
}

void TestSquares::boardOfOtherSize_isSeen() {
  QFETCH(int, type);
  QFETCH(int, more_rows);
  const Scenario scenario = davis346Before(squares(static_cast<BoardType>(type)), {});
  Board stated = scenario.board;
  stated.rows += more_rows;
  const BoardExtent extent = detect(scenario, stated).extent;
  QVERIFY(extent.rows.lines_lead >= 3);
  QCOMPARE(extent.rows.lines, scenario.board.lineCount(true));
  if (more_rows > 0) return;
  QVERIFY(extent.rows.beyond_in_view > 0);
  if (more_rows < 0)
    QVERIFY(2 * extent.rows.beyond_seen > extent.rows.beyond_in_view);
  else
    QCOMPARE(extent.rows.beyond_seen, 0);
  QCOMPARE(extent.cols.beyond_seen, 0);
}

void TestSquares::motionAlongOneLine_leavesCornersUnknownAlongIt() {
  Scenario scenario = davis346Before(squares(BoardType::Checkerboard), {});
  scenario.motion.angle_amplitude_rad.setZero();
  scenario.motion.target_amplitude_m = {0.1, 0.0};
  scenario.motion.distance_amplitude_m = 0.0;
  const BoardObservations found = detect(scenario, scenario.board);
  int corners = 0, half_known = 0;
  for (const BoardView& view : found.views)
    for (const CircleObservation& corner : view.circles) {
      ++corners;
      const auto known = onlyKnownDirection(corner.covariance_px2);
      half_known += known && std::abs(known->x()) > 0.9;
    }
  QVERIFY(corners > 100);
  QVERIFY2(half_known > 0.9 * corners, qPrintable(QString("%1 of %2").arg(half_known).arg(corners)));
}

// High thresholds: most edges fire one event at a pixel, as in old sensors.
void TestSquares::singleEvents_showCheckerboard() {
  Scenario scenario = davis346Before(squares(BoardType::Checkerboard), {});
  scenario.cameras[0].pixel.threshold_on = scenario.cameras[0].pixel.threshold_off = 1.2;
  scenario.cameras[0].pixel.threshold_mismatch = 0.1;
  const BoardObservations found = detect(scenario, scenario.board);
  QVERIFY(found.single_events);
  QVERIFY2(foundShare(found) >= 0.6, qPrintable(QString::number(foundShare(found))));
  const CornerErrors errors = errorsOf(scenario, found);
  QVERIFY(errors.corners > 200);
  QVERIFY2(errors.rms_px < 0.4, qPrintable(QString::number(errors.rms_px)));
  QVERIFY2(errors.max_px < 3.0, qPrintable(QString::number(errors.max_px)));
}

}  // namespace

EVICAL_TEST(TestSquares)
#include "tst_squares.moc"
