// Folders of images in the layouts of data sets and without one: their streams and times.
#include "core/base/error.h"
#include "core/format/picture_header.h"
#include "core/recording/conversion.h"
#include "core/recording/pictures/picture_names.h"
#include "tests/core/recording/picture_samples.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

#include <sys/stat.h>

using namespace evical;
using namespace evical::test;

namespace {

constexpr std::int64_t kPictureFoldersStart_ns = 1'403'636'579'763'555'584;

std::string nameAt(std::int64_t time_ns) {
  return std::to_string(time_ns) + ".png";
}

bool hasTime(const std::string& name) {
  return !pictures::timesInNames({name}).times_ns.empty();
}

const char* const kEurocImu =
    "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],a_RS_S_y "
    "[m "
    "s^-2],a_RS_S_z [m s^-2]\n1403636579758555392,0.1,0.2,0.3,9.8,0.5,0.25\n"
    "1403636579763555584,0.1,0.2,0.3,9.8,0.5,0.25\n";

}  // namespace

class TestPictureFolders : public QObject {
  Q_OBJECT

 private slots:
  void init() { scratch_ = std::make_unique<ScratchFolder>(); }

  void euroc_isOneRecording_data();
  void euroc_isOneRecording();
  void oneEurocCamera_isARecording();
  void eurocLists_sayBadLines();
  void kalibr_hasAStreamAFolder();
  void namesInMicroseconds_areSaid();
  void namesOfAllKinds_areTimes_data();
  void namesOfAllKinds_areTimes();
  void tablesOfAllKinds_areTimes_data();
  void tablesOfAllKinds_areTimes();
  void twoCamerasInOneFolder_areTwoStreams();
  void eurocWithoutTable_takesTheNames();
  void eurocTimesInAnotherUnit_areCorrected_data();
  void eurocTimesInAnotherUnit_areCorrected();
  void picturesOfKalibr_stayWithAnyNameOfTheImu();
  void dsec_hasTheMiddleOfTheExposure();
  void dsec_withoutExposures_hasTheCommonTimes();
  void tumVie_hasExposures();
  void rpg_hasPicturesBesideItsText();
  void pictures_withoutTimes_areNumberedAndSaid();
  void names_areSortedNaturally();
  void missingAndBrokenPictures_areSaid();
  void differentNumbers_areSaid();
  void exposuresInOtherUnits_areLeftOutAndSaid();
  void listsThatLeaveTheFolder_areNotFollowed();
  void timesBeyondTheLimit_areLeftOut();
  void byDefault_picturesAreNotRead();
  void conversion_takesThemAlongOrSaysThatItDoesNot_data();
  void conversion_takesThemAlongOrSaysThatItDoesNot();
  void cameras_areReadSideBySide();
  void emptyFolders_areNoRecording();
  void sizes_areRead_data();
  void sizes_areRead();
  void sizes_ofCutFiles_areUnknown();
  void specialFiles_areNotOpened();

 private:
  void addEurocCamera(const std::string& folder, int count) const {
    std::string list = "#timestamp [ns],filename\r\n";
    for (int i = 0; i < count; ++i) {
      const std::int64_t time_ns = kPictureFoldersStart_ns + i * std::int64_t{50'000'000};
      list += std::to_string(time_ns) + "," + nameAt(time_ns) + "\r\n";
      scratch_->write(folder + "/data/" + nameAt(time_ns), pngBytes(752, 480) + std::to_string(i));
    }
    scratch_->write(folder + "/data.csv", list);
  }
  void addNumbered(const std::string& folder, int count, const char* extension = ".png") const {
    for (int i = 0; i < count; ++i)
      scratch_->write((folder.empty() ? "" : folder + "/") +
                          QString("%1").arg(i, 6, 10, QChar('0')).toStdString() + extension,
                      pngBytes(8, 6) + std::to_string(i));
  }
  static std::string lastLetter(const Frame& frame) { return {static_cast<char>(frame.bytes.back())}; }

  std::unique_ptr<ScratchFolder> scratch_;
};

void TestPictureFolders::euroc_isOneRecording_data() {
  QTest::addColumn<QString>("opened");
  QTest::newRow("mav0") << "MH_01/mav0";
  QTest::newRow("the folder above") << "MH_01";
}

void TestPictureFolders::euroc_isOneRecording() {
  QFETCH(QString, opened);
  addEurocCamera("MH_01/mav0/cam0", 3);
  addEurocCamera("MH_01/mav0/cam1", 3);
  scratch_->write("MH_01/mav0/imu0/data.csv", kEurocImu);
  scratch_->write("MH_01/mav0/state0/data.csv", "#timestamp,p_x,p_y,p_z\n1,2,3,4\n");
  const Contents contents = readEverything(*scratch_ / opened.toStdString());
  QCOMPARE(contents.streams.size(), std::size_t{3});
  QCOMPARE(QString::fromStdString(contents.streams[0].name), QString("cam0"));
  QCOMPARE(QString::fromStdString(contents.streams[1].name), QString("cam1"));
  QCOMPARE(QString::fromStdString(contents.streams[2].name), QString("imu0"));
  QVERIFY(contents.streams[2].type == StreamType::Imu);
  QCOMPARE(contents.streams[0].resolution_px.width_px, 752);
  QCOMPARE(contents.streams[0].messages, std::uint64_t{3});
  QVERIFY(contents.streams[0].timed);
  const std::vector<Frame>& frames = contents.frames.at(1);
  QCOMPARE(frames.size(), std::size_t{3});
  QCOMPARE(frames[2].time_ns, kPictureFoldersStart_ns + 100'000'000);
  QVERIFY(frames[2].format == FrameFormat::Encoded);
  QCOMPARE(lastLetter(frames[2]), std::string("2"));
  QCOMPARE(contents.imu.at(2).size(), std::size_t{2});
  QCOMPARE(contents.imu.at(2)[0].time_ns, 1403636579758555392);
  QVERIFY(contents.imu.at(2)[0].specific_force_m_s2 == Eigen::Vector3d(9.8, 0.5, 0.25));
  QVERIFY(contents.faults.empty());
}

void TestPictureFolders::oneEurocCamera_isARecording() {
  addEurocCamera("cam0", 4);
  const Contents contents = readEverything(*scratch_ / "cam0/");
  QCOMPARE(contents.frameCount(), 4u);
  QCOMPARE(QString::fromStdString(contents.streams[0].name), QString("cam0"));
}

void TestPictureFolders::eurocLists_sayBadLines() {
  addEurocCamera("cam0", 2);
  std::string list = fileBytes(*scratch_ / "cam0/data.csv");
  scratch_->write("cam0/data.csv", list + "no time,a.png\r\n1403636\r\n");
  const Contents contents = readEverything(*scratch_ / "cam0");
  QCOMPARE(contents.frameCount(), 2u);
  QCOMPARE(contents.faults.size(), std::size_t{2});
  QVERIFY(contents.faults[0].text.find("Line 4") != std::string::npos);
}

void TestPictureFolders::kalibr_hasAStreamAFolder() {
  for (const char* camera : {"cam0", "cam1"})
    for (int i = 0; i < 3; ++i)
      scratch_->write(std::string(camera) + "/" + nameAt(kPictureFoldersStart_ns + i * 50'000'000),
                      pngBytes(8, 6));
  scratch_->write("cam1/notes.png", pngBytes(8, 6));
  scratch_->write(
      "imu0.csv",
      "timestamp,omega_x,omega_y,omega_z,alpha_x,alpha_y,alpha_z\n1385030208726607500,1,2,3,4,5,9.8\n");
  const Contents contents = readEverything(scratch_->path());
  QCOMPARE(contents.streams.size(), std::size_t{3});
  QCOMPARE(QString::fromStdString(contents.streams[1].name), QString("cam1"));
  QCOMPARE(contents.frames.at(1)[2].time_ns, kPictureFoldersStart_ns + 100'000'000);
  QCOMPARE(contents.frames.at(1).size(), std::size_t{3});
  QVERIFY(contents.hasFault(FaultKind::Untimed));  // notes.png
  QCOMPARE(contents.imu.at(2).size(), std::size_t{1});
  QCOMPARE(contents.imu.at(2)[0].time_ns, 1385030208726607500);
  QVERIFY(contents.imu.at(2)[0].angular_rate_rad_s == Eigen::Vector3d(1.0, 2.0, 3.0));
  QVERIFY(contents.imu.at(2)[0].specific_force_m_s2 == Eigen::Vector3d(4.0, 5.0, 9.8));
}

void TestPictureFolders::namesInMicroseconds_areSaid() {
  for (int i = 0; i < 3; ++i) scratch_->write(nameAt(1'403'636'579'763'555 + i * 50'000), pngBytes(8, 6));
  const Contents contents = readEverything(scratch_->path());
  QCOMPARE(contents.frames.at(0)[1].time_ns - contents.frames.at(0)[0].time_ns, 50'000'000);
  QVERIFY(contents.hasFault(FaultKind::Guess));
}

void TestPictureFolders::namesOfAllKinds_areTimes_data() {
  QTest::addColumn<QStringList>("names");
  QTest::addColumn<qint64>("step_ns");  // 0: no times
  const auto row = [](const char* name, const QStringList& names, qint64 step_ns) {
    QTest::newRow(name) << names << step_ns;
  };
  row("ns", {"1700000000000000000", "1700000000050000000", "1700000000100000000"}, 50'000'000);
  row("ns since the start", {"000000000000", "000050000000", "000100000000"}, 50'000'000);
  row("us", {"1700000000000000", "1700000000050000", "1700000000100000"}, 50'000'000);
  row("ms", {"1700000000000", "1700000000050", "1700000000100"}, 50'000'000);
  row("s", {"1700000000", "1700000001", "1700000002"}, 1'000'000'000);
  row("decimals", {"1700000000.000000", "1700000000.050000", "1700000000.100000"}, 50'000'000);
  row("decimals since the start", {"0.000000", "0.050000", "0.100000"}, 50'000'000);
  row("s and ns", {"1700000000_000000000", "1700000000_050000000", "1700000000_100000000"}, 50'000'000);
  row("s and ns without zeros", {"1700000000_999999999", "1700000001_49999999", "1700000001_99999999"},
      50'000'000);
  row("a word before", {"cam0_1700000000000000000", "cam0_1700000000050000000", "cam0_1700000000100000000"},
      50'000'000);
  row("a word behind", {"1700000000000000000_left", "1700000000050000000_left", "1700000000100000000_left"},
      50'000'000);
  row("date of 17 digits", {"20240506070809000", "20240506070809050", "20240506070809100"}, 50'000'000);
  row("date of a telephone", {"IMG_20240506_070809", "IMG_20240506_070811", "IMG_20240506_070813"},
      2'000'000'000);
  row("date with lines", {"2024-05-06-07-08-09", "2024-05-06-07-08-11", "2024-05-06-07-08-13"},
      2'000'000'000);
  row("a count of 12 digits", {"000000000000", "000000000001", "000000000002"}, 0);
  row("a count of 19 digits", {"0000000000000000000", "0000000000000000001", "0000000000000000002"}, 0);
  row("a count from a large number", {"100000000000", "100000000001", "100000000002"}, 0);
  row("a count of 6 digits", {"000000", "000001", "000002"}, 0);
  row("a count with a point", {"frame.0001", "frame.0002", "frame.0003"}, 0);
  row("a count with a line", {"board_1_01", "board_1_02", "board_1_03"}, 0);
}

void TestPictureFolders::namesOfAllKinds_areTimes() {
  QFETCH(QStringList, names);
  QFETCH(qint64, step_ns);
  for (const QString& name : names) scratch_->write(name.toStdString() + ".png", pngBytes(8, 6));
  const Contents contents = readEverything(scratch_->path());
  QCOMPARE(contents.streams.size(), std::size_t{1});
  QCOMPARE(contents.frameCount(), 3u);
  QCOMPARE(contents.streams[0].timed, step_ns > 0);
  const std::vector<Frame>& frames = contents.frames.at(0);
  const qint64 expected_ns = step_ns > 0 ? step_ns : 1'000'000'000;
  QCOMPARE(qint64(frames[1].time_ns - frames[0].time_ns), expected_ns);
  QCOMPARE(qint64(frames[2].time_ns - frames[1].time_ns), expected_ns);
}

void TestPictureFolders::tablesOfAllKinds_areTimes_data() {
  QTest::addColumn<QString>("table");
  QTest::addColumn<QString>("content");
  const auto row = [](const char* name, const char* table, const char* content) {
    QTest::newRow(name) << QString(table) << QString(content);
  };
  row("data.csv", "cam0/data.csv",
      "#timestamp [ns],filename\n1000000000,000000.png\n1050000000,000001.png\n1100000000,000002.png\n");
  row("times.txt of KITTI", "times.txt", "1.000000e+00\n1.050000e+00\n1.100000e+00\n");
  row("times.txt of TUM's monocular data", "cam0/times.txt",
      "000000 1.000000 0.5\n000001 1.050000 0.5\n000002 1.100000 0.5\n");
  row("times.txt in ns", "cam0/times.txt", "1700000001000000000\n1700000001050000000\n1700000001100000000\n");
  row("timestamps.txt with dates", "cam0/timestamps.txt",
      "2011-09-26 13:02:25.000000000\n2011-09-26 13:02:25.050000000\n2011-09-26 13:02:25.100000000\n");
  row("timestamps.txt with names", "cam0/timestamps.txt",
      "000000.png 1.000000\n000001.png 1.050000\n000002.png 1.100000\n");
  row("as rgb.txt of TUM RGB-D", "cam0.txt",
      "# color images\n# timestamp filename\n1.000000 cam0/000000.png\n1.050000 cam0/000001.png\n1.100000 "
      "cam0/000002.png\n");
}

void TestPictureFolders::tablesOfAllKinds_areTimes() {
  QFETCH(QString, table);
  QFETCH(QString, content);
  addNumbered("cam0", 3);
  scratch_->write(table.toStdString(), content.toStdString());
  const Contents contents = readEverything(scratch_->path());
  QCOMPARE(contents.streams.size(), std::size_t{1});
  QVERIFY(contents.streams[0].timed);
  QCOMPARE(contents.frameCount(), 3u);
  const std::vector<Frame>& frames = contents.frames.at(0);
  QCOMPARE(qint64(frames[1].time_ns - frames[0].time_ns), qint64(50'000'000));
  QCOMPARE(qint64(frames[2].time_ns - frames[1].time_ns), qint64(50'000'000));
}

void TestPictureFolders::twoCamerasInOneFolder_areTwoStreams() {
  for (const char* name : {"left00", "left01", "left02", "right00", "right01", "right02"})
    scratch_->write(std::string(name) + ".png", pngBytes(8, 6) + name);
  const Contents contents = readEverything(scratch_->path());
  QCOMPARE(contents.streams.size(), std::size_t{2});
  QCOMPARE(QString::fromStdString(contents.streams[0].name), QString("left"));
  QCOMPARE(QString::fromStdString(contents.streams[1].name), QString("right"));
  QCOMPARE(contents.frames.at(1).size(), std::size_t{3});
}

void TestPictureFolders::eurocWithoutTable_takesTheNames() {
  addEurocCamera("mav0/cam0", 5);
  std::filesystem::remove(*scratch_ / "mav0/cam0/data.csv");
  scratch_->write("mav0/imu0/data.csv", kEurocImu);
  const Contents contents = readEverything(scratch_->path());
  QCOMPARE(contents.streams.size(), std::size_t{2});
  QCOMPARE(QString::fromStdString(contents.streams[0].name), QString("cam0"));
  QCOMPARE(qint64(contents.frames.at(0)[1].time_ns), qint64(kPictureFoldersStart_ns + 50'000'000));
  QCOMPARE(contents.sampleCount(), 2u);
}

void TestPictureFolders::eurocTimesInAnotherUnit_areCorrected_data() {
  QTest::addColumn<QString>("format");  // of the time, from its s and ns
  QTest::addColumn<QString>("said");
  QTest::newRow("s") << "%1.%2"
                     << "read as s";
  QTest::newRow("rounded by a spreadsheet") << "1.40364E+18"
                                            << "in the names are used";
}

void TestPictureFolders::eurocTimesInAnotherUnit_areCorrected() {
  QFETCH(QString, format);
  QFETCH(QString, said);
  addEurocCamera("cam0", 6);
  std::string list = "#timestamp [ns],filename\n";
  for (int i = 0; i < 6; ++i) {
    const QString time = QString::number(kPictureFoldersStart_ns + i * qint64{50'000'000});
    const QString written = format.contains('%') ? format.arg(time.left(10), time.mid(10)) : format;
    list += written.toStdString() + "," + time.toStdString() + ".png\n";
  }
  scratch_->write("cam0/data.csv", list);
  const Contents contents = readEverything(*scratch_ / "cam0");
  QVERIFY(contents.streams[0].timed);
  QCOMPARE(qint64(contents.frames.at(0)[5].time_ns), qint64(kPictureFoldersStart_ns + 250'000'000));
  QVERIFY(std::ranges::any_of(contents.faults, [&](const RecordingFault& fault) {
    return fault.text.find(said.toStdString()) != std::string::npos;
  }));
}

void TestPictureFolders::picturesOfKalibr_stayWithAnyNameOfTheImu() {
  for (int i = 0; i < 3; ++i)
    scratch_->write("cam0/" + nameAt(kPictureFoldersStart_ns + i * 50'000'000), pngBytes(8, 6));
  scratch_->write(
      "imu.csv",
      "timestamp,omega_x,omega_y,omega_z,alpha_x,alpha_y,alpha_z\n1385030208726607500,1,2,3,4,5,9.8\n");
  const Contents contents = readEverything(scratch_->path());
  QCOMPARE(contents.frameCount(), 3u);
  QCOMPARE(contents.sampleCount(), 1u);
}

void TestPictureFolders::dsec_hasTheMiddleOfTheExposure() {
  addNumbered("images/left/rectified", 3);
  addNumbered("images/left/distorted", 3);
  addNumbered("images/right/rectified", 3);
  scratch_->write("zurich_image_exposure_timestamps_left.txt",
                  "# exposure_start_timestamp_us, exposure_end_timestamp_us\n1000000, 1004000\n1050000, "
                  "1054000\n1100000, 1104001\n");
  scratch_->write("images/right/exposure_timestamps.txt", "start,end\n1,3\n5,7\n9,11\n");
  const Contents contents = readEverything(scratch_->path());
  QCOMPARE(contents.streams.size(), std::size_t{3});
  QCOMPARE(QString::fromStdString(contents.streams[1].name), QString("left/distorted"));
  const std::vector<Frame>& frames = contents.frames.at(0);
  QCOMPARE(frames[0].time_ns, 1'002'000'000);
  QCOMPARE(frames[0].exposure_s, 0.004);
  QCOMPARE(frames[2].time_ns, 1'102'000'500);
  QCOMPARE(contents.frames.at(2)[1].time_ns, 6000);
  QVERIFY(contents.faults.empty());
}

void TestPictureFolders::dsec_withoutExposures_hasTheCommonTimes() {
  addNumbered("images/left/rectified", 2);
  scratch_->write("images/timestamps.txt", "1002000\n1052000\n");
  const Contents contents = readEverything(scratch_->path());
  QCOMPARE(contents.frames.at(0)[1].time_ns, 1'052'000'000);
  QCOMPARE(contents.frames.at(0)[1].exposure_s, 0.0);
}

void TestPictureFolders::tumVie_hasExposures() {
  addNumbered("left_images", 2, ".jpg");
  addNumbered("right_images", 2, ".jpg");
  scratch_->write("left_images/image_timestamps_left.txt", "# timestamps [us]\n100.25\n50100.5\n");
  scratch_->write("left_images/image_exposures_left.txt", "# exposures [us]\n1500\n2500.5\n");
  scratch_->write("right_images/image_timestamps_right.txt", "100.25\n50100.5\n");
  scratch_->write("imu_data.txt", "# t gyro acc temp\n100 1 2 3 4 5 9.8 30\n5100 1 2 3 4 5 9.8 30\n");
  const Contents contents = readEverything(scratch_->path());
  QCOMPARE(contents.streams.size(), std::size_t{3});
  QCOMPARE(contents.sampleCount(), 2u);
  for (std::size_t i = 0; i < contents.streams.size(); ++i) {
    const bool left = contents.streams[i].name == "left_images";
    if (contents.streams[i].type == StreamType::Imu) continue;
    const std::vector<Frame>& frames = contents.frames.at(i);
    QCOMPARE(frames.size(), std::size_t{2});
    QCOMPARE(frames[0].time_ns, 100'250);
    QCOMPARE(frames[1].exposure_s, left ? 0.0025005 : 0.0);
  }
}

void TestPictureFolders::rpg_hasPicturesBesideItsText() {
  scratch_->write("events.txt", "0.000001 1 2 1\n0.000002 3 4 0\n");
  scratch_->write("images.txt", "0.5 images/frame_00000000.png\n0.55 images/frame_00000001.png\n");
  for (const char* name : {"images/frame_00000000.png", "images/frame_00000001.png"})
    scratch_->write(name, pngBytes(240, 180));
  const Contents contents = readEverything(scratch_->path());
  QCOMPARE(contents.eventCount(), 2u);
  QCOMPARE(contents.frameCount(), 2u);
  QCOMPARE(contents.frames.at(1)[1].time_ns, 550'000'000);
}

void TestPictureFolders::pictures_withoutTimes_areNumberedAndSaid() {
  addNumbered("", 3, ".JPG");
  const Contents contents = readEverything(scratch_->path());
  QCOMPARE(QString::fromStdString(contents.streams[0].name), QString("pictures"));
  QVERIFY(!contents.streams[0].timed);
  QCOMPARE(contents.frames.at(0)[2].time_ns, 2'000'000'000);
  QCOMPARE(contents.faults.size(), std::size_t{1});
  QVERIFY(contents.faults[0].kind == FaultKind::Guess);
}

void TestPictureFolders::names_areSortedNaturally() {
  using pictures::naturallyBefore;
  QVERIFY(naturallyBefore("a9.png", "a10.png"));
  QVERIFY(!naturallyBefore("a10.png", "a9.png"));
  QVERIFY(naturallyBefore("a09.png", "a10.png"));
  QVERIFY(naturallyBefore("a1b2", "a1b10"));
  QVERIFY(naturallyBefore("a", "a1"));
  QVERIFY(naturallyBefore("a1", "a01") != naturallyBefore("a01", "a1"));  // any order, but always the same
  QVERIFY(!naturallyBefore("a1", "a1"));
  for (const char* name : {"left10.png", "left9.png", "left1.png"})
    scratch_->write(name, pngBytes(8, 6) + name);
  const Contents contents = readEverything(scratch_->path());
  const Frame& last = contents.frames.at(0)[2];
  QVERIFY(std::string(last.bytes.begin(), last.bytes.end()).ends_with("left10.png"));
}

void TestPictureFolders::missingAndBrokenPictures_areSaid() {
  addEurocCamera("cam0", 5);
  const auto path = [&](int i) {
    return *scratch_ / ("cam0/data/" + nameAt(kPictureFoldersStart_ns + i * 50'000'000));
  };
  std::filesystem::remove(path(1));
  scratch_->write("cam0/data/" + nameAt(kPictureFoldersStart_ns + 2 * 50'000'000), "");
  scratch_->write("cam0/data/" + nameAt(kPictureFoldersStart_ns + 3 * 50'000'000), "no picture");
  const Contents contents = readEverything(*scratch_ / "cam0");
  QCOMPARE(contents.frameCount(), 2u);
  QCOMPARE(contents.frames.at(0)[1].time_ns, kPictureFoldersStart_ns + 200'000'000);
  QCOMPARE(contents.faults.size(), std::size_t{3});
  QVERIFY(contents.hasFault(FaultKind::Unreadable));
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

void TestPictureFolders::differentNumbers_areSaid() {
  addNumbered("left_images", 3);
  scratch_->write("left_images/image_timestamps_left.txt", "1\n2\n");
  scratch_->write("left_images/image_exposures_left.txt", "1\n2\n3\n4\n");
  const Contents contents = readEverything(scratch_->path());
  QCOMPARE(contents.frameCount(), 2u);
  QCOMPARE(contents.faults.size(), std::size_t{2});
  QVERIFY(contents.faults[0].kind == FaultKind::Metadata && contents.faults[1].kind == FaultKind::Metadata);
}

void TestPictureFolders::exposuresInOtherUnits_areLeftOutAndSaid() {
  addNumbered("left_images", 2);
  scratch_->write("left_images/image_timestamps_left.txt", "100\n50100\n");
  scratch_->write("left_images/image_exposures_left.txt", "1500000\n2500\n");
  const Contents contents = readEverything(scratch_->path());
  QCOMPARE(contents.frames.at(0)[0].exposure_s, 0.0);
  QCOMPARE(contents.frames.at(0)[1].exposure_s, 0.0025);
  QVERIFY(contents.hasFault(FaultKind::Metadata));
}

void TestPictureFolders::listsThatLeaveTheFolder_areNotFollowed() {
  scratch_->write("secret.png", pngBytes(8, 6));
  scratch_->write("cam0/data/a.png", pngBytes(8, 6));
  scratch_->write("cam0/data.csv",
                  "#t,name\n1,a.png\n2,../../secret.png\n3," + (*scratch_ / "secret.png").string() + "\n");
  const Contents contents = readEverything(*scratch_ / "cam0");
  QCOMPARE(contents.frameCount(), 1u);
  QCOMPARE(contents.faults.size(), std::size_t{2});
}

void TestPictureFolders::timesBeyondTheLimit_areLeftOut() {
  scratch_->write("cam0/data/a.png", pngBytes(8, 6));
  scratch_->write("cam0/data.csv",
                  "#t,name\n4611686018427387903,a.png\n4611686018427387904,a.png\n-5,a.png\n");
  const Contents contents = readEverything(*scratch_ / "cam0");
  QCOMPARE(contents.frameCount(), 2u);
  QCOMPARE(contents.faults.size(), std::size_t{1});
  QVERIFY(!hasTime("4611686018427387904.png"));
  QVERIFY(!hasTime("99999999999999999999.png"));
  QVERIFY(!hasTime("00000001234.png"));
  QVERIFY(hasTime("0000000000123456789.png"));
}

void TestPictureFolders::byDefault_picturesAreNotRead() {
  addEurocCamera("mav0/cam0", 2);
  scratch_->write("mav0/imu0/data.csv", kEurocImu);
  const auto reader = openRecording(*scratch_ / "mav0");
  Contents contents = readAll(*reader);
  QCOMPARE(contents.frameCount(), 0u);
  QCOMPARE(contents.sampleCount(), 2u);
  QCOMPARE(reader->fractionRead(), 1.0);
  const auto pictures = openRecording(*scratch_ / "mav0");
  pictures->select({0});
  contents = readAll(*pictures);
  QCOMPARE(contents.frameCount(), 2u);
  QCOMPARE(contents.sampleCount(), 0u);
  QCOMPARE(pictures->fractionRead(), 1.0);
  QVERIFY_THROWS_EXCEPTION(std::out_of_range, pictures->select({7}));
}

void TestPictureFolders::conversion_takesThemAlongOrSaysThatItDoesNot_data() {
  QTest::addColumn<QString>("output");
  QTest::addColumn<int>("frames");
  QTest::newRow("bag") << "a.bag" << 2;
  QTest::newRow("MCAP") << "a.mcap" << 2;
  QTest::newRow("AEDAT4") << "a.aedat4" << 0;
}

void TestPictureFolders::conversion_takesThemAlongOrSaysThatItDoesNot() {
  QFETCH(QString, output);
  QFETCH(int, frames);
  addEurocCamera("mav0/cam0", 2);
  scratch_->write("mav0/imu0/data.csv", kEurocImu);
  ConversionRequest request;
  request.input = *scratch_ / "mav0";
  request.output = *scratch_ / output.toStdString();
  Log log;
  const ConversionSummary summary = convertRecording(request, RunContext{log});
  QCOMPARE(summary.imu_samples, std::uint64_t{2});
  QCOMPARE(summary.frames, static_cast<std::uint64_t>(frames));
  QCOMPARE(log.said.find("omitted: cam0") == std::string::npos, frames > 0);
  const Contents contents = readEverything(request.output);
  QCOMPARE(contents.frameCount(), static_cast<std::size_t>(frames));
  QCOMPARE(contents.sampleCount(), std::size_t{2});
}

void TestPictureFolders::cameras_areReadSideBySide() {
  addEurocCamera("mav0/cam0", 20);
  addEurocCamera("mav0/cam1", 20);
  const auto reader = openRecording(*scratch_ / "mav0");
  reader->select({0, 1});
  std::int64_t last_ns = 0;
  Packet packet;
  int count = 0;
  for (; reader->read(packet); ++count) {
    QVERIFY(packet.frames[0].time_ns >= last_ns);
    last_ns = packet.frames[0].time_ns;
  }
  QCOMPARE(count, 40);
}

void TestPictureFolders::emptyFolders_areNoRecording() {
  scratch_->write("notes.md", "nothing");
  std::filesystem::create_directories(*scratch_ / "cam0");
  QVERIFY_THROWS_EXCEPTION(CalibrationError, openRecording(scratch_->path()));
}

void TestPictureFolders::sizes_areRead_data() {
  QTest::addColumn<QByteArray>("bytes");
  const auto row = [](const char* name, const std::string& bytes) {
    QTest::newRow(name) << QByteArray(bytes.data(), static_cast<qsizetype>(bytes.size()));
  };
  row("PNG", pngBytes(640, 480));
  row("JPEG", jpegBytes(640, 480));
  row("PGM", "P5\n# a comment\n640 480\n255\n...");
  row("PPM", "P6 640 480 255 ...");
  row("BMP", std::string("BM") + std::string(16, '\0') + std::string("\x80\x02\0\0\xE0\x01\0\0", 8));
  row("BMP from the top",
      std::string("BM") + std::string(16, '\0') + std::string("\x80\x02\0\0\x20\xFE\xFF\xFF", 8));
}

void TestPictureFolders::sizes_areRead() {
  QFETCH(QByteArray, bytes);
  const Resolution size_px = pictureSize(bytes.toStdString());
  QCOMPARE(size_px.width_px, 640);
  QCOMPARE(size_px.height_px, 480);
}

void TestPictureFolders::sizes_ofCutFiles_areUnknown() {
  for (const std::string& whole : {pngBytes(640, 480), jpegBytes(640, 480)})
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const Resolution size_px = pictureSize(whole.substr(0, size));
      QVERIFY(!size_px.known() || (size_px.width_px == 640 && size_px.height_px == 480));
    }
  QVERIFY(!pictureSize(pngBytes(0, 480)).known());
  QVERIFY(!pictureSize(pngBytes(70'000, 480)).known());
  QVERIFY(!pictureSize("no picture").known());
}

// Opening a pipe would block.
void TestPictureFolders::specialFiles_areNotOpened() {
  addEurocCamera("cam0", 2);
  const std::filesystem::path path = *scratch_ / ("cam0/data/" + nameAt(kPictureFoldersStart_ns));
  std::filesystem::remove(path);
  QCOMPARE(::mkfifo(path.c_str(), 0600), 0);
  const Contents contents = readEverything(*scratch_ / "cam0");
  QCOMPARE(contents.frameCount(), 1u);
  QVERIFY(contents.hasFault(FaultKind::Unreadable));
}

EVICAL_TEST(TestPictureFolders)
#include "tst_picture_folders.moc"
