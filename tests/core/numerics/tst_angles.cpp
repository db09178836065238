#include "core/numerics/angles.h"

#include "tests/support/test_program.h"

#include <cmath>

using namespace evical;

class TestAngles : public QObject {
  Q_OBJECT

 private slots:
  void aRightAngle_isNinetyDegrees() {
    QVERIFY(kPi == 2.0 * std::acos(0.0));  // to the last bit
    QVERIFY(kDegPerRad == 90.0 / std::acos(0.0));
    QVERIFY(kRadPerDeg == std::acos(0.0) / 90.0);
  }
};

EVICAL_TEST(TestAngles)
#include "tst_angles.moc"
