#include "core/pipeline/compare/outlier_group_test.h"
#include "tests/support/test_program.h"

#include <Eigen/Cholesky>

#include <array>
#include <cmath>
#include <random>
#include <vector>

using namespace evical;

namespace {

constexpr Eigen::Index kNumbers = 6;

// Three numbers each, the second group's correlated with the first's.
Eigen::MatrixXd covariance() {
  Eigen::MatrixXd root = Eigen::MatrixXd::Identity(kNumbers, kNumbers);
  for (Eigen::Index i = 0; i < 3; ++i) root(3 + i, i) = 0.8;
  return root * root.transpose();
}

std::array<ChangeGroup, 2> groups(double stability) {
  std::array<ChangeGroup, 2> groups;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    groups[g] = {3 * static_cast<Eigen::Index>(g),
                 3,
                 Eigen::Matrix3d::Identity(),
                 stability,
                 stability * stability * Eigen::Matrix3d::Identity(),
                 true};
  }
  return groups;
}

class Draws {
 public:
  EstimatedChange next(const Eigen::VectorXd& truth) {
    Eigen::VectorXd white(kNumbers);
    for (double& each : white) each = normal_(random_);
    return {truth + covariance().llt().matrixL() * white, covariance()};
  }

 private:
  std::mt19937_64 random_{7};
  std::normal_distribution<double> normal_;
};

}  // namespace

class TestSingleChanges : public QObject {
  Q_OBJECT

 private slots:
  // False alarms at the stated rate, also if everything has moved by the tolerance.
  void noChange_isSeldomOne() {
    constexpr int kDraws = 4000;
    constexpr double kFalseAlarms = 0.05;
    for (const double stability : {0.0, 0.5}) {
      Draws draws;
      const auto all = groups(stability);
      Eigen::VectorXd truth = Eigen::VectorXd::Zero(kNumbers);
      truth[0] = truth[3] = 0.5 * stability;
      int alarms = 0;
      for (int k = 0; k < kDraws; ++k) {
        const GroupTestResults tests = testSingleChanges(draws.next(truth), all, kFalseAlarms);
        alarms += tests.groups[0].changed || tests.groups[1].changed;
      }
      QVERIFY2(alarms < 1.2 * kFalseAlarms * kDraws, qPrintable(QString::number(alarms)));
      if (stability == 0.0) QVERIFY(alarms > 0.6 * kFalseAlarms * kDraws);
    }
  }

  // A change of detectable size, in the least certain direction.
  void changeThatWouldBeNoticed_isFound() {
    constexpr int kDraws = 1000;
    constexpr double kStability = 0.3;
    const auto all = groups(kStability);
    Draws draws;
    const double size = testSingleChanges(draws.next(Eigen::VectorXd::Zero(kNumbers)), all, 0.01)
                            .groups[1]
                            .smallest_detectable_change;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      int found = 0;
      for (int k = 0; k < kDraws; ++k)
        found += testSingleChanges(draws.next(size * Eigen::VectorXd::Unit(kNumbers, 3 + axis)), all, 0.01)
                     .groups[1]
                     .changed;
      QVERIFY2(found > 0.93 * kDraws, qPrintable(QString::number(found)));
    }
  }

  void changedGroup_isNamedAndSizedAlone() {
    Draws draws;
    const auto all = groups(0.1);
    const GroupTestResults tests =
        testSingleChanges(draws.next(20.0 * Eigen::VectorXd::Unit(kNumbers, 1)), all, 0.01);
    QVERIFY(tests.groups[0].changed);
    QVERIFY(!tests.groups[1].changed);
    QVERIFY(tests.alternatives.empty());
    QVERIFY(std::abs(tests.groups[0].change.norm() - 20.0) < 4.0);
  }

  void bothGroups_areFound() {
    Draws draws;
    Eigen::VectorXd truth = Eigen::VectorXd::Zero(kNumbers);
    truth[0] = 15.0;
    truth[5] = -25.0;
    const GroupTestResults tests = testSingleChanges(draws.next(truth), groups(0.1), 0.01);
    QVERIFY(tests.groups[0].changed && tests.groups[1].changed);
    QVERIFY(std::abs(tests.groups[0].change[0] - 15.0) < 4.0);
    QVERIFY(std::abs(tests.groups[1].change[2] + 25.0) < 6.0);
  }

  void changeWithinTheStability_isNone() {
    const auto all = groups(5.0);
    const EstimatedChange sharp{4.9 * Eigen::VectorXd::Unit(kNumbers, 0), 1e-4 * covariance()};
    const GroupTestResults tests = testSingleChanges(sharp, all, 0.01);
    QVERIFY(!tests.groups[0].changed);
    QCOMPARE(tests.groups[0].beyond, 0.0);
    QVERIFY(tests.groups[0].sigmas > 100.0);
  }
};

EVICAL_TEST(TestSingleChanges)
#include "tst_outlier_group_test.moc"
