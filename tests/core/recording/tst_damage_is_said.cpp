// Slightly damaged files: all events and samples are read, or there is a fault, or the file is refused.
#include "core/base/error.h"
#include "core/recording/recording_writer.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

using namespace evical;
using namespace evical::test;

namespace {

constexpr std::size_t kEvents = 3000, kSamples = 60;

void write(RecordingWriter& writer) {
  const std::vector<Event> events = someEvents(kEvents);
  const std::vector<ImuSample> samples = someSamples(kSamples);
  writer.write(0, EventSpan(events));
  writer.write(1, std::span(samples));
  writer.finish();
}

const std::vector<StreamInfo> kStreams = {{"events", StreamType::Events, "", {64, 48}},
                                          {"imu", StreamType::Imu, "", {}}};

bool isWholeOrSaid(const std::filesystem::path& path) {
  try {
    const Contents contents = readAll(path);
    return !contents.faults.empty() ||
           (contents.eventCount() == kEvents && contents.sampleCount() == kSamples);
  } catch (const CalibrationError& error) {
    return error.kind() == ErrorKind::BadInput;
  }
}

}  // namespace

class TestDamageIsSaid : public QObject {
  Q_OBJECT
 private slots:
  void aedat4_everyBitOfTheDescription();
  void aedat4_falseType_isThatOfThePackets();
  void hdf5_zeroTail();
  void hdf5_lostName();
  void tumVieImu_zeroHeadOrTail_data();
  void tumVieImu_zeroHeadOrTail();

 private:
  ScratchFolder folder_;
};

void TestDamageIsSaid::aedat4_everyBitOfTheDescription() {
  write(*createAedat4(folder_ / "whole.aedat4", kStreams, false));
  const std::string whole = fileBytes(folder_ / "whole.aedat4");
  const std::size_t begin = whole.find("<dv"), end = whole.find("</dv>");
  for (std::size_t at = begin; at < end; ++at) {
    for (const int bit : {0, 1, 5}) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << bit));
      QVERIFY2(isWholeOrSaid(folder_.write("bit.aedat4", bytes)),
               qPrintable(QString("bit %1 of byte %2").arg(bit).arg(at)));
    }
  }
}

void TestDamageIsSaid::aedat4_falseType_isThatOfThePackets() {
  write(*createAedat4(folder_ / "whole.aedat4", kStreams, false));
  std::string bytes = fileBytes(folder_ / "whole.aedat4");
  bytes[bytes.find("EVTS")] = 'G';
  bytes[bytes.find("IMUS")] = 'M';
  const Contents contents = readAll(folder_.write("type.aedat4", bytes));
  QCOMPARE(contents.eventCount(), kEvents);
  QCOMPARE(contents.sampleCount(), kSamples);
  QCOMPARE(contents.streams[0].type, StreamType::Events);
  QCOMPARE(contents.faults.size(), std::size_t{2});
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

void TestDamageIsSaid::hdf5_zeroTail() {
  write(*createDsec(folder_ / "whole.h5", kStreams));
  const std::string whole = fileBytes(folder_ / "whole.h5");
  for (std::size_t count = 64; count < whole.size(); count += 64) {
    std::string bytes = whole;
    bytes.replace(bytes.size() - count, count, std::string(count, '\0'));
    QVERIFY2(isWholeOrSaid(folder_.write("tail.h5", bytes)), qPrintable(QString::number(count)));
  }
}

// One letter of a dataset's name: the IMU's other two datasets remain.
void TestDamageIsSaid::hdf5_lostName() {
  write(*createDsec(folder_ / "whole.h5", kStreams));
  const std::string whole = fileBytes(folder_ / "whole.h5");
  for (const std::string& name : {std::string("omega"), std::string("accel")}) {
    std::string bytes = whole;
    for (std::size_t at = bytes.find(name); at != std::string::npos; at = bytes.find(name, at + 1))
      bytes[at + 4] = static_cast<char>(bytes[at + 4] + 1);
    const Contents contents = readAll(folder_.write("name.h5", bytes));
    QCOMPARE(contents.eventCount(), kEvents);
    QCOMPARE(contents.sampleCount(), std::size_t{0});
    QVERIFY2(contents.hasFault(FaultKind::Corrupt), name.c_str());
  }
}

void TestDamageIsSaid::tumVieImu_zeroHeadOrTail_data() {
  QTest::addColumn<bool>("head");
  QTest::addColumn<bool>("comment");  // as in the data set
  for (const bool comment : {false, true}) {
    QTest::addRow("head%s", comment ? ", comment" : "") << true << comment;
    QTest::addRow("tail%s", comment ? ", comment" : "") << false << comment;
  }
}

void TestDamageIsSaid::tumVieImu_zeroHeadOrTail() {
  QFETCH(bool, head);
  QFETCH(bool, comment);
  const std::filesystem::path folder = folder_ / (head ? "head" : "tail");
  std::filesystem::create_directories(folder);
  const std::vector<Event> events = someEvents(kEvents);
  const auto writer = createDsec(folder / "run-events_left.h5", {kStreams[0]});
  writer->write(0, EventSpan(events));
  writer->finish();
  std::string text = comment ? "# timestamp gx gy gz ax ay az temperature\n" : "";
  for (std::size_t i = 0; i < kSamples; ++i) text += std::to_string(5000 * i) + " 1 2 3 4 5 6 38.1\n";
  const auto samplesOf = [&](const std::string& content) {
    std::ofstream(folder / "imu_data.txt", std::ios::binary) << content;
    return readAll(folder);
  };
  const Contents whole = samplesOf(text);
  QCOMPARE(whole.sampleCount(), kSamples);
  QVERIFY(whole.faults.empty());
  for (const std::size_t count : {10, 100, 700}) {
    std::string bytes = text;
    bytes.replace(head ? 0 : bytes.size() - count, count, std::string(count, '\0'));
    const Contents contents = samplesOf(bytes);
    QVERIFY(contents.sampleCount() < kSamples || (head && comment && count == 10));
    QVERIFY2(contents.hasFault(FaultKind::Corrupt), qPrintable(QString::number(count)));
  }
}

EVICAL_TEST(TestDamageIsSaid)
#include "tst_damage_is_said.moc"
