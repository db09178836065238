#include "core/base/error.h"
#include "tests/core/recording/sample_recording.h"
#include "tests/support/test_program.h"

#include <QDir>
#include <QProcess>
#include <QTemporaryDir>

#include <sys/resource.h>

#include <csignal>

using namespace evical;
using namespace evical::test;

namespace {

// Limits the size of files: writing fails like on a full disk.
class SmallFilesOnly {
 public:
  explicit SmallFilesOnly(rlim_t largest_bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{largest_bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallFilesOnly() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  SmallFilesOnly(const SmallFilesOnly&) = delete;
  SmallFilesOnly& operator=(const SmallFilesOnly&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

}  // namespace

class TestRosbag : public QObject {
  Q_OBJECT

 private slots:
  void roundTrip_isExact_data();
  void roundTrip_isExact();
  void select_handsOutOnlyWhatIsWanted();
  void writer_withoutFinish_leavesNothing();
  void writer_onFullDisk_throwsAndLeavesNothing();
  void python_readsOurBags_data() { roundTrip_isExact_data(); }
  void python_readsOurBags();
  void pythonBags_areRead_data();
  void pythonBags_areRead();
  void withoutIndex_everythingIsRead();
  void truncation_givesWhatIsWhole_data() { roundTrip_isExact_data(); }
  void truncation_givesWhatIsWhole();
  void corruption_neverCrashes_data() { roundTrip_isExact_data(); }
  void corruption_neverCrashes();
  void lyingLengths_areRefused_data();
  void lyingLengths_areRefused();
  void unreadableFiles_areNamed_data();
  void unreadableFiles_areNamed();
  void filesWithoutHeader_areNamedByTheirName_data();
  void filesWithoutHeader_areNamedByTheirName();
  void linkOfGitAnnex_isNamed();

 private:
  std::filesystem::path path(const char* name) const { return folder_.filePath(name).toStdString(); }
  std::filesystem::path makeBag(bool lz4, std::size_t events, const char* name = "sample.bag") const {
    const auto writer = createBag(path(name), sampleStreams(), lz4);
    writeAll(*writer, sampleRecording(events));
    return path(name);
  }
  // With this name, or one that begins so.
  int filesNamed(const char* name) const {
    return static_cast<int>(QDir(folder_.path()).entryList({QString(name) + '*'}).size());
  }
  static bool pythonHasRosbag() {
    return QProcess::execute("/usr/bin/python3", {"-c", "import rosbag"}) == 0;
  }
  static QByteArray python(const QStringList& arguments) {
    QProcess process;
    process.setProcessChannelMode(QProcess::ForwardedErrorChannel);
    process.start("/usr/bin/python3", arguments);
    process.waitForFinished(300'000);
    return process.readAllStandardOutput().trimmed();
  }

  QTemporaryDir folder_;
};

void TestRosbag::roundTrip_isExact_data() {
  QTest::addColumn<bool>("lz4");
  QTest::newRow("none") << false;
  QTest::newRow("lz4") << true;
}

void TestRosbag::roundTrip_isExact() {
  QFETCH(bool, lz4);
  const Recording written = sampleRecording(200'000);  // several chunks
  const auto reader = openRecording(makeBag(lz4, 200'000));
  QCOMPARE(reader->format(), "rosbag");
  QCOMPARE(reader->streams().size(), 2u);
  QCOMPARE(reader->streams()[0].name, "/dvs/events");
  QCOMPARE(reader->streams()[0].message, "dvs_msgs/EventArray");
  QVERIFY((reader->streams()[0].resolution_px == Resolution{346, 260}));
  QCOMPARE(reader->streams()[1].messages, written.imu_samples.size());
  const Recording read = readRecording(*reader);
  QVERIFY(same(read.events, written.events));
  QVERIFY(same(read.imu_samples, written.imu_samples));
  QVERIFY(reader->faults().empty());
  QCOMPARE(reader->fractionRead(), 1.0);
}

void TestRosbag::select_handsOutOnlyWhatIsWanted() {
  const auto reader = openRecording(makeBag(true, 20'000));
  reader->select({1});
  const Recording read = readRecording(*reader);
  QVERIFY(read.events.empty());
  QVERIFY(same(read.imu_samples, sampleRecording(20'000).imu_samples));
}

void TestRosbag::writer_withoutFinish_leavesNothing() {
  {
    const auto writer = createBag(path("dropped.bag"), sampleStreams(), false);
    writer->write(0, EventSpan(sampleRecording(1000).events));
    QCOMPARE(filesNamed("dropped.bag"), 1);
    QVERIFY(!std::filesystem::exists(path("dropped.bag")));
  }
  QCOMPARE(filesNamed("dropped.bag"), 0);
}

void TestRosbag::writer_onFullDisk_throwsAndLeavesNothing() {
  const SmallFilesOnly no_more_space(100'000);
  QVERIFY_THROWS_EXCEPTION(CalibrationError, {
    const auto writer = createBag(path("full.bag"), sampleStreams(), false);
    writeAll(*writer, sampleRecording(200'000));
  });
  QCOMPARE(filesNamed("full.bag"), 0);
}

void TestRosbag::python_readsOurBags() {
  if (!pythonHasRosbag()) QSKIP("python3-rosbag is not installed");
  QFETCH(bool, lz4);
  const Recording written = sampleRecording(20'000);
  std::uint64_t sum_x = 0, sum_t = 0;
  for (const Event& event : written.events) {
    sum_x += event.x_px;
    sum_t += static_cast<std::uint64_t>(event.time_ns);
  }
  const char* script =
      "import rosbag, sys\n"
      "n = x = t = imu = 0\n"
      "for topic, m, stamp in rosbag.Bag(sys.argv[1]).read_messages():\n"
      "    if topic == '/dvs/imu': imu += 1; continue\n"
      "    n += len(m.events); x += sum(e.x for e in m.events); t += sum(e.ts.to_nsec() for e in m.events)\n"
      "print(n, x, t % 2**64, imu, m.angular_velocity.x if topic == '/dvs/imu' else (m.width, m.height))\n";
  const QByteArray expected = QByteArray::number(qulonglong(written.events.size())) + ' ' +
                              QByteArray::number(qulonglong(sum_x)) + ' ' +
                              QByteArray::number(qulonglong(sum_t)) + ' ' +
                              QByteArray::number(qulonglong(written.imu_samples.size()));
  QVERIFY2(python({"-c", script, QString::fromStdString(makeBag(lz4, 20'000).string())})
               .startsWith(expected + ' '),
           expected.constData());
}

void TestRosbag::pythonBags_areRead_data() {
  QTest::addColumn<QString>("compression");
  for (const char* name : {"none", "bz2", "lz4"}) QTest::newRow(name) << name;
}

void TestRosbag::pythonBags_areRead() {
  if (!pythonHasRosbag()) QSKIP("python3-rosbag is not installed");
  QFETCH(QString, compression);
  const std::filesystem::path copy = path("copy.bag");
  const char* script =
      "import rosbag, sys\n"
      "out = rosbag.Bag(sys.argv[2], 'w', compression=sys.argv[3], chunk_threshold=50000)\n"
      "for topic, m, t in rosbag.Bag(sys.argv[1]).read_messages(): out.write(topic, m, t)\n"
      "out.close()\n";
  python({"-c", script, QString::fromStdString(makeBag(false, 20'000).string()),
          QString::fromStdString(copy.string()), compression});
  const auto reader = openRecording(copy);
  const Recording read = readRecording(*reader), written = sampleRecording(20'000);
  QVERIFY(same(read.events, written.events));
  QVERIFY(same(read.imu_samples, written.imu_samples));
  QVERIFY(reader->faults().empty());
}

void TestRosbag::withoutIndex_everythingIsRead() {
  std::string bytes = fileBytes(makeBag(true, 50'000));
  const std::size_t field = bytes.find("index_pos=") + 10;
  bytes.replace(field, 8, 8, '\0');
  writeFile(path("no_index.bag"), bytes);
  const auto reader = openRecording(path("no_index.bag"));
  QCOMPARE(reader->streams().size(), 2u);
  const std::size_t events = findStream(*reader, "/dvs/events", StreamType::Events);
  QVERIFY((reader->streams()[events].resolution_px == Resolution{346, 260}));
  QVERIFY(same(readRecording(*reader).events, sampleRecording(50'000).events));
  QCOMPARE(reader->faults().size(), 1u);
  QCOMPARE(reader->faults()[0].kind, FaultKind::NoIndex);
}

// The data read must be a prefix of the written data, and the loss must be reported.
void TestRosbag::truncation_givesWhatIsWhole() {
  QFETCH(bool, lz4);
  const Recording written = sampleRecording(80'000);
  const std::string bytes = fileBytes(makeBag(lz4, 80'000));
  std::size_t most = 0;
  for (std::size_t size = 13; size < bytes.size(); size += 1 + bytes.size() / 80) {
    writeFile(path("cut.bag"), bytes.substr(0, size));
    const auto reader = openRecording(path("cut.bag"));
    const Recording read = readRecording(*reader);
    QVERIFY(read.events.size() <= written.events.size());
    QVERIFY(same(read.events, EventSpan(written.events).first(read.events.size())));
    if (size > 5000 && size < bytes.size() * 9 / 10) QVERIFY(!reader->faults().empty());
    most = std::max(most, read.events.size());
  }
  QVERIFY(most > written.events.size() / 2);
}

void TestRosbag::corruption_neverCrashes() {
  QFETCH(bool, lz4);
  const std::string bytes = fileBytes(makeBag(lz4, 30'000));
  std::mt19937 random(7);
  for (int i = 0; i < 150; ++i) {
    std::string broken = bytes;
    // Half of the damage is in the structure: at the start and in the index.
    const std::size_t spread = i % 2 == 0 ? bytes.size() : 6000;
    for (int k = 0; k < 8; ++k) {
      const std::size_t at = random() % spread;
      broken[i % 4 == 3 ? bytes.size() - 1 - at % 2000 : at] = static_cast<char>(random());
    }
    writeFile(path("broken.bag"), broken);
    try {
      const auto reader = openRecording(path("broken.bag"));
      QVERIFY(readRecording(*reader).events.size() < 100'000);
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);  // the magic was damaged
    }
  }
}

void TestRosbag::lyingLengths_areRefused_data() {
  QTest::addColumn<bool>("before_name");  // the number is there, otherwise after it
  QTest::addColumn<QByteArray>("name");
  QTest::newRow("chunk size") << false << QByteArray("\x09\0\0\0size=", 9);
  QTest::newRow("index position") << false << QByteArray("index_pos=");
  QTest::newRow("message header") << true << QByteArray("op=\x02", 4);
  QTest::newRow("chunk header") << true << QByteArray("compression=");
}

void TestRosbag::lyingLengths_areRefused() {
  QFETCH(bool, before_name);
  QFETCH(QByteArray, name);
  std::string bytes = fileBytes(makeBag(false, 10'000));
  const std::size_t found = bytes.find(name.toStdString());
  QVERIFY(found != std::string::npos);
  const std::size_t at = found + static_cast<std::size_t>(before_name ? 0 : name.size());
  bytes.replace(before_name ? at - 4 : at, 4, 4, '\xF0');
  writeFile(path("lying.bag"), bytes);
  const auto reader = openRecording(path("lying.bag"));
  QVERIFY(readRecording(*reader).events.size() <= 10'000);
  QVERIFY(!reader->faults().empty());
}

void TestRosbag::unreadableFiles_areNamed_data() {
  QTest::addColumn<QByteArray>("content");
  QTest::addColumn<QByteArray>("expected");
  QTest::newRow("empty") << QByteArray() << QByteArray("empty");
  QTest::newRow("old bag") << QByteArray("#ROSBAG V1.2\n") << QByteArray("old format");
  QTest::newRow("lfs") << QByteArray("version https://git-lfs.github.com/spec/v1\n")
                       << QByteArray("git lfs pull");
  const auto row = [](const char* name, const QByteArray& content, const char* expected) {
    QTest::newRow(name) << content << QByteArray(expected);
  };
  const QByteArray zeros(300, '\0');
  row("mp4",
      QByteArray("\0\0\0\x20"
                 "ftypisom",
                 12) +
          zeros,
      "video (MP4)");
  row("mov",
      QByteArray("\0\0\0\x14"
                 "ftypqt  ",
                 12) +
          zeros,
      "video (MOV)");
  row("avi",
      QByteArray("RIFF\x10\0\0\0"
                 "AVI LIST",
                 16) +
          zeros,
      "video (AVI)");
  row("mkv", QByteArray("\x1A\x45\xDF\xA3") + zeros, "video (MKV");
  row("webp",
      QByteArray("RIFF\x10\0\0\0"
                 "WEBPVP8 ",
                 16) +
          zeros,
      "WebP");
  row("gif", QByteArray("GIF89a") + zeros, "GIF");
  row("png", QByteArray("\x89PNG\r\n\x1A\n") + zeros, "folder with all pictures");
  row("jpeg", QByteArray("\xFF\xD8\xFF\xE0") + zeros, "folder with all pictures");
  row("bmp", QByteArray("BM\x46\x10\0\0\0\0\0\0", 10) + zeros, "folder with all pictures");
  row("tiff", QByteArray("II*\0", 4) + zeros, "folder with all pictures");
  row("bz2", QByteArray("BZh91AY&SY") + zeros, "bzip2");
  row("xz",
      QByteArray("\xFD"
                 "7zXZ") +
          zeros,
      "xz");
  row("tar", QByteArray("name") + zeros.left(253) + QByteArray("ustar") + zeros, "tar archive");
  row("rar", QByteArray("Rar!\x1A\x07\0", 7) + zeros, "RAR");
  row("mat", QByteArray("MATLAB 5.0 MAT-file, Platform: GLNXA64") + zeros, "MATLAB");
  row("html", QByteArray("\n<!DOCTYPE html>\n<html><head><title>Sign in</title></head></html>\n"),
      "web site");
  row("git-annex", QByteArray("/annex/objects/MD5E-s1024--0123.bag\n"), "git annex get");
  QTest::newRow("unknown") << QByteArray("hello world\n") << QByteArray("Use a ROS 1 bag");
}

void TestRosbag::unreadableFiles_areNamed() {
  QFETCH(QByteArray, content);
  QFETCH(QByteArray, expected);
  writeFile(path("unreadable"), content.toStdString());
  try {
    openRecording(path("unreadable"));
    QFAIL("no error");
  } catch (const CalibrationError& error) {
    QVERIFY(error.kind() == ErrorKind::BadInput);
    QVERIFY2(QByteArray(error.what()).contains(expected), error.what());
  }
  QVERIFY_THROWS_EXCEPTION(CalibrationError, openRecording(path("missing")));
}

void TestRosbag::filesWithoutHeader_areNamedByTheirName_data() {
  QTest::addColumn<QString>("file");
  QTest::addColumn<QString>("expected");
  QTest::newRow("RAW") << "events.raw"
                       << "RAW file has no header";
  QTest::newRow("AEDAT") << "events.aedat"
                         << "AEDAT file has no header";
}

void TestRosbag::filesWithoutHeader_areNamedByTheirName() {
  QFETCH(QString, file);
  QFETCH(QString, expected);
  std::string content(4096, '\0');
  for (std::size_t i = 0; i < content.size(); ++i) content[i] = static_cast<char>(i * 97 + 13);
  writeFile(path(qPrintable(file)), content);
  try {
    openRecording(path(qPrintable(file)));
    QFAIL("no error");
  } catch (const CalibrationError& error) {
    QVERIFY2(QString(error.what()).contains(expected), error.what());
  }
}

void TestRosbag::linkOfGitAnnex_isNamed() {
  std::filesystem::create_symlink(".git/annex/objects/aa/bb/MD5E-s1--0/MD5E-s1--0.bag", path("annexed.bag"));
  try {
    openRecording(path("annexed.bag"));
    QFAIL("no error");
  } catch (const CalibrationError& error) {
    QVERIFY2(QString(error.what()).contains("git annex get"), error.what());
  }
}

EVICAL_TEST(TestRosbag)
#include "tst_rosbag.moc"
