// Recordings of other people's programs, which are too many or not free enough to lie in tests/data: in the folder that
// EVICAL_DATA names. Counts and sums are those of other decoders, from its manifest.
#include "core/recording/recording_reader.h"

#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

#include <filesystem>

namespace {

using namespace evical;

struct SampleDataSums {
  quint64 events = 0, on = 0, x = 0, y = 0;

  bool operator==(const SampleDataSums&) const = default;
};

SampleDataSums sumsOfSampleData(const test::Contents& contents) {
  SampleDataSums sums;
  for (const auto& [stream, events] : contents.events) {
    for (const Event& event : events) {
      ++sums.events;
      sums.on += event.brighter;
      sums.x += event.x_px;
      sums.y += event.y_px;
    }
  }
  return sums;
}

class TestSampleData : public QObject {
  Q_OBJECT

 private slots:
  void recordings_areReadAsOtherDecodersReadThem_data() {
    QTest::addColumn<QString>("file");
    QTest::addColumn<QList<quint64>>("sums");  // events, ON events, x, y
    QTest::addColumn<int>("samples");
    const auto row = [](const char* file, const QList<quint64>& sums, int samples = 0) {
      QTest::newRow(file) << QString(file) << sums << samples;
    };
    row("real/dvxplorer_events_imu.aedat4", {111954, 55023, 18342405, 15105898}, 475);
    row("derived/npz_dvxplorer.npz", {20000, 9911, 3294224, 2695156});
    row("real/evlib_event.txt", {17, 0, 1801, 1103});
    row("real/gen3_evt2.raw", {539481, 367855, 171811022, 110162026});
    row("real/ros1_evt3_with_triggers.bag", {343474, 125183, 116731888, 80879209});
    // The format's y points up, ours down.
    row("real/sepia_dvs_first_part.es", {159996, 116617, 25258195, 159996 * 239 - 13876538});
  }

  void recordings_areReadAsOtherDecodersReadThem() {
    const QString folder = qEnvironmentVariable("EVICAL_DATA");
    if (folder.isEmpty()) QSKIP("EVICAL_DATA, the folder of sample recordings, is not set");
    QFETCH(QString, file);
    QFETCH(QList<quint64>, sums);
    QFETCH(int, samples);
    const std::filesystem::path path = (folder + "/formats/" + file).toStdString();
    const test::Contents contents = test::readAll(*openRecording(path));
    const SampleDataSums found = sumsOfSampleData(contents);
    QCOMPARE((QList<quint64>{found.events, found.on, found.x, found.y}), sums);
    QCOMPARE(static_cast<int>(contents.sampleCount()), samples);
  }
};

}  // namespace

EVICAL_TEST(TestSampleData)
#include "tst_sample_data.moc"
