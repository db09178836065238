#include "core/frontend/ring_vote.h"

#include "tests/core/frontend/synthetic_bursts.h"
#include "tests/support/test_program.h"

namespace {

using namespace evical;
using namespace evical::test;

constexpr double kRingVoteHalfWindow_s = 0.015;

class TestRingVote : public QObject {
  Q_OBJECT
 private slots:
  void circle_isFoundAtItsPlace_data();
  void circle_isFoundAtItsPlace();
  void wrongShade_pointsBackwards();
  void noise_givesFewCandidates();
  void unsupportedBursts_areDropped();
};

void TestRingVote::circle_isFoundAtItsPlace_data() {
  QTest::addColumn<double>("radius_px");
  QTest::addColumn<bool>("dark");
  for (const double radius_px : {3.0, 5.0, 8.0, 13.0, 20.0, 35.0, 60.0}) {
    for (const bool dark : {true, false})
      QTest::addRow("%s, radius %.0f px", dark ? "dark" : "bright", radius_px) << radius_px << dark;
  }
}

void TestRingVote::circle_isFoundAtItsPlace() {
  QFETCH(double, radius_px);
  QFETCH(bool, dark);
  const CircleShade shade = dark ? CircleShade::Dark : CircleShade::Bright;
  std::mt19937 random(6);
  const SyntheticCircle circle = {{160.3, 121.8}, {70.0, -45.0}, radius_px};
  std::vector<EdgeCrossing> bursts;
  addBursts(circle, kRingVoteHalfWindow_s, shade, 0.15, random, bursts);
  addRandomBursts(100, kRingVoteHalfWindow_s, random, bursts);
  const SyntheticWindow synthetic(bursts, shade);
  const std::vector<CircleCandidate> candidates = voteForCircles(synthetic.window, FrontEndOptions{});
  QVERIFY(!candidates.empty());
  const CircleCandidate& best = candidates.front();
  // The tolerance of the first gate of the moving-circle fit.
  const double tolerance_px = std::max(1.5, 0.1 * radius_px);
  QVERIFY2((best.centre_px - circle.centre_px).norm() < tolerance_px,
           qPrintable(QString("at %1, %2").arg(best.centre_px.x()).arg(best.centre_px.y())));
  QVERIFY2(std::abs(best.radius_px - radius_px) < tolerance_px, qPrintable(QString::number(best.radius_px)));
  QVERIFY(best.direction.dot(circle.velocity_px_s.normalized()) > 0.95);
}

void TestRingVote::wrongShade_pointsBackwards() {
  std::mt19937 random(7);
  const SyntheticCircle circle = {{160.0, 120.0}, {80.0, 0.0}, 10.0};
  std::vector<EdgeCrossing> bursts;
  addBursts(circle, kRingVoteHalfWindow_s, CircleShade::Bright, 0.1, random, bursts);
  const SyntheticWindow synthetic(bursts, CircleShade::Dark);
  const std::vector<CircleCandidate> candidates = voteForCircles(synthetic.window, FrontEndOptions{});
  QVERIFY(!candidates.empty());
  QVERIFY(candidates.front().direction.x() < -0.9);
}

void TestRingVote::noise_givesFewCandidates() {
  std::mt19937 random(8);
  std::vector<EdgeCrossing> bursts;
  addRandomBursts(2000, kRingVoteHalfWindow_s, random, bursts);  // 2 % of the pixels
  keepSupported(kDavis_px, RingVoteOptions{}.min_support, bursts);
  const SyntheticWindow synthetic(bursts);
  QVERIFY(voteForCircles(synthetic.window, FrontEndOptions{}).size() < 20u);
}

void TestRingVote::unsupportedBursts_areDropped() {
  std::vector<EdgeCrossing> bursts = {
      burstAt(0, 0, 0.0, true),     burstAt(1, 0, 0.0, true),
      burstAt(0, 1, 0.0, true),     burstAt(1, 1, 0.0, false),  // of the other polarity
      burstAt(345, 259, 0.0, true), burstAt(344, 258, 0.0, true)};
  keepSupported(kDavis_px, 3, bursts);
  QCOMPARE(bursts.size(), 3u);
  for (const EdgeCrossing& burst : bursts) QVERIFY(burst.brighter && burst.x_px < 2);
}

}  // namespace

EVICAL_TEST(TestRingVote)
#include "tst_ring_vote.moc"
