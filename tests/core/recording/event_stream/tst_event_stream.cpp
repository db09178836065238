#include "core/base/error.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/packed_events.h"
#include "tests/support/test_program.h"

#include <cmath>

using namespace evical;
using namespace evical::test;

class TestEventStream : public QObject {
  Q_OBJECT

 private slots:
  void roundTrip_isExact_data();
  void roundTrip_isExact();
  void y_countsUpwardsInTheFile();
  void everyCut_keepsWhatIsWhole();
  void greyLevels_areLeftOut();
  void eventsOutside_areLeftOut();
  void badHeaders_areRefused_data();
  void badHeaders_areRefused();

 private:
  Contents read(const std::string& bytes) const { return readAll(scratch_.write("file.es", bytes)); }
  ScratchFolder scratch_;
};

void TestEventStream::roundTrip_isExact_data() {
  QTest::addColumn<bool>("atis");
  QTest::newRow("DVS") << false;
  QTest::newRow("ATIS") << true;
}

void TestEventStream::roundTrip_isExact() {
  QFETCH(bool, atis);
  std::vector<Event> events = someEvents(200'000, 1'000'000);
  for (std::size_t i = 1000; i < events.size(); ++i) events[i].time_ns += 777'000;  // many overflows
  const Contents contents = read(eventStreamHeader(64, 48, atis) + encodeEventStream(events, 48, atis));
  QVERIFY(sameEvents(contents.events.at(0), events));
  QVERIFY(contents.faults.empty());
  QCOMPARE(contents.streams[0].resolution_px.width_px, 64);
  QCOMPARE(contents.streams[0].resolution_px.height_px, 48);
}

void TestEventStream::y_countsUpwardsInTheFile() {
  const std::string event("\x03\x05\x00\x2F\x00", 5);  // 1 us, on, x 5, y 47
  const Contents contents = read(eventStreamHeader(64, 48, false) + event);
  QVERIFY(sameEvents(contents.events.at(0), {{1000, 5, 0, true}}));
}

void TestEventStream::everyCut_keepsWhatIsWhole() {
  const std::vector<Event> events = someEvents(10, 200'000);
  const std::string header = eventStreamHeader(64, 48, false);
  const std::string whole = header + encodeEventStream(events, 48, false);
  for (std::size_t size = header.size(); size < whole.size(); ++size) {
    const Contents contents = read(whole.substr(0, size));
    const std::size_t data = size - header.size(), overflows = std::min<std::size_t>(1, data);  // 200 us
    QCOMPARE(contents.eventCount(), (data - overflows) / 5);
    QCOMPARE(contents.hasFault(FaultKind::Truncated), (data - overflows) % 5 != 0);
  }
  for (std::size_t size = 12; size < header.size(); ++size)
    QVERIFY_THROWS_EXCEPTION(CalibrationError, read(whole.substr(0, size)));
}

void TestEventStream::greyLevels_areLeftOut() {
  std::string bytes = eventStreamHeader(64, 48, true) + encodeEventStream(someEvents(3, 1'000'000), 48, true);
  bytes += std::string("\x05\x01\x00\x01\x00", 5);
  const Contents contents = read(bytes);
  QCOMPARE(contents.eventCount(), 3u);
  QVERIFY(contents.hasFault(FaultKind::ExposureLeftOut));
}

void TestEventStream::eventsOutside_areLeftOut() {
  const std::string bytes = eventStreamHeader(10, 10, false) + std::string("\x03\x0A\x00\x00\x00", 5) +
                            std::string("\x03\x00\x00\x0A\x00", 5) + std::string("\x03\x09\x00\x09\x00", 5);
  const Contents contents = read(bytes);
  QVERIFY(sameEvents(contents.events.at(0), {{3000, 9, 0, true}}));
  QVERIFY(contents.faults.at(0).text.find("byte 20") != std::string::npos);
}

void TestEventStream::badHeaders_areRefused_data() {
  QTest::addColumn<QByteArray>("bytes");
  QTest::addColumn<QString>("said");
  QTest::newRow("version") << QByteArray("Event Stream\1\0\0\1\x40\1\xF0\0", 20) << "version 1.0";
  QTest::newRow("color") << QByteArray("Event Stream\2\0\0\4\x40\1\xF0\0", 20) << "color";
  QTest::newRow("generic") << QByteArray("Event Stream\2\0\0\0\x40\1\xF0\0", 20) << "generic";
  QTest::newRow("no size") << QByteArray("Event Stream\2\0\0\1\0\0\xF0\0", 20) << "0 x 240";
}

void TestEventStream::badHeaders_areRefused() {
  QFETCH(QByteArray, bytes);
  QFETCH(QString, said);
  try {
    read(bytes.toStdString());
    QFAIL("read");
  } catch (const CalibrationError& error) {
    QVERIFY(error.kind() == ErrorKind::BadInput);
    QVERIFY2(QString(error.what()).contains(said), error.what());
  }
}

EVICAL_TEST(TestEventStream)
#include "tst_event_stream.moc"
