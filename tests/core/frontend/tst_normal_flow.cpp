#include "core/frontend/normal_flow.h"

#include "tests/core/frontend/synthetic_bursts.h"
#include "tests/support/test_program.h"

namespace {

using namespace evical;
using namespace evical::test;

constexpr double kNormalFlowHalfWindow_s = 0.2;

// A straight edge that moves along `normal` at `speed_px_s` through a patch of the image.
std::vector<EdgeCrossing> straightEdge(const Eigen::Vector2d& normal, double speed_px_s, double noise_s,
                                       std::mt19937& random) {
  std::normal_distribution<double> gauss;
  std::vector<EdgeCrossing> bursts;
  for (int y = 80; y < 120; ++y) {
    for (int x = 80; x < 120; ++x) {
      const double time_s =
          normal.dot(Eigen::Vector2d(x - 100, y - 100)) / speed_px_s + noise_s * gauss(random);
      if (std::abs(time_s) < kNormalFlowHalfWindow_s) bursts.push_back(burstAt(x, y, time_s, false));
    }
  }
  return bursts;
}

NormalFlowField flowOf(const std::vector<EdgeCrossing>& bursts, const NormalFlowOptions& options = {}) {
  const SyntheticWindow synthetic(bursts);
  return estimateNormalFlow(ActiveEventSurface(synthetic.window, options.plane_radius_px), options);
}

class TestNormalFlow : public QObject {
  Q_OBJECT
 private slots:
  void surface_keepsTheLastPerPolarity();
  void surface_hasABorder();
  void plane_isRecovered_data();
  void plane_isRecovered();
  void jitter_isAveraged();
  void outlier_isDropped();
  void lonelyPixels_giveNothing();
  void speedLimit_isKept();
  void polarities_doNotMix();
};

void TestNormalFlow::surface_keepsTheLastPerPolarity() {
  const SyntheticWindow synthetic(
      {burstAt(10, 20, 0.004, false), burstAt(10, 20, -0.004, false), burstAt(10, 20, 0.001, true)});
  const ActiveEventSurface surface(synthetic.window, 1);
  QCOMPARE(surface.pixels().size(), 2u);
  QCOMPARE(*surface.at(true, 10, 20), 0.004f);  // dark circles lead with darker edges
  QCOMPARE(*surface.at(false, 10, 20), 0.001f);
  QVERIFY(!ActiveEventSurface::active(*surface.at(true, 11, 20)));
}

void TestNormalFlow::surface_hasABorder() {
  const SyntheticWindow synthetic({burstAt(0, 0, 0.0, false), burstAt(345, 259, 0.0, false)});
  const ActiveEventSurface surface(synthetic.window, 2);
  for (int d = -2; d <= 2; ++d) {
    QVERIFY(!ActiveEventSurface::active(surface.at(true, 0, 0)[-2 * surface.stride() + d]));
    QVERIFY(!ActiveEventSurface::active(surface.at(true, 345, 259)[2 * surface.stride() + d]));
  }
}

void TestNormalFlow::plane_isRecovered_data() {
  QTest::addColumn<double>("speed_px_s");
  QTest::addColumn<int>("radius_px");
  for (const double speed_px_s : {20.0, 100.0, 2000.0}) {
    for (const int radius_px : {1, 2, 3})
      QTest::addRow("%.0f px/s, radius %d px", speed_px_s, radius_px) << speed_px_s << radius_px;
  }
}

void TestNormalFlow::plane_isRecovered() {
  QFETCH(double, speed_px_s);
  QFETCH(int, radius_px);
  std::mt19937 random(50);
  NormalFlowOptions options;
  options.plane_radius_px = radius_px;
  for (int k = 0; k < 12; ++k) {
    const Eigen::Vector2d normal(std::cos(0.5 * k), std::sin(0.5 * k));
    const NormalFlowField field = flowOf(straightEdge(normal, speed_px_s, 0.0, random), options);
    QVERIFY(field.size() > 40);
    for (const NormalFlow& flow : field) {
      // Times are float seconds and whole nanoseconds.
      QVERIFY((flow.velocity_px_s.cast<double>() - speed_px_s * normal).norm() < 1e-3 * speed_px_s);
      QVERIFY(flow.leading);
    }
  }
}

void TestNormalFlow::jitter_isAveraged() {
  std::mt19937 random(51);
  const Eigen::Vector2d velocity(60.0, 80.0);
  const NormalFlowField field =
      flowOf(straightEdge(velocity.normalized(), 100.0, 1.5e-3, random));  // 0.15 px
  QVERIFY(field.size() > 200);
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  for (const NormalFlow& flow : field)
    slope += flow.velocity_px_s.cast<double>() / flow.velocity_px_s.cast<double>().squaredNorm();
  slope /= static_cast<double>(field.size());
  QVERIFY((slope / slope.squaredNorm() - velocity).norm() < 4.0);
}

void TestNormalFlow::outlier_isDropped() {
  std::mt19937 random(52);
  const Eigen::Vector2d normal(1.0, 0.0);
  std::vector<EdgeCrossing> bursts = straightEdge(normal, 100.0, 0.0, random);
  for (EdgeCrossing& burst : bursts) {
    if (burst.x_px == 101 && burst.y_px == 101) burst.time_ns += 25'000'000;  // 2.5 px late
  }
  const NormalFlowField field = flowOf(bursts);
  for (const NormalFlow& flow : field) {
    if (flow.x_px == 100 && flow.y_px == 100)
      QVERIFY((flow.velocity_px_s.cast<double>() - 100.0 * normal).norm() < 0.1);
    QVERIFY(flow.x_px != 101 || flow.y_px != 101);  // the outlier itself has no flow either
  }
  QVERIFY(std::any_of(field.begin(), field.end(),
                      [](const NormalFlow& flow) { return flow.x_px == 100 && flow.y_px == 100; }));
}

void TestNormalFlow::lonelyPixels_giveNothing() {
  QVERIFY(
      flowOf({burstAt(10, 10, 0.0, true), burstAt(11, 10, 0.01, true), burstAt(12, 10, 0.02, true)}).empty());
  std::vector<EdgeCrossing> line;
  for (int x = 10; x < 40; ++x) line.push_back(burstAt(x, 10, 0.001 * x, true));
  NormalFlowOptions options;
  options.min_plane_inliers = 0.3;
  QVERIFY(flowOf(line, options).empty());  // a line of pixels does not determine a plane
}

void TestNormalFlow::speedLimit_isKept() {
  std::mt19937 random(53);
  NormalFlowOptions options;
  options.fastest_px_s = 500.0;
  QVERIFY(flowOf(straightEdge({0.6, 0.8}, 550.0, 0.0, random), options).empty());
  QVERIFY(!flowOf(straightEdge({0.6, 0.8}, 450.0, 0.0, random), options).empty());
}

void TestNormalFlow::polarities_doNotMix() {
  std::mt19937 random(54);
  std::vector<EdgeCrossing> bursts = straightEdge({1.0, 0.0}, 100.0, 0.0, random);
  for (EdgeCrossing& burst : bursts) burst.brighter = (burst.x_px + burst.y_px) % 2;
  // Each keeps 5 or 4 of 9 neighbours: too few with 6.
  NormalFlowOptions options;
  options.min_plane_inliers = 0.6;
  QVERIFY(flowOf(bursts, options).empty());
}

}  // namespace

EVICAL_TEST(TestNormalFlow)
#include "tst_normal_flow.moc"
