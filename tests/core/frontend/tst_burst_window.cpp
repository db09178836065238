#include "core/frontend/burst_window.h"

#include "core/geometry/camera_model.h"

#include "tests/core/frontend/synthetic_bursts.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <random>

namespace {

using namespace evical;
using namespace evical::test;

class TestBurstWindow : public QObject {
  Q_OBJECT
 private slots:
  void visitBox_findsAllInside();
  void visitBox_outsideTheImage_visitsNothing();
  void lead_followsShade();
  void idealPixels_comeFromTable();
  void history_gathersWhatLiesInTime();
  void history_takesBurstsInAnyOrder();
  void history_dropsOld();
  void history_needsNoRoomForEmptyTime();
};

void TestBurstWindow::visitBox_findsAllInside() {
  std::mt19937 random(3);
  std::vector<EdgeCrossing> bursts;
  addRandomBursts(5000, 0.02, random, bursts);
  const SyntheticWindow synthetic(bursts);
  const BurstWindow& window = synthetic.window;
  QCOMPARE(window.bursts().size(), bursts.size());
  std::uniform_real_distribution<double> x(-20.0, 366.0), y(-20.0, 280.0), size(0.0, 60.0);
  for (int k = 0; k < 200; ++k) {
    const double x_low = x(random), y_low = y(random), x_high = x_low + size(random),
                 y_high = y_low + size(random);
    std::vector<bool> visited(bursts.size(), false);
    window.visitBox(x_low, x_high, y_low, y_high, [&](std::uint32_t i) {
      QVERIFY(!visited[i]);
      visited[i] = true;
    });
    for (std::size_t i = 0; i < bursts.size(); ++i) {
      const WindowBurst& b = window.bursts()[i];
      if (b.x_px >= x_low && b.x_px <= x_high && b.y_px >= y_low && b.y_px <= y_high) QVERIFY(visited[i]);
    }
  }
}

void TestBurstWindow::visitBox_outsideTheImage_visitsNothing() {
  std::mt19937 random(4);
  std::vector<EdgeCrossing> bursts;
  addRandomBursts(2000, 0.02, random, bursts);
  const SyntheticWindow synthetic(bursts);
  const auto fail = [](std::uint32_t) { QFAIL("visited"); };
  synthetic.window.visitBox(-50.0, -1.0, 0.0, 100.0, fail);
  synthetic.window.visitBox(0.0, 100.0, 300.0, 400.0, fail);
}

void TestBurstWindow::lead_followsShade() {
  const std::vector<EdgeCrossing> bursts = {burstAt(10, 20, 0.003, false)};
  QCOMPARE(SyntheticWindow(bursts, CircleShade::Dark).window.bursts()[0].lead, 1.0f);
  QCOMPARE(SyntheticWindow(bursts, CircleShade::Bright).window.bursts()[0].lead, -1.0f);
  QCOMPARE(SyntheticWindow(bursts).window.bursts()[0].time_s, 0.003f);
}

void TestBurstWindow::idealPixels_comeFromTable() {
  CameraIntrinsics camera;
  camera.resolution_px = kDavis_px;
  camera.focal_length_px = {260.0, 260.0};
  camera.principal_point_px = {172.5, 129.5};
  camera.distortion = {-0.3, 0.08, 0.0, 0.0, 0.0};
  BoardScene scene(Board{}, kDavis_px, camera);
  IdealPixels pixels = *scene.pixels;
  pixels.stretch.assign(pixels.stretch.size(), {4.0f, 0.0f, 1.0f});
  scene.pixels = std::make_shared<IdealPixels>(pixels);
  BurstWindow window(scene);
  window.assign({burstAt(20, 30, 0.0, true)}, 0);
  const Eigen::Vector2d expected = *idealPixel(camera, {20.0, 30.0});
  QVERIFY(std::abs(window.bursts()[0].ideal_x_px - expected.x()) < 1e-3);
  QVERIFY(std::abs(window.bursts()[0].ideal_y_px - expected.y()) < 1e-3);
  QCOMPARE(window.bursts()[0].stretch.across(Eigen::Vector2d::UnitX()), 2.0);
  QCOMPARE(window.bursts()[0].stretch.across(Eigen::Vector2d::UnitY()), 1.0);
}

void TestBurstWindow::history_gathersWhatLiesInTime() {
  std::mt19937 random(5);
  std::vector<EdgeCrossing> bursts;
  addRandomBursts(3000, 0.5, random, bursts);  // negative times too
  BurstHistory history;
  history.add(bursts);
  const std::int64_t begin_ns = -123'456'789, end_ns = 87'654'321;
  std::vector<EdgeCrossing> found;
  history.gather(begin_ns, end_ns, found);
  const auto inside = [&](const EdgeCrossing& b) { return b.time_ns >= begin_ns && b.time_ns < end_ns; };
  QCOMPARE(static_cast<std::ptrdiff_t>(found.size()), std::count_if(bursts.begin(), bursts.end(), inside));
  QVERIFY(std::all_of(found.begin(), found.end(), inside));
  QVERIFY(history.count(begin_ns, end_ns) >= found.size());
}

void TestBurstWindow::history_takesBurstsInAnyOrder() {
  BurstHistory history;
  history.add({burstAt(1, 1, 0.5, true)});
  history.add({burstAt(2, 2, -0.5, true), burstAt(3, 3, 0.1, true)});
  std::vector<EdgeCrossing> found;
  history.gather(-1'000'000'000, 1'000'000'000, found);
  QCOMPARE(found.size(), 3u);
}

void TestBurstWindow::history_dropsOld() {
  BurstHistory history;
  for (int k = 0; k < 100; ++k) history.add({burstAt(1, 1, 0.01 * k, true)});
  history.dropBefore(500'000'000);
  std::vector<EdgeCrossing> found;
  history.gather(0, 2'000'000'000, found);
  QVERIFY(found.size() >= 50 && found.size() <= 51);
  history.dropBefore(5'000'000'000);
  QVERIFY(history.empty());
}

// A slice per 5 ms would be six thousand million per year.
void TestBurstWindow::history_needsNoRoomForEmptyTime() {
  constexpr std::int64_t kYear_ns = 365LL * 86'400 * 1'000'000'000;
  BurstHistory history;
  history.add({{kYear_ns, 0, 1, 1, 3, true}, {0, 0, 2, 2, 3, true}, {-kYear_ns, 0, 3, 3, 3, true}});
  history.add({{kYear_ns + 1, 0, 4, 4, 3, true}, {1, 0, 5, 5, 3, true}});
  std::vector<EdgeCrossing> found;
  history.gather(-2 * kYear_ns, 2 * kYear_ns, found);
  QCOMPARE(found.size(), std::size_t{5});
  const auto earlier = [](const EdgeCrossing& a, const EdgeCrossing& b) { return a.time_ns < b.time_ns; };
  QVERIFY(std::is_sorted(found.begin(), found.end(), earlier));
  QCOMPARE(history.count(0, 2), std::size_t{2});
  QVERIFY(*history.nextAfter(10'000'000) >= kYear_ns - 5'000'000);
  QVERIFY(!history.nextAfter(kYear_ns + 10'000'000));
}

}  // namespace

EVICAL_TEST(TestBurstWindow)
#include "tst_burst_window.moc"
