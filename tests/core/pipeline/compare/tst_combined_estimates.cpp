// Several estimates combined into one, against the least squares of all their measurements at once.
#include "core/pipeline/compare/combined_estimates.h"
#include "tests/support/test_program.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <array>
#include <cmath>
#include <random>
#include <vector>

using namespace evical;

namespace {

constexpr Eigen::Index kUnknowns = 3;
constexpr std::size_t kRecordings = 4;
constexpr std::array<std::size_t, kRecordings> kAll = {0, 1, 2, 3};

// Rows are measurements of three unknowns; priors are one row per unknown, the same in every recording.
class Measurements {
 public:
  explicit Measurements(double error_size = 1.0) : error_size_(error_size) {}

  void draw(const Eigen::Vector3d& truth) {
    for (double& each : prior_value_) each = normal_(random_);
    prior_value_ = truth + prior_sigma_.cwiseProduct(prior_value_);
    for (std::size_t k = 0; k < kRecordings; ++k) {
      rows_[k] = Eigen::MatrixXd::NullaryExpr(6, kUnknowns, [&] { return normal_(random_); });
      measured_[k] = rows_[k] * truth;
      for (double& each : measured_[k]) each += error_size_ * normal_(random_);
    }
  }
  Eigen::Matrix3d prior() const { return prior_sigma_.cwiseAbs2().cwiseInverse().asDiagonal(); }

  // Covariances describe the errors, weights do not.
  PartialEstimate estimate(std::size_t k, const Eigen::Vector3d& off = Eigen::Vector3d::Zero()) const {
    const Eigen::Matrix3d data = rows_[k].transpose() * rows_[k], weight = data + prior();
    const Eigen::Matrix3d inverse = weight.inverse();
    return {{0, 1, 2},
            inverse * (rows_[k].transpose() * measured_[k] + prior() * prior_value_) + off,
            weight,
            inverse * (error_size_ * error_size_ * data + prior()) * inverse};
  }
  EstimateCombination combination(const Eigen::Vector3d& off = Eigen::Vector3d::Zero(),
                                  const Eigen::Matrix3d& moving = Eigen::Matrix3d::Zero()) const {
    std::vector<PartialEstimate> estimates;
    for (std::size_t k = 0; k < kRecordings; ++k)
      estimates.push_back(estimate(k, k == 2 ? off : Eigen::Vector3d::Zero().eval()));
    return {estimates, {prior(), prior_value_, moving}};
  }
  CombinedEstimate batch() const {
    Eigen::Matrix3d information = prior();
    Eigen::Vector3d vector = prior() * prior_value_;
    for (std::size_t k = 0; k < kRecordings; ++k) {
      information += rows_[k].transpose() * rows_[k];
      vector += rows_[k].transpose() * measured_[k];
    }
    return {information.ldlt().solve(vector), information.inverse()};
  }

 private:
  double error_size_;
  Eigen::Vector3d prior_sigma_ = {0.2, 1.0, 5.0}, prior_value_ = Eigen::Vector3d::Zero();
  std::array<Eigen::MatrixXd, kRecordings> rows_;
  std::array<Eigen::VectorXd, kRecordings> measured_;
  std::mt19937_64 random_{11};
  std::normal_distribution<double> normal_;
};

const Eigen::Vector3d kTruth(0.3, -2.0, 7.0);

}  // namespace

class TestCombinedEstimates : public QObject {
  Q_OBJECT

 private slots:
  // A prior that all share counts once, not four times.
  void combination_isTheBatch() {
    Measurements measurements;
    measurements.draw(kTruth);
    const CombinedEstimate combined = measurements.combination().combine(kAll), batch = measurements.batch();
    QVERIFY((combined.value - batch.value).norm() < 1e-9);
    QVERIFY((combined.covariance - batch.covariance).norm() < 1e-9);
  }

  void sigmas_areThoseOfTheErrors_data() {
    QTest::addColumn<double>("size");
    QTest::newRow("as weighed") << 1.0;
    QTest::newRow("twice as large") << 2.0;
  }
  void sigmas_areThoseOfTheErrors() {
    QFETCH(double, size);
    constexpr int kDraws = 2000;
    Measurements measurements(size);
    double squares = 0.0, distances = 0.0;
    Eigen::Vector3d varying = Eigen::Vector3d::Zero(), scatter = Eigen::Vector3d::Zero();
    for (int draw = 0; draw < kDraws; ++draw) {
      measurements.draw(kTruth);
      const EstimateCombination combination = measurements.combination();
      const CombinedEstimate combined = combination.combine(kAll);
      const Eigen::Vector3d error = combined.value - kTruth;
      squares += error.dot(combined.covariance.inverse() * error) / kUnknowns / kDraws;
      const std::array<std::size_t, 3> others = {1, 2, 3};
      const EstimateDistance distance = combination.distance(0, others);
      QCOMPARE(distance.freedom, 3);
      distances += distance.chi_square / distance.freedom / kDraws;
      // Two recordings differ by their data alone, even if the prior of both is wrong.
      varying +=
          (combination.varyingSigmas(0).cwiseAbs2() + combination.varyingSigmas(1).cwiseAbs2()) / kDraws;
      scatter += (measurements.estimate(0).value - measurements.estimate(1).value).cwiseAbs2() / kDraws;
    }
    // A mean of 2000 sums of three squares scatters by 0.018, of single squares by 0.05; random rows add to
    // it.
    QVERIFY2(std::abs(squares - 1.0) < 0.08, qPrintable(QString::number(squares)));
    QVERIFY2(std::abs(distances - 1.0) < 0.08, qPrintable(QString::number(distances)));
    for (Eigen::Index i = 0; i < kUnknowns; ++i)
      QVERIFY2(std::abs(scatter[i] / varying[i] - 1.0) < 0.3,
               qPrintable(QString::number(scatter[i] / varying[i])));
  }

  void offOne_isFar_unlessItMayMove() {
    Measurements measurements;
    measurements.draw(kTruth);
    const Eigen::Vector3d off(0.0, 4.0, 0.0);
    const std::array<std::size_t, 3> others = {0, 1, 3};
    QVERIFY(probabilityBeyond(measurements.combination().distance(2, others)) > 1e-4);
    QVERIFY(probabilityBeyond(measurements.combination(off).distance(2, others)) < 1e-4);
    const Eigen::Matrix3d moving = 25.0 * Eigen::Matrix3d::Identity();
    QVERIFY(probabilityBeyond(measurements.combination(off, moving).distance(2, others)) > 0.1);
  }

  // One recording determines only the first unknown, another one the other two.
  void unknownsThatOneDoesNotTell_comeFromTheOthers() {
    const Eigen::Matrix2d two = (Eigen::Matrix2d() << 4.0, 1.0, 1.0, 2.0).finished();
    const std::vector<PartialEstimate> estimates = {{{0},
                                                     Eigen::VectorXd::Constant(1, 5.0),
                                                     Eigen::MatrixXd::Constant(1, 1, 4.0),
                                                     Eigen::MatrixXd::Constant(1, 1, 0.25)},
                                                    {{1, 2}, Eigen::Vector2d(-1.0, 2.0), two, two.inverse()}};
    const Eigen::Matrix3d zero = Eigen::Matrix3d::Zero();
    const EstimateCombination combination(estimates, {zero, Eigen::Vector3d::Zero(), zero});
    const std::array<std::size_t, 2> both = {0, 1};
    const std::array<std::size_t, 1> second = {1};
    QVERIFY((combination.combine(both).value - Eigen::Vector3d(5.0, -1.0, 2.0)).norm() < 1e-9);
    QVERIFY(std::abs(combination.combine(both).covariance(0, 0) - 0.25) < 1e-9);
    QVERIFY(combination.combine(second).covariance(0, 0) > 1e6);
    QCOMPARE(combination.distance(0, second).freedom, 0);
  }
};

EVICAL_TEST(TestCombinedEstimates)
#include "tst_combined_estimates.moc"
