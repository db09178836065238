#include "core/frontend/edge_crossings.h"
#include "tests/support/test_program.h"

#include <cmath>

namespace {

using namespace evical;

constexpr int kWhole = 9;  // events of a whole crossing, from -4 to 4 around the middle
constexpr bool kRested = true, kTurned = false;

LevelBurst burstOf(bool brighter, int events, bool rested_before, bool rested_after) {
  return {brighter, events, false, rested_before, rested_after};
}

// A pixel that an edge has crossed once in either direction, and that is dark.
PixelLevel knownPixel() {
  PixelLevel level;
  level.pass(burstOf(true, kWhole, kRested, kRested));
  level.pass(burstOf(false, kWhole, kRested, kRested));
  return level;
}

class TestPixelLevel : public QObject {
  Q_OBJECT
 private slots:
  void wholeBurst_isInTheMiddleAtItsMedian();
  void edgeThatTurnsBack_isInTheMiddleWhereWholeBurstsAre();
  void edgeThatTurnedBefore_isInTheMiddleWhereWholeBurstsAre();
  void edgeThatTurnsTwice_keepsTheLevel();
  void edgeThatTurnsBeforeTheMiddle_isNotInIt();
  void singleEvents_areStepsOfTheLevel();
  void unknownPixel_countsAsCrossed();
  void noiseBeforeABurst_leavesTheLevelUnknown();
  void otherEdge_isLearntAnew();
};

void TestPixelLevel::wholeBurst_isInTheMiddleAtItsMedian() {
  PixelLevel level;
  const auto middle = level.pass(burstOf(true, kWhole, kRested, kRested));
  QVERIFY(middle);
  QCOMPARE(middle->event, 4.0);
  QCOMPARE(middle->whole_events, kWhole);
  QCOMPARE(level.pass(burstOf(false, 8, kRested, kRested))->event, 3.5);
}

void TestPixelLevel::edgeThatTurnsBack_isInTheMiddleWhereWholeBurstsAre() {
  PixelLevel level = knownPixel();
  const auto towards = level.pass(burstOf(true, 7, kRested, kTurned));
  QVERIFY(towards);
  QCOMPARE(towards->event, 4.0);  // the fifth event, not the fourth as in the middle of seven
  QCOMPARE(towards->whole_events, kWhole);
  const auto back = level.pass(burstOf(false, 7, kTurned, kRested));
  QVERIFY(back);
  QCOMPARE(back->event, 2.0);  // the fifth from the end
  QCOMPARE(back->whole_events, kWhole);
}

void TestPixelLevel::edgeThatTurnedBefore_isInTheMiddleWhereWholeBurstsAre() {
  PixelLevel level = knownPixel();
  level.pass(burstOf(true, 3, kRested, kTurned));
  level.pass(burstOf(false, 1, kTurned, kTurned));
  const auto middle = level.pass(burstOf(true, 7, kTurned, kRested));
  QVERIFY(middle);
  QCOMPARE(middle->event, 2.0);
}

void TestPixelLevel::edgeThatTurnsTwice_keepsTheLevel() {
  PixelLevel level = knownPixel();
  level.pass(burstOf(true, 6, kRested, kTurned));
  level.pass(burstOf(false, 3, kTurned, kTurned));
  const auto middle = level.pass(burstOf(true, 5, kTurned, kTurned));  // from the third event to the eighth
  QVERIFY(middle);
  QVERIFY2(std::abs(middle->event - 1.0) < 1e-5, qPrintable(QString::number(middle->event)));
}

void TestPixelLevel::edgeThatTurnsBeforeTheMiddle_isNotInIt() {
  PixelLevel level = knownPixel();
  QVERIFY(!level.pass(burstOf(true, 4, kRested, kTurned)));
  QVERIFY(!level.pass(burstOf(false, 4, kTurned, kRested)));
  QVERIFY(level.pass(burstOf(true, kWhole, kRested, kRested)));
}

void TestPixelLevel::singleEvents_areStepsOfTheLevel() {
  PixelLevel level = knownPixel();
  level.pass(burstOf(true, 6, kRested, kTurned));
  level.step(false, 1);
  level.pass(burstOf(true, 2, kTurned, kTurned));  // to the seventh
  const auto middle = level.pass(burstOf(false, 5, kTurned, kTurned));
  QVERIFY(middle);
  QVERIFY2(std::abs(middle->event - 2.0) < 1e-5, qPrintable(QString::number(middle->event)));
}

void TestPixelLevel::unknownPixel_countsAsCrossed() {
  PixelLevel level;
  const auto middle = level.pass(burstOf(true, 5, kTurned, kTurned));
  QVERIFY(middle);
  QCOMPARE(middle->event, 2.0);
  QCOMPARE(middle->whole_events, 5);
}

void TestPixelLevel::noiseBeforeABurst_leavesTheLevelUnknown() {
  PixelLevel level = knownPixel();
  const auto middle = level.pass({true, 7, true, kTurned, kTurned});
  QVERIFY(middle);
  QCOMPARE(middle->whole_events, 7);  // so few that the board's fit does not count it
}

void TestPixelLevel::otherEdge_isLearntAnew() {
  PixelLevel level = knownPixel();
  level.pass(burstOf(true, 5, kRested, kRested));
  level.pass(burstOf(false, 5, kRested, kRested));
  const auto middle = level.pass(burstOf(true, 4, kRested, kTurned));
  QVERIFY(middle);
  QCOMPARE(middle->event, 2.0);
  QCOMPARE(middle->whole_events, 5);
}

}  // namespace

EVICAL_TEST(TestPixelLevel)
#include "tst_pixel_level.moc"
