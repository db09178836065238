#include "core/base/error.h"
#include "core/format/intrinsics_yaml.h"
#include "core/initialisation/initialisation_options.h"
#include "core/pipeline/session/import_session.h"
#include "core/recording/recording_writer.h"
#include "tests/support/file_cost.h"
#include "tests/support/test_program.h"

#include <sys/stat.h>
#include <unistd.h>
#include <QTemporaryDir>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

using namespace evical;
using namespace evical::test;

namespace {

const char* const kEkalibr = R"(Configor:
  DataStream:
    EventTopics:
      - key: /davis_left/events
        value: {Type: DVS_EVENT, Width: 346, Height: 260, Intrinsics: left.yaml}
      - key: /davis_right/events
        value: {Type: DVS_EVENT, Width: 346, Height: 260, Intrinsics: ''}
    IMUTopics:
      - key: /davis_left/imu
        value: {Type: SENSOR_IMU_DEG_G_NEG, AcceWhiteNoise: 0.00186, GyroWhiteNoise: 0.000187}
      - key: /davis_right/imu
        value: {Type: SENSOR_IMU, AcceWhiteNoise: 0.002, GyroWhiteNoise: 0.0002}
    RefIMUTopic: /davis_right/imu
    BagPath: recording.bag
    BeginTime: 2
    Duration: 10
  Prior:
    CirclePattern: {Type: ASYMMETRIC_GRID, Cols: 4, Rows: 11, SpacingMeters: 0.05, RadiusRate: 2.5}
    GravityNorm: 9.79
    TimeOffsetPadding: 0.1
    SpatTempPrioriPath: ''
)";

const char* const kEkalibrLens = R"(Intrinsics:
  polymorphic_id: 2147483649
  polymorphic_name: pinhole_brown_t2
  ptr_wrapper:
    id: 2147483649
    data:
      img_width: 346
      img_height: 260
      focal_length: [260.5, 261]
      principal_point: [171, 132]
      disto_param: [-0.3, 0.1, 0.01, 0.001, 0.002]
)";

const char* const kTarget =
    "target_type: circlegrid\ntargetCols: 4\ntargetRows: 11\nspacingMeters: 0.05\n"
    "asymmetricGrid: True\n";
const char* const kImu =
    "rostopic: /davis/imu\nupdate_rate: 1000.0\naccelerometer_noise_density: 0.002\n"
    "accelerometer_random_walk: 0.0004\ngyroscope_noise_density: 0.0003\n"
    "gyroscope_random_walk: 2.0e-05\n";
const char* const kCamchain = R"(cam0:
  T_cam_imu: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
  camera_model: pinhole
  intrinsics: [260, 261, 171, 132]
  distortion_model: equidistant
  distortion_coeffs: [0.1, 0.01, 0, 0]
  resolution: [346, 260]
  rostopic: /davis/image_raw
  timeshift_cam_imu: 0.002
)";

const char* const kAprilGrid =
    "target_type: aprilgrid\ntagRows: 6\ntagCols: 6\ntagSize: 0.088\ntagSpacing: 0.3\n";

// A bag with these streams of events, and of frames of the same size.
std::filesystem::path writeBag(const std::filesystem::path& path, const std::vector<std::string>& events,
                               const std::vector<std::string>& frames) {
  std::vector<StreamInfo> streams;
  for (const auto& [names, type] : {std::pair(&events, StreamType::Events), {&frames, StreamType::Frames}})
    for (const std::string& name : *names) {
      StreamInfo& stream = streams.emplace_back();
      stream.name = name;
      stream.type = type;
      stream.resolution_px = {16, 12};
    }
  const auto bag = createBag(path, streams, false);
  for (int k = 0; k < 20; ++k) {
    const std::int64_t time_ns = 1'000'000'000 + 50'000'000 * k;
    for (std::size_t s = 0; s < streams.size(); ++s) {
      const std::vector<Event> one(1, Event{time_ns, static_cast<std::uint16_t>(k % 16), 3, true});
      if (s < events.size()) bag->write(s, one);
      Frame frame;
      frame.time_ns = time_ns;
      frame.size_px = {16, 12};
      frame.row_bytes = 16;
      frame.bytes.assign(16 * 12, 90);
      if (s >= events.size()) bag->writeFrame(s, frame);
    }
  }
  bag->finish();
  return path;
}

std::string oakCamera(int type, const std::string& focal = "262.4", const std::string& centre = "171.8") {
  return fmt::format(
      R"({{"cameraType":{},"distortionCoeff":[0.05,0.01,-0.002,0.0003,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0,0.0],"extrinsics":{{}},)"
      R"("height":260,"intrinsicMatrix":[[{},0.0,{}],[0.0,262.9,131.2],[0.0,0.0,1.0]],"width":346}})",
      type, focal, centre);
}

// The key of an OAK's file with its cameras.
std::string oakData(const std::vector<std::string>& cameras) {
  std::string text;
  for (std::size_t i = 0; i < cameras.size(); ++i)
    text += fmt::format("{}[{},{}]", i == 0 ? "" : ",", i, cameras[i]);
  return "\"cameraData\":[" + text + "]";
}

QString filled(QString text, const char* focal, const char* centre) {
  return text.replace("%1", focal).replace("%2", centre);
}

bool has(const std::vector<std::string>& notes, const char* text) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

}  // namespace

class TestImportSession : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

  std::filesystem::path write(const char* name, const std::string& text) const {
    const std::filesystem::path path = std::filesystem::path(scratch_.path().toStdString()) / name;
    std::ofstream(path) << text;
    return path;
  }
  // The session as written by `evical import` and read by `evical calibrate`.
  Session written(const ImportRequest& request, std::vector<std::string>& notes) const {
    const std::filesystem::path output =
        std::filesystem::path(scratch_.path().toStdString()) / "session.yaml";
    const ImportedFiles imported = importFiles(request, output);
    notes = imported.notes;
    if (imported.files.size() != 1 || imported.files[0].path != output)
      throw std::runtime_error("no session");
    writeFilesWhole(imported.files);
    return readSession(output);
  }
  ImportRequest kalibr() const {
    return {{write("imu.yaml", kImu), write("camchain.yaml", kCamchain), write("target.yaml", kTarget)},
            "",
            write("recording.bag", "bag"),
            std::nullopt};
  }

 private slots:
  // Camchains of MVSEC and DM-VIO contain more than cameras.
  void furtherKeysOfACamchain_areSaid() {
    ImportRequest request = kalibr();
    std::string chain = kCamchain;
    chain += "T_cam0_lidar: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n";
    chain.insert(chain.find("  rostopic"),
                 "  T_imu_cam: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n");
    request.files[1] = write("camchain.yaml", chain);
    std::vector<std::string> notes;
    QCOMPARE(written(request, notes).cameras.size(), std::size_t{1});
    QVERIFY(has(notes, "T_cam0_lidar is ignored"));
    QVERIFY(has(notes, "cam0: left out: T_imu_cam"));
  }

  // A chain of the second and the third camera only.
  void camchainWithoutCam0_isOne() {
    std::string chain = kCamchain;
    chain.replace(chain.find("cam0"), 4, "cam2");
    const ImportedFiles imported =
        importFiles({{write("camchain.yaml", chain)}, "", {}, std::nullopt}, "lens.yaml");
    QCOMPARE(imported.files.size(), std::size_t{1});
    QVERIFY(imported.files[0].content.find("pinhole_equidistant") != std::string::npos);
  }

  void camchainWithoutTheLineOfCam0_isRefused() {
    std::string second = kCamchain;
    second.replace(second.find("cam0"), 4, "cam1");
    const std::string lines = "camera_model: pinhole\nintrinsics: [260, 261, 171, 132]\n";
    const ImportRequest request{{write("camchain.yaml", lines + second)}, "", {}, std::nullopt};
    QVERIFY_THROWS_EXCEPTION(CalibrationError, importFiles(request, "lens.yaml"));
  }

  // Codes of depthai: Perspective, Fisheye, Equirectangular, RadialDivision.
  void typesOfAnOak_areTheMakers_data() {
    QTest::addColumn<int>("type");
    QTest::addColumn<QString>("model");
    QTest::newRow("Perspective") << 0 << "pinhole_radtan";
    QTest::newRow("Fisheye") << 1 << "pinhole_equidistant";
    QTest::newRow("Equirectangular") << 2 << "is 2 (Equirectangular), a lens model that is not supported";
    QTest::newRow("RadialDivision") << 3 << "is 3 (RadialDivision), a lens model that is not supported";
    QTest::newRow("unknown") << 4 << "above the maximum of 3";
  }
  void typesOfAnOak_areTheMakers() {
    QFETCH(int, type);
    QFETCH(QString, model);
    const ImportRequest request{
        {write("oak.json", "{" + oakData({oakCamera(type)}) + "}")}, "", {}, std::nullopt};
    QString said;
    try {
      said = QString::fromStdString(importFiles(request, "lens.yaml").files.at(0).content);
    } catch (const CalibrationError& error) {
      said = error.what();
    }
    QVERIFY2(said.contains(model), qPrintable(said));
  }

  void eachCameraOfAnOak_isImported() {
    const std::string off =
        "{\"cameraType\":0,\"distortionCoeff\":[],\"intrinsicMatrix\":[],\"width\":0,\"height\":0}";
    const std::filesystem::path file =
        write("oak.json", "{\"boardName\":\"B\"," + oakData({oakCamera(0), oakCamera(1), off}) + "}");
    const ImportedFiles imported = importFiles({{file}, "", {}, std::nullopt}, "lens.yaml");
    QCOMPARE(imported.files.size(), std::size_t{2});
    QCOMPARE(imported.files[1].path, std::filesystem::path("lens-cam1.yaml"));
    QVERIFY(imported.files[1].content.find("pinhole_equidistant") != std::string::npos);
    QVERIFY(has(imported.notes, "cam1: left out: extrinsics"));
    QVERIFY(has(imported.notes, "oak.json: left out: boardName"));
    QVERIFY(has(imported.notes, "cameras without intrinsics are left out"));
    QVERIFY(readIntrinsicsFile(file, "cam1", "").model == CameraModel::PinholeEquidistant);
    QVERIFY_THROWS_EXCEPTION(CalibrationError, readIntrinsicsFile(file, "left", ""));
  }

  // Files of each layout that is read as YAML; those of others are rows of tst_lens_files.
  void implausibleLenses_areRefused_data() {
    QTest::addColumn<QString>("content");
    const char* const kRos =
        "image_width: 346\nimage_height: 260\ndistortion_model: plumb_bob\ncamera_matrix: {rows: 3, cols: 3, "
        "data: [%1, 0, "
        "%2, 0, %1, 131, 0, 0, 1]}\ndistortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}\n";
    const char* const kKalibr =
        "cam0:\n  camera_model: pinhole\n  intrinsics: [%1, %1, %2, 131]\n  distortion_model: radtan\n"
        "  distortion_coeffs: [0, 0, 0, 0]\n  resolution: [346, 260]\n";
    const char* const kEuroc =
        "camera_model: pinhole\nintrinsics: [%1, %1, %2, 131]\ndistortion_model: radial-tangential\n"
        "distortion_coefficients: [0, 0, 0, 0]\nresolution: [346, 260]\n";
    const char* const kOst =
        "[image]\nwidth\n346\nheight\n260\n[narrow_stereo]\ncamera matrix\n%1 0 %2\n0 %1 131\n0 0 "
        "1\ndistortion\n"
        "0 0 0 0 0\nprojection\n260 0 171 0\n0 260 131 0\n0 0 1 0\n";
    QString ekalibr = kEkalibrLens;
    ekalibr.replace("260.5, 261", "%1, %1").replace("171", "%2");
    const char* const kOwn =
        "model: pinhole_radtan\nresolution_px: [346, 260]\nfocal_length_px: [%1, %1]\nprincipal_point_px: "
        "[%2, 131]\n"
        "distortion: [0, 0, 0, 0, 0]\n";
    for (const auto& [name, text] :
         {std::pair{"ROS", QString(kRos)}, std::pair{"Kalibr", QString(kKalibr)},
          std::pair{"EuRoC", QString(kEuroc)}, std::pair{"ost.txt", QString(kOst)},
          std::pair{"eKalibr", ekalibr}, std::pair{"Evical", QString(kOwn)},
          std::pair{"OAK", QString::fromStdString("{" + oakData({oakCamera(0, "%1", "%2")}) + "}")}}) {
      importFiles({{write("good.yaml", filled(text, "260.5", "171").toStdString())}, "", {}, std::nullopt},
                  "lens.yaml");
      for (const auto& [focal, centre] :
           {std::pair{"1e20", "171"}, std::pair{"1", "171"}, std::pair{"260.5", "-1"}})
        QTest::newRow(qPrintable(QString("%1, %2, %3").arg(name, focal, centre)))
            << filled(text, focal, centre);
    }
  }
  void impossibleLenses_areNamed_data() {
    QTest::addColumn<QString>("content");
    QTest::addColumn<QString>("says");
    const QString kalibr =
        "cam0:\n  camera_model: pinhole\n  intrinsics: [%1]\n  distortion_model: %2\n"
        "  distortion_coeffs: [%3]\n  resolution: [640, 480]\n";
    const char* const kLens = "460, 459, 320, 240";
    QTest::newRow("strong") << filled(kalibr, kLens, "radtan").arg("-28, 700, 0, 0")
                            << "distortion is implausible";
    QTest::newRow("degrees") << filled(kalibr, kLens, "equidistant").arg("5, 5, 5, 5")
                             << "distortion is implausible";
    QTest::newRow("folded") << filled(kalibr, kLens, "radtan").arg("-1.8, 0.9, 0, 0") << "the distortion ";
    QTest::newRow("order") << filled(kalibr, "460, 320, 459, 240", "radtan").arg("0, 0, 0, 0")
                           << "noted: cam0: fx and fy differ by a factor of 1.4";
    const QString ros =
        "image_width: 640\nimage_height: 480\ndistortion_model: plumb_bob\ncamera_matrix: {rows: 3, cols: "
        "3, data: [460, 0, 320, 0, 460, 240, 0, 0, 1]}\ndistortion_coefficients: {rows: 1, cols: 5, data: "
        "[-0.3, 0.1, 0, 0, 0]}\n";
    QTest::newRow("binning") << ros + "binning_x: 2\nbinning_y: 2\n"
                             << "is 2: the pictures have fewer pixels";
    QTest::newRow("part") << ros + "roi: {x_offset: 100, y_offset: 50, height: 100, width: 100}\n"
                          << "is a part of the image";
    QTest::newRow("right") << ros +
                                  "binning_x: 1\nbinning_y: 0\nroi: {x_offset: 0, y_offset: 0, height: "
                                  "480, width: 640, do_rectify: false}\n"
                           << "";
    QTest::newRow("fisheye")
        << filled(kalibr, "200, 200, 320, 240", "equidistant").arg("-0.02, 0.01, -0.008, 0.002") << "";
  }
  void impossibleLenses_areNamed() {
    QFETCH(QString, content);
    QFETCH(QString, says);
    QString said;
    try {
      for (const std::string& note :
           importFiles({{write("lens.yaml", content.toStdString())}, "", {}, std::nullopt}, "out.yaml").notes)
        if (note.find("differ") != std::string::npos) said = "noted: " + QString::fromStdString(note);
    } catch (const CalibrationError& error) {
      said = error.what();
    }
    QVERIFY2(said.isEmpty() == says.isEmpty() && said.contains(says), qPrintable(said));
  }
  void implausibleLenses_areRefused() {
    QFETCH(QString, content);
    const ImportRequest request{{write("bad.yaml", content.toStdString())}, "", {}, std::nullopt};
    QVERIFY_THROWS_EXCEPTION(CalibrationError, importFiles(request, "lens.yaml"));
  }

  void pipes_areRefusedWithoutWaiting() {
    const std::filesystem::path pipe = std::filesystem::path(scratch_.path().toStdString()) / "pipe.yaml";
    std::filesystem::remove(pipe);
    QCOMPARE(::mkfifo(pipe.c_str(), 0600), 0);
    const FileCost cost = costOf([&] {
      ::alarm(5);  // ends a reader that waits
      return importFiles({{pipe}, "", {}, std::nullopt}, "lens.yaml").notes.front();
    });
    VERIFY_COST(cost, "is a device or a pipe");
    const FileCost of_session = costOf([&] {
      ::alarm(5);
      readIntrinsicsFile(pipe, "left", "");
      return std::string("read");
    });
    VERIFY_COST(of_session, "is a device or a pipe");
  }

  // Files of an attack on imports; each was read wrong, or stopped the program.
  void collectedFiles_areReadRightOrRefused_data() {
    QTest::addColumn<QString>("file");
    QTest::addColumn<QString>("says");
    for (const auto& [file, says] :
         {std::pair{"cvdt2.yaml", "dt: is not a type"}, std::pair{"nodata.yaml", "not a plain word"},
          std::pair{"oak1.json", "pinhole_equidistant"},
          std::pair{"oaktwo.json", "^lens-cam0.yaml lens-cam1.yaml "}, std::pair{"cvu8.yaml", "does not fit"},
          std::pair{"cvscaled.yaml", "2 as its last number"},
          std::pair{"cvdup.xml", "occurs twice, first in line 4"},
          std::pair{"dupek.yaml", "occurs twice, first in line 11"},
          std::pair{"dupbas.json", "occurs twice, first in line 7"}})
      QTest::newRow(file) << QString(file) << QString(says);
  }
  void collectedFiles_areReadRightOrRefused() {
    const QString data = qEnvironmentVariable("EVICAL_DATA");
    if (data.isEmpty()) QSKIP("EVICAL_DATA is not set");
    QFETCH(QString, file);
    QFETCH(QString, says);
    const FileCost cost = costOf([&] {
      const std::filesystem::path path = (data + "/reports/imports/" + file).toStdString();
      std::string said, content;
      for (const FileContent& each : importFiles({{path}, "", {}, std::nullopt}, "lens.yaml").files) {
        said += each.path.string() + " ";
        content += each.content;
      }
      return said + content;
    });
    VERIFY_COST(cost, says);
  }

  // Without a Kalibr run there is no camchain.
  void withoutCamchain_camerasAreThoseOfTheRecording() {
    ImportRequest request = kalibr();
    request.files.erase(request.files.begin() + 1);
    std::string events = "t_s x y p\n";
    for (int i = 0; i < 2000; ++i) events += fmt::format("{:.6f} {} {} 1\n", 0.001 * i, i % 346, i % 260);
    request.recording = write("events.txt", events);
    std::vector<std::string> notes;
    const Session session = written(request, notes);
    QCOMPARE(session.cameras.size(), std::size_t{1});
    QCOMPARE(session.cameras[0].stream, std::string("events.txt"));
    QVERIFY(!session.cameras[0].intrinsics && session.imus.size() == 1);
    QVERIFY(has(notes, "its lens is calibrated first"));
    request.recording.clear();
    try {
      importSession(request);
      QFAIL("imported");
    } catch (const CalibrationError& error) {
      QVERIFY2(std::string(error.what()).find("or --recording FILE") != std::string::npos, error.what());
    }
  }

  // Events and frames show all boards.
  void recordedCameras_areThoseWithEventsOrFrames_data() {
    QTest::addColumn<bool>("circles");
    QTest::addColumn<QStringList>("events");
    QTest::addColumn<QStringList>("frames");
    const QStringList none, e = {"/left/events"}, f = {"/left/image_raw"},
                            both = {"/left/image_raw", "/right/image_raw"};
    for (const bool circles : {false, true}) {
      const char* const board = circles ? "circles" : "tags";
      QTest::addRow("%s, both", board) << circles << e << f;
      QTest::addRow("%s, two streams of frames", board) << circles << e << both;
      QTest::addRow("%s, frames only", board) << circles << none << f;
      QTest::addRow("%s, events only", board) << circles << e << none;
    }
  }
  void recordedCameras_areThoseWithEventsOrFrames() {
    QFETCH(bool, circles);
    QFETCH(QStringList, events);
    QFETCH(QStringList, frames);
    const auto names = [](const QStringList& list) {
      std::vector<std::string> texts;
      for (const QString& each : list) texts.push_back(each.toStdString());
      return texts;
    };
    ImportRequest request = kalibr();
    request.files = {write("imu.yaml", kImu), write("target.yaml", circles ? kTarget : kAprilGrid)};
    request.recording = writeBag(std::filesystem::path(scratch_.path().toStdString()) / "both.bag",
                                 names(events), names(frames));
    std::vector<std::string> notes;
    const Session session = written(request, notes);
    QStringList streams;
    for (const SessionCamera& camera : session.cameras) streams += QString::fromStdString(camera.stream);
    QCOMPARE(streams, events + frames);
    QVERIFY(has(notes, ("camera of the stream " + streams.front()).toUtf8()));
  }

  void camchainThatNamesEvents_isTaken() {
    ImportRequest request = kalibr();
    std::string chain = kCamchain;
    chain.replace(chain.find("/davis/image_raw"), 16, "/left/events");
    request.files = {write("imu.yaml", kImu), write("camchain.yaml", chain),
                     write("target.yaml", kAprilGrid)};
    request.recording = writeBag(std::filesystem::path(scratch_.path().toStdString()) / "both.bag",
                                 {"/left/events"}, {"/left/image_raw"});
    std::vector<std::string> notes;
    QCOMPARE(written(request, notes).cameras[0].stream, std::string("/left/events"));
    QVERIFY(!has(notes, "warning"));
    chain.replace(chain.find("/left/events"), 12, "/left/image_raw");
    request.files[1] = write("camchain.yaml", chain);
    written(request, notes);
    QVERIFY(!has(notes, "give the topic of the events"));
  }

  void camchainWithoutTopics_takesTheStreamsThatFit_data() {
    QTest::addColumn<bool>("circles");
    QTest::addColumn<QStringList>("frames");
    QTest::addColumn<QString>("stream");  // empty: refused
    QTest::newRow("tags") << false << QStringList{"/left/image_raw"} << "/left/image_raw";
    QTest::newRow("circles") << true << QStringList{"/left/image_raw"} << "/left/events";
    QTest::newRow("by name") << false << QStringList{"/cam0/image_raw", "/cam1/image_raw"}
                             << "/cam0/image_raw";
    QTest::newRow("several") << false << QStringList{"/a/image_raw", "/b/image_raw"} << "";
  }
  void camchainWithoutTopics_takesTheStreamsThatFit() {
    QFETCH(bool, circles);
    QFETCH(QStringList, frames);
    QFETCH(QString, stream);
    ImportRequest request = kalibr();
    std::string chain = kCamchain;
    chain.erase(chain.find("  rostopic"), std::string("  rostopic: /davis/image_raw\n").size());
    request.files = {write("imu.yaml", kImu), write("camchain.yaml", chain),
                     write("target.yaml", circles ? kTarget : kAprilGrid)};
    std::vector<std::string> names, notes;
    for (const QString& each : frames) names.push_back(each.toStdString());
    request.recording =
        writeBag(std::filesystem::path(scratch_.path().toStdString()) / "both.bag", {"/left/events"}, names);
    try {
      const Session session = written(request, notes);
      QCOMPARE(QString::fromStdString(session.cameras.at(0).stream), stream);
      QVERIFY(has(notes, "its camchain has no rostopic; the stream"));
    } catch (const CalibrationError& error) {
      QVERIFY2(stream.isEmpty(), error.what());
      QVERIFY2(QString(error.what()).contains("Add rostopic: with one of /a/image_raw, /b/image_raw"),
               error.what());
    }
  }

  // Files from users' reports: imported with these numbers, or refused by their kind.
  void reportedFiles_areImportedOrNamed_data() {
    QTest::addColumn<QString>("file");
    QTest::addColumn<double>("focal_length_px");  // of the first camera; 0: refused
    QTest::addColumn<QString>("text");            // that the lens, or the refusal, has
    const auto row = [](const char* file, double focal_length_px, const char* text) {
      QTest::newRow(file) << QString(file) << focal_length_px << QString(text);
    };
    row("camchain_12.yaml", 1049.5, "pinhole_equidistant");
    row("camchain_fov.yaml", 0.0, "is the fov model");
    row("oak.json", 0.0, "rational lens");
    row("ost.txt", 580.46715, "[0.134462, -0.311908, 0.002304, 0.003083]");
    row("rational.yaml", 0.0, "rational lens");
    row("ros1_skew.yaml", 0.0, "skew of 4.265 px");
    row("ros2_echo.yaml", 0.0, "skew of 4.265 px");
    row("ros_flatd.yaml", 579.31292788, "-0.17473019");
    row("ros_nomodel.yaml", 538.63, "-0.30678");
    row("ros_oldmodel.yaml", 580.46715, "0.134462");
  }

  void reportedFiles_areImportedOrNamed() {
    const QString folder = qEnvironmentVariable("EVICAL_DATA");
    if (folder.isEmpty()) QSKIP("EVICAL_DATA, the folder of sample recordings, is not set");
    QFETCH(QString, file);
    QFETCH(double, focal_length_px);
    QFETCH(QString, text);
    const std::filesystem::path path = (folder + "/reports/calibration_files/" + file).toStdString();
    try {
      const ImportedFiles imported = importFiles({{path}, "", {}, std::nullopt}, "lens.yaml");
      QVERIFY2(focal_length_px > 0.0, "imported");
      const std::string& yaml = imported.files[0].content;
      QVERIFY2(yaml.find(text.toStdString()) != std::string::npos, yaml.c_str());
      const CameraIntrinsics lens = readIntrinsics(YamlNode::parse(yaml, "lens.yaml"));
      QCOMPARE(lens.focal_length_px.x(), focal_length_px);
    } catch (const CalibrationError& error) {
      QVERIFY2(focal_length_px == 0.0 && QString(error.what()).contains(text), error.what());
    }
  }

  void ekalibr_becomesASession() {
    write("recording.bag", "bag");
    write("left.yaml", kEkalibrLens);
    std::vector<std::string> notes;
    const Session session = written({{write("config.yaml", kEkalibr)}, "", {}, std::nullopt}, notes);
    QVERIFY(session.board.rows == 11 && session.board.cols == 4 &&
            session.board.type == BoardType::AsymmetricCircles);
    QCOMPARE(session.board.radius_m, 0.02);
    QCOMPARE(session.cameras.size(), 2U);
    QCOMPARE(session.cameras[0].name, std::string("davis_left"));
    QCOMPARE(session.cameras[0].stream, std::string("/davis_left/events"));
    // k1 k2 k3 t1 t2 there, k1 k2 p1 p2 k3 here.
    const std::array<double, 5> distortion{-0.3, 0.1, 0.001, 0.002, 0.01};
    QVERIFY(session.cameras[0].intrinsics->distortion == distortion);
    QVERIFY(!session.cameras[1].intrinsics && session.cameras[1].resolution_px == (Resolution{346, 260}));
    QVERIFY(session.imus[0].acceleration_unit == AccelerationUnit::MinusGravity);
    QVERIFY(session.imus[0].angular_rate_unit == AngularRateUnit::DegreesPerSecond);
    QVERIFY(session.imus[1].acceleration_unit == AccelerationUnit::MetresPerSecond2);
    QCOMPARE(session.imus[1].noise.accelerometer_density, 0.002);
    QCOMPARE(session.reference, std::string("davis_right_imu"));
    QVERIFY((*session.time_range_s == std::array<double, 2>{2.0, 12.0}));
    QCOMPARE(session.options.initialisation->time_offset_search_s, 0.1);
    QCOMPARE(session.options.initialisation->gravity_m_s2, 9.79);
  }

  void kalibrsOtherTargets_becomeBoards() {
    const ImportRequest request = kalibr();
    std::vector<std::string> notes;
    write("target.yaml",
          "target_type: 'aprilgrid'\ntagCols: 6\ntagRows: 5\ntagSize: 0.088\ntagSpacing: 0.3\n");
    const Board tags = written(request, notes).board;
    QVERIFY(tags.type == BoardType::AprilGrid && tags.rows == 5 && tags.cols == 6);
    QVERIFY(std::abs(tags.spacing_m - 0.1144) < 1e-9 && tags.tag_size_m == 0.088);
    QCOMPARE(tags.pointCount(), 120);
    QVERIFY((tags.point_m(0) - Eigen::Vector2d(0.0, 4 * 0.1144 + 0.088)).norm() < 1e-9);
    write("target.yaml",
          "target_type: 'checkerboard'\ntargetCols: 7\ntargetRows: 6\nrowSpacingMeters: 0.06\n"
          "colSpacingMeters: 0.06\n");
    const Board squares = written(request, notes).board;
    QVERIFY(squares.type == BoardType::Checkerboard && squares.rows == 6 && squares.cols == 7);
    QCOMPARE(squares.spacing_m, 0.06);
  }

  void ekalibr_recordingThatIsElsewhere_isSaid() {
    const ImportedSession imported = importSession(
        {{write("config.yaml", QString(kEkalibr).replace("recording.bag", "/else/where.bag").toStdString())},
         "ekalibr",
         {},
         std::nullopt});
    QVERIFY(has(imported.notes, "/else/where.bag does not exist"));
  }

  void kalibr_inAnyOrder_becomesASession() {
    ImportRequest request = kalibr();
    std::vector<std::string> texts;
    std::sort(request.files.begin(), request.files.end());
    do {
      std::vector<std::string> notes;
      const Session session = written(request, notes);
      QCOMPARE(session.cameras[0].name, std::string("cam0"));
      QVERIFY(session.cameras[0].intrinsics->model == CameraModel::PinholeEquidistant);
      QCOMPARE(session.imus[0].stream, std::string("/davis/imu"));
      QCOMPARE(session.imus[0].noise.gyroscope_random_walk, 2e-5);
      QCOMPARE(session.board.radius_m, 0.02);
      QVERIFY(has(notes, "--radius-m") && has(notes, "seems to be an image topic") &&
              has(notes, "under prior"));
      texts.push_back(sessionYaml(session, scratch_.path().toStdString()));
      QCOMPARE(texts.back(), texts.front());
    } while (std::next_permutation(request.files.begin(), request.files.end()));
    QCOMPARE(texts.size(), 6U);
    request.radius_m = 0.015;
    QCOMPARE(importSession(request).session.board.radius_m, 0.015);
  }

  void camchain_alone_becomesIntrinsics() {
    const std::string two = std::string(kCamchain) + QString(kCamchain).replace("cam0", "cam1").toStdString();
    const ImportedFiles imported =
        importFiles({{write("camchain.yaml", two)}, "kalibr", {}, std::nullopt}, "lens.yaml");
    QCOMPARE(imported.files.size(), 2U);
    QCOMPARE(imported.files[1].path.string(), std::string("lens-cam1.yaml"));
    const CameraIntrinsics read = readIntrinsics(YamlNode::parse(imported.files[0].content, "lens"));
    QCOMPARE(read.focal_length_px.y(), 261.0);
    QVERIFY(has(imported.notes, "cam0: its pose and time offset are not imported"));
  }

  void camchain_ofADoubleSphere_becomesIntrinsics() {
    const QString ds = QString(kCamchain)
                           .replace("camera_model: pinhole", "camera_model: ds")
                           .replace("[260, 261, 171, 132]", "[-0.2, 0.6, 260, 261, 171, 132]")
                           .replace("equidistant", "none")
                           .replace("[0.1, 0.01, 0, 0]", "[]");
    const ImportedFiles imported =
        importFiles({{write("camchain.yaml", ds.toStdString())}, "kalibr", {}, std::nullopt}, "lens.yaml");
    const CameraIntrinsics read = readIntrinsics(YamlNode::parse(imported.files[0].content, "lens"));
    QCOMPARE(read.model, CameraModel::DoubleSphere);
    QCOMPARE(read.focal_length_px.y(), 261.0);
    QCOMPARE(read.distortion, (std::array<double, 5>{-0.2, 0.6, 0.0, 0.0, 0.0}));
  }

  void badInput_isNamed_data() {
    QTest::addColumn<QString>("file");  // replaces the one of its name
    QTest::addColumn<QString>("from");
    QTest::addColumn<QString>("to");
    QTest::addColumn<QString>("said");
    QTest::newRow("model") << "camchain.yaml"
                           << "camera_model: pinhole"
                           << "camera_model: scaramuzza"
                           << "scaramuzza";
    QTest::newRow("numbers of another model") << "camchain.yaml"
                                              << "camera_model: pinhole"
                                              << "camera_model: ds"
                                              << "distortion_model";
    QTest::newRow("distortion") << "camchain.yaml"
                                << "equidistant"
                                << "fov"
                                << "fov";
    QTest::newRow("target") << "target.yaml"
                            << "circlegrid"
                            << "dots"
                            << "'dots' is not a known target type";
    QTest::newRow("aprilgrid without tags") << "target.yaml"
                                            << "circlegrid"
                                            << "aprilgrid"
                                            << "tagRows";
    QTest::newRow("symmetric with IMU") << "target.yaml"
                                        << "True"
                                        << "False"
                                        << "turned by 180 degrees";
    QTest::newRow("noise") << "imu.yaml"
                           << "gyroscope_noise_density: 0.0003"
                           << "gyroscope_noise_density: -1"
                           << "gyroscope_noise_density";
    QTest::newRow("no target") << "target.yaml" << kTarget << kImu << "Give Kalibr's target file, too";
    QTest::newRow("two camchains") << "target.yaml" << kTarget << kCamchain << "is the second camchain file";
    QTest::newRow("something else") << "target.yaml" << kTarget << "a: b\n"
                                    << "no layout that can be imported";
  }
  void badInput_isNamed() {
    QFETCH(QString, file);
    QFETCH(QString, from);
    QFETCH(QString, to);
    QFETCH(QString, said);
    const ImportRequest request = kalibr();
    const QString before = file == "imu.yaml" ? kImu : (file == "target.yaml" ? kTarget : kCamchain);
    QVERIFY(before.contains(from));
    write(file.toUtf8().constData(), QString(before).replace(from, to).toStdString());
    try {
      importFiles(request, "session.yaml");
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      QVERIFY2(QString(error.what()).contains(said), error.what());
    }
  }

  void recording_thatNobodyNames_isAskedFor() {
    ImportRequest request = kalibr();
    request.recording.clear();
    try {
      importFiles(request, "session.yaml");
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      QVERIFY2(QString(error.what()).contains("--recording FILE"), error.what());
    }
  }

  void imuType_thatIsUnknown_isNamed() {
    const std::string text = QString(kEkalibr).replace("SENSOR_IMU_DEG_G_NEG", "ANOTHER_IMU").toStdString();
    try {
      importSession({{write("config.yaml", text)}, "", {}, std::nullopt});
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      QVERIFY2(QString(error.what()).contains("ANOTHER_IMU"), error.what());
    }
  }

  // eKalibr's own template names one; the other IMU and the cameras are imported.
  void imuOfSbg_isLeftOut() {
    write("recording.bag", "bag");
    write("left.yaml", kEkalibrLens);
    const std::string text = QString(kEkalibr).replace("SENSOR_IMU_DEG_G_NEG", "SBG_IMU").toStdString();
    std::vector<std::string> notes;
    const Session session = written({{write("config.yaml", text)}, "", {}, std::nullopt}, notes);
    QVERIFY(session.imus.size() == 1 && session.imus[0].stream == "/davis_right/imu");
    QVERIFY(has(notes, "/davis_left/imu is ignored"));
  }
};

EVICAL_TEST(TestImportSession)
#include "tst_import_session.moc"
