// Logs of IMUs as one series of samples in order of time.
#include "core/pipeline/maintain/imu_logs.h"

#include "core/base/time.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <random>

namespace {

using namespace evical;

constexpr int kSamples = 40'000;  // 200 s at 200 Hz: several blocks

class TestImuLogs : public QObject {
  Q_OBJECT

 private slots:
  void disorderAndSecondClocks_areRemoved();
  void coarseStamps_becomeSteadyTimes();
  void severalImus_stayTogether();
  void twoTablesOfAnImu_areJoined();

 private:
  using Times = std::vector<std::int64_t>;

  static Times steady() {
    Times times_ns;
    for (int i = 0; i < kSamples; ++i) times_ns.push_back(1'700'000'000 * kSecond_ns + 5'000'123LL * i);
    return times_ns;
  }
  std::filesystem::path write(const char* name, const Times& times_ns) const {
    const std::filesystem::path path = folder_.filePath(name).toStdString();
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, 0.01);
    std::ofstream file(path);
    file << "timestamp_ns,gx,gy,gz,ax,ay,az\n";
    for (const std::int64_t time_ns : times_ns)
      file << fmt::format("{},{:.6f},{:.6f},0.1,0.2,0.3,9.8\n", time_ns, noise(random), noise(random));
    return path;
  }
  static NamedResult resultOf(const std::vector<std::string>& imus) {
    NamedResult before;
    for (const std::string& imu : imus) {
      before.imus.emplace_back();
      before.imus.back().name = imu;
      before.imus.back().stream = imu + ".csv";
    }
    return before;
  }
  static Times read(ImuLogs& logs) {
    Times times_ns;
    SensorPacket packet;
    while (logs.read(packet))
      for (const ImuSample& sample : packet.imu_samples) times_ns.push_back(sample.time_ns);
    return times_ns;
  }

  QTemporaryDir folder_;
};

void TestImuLogs::disorderAndSecondClocks_areRemoved() {
  Times times_ns = steady();
  const Times good_ns = times_ns;
  for (const std::size_t i : {100U, 11'000U, 12'000U, 30'000U}) std::swap(times_ns[i], times_ns[i + 1]);
  for (std::size_t i = 20'000; i < 20'010; ++i) times_ns[i] += kSecond_ns / 2;
  const NamedResult before = resultOf({"imu"});
  ImuLogs logs({write("imu.csv", times_ns)}, before, {});
  const Times read_ns = read(logs);
  QVERIFY(std::ranges::is_sorted(read_ns));
  Times expected_ns = good_ns;
  expected_ns.erase(expected_ns.begin() + 20'000, expected_ns.begin() + 20'010);
  QVERIFY(read_ns == expected_ns);
  const std::vector<RecordingFault> faults = logs.faults();
  QCOMPARE(faults.size(), std::size_t{2});
  QVERIFY(faults[0].kind == FaultKind::BackwardTime);
  QVERIFY2(faults[1].kind == FaultKind::SecondClock &&
               faults[1].text.find("10 samples from 99.997 s on") != std::string::npos,
           faults[1].text.c_str());
}

void TestImuLogs::coarseStamps_becomeSteadyTimes() {
  Times times_ns = steady();
  const Times good_ns = times_ns;
  for (std::int64_t& time_ns : times_ns) time_ns -= time_ns % 10'000'000;
  const NamedResult before = resultOf({"imu"});
  ImuLogs logs({write("imu.csv", times_ns)}, before, {});
  const Times read_ns = read(logs);
  QCOMPARE(read_ns.size(), good_ns.size());
  for (std::size_t i = 1; i < read_ns.size(); ++i) {
    QVERIFY(read_ns[i] > read_ns[i - 1]);
    QVERIFY(std::abs(read_ns[i] + 5'000'000 - good_ns[i]) < 5'100'000);  // half a step early
  }
  QCOMPARE(logs.faults().size(), std::size_t{1});
  QVERIFY(logs.faults().front().kind == FaultKind::Encoding);
  QVERIFY(std::abs(logs.stampStep_s(0) - 0.01) < 1e-6);
}

void TestImuLogs::twoTablesOfAnImu_areJoined() {
  constexpr int kRows = 4000;
  const auto writeTable = [&](const char* name, const char* header, std::int64_t later_ns) {
    const std::filesystem::path path = folder_.filePath(name).toStdString();
    std::filesystem::create_directories(path.parent_path());
    std::ofstream file(path);
    file << header;
    for (int i = 0; i < kRows; ++i) file << fmt::format("{},0.1,{},9.8\n", later_ns + 5'000'000LL * i, i % 7);
    return path;
  };
  std::vector<std::filesystem::path> logs;
  for (const auto& [day, from_ns] :
       {std::pair{"1", std::int64_t{1'000'000}}, std::pair{"2", 100 * kSecond_ns}}) {
    logs.push_back(writeTable(fmt::format("{}/Accelerometer.csv", day).c_str(), "t_ns,ax,ay,az\n", from_ns));
    logs.push_back(
        writeTable(fmt::format("{}/Gyroscope.csv", day).c_str(), "t_ns,gx,gy,gz\n", from_ns + 700));
  }
  NamedResult before = resultOf({"imu"});
  before.imus[0].stream = "Gyroscope.csv";
  before.imus[0].accelerometer_stream = "Accelerometer.csv";
  SessionImu reading;
  reading.stream = "Gyroscope.csv";
  reading.accelerometer_stream = "Accelerometer.csv";
  ImuLogs joined(logs, before, {}, {{"imu", reading}});
  QCOMPARE(read(joined).size(), std::size_t{4 * kRows});
  QVERIFY(joined.notes().empty());
  const NamedResult other = resultOf({"imu"});
  ImuLogs named(logs, other, {.streams = {{"imu", "Gyroscope.csv + Accelerometer.csv"}}});
  QCOMPARE(read(named).size(), std::size_t{4 * kRows});
}

// A comparison of two IMUs takes one that is 3 s behind for one with a gap.
void TestImuLogs::severalImus_stayTogether() {
  const NamedResult before = resultOf({"left", "right"});
  Times later_ns = steady();
  for (std::int64_t& time_ns : later_ns) time_ns += 2'345'678;
  ImuLogs logs({write("left.csv", steady()), write("right.csv", later_ns)}, before, {});
  SensorPacket packet;
  std::map<std::size_t, std::int64_t> latest_ns;
  std::size_t samples = 0;
  while (logs.read(packet)) {
    latest_ns[packet.sensor] = packet.imu_samples.back().time_ns;
    samples += packet.imu_samples.size();
    if (latest_ns.size() == 2) QVERIFY(std::abs(latest_ns[0] - latest_ns[1]) < 2 * kSecond_ns);
  }
  QCOMPARE(samples, std::size_t{2 * kSamples});
}

}  // namespace

EVICAL_TEST(TestImuLogs)
#include "tst_imu_logs.moc"
