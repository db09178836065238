#include "core/recording/inspection.h"
#include "tests/core/recording/aedat/aedat3_builder.h"
#include "tests/core/recording/bag_builder.h"
#include "tests/core/recording/picture_samples.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/core/recording/sample_recording.h"
#include "tests/support/test_program.h"

#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QTemporaryDir>

#include <cmath>
#include <functional>
#include <limits>

using namespace evical;
using namespace evical::test;

using Samples = std::vector<ImuSample>;
using Spoil = std::function<void(Samples&)>;
Q_DECLARE_METATYPE(Spoil)

namespace {

// 1 kHz, moved by hand, with the noise of a typical sensor.
Samples handheld() {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.01);
  Samples samples;
  for (int i = 0; i < 5000; ++i) {
    const double t = 1e-3 * i;
    ImuSample sample;
    sample.time_ns = 1'600'000'000'000'000'000 + 1'000'000LL * i;
    sample.angular_rate_rad_s = {3.0 * std::sin(5.0 * t) + noise(random), noise(random), noise(random)};
    sample.specific_force_m_s2 = {std::sin(7.0 * t) + noise(random), noise(random), 9.81 + noise(random)};
    samples.push_back(sample);
  }
  return samples;
}

QStringList kinds(const std::vector<RecordingFault>& faults) {
  QStringList names;
  for (const RecordingFault& fault : faults) names << nameOf(fault.kind);
  return names;
}

}  // namespace

class TestInspection : public QObject {
  Q_OBJECT

 private slots:
  void imuFaults_areFound_data();
  void imuFaults_areFound();
  void manyGaps_areSummedUp();
  void summary_matchesTheRecording();
  void eventFaults_areFound();
  void fewEventsOfHotPixels_areANote();
  void shortestInterval_isTheRefractoryPeriod();
  void json_holdsTheContractsKeys();
  void frames_areCountedWithTheirExposures();
  void untimedPictures_areToldSo();
  void unknownCovariances_hideNoSensor();
  void framesOutOfOrder_areAFault();
  void strayEvents_doNotExtendTheRecording();
  void emptyRecording_isAFault();
  void hostileSamples_areSurvived();
  void hostileEvents_areSurvived();

 private:
  std::filesystem::path path(const char* name) const { return folder_.filePath(name).toStdString(); }
  QTemporaryDir folder_;
};

void TestInspection::imuFaults_areFound_data() {
  QTest::addColumn<Spoil>("spoil");
  QTest::addColumn<QStringList>("expected");
  const auto row = [](const char* name, const Spoil& spoil, const QStringList& expected) {
    QTest::newRow(name) << spoil << expected;
  };
  row("good", [](Samples&) {}, {});
  row("empty", [](Samples& s) { s.clear(); }, {"empty"});
  row("gap", [](Samples& s) { s.erase(s.begin() + 100, s.begin() + 120); }, {"gap"});
  row("one sample lost", [](Samples& s) { s.erase(s.begin() + 100); }, {"gap"});
  row("backward", [](Samples& s) { std::swap(s[50].time_ns, s[51].time_ns); },
      {"gap", "gap", "backward_time"});
  row("jitter",
      [](Samples& s) {
        std::mt19937 random(5);
        for (ImuSample& sample : s) sample.time_ns += random() % 700'000;
      },
      {"jitter"});
  row("stamps in steps of 10 ms",
      [](Samples& s) {
        for (ImuSample& sample : s) sample.time_ns -= sample.time_ns % 10'000'000;
      },
      {"encoding"});
  row("stuck",
      [](Samples& s) {
        for (std::size_t i = 1000; i < 2500; ++i) s[i].angular_rate_rad_s.y() = 0.02;
      },
      {"stuck_axis"});
  row("saturated",
      [](Samples& s) {
        for (ImuSample& sample : s)
          sample.angular_rate_rad_s.x() = std::clamp(sample.angular_rate_rad_s.x(), -2.18, 2.18);
      },
      {"saturated_axis"});
  row("in g",
      [](Samples& s) {
        for (ImuSample& sample : s) sample.specific_force_m_s2 /= 9.80665;
      },
      {"unit"});
  row("gravity removed",
      [](Samples& s) {
        for (ImuSample& sample : s) sample.specific_force_m_s2.z() -= 9.81;
      },
      {"unit"});
  row("brisk motion",
      [](Samples& s) {  // a median norm of 12.7 m/s^2
        for (std::size_t i = 0; i < s.size(); ++i) {
          const double angle = 12.0 * 1e-3 * static_cast<double>(i);
          s[i].angular_rate_rad_s.x() /= 100.0;
          s[i].specific_force_m_s2 += Eigen::Vector3d(8.0 * std::sin(angle), 8.0 * std::cos(angle), 0.0);
        }
      },
      {});
  row("brisk motion, gravity removed",
      [](Samples& s) {
        for (std::size_t i = 0; i < s.size(); ++i) {
          const double angle = 12.0 * 1e-3 * static_cast<double>(i);
          s[i].angular_rate_rad_s.x() /= 100.0;
          s[i].specific_force_m_s2 += Eigen::Vector3d(8.0 * std::sin(angle), 8.0 * std::cos(angle), -9.81);
        }
      },
      {"unit"});
  row("a spike", [](Samples& s) { s[2000].specific_force_m_s2.y() += 3.0; }, {"corrupt"});
  row("deg/s",
      [](Samples& s) {
        for (ImuSample& sample : s) sample.angular_rate_rad_s *= 57.3;
      },
      {"unit"});
  row("not a number", [](Samples& s) { s[7].specific_force_m_s2.x() = std::nan(""); }, {"not_finite"});
}

void TestInspection::imuFaults_areFound() {
  QFETCH(Spoil, spoil);
  QFETCH(QStringList, expected);
  Samples samples = handheld();
  spoil(samples);
  QCOMPARE(kinds(checkImu("imu", samples)), expected);
}

void TestInspection::manyGaps_areSummedUp() {
  Samples samples;
  for (const ImuSample& sample : handheld()) {
    if (sample.time_ns / 1'000'000 % 50 != 0) samples.push_back(sample);
  }
  const std::vector<RecordingFault> faults = checkImu("imu", samples);
  QCOMPARE(faults.size(), 11u);
  QCOMPARE(faults[0].stream, std::string("imu"));
  QVERIFY(faults.back().text.ends_with("more gaps."));
}

void TestInspection::summary_matchesTheRecording() {
  const Recording written = sampleRecording(50'000);
  writeAll(*createBag(path("sample.bag"), sampleStreams(), true), written);
  const Inspection inspection = inspectRecording(*openRecording(path("sample.bag")));
  QCOMPARE(inspection.streams.size(), 2u);
  const StreamSummary& events = inspection.streams[0];
  QCOMPARE(events.count, std::uint64_t{50'000});
  QCOMPARE(events.on + events.off, events.count);
  QCOMPARE(events.first_ns, written.events.front().time_ns);
  QCOMPARE(events.last_ns, written.events.back().time_ns);
  QCOMPARE(events.backward_steps, std::uint64_t{0});
  QVERIFY(events.largest_gap_ns < 3000);
  QVERIFY((events.seen_px == Resolution{346, 260}));
  QCOMPARE(inspection.streams[1].count, std::uint64_t{written.imu_samples.size()});
}

void TestInspection::eventFaults_areFound() {
  Recording recording = sampleRecording(200'000);
  for (std::size_t i = 0; i < recording.events.size(); i += 50) {
    recording.events[i].x_px = 17;
    recording.events[i].y_px = 23;
  }
  recording.events[3].x_px = 400;
  for (std::size_t i = 100'000; i < 150'000; ++i) recording.events[i].time_ns += 200'000'000;
  recording.imu_samples.clear();
  writeAll(*createBag(path("faulty.bag"), sampleStreams(), true), recording);
  const Inspection inspection = inspectRecording(*openRecording(path("faulty.bag")));
  QVERIFY2(inspection.faults.size() == 5, qPrintable(kinds(inspection.faults).join(" ")));
  QCOMPARE(kinds(inspection.faults), QStringList({"gap", "backward_time", "outside", "hot_pixels", "empty"}));
  QCOMPARE(inspection.streams[0].backward_steps, std::uint64_t{1});
  const std::string& text = inspection.faults.at(3).text;
  QVERIFY2(text.find("1 hot pixels") == 0 && text.find("(17, 23)") != std::string::npos, text.c_str());
}

// Pixels that rest for so long after each event, in bursts; and a few events of a hot pixel, which does not
// rest.
void TestInspection::shortestInterval_isTheRefractoryPeriod() {
  constexpr std::uint16_t kWidth = 40;
  std::mt19937 random(5);
  for (const double rest_s : {0.1e-3, 0.98e-3}) {
    std::exponential_distribution<double> further_s(1.0 / 0.5e-3);
    Recording recording = sampleRecording(10);
    const std::int64_t start_ns = recording.events.front().time_ns;
    recording.events.clear();
    for (std::uint16_t pixel = 0; pixel < 1000; ++pixel) {
      double time_s = 1e-6 * pixel;
      for (int event = 0; event < 30; ++event) {
        const auto x_px = static_cast<std::uint16_t>(pixel % kWidth),
                   y_px = static_cast<std::uint16_t>(pixel / kWidth);
        recording.events.push_back({start_ns + std::llround(1e9 * time_s), x_px, y_px, event % 2 == 0});
        time_s += pixel == 0 ? 1e-5 : rest_s + further_s(random) + (event % 10 == 9 ? 0.1 : 0.0);
      }
    }
    std::ranges::sort(recording.events, {}, &Event::time_ns);
    writeAll(*createBag(path("resting.bag"), sampleStreams(), true), recording);
    const double found_s =
        inspectRecording(*openRecording(path("resting.bag"))).streams[0].shortest_interval_s;
    QVERIFY2(found_s > 0.97 * rest_s && found_s < rest_s + 0.03e-3, qPrintable(QString::number(found_s)));
  }
}
void TestInspection::fewEventsOfHotPixels_areANote() {
  Recording recording = sampleRecording(200'000);
  for (std::size_t i = 0; i < recording.events.size(); i += 500) {
    recording.events[i].x_px = 17;
    recording.events[i].y_px = 23;
  }
  writeAll(*createBag(path("hot.bag"), sampleStreams(), true), recording);
  InspectionOptions strict;
  strict.hot_pixel_share = 0.001;
  const Inspection faulty = inspectRecording(*openRecording(path("hot.bag")), strict);
  QVERIFY(kinds(faulty.faults).contains("hot_pixels") && faulty.streams[0].note.empty());
  const Inspection inspection = inspectRecording(*openRecording(path("hot.bag")));
  QVERIFY(!kinds(inspection.faults).contains("hot_pixels"));
  const std::string& note = inspection.streams[0].note;
  QVERIFY2(note.find("1 hot pixels give 0.2 %") == 0, note.c_str());
  QVERIFY(inspectionJson(inspection, false).find(note) != std::string::npos);
}

void TestInspection::json_holdsTheContractsKeys() {
  writeAll(*createBag(path("json.bag"), sampleStreams(), false), sampleRecording(10'000));
  const Inspection inspection = inspectRecording(*openRecording(path("json.bag")));
  const auto parsed = [&](bool sums) {
    return QJsonDocument::fromJson(QByteArray::fromStdString(inspectionJson(inspection, sums))).object();
  };
  const QJsonObject json = parsed(true);
  QCOMPARE(json["evical_inspect"].toInt(), 1);
  QCOMPARE(json["format"].toString(), "rosbag");
  QVERIFY(json["faults"].isArray());
  const QJsonObject events = json["streams"][0].toObject(), imu = json["streams"][1].toObject();
  for (const char* key :
       {"name", "type", "message", "count", "on", "off", "first_ns", "last_ns", "resolution_px",
        "backward_steps", "largest_gap_ns", "sum_x", "sum_y", "sum_t_ns_mod_2_64"}) {
    QVERIFY2(events.contains(key), key);
  }
  for (const char* key : {"name", "type", "count", "first_ns", "last_ns", "rate_hz", "acceleration_unit",
                          "angular_rate_unit", "mean_acceleration", "mean_angular_rate"}) {
    QVERIFY2(imu.contains(key), key);
  }
  QCOMPARE(events["type"].toString(), "events");
  QCOMPARE(events["resolution_px"].toArray(), QJsonArray({346, 260}));
  QVERIFY(!parsed(false)["streams"][0].toObject().contains("sum_x"));
}

void TestInspection::frames_areCountedWithTheirExposures() {
  const ScratchFolder scratch;
  std::string bytes = test::aedat3Header();
  for (int i = 0; i < 5; ++i) bytes += test::aedat3FramePacket({1, 50'000 * i, 50'000 * i + 1000 * (i + 1)});
  const Inspection inspection = inspectRecording(*openRecording(scratch.write("frames.aedat", bytes)));
  const StreamSummary& frames = inspection.streams.at(0);
  QCOMPARE(frames.count, std::uint64_t{5});
  QVERIFY(std::abs(frames.rate_hz - 4 / 0.202) < 1e-9);
  QCOMPARE(frames.shortest_exposure_s, 0.001);
  QCOMPARE(frames.longest_exposure_s, 0.005);
  QCOMPARE(frames.largest_gap_ns, std::int64_t{50'500'000});
  QVERIFY((frames.info.resolution_px == Resolution{3, 2}));
  const QJsonObject json =
      QJsonDocument::fromJson(QByteArray::fromStdString(inspectionJson(inspection, true)))["streams"][0]
          .toObject();
  QCOMPARE(json["type"].toString(), "frames");
  QCOMPARE(json["resolution_px"].toArray(), QJsonArray({3, 2}));
  QCOMPARE(json["exposure_s"].toArray(), QJsonArray({0.001, 0.005}));
  QVERIFY(json.contains("rate_hz") && json["readable"].toBool() && json["timed"].toBool());
}

void TestInspection::untimedPictures_areToldSo() {
  const ScratchFolder scratch;
  for (const char* name : {"pictures/1.png", "pictures/2.png"}) scratch.write(name, test::pngBytes(8, 6));
  const Inspection inspection = inspectRecording(*openRecording(scratch / "pictures"));
  QCOMPARE(inspection.streams.at(0).count, std::uint64_t{2});
  QCOMPARE(inspection.streams[0].rate_hz, 0.0);
  QVERIFY(!inspection.streams[0].info.timed);
  QCOMPARE(kinds(inspection.faults), QStringList({"guess"}));
}

// -1 marks a missing sensor, but some drivers mean an unknown covariance.
void TestInspection::unknownCovariances_hideNoSensor() {
  for (const bool values : {true, false}) {
    Samples samples = handheld();
    BagBuilder bag;
    const std::uint32_t topic = bag.addImu("/imu");
    for (ImuSample& sample : samples) {
      if (!values) sample.specific_force_m_s2.setZero();
      std::string message = imuMessage(sample);
      const double unknown = -1.0;
      message.replace(message.size() - 9 * sizeof unknown, sizeof unknown, bytesOf(unknown));
      bag.message(topic, sample.time_ns, message);
    }
    std::ofstream(path("imu.bag"), std::ios::binary) << bag.finished();
    const auto reader = openRecording(path("imu.bag"));
    const Inspection inspection = inspectRecording(*reader);
    QVERIFY(imuStreamKind(inspection.streams.at(0)) ==
            (values ? ImuStreamKind::Whole : ImuStreamKind::Gyroscope));
  }
}

void TestInspection::framesOutOfOrder_areAFault() {
  const ScratchFolder folder;
  folder.write("cam0/data.csv",
               "#t,name\n1000000000,a.png\n1100000000,b.png\n1050000000,c.png\n1150000000,d.png\n");
  for (const char* name : {"a", "b", "c", "d"})
    folder.write(std::string("cam0/data/") + name + ".png", pngBytes(8, 6));
  const auto reader = openRecording(folder / "cam0");
  QCOMPARE(kinds(inspectRecording(*reader).faults), QStringList{"backward_time"});
}

void TestInspection::strayEvents_doNotExtendTheRecording() {
  constexpr std::int64_t kBegin_ns = 1'700'000'000'000'000'000;
  std::string table = "t_ns,x,y,p\n0,1,1,1\n";
  for (int i = 0; i < 5000; ++i)
    table += std::to_string(kBegin_ns + 10'000 * i) + "," + std::to_string(i % 64) + "," +
             std::to_string(i % 48) + ",1\n";
  const ScratchFolder folder;
  const auto reader = openRecording(folder.write("events.csv", table + "0,1,1,1\n"));
  const StreamSummary events = inspectRecording(*reader).streams.at(0);
  QCOMPARE(qint64(events.first_ns), qint64(kBegin_ns));
  QCOMPARE(qint64(events.last_ns), qint64(kBegin_ns + 10'000 * 4999));
  QCOMPARE(events.count, std::uint64_t{5002});
}

void TestInspection::emptyRecording_isAFault() {
  const ScratchFolder folder;
  const auto reader = openRecording(folder.write("a.bag", BagBuilder().finished()));
  QCOMPARE(kinds(inspectRecording(*reader).faults), QStringList{"empty"});
}

void TestInspection::hostileSamples_areSurvived() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Recording recording = sampleRecording(50'000);
  const std::vector<double> values = {std::nan(""), kInfinity, -kInfinity, 1e308, -1e-308};
  for (std::size_t i = 0; i < recording.imu_samples.size(); ++i) {
    ImuSample& sample = recording.imu_samples[i];
    sample.specific_force_m_s2[static_cast<Eigen::Index>(i % 3)] = values[i % values.size()];
    sample.angular_rate_rad_s[static_cast<Eigen::Index>(i % 3)] = values[i / 3 % values.size()];
  }
  recording.imu_samples[10].time_ns = 0;
  recording.imu_samples[11].time_ns = 4'294'967'295'000'000'000;
  writeAll(*createBag(path("samples.bag"), sampleStreams(), false), recording);
  const Inspection inspection = inspectRecording(*openRecording(path("samples.bag")));
  QVERIFY(kinds(inspection.faults).contains("not_finite"));
  QVERIFY(kinds(inspection.faults).contains("backward_time"));
  const QByteArray json = QByteArray::fromStdString(inspectionJson(inspection, true));
  QVERIFY(QJsonDocument::fromJson(json).isObject());
}

void TestInspection::hostileEvents_areSurvived() {
  std::ofstream(path("events.csv")) << "t_s,x,y,p\n4.6e9,65535,65535,1\n-4.6e9,0,0,0\n1,65535,0,1\n"
                                       "4.7e9,1,1,1\n9.3e9,1,1,1\n2,0,65535,1\n";
  const Inspection inspection = inspectRecording(*openRecording(path("events.csv")));
  QCOMPARE(inspection.streams.at(0).count, std::uint64_t{4});
  QCOMPARE(inspection.streams[0].largest_gap_ns, std::int64_t{4'600'000'001'000'000'000});
  QCOMPARE(inspection.streams[0].backward_steps, std::uint64_t{1});
  QVERIFY((inspection.streams[0].seen_px == Resolution{65536, 65536}));
}

EVICAL_TEST(TestInspection)
#include "tst_inspection.moc"
