#include "core/frontend/board_search.h"

#include "tests/core/frontend/synthetic_bursts.h"
#include "tests/support/processor_time.h"
#include "tests/support/test_program.h"

namespace {

using namespace evical;
using namespace evical::test;

// A board that moves through the image for a while.
const BurstHistory& history() {
  static const BurstHistory all = [] {
    std::mt19937 random(5);
    BurstHistory bursts;
    bursts.add(burstsOf(MovingBoard(), 0.08, 0.1, random));
    return bursts;
  }();
  return all;
}

class TestBoardSearch : public QObject {
  Q_OBJECT
 private slots:
  void board_isFoundWhereItIs_data();
  void board_isFoundWhereItIs();
  void ended_isTheStageThatFailed_data();
  void ended_isTheStageThatFailed();
  void otherSource_isTriedWhereTheFirstFails();
  void muchTooLargeBoard_isSearchedInBoundedTime();
  void windows_areNoLongerThanTheReach();
  void flowAround_seesWhatASearchSees();
};

void TestBoardSearch::board_isFoundWhereItIs_data() {
  QTest::addColumn<int>("method");
  QTest::newRow("ring vote") << static_cast<int>(CandidateSource::RingVote);
  QTest::newRow("normal flow") << static_cast<int>(CandidateSource::NormalFlow);
}

void TestBoardSearch::board_isFoundWhereItIs() {
  QFETCH(int, method);
  FrontEndOptions options;
  options.detection.method = static_cast<CandidateSource>(method);
  const MovingBoard moving;
  const std::vector<BoardSearch> searches = searchBoard(history(), 0, moving.scene(), options);
  QCOMPARE(searches.size(), std::size_t{1});
  const BoardSearch& search = searches.front();
  QCOMPARE(search.source, options.detection.method);
  QCOMPARE(search.ended, SearchStage::Done);
  QCOMPARE(search.outcome, WindowOutcome::Complete);
  for (const int circle : {0, 21, 43}) {
    const auto found = imageOfCircle(search.motion->ideal_from_board, moving.scene(), circle);
    QVERIFY((found->centre_px - moving.imageAt(circle, 0.0).centre_px).norm() < 0.1);
  }
}

void TestBoardSearch::ended_isTheStageThatFailed_data() {
  QTest::addColumn<QString>("what");
  QTest::addColumn<int>("stage");
  QTest::addColumn<int>("outcome");
  const auto row = [](const char* what, SearchStage stage, WindowOutcome outcome) {
    QTest::newRow(what) << QString(what) << static_cast<int>(stage) << static_cast<int>(outcome);
  };
  row("bursts", SearchStage::Bursts, WindowOutcome::TooFewEvents);
  row("circles", SearchStage::Circles, WindowOutcome::TooFewCircles);
  row("lattice", SearchStage::Lattice, WindowOutcome::NoLattice);
  row("placement", SearchStage::Placement, WindowOutcome::NoLattice);
  row("joint fit", SearchStage::JointFit, WindowOutcome::RefinementFailed);
}

void TestBoardSearch::ended_isTheStageThatFailed() {
  QFETCH(QString, what);
  QFETCH(int, stage);
  QFETCH(int, outcome);
  FrontEndOptions options;
  options.detection.try_both = false;
  BoardScene scene = MovingBoard().scene();
  if (what == "bursts") options.detection.min_window_bursts = 100000;
  if (what == "circles") options.grid.min_circles = 500;
  if (what == "lattice") options.grid.max_step_radii = 2.1;
  if (what == "placement") {
    // A camera whose image has no square lattice.
    CameraIntrinsics camera;
    camera.resolution_px = kDavis_px;
    camera.focal_length_px = {260.0, 520.0};
    camera.principal_point_px = {172.5, 129.5};
    scene = BoardScene(scene.board, kDavis_px, camera);
  }
  if (what == "joint fit") options.tracking.first_gate_px = 0.0;
  const std::vector<BoardSearch> searches = searchBoard(history(), 0, scene, options);
  QCOMPARE(searches.size(), std::size_t{1});
  QCOMPARE(static_cast<int>(searches.front().ended), stage);
  QCOMPARE(static_cast<int>(searches.front().outcome), outcome);
  QVERIFY(!searches.front().motion);
}

void TestBoardSearch::otherSource_isTriedWhereTheFirstFails() {
  FrontEndOptions options;
  options.detection.method = CandidateSource::NormalFlow;
  options.normal_flow.min_cluster_px = 10000;
  const std::vector<BoardSearch> both = searchBoard(history(), 0, MovingBoard().scene(), options);
  QCOMPARE(both.size(), std::size_t{2});
  QCOMPARE(both[0].source, CandidateSource::NormalFlow);
  QCOMPARE(both[0].ended, SearchStage::Circles);
  QCOMPARE(both[1].source, CandidateSource::RingVote);
  QCOMPARE(both[1].ended, SearchStage::Done);
  options.detection.try_both = false;
  QCOMPARE(searchBoard(history(), 0, MovingBoard().scene(), options).size(), std::size_t{1});
}

// It has dozens of placements on the same circles, which must not be fitted one by one: a recording of 10 s
// took minutes for its message. A search that fails takes all lengths of windows: some 40 times one that
// finds the board.
void TestBoardSearch::muchTooLargeBoard_isSearchedInBoundedTime() {
  FrontEndOptions options;
  const BoardScene given = MovingBoard().scene();
  Board large = given.board;
  large.cols = 25;
  const BoardScene scene(large, kDavis_px, given.camera);
  const auto searched_s = [&](const BoardScene& searched, bool found) {
    const double begin_s = processCpu_s();
    const std::vector<BoardSearch> searches = searchBoard(history(), 0, searched, options);
    if (searches.back().motion.has_value() != found) return -1.0;
    return (processCpu_s() - begin_s) / static_cast<double>(searches.size());
  };
  const double right_s = searched_s(given, true), wrong_s = searched_s(scene, false);
  QVERIFY(right_s > 0.0 && wrong_s > 0.0);
  QVERIFY2(wrong_s < 80.0 * right_s, qPrintable(QString("%1 s, %2 s").arg(right_s).arg(wrong_s)));
}

// If hardly anything moves, edges count as the slowest possible ones.
void TestBoardSearch::windows_areNoLongerThanTheReach() {
  FrontEndOptions options;
  options.detection.try_both = false;
  const BoardScene scene = MovingBoard().scene();
  QCOMPARE(searchBoard(BurstHistory{}, 0, scene, options).front().half_window_s, kSearchReach_s);
  QCOMPARE(flowAround(BurstHistory{}, 0, std::nullopt, scene, options).half_window_s, kSearchReach_s);
}

void TestBoardSearch::flowAround_seesWhatASearchSees() {
  FrontEndOptions options;
  const BoardScene scene = MovingBoard().scene();
  const BoardSearch search = searchBoard(history(), 0, scene, options).front();
  const FlowAround first = flowAround(history(), 0, std::nullopt, scene, options);
  const FlowAround same = flowAround(history(), 0, search.half_window_s, scene, options);
  QCOMPARE(same.half_window_s, search.half_window_s);
  QCOMPARE(same.arcs.pairs.size(), search.candidates.size());
  QCOMPARE(first.half_window_s, search.half_window_s);  // found at once
  QCOMPARE(first.arcs.flow.size(), same.arcs.flow.size());
}

}  // namespace

EVICAL_TEST(TestBoardSearch)
#include "tst_board_search.moc"
