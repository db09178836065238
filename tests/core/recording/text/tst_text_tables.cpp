// Tables as people have them: headers, units and cells of many programs, and tables without readable ones.
#include "core/base/error.h"
#include "core/recording/inspection.h"
#include "core/recording/separate_imu.h"
#include "tests/core/recording/sample_recording.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>
#include <QtTest>

#include <fmt/format.h>

#include <cmath>
#include <functional>

using namespace evical;
using namespace evical::test;

namespace {

using Cell = std::function<std::string(int)>;

std::string numberAt(int row) {
  return fmt::format("{:.3f}", 0.1 * std::sin(0.3 * row));
}

// Samples at 200 Hz with these times.
std::string table(const std::string& header, int rows, const Cell& time, const Cell& value = numberAt,
                  char separator = ',') {
  std::string text = header + "\n";
  for (int i = 0; i < rows; ++i) {
    text += time(i);
    for (int axis = 0; axis < 6; ++axis)
      text += separator + (axis == 2 ? std::string("9.8") : value(i + axis));
    text += "\n";
  }
  return text;
}

std::string utf16(const std::string& text, bool big_endian) {
  std::string bytes = big_endian ? std::string("\xFE\xFF") : std::string("\xFF\xFE");
  for (const char c : text) bytes += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
  return bytes;
}

const char* const kHeader = "time_s,ax,ay,az,gx,gy,gz";

}  // namespace

class TestTextTables : public QObject {
  Q_OBJECT

 private slots:
  void tablesWithoutTimes_areRefusedByRowAndCell_data();
  void tablesWithoutTimes_areRefusedByRowAndCell();
  void thousandsAmongTimes_areRefused_data();
  void thousandsAmongTimes_areRefused();
  void tablesWithoutCells_areSurvived_data();
  void tablesWithoutCells_areSurvived();
  void times_areRead_data();
  void times_areRead();
  void scalesAboveTheHeader_areApplied_data();
  void scalesAboveTheHeader_areApplied();
  void scalesThatCannotBe_areRefused_data();
  void scalesThatCannotBe_areRefused();
  void orientation_turnsTheAxes();
  void rawCounts_haveTheFactorOfTheirUnit_data();
  void rawCounts_haveTheFactorOfTheirUnit();
  void severalImus_areStreams_data();
  void severalImus_areStreams();
  void stagesOfOneSensor_areRefused();
  void oneSensor_isNamedByHeaderUnitOrFile_data();
  void oneSensor_isNamedByHeaderUnitOrFile();
  void twoTables_areOneImu();
  void bareAxes_areRefusedWithLinesThatWork();
  void proposals_areForTheirSensor();
  void proposals_areNotRefused_data();
  void proposals_areNotRefused();
  void wideTables_areRefusedBriefly();
  void tablesWithoutHeader_haveTheUnitThatFits_data();
  void tablesWithoutHeader_haveTheUnitThatFits();
  void timesOfAnotherUnit_areNamed();
  void pointsOfOneTime_areLimited();
  void decimalPixels_areRefused_data();
  void decimalPixels_areRefused();

 private:
  std::filesystem::path path(const std::string& name) const {
    return folder_.filePath(QString::fromStdString(name)).toStdString();
  }
  // Message of the refusal; empty if the table is read.
  std::string refusalOf(const std::string& text, const std::string& name = "table.csv") const {
    writeFile(path(name), text);
    try {
      openRecording(path(name));
      return {};
    } catch (const CalibrationError& error) {
      return error.what();
    }
  }
  Recording recordingOf(const std::string& text, const std::string& name = "table.csv") const {
    writeFile(path(name), text);
    return readRecording(*openRecording(path(name)));
  }
  QTemporaryDir folder_;
};

void TestTextTables::tablesWithoutTimes_areRefusedByRowAndCell_data() {
  QTest::addColumn<QByteArray>("header");
  QTest::addColumn<QByteArray>("cell");
  QTest::addColumn<QByteArray>("advice");
  for (const char* header : {kHeader, "t,ax,ay,az,gx,gy,gz", "timestamp_ns,ax,ay,az,gx,gy,gz",
                             "stamp [us],ax [g],ay [g],az [g],gx [deg/s],gy [deg/s],gz [deg/s]"})
    for (const auto& [cell, advice] :
         {std::pair{"1.700.000", "thousands"}, std::pair{"NaN", "times as numbers"},
          std::pair{"0x1F", "times as numbers"}, std::pair{"0.005 sec", "times as numbers"},
          std::pair{"", "times as numbers"}, std::pair{"12:99:00", "times as numbers"},
          std::pair{"25:00:00", "times as numbers"}, std::pair{"inf", "times as numbers"},
          std::pair{"01/03/2026 10:00", "times as numbers"}})
      QTest::addRow("%s below %.12s", cell, header)
          << QByteArray(header) << QByteArray(cell) << QByteArray(advice);
}

void TestTextTables::tablesWithoutTimes_areRefusedByRowAndCell() {
  QFETCH(QByteArray, header);
  QFETCH(QByteArray, cell);
  QFETCH(QByteArray, advice);
  for (const int rows : {1, 3, 10, 40}) {
    const QByteArray refusal =
        refusalOf(table(header.toStdString(), rows, [&](int) { return cell.toStdString(); })).c_str();
    QVERIFY2(refusal.contains("line 2 ") && refusal.contains(advice), refusal);
    QVERIFY2(cell.isEmpty() || refusal.contains(cell), refusal);
  }
}

// Shorter times of the same column look like decimals.
void TestTextTables::thousandsAmongTimes_areRefused_data() {
  QTest::addColumn<QByteArray>("text");
  QTest::addColumn<QByteArray>("place");
  const auto row = [](const char* name, const std::string& text, const char* place) {
    QTest::newRow(name) << QByteArray::fromStdString(text) << QByteArray(place);
  };
  const auto thousands = [](int number, const std::string& mark) {
    std::string text = std::to_string(number);
    for (std::ptrdiff_t at = std::ssize(text) - 3; at > 0; at -= 3)
      text.insert(static_cast<std::size_t>(at), mark);
    return text;
  };
  row("ms", table("t_ms,ax,ay,az,gx,gy,gz", 300, [&](int i) { return thousands(5 * i, "."); }),
      "line 202 has the time 1.000");
  row("us, decimal commas",
      table(
          "t_us;ax;ay;az;gx;gy;gz", 300, [&](int i) { return thousands(5000 * i, "."); },
          [](int i) { return fmt::format("0,{}", i % 10); }, ';'),
      "line 3 has the time 5.000");
  row("commas in quotes",
      table(kHeader, 300, [&](int i) { return '"' + thousands(4'000'000 + i, ",") + '"'; }),
      "line 2 has \"4,000,000\" as time");
  row("apostrophes", table(kHeader, 300, [&](int i) { return thousands(4'000'000 + i, "'"); }),
      "line 2 has \"4'000'000\" as time");
}

void TestTextTables::thousandsAmongTimes_areRefused() {
  QFETCH(QByteArray, text);
  QFETCH(QByteArray, place);
  const QByteArray refusal = refusalOf(text.toStdString()).c_str();
  QVERIFY2(refusal.contains(place) && refusal.contains("without thousands separators"), refusal);
}

void TestTextTables::tablesWithoutCells_areSurvived_data() {
  QTest::addColumn<QByteArray>("text");
  QTest::addColumn<bool>("read");
  const auto row = [](const char* name, const std::string& text, bool read) {
    QTest::newRow(name) << QByteArray::fromStdString(text) << read;
  };
  const auto time = [](int i) { return fmt::format("{}", 0.005 * i); };
  row("only a header", std::string(kHeader) + "\n", true);
  row("only a header, without its end", kHeader, true);
  row("nothing can be read",
      table(
          kHeader, 20, [](int) { return "?"; }, [](int) { return "x"; }),
      false);
  row("no numbers in any column", std::string(kHeader) + "\n" + "x,x,x,x,x,x,x\nx,x,x,x,x,x,x\n", false);
  row("empty cells", table(kHeader, 20, time, [](int) { return ""; }), false);
  row("NaN in an axis", table(kHeader, 20, time, [](int) { return "NaN"; }), false);
  row("only commas", std::string(kHeader) + "\n,,,,,,\n,,,,,,\n", false);
  row("too few columns", std::string(kHeader) + "\n1,2,3\n1,2,3\n", false);
  row("names without a sensor", "time_s,a,b,c\n?,1,2,3\n", false);
  row("the last rows are ragged", table(kHeader, 20, time) + "1,2\n1,2,3,4,5,6,7,8,9\n\n,,\n", true);
  row("the first row is ragged", std::string(kHeader) + "\n0,1\n" + table("", 20, time).substr(1), true);
  row("units in the second line",
      table(std::string(kHeader) + "\n[s],[m/s^2],[m/s^2],[m/s^2],[rad/s],[rad/s],[rad/s]", 20, time), true);
}

void TestTextTables::tablesWithoutCells_areSurvived() {
  QFETCH(QByteArray, text);
  QFETCH(bool, read);
  const std::string refusal = refusalOf(text.toStdString());
  QVERIFY2(refusal.empty() == read, refusal.c_str());
  if (read) recordingOf(text.toStdString());
}

void TestTextTables::times_areRead_data() {
  QTest::addColumn<QByteArray>("text");
  QTest::addColumn<qlonglong>("first_ns");
  const auto row = [](const char* name, const std::string& text, qlonglong first_ns) {
    QTest::newRow(name) << QByteArray::fromStdString(text) << first_ns;
  };
  const qlonglong noon_ns = 43'200'000'000'000;
  const auto clock = [](int start_s, const char* format) {
    return [=](int i) {
      const int ms = 1000 * start_s + 5 * i, s = ms / 1000 % 86'400;
      return fmt::format(fmt::runtime(format), s / 3600, s / 60 % 60, s % 60, ms % 1000,
                         (s / 3600 + 11) % 12 + 1);
    };
  };
  for (const char* header : {"Time,ax,ay,az,gx,gy,gz", kHeader, "timestamp_ns,ax,ay,az,gx,gy,gz"})
    QTest::addRow("clock times below %.8s", header)
        << QByteArray::fromStdString(table(header, 300, clock(43'200, "{:02}:{:02}:{:02}.{:03}"))) << noon_ns;
  row("clock times with milliseconds", table(kHeader, 300, clock(43'200, "{:02}:{:02}:{:02}:{:03}")),
      noon_ns);
  row("clock times with PM", table(kHeader, 300, clock(43'200, "{4}:{1:02}:{2:02}.{3:03} PM")), noon_ns);
  row("clock times across midnight", table(kHeader, 600, clock(86'399, "{:02}:{:02}:{:02}.{:03}")),
      86'399'000'000'000);
  row("dates below a unit",
      table("timestamp_ns,ax,ay,az,gx,gy,gz", 200,
            [](int i) { return fmt::format("2026/03/01 10:00:00.{:03}", 5 * i); }),
      1'772'359'200'000'000'000);
  const auto dated = [&](const char* form, char separator) {
    std::string header = "Date,Time,ax,ay,az,gx,gy,gz";
    std::ranges::replace(header, ',', separator);
    return table(header, 300, clock(36'000, form), numberAt, separator);
  };
  row("dates and times of day", dated("2026-03-01,{:02}:{:02}:{:02}.{:03}", ','), 1'772'359'200'000'000'000);
  row("dates with slashes", dated("2026/03/01;{:02}:{:02}:{:02}.{:03}", ';'), 1'772'359'200'000'000'000);
  row("dates and times of day across midnight",
      table("Date,Time,ax,ay,az,gx,gy,gz", 400,
            [](int i) {
              return fmt::format("{}.{:03}", i < 200 ? "2026-02-28,23:59:59" : "2026-03-01,00:00:00",
                                 5 * i % 1000);
            }),
      1'772'323'199'000'000'000);
  const auto parts = [](std::int64_t unit) {
    return [unit](int i) { return fmt::format("{}.{}", 100 + i / 200, i % 200 * 5 * unit); };
  };
  row("seconds and nanoseconds without zeros", table("timestamp,ax,ay,az,gx,gy,gz", 700, parts(1'000'000)),
      100'000'000'000);
  row("seconds and microseconds without zeros", table(kHeader, 700, parts(1000)), 100'000'000'000);
  row("seconds and milliseconds without zeros", table("t,ax,ay,az,gx,gy,gz", 700, parts(1)), 100'000'000'000);
  row("seconds and milliseconds without zeros, decimal commas",
      table(
          "t;ax;ay;az;gx;gy;gz", 700, [](int i) { return fmt::format("{},{}", 100 + i / 200, i % 200 * 5); },
          [](int i) { return fmt::format("0,{}", i % 10); }, ';'),
      100'000'000'000);
  row("a column named clock", table("clock,ax,ay,az,gx,gy,gz", 300, clock(43'200, "{:02}:{:02}:{:02}.{:03}")),
      noon_ns);
  row("all cells in quotes",
      table(kHeader, 300, [](int i) { return fmt::format("\"{}\"", 1.0 + 0.005 * i); }), 1'000'000'000);
  row("decimals without zeros at their end",
      table(kHeader, 700, [](int i) { return fmt::format("{}", 100.0 + 0.005 * i); }), 100'000'000'000);
  row("a temperature named T",
      table("t_s,ax,ay,az,gx,gy,gz", 50, [](int i) { return fmt::format("{}", 0.005 * i); }), 0);
  const std::string plain = table(kHeader, 300, [](int i) { return fmt::format("{:.3f}", 1.0 + 0.005 * i); });
  row("UTF-16, little endian", utf16(plain, false), 1'000'000'000);
  row("UTF-16, big endian", utf16(plain, true), 1'000'000'000);
  row("UTF-16 without a mark", utf16(plain, false).substr(2), 1'000'000'000);
  row("UTF-16 without a mark, big endian", utf16(plain, true).substr(2), 1'000'000'000);
}

void TestTextTables::times_areRead() {
  QFETCH(QByteArray, text);
  QFETCH(qlonglong, first_ns);
  const std::vector<ImuSample> samples = recordingOf(text.toStdString()).imu_samples;
  QVERIFY(samples.size() >= 50);
  QCOMPARE(qlonglong(samples.front().time_ns), first_ns);
  for (std::size_t i = 1; i < samples.size(); ++i)
    QCOMPARE(qlonglong(samples[i].time_ns - samples[i - 1].time_ns), qlonglong(5'000'000));
}

void TestTextTables::scalesAboveTheHeader_areApplied_data() {
  QTest::addColumn<double>("tscale_s");
  QTest::newRow("microseconds") << 1e-6;
  QTest::newRow("milliseconds") << 1e-3;
  QTest::newRow("ticks of 1/32768 s") << 1.0 / 32768.0;
}

void TestTextTables::scalesAboveTheHeader_areApplied() {
  QFETCH(double, tscale_s);
  std::string text = fmt::format(
      "GYROFLOW IMU LOG\nversion,1.3\norientation,XYZ\ntscale,{}\ngscale,0.001\nascale,0.0005\n"
      "t,gx,gy,gz,ax,ay,az\n",
      tscale_s);
  for (int i = 0; i < 40; ++i)
    text += fmt::format("{},100,-200,{},0,2,2000\n", std::llround(0.01 * i / tscale_s), i);
  writeFile(path("log.gcsv"), text);
  const auto reader = openRecording(path("log.gcsv"));
  const std::string& message = reader->streams()[0].message;
  QVERIFY2(message.find("gscale 0.001") != std::string::npos, message.c_str());
  const std::vector<ImuSample> samples = readRecording(*reader).imu_samples;
  QCOMPARE(samples.size(), std::size_t{40});
  QVERIFY(std::abs(static_cast<double>(samples[39].time_ns) - 0.39e9) < 0.5e9 * tscale_s);  // half a tick
  QVERIFY((samples[3].angular_rate_rad_s - Eigen::Vector3d(0.1, -0.2, 0.003)).norm() < 1e-12);
  QVERIFY((samples[3].specific_force_m_s2 - kStandardGravity_m_s2 * Eigen::Vector3d(0.0, 0.001, 1.0)).norm() <
          1e-9);
}

void TestTextTables::scalesThatCannotBe_areRefused_data() {
  QTest::addColumn<QByteArray>("scale");
  QTest::addColumn<QByteArray>("header");
  QTest::addColumn<bool>("refused");
  const auto row = [](const char* scale, const char* header, bool refused) {
    QTest::addRow("%s: %s", scale, header) << QByteArray(scale) << QByteArray(header) << refused;
  };
  const char *const plain = "t,gx,gy,gz,ax,ay,az",
                    *const units = "t_s,gx [rad/s],gy [rad/s],gz [rad/s],ax [g],ay [g],az [g]";
  for (const char* scale : {"tscale,0", "tscale,1e308", "gscale,nan", "ascale,-1", "# ascale: inf"}) {
    row(scale, plain, true);
    row(scale, units, false);  // it is not used
  }
  row("gscale,0.01", plain, false);
  row("ascale,unknown", plain, false);
}

void TestTextTables::scalesThatCannotBe_areRefused() {
  QFETCH(QByteArray, scale);
  QFETCH(QByteArray, header);
  QFETCH(bool, refused);
  const QByteArray text = scale + "\n" + header + "\n0,1,2,3,4,5,9.8\n";
  const QByteArray refusal = refusalOf(text.toStdString()).c_str();
  QVERIFY2(refusal.isEmpty() != refused, refusal);
  if (!refused) return;
  const QByteArray name = scale.mid(scale.indexOf("scale") - 1, 6);
  QVERIFY2(refusal.contains("\"" + name + " "), refusal);
}

void TestTextTables::orientation_turnsTheAxes() {
  const auto read = [&](const std::string& orientation) {
    return recordingOf("orientation," + orientation + "\nt_s,gx,gy,gz,ax,ay,az\n0,1,2,3,4,5,9.8\n")
        .imu_samples.at(0);
  };
  QVERIFY((read("XYZ").angular_rate_rad_s == Eigen::Vector3d(1, 2, 3)));
  QVERIFY((read("YxZ").angular_rate_rad_s == Eigen::Vector3d(2, -1, 3)));
  QVERIFY((read("YxZ").specific_force_m_s2 == Eigen::Vector3d(5, -4, 9.8)));
  // Without signs, in lower case.
  QVERIFY((read("xyz").angular_rate_rad_s == Eigen::Vector3d(1, 2, 3)));
  // A sensor cannot be mounted as its mirror image.
  QVERIFY((read("YXZ").angular_rate_rad_s == Eigen::Vector3d(1, 2, 3)));
}

void TestTextTables::rawCounts_haveTheFactorOfTheirUnit_data() {
  QTest::addColumn<QByteArray>("acceleration");
  QTest::addColumn<QByteArray>("rate");
  QTest::newRow("decimal") << QByteArray("0.0005 g") << QByteArray("0.001 rad/s");
  QTest::newRow("fraction") << QByteArray("1/2000 g") << QByteArray("1/1000 rad/s");
  QTest::newRow("without a blank") << QByteArray("5e-4g") << QByteArray("1e-3rad/s");
}

void TestTextTables::rawCounts_haveTheFactorOfTheirUnit() {
  QFETCH(QByteArray, acceleration);
  QFETCH(QByteArray, rate);
  const std::string a = " [" + acceleration.toStdString() + "]", g = " [" + rate.toStdString() + "]";
  const ImuSample sample =
      recordingOf(fmt::format("t_s,ax{0},ay{0},az{0},gx{1},gy{1},gz{1}\n0,0,2,2000,100,200,300\n", a, g))
          .imu_samples.at(0);
  QVERIFY((sample.specific_force_m_s2 / kStandardGravity_m_s2 - Eigen::Vector3d(0.0, 0.001, 1.0)).norm() <
          1e-12);
  QVERIFY((sample.angular_rate_rad_s - Eigen::Vector3d(0.1, 0.2, 0.3)).norm() < 1e-12);
}

void TestTextTables::severalImus_areStreams_data() {
  QTest::addColumn<QByteArray>("text");
  const auto names = [](const char* name, const std::string& header) {
    std::string text = header + "\n";
    for (int i = 0; i < 20; ++i) text += fmt::format("{},1,2,9,1,2,3,4,5,8,4,5,6\n", 0.005 * i);
    QTest::newRow(name) << QByteArray::fromStdString(text);
  };
  names(
      "imu0, imu1",
      "t_s,imu0_ax,imu0_ay,imu0_az,imu0_gx,imu0_gy,imu0_gz,imu1_ax,imu1_ay,imu1_az,imu1_gx,imu1_gy,imu1_gz");
  names("numbers at the end", "t_s,ax0,ay0,az0,gx0,gy0,gz0,ax1,ay1,az1,gx1,gy1,gz1");
  names("sides",
        "t_s,left_acc_x,left_acc_y,left_acc_z,left_gyro_x,left_gyro_y,left_gyro_z,right_acc_x,right_acc_y,"
        "right_acc_z,"
        "right_gyro_x,right_gyro_y,right_gyro_z");
  const auto rows = [](const char* name, const char* column, const char* first, const char* second) {
    std::string text = fmt::format("t_s,{},ax,ay,az,gx,gy,gz\n", column);
    for (int i = 0; i < 20; ++i)
      text += fmt::format("{0},{1},1,2,9,1,2,3\n{0},{2},4,5,8,4,5,6\n", 0.005 * i, first, second);
    QTest::newRow(name) << QByteArray::fromStdString(text);
  };
  rows("ArduPilot's I", "I", "0", "1");
  rows("imu_id", "imu_id", "1", "2");
  rows("names", "sensor", "front", "rear");
}

void TestTextTables::severalImus_areStreams() {
  QFETCH(QByteArray, text);
  writeFile(path("two.csv"), text.toStdString());
  const auto reader = openRecording(path("two.csv"));
  QCOMPARE(reader->streams().size(), std::size_t{2});
  QVERIFY(reader->streams()[0].name != reader->streams()[1].name);
  std::array<std::vector<RawImuSample>, 2> samples;
  for (Packet packet; reader->read(packet);)
    for (const RawImuSample& sample : packet.imu_samples) samples[packet.stream].push_back(sample);
  QVERIFY(reader->faults().empty());
  for (std::size_t imu = 0; imu < 2; ++imu) {
    QCOMPARE(samples[imu].size(), std::size_t{20});
    QCOMPARE(qlonglong(samples[imu][19].time_ns), qlonglong(95'000'000));
    const double more = imu == 0 ? 0.0 : 3.0;
    QVERIFY((samples[imu][5].angular_rate == Eigen::Vector3d(1 + more, 2 + more, 3 + more)));
    QVERIFY((samples[imu][5].specific_force == Eigen::Vector3d(1 + more, 2 + more, imu == 0 ? 9.0 : 8.0)));
  }
}

void TestTextTables::stagesOfOneSensor_areRefused() {
  const std::string refusal = refusalOf(
      "t_s,raw_ax,raw_ay,raw_az,raw_gx,raw_gy,raw_gz,cal_ax,cal_ay,cal_az,cal_gx,cal_gy,cal_gz\n"
      "0,1,2,9,1,2,3,1,2,9,1,2,3\n");
  QVERIFY2(refusal.find("more than one accelerometer: raw_ax, cal_ax") != std::string::npos, refusal.c_str());
}

void TestTextTables::oneSensor_isNamedByHeaderUnitOrFile_data() {
  QTest::addColumn<QByteArray>("file");
  QTest::addColumn<QByteArray>("header");
  QTest::addColumn<bool>("gyroscope");
  const auto row = [](const char* file, const char* header, bool gyroscope) {
    QTest::addRow("%s: %s", file, header) << QByteArray(file) << QByteArray(header) << gyroscope;
  };
  row("Gyroscope.csv", "time_s,seconds_elapsed,z,y,x", true);
  row("AccelerometerUncalibrated.csv", "time_s,seconds_elapsed,z,y,x", false);
  row("phone_gyro.csv", "t_s,accuracy,z,y,x", true);
  row("data.csv", "t_s,accuracy,gz,gy,gx", true);
  row("data.csv", "t_s,accuracy,acc_z,acc_y,acc_x", false);
  row("data.csv", "t_s,accuracy,z [rad/s],y [rad/s],x [rad/s]", true);
  row("Raw Data.csv", "Time (s),T (C),Acceleration z (m/s^2),Acceleration y (m/s^2),Acceleration x (m/s^2)",
      false);
}

void TestTextTables::oneSensor_isNamedByHeaderUnitOrFile() {
  QFETCH(QByteArray, file);
  QFETCH(QByteArray, header);
  QFETCH(bool, gyroscope);
  writeFile(path(file.toStdString()), header.toStdString() + "\n0.5,0,3,2,1\n");
  Packet packet;
  QVERIFY(openRecording(path(file.toStdString()))->read(packet));
  const RawImuSample& sample = packet.imu_samples.at(0);
  QVERIFY(sample.time_ns == 500'000'000 && lacksForce(sample) == gyroscope && lacksRate(sample) != gyroscope);
  QVERIFY(((gyroscope ? sample.angular_rate : sample.specific_force) == Eigen::Vector3d(1, 2, 3)));
}

// Each sensor keeps its own times.
void TestTextTables::twoTables_areOneImu() {
  QTemporaryDir folder;
  const std::filesystem::path place = folder.path().toStdString();
  const auto file = [&](const char* name, double first_s, double period_s, const char* values) {
    std::string text = "time_s,z,y,x\n";
    for (int i = 0; i < 50; ++i) text += fmt::format("{:.6f},{}\n", first_s + period_s * i, values);
    writeFile(place / name, text);
  };
  file("Gyroscope.csv", 10.0012, 0.005, "3,2,1");
  file("Accelerometer.csv", 10.0, 0.01, "9,5,4");
  file("Magnetometer.csv", 10.0, 0.01, "9,5,4");
  auto folder_reader = openRecording(place);
  QCOMPARE(folder_reader->streams().size(), std::size_t{2});
  const auto reader = withSeparateImus(std::move(folder_reader), {{"Gyroscope.csv", "Accelerometer.csv"}});
  reader->select({2});
  std::size_t rates = 0, forces = 0;
  std::int64_t last_ns = 0;
  for (Packet packet; reader->read(packet);)
    for (const RawImuSample& sample : packet.imu_samples) {
      QVERIFY(sample.time_ns >= last_ns);
      last_ns = sample.time_ns;
      if (sample.measured_by == MeasuredBy::Gyroscope) {
        QCOMPARE(qlonglong((sample.time_ns - 10'001'200'000) % 5'000'000), qlonglong(0));
        QVERIFY((sample.angular_rate == Eigen::Vector3d(1, 2, 3)));
        ++rates;
      } else {
        QVERIFY((sample.specific_force == Eigen::Vector3d(4, 5, 9)));
        ++forces;
      }
    }
  QVERIFY(rates == 50 && forces == 50);
}

void TestTextTables::bareAxes_areRefusedWithLinesThatWork() {
  const std::string text = "time_ns,seconds_elapsed,z,y,x\n1000,0,3,2,1\n2000,0.1,3,2,1\n";
  const std::string refusal = refusalOf(text, "data.csv");
  QVERIFY2(refusal.find("columns: \"t_ns,-,gz,gy,gx\" or columns: \"t_ns,-,az,ay,ax\"") != std::string::npos,
           refusal.c_str());
  const auto reader = openRecording(path("data.csv"), {{"data.csv", "t_ns,-,gz,gy,gx"}});
  Packet packet;
  QVERIFY(reader->read(packet));
  QVERIFY((packet.imu_samples.at(0).angular_rate == Eigen::Vector3d(1, 2, 3)));
}

void TestTextTables::proposals_areForTheirSensor() {
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  // A pressure may be named p, and a temperature T.
  const std::string imu = refusalOf("t_us,T[C],p,ax,ay,az,b1,b2,b3\n7,21,3,1,2,9.5,1,2,3\n");
  QVERIFY2(has(imu, "columns: \"t_us,-,?,ax,ay,az,?,?,?\"") && !has(imu, "x, y, p"), imu.c_str());
  const std::string angles = refusalOf("t_s,ang_x,ang_y,ang_z,ax,ay,az\n0,1,2,3,1,2,9.8\n");
  QVERIFY2(has(angles, "names no gyroscope"), angles.c_str());
  QVERIFY(refusalOf("t_s,ang_vel_x,ang_vel_y,ang_vel_z,ax,ay,az\n0,1,2,3,1,2,9.8\n").empty());
  writeFile(path("pose.csv"), "t_s,t_x,t_y,t_z,ax,ay,az,gx,gy,gz\n0.5,1,2,3,1,2,9.8,1,2,3\n");
  const auto reader = openRecording(path("pose.csv"));
  QVERIFY(reader->faults().empty());
  QCOMPARE(qlonglong(readRecording(*reader).imu_samples.at(0).time_ns), qlonglong(500'000'000));
}

void TestTextTables::proposals_areNotRefused_data() {
  QTest::addColumn<QByteArray>("header");
  QTest::addColumn<QByteArray>("line");
  const auto row = [](const char* name, const char* header, const char* line) {
    QTest::newRow(name) << QByteArray(header) << QByteArray(line);
  };
  row("axes twice", "t_ns,gx,gx,gx,ax,ay,ay", "t_ns,?,?,?,ax,?,?");
  row("an axis twice, with units", "t_ns,gx,gy,gz,ax [g],ax [m/s^2],az", "t_ns,gx,gy,gz,?,?,az");
  row("different units", "t [ns],wx [rad/s],wy [rad/s],wz [rad/s],ax [m/s^2],ay [m/s^2],az [g]",
      "t_ns,gx [rad/s],gy [rad/s],gz [rad/s],ax,ay,az");
  row("an unknown unit",
      "t [\xC2\xB5s],wx [\xC2\xB0/s],wy [\xC2\xB0/s],wz [\xC2\xB0/s],ax [ell],ay [ell],az [ell]",
      "t [\xC2\xB5s],gx [\xC2\xB0/s],gy [\xC2\xB0/s],gz [\xC2\xB0/s],ax,ay,az");
  row("units of the other sensor", "t [ns],gx [g],gy [g],gz [g],ax [rad/s],ay [rad/s],az [rad/s]",
      "t_ns,gx,gy,gz,ax,ay,az");
  row("raw counts of one sensor", "t_s,gx [lsb],gy [lsb],gz [lsb],ax [0.001 g],ay [0.001 g],az [0.001 g]",
      "t_s,gx,gy,gz,ax [0.001 g],ay [0.001 g],az [0.001 g]");
}

// A proposed line with '?' is to be completed.
void TestTextTables::proposals_areNotRefused() {
  QFETCH(QByteArray, header);
  QFETCH(QByteArray, line);
  const std::string row = "\n7,1,2,3,1,2,9\n";
  const QByteArray refusal = refusalOf(header.toStdString() + row).c_str();
  QVERIFY2(refusal.contains("columns: \"" + line + "\""), refusal);
  if (line.contains('?')) return;
  const std::string again = refusalOf(line.toStdString() + row);
  QVERIFY2(again.empty(), again.c_str());
}

void TestTextTables::wideTables_areRefusedBriefly() {
  std::string header = "t_s", row = "7";
  for (int imu = 0; imu < 1000; ++imu) {
    header += fmt::format(",imu{0}_ax,imu{0}_ay,imu{0}_az,imu{0}_gx,imu{0}_gy,imu{0}_gz", imu);
    row += ",1,2,9,1,2,3";
  }
  const std::string refusal = refusalOf(header + "\n" + row + "\n");
  QVERIFY2(refusal.size() < 1500, refusal.c_str());
  QVERIFY2(refusal.find("imu0_ax, imu1_ax") != std::string::npos &&
               refusal.find("992 more") != std::string::npos &&
               refusal.find("6001 columns") != std::string::npos,
           refusal.c_str());
}

void TestTextTables::tablesWithoutHeader_haveTheUnitThatFits_data() {
  QTest::addColumn<QByteArray>("file");
  QTest::addColumn<qlonglong>("step");
  QTest::addColumn<QByteArray>("unit");
  QTest::addColumn<qlonglong>("unit_ns");
  QTest::newRow("IMU, us") << QByteArray("imu.txt") << qlonglong(5000) << QByteArray("us") << qlonglong(1000);
  QTest::newRow("IMU, ns") << QByteArray("imu.txt") << qlonglong(5'000'000) << QByteArray("ns")
                           << qlonglong(1);
  QTest::newRow("events, us") << QByteArray("events.txt") << qlonglong(3) << QByteArray("us")
                              << qlonglong(1000);
}

void TestTextTables::tablesWithoutHeader_haveTheUnitThatFits() {
  QFETCH(QByteArray, file);
  QFETCH(qlonglong, step);
  QFETCH(QByteArray, unit);
  QFETCH(qlonglong, unit_ns);
  const bool events = file.startsWith("events");
  std::string text;
  for (int i = 0; i < 200; ++i)
    text += events ? fmt::format("{} {} {} {}\n", step * i, i % 7, i % 5, i % 2)
                   : fmt::format("{} 0.1 0.2 9.8 0 0.1 0\n", step * i);
  writeFile(path(file.toStdString()), text);
  const auto reader = openRecording(path(file.toStdString()));
  QCOMPARE(reader->faults().size(), std::size_t{1});
  QVERIFY2(reader->faults()[0].text.find("these fit " + unit.toStdString()) != std::string::npos,
           reader->faults()[0].text.c_str());
  const Recording read = readRecording(*reader);
  const std::int64_t last_ns = events ? read.events.at(199).time_ns : read.imu_samples.at(199).time_ns;
  QCOMPARE(qlonglong(last_ns), 199 * step * unit_ns);
}

// Milliseconds since 1970 are too many seconds for any time.
void TestTextTables::timesOfAnotherUnit_areNamed() {
  std::string text;
  for (int i = 0; i < 50; ++i) text += fmt::format("{}.500 {} 5 1\n", 1'700'000'000'000 + i, i);
  writeFile(path("events.txt"), text);
  const auto reader = openRecording(path("events.txt"));
  readRecording(*reader);
  const auto unit = std::ranges::find(reader->faults(), FaultKind::Unit, &RecordingFault::kind);
  QVERIFY(unit != reader->faults().end());
  QVERIFY2(unit->text.find("Line 1: 1700000000000.500 is too large for a time in s, but not in ms") == 0,
           unit->text.c_str());
  const auto time = [](int i) { return i == 20 ? "17,x" : fmt::format("17,{}", i * 5'000'000); };
  writeFile(path("imu.csv"), table("secs,nsecs,ax,ay,az,gx,gy,gz", 50, time));
  const auto imu = openRecording(path("imu.csv"));
  QCOMPARE(readRecording(*imu).imu_samples.size(), std::size_t{49});
  QVERIFY(
      std::ranges::none_of(imu->faults(), [](const auto& fault) { return fault.kind == FaultKind::Unit; }));
}

// A board has no more points; without a limit, the whole file would be one view.
void TestTextTables::pointsOfOneTime_areLimited() {
  std::string text = "time_s,point,x_px,y_px\n";
  for (int i = 0; i < 70'000; ++i) text += "0.1,0,1.0,2.0\n";
  QVERIFY_THROWS_EXCEPTION(CalibrationError, recordingOf(text, "points.csv"));
}

void TestTextTables::decimalPixels_areRefused_data() {
  QTest::addColumn<QByteArray>("header");
  QTest::newRow("no header") << QByteArray();
  QTest::newRow("header") << QByteArray("t_s,x,y,p\n");
}

void TestTextTables::decimalPixels_areRefused() {
  QFETCH(QByteArray, header);
  std::string text = header.toStdString();
  for (int i = 0; i < 30; ++i)
    text += fmt::format("{:.6f},{:.2f},{:.2f},{}\n", 1e-4 * i, 10.25 + i, 20.75 + i % 7, i % 2);
  const std::string refusal = refusalOf(text, "undistorted.csv");
  QVERIFY2(refusal.find("10.25") != std::string::npos &&
               refusal.find("undistorted or averaged") != std::string::npos,
           refusal.c_str());
}

EVICAL_TEST(TestTextTables)
#include "tst_text_tables.moc"
