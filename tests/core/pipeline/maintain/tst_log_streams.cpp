// Assignment of the streams of logs to the IMUs of an old result.
#include "core/base/error.h"
#include "core/pipeline/maintain/imu_logs.h"
#include "core/recording/recording_writer.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <map>

using namespace evical;

namespace {

using Streams = std::vector<std::string>;

// Each stream has its own angular rate about x, by which the test recognises it: 1, 2, ... rad/s.
void writeLog(const std::filesystem::path& path, const Streams& names) {
  std::vector<StreamInfo> streams;
  for (const std::string& name : names) {
    StreamInfo& info = streams.emplace_back();
    info.name = name;
    info.type = StreamType::Imu;
  }
  const auto bag = createBag(path, streams, false);
  for (int k = 0; k < 200; ++k)
    for (std::size_t s = 0; s < names.size(); ++s) {
      ImuSample sample;
      sample.time_ns = 1'000'000'000 + 5'000'000 * static_cast<std::int64_t>(k);
      sample.angular_rate_rad_s.x() = 1.0 + static_cast<double>(s);
      sample.specific_force_m_s2.z() = 9.81;
      bag->write(s, std::span(&sample, 1));
    }
  bag->finish();
}

// "name stream" of each IMU.
NamedResult resultOf(const Streams& imus) {
  NamedResult before;
  for (const std::string& imu : imus) {
    const std::size_t space = imu.find(' ');
    before.imus.push_back({imu.substr(0, space), space == std::string::npos ? "" : imu.substr(space + 1)});
  }
  return before;
}

// By IMU: the streams whose samples it receives, as "1" for the first.
std::string assignedTo(ImuLogs& logs, const NamedResult& before) {
  std::map<std::string, std::map<int, int>> counts;
  SensorPacket packet;
  while (logs.read(packet))
    for (const ImuSample& sample : packet.imu_samples)
      ++counts[before.imus[packet.sensor].name][static_cast<int>(sample.angular_rate_rad_s.x())];
  std::string text;
  for (const auto& [imu, streams] : counts) {
    text += (text.empty() ? "" : ", ") + imu;
    for (const auto& [stream, samples] : streams) text += " " + std::to_string(stream);
  }
  return text;
}

}  // namespace

class TestLogStreams : public QObject {
  Q_OBJECT

  QTemporaryDir folder_;

 private slots:
  void streams_goToTheirImu_data() {
    QTest::addColumn<Streams>("streams");
    QTest::addColumn<Streams>("imus");
    QTest::addColumn<QString>("assigned");
    const auto row = [](const char* name, const Streams& streams, const Streams& imus, const char* assigned) {
      QTest::newRow(name) << streams << imus << QString(assigned);
    };
    row("the log's name is an IMU's", {"/imu", "/xsens/imu"}, {"imu /imu"}, "imu 1");
    row("in the other order", {"/xsens/imu", "/imu"}, {"imu /imu"}, "imu 2");
    row("two IMUs", {"/imu", "/xsens/imu"}, {"imu /imu", "xsens_imu /xsens/imu"}, "imu 1, xsens_imu 2");
    row("the log's name is the other IMU's", {"/a/imu", "/b/imu"}, {"imu /b/imu", "a /a/imu"}, "a 1, imu 2");
    row("the name of an IMU, not of its stream", {"left", "right"}, {"left /l", "right /r"},
        "left 1, right 2");
    row("its stream before its name", {"left", "/l"}, {"left /l"}, "left 2");
    row("one stream: the log's name", {"/unknown"}, {"imu /imu", "xsens_imu /xsens/imu"}, "imu 1");
    row("one stream: its name before the log's", {"/xsens/imu"}, {"imu /imu", "xsens_imu /xsens/imu"},
        "xsens_imu 1");
    row("one stream and one IMU", {"/renamed"}, {"body /body/imu"}, "body 1");
  }
  void streams_goToTheirImu() {
    QFETCH(const Streams, streams);
    QFETCH(const Streams, imus);
    QFETCH(const QString, assigned);
    const NamedResult before = resultOf(imus);
    ImuLogs logs({log(streams)}, before, {});
    QCOMPARE(QString::fromStdString(assignedTo(logs, before)), assigned);
  }

  void severalStreamsWithoutAMatch_areRefused() {
    const NamedResult before = resultOf({"imu /body"});
    QVERIFY_THROWS_EXCEPTION(CalibrationError, ImuLogs({log({"/imu", "/xsens/imu"})}, before, {}));
  }

  void settings_comeFirst() {
    const NamedResult before = resultOf({"imu /imu"});
    ImuLogSettings settings;
    settings.streams["imu"] = "/xsens/imu";
    ImuLogs logs({log({"/imu", "/xsens/imu"})}, before, settings);
    QCOMPARE(QString::fromStdString(assignedTo(logs, before)), QString("imu 2"));
  }

 private:
  std::filesystem::path log(const Streams& streams) const {
    const std::filesystem::path path = folder_.filePath("imu.bag").toStdString();
    writeLog(path, streams);
    return path;
  }
};

EVICAL_TEST(TestLogStreams)
#include "tst_log_streams.moc"
