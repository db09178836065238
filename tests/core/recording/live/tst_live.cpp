// Files that grow while they are read, in pieces of any size, and recordings that can be read while they are
// written.
#include "core/base/error.h"
#include "core/recording/live/growth.h"
#include "core/recording/live/live_recording.h"
#include "core/recording/recording_writer.h"
#include "tests/core/recording/sample_recording.h"
#include "tests/support/test_program.h"

#include <chrono>
#include <fstream>
#include <random>
#include <thread>

using namespace evical;
using namespace evical::test;

class TestLive : public QObject {
  Q_OBJECT
 private slots:
  void growingFile_isReadAsAWholeOne_data();
  void growingFile_isReadAsAWholeOne();
  void growingFile_isReadUpToItsEnd();
  void flushedFile_hasEverythingSoFar_data();
  void flushedFile_hasEverythingSoFar();
  void growingFile_isRecorded_data() { flushedFile_hasEverythingSoFar_data(); }
  void growingFile_isRecorded();

 private:
  std::filesystem::path write(const std::string& format, const Recording& recording) const;
  ScratchFolder folder_;
};

std::filesystem::path TestLive::write(const std::string& format, const Recording& recording) const {
  const RecordingFormat& of = recordingFormat(format);
  const std::filesystem::path path = folder_ / ("whole" + std::string(of.extension));
  std::filesystem::create_directories(of.isFolder() ? path : path.parent_path());
  std::vector<StreamInfo> streams = sampleStreams();
  if (of.one_camera) streams.resize(1);
  const auto writer = createRecording(path, format, streams);
  if (of.one_camera) {
    writer->write(0, EventSpan(recording.events));
    writer->finish();
  } else {
    writeAll(*writer, recording);
  }
  return of.isFolder() ? path / ("events" + std::string(format == "csv" ? ".csv" : ".txt")) : path;
}

namespace {

// Appends the bytes from `from` on in random pieces.
void grow(const std::filesystem::path& path, std::string_view bytes, Growth* growth) {
  std::mt19937 random(7);
  std::ofstream file(path, std::ios::binary | std::ios::app);
  while (!bytes.empty()) {
    const std::size_t piece = std::min<std::size_t>(bytes.size(), 1 + random() % 60'000);
    file << bytes.substr(0, piece) << std::flush;
    bytes.remove_prefix(piece);
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 2000));
  }
  if (growth != nullptr) growth->end();
}

}  // namespace

void TestLive::growingFile_isReadAsAWholeOne_data() {
  QTest::addColumn<QString>("format");
  for (const char* format : {"bag", "mcap", "aedat4", "raw", "dat", "text", "csv"})
    QTest::newRow(format) << format;
}

void TestLive::growingFile_isReadAsAWholeOne() {
  QFETCH(QString, format);
  const std::string bytes = fileBytes(write(format.toStdString(), sampleRecording(400'000)));
  const std::filesystem::path whole = folder_ / "all", growing = folder_ / "growing";
  writeFile(whole, bytes);
  const std::size_t first = bytes.size() / 3;
  writeFile(growing, bytes.substr(0, first));
  const auto reader = openRecording(growing);
  const auto growth = std::make_shared<Growth>(growing, Growth::EndsBy::Writer);
  QVERIFY(reader->follow(growth));
  const std::jthread writing([&] { grow(growing, std::string_view(bytes).substr(first), growth.get()); });
  const Contents got = readAll(*reader), expected = readAll(whole);
  QCOMPARE(got.streams.size(), expected.streams.size());
  for (const auto& [stream, events] : expected.events) QVERIFY(sameEvents(got.events.at(stream), events));
  for (const auto& [stream, samples] : expected.imu) QVERIFY(sameSamples(got.imu.at(stream), samples));
  QCOMPARE(got.eventCount(), expected.eventCount());
  QCOMPARE(got.sampleCount(), expected.sampleCount());
  QVERIFY2(got.faults.empty(), got.faults.empty() ? "" : got.faults.front().text.c_str());
}

// Another program's file that stops growing anywhere.
void TestLive::growingFile_isReadUpToItsEnd() {
  const std::string bytes = fileBytes(write("mcap", sampleRecording(400'000)));
  const std::filesystem::path growing = folder_ / "stopped.mcap";
  const std::size_t first = bytes.size() / 3;
  writeFile(growing, bytes.substr(0, first));
  const auto reader = openRecording(growing);
  QVERIFY(reader->follow(std::make_shared<Growth>(growing, Growth::EndsBy::Silence)));
  grow(growing, std::string_view(bytes).substr(first, first), nullptr);
  const auto begin = std::chrono::steady_clock::now();
  const Contents got = readAll(*reader);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  QVERIFY2(took.count() >= 0.9 * Growth::kSilence_s, qPrintable(QString::number(took.count())));
  QCOMPARE(got.eventCount(), readAll(growing).eventCount());
  QVERIFY(got.eventCount() > 150'000);
}

void TestLive::flushedFile_hasEverythingSoFar_data() {
  QTest::addColumn<QString>("format");
  for (const RecordingFormat& format : recordingFormats())
    if (format.live) QTest::newRow(format.name) << format.name;
}

void TestLive::flushedFile_hasEverythingSoFar() {
  QFETCH(QString, format);
  const std::filesystem::path path =
      folder_ / ("flushed" + std::string(recordingFormat(format.toStdString()).extension));
  const Recording recording = sampleRecording(30'000);
  {
    const auto writer = createRecording(path, format.toStdString(), sampleStreams());
    writer->write(1, std::span(recording.imu_samples));
    QVERIFY(!std::filesystem::exists(path));
    for (std::size_t i = 0; i < 30; ++i) {
      writer->write(0, EventSpan(recording.events).subspan(1000 * i, 1000));
      writer->flush();
      const Contents now = readAll(path);
      QCOMPARE(now.eventCount(), 1000 * (i + 1));
      QCOMPARE(now.sampleCount(), recording.imu_samples.size());
    }
  }
  QCOMPARE(readAll(path).eventCount(), std::size_t{30'000});  // also without finish()
}

void TestLive::growingFile_isRecorded() {
  QFETCH(QString, format);
  const std::string bytes = fileBytes(write("bag", sampleRecording(200'000)));
  const std::filesystem::path growing = folder_ / "source.bag";
  const std::size_t first = bytes.size() / 2;
  writeFile(growing, bytes.substr(0, first));
  LiveRequest request;
  request.sources = {growing.string()};
  request.output = folder_ / ("recorded" + std::string(recordingFormat(format.toStdString()).extension));
  const std::jthread writing([&] { grow(growing, std::string_view(bytes).substr(first), nullptr); });
  const LiveSummary made = recordLive(request, {});
  const Contents got = readAll(request.output);
  QCOMPARE(got.eventCount(), std::size_t{200'000});
  QCOMPARE(made.events, got.eventCount());
  QCOMPARE(made.imu_samples, got.sampleCount());
  QVERIFY(got.faults.empty());
}

EVICAL_TEST(TestLive)
#include "tst_live.moc"
