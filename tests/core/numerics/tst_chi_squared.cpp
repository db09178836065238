#include "core/numerics/chi_squared.h"
#include "tests/support/test_program.h"

#include <cmath>

using namespace evical;

class TestChiSquared : public QObject {
  Q_OBJECT

 private slots:
  // Tables of the distribution.
  void limit_isThatOfTables_data() {
    QTest::addColumn<int>("count");
    QTest::addColumn<double>("probability");
    QTest::addColumn<double>("limit");
    QTest::newRow("1, 5 %") << 1 << 0.05 << 3.841459;
    QTest::newRow("1, 0.1 %") << 1 << 0.001 << 10.827566;
    QTest::newRow("2, 1 %") << 2 << 0.01 << 9.210340;
    QTest::newRow("3, 1 %") << 3 << 0.01 << 11.344867;
    QTest::newRow("6, 0.1 %") << 6 << 0.001 << 22.457744;
    QTest::newRow("9, 5 %") << 9 << 0.05 << 16.918978;
  }
  void limit_isThatOfTables() {
    QFETCH(int, count);
    QFETCH(double, probability);
    QFETCH(double, limit);
    QVERIFY(std::abs(chiSquaredLimit(probability, count) - limit) < 1e-5);
    QVERIFY(std::abs(chiSquaredTail(limit, count) / probability - 1.0) < 1e-5);
  }
  void normal_isThatOfTables() {
    QVERIFY(std::abs(normalLimit(0.05) - 1.644854) < 1e-6);
    QVERIFY(std::abs(normalLimit(0.5)) < 1e-9);
    QVERIFY(std::abs(normalLimit(0.975) + 1.959964) < 1e-6);
  }
};

EVICAL_TEST(TestChiSquared)
#include "tst_chi_squared.moc"
