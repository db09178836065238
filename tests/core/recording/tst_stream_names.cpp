// Stream names that writers announce are those that readers report: the new file need not be opened to know
// them.
#include "core/base/error.h"
#include "core/base/plain_text.h"
#include "core/recording/conversion.h"
#include "core/recording/recording_writer.h"

#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

#include <span>

namespace {

using namespace evical;
using namespace evical::test;

class TestStreamNames : public QObject {
  Q_OBJECT

 private slots:
  void streamNames_areThoseThatReadersGive_data();
  void streamNames_areThoseThatReadersGive();
  void conversion_tellsNewNames_alsoOfAnEmptyRecording();
  void namesWithControlCharacters_areListedVisibly_andNotRead_data();
  void namesWithControlCharacters_areListedVisibly_andNotRead();
  void fileWithALineBreakInItsName_isRead();

 private:
  ScratchFolder scratch_;
};

StreamInfo stream(const std::string& name, const std::string& source = {}) {
  const bool events = name.find("imu") == std::string::npos;
  StreamInfo info;
  info.name = name;
  info.type = events ? StreamType::Events : StreamType::Imu;
  if (events) info.resolution_px = {64, 48};
  info.source = source;
  return info;
}

std::vector<StreamInfo> streamsNamed(const QStringList& names) {
  std::vector<StreamInfo> streams;
  for (const QString& name : names) {
    const QStringList parts = name.split('|');
    streams.push_back(stream(parts[0].toStdString(), parts.size() > 1 ? parts[1].toStdString() : ""));
  }
  return streams;
}

void writeSome(RecordingWriter& writer, const std::vector<StreamInfo>& streams) {
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (streams[i].type == StreamType::Events) {
      writer.write(i, EventSpan(someEvents(20)));
    } else {
      writer.write(i, std::span<const ImuSample>(someSamples(5)));
    }
  }
  writer.finish();
}

void TestStreamNames::streamNames_areThoseThatReadersGive_data() {
  QTest::addColumn<QString>("format");
  QTest::addColumn<QStringList>("given");  // "name" or "name|source"
  for (const RecordingFormat& format : recordingFormats()) {
    const QString name = format.name;
    if (format.one_camera) {
      QTest::addRow("%s, camera alone", format.name) << name << QStringList{"events"};
      continue;
    }
    QTest::addRow("%s, camera and IMU", format.name) << name << QStringList{"/dvs/events", "/dvs/imu"};
    QTest::addRow("%s, camera alone", format.name) << name << QStringList{"events"};
    QTest::addRow("%s, IMU alone", format.name) << name << QStringList{"some_imu"};
    if (format.isFolder() || name == "dsec") continue;  // one stream per type
    QTest::addRow("%s, rig", format.name)
        << name << QStringList{"/left/events", "/right/events", "/left/imu", "/right/imu"};
    QTest::addRow("%s, nobody's", format.name) << name << QStringList{"a", "b", "imu"};
    QTest::addRow("%s, sources", format.name)
        << name << QStringList{"DVX_1/events|DVX_1", "DVX_2/events|DVX_2", "imu|DVX_2"};
    QTest::addRow("%s, two of one source", format.name)
        << name << QStringList{"noisy|DVX_1", "clean|DVX_1", "DVX_2/clean|DVX_2"};
  }
}

void TestStreamNames::streamNames_areThoseThatReadersGive() {
  QFETCH(QString, format);
  QFETCH(QStringList, given);
  const RecordingFormat& chosen = recordingFormat(format.toStdString());
  std::filesystem::path path = scratch_ / QTest::currentDataTag();
  path += chosen.extension;
  if (chosen.isFolder()) std::filesystem::create_directories(path);
  const std::vector<StreamInfo> streams = streamsNamed(given);
  const std::unique_ptr<RecordingWriter> writer = createRecording(path, chosen.name, streams);
  writeSome(*writer, streams);
  const std::vector<std::string> names = writer->streamNames();
  QCOMPARE(names.size(), streams.size());
  const std::unique_ptr<RecordingReader> reader = openRecording(path);
  const std::size_t triggers =
      chosen.name == std::string_view("raw") ? 1 : 0;  // RAW has a stream for triggers
  QCOMPARE(reader->streams().size(), streams.size() + triggers);
  for (std::size_t i = 0; i < streams.size(); ++i)
    findStream(*reader, names[i], streams[i].type);  // throws if there is none
}

// A file with topics only is useless as a recording, but its conversion has succeeded.
void TestStreamNames::conversion_tellsNewNames_alsoOfAnEmptyRecording() {
  ConversionRequest request;
  request.input = scratch_.write("empty/samples.csv", "t_s,ax,ay,az,gx,gy,gz\n");
  for (const char* file : {"empty.bag", "empty.mcap", "empty.aedat4", "empty.h5"}) {
    request.output = scratch_ / file;
    Log log;
    QCOMPARE(convertRecording(request, RunContext{log}).imu_samples, std::uint64_t{0});
    const bool renamed = request.output.extension() == ".aedat4" || request.output.extension() == ".h5";
    const bool told = log.said.find("samples.csv is called imu") != std::string::npos;
    QVERIFY2(told == renamed, (request.output.string() + ": " + log.said).c_str());
  }
}

void TestStreamNames::namesWithControlCharacters_areListedVisibly_andNotRead_data() {
  QTest::addColumn<QByteArray>("name");
  QTest::addColumn<QByteArray>("shown");
  QTest::newRow("ESC") << QByteArray("/dvs\x1b[2J") << QByteArray("/dvs\\x1b[2J");
  QTest::newRow("CR") << QByteArray("/a\rb") << QByteArray("/a\\x0db");
  QTest::newRow("NEL") << QByteArray("/a\xc2\x85") << QByteArray("/a\\u0085");
  QTest::newRow("line separator") << QByteArray("/a\xe2\x80\xa8") << QByteArray("/a\\u2028");
}

void TestStreamNames::namesWithControlCharacters_areListedVisibly_andNotRead() {
  QFETCH(QByteArray, name);
  QFETCH(QByteArray, shown);
  const std::vector<StreamInfo> streams{stream(name.toStdString()), stream("/plain"), stream("/imu")};
  for (const char* const file : {"names.bag", "names.mcap", "names.aedat4"}) {
    const auto path = scratch_ / (std::string(QTest::currentDataTag()) + file);
    const std::string format = path.extension().string().substr(1);
    writeSome(*createRecording(path, format, streams), streams);
    const std::unique_ptr<RecordingReader> reader = openRecording(path);
    const Contents contents = test::readAll(*reader);
    std::size_t hostile = 0;
    for (std::size_t i = 0; i < contents.streams.size(); ++i) {
      const StreamInfo& each = contents.streams[i];
      QVERIFY(!hasControl(each.name) && !hasControl(each.source));
      if (each.name.find(shown.toStdString().substr(1)) == std::string::npos) continue;
      ++hostile;
      QVERIFY(each.type == StreamType::Other && !contents.events.contains(i));
    }
    QCOMPARE(hostile, std::size_t{1});
    QCOMPARE(contents.eventCount(), std::size_t{20});
    QCOMPARE(contents.sampleCount(), std::size_t{5});
    QVERIFY(contents.hasFault(FaultKind::Unreadable));
    QVERIFY_THROWS_EXCEPTION(CalibrationError, findStream(*reader, shown.toStdString(), StreamType::Events));
  }
}

// The user's own files may have any name.
void TestStreamNames::fileWithALineBreakInItsName_isRead() {
  const auto path =
      scratch_.write("a\nb.csv", "t_s,ax,ay,az,gx,gy,gz\n0,0,0,9.8,0,0,0\n0.01,0,0,9.8,0,0,0\n");
  const Contents contents = test::readAll(path);
  QCOMPARE(contents.streams.at(0).name, std::string("a\\x0ab.csv"));
  QCOMPARE(contents.sampleCount(), std::size_t{2});
}

}  // namespace

EVICAL_TEST(TestStreamNames)
#include "tst_stream_names.moc"
