// One recording compared with another, and with the joint solution that contains it.
#include "core/report/repeat_comparison.h"
#include "tests/support/test_program.h"

#include <cmath>
#include <limits>

using namespace evical;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Three recordings of one quantity; the third disagrees, and is not in the joint solution.
Repeatability threeRecordings() {
  Repeatability repeat;
  for (const char* const name : {"a", "b", "c"}) {
    RepeatedRecording recording;
    recording.name = name;
    repeat.recordings.push_back(recording);
    repeat.columns.emplace_back(name);
  }
  repeat.recordings.back().outcome = RepeatOutcome::DoesNotFit;
  return repeat;
}

RepeatedNumber number() {
  RepeatedNumber one;
  one.values = {1.0, 3.0, 10.0};
  one.sigmas = {0.3, 0.4, 0.5};
  one.joint = 1.72;  // weighted by 1/sigma^2
  one.joint_sigma = 0.24;
  return one;
}

}  // namespace

class TestRepeatComparison : public QObject {
  Q_OBJECT

 private slots:
  void twoRecordings_areIndependent() {
    const auto difference = differenceOf(threeRecordings(), number(), 0, 1);
    QVERIFY(difference);
    QCOMPARE(difference->value, 2.0);
    QCOMPARE(difference->sigma, 0.5);
    QCOMPARE(differenceOf(threeRecordings(), number(), 1, 0)->value, -2.0);
  }

  // var(a - joint) = var(a) - var(joint), as the joint solution is the optimum that includes a.
  void partOfAll_isComparedWithoutWhatBothHaveInCommon() {
    const auto difference = differenceOf(threeRecordings(), number(), 0, kAllTogether);
    QVERIFY(difference);
    QVERIFY(std::abs(difference->value - 0.72) < 1e-12);
    QVERIFY(std::abs(difference->sigma - 0.18) < 1e-12);
  }

  void oneThatDoesNotFit_isIndependentOfAll() {
    const auto difference = differenceOf(threeRecordings(), number(), kAllTogether, 2);
    QVERIFY(std::abs(difference->sigma - std::hypot(0.24, 0.5)) < 1e-12);
  }

  void whatARecordingDoesNotTell_isNoDifference() {
    RepeatedNumber one = number();
    one.values[1] = kNone;
    one.sigmas[1] = kNone;
    QVERIFY(!differenceOf(threeRecordings(), one, 0, 1));
    QVERIFY(!differenceOf(threeRecordings(), one, 0, 0));
    one.joint_sigma = 0.0;  // separate in each recording
    QVERIFY(!differenceOf(threeRecordings(), one, 0, kAllTogether));
    QVERIFY(!numberOf(one, 7));
  }
};

EVICAL_TEST(TestRepeatComparison)
#include "tst_repeat_comparison.moc"
