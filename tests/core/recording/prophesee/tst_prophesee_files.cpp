#include "core/base/error.h"
#include "core/base/time.h"
#include "core/recording/conversion.h"
#include "core/recording/recording_writer.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/packed_events.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

using namespace evical;
using namespace evical::test;

namespace {

const std::string kEvt2Header = "% evt 2.0\n% format EVT2;height=480;width=640\n% geometry 640x480\n% end\n";

// Rows of neighbours, some separate, over blocks of many sizes; whole us.
std::vector<Event> rowsForPropheseeFiles(std::size_t count, std::int64_t start_ns) {
  std::vector<Event> events;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t row = i / 5;
    events.push_back({start_ns + static_cast<std::int64_t>(row * 3) * 1000,
                      static_cast<std::uint16_t>(row * 7 % 600 + i % 5 * (1 + row % 4)),
                      static_cast<std::uint16_t>(row * 11 % 480), row % 3 == 0});
  }
  return events;
}

std::string encoded(const QString& format, EventSpan events) {
  if (format == "EVT2") return kEvt2Header + encodeEvt2(events);
  if (format == "EVT2 old") return "% Date 2020-09-14 09:03:25\n% system_ID 21\n" + encodeEvt2(events);
  if (format == "EVT2.1 little")
    return "% format EVT21;endianness=little;height=480;width=640\n% end\n" + encodeEvt21(events, false);
  if (format == "EVT2.1 legacy")
    return "% evt 2.1\n% geometry 640x480\n% system_ID 49\n% end\n" + encodeEvt21(events, true);
  if (format == "EVT2.1 unstated plain")
    return "% evt 2.1\n% geometry 640x480\n% end\n" + encodeEvt21(events, false);
  if (format == "EVT2.1 unstated exchanged")
    return "% evt 2.1\n% geometry 640x480\n% end\n" + encodeEvt21(events, true);
  if (format == "EVT3") return "% format EVT3;height=480;width=640\n% end\n" + encodeEvt3(events);
  if (format == "DAT") return "% Version 2\n% Height 480\n% Width 640\n" + encodeDat(events);
  return encodeDat(events);  // without any header
}

}  // namespace

class TestPropheseeFiles : public QObject {
  Q_OBJECT

 private slots:
  void roundTrip_isExact_data();
  void roundTrip_isExact();
  void whatIsWritten_isReadBack_data();
  void whatIsWritten_isReadBack();
  void whatHasNoPlace_isRefused();
  void strayStamps_areLeftOut_data();
  void strayStamps_areLeftOut();
  void size_isThatOfTheHeader();
  void everyCut_keepsWhatIsWhole();
  void time_wraps_data();
  void time_wraps();
  void clockReset_startsAPacket();
  void disorder_isSortedAndSaid();
  void eventsOutside_areLeftOutWithTheirByte();
  void eventsBeforeTheFirstTime_areLeftOut();
  void strangeWords_areCounted();
  void triggers_areCounted();
  void datOfTriggers_hasNoEvents();
  void oldDat_hasItsOwnBits();
  void badHeaders_areRefused_data();
  void badHeaders_areRefused();
  void unknownSize_isSaid();

 private:
  Contents read(const std::string& bytes) const { return readAll(scratch_.write("file", bytes)); }
  ScratchFolder scratch_;
};

void TestPropheseeFiles::roundTrip_isExact_data() {
  QTest::addColumn<QString>("format");
  for (const char* format : {"EVT2", "EVT2 old", "EVT2.1 little", "EVT2.1 legacy", "EVT2.1 unstated plain",
                             "EVT2.1 unstated exchanged", "EVT3", "DAT", "DAT bare"})
    QTest::newRow(format) << QString(format);
}

void TestPropheseeFiles::roundTrip_isExact() {
  QFETCH(QString, format);
  const std::vector<Event> events = rowsForPropheseeFiles(300'000, 2 * kSecond_ns);  // several blocks
  const Contents contents = read(encoded(format, events));
  QVERIFY(contents.streams[0].type == StreamType::Events);
  QCOMPARE(contents.streams[0].time_unit_ns, std::int64_t{1000});
  QVERIFY(sameEvents(contents.events.at(0), events));
  QCOMPARE(contents.faults.size(), format == "DAT bare" ? 1u : 0u);
}

// Over three wraps of EVT3's counter; with a late beginning, times count from the first event.
void TestPropheseeFiles::whatIsWritten_isReadBack_data() {
  QTest::addColumn<QString>("format");
  QTest::addColumn<qint64>("start_ns");
  for (const char* const format : {"raw", "dat"}) {
    QTest::addRow("%s", format) << QString(format) << qint64{1'000'000'000};
    QTest::addRow("%s, of a host's clock", format) << QString(format) << qint64{1'700'000'000'123'456'000};
  }
}

void TestPropheseeFiles::whatIsWritten_isReadBack() {
  QFETCH(QString, format);
  QFETCH(qint64, start_ns);
  std::vector<Event> events = rowsForPropheseeFiles(60'000, start_ns);
  for (std::size_t i = 0; i < events.size(); ++i)
    events[i].time_ns += static_cast<std::int64_t>(i / 10) * 10'000'000;
  StreamInfo stream;
  stream.name = "/camera/events";
  stream.type = StreamType::Events;
  stream.resolution_px = {640, 480};
  const std::filesystem::path path = scratch_ / ("written." + format.toStdString());
  const auto writer = createRecording(path, format.toStdString(), {stream});
  for (std::size_t i = 0; i < events.size(); i += 777)
    writer->write(0, EventSpan(events).subspan(i, std::min<std::size_t>(777, events.size() - i)));
  writer->finish();
  const Contents contents = readAll(path);
  QVERIFY(contents.streams[0].resolution_px == stream.resolution_px);
  QCOMPARE(contents.streams[0].name, writer->streamNames()[0]);
  if (start_ns > 1'000'000'000'000)
    for (Event& event : events) event.time_ns -= start_ns;
  QVERIFY(sameEvents(contents.events.at(0), events));
}

void TestPropheseeFiles::whatHasNoPlace_isRefused() {
  StreamInfo events, imu;
  events.name = "events";
  events.type = StreamType::Events;
  events.resolution_px = {640, 480};
  imu.name = "imu";
  imu.type = StreamType::Imu;
  for (const char* const format : {"raw", "dat"}) {
    QVERIFY_THROWS_EXCEPTION(CalibrationError, createRecording(scratch_ / "no", format, {events, imu}));
    QVERIFY_THROWS_EXCEPTION(CalibrationError, createRecording(scratch_ / "no", format, {events, events}));
    StreamInfo unknown = events;
    unknown.resolution_px = {};
    QVERIFY_THROWS_EXCEPTION(CalibrationError, createRecording(scratch_ / "no", format, {unknown}));
  }
  QVERIFY(!std::filesystem::exists(scratch_ / "no"));
}

void TestPropheseeFiles::strayStamps_areLeftOut_data() {
  QTest::addColumn<QString>("format");
  for (const char* const format : {"raw", "dat"}) QTest::newRow(format) << QString(format);
}

// A first event stamped 0 before those of a host's clock, and one of next year: neither fills the file with
// counter words.
void TestPropheseeFiles::strayStamps_areLeftOut() {
  QFETCH(QString, format);
  constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000, kYear_ns = 31'536'000'000'000'000;
  std::vector<Event> events = rowsForPropheseeFiles(20'000, kStart_ns);
  events.front().time_ns = 0;
  events[10'000].time_ns += kYear_ns;
  StreamInfo stream;
  stream.name = "/camera/events";
  stream.type = StreamType::Events;
  stream.resolution_px = {640, 480};
  const std::filesystem::path bag = scratch_ / "stray.bag",
                              path = scratch_ / ("stray." + format.toStdString());
  const auto writer = createBag(bag, {stream}, false);
  writer->write(0, EventSpan(events));
  writer->finish();
  Log log;
  ConversionRequest request;
  request.input = bag;
  request.output = path;
  QCOMPARE(convertRecording(request, RunContext{log}).events, std::uint64_t{20'000 - 2});
  QVERIFY2(log.said.find("2 events are left out") != std::string::npos, log.said.c_str());
  QVERIFY2(log.said.find("clock_offset_s: 17000000") != std::string::npos, log.said.c_str());
  QCOMPARE(readAll(path).events.at(0).size(), std::size_t{20'000 - 2});
  QVERIFY(std::filesystem::file_size(path) < 1'000'000);
  // Writing without that filter is refused.
  const auto direct = createRecording(scratch_ / "direct", format.toStdString(), {stream});
  QVERIFY_THROWS_EXCEPTION(CalibrationError, direct->write(0, EventSpan(events)));
}

void TestPropheseeFiles::size_isThatOfTheHeader() {
  for (const char* format : {"EVT2", "EVT2 old", "EVT2.1 legacy", "EVT3", "DAT"}) {
    const Contents contents = read(encoded(format, rowsForPropheseeFiles(10, kSecond_ns)));
    QCOMPARE(contents.streams[0].resolution_px.width_px, 640);
    QCOMPARE(contents.streams[0].resolution_px.height_px, 480);
  }
}

void TestPropheseeFiles::everyCut_keepsWhatIsWhole() {
  const std::vector<Event> events = rowsForPropheseeFiles(20, kSecond_ns);
  for (const char* format : {"EVT2", "EVT2.1 little", "EVT3", "DAT"}) {
    const std::string header = encoded(format, {}), whole = encoded(format, events);
    for (std::size_t size = header.size(); size < whole.size(); ++size) {
      const Contents contents = read(whole.substr(0, size));
      QVERIFY(contents.eventCount() <= events.size());
      const auto expected = EventSpan(events).first(contents.eventCount());
      if (contents.eventCount() > 0)
        QVERIFY(sameEvents(contents.events.at(0), {expected.begin(), expected.end()}));
      const std::size_t word = std::string(format) == "EVT2" ? 4 : std::string(format) == "EVT3" ? 2 : 8;
      QCOMPARE(contents.hasFault(FaultKind::Truncated), (size - header.size()) % word != 0);
    }
    for (std::size_t size = 1; size < header.size() - 2; ++size) {
      try {
        QCOMPARE(read(whole.substr(0, size)).eventCount(), 0u);  // the header may end with any of its lines
      } catch (const CalibrationError& error) {
        QVERIFY(error.kind() == ErrorKind::BadInput);
      }
    }
  }
}

void TestPropheseeFiles::time_wraps_data() {
  QTest::addColumn<QString>("format");
  QTest::addColumn<qlonglong>("period_us");
  QTest::newRow("EVT2") << "EVT2" << (1LL << 34);
  QTest::newRow("EVT2.1") << "EVT2.1 little" << (1LL << 34);
  QTest::newRow("EVT3") << "EVT3" << (1LL << 24);
  QTest::newRow("DAT") << "DAT" << (1LL << 32);
}

void TestPropheseeFiles::time_wraps() {
  QFETCH(QString, format);
  QFETCH(qlonglong, period_us);
  const std::vector<Event> events = rowsForPropheseeFiles(5000, (period_us - 1000) * 1000);
  const Contents contents = read(encoded(format, events));
  QVERIFY(sameEvents(contents.events.at(0), events));
  if (format != "EVT3") QVERIFY(contents.hasFault(FaultKind::TimeWrap));
}

void TestPropheseeFiles::clockReset_startsAPacket() {
  std::vector<Event> events = rowsForPropheseeFiles(100, 100 * kSecond_ns);
  const std::vector<Event> later = rowsForPropheseeFiles(100, kSecond_ns);
  events.insert(events.end(), later.begin(), later.end());
  const auto reader = openRecording(scratch_.write("reset.raw", kEvt2Header + encodeEvt2(events)));
  Packet packet;
  QVERIFY(reader->read(packet));
  QCOMPARE(packet.events.size(), 100u);
  QVERIFY(reader->read(packet));
  QVERIFY(sameEvents(packet.events, later));
  QVERIFY(!reader->read(packet));
}

void TestPropheseeFiles::disorder_isSortedAndSaid() {
  std::vector<Event> events = rowsForPropheseeFiles(100, kSecond_ns);
  std::swap(events[50], events[60]);
  const Contents contents = read(kEvt2Header + encodeEvt2(events));
  QVERIFY(std::is_sorted(contents.events.at(0).begin(), contents.events.at(0).end(),
                         [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; }));
  QCOMPARE(contents.eventCount(), 100u);
  QVERIFY(contents.hasFault(FaultKind::Unsorted));
}

void TestPropheseeFiles::eventsOutside_areLeftOutWithTheirByte() {
  std::vector<Event> events = rowsForPropheseeFiles(10, kSecond_ns);
  events[3].x_px = 640;
  events[4].y_px = 480;
  for (const char* format : {"EVT2", "EVT2.1 little", "EVT3", "DAT"}) {
    const Contents contents = read(encoded(format, events));
    QCOMPARE(contents.eventCount(), 8u);
    QCOMPARE(contents.faults.size(), 1u);
    QCOMPARE(contents.faults[0].kind, FaultKind::Outside);
    QVERIFY(contents.faults[0].text.starts_with("2 events"));
  }
  const Contents contents = read(encoded("EVT2", events));
  QVERIFY(contents.faults[0].text.find(std::to_string(kEvt2Header.size() + 4 * 4)) != std::string::npos);
}

void TestPropheseeFiles::eventsBeforeTheFirstTime_areLeftOut() {
  const std::string data = encodeEvt2(rowsForPropheseeFiles(10, kSecond_ns));
  const Contents contents = read(kEvt2Header + data.substr(4, 8) + data);
  QCOMPARE(contents.eventCount(), 10u);
  QVERIFY(contents.hasFault(FaultKind::Untimed));
}

void TestPropheseeFiles::strangeWords_areCounted() {
  std::string data = encodeEvt2(rowsForPropheseeFiles(10, kSecond_ns));
  appendWord(data, std::uint32_t{0x50000000});
  appendWord(data, std::uint32_t{0xD0000002});
  appendWord(data, std::uint32_t{0xE0000000});
  const Contents contents = read(kEvt2Header + data);
  QCOMPARE(contents.eventCount(), 10u);
  QCOMPARE(contents.faults.size(), 2u);
  QVERIFY(contents.hasFault(FaultKind::Corrupt) && contents.hasFault(FaultKind::ImuLeftOut));
}

void TestPropheseeFiles::triggers_areCounted() {
  std::string data = encodeEvt2(rowsForPropheseeFiles(10, kSecond_ns));
  appendWord(data, std::uint32_t{0xA0000001});
  appendWord(data, std::uint32_t{0xA0000000});
  const Contents contents = read(kEvt2Header + data);
  QCOMPARE(contents.streams.size(), 2u);
  QVERIFY(contents.streams[1].type == StreamType::Triggers);
  QCOMPARE(contents.streams[1].messages, std::uint64_t{2});
}

void TestPropheseeFiles::datOfTriggers_hasNoEvents() {
  const Contents contents = read("% Version 2\n" + std::string("\x0E\x08", 2) + std::string(24, '\1'));
  QCOMPARE(contents.streams.size(), 1u);
  QCOMPARE(contents.streams[0].messages, std::uint64_t{3});
  QCOMPARE(contents.eventCount(), 0u);
}

void TestPropheseeFiles::oldDat_hasItsOwnBits() {
  std::string bytes("% Date 2012-01-01\n% Version 1\n\x00\x08", 32);
  appendWord(bytes, std::uint32_t{77});
  appendWord(bytes, std::uint32_t{300 | 200 << 9 | 1 << 17});
  const Contents contents = read(bytes);
  QVERIFY(sameEvents(contents.events.at(0), {{77'000, 300, 200, true}}));
}

void TestPropheseeFiles::badHeaders_areRefused_data() {
  QTest::addColumn<QByteArray>("bytes");
  QTest::addColumn<QString>("said");
  QTest::newRow("histograms") << QByteArray("% format HISTO3D;height=320;width=320\n% end\n") << "HISTO3D";
  QTest::newRow("EVT4") << QByteArray("% evt 4.0\n% end\n") << "4.0";
  QTest::newRow("cut") << QByteArray("% evt 2.0\n% geome") << "byte 10";
  QTest::newRow("nothing known") << QByteArray("% Date today\n% end\n\1\2\3\4") << "encoding";
  QTest::newRow("not text") << QByteArray("% \1\2\3\n") << "byte 0";
}

void TestPropheseeFiles::badHeaders_areRefused() {
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

void TestPropheseeFiles::unknownSize_isSaid() {
  const Contents contents =
      read("% evt 2.0\n% geometry 0x99999\n% end\n" + encodeEvt2(rowsForPropheseeFiles(10, kSecond_ns)));
  QVERIFY(!contents.streams[0].resolution_px.known());
  QVERIFY(contents.hasFault(FaultKind::NoResolution));
  QCOMPARE(contents.eventCount(), 10u);
}

EVICAL_TEST(TestPropheseeFiles)
#include "tst_prophesee_files.moc"
