#include "core/report/residual_statistics.h"

#include "tests/support/random_vector.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

using namespace evical;

namespace {

std::vector<CircleResidual> normalResiduals(int count, double sigma_px, const Eigen::Vector2d& mean_px) {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> normal;
  std::vector<CircleResidual> residuals;
  for (int k = 0; k < count; ++k) {
    CircleResidual residual;
    residual.view = k / 10;
    residual.time_s = 0.02 * residual.view;
    residual.centre_px = {10.0 + k % 300, 10.0 + (k / 7) % 200};
    residual.residual_px = mean_px + sigma_px * test::randomVector<2>([&] { return normal(engine); });
    residual.sigma_px = Eigen::Vector2d::Constant(sigma_px);
    residuals.push_back(residual);
  }
  return residuals;
}

const CameraIntrinsics kUndistorted{
    CameraModel::PinholeRadtan, {320, 240}, {260.0, 260.0}, {160.0, 120.0}, {}};

}  // namespace

class TestResidualStatistics : public QObject {
  Q_OBJECT

 private slots:
  void statistics_ofNormalResidualsAreThoseOfTheirDistribution();
  void statistics_findTheBiasOfACell();
  void statistics_countEachWindowOnItsOwn();
  void ellipse_holdsItsShare();
  void statistics_ofTwoResidualsAreThoseByHand();
  void statistics_ofNothingAreEmpty();
};

void TestResidualStatistics::statistics_ofNormalResidualsAreThoseOfTheirDistribution() {
  const ResidualStatistics s =
      residualStatistics(normalResiduals(20'000, 0.1, {0.02, -0.01}), 0, kUndistorted);
  QVERIFY((s.mean_px - Eigen::Vector2d(0.02, -0.01)).norm() < 0.004);
  QVERIFY((s.covariance_px2 - 0.01 * Eigen::Matrix2d::Identity()).norm() < 5e-4);
  QVERIFY(std::abs(s.normalised_mean - 0.05) < 0.02);
  QVERIFY(std::abs(s.normalised_std - 1.0) < 0.03);
  const double mass = s.bin_width * std::accumulate(s.bin_density.begin(), s.bin_density.end(), 0.0);
  QVERIFY(std::abs(mass - 1.0) < 1e-3);
  const auto peak = std::max_element(s.bin_density.begin(), s.bin_density.end()) - s.bin_density.begin();
  QVERIFY(std::abs(s.bin_middle[static_cast<std::size_t>(peak)]) < 0.5);
  QVERIFY(std::abs(s.bin_density[static_cast<std::size_t>(peak)] - 0.399) < 0.03);
}

void TestResidualStatistics::statistics_findTheBiasOfACell() {
  std::vector<CircleResidual> residuals = normalResiduals(3000, 0.01, {0.0, 0.0});
  for (CircleResidual& residual : residuals)
    if (residual.centre_px.x() < 20.0) residual.residual_px.y() += 0.5;
  const ResidualStatistics s = residualStatistics(residuals, 0, kUndistorted);
  QCOMPARE(s.columns, 16);
  QCOMPARE(s.rows, 12);
  int count = 0;
  for (const auto& cell : s.cells) {
    count += cell.count;
    if (cell.count < 5) continue;
    const Eigen::Vector2d expected(0.0, cell.middle_px.x() < 20.0 ? 0.5 : 0.0);
    QVERIFY((cell.mean_px - expected).norm() < 0.02);
  }
  QCOMPARE(count, 3000);
}

void TestResidualStatistics::statistics_countEachWindowOnItsOwn() {
  std::vector<CircleResidual> residuals = normalResiduals(40, 0.1, {0.0, 0.0});
  for (std::size_t k = 10; k < 20; ++k) residuals[k].residual_px = {3.0, 4.0};
  for (std::size_t k = 20; k < 30; ++k) residuals[k].used = false;
  residuals[39].camera = 1;
  const ResidualStatistics s = residualStatistics(residuals, 0, kUndistorted);
  QCOMPARE(s.windows.size(), std::size_t{3});
  QCOMPARE(s.windows[1].view, 1);
  QVERIFY(std::abs(s.windows[1].rms_px - 5.0) < 1e-12);
  QCOMPARE(s.windows[2].view, 3);
  QCOMPARE(s.windows[2].circles, 9);
  QCOMPARE(s.dropped.size(), std::size_t{10});
}

void TestResidualStatistics::ellipse_holdsItsShare() {
  const ResidualStatistics s = residualStatistics(normalResiduals(20'000, 0.1, {0.3, 0.0}), 0, kUndistorted);
  const auto ellipse = sigmaEllipse(s.mean_px, s.covariance_px2, 2.0);
  for (const Eigen::Vector2d& point : ellipse) QVERIFY(std::abs((point - s.mean_px).norm() - 0.2) < 0.01);
}

// Two windows of one circle each, at (3, 4) px and (-3, -4) px with sigmas of 1 px: every number computed by
// hand.
void TestResidualStatistics::statistics_ofTwoResidualsAreThoseByHand() {
  CircleResidual residual;
  residual.centre_px = {30.0, 50.0};
  residual.residual_px = {3.0, 4.0};
  residual.sigma_px = {1.0, 1.0};
  std::vector<CircleResidual> residuals(2, residual);
  residuals[1].view = 1;
  residuals[1].time_s = 0.5;
  residuals[1].residual_px = {-3.0, -4.0};
  const ResidualStatistics s = residualStatistics(residuals, 0, kUndistorted);
  QCOMPARE(s.used.front().residual_px.x(), -3.0);  // by x
  QVERIFY(s.mean_px.norm() < 1e-12);
  QVERIFY((s.covariance_px2 - (Eigen::Matrix2d() << 9.0, 12.0, 12.0, 16.0).finished()).norm() < 1e-12);
  QVERIFY(std::abs(s.normalised_mean) < 1e-12);
  QVERIFY(std::abs(s.normalised_std - std::sqrt(12.5)) < 1e-12);  // of 9, 16, 9 and 16
  QCOMPARE(s.windows.size(), std::size_t{2});
  QCOMPARE(s.windows[1].time_s, 0.5);
  QVERIFY(std::abs(s.windows[1].rms_px - 5.0) < 1e-12);
  const std::size_t cell = 2 * 16 + 1;  // of 20 x 20 px
  QCOMPARE(s.cells[cell].count, 2);
  QVERIFY(s.cells[cell].mean_px.norm() < 1e-12);
}

void TestResidualStatistics::statistics_ofNothingAreEmpty() {
  const ResidualStatistics s = residualStatistics({}, 0, kUndistorted);
  QVERIFY(s.used.empty() && s.windows.empty() && s.cells.empty() && s.bin_density.empty());
}

EVICAL_TEST(TestResidualStatistics)
#include "tst_residual_statistics.moc"
