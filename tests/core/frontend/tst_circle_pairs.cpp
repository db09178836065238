#include "core/frontend/circle_pairs.h"

#include "core/frontend/moving_circle.h"
#include "core/numerics/angles.h"
#include "tests/core/frontend/synthetic_bursts.h"
#include "tests/support/test_program.h"

namespace {

using namespace evical;
using namespace evical::test;

EventCluster cluster(bool leading, ClusterKind kind, const Eigen::Vector2d& centroid_px,
                     double angle_deg = 0.0) {
  EventCluster out;
  out.leading = leading;
  out.kind = kind;
  out.centroid_px = centroid_px;
  const double angle = angle_deg * kRadPerDeg;
  out.direction = {std::cos(angle), std::sin(angle)};
  return out;
}

// A field that gives every cluster a small arc, so that a circle can be fitted.
NormalFlowField arcsOf(std::vector<EventCluster>& clusters) {
  NormalFlowField field;
  for (EventCluster& c : clusters) {
    for (int k = -3; k <= 3; ++k) {
      const Eigen::Vector2d n = Eigen::Rotation2Dd(0.25 * k) * c.direction;
      const Eigen::Vector2d outwards = c.leading ? n : Eigen::Vector2d(-n);
      const Eigen::Vector2d first = c.leading ? c.direction : Eigen::Vector2d(-c.direction);
      const Eigen::Vector2d at = c.centroid_px + 8.0 * (outwards - first);
      c.flows.push_back(static_cast<std::uint32_t>(field.size()));
      field.push_back({static_cast<std::uint16_t>(std::lround(at.x())),
                       static_cast<std::uint16_t>(std::lround(at.y())), c.leading, 0.0f,
                       (80.0 * n.dot(c.direction) * n).cast<float>()});
    }
  }
  return field;
}

std::vector<ArcPair> pair(std::vector<EventCluster> clusters) {
  const NormalFlowField field = arcsOf(clusters);
  return pairClusters(clusters, field, FrontEndOptions{});
}

class TestCirclePairs : public QObject {
  Q_OBJECT
 private slots:
  void circles_areFound_data();
  void circles_areFound();
  void runAndChase_pair();
  void wrongKindsOrDirections_doNotPair();
  void thirdCluster_blocks();
  void nearest_winsMutually();
  void clearKinds_comeFirst();
  void noise_givesFewCandidates();
};

void TestCirclePairs::circles_areFound_data() {
  QTest::addColumn<double>("radius_px");
  QTest::addColumn<double>("speed_px_s");
  QTest::addColumn<bool>("dark");
  QTest::newRow("small") << 4.0 << 60.0 << true;
  QTest::newRow("ordinary") << 8.0 << 60.0 << true;
  QTest::newRow("bright") << 8.0 << 60.0 << false;
  QTest::newRow("slow") << 8.0 << 20.0 << true;
  QTest::newRow("fast") << 8.0 << 600.0 << true;
  QTest::newRow("large") << 30.0 << 150.0 << true;
}

void TestCirclePairs::circles_areFound() {
  QFETCH(double, radius_px);
  QFETCH(double, speed_px_s);
  QFETCH(bool, dark);
  const CircleShade shade = dark ? CircleShade::Dark : CircleShade::Bright;
  std::mt19937 random(70);
  const double half_window_s = 1.75 / speed_px_s;  // edges travel 3.5 px
  std::vector<SyntheticCircle> circles;
  for (int k = 0; k < 3; ++k)
    circles.push_back(
        {{60.3 + 110.0 * k, 90.7 + 30.0 * k}, speed_px_s * Eigen::Vector2d(0.8, -0.6), radius_px});
  std::vector<EdgeCrossing> bursts;
  for (const SyntheticCircle& circle : circles) addBursts(circle, half_window_s, shade, 0.1, random, bursts);
  addRandomBursts(300, half_window_s, random, bursts);
  const SyntheticWindow synthetic(bursts, shade);
  const std::vector<CircleCandidate> found = pairArcs(synthetic.window, FrontEndOptions{});
  for (const SyntheticCircle& circle : circles) {
    const auto hit = std::find_if(found.begin(), found.end(), [&](const CircleCandidate& candidate) {
      return (candidate.centre_px - circle.centre_px).norm() < 1.0;
    });
    QVERIFY(hit != found.end());
    QVERIFY2(std::abs(hit->radius_px - radius_px) < 0.7, qPrintable(QString::number(hit->radius_px)));
    QVERIFY(hit->direction.dot(circle.velocity_px_s) > 0.95 * speed_px_s);
    QVERIFY2(std::abs(hit->speed_px_s / speed_px_s - 1.0) < 0.3,
             qPrintable(QString::number(hit->speed_px_s)));
    // The next stage continues from there.
    const auto fit = fitMovingCircle(synthetic.window, *hit, speed_px_s, MovingCircleOptions{});
    QVERIFY(fit && (fit->centre_px - circle.centre_px).norm() < 0.2);
  }
}

void TestCirclePairs::runAndChase_pair() {
  const std::vector<ArcPair> pairs = pair(
      {cluster(true, ClusterKind::Run, {108.0, 50.0}), cluster(false, ClusterKind::Chase, {92.0, 50.0})});
  QCOMPARE(pairs.size(), 1u);
  QCOMPARE(pairs[0].leading, 0u);
  QCOMPARE(pairs[0].trailing, 1u);
  QVERIFY((pairs[0].circle.centre_px - Eigen::Vector2d(100.0, 50.0)).norm() < 0.5);
  QVERIFY(std::abs(pairs[0].circle.radius_px - 8.0) < 0.5);
}

void TestCirclePairs::wrongKindsOrDirections_doNotPair() {
  const Eigen::Vector2d front(108.0, 50.0), back(92.0, 50.0);
  using enum ClusterKind;
  QVERIFY(pair({cluster(true, Chase, front), cluster(false, Chase, back)}).empty());
  QVERIFY(pair({cluster(true, Run, front), cluster(false, Run, back)}).empty());
  QVERIFY(pair({cluster(true, Run, front), cluster(true, Chase, back)}).empty());
  QVERIFY(
      pair({cluster(true, Run, back), cluster(false, Chase, front)}).empty());  // chased by what it runs from
  QVERIFY(pair({cluster(true, Run, front, 40.0), cluster(false, Chase, back)}).empty());
  QCOMPARE(pair({cluster(true, Run, front, 20.0), cluster(false, Chase, back)}).size(), 1u);
  QCOMPARE(pair({cluster(true, Other, front), cluster(false, Other, back)}).size(), 1u);
}

void TestCirclePairs::thirdCluster_blocks() {
  using enum ClusterKind;
  const EventCluster front = cluster(true, Run, {108.0, 50.0}), back = cluster(false, Chase, {92.0, 50.0});
  QVERIFY(pair({front, back, cluster(true, Other, {101.0, 52.0}, 90.0)}).empty());
  QCOMPARE(pair({front, back, cluster(true, Other, {101.0, 62.0}, 90.0)}).size(), 1u);
}

void TestCirclePairs::nearest_winsMutually() {
  using enum ClusterKind;
  const std::vector<ArcPair> pairs =
      pair({cluster(true, Run, {108.0, 50.0}), cluster(false, Chase, {92.0, 50.0}),
            cluster(true, Run, {158.0, 50.0}), cluster(false, Chase, {142.0, 50.0})});
  QCOMPARE(pairs.size(), 2u);
  for (const ArcPair& p : pairs) QCOMPARE(p.trailing, p.leading + 1);
}

void TestCirclePairs::clearKinds_comeFirst() {
  using enum ClusterKind;
  // The other arc is nearer, to the side, but unambiguous kinds have priority.
  const std::vector<ArcPair> pairs =
      pair({cluster(true, Run, {110.0, 50.0}), cluster(false, Chase, {90.0, 50.0}),
            cluster(false, Other, {101.0, 60.0 - 14.9}, 20.0)});
  QVERIFY(pairs.size() <= 1u);
  const std::vector<ArcPair> apart =
      pair({cluster(true, Run, {110.0, 50.0}), cluster(false, Chase, {90.0, 50.0}),
            cluster(false, Other, {92.0, 41.0}, 20.0)});
  QCOMPARE(apart.size(), 1u);
  QCOMPARE(apart[0].trailing, 1u);
}

void TestCirclePairs::noise_givesFewCandidates() {
  std::mt19937 random(71);
  std::vector<EdgeCrossing> bursts;
  addRandomBursts(20000, 0.02, random, bursts);  // 20 % of the pixels
  const SyntheticWindow synthetic(bursts);
  QVERIFY(pairArcs(synthetic.window, FrontEndOptions{}).size() < 10u);
}

}  // namespace

EVICAL_TEST(TestCirclePairs)
#include "tst_circle_pairs.moc"
