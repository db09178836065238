#include "core/numerics/bordered_band.h"

#include "tests/support/test_program.h"

#include <Eigen/LU>

#include <algorithm>
#include <limits>
#include <random>

using namespace evical;

namespace {

struct Sizes {
  Eigen::Index band, half_bandwidth, border;
};

// The same matrix twice; `weight` on the diagonal makes it positive definite.
struct Twins {
  BorderedBand bordered;
  Eigen::MatrixXd dense;

  explicit Twins(const Sizes& sizes, double weight = 10.0)
      : bordered(sizes.band, sizes.half_bandwidth, sizes.border),
        dense(Eigen::MatrixXd::Zero(sizes.band + sizes.border, sizes.band + sizes.border)) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (Eigen::Index i = 0; i < dense.rows(); ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) {
        if (i < sizes.band && i - j > sizes.half_bandwidth) continue;
        const double value = number(random) + (i == j ? weight : 0.0);
        dense(i, j) = dense(j, i) = value;
        if (i < sizes.band)
          bordered.band().add(i, j, value);
        else if (j < sizes.band)
          bordered.mixed()(j, i - sizes.band) = value;
        else
          bordered.corner()(i - sizes.band, j - sizes.band) = value;
      }
    }
  }
};

}  // namespace

class TestBorderedBand : public QObject {
  Q_OBJECT

  BandCholesky factor_{0, 0};  // of all matrices, as in successive solutions

 private slots:
  void solve_matchesDenseSolver_data() {
    QTest::addColumn<int>("band");
    QTest::addColumn<int>("half_bandwidth");
    QTest::addColumn<int>("border");
    QTest::newRow("longer than a panel") << 150 << 5 << 4;
    QTest::newRow("a panel") << 64 << 3 << 2;
    QTest::newRow("wider than long") << 4 << 7 << 3;
    QTest::newRow("without a border") << 70 << 4 << 0;
    QTest::newRow("a border only") << 0 << 0 << 5;
  }
  void solve_matchesDenseSolver() {
    QFETCH(int, band);
    QFETCH(int, half_bandwidth);
    QFETCH(int, border);
    Twins twins({band, half_bandwidth, border}, 20.0);
    const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(band + border, -1.0, 2.0),
                          added = Eigen::VectorXd::LinSpaced(band + border, 0.0, 5.0);
    const std::optional<Eigen::VectorXd> solution = twins.bordered.solve(added, right, factor_);
    QVERIFY(solution.has_value());
    const Eigen::MatrixXd matrix = twins.dense + Eigen::MatrixXd(added.asDiagonal());
    QVERIFY((matrix * *solution - right).norm() < 1e-12 * right.norm() * matrix.norm());
    QVERIFY(twins.bordered.diagonal() == twins.dense.diagonal());
  }

  void schurComplement_matchesDenseOne() {
    const Sizes sizes{150, 5, 4};
    const Twins twins(sizes);
    const Eigen::MatrixXd expected =
        twins.dense.bottomRightCorner(4, 4) -
        twins.dense.bottomLeftCorner(4, 150) *
            twins.dense.topLeftCorner(150, 150).fullPivLu().solve(twins.dense.topRightCorner(150, 4));
    QVERIFY((twins.bordered.schurComplement() - expected).norm() < 1e-12 * expected.norm());
  }

  // A direction without information is not changed.
  void schurComplement_passesOverWhatHasNoInformation() {
    BorderedBand matrix(3, 1, 1);
    matrix.band().add(0, 0, 4.0);
    matrix.band().add(2, 2, 1.0);
    matrix.mixed()(0, 0) = 2.0;
    matrix.mixed()(2, 0) = 1.0;
    matrix.corner()(0, 0) = 5.0;
    QCOMPARE(matrix.schurComplement()(0, 0), 3.0);
  }

  void solve_refusesWhatIsNotPositiveDefinite() {
    const Sizes sizes{20, 3, 2};
    const Eigen::VectorXd right = Eigen::VectorXd::Ones(22), none = Eigen::VectorXd::Zero(22);
    QVERIFY(Twins(sizes).bordered.solve(none, right, factor_).has_value());
    Twins in_band(sizes);
    in_band.bordered.band().row(11)[11] = -1.0;
    QVERIFY(!in_band.bordered.solve(none, right, factor_).has_value());
    Twins in_corner(sizes);
    in_corner.bordered.corner()(1, 1) = -1.0;
    QVERIFY(!in_corner.bordered.solve(none, right, factor_).has_value());
    Twins no_number(sizes);
    no_number.bordered.band().row(5)[4] = std::numeric_limits<double>::quiet_NaN();
    QVERIFY(!no_number.bordered.solve(none, right, factor_).has_value());
  }
};

EVICAL_TEST(TestBorderedBand)
#include "tst_bordered_band.moc"
