// Changed parts of a state: statistics by chance, steps in one block, quantities that data do not determine.
#include "core/numerics/change_test.h"
#include "core/numerics/chi_squared.h"
#include "tests/support/test_program.h"

#include <Eigen/Cholesky>

#include <array>
#include <cmath>
#include <random>

using namespace evical;

namespace {

constexpr std::array<StateBlock, 2> kBlocks = {{{0, 2}, {2, 1}}};

// Rows that couple the three numbers, with unit noise.
Eigen::MatrixXd rows(std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(12, 3, [&] { return normal(generator); });
}

Eigen::VectorXd normalVectorForChangeTest(Eigen::Index size, std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(size, [&] { return normal(generator); });
}

}  // namespace

class TestChangeTest : public QObject {
  Q_OBJECT

 private slots:
  void statistic_ofNoChange_isChiSquared() {
    std::mt19937_64 generator(1);
    const Eigen::Vector3d sigma(0.5, 2.0, 0.1);
    double sum = 0.0;
    constexpr int kRuns = 2000;
    for (int run = 0; run < kRuns; ++run) {
      const Eigen::MatrixXd j = rows(generator);
      const Eigen::VectorXd state = sigma.cwiseProduct(normalVectorForChangeTest(3, generator));
      const Eigen::VectorXd measured = j * state + normalVectorForChangeTest(12, generator);
      const ChangeDetector test(j.transpose() * j, j.transpose() * measured, sigma.cwiseAbs2().asDiagonal());
      sum += test.of(kBlocks[0]).chi_square;
    }
    QVERIFY2(std::abs(sum / kRuns - 2.0) < 0.2, qPrintable(QString::number(sum / kRuns)));  // five sigmas
  }

  void step_comesBackWithItsCovariance() {
    std::mt19937_64 generator(2);
    const Eigen::Vector3d sigma(0.1, 0.1, 0.1), step(3.0, -2.0, 0.0);
    double squares = 0.0;
    constexpr int kRuns = 1000;
    for (int run = 0; run < kRuns; ++run) {
      const Eigen::MatrixXd j = rows(generator);
      const Eigen::VectorXd state = step + sigma.cwiseProduct(normalVectorForChangeTest(3, generator));
      const ChangeDetector test(j.transpose() * j,
                                j.transpose() * (j * state + normalVectorForChangeTest(12, generator)),
                                sigma.cwiseAbs2().asDiagonal());
      const BlockChange found = test.of(kBlocks[0]);
      const Eigen::Vector2d error = found.step - step.head<2>();
      squares += error.dot(found.covariance.ldlt().solve(error)) / 2.0;
    }
    QVERIFY2(std::abs(squares / kRuns - 1.0) < 0.15, qPrintable(QString::number(squares / kRuns)));
  }

  void findChanges_namesTheBlockThatChanged() {
    std::mt19937_64 generator(3);
    const Eigen::Matrix3d known = 0.01 * Eigen::Matrix3d::Identity();
    for (const std::size_t changed : {0ul, 1ul}) {
      const Eigen::MatrixXd j = rows(generator);
      const Eigen::Vector3d step =
          changed == 0 ? Eigen::Vector3d(4.0, 4.0, 0.0) : Eigen::Vector3d(0.0, 0.0, 4.0);
      const auto found = findChanges(j.transpose() * j, j.transpose() * (j * step), known, kBlocks,
                                     limitsFor(kBlocks, 1e-4));
      QCOMPARE(found.size(), std::size_t{1});
      QCOMPARE(found.front().block, changed);
    }
  }

  void withoutInformation_nothingIsFoundAndNothingWouldBeNoticed() {
    const ChangeDetector test(Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity());
    QCOMPARE(test.of(kBlocks[0]).chi_square, 0.0);
    QVERIFY(!std::isfinite(test.worstSigma(kBlocks[0])));
    QVERIFY(findChanges(Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(),
                        kBlocks, limitsFor(kBlocks, 0.01))
                .empty());
  }
};

EVICAL_TEST(TestChangeTest)
#include "tst_change_test.moc"
