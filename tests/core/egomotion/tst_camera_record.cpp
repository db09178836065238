// Edges kept from a recording: memory is bounded, and the kept ones are spread over the whole recording.
#include "core/egomotion/camera_record.h"

#include "tests/support/test_program.h"

#include <QTest>

using namespace evical;

class TestCameraRecord : public QObject {
  Q_OBJECT

 private slots:
  void longRecordings_keepEverySecondWindow() {
    EgomotionOptions options;
    options.kept_windows = 100;
    options.kept_slopes = 10;
    KeptSlopes kept;
    const std::vector<EdgeSlope> slopes(35);
    for (std::size_t k = 0; k < 1000; ++k) kept.add(k, static_cast<std::int64_t>(k), slopes, options);
    QVERIFY(kept.windows().size() <= 100 && kept.windows().size() > 50);
    const std::size_t step = kept.windows()[1].index;
    for (std::size_t k = 0; k < kept.windows().size(); ++k) {
      QCOMPARE(kept.windows()[k].index, k * step);
      QVERIFY(kept.windows()[k].slopes.size() <= 10 && kept.windows()[k].slopes.size() > 5);
    }
    QVERIFY(kept.windows().back().index + step >= 1000);
  }
};

EVICAL_TEST(TestCameraRecord)
#include "tst_camera_record.moc"
