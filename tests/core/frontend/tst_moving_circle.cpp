#include "core/frontend/moving_circle.h"

#include "tests/core/frontend/synthetic_bursts.h"
#include "tests/support/test_program.h"

namespace {

using namespace evical;
using namespace evical::test;

class TestMovingCircle : public QObject {
  Q_OBJECT
 private slots:
  void fit_recoversCentreVelocityRadius_data();
  void fit_recoversCentreVelocityRadius();
  void fit_withoutNoise_isExact();
  void fit_onNoise_givesNothing();
  void fit_onOneEdgeOnly_givesNothing();
  void overlappingFits_leaveOne();
  void typicalSpeed_isThatOfEdges_data();
  void typicalSpeed_isThatOfEdges();
};

// Long enough for edges to travel 3 px.
double halfWindow_s(const SyntheticCircle& circle) {
  return 1.5 / circle.velocity_px_s.norm();
}

CircleCandidate near(const SyntheticCircle& circle) {
  CircleCandidate candidate;
  candidate.centre_px = circle.centre_px + Eigen::Vector2d(0.7, -0.6);
  candidate.radius_px = 1.06 * circle.radius_px;
  candidate.direction = Eigen::Rotation2Dd(0.2) * circle.velocity_px_s.normalized();
  return candidate;
}

void TestMovingCircle::fit_recoversCentreVelocityRadius_data() {
  QTest::addColumn<double>("radius_px");
  QTest::addColumn<double>("speed_px_s");
  QTest::addColumn<double>("assumed_px_s");
  QTest::newRow("small, slow") << 4.0 << 30.0 << 30.0;
  QTest::newRow("ordinary") << 8.0 << 80.0 << 80.0;
  QTest::newRow("twice as fast as assumed") << 8.0 << 160.0 << 80.0;
  QTest::newRow("half as fast as assumed") << 8.0 << 40.0 << 80.0;
  QTest::newRow("large, fast") << 25.0 << 600.0 << 600.0;
}

void TestMovingCircle::fit_recoversCentreVelocityRadius() {
  QFETCH(double, radius_px);
  QFETCH(double, speed_px_s);
  QFETCH(double, assumed_px_s);
  std::mt19937 random(9);
  const SyntheticCircle circle = {{150.4, 99.7}, Eigen::Vector2d(0.8, -0.6) * speed_px_s, radius_px};
  std::vector<EdgeCrossing> bursts;
  addBursts(circle, halfWindow_s(circle), CircleShade::Dark, 0.2, random, bursts);
  addRandomBursts(600, halfWindow_s(circle), random, bursts);
  const SyntheticWindow synthetic(bursts);
  const auto fit = fitMovingCircle(synthetic.window, near(circle), assumed_px_s, MovingCircleOptions{});
  QVERIFY(fit.has_value());
  // 0.2 px of noise on some 30 bursts and more: 0.2 px is four sigmas of the smallest circle's centre.
  QVERIFY2((fit->centre_px - circle.centre_px).norm() < 0.2,
           qPrintable(QString::number((fit->centre_px - circle.centre_px).norm())));
  QVERIFY(std::abs(fit->radius_px - radius_px) < 0.2);
  QVERIFY2((fit->velocity_px_s - circle.velocity_px_s).norm() < 0.15 * speed_px_s,
           qPrintable(QString::number((fit->velocity_px_s - circle.velocity_px_s).norm() / speed_px_s)));
}

void TestMovingCircle::fit_withoutNoise_isExact() {
  std::mt19937 random(10);
  const SyntheticCircle circle = {{150.4, 99.7}, {60.0, 35.0}, 9.0};
  std::vector<EdgeCrossing> bursts;
  addBursts(circle, halfWindow_s(circle), CircleShade::Dark, 0.0, random, bursts);
  const SyntheticWindow synthetic(bursts);
  const auto fit = fitMovingCircle(synthetic.window, near(circle), 70.0, MovingCircleOptions{});
  QVERIFY(fit.has_value());
  QVERIFY((fit->centre_px - circle.centre_px).norm() < 2e-3);
  QVERIFY((fit->velocity_px_s - circle.velocity_px_s).norm() < 0.2);
  QVERIFY(std::abs(fit->radius_px - circle.radius_px) < 2e-3);
  QVERIFY(fit->rms_px < 0.01);
  QVERIFY(fit->sectors >= 12);
}

void TestMovingCircle::fit_onNoise_givesNothing() {
  std::mt19937 random(11);
  int found = 0;
  for (int k = 0; k < 50; ++k) {
    std::vector<EdgeCrossing> bursts;
    addRandomBursts(1500, 0.02, random, bursts);
    const SyntheticWindow synthetic(bursts);
    found += fitMovingCircle(synthetic.window, near({{150.0, 100.0}, {60.0, 0.0}, 8.0}), 60.0,
                             MovingCircleOptions{})
                 .has_value();
  }
  QVERIFY2(found <= 2, qPrintable(QString::number(found)));
}

void TestMovingCircle::fit_onOneEdgeOnly_givesNothing() {
  std::mt19937 random(12);
  const SyntheticCircle circle = {{150.4, 99.7}, {60.0, 35.0}, 9.0};
  std::vector<EdgeCrossing> bursts;
  addBursts(circle, halfWindow_s(circle), CircleShade::Dark, 0.1, random, bursts);
  std::erase_if(bursts, [](const EdgeCrossing& burst) { return burst.brighter; });
  const SyntheticWindow synthetic(bursts);
  QVERIFY(!fitMovingCircle(synthetic.window, near(circle), 70.0, MovingCircleOptions{}));
}

void TestMovingCircle::overlappingFits_leaveOne() {
  std::mt19937 random(13);
  const SyntheticCircle a = {{100.0, 100.0}, {70.0, 10.0}, 8.0}, b = {{130.0, 100.0}, {70.0, 10.0}, 8.0};
  std::vector<EdgeCrossing> bursts;
  for (const SyntheticCircle& circle : {a, b})
    addBursts(circle, halfWindow_s(a), CircleShade::Dark, 0.1, random, bursts);
  const SyntheticWindow synthetic(bursts);
  CircleCandidate again = near(a);
  again.centre_px += Eigen::Vector2d(-1.0, 1.0);
  const std::vector<MovingCircle> circles =
      fitMovingCircles(synthetic.window, {near(a), again, near(b)}, 70.0, MovingCircleOptions{});
  QCOMPARE(circles.size(), 2u);
}

void TestMovingCircle::typicalSpeed_isThatOfEdges_data() {
  QTest::addColumn<double>("speed_px_s");
  for (const double speed_px_s : {40.0, 80.0, 400.0}) QTest::addRow("%.0f px/s", speed_px_s) << speed_px_s;
}

void TestMovingCircle::typicalSpeed_isThatOfEdges() {
  QFETCH(double, speed_px_s);
  std::mt19937 random(14);
  std::vector<EdgeCrossing> bursts;
  for (int k = 0; k < 12; ++k)
    addBursts({{40.0 + 25.0 * k, 60.0 + 10.0 * k}, {speed_px_s, 0.0}, 9.0}, 0.04, CircleShade::Dark, 0.1,
              random, bursts);
  const SyntheticWindow synthetic(bursts);
  // Edges of circles move along their normals, slower than the circles: by 0.8 in the middle of all.
  const double typical = typicalEdgeSpeed_px_s(synthetic.window);
  QVERIFY2(typical > 0.6 * speed_px_s && typical < 1.2 * speed_px_s, qPrintable(QString::number(typical)));
}

}  // namespace

EVICAL_TEST(TestMovingCircle)
#include "tst_moving_circle.moc"
