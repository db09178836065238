#include "core/frontend/edge_slopes.h"

#include "tests/support/test_program.h"

#include <QTest>

#include <cmath>
#include <vector>

using namespace evical;

namespace {

constexpr Resolution kSize{40, 30};
constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

// A straight edge that crosses the whole image; its normal at `angle`.
std::vector<EdgeCrossing> edge(double angle_rad, double speed_px_s, bool brighter = true,
                               double begin_s = 0.2) {
  std::vector<EdgeCrossing> bursts;
  for (std::uint16_t y = 0; y < kSize.height_px; ++y)
    for (std::uint16_t x = 0; x < kSize.width_px; ++x) {
      const double way_px = std::cos(angle_rad) * x + std::sin(angle_rad) * y;
      const double time_s = begin_s + (std::isinf(speed_px_s) ? 0.0 : way_px / speed_px_s);
      bursts.push_back({kStart_ns + std::llround(1e9 * time_s), 1'000'000, x, y, 4, brighter});
    }
  return bursts;
}

std::vector<EdgeSlope> slopesOf(const std::vector<EdgeCrossing>& bursts) {
  std::vector<EdgeSlope> all;
  EdgeSlopeFinder finder(kSize, {}, 0.04, [&](std::int64_t begin_ns, std::span<const EdgeSlope> slopes) {
    for (const EdgeSlope& slope : slopes) {
      QVERIFY(slope.time_ns >= begin_ns && slope.time_ns < begin_ns + 40'000'000);
      all.push_back(slope);
    }
  });
  finder.add(bursts, std::numeric_limits<std::int64_t>::max());
  finder.finish();
  return all;
}

}  // namespace

class TestEdgeSlopes : public QObject {
  Q_OBJECT

 private slots:
  void slopes_areOneOverTheSpeed_data() {
    QTest::addColumn<double>("angle_rad");
    QTest::addColumn<double>("speed_px_s");
    QTest::newRow("along x") << 0.0 << 100.0;
    QTest::newRow("aslant") << 0.7 << 60.0;
    QTest::newRow("fast") << 2.5 << 1500.0;
  }
  void slopes_areOneOverTheSpeed() {
    QFETCH(double, angle_rad);
    QFETCH(double, speed_px_s);
    const std::vector<EdgeSlope> slopes = slopesOf(edge(angle_rad, speed_px_s));
    // All pixels except a border of two.
    QCOMPARE(slopes.size(), std::size_t{36 * 26});
    const Eigen::Vector2d expected = Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)) / speed_px_s;
    for (const EdgeSlope& slope : slopes) {
      QVERIFY((slope.slope_s_px.cast<double>() - expected).norm() < 1e-3 / speed_px_s);
      QVERIFY(std::abs(slope.shape[0] - 1.0f / 50.0f) < 1e-6f);
    }
  }

  // The second edge is a different one, though its bursts are of the same pixels.
  void twoEdges_doNotMix() {
    std::vector<EdgeCrossing> bursts = edge(0.3, 200.0);
    const std::vector<EdgeCrossing> second = edge(0.3 + 1.5, 200.0, true, 0.26);
    bursts.insert(bursts.end(), second.begin(), second.end());
    for (const EdgeSlope& slope : slopesOf(bursts))
      QVERIFY(std::abs(200.0 * static_cast<double>(slope.slope_s_px.norm()) - 1.0) < 0.05);
  }

  void flicker_hasNoSlopes() {
    QVERIFY(slopesOf(edge(0.0, std::numeric_limits<double>::infinity())).empty());
  }

  void slowEdges_areLeftOut() { QVERIFY(slopesOf(edge(0.0, 10.0)).empty()); }
};

EVICAL_TEST(TestEdgeSlopes)
#include "tst_edge_slopes.moc"
