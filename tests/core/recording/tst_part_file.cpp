// Output files: complete under their name or absent, also with concurrent writers, and on disk before they
// are renamed.
#include "core/base/error.h"
#include "core/recording/conversion.h"
#include "core/recording/recording_writer.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

using namespace evical;
using namespace evical::test;

namespace {

int synced_files = 0;
bool renamed_before_sync = false;
std::filesystem::path watched;

}  // namespace

// Replaces the C library's function, to observe its calls.
extern "C" int fsync(int file) {
  ++synced_files;
  renamed_before_sync = renamed_before_sync || std::filesystem::exists(watched);
  return static_cast<int>(::syscall(SYS_fsync, file));
}

class TestPartFile : public QObject {
  Q_OBJECT
 private slots:
  void twoWritersOfOnePath_leaveAWholeFile_data();
  void twoWritersOfOnePath_leaveAWholeFile();
  void finish_syncsBeforeItRenames_data() { twoWritersOfOnePath_leaveAWholeFile_data(); }
  void finish_syncsBeforeItRenames();
  void whatIsNoFile_isRefused_data();
  void whatIsNoFile_isRefused();
  void file_isReadableAsOthersAre();

 private:
  std::vector<StreamInfo> streams() const {
    return {{"/events", StreamType::Events, "", {64, 48}}, {"/imu", StreamType::Imu, "", {}}};
  }
  std::filesystem::path pathOf(const RecordingFormat& format) const {
    return folder_ / (std::string("out") + format.extension);
  }
  ScratchFolder folder_;
};

void TestPartFile::twoWritersOfOnePath_leaveAWholeFile_data() {
  QTest::addColumn<QString>("format");
  for (const RecordingFormat& format : recordingFormats())
    if (!format.isFolder() && !format.one_camera) QTest::newRow(format.name) << format.name;
}

// The last one to finish remains.
void TestPartFile::twoWritersOfOnePath_leaveAWholeFile() {
  QFETCH(QString, format);
  const std::filesystem::path path = pathOf(recordingFormat(format.toStdString()));
  const std::vector<Event> first_events = someEvents(150'000), second_events = someEvents(90'000);
  const auto first = createRecording(path, format.toStdString(), streams());
  const auto second = createRecording(path, format.toStdString(), streams());
  for (std::size_t i = 0; i < 90; ++i) {
    first->write(0, EventSpan(first_events).subspan(1000 * i, 1000));
    second->write(0, EventSpan(second_events).subspan(1000 * i, 1000));
  }
  second->finish();
  first->write(0, EventSpan(first_events).subspan(90'000));
  QVERIFY(sameEvents(readAll(path).events.at(0), second_events));
  first->finish();
  const Contents contents = readAll(path);
  QVERIFY(sameEvents(contents.events.at(0), first_events));
  QVERIFY(contents.faults.empty());
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    QCOMPARE(entry.path().filename().string().find(".part"), std::string::npos);
}

void TestPartFile::finish_syncsBeforeItRenames() {
  QFETCH(QString, format);
  watched = folder_ / ("synced" + format.toStdString());
  const auto writer = createRecording(watched, format.toStdString(), streams());
  writer->write(0, EventSpan(someEvents(100)));
  synced_files = 0;
  renamed_before_sync = false;
  writer->finish();
  QCOMPARE(synced_files, 1);
  QVERIFY(!renamed_before_sync);
}

void TestPartFile::whatIsNoFile_isRefused_data() {
  QTest::addColumn<QString>("what");
  for (const char* what : {"pipe", "folder", "link to a device"}) QTest::newRow(what) << what;
}

void TestPartFile::whatIsNoFile_isRefused() {
  QFETCH(QString, what);
  const std::filesystem::path path = folder_ / "taken.bag";
  std::filesystem::remove(path);
  if (what == "pipe") QCOMPARE(::mkfifo(path.c_str(), 0600), 0);
  if (what == "folder") std::filesystem::create_directory(path);
  if (what == "link to a device") std::filesystem::create_symlink("/dev/null", path);
  const std::filesystem::file_status before = std::filesystem::symlink_status(path);
  try {
    const auto writer = createBag(path, streams(), false);
    writer->write(0, EventSpan(someEvents(100)));
    writer->finish();
    QFAIL("written");
  } catch (const CalibrationError& error) {
    QCOMPARE(error.kind(), ErrorKind::BadInput);
    QCOMPARE(error.place(), path.string());
  }
  QVERIFY(std::filesystem::symlink_status(path).type() == before.type());
}

void TestPartFile::file_isReadableAsOthersAre() {
  std::ofstream(folder_ / "other") << "other";
  PartFile file(folder_ / "ours");
  file.append("ours");
  file.finish();
  QVERIFY(std::filesystem::status(folder_ / "ours").permissions() ==
          std::filesystem::status(folder_ / "other").permissions());
}

EVICAL_TEST(TestPartFile)
#include "tst_part_file.moc"
