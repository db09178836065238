#include "core/frontend/detection_options.h"
#include "core/initialisation/initialisation_options.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/session/session.h"

#include "core/pipeline/session/option_pages.h"
#include "core/pipeline/session/session_keys.h"
#include "tests/core/pipeline/session/refused_session.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <fstream>

using namespace evical;

namespace {

const char* const kGoodSession = R"(evical_session: 1
recording: recording.bag
time_range_s: [1, 30]
board:
  type: asymmetric_circles
  rows: 11
  cols: 4
  spacing_m: 0.05
  radius_m: 0.02
  circles: bright
cameras:
  left:
    stream: /left/events
    resolution_px: [346, 260]
    intrinsics:
      model: pinhole_radtan
      focal_length_px: [260.5, 255]
      principal_point_px: [170, 131]
      distortion: [-0.3, 0.1, 0.001, 0.002]
imus:
  left_imu:
    stream: /left/imu
    accelerometer_noise_density: 1.86e-3
    gyroscope_noise_density: 1.87e-4
    acceleration_unit: -g
    angular_rate_unit: deg/s
reference: left_imu
prior:
  time_offset_search_s: 0.5
options:
  grid: {min_circles: 7}
  tuning.bursts.min_events: 3
)";

const char* const kSessionCamchain = R"(cam0:
  camera_model: pinhole
  intrinsics: [300, 301, 170, 131]
  distortion_model: radtan
  distortion_coeffs: [0.1, 0, 0, 0]
  resolution: [640, 480]
  rostopic: /right/events
cam1:
  T_cn_cnm1: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
  camera_model: pinhole
  intrinsics: [260, 261, 171, 132]
  distortion_model: equidistant
  distortion_coeffs: [0.1, 0.01, 0, 0]
  resolution: [346, 260]
  rostopic: /left/events
)";

const char* const kCameraInfo = R"(image_width: 346
image_height: 260
camera_name: left
camera_matrix: {rows: 3, cols: 3, data: [260, 0, 171, 0, 261, 132, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [-0.3, 0.1, 0, 0, 0.01]}
)";

const QString kCircles =
    "board:\n  type: asymmetric_circles\n  rows: 11\n  cols: 4\n  spacing_m: 0.05\n  radius_m: 0.02\n"
    "  circles: bright\n";
const QString kInlineIntrinsics =
    "intrinsics:\n      model: pinhole_radtan\n      focal_length_px: [260.5, 255]\n"
    "      principal_point_px: [170, 131]\n      distortion: [-0.3, 0.1, 0.001, 0.002]\n";

}  // namespace

class TestSession : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;
  std::filesystem::path folder() const { return scratch_.path().toStdString(); }

  std::filesystem::path write(const char* name, const std::string& text) const {
    std::ofstream(folder() / name) << text;
    return folder() / name;
  }
  Session sessionWith(const QString& from, const QString& to) const {
    QString text = kGoodSession;
    if (!from.isEmpty() && !text.contains(from)) qFatal("the good session lacks %s", qPrintable(from));
    if (!from.isEmpty()) text.replace(from, to);
    return readSession(write("session.yaml", text.toStdString()));
  }
  Session sessionWithIntrinsicsFile(const char* content) const {
    write("left.yaml", content);
    return sessionWith(kInlineIntrinsics, "intrinsics: left.yaml\n");
  }

 private slots:
  void initTestCase() { write("recording.bag", "x"); }

  void session_isReadWhole() {
    const Session session = sessionWith("", "");
    QVERIFY(std::filesystem::equivalent(session.recording, folder() / "recording.bag"));
    QCOMPARE((*session.time_range_s)[1], 30.0);
    QCOMPARE(session.board.rows, 11);
    QVERIFY(session.board.circles == CircleShade::Bright);
    QCOMPARE(session.cameras.at(0).name, std::string("left"));
    QCOMPARE(session.cameras[0].stream, std::string("/left/events"));
    QCOMPARE(session.cameras[0].intrinsics->focal_length_px.x(), 260.5);
    QVERIFY((session.cameras[0].intrinsics->resolution_px == Resolution{346, 260}));
    QCOMPARE(session.imus.at(0).noise.gyroscope_density, 1.87e-4);
    QVERIFY(std::abs(metresPerSecond2(session.imus[0].acceleration_unit.value()) + 9.80665) < 1e-12);
    QVERIFY(std::abs(180.0 * radiansPerSecond(session.imus[0].angular_rate_unit.value()) - 3.14159265358979) <
            1e-12);
    QCOMPARE(session.options.initialisation->time_offset_search_s, 0.5);
    QCOMPARE(session.options.front_end->grid.min_circles, 7);
    QCOMPARE(session.options.front_end->bursts.min_events, 3);
  }

  void optionInAGroupOfGroups_isReadInEveryForm_data() {
    QTest::addColumn<QString>("text");
    QTest::newRow("nested") << "optimisation: {solver: {threads: 7}}";
    QTest::newRow("full name") << "optimisation.solver.threads: 7";
    QTest::newRow("full group") << "optimisation.solver: {threads: 7}";
    QTest::newRow("old name") << "optimisation.threads: 7";
    QTest::newRow("old group") << "optimisation: {threads: 7}";
  }
  void optionInAGroupOfGroups_isReadInEveryForm() {
    QFETCH(QString, text);
    const Session session = sessionWith("tuning.bursts.min_events: 3", text);
    QCOMPARE(session.options.optimisation->threads, 7);
    QVERIFY(sessionYaml(session, folder()).find("optimisation.solver.threads: 7") != std::string::npos);
  }

  void tuning_isReadInEveryForm_andWritten() {
    for (const char* const text : {"tuning.bursts.min_events: 4", "tuning: {bursts.min_events: 4}",
                                   "tuning: {bursts: {min_events: 4}}"}) {
      const Session session = sessionWith("tuning.bursts.min_events: 3", text);
      QCOMPARE(session.options.front_end->bursts.min_events, 4);
      QVERIFY(sessionYaml(session, folder()).find("\n  tuning.bursts.min_events: 4\n") != std::string::npos);
    }
  }

  void everyDefault_canBeRead() {
    std::string defaults = optionYaml();
    const Session session = sessionWith("options:\n  grid: {min_circles: 7}\n  tuning.bursts.min_events: 3\n",
                                        QString::fromStdString(defaults));
    QCOMPARE(differingOptions(session.options).size(), std::size_t(0));
  }

  void session_writtenAndRead_isTheSame() {
    const Session session = sessionWith("", "");
    writeSession(session, folder() / "again.yaml");
    const Session again = readSession(folder() / "again.yaml");
    QVERIFY(std::filesystem::equivalent(again.recording, session.recording));
    QVERIFY(again.time_range_s == session.time_range_s);
    QVERIFY(again.board == session.board);
    QVERIFY(again.cameras[0].intrinsics == session.cameras[0].intrinsics);
    QVERIFY(again.imus[0].acceleration_unit == session.imus[0].acceleration_unit);
    QVERIFY(again.options == session.options);
    QCOMPARE(sessionYaml(again, folder()), sessionYaml(session, folder()));
  }

  void boardsWithoutCircles_areReadAndWritten_data() {
    QTest::addColumn<QString>("board");
    QTest::addColumn<int>("points");
    QTest::addColumn<double>("spacing_m");
    QTest::newRow("aprilgrid") << "type: aprilgrid, rows: 6, cols: 5, tag_size_m: 0.08, spacing_m: 0.1" << 120
                               << 0.1;
    QTest::newRow("as Kalibr says it")
        << "type: aprilgrid, rows: 6, cols: 5, tag_size_m: 0.08, tag_spacing: 0.25" << 120 << 0.1;
    QTest::newRow("checkerboard") << "type: checkerboard, rows: 6, cols: 9, spacing_m: 0.03" << 54 << 0.03;
    QTest::newRow("charuco") << "type: charuco, rows: 6, cols: 9, spacing_m: 0.03, tag_size_m: 0.02" << 40
                             << 0.03;
  }
  void boardsWithoutCircles_areReadAndWritten() {
    QFETCH(QString, board);
    QFETCH(int, points);
    QFETCH(double, spacing_m);
    const Session session = sessionWith(kCircles, "board: {" + board + "}\n");
    QCOMPARE(session.board.pointCount(), points);
    QVERIFY(std::abs(session.board.spacing_m - spacing_m) < 1e-12);
    writeSession(session, folder() / "again.yaml");
    QVERIFY(readSession(folder() / "again.yaml").board == session.board);
  }

  void boardsThatAreNone_areRefused_data() {
    QTest::addColumn<QString>("board");
    QTest::addColumn<QString>("said");
    QTest::newRow("radius of corners")
        << "type: checkerboard, rows: 6, cols: 9, spacing_m: 0.03, radius_m: 0.01"
        << "radius_m";
    QTest::newRow("no tag size") << "type: aprilgrid, rows: 6, cols: 5, spacing_m: 0.1"
                                 << "tag_size_m";
    QTest::newRow("no spacing") << "type: aprilgrid, rows: 6, cols: 5, tag_size_m: 0.08"
                                << "neither spacing_m nor tag_spacing";
    QTest::newRow("twice") << "type: aprilgrid, rows: 6, cols: 5, tag_size_m: 0.08, tag_spacing: 0.25, "
                              "spacing_m: 0.1"
                           << "duplicates spacing_m";
    QTest::newRow("tags that touch") << "type: aprilgrid, rows: 6, cols: 5, tag_size_m: 0.1, spacing_m: 0.1"
                                     << "less than the distance from one tag to the next";
    QTest::newRow("half turn") << "type: checkerboard, rows: 6, cols: 8, spacing_m: 0.03"
                               << "both even or both odd";
    QTest::newRow("unknown") << "type: dots, rows: 6, cols: 8, spacing_m: 0.03"
                             << "aprilgrid";
  }
  void boardsThatAreNone_areRefused() {
    QFETCH(QString, board);
    QFETCH(QString, said);
    try {
      sessionWith(kCircles, "board: {" + board + "}\n");
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      QVERIFY2(QString(error.what()).contains(said), error.what());
    }
  }

  void shutter_isKept() {
    const Session session =
        sessionWith("    stream: /left/events\n", "    stream: /left/events\n    shutter: rolling\n");
    QVERIFY(session.cameras[0].shutter == Shutter::Rolling);
    writeSession(session, folder() / "again.yaml");
    QVERIFY(readSession(folder() / "again.yaml").cameras[0].shutter == Shutter::Rolling);
    QVERIFY(sessionWith("", "").cameras[0].shutter == Shutter::Global);
  }

  void mirroring_isReadAndWritten() {
    for (std::size_t k = 0; k < kMirroringNames.size(); ++k) {
      const QString key = QString("    mirrored: %1\n").arg(kMirroringNames[k]);
      const Session session = sessionWith("    stream: /left/events\n", "    stream: /left/events\n" + key);
      QVERIFY(session.cameras[0].mirrored == static_cast<Mirroring>(k));
      QVERIFY(QString::fromStdString(sessionYaml(session, folder())).contains(key));
    }
    QVERIFY(!sessionWith("", "").cameras[0].mirrored);
    Session session = sessionWith("", "");
    QVERIFY_THROWS_EXCEPTION(CalibrationError, setInSession(session, "cameras.left.mirrored", "z"));
  }

  void rejectedWindows_areReadAndWritten() {
    const QString stream = "    stream: /left/events\n";
    const Session session = sessionWith(stream, stream + "    rejected_windows_s: [12.5, 3.0625]\n");
    QCOMPARE(session.cameras[0].rejected_windows_s, (std::vector{3.0625, 12.5}));
    writeSession(session, folder() / "again.yaml");
    QCOMPARE(readSession(folder() / "again.yaml").cameras[0].rejected_windows_s,
             session.cameras[0].rejected_windows_s);
    QCOMPARE(sessionYaml(withoutRejectedWindows(session), folder()),
             sessionYaml(sessionWith("", ""), folder()));
  }

  void camerasOfOneSensor_haveOneLens() {
    const Session session =
        sessionWith("imus:\n", "  frames:\n    stream: /left/image_raw\n    same_sensor_as: left\nimus:\n");
    QCOMPARE(session.sensorOf(1), std::size_t{0});
    QCOMPARE(session.sensorOf(0), std::size_t{0});
    const std::vector<CameraLens> lenses = givenLenses(session);
    QVERIFY(lenses[1].given && lenses[1] == lenses[0]);
    writeSession(session, folder() / "again.yaml");
    QCOMPARE(sessionYaml(readSession(folder() / "again.yaml"), folder()), sessionYaml(session, folder()));
  }

  void camerasOfNoSensor_areRefused_data() {
    QTest::addColumn<QString>("camera");
    QTest::addColumn<QStringList>("said");
    const QString frames = "  frames:\n    stream: /left/image_raw\n    same_sensor_as: ";
    QTest::newRow("unknown") << frames + "lift\n" << QStringList{"cameras.frames.same_sensor_as", "'left'"};
    QTest::newRow("itself") << frames + "frames\n" << QStringList{"not another camera", "left"};
    QTest::newRow("of one that has none")
        << frames + "left\n  more:\n    stream: /more\n    same_sensor_as: frames\n"
        << QStringList{"cameras.more.same_sensor_as", "with its own sensor"};
    QTest::newRow("two lenses")
        << frames +
               "left\n    resolution_px: [346, 260]\n    intrinsics: {model: pinhole_radtan, "
               "focal_length_px: "
               "[260, 260], principal_point_px: [170, 130], distortion: [0, 0, 0, 0]}\n"
        << QStringList{"cameras.frames.intrinsics", "Give intrinsics only for 'left'"};
  }
  void camerasOfNoSensor_areRefused() {
    QFETCH(QString, camera);
    QFETCH(QStringList, said);
    try {
      sessionWith("imus:\n", camera + "imus:\n");
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      test::verifyRefusal(error, said);
    }
  }

  void severalBoards_areReadAndWritten() {
    const QString text =
        QString(kGoodSession)
            .replace(kCircles,
                     "boards:\n"
                     "  tags: {type: aprilgrid, rows: 6, cols: 6, tag_size_m: 0.088, tag_spacing: 0.3, "
                     "spacing_std: 0.001}\n"
                     "  plate: {type: asymmetric_circles, rows: 11, cols: 4, radius_m: 0.02,\n"
                     "          measured: {spacings: 10, length_m: 0.502, std_m: 0.0005}}\n")
            .replace("    resolution_px: [346, 260]\n", "    resolution_px: [346, 260]\n    board: plate\n")
            .replace("imus:\n", "  right: {stream: /right/frames, board: tags}\nimus:\n");
    const Session session = readSession(write("session.yaml", text.toStdString()));
    QCOMPARE(session.board_name, std::string("plate"));  // which the first camera sees: the world
    QCOMPARE(session.board.spacing_m, 0.0502);
    QCOMPARE(session.options.optimisation->board_spacing_sigma, 0.0005 / 0.502);
    QCOMPARE(session.further_boards.size(), std::size_t{1});
    QCOMPARE(session.further_boards[0].name, std::string("tags"));
    QCOMPARE(session.further_boards[0].spacing_std, std::optional(0.001));
    QCOMPARE(session.boardIndexOf(0), std::size_t{0});
    QCOMPARE(session.boardOf(1).tag_size_m, 0.088);
    writeSession(session, folder() / "again.yaml");
    const Session again = readSession(folder() / "again.yaml");
    QVERIFY(again.board == session.board && again.board_name == session.board_name);
    QVERIFY(again.further_boards[0].board == session.further_boards[0].board);
    QCOMPARE(again.further_boards[0].spacing_std, std::optional(0.001));
    QCOMPARE(again.cameras[1].board, std::string("tags"));
  }

  void boardsThatNobodySees_areRefused_data() {
    QTest::addColumn<QString>("boards");
    QTest::addColumn<QString>("of_left");
    QTest::addColumn<QStringList>("said");
    const QString plate =
        "  plate: {type: asymmetric_circles, rows: 11, cols: 4, spacing_m: 0.05, radius_m: 0.02}\n";
    const QString tags = "  tags: {type: aprilgrid, rows: 6, cols: 6, tag_size_m: 0.088, spacing_m: 0.1}\n";
    QTest::newRow("none") << "boards: {}\n"
                          << "" << QStringList{"boards", "is empty"};
    QTest::newRow("unseen") << "boards:\n" + plate + tags << "board: plate"
                            << QStringList{"boards.tags", "no camera sees it"};
    QTest::newRow("not said") << "boards:\n" + plate + tags << ""
                              << QStringList{"cameras.left.board", "is missing"};
    QTest::newRow("other name") << "boards:\n" + plate << "board: plat"
                                << QStringList{"cameras.left.board", "Did you mean 'plate'"};
    QTest::newRow("of a sensor") << "boards:\n" + QString(plate).replace("plate", "left_imu")
                                 << "board: left_imu"
                                 << QStringList{"boards.left_imu", "is also a sensor's name"};
    QTest::newRow("both") << kCircles + "boards:\n" + plate << "board: plate"
                          << QStringList{"boards", "in addition to board"};
    QTest::newRow("symmetric") << "boards:\n" + QString(plate).replace("11", "10") << "board: plate"
                               << QStringList{"boards.plate.rows", "turned by 180 degrees"};
  }
  void boardsThatNobodySees_areRefused() {
    QFETCH(QString, boards);
    QFETCH(QString, of_left);
    QFETCH(QStringList, said);
    const QString resolution = "    resolution_px: [346, 260]\n";
    const QString text =
        QString(kGoodSession)
            .replace(kCircles, boards)
            .replace(resolution, resolution + (of_left.isEmpty() ? "" : "    " + of_left + "\n"));
    try {
      readSession(write("session.yaml", text.toStdString()));
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      test::verifyRefusal(error, said);
    }
  }

  void exportsAndRandomWalks_areKept() {
    const Session session =
        sessionWith("reference: left_imu\n", "reference: left_imu\nexport: [openvins, ros]\n");
    QVERIFY((session.exports == std::vector<std::string>{"openvins", "ros"}));
    writeSession(session, folder() / "again.yaml");
    QVERIFY(readSession(folder() / "again.yaml").exports == session.exports);
    const Session walks = sessionWith("    acceleration_unit: -g\n",
                                      "    acceleration_unit: -g\n    gyroscope_random_walk: 2e-5\n"
                                      "    accelerometer_random_walk: 3e-4\n");
    writeSession(walks, folder() / "again.yaml");
    const SessionImu again = readSession(folder() / "again.yaml").imus.at(0);
    QCOMPARE(again.noise.gyroscope_random_walk, 2e-5);
    QCOMPARE(again.noise.accelerometer_random_walk, 3e-4);
  }

  void points_areAFileOfTheirOwn() {
    write("left.csv.gz", "x");
    const Session session =
        sessionWith("    stream: /left/events\n", "    points: left.csv.gz\n    clock_offset_s: 0.5\n");
    QVERIFY(std::filesystem::equivalent(session.cameras[0].recording, folder() / "left.csv.gz"));
    QCOMPARE(session.cameras[0].stream, std::string("left.csv.gz"));
    QCOMPARE(session.cameras[0].clock_offset_s, 0.5);
    writeSession(session, folder() / "again.yaml");
    const Session again = readSession(folder() / "again.yaml");
    QVERIFY(std::filesystem::equivalent(again.cameras[0].recording, folder() / "left.csv.gz"));
    QCOMPARE(again.cameras[0].stream, session.cameras[0].stream);
  }

  void camerasOfOneSensor_mayBeCompared() {
    const QString camera = "  frames:\n    stream: /left/image_raw\n    same_sensor_as: left\n";
    const auto sharing = [&](const QString& key) {
      return sessionWith("imus:\n", camera + key + "imus:\n").options.optimisation->share_sensors;
    };
    QVERIFY(sharing(""));
    QVERIFY(sharing("    same_sensor_check: false\n"));
    QVERIFY(!sharing("    same_sensor_check: true\n"));
  }

  void sensors_mayHaveTheirOwnRecordings() {
    write("imu.csv", "x");
    const Session session = sessionWith(
        "    stream: /left/imu\n", "    recording: imu.csv\n    stream: imu\n    clock_offset_s: -1.25\n");
    QVERIFY(session.cameras[0].recording.empty());
    QVERIFY(std::filesystem::equivalent(session.imus[0].recording, folder() / "imu.csv"));
    QCOMPARE(session.imus[0].clock_offset_s, -1.25);
    writeSession(session, folder() / "again.yaml");
    const Session again = readSession(folder() / "again.yaml");
    QVERIFY(std::filesystem::equivalent(again.imus[0].recording, folder() / "imu.csv"));
    QCOMPARE(again.imus[0].clock_offset_s, -1.25);
    QCOMPARE(sessionYaml(again, folder()), sessionYaml(session, folder()));
  }

  void intrinsics_ofKalibr_areThoseOfTheStream() {
    const CameraIntrinsics camera = *sessionWithIntrinsicsFile(kSessionCamchain).cameras[0].intrinsics;
    QVERIFY(camera.model == CameraModel::PinholeEquidistant);
    QCOMPARE(camera.focal_length_px.y(), 261.0);
  }
  void intrinsics_ofRos_areRead() {
    const CameraIntrinsics camera = *sessionWithIntrinsicsFile(kCameraInfo).cameras[0].intrinsics;
    QVERIFY(camera.model == CameraModel::PinholeRadtan);
    QCOMPARE(camera.principal_point_px.y(), 132.0);
    QCOMPARE(camera.distortion[4], 0.01);
  }

  void session_withoutImu_mayHaveAnyBoard() {
    const QString text = QString(kGoodSession).section("imus:", 0, 0).replace("rows: 11", "rows: 10");
    const Session session = readSession(write("session.yaml", text.toStdString()));
    QCOMPARE(session.reference, std::string("left"));
  }

  void spacingsSigma_isAnOption() {
    const Session exact = sessionWith("radius_m: 0.02", "radius_m: 0.02\n  spacing_std: 0");
    QVERIFY(!exact.options.optimisation->free_board_size);
    const Session measured = sessionWith("radius_m: 0.02", "radius_m: 0.02\n  spacing_std: 0.0005");
    QVERIFY(measured.options.optimisation->free_board_size);
    QCOMPARE(measured.options.optimisation->board_spacing_sigma, 0.0005);
  }

  void sigmasOfALens_comeWithItsFile_andAreWritten() {
    const char* const file = R"(evical_intrinsics: 1
intrinsics:
  model: pinhole_radtan
  resolution_px: [346, 260]
  focal_length_px: [260, 261]
  principal_point_px: [171, 132]
  distortion: [-0.3, 0.1, 0.001, 0.002]
intrinsics_std:
  focal_length_px: [0.2, 0.21]
  principal_point_px: [0.3, 0.31]
  distortion: [0.001, 0.002, 0.0001, 0.0002]
correlation:
  - [1, 0.9, 0, 0, 0, 0, 0, 0]
  - [0.9, 1, 0, 0, 0, 0, 0, 0]
  - [0, 0, 1, 0, 0, 0, 0, 0]
  - [0, 0, 0, 1, 0, 0, 0, 0]
  - [0, 0, 0, 0, 1, -0.8, 0, 0]
  - [0, 0, 0, 0, -0.8, 1, 0, 0]
  - [0, 0, 0, 0, 0, 0, 1, 0]
  - [0, 0, 0, 0, 0, 0, 0, 1]
)";
    const Session session = sessionWithIntrinsicsFile(file);
    const LensUncertainty uncertainty = session.cameras[0].intrinsics_uncertainty.value();
    QCOMPARE(uncertainty.std[1], 0.21);
    QCOMPARE(uncertainty.std[7], 0.0002);
    QCOMPARE(uncertainty.std[8], 0.0);
    QCOMPARE(uncertainty.correlation.value()(5, 4), -0.8);
    QCOMPARE(uncertainty.correlation.value()(8, 8), 1.0);
    QVERIFY(givenLenses(session)[0].given_with == uncertainty);
    const Session again = readSession(write("again.yaml", sessionYaml(session, folder())));
    QVERIFY(again.cameras[0].intrinsics_uncertainty == uncertainty);
    QVERIFY(!sessionWithIntrinsicsFile(kCameraInfo).cameras[0].intrinsics_uncertainty);
  }

  void sigmasOfALens_mayStandInTheSession() {
    const QString sigmas =
        kInlineIntrinsics +
        "    intrinsics_std: {focal_length_px: [0.2, 0.2], principal_point_px: [0.3, 0.3], "
        "distortion: [0, 0, 0, 0]}\n";
    const Session session = sessionWith(kInlineIntrinsics, sigmas);
    QCOMPARE(session.cameras[0].intrinsics_uncertainty.value().std[3], 0.3);
    QVERIFY(!session.cameras[0].intrinsics_uncertainty->correlation);
  }

  void imusAxes_areReadAndWritten_andAreAPermutation() {
    const Session session =
        sessionWith("angular_rate_unit: deg/s", "angular_rate_unit: deg/s\n    gyroscope_axes: y,x,-z");
    QVERIFY((session.imus[0].gyroscope_axes == AxesReading{2, 1, -3}));
    QVERIFY(session.imus[0].accelerometer_axes == kIdentityAxes);
    const Eigen::Vector3d read = readAs(session.imus[0].gyroscope_axes, {1.0, 2.0, 3.0});
    QCOMPARE((read - Eigen::Vector3d(2.0, 1.0, -3.0)).norm(), 0.0);
    const Session again = readSession(write("again.yaml", sessionYaml(session, folder())));
    QVERIFY(again.imus[0].gyroscope_axes == session.imus[0].gyroscope_axes);
    for (const char* const none : {"x,y", "x,x,z", "x,y,z,", "x y z", "x,y,w", ""}) QVERIFY(!axesFrom(none));
    QVERIFY((axesFrom("-x, -y, -z") == AxesReading{-1, -2, -3}));
  }

  // Raw counts have the size of a count as their unit.
  void imusUnits_mayHaveAFactor() {
    for (const auto& [text, factor] :
         {std::pair{"0.000488 g", 0.000488}, std::pair{"1/16384 g", 1.0 / 16384.0},
          std::pair{"0.061 mg", 0.000061}, std::pair{"g", 1.0}}) {
      Session session = sessionWith("acceleration_unit: -g", QString("acceleration_unit: %1").arg(text));
      QVERIFY(session.imus[0].acceleration_unit == AccelerationUnit::Gravity);
      QVERIFY(std::abs(session.imus[0].acceleration_factor / factor - 1.0) < 1e-12);
      setInSession(session, "imus.left_imu.angular_rate_unit", "0.061 deg/s");
      const Session again = readSession(write("again.yaml", sessionYaml(session, folder())));
      QCOMPARE(again.imus[0].acceleration_factor, session.imus[0].acceleration_factor);
      QVERIFY(again.imus[0].angular_rate_unit == AngularRateUnit::DegreesPerSecond);
      QCOMPARE(again.imus[0].angular_rate_factor, 0.061);
    }
    for (const char* const none : {"0 g", "-0.1 g", "1/0 g", "3", "0.1 lsb", "1e999 g"})
      QVERIFY_THROWS_EXCEPTION(
          CalibrationError, sessionWith("acceleration_unit: -g", QString("acceleration_unit: %1").arg(none)));
  }

  // Gyroscope and accelerometer of a phone.
  void imu_mayHaveTwoFiles() {
    for (const char* const file : {"Gyroscope.csv", "Accelerometer.csv"}) write(file, "x");
    const QString two = "recording: [Gyroscope.csv, Accelerometer.csv]\n";
    const Session session =
        sessionWith("stream: /left/imu\n",
                    two + "    columns: {gyroscope: \"t_ns,gz,gy,gx\", accelerometer: \"t_ns,az,ay,ax\"}\n");
    const Session again = readSession(write("again.yaml", sessionYaml(session, folder())));
    for (const SessionImu& imu : {session.imus[0], again.imus[0]}) {
      QCOMPARE(imu.recording.filename().string(), std::string("Gyroscope.csv"));
      QCOMPARE(imu.accelerometer_recording.filename().string(), std::string("Accelerometer.csv"));
      QCOMPARE(imu.joinedStream(), std::string("Gyroscope.csv + Accelerometer.csv"));
      QCOMPARE(imu.columns, std::string("t_ns,gz,gy,gx"));
      QCOMPARE(imu.accelerometer_columns, std::string("t_ns,az,ay,ax"));
    }
    for (const char* const bad : {"recording: [Gyroscope.csv]\n", "recording: [Gyroscope.csv, none.csv]\n",
                                  "recording: [Gyroscope.csv, Accelerometer.csv]\n    stream: imu\n"})
      QVERIFY_THROWS_EXCEPTION(CalibrationError, sessionWith("stream: /left/imu\n", bad));
  }

  // A table may have columns of several IMUs.
  void sensorsOfOneTable_differInTheirColumns() {
    const auto with = [&](const char* columns) {
      return sessionWith("reference: left_imu\n",
                         QString("  right_imu:\n    stream: /left/imu\n    columns: \"%1\"\n"
                                 "    accelerometer_noise_density: 1e-3\n    gyroscope_noise_density: 1e-4\n"
                                 "reference: left_imu\n")
                             .arg(columns));
    };
    QCOMPARE(with("t_s,ax,ay,az,gx,gy,gz").imus.size(), std::size_t{2});
    QVERIFY_THROWS_EXCEPTION(CalibrationError, sessionWith("reference: left_imu\n",
                                                           "  right_imu:\n    stream: /left/imu\n"
                                                           "    accelerometer_noise_density: 1e-3\n"
                                                           "    gyroscope_noise_density: 1e-4\n"
                                                           "reference: left_imu\n"));
  }

  void oneKey_isSet() {
    Session session = sessionWith("", "");
    setInSession(session, "imus.left_imu.acceleration_unit", "g");
    QVERIFY(session.imus[0].acceleration_unit == AccelerationUnit::Gravity);
    setInSession(session, "imus.left_imu.accelerometer_axes", "-x,-y,-z");
    QVERIFY((session.imus[0].accelerometer_axes == AxesReading{-1, -2, -3}));
    setInSession(session, "optimisation.gyroscope_rotation", "true");
    QVERIFY(session.options.optimisation->gyroscope_rotation == Estimated::Yes);
    setInSession(session, "time_range_s", "[2,11.5]");
    QVERIFY((session.time_range_s == std::array<double, 2>{2.0, 11.5}));
    for (const auto& [key, value] :
         {std::pair{"imus.right_imu.acceleration_unit", "g"},
          std::pair{"imus.left_imu.acceleration_unit", "gravities"}, std::pair{"imus.left_imu.colour", "red"},
          std::pair{"imus.left_imu.gyroscope_axes", "y,x"}, std::pair{"time_range_s", "[3, 2]"},
          std::pair{"time_range_s", "5"}, std::pair{"time_range_s", "[-1, 2]"}})
      QVERIFY_THROWS_EXCEPTION(CalibrationError, setInSession(session, key, value));
  }

  // If -x,-y,-z was applied and is applied again, the original axes result.
  void repairOfAxes_isOfWhatTheSensorGives() {
    Session session = sessionWith("", "");
    const Repair negate{"imus.left_imu.accelerometer_axes", "-x,-y,-z"};
    QVERIFY(ofRawAxes(negate, session) == negate);
    session.imus[0].accelerometer_axes = {-1, -2, -3};
    QCOMPARE(ofRawAxes(negate, session).value, std::string("x,y,z"));
    session.imus[0].accelerometer_axes = {2, 3, 1};
    const Repair swap{"imus.left_imu.accelerometer_axes", "y,x,z"};
    const Eigen::Vector3d own(1.0, 2.0, 3.0);
    const Eigen::Vector3d twice = readAs({2, 1, 3}, readAs({2, 3, 1}, own));
    QCOMPARE((readAs(axesFrom(ofRawAxes(swap, session).value).value(), own) - twice).norm(), 0.0);
    const Repair option{"optimisation.model.gyroscope_rotation", "true"};
    QVERIFY(ofRawAxes(option, session) == option);
  }

  void measuredLength_tellsSpacingAndSigma() {
    const Session session =
        sessionWith("spacing_m: 0.05", "measured: {spacings: 10, length_m: 0.352, std_m: 0.0005}");
    QCOMPARE(session.board.spacing_m, 0.352 / 10);
    QVERIFY(session.options.optimisation->free_board_size);
    QCOMPARE(session.options.optimisation->board_spacing_sigma, 0.0005 / 0.352);
    QVERIFY(session.measured == (MeasuredLength{10, 0.352, 0.0005}));
    const Session rough = sessionWith("spacing_m: 0.05", "measured: {spacings: 10, length_m: 0.352}");
    QCOMPARE(rough.options.optimisation->board_spacing_sigma, 0.0005 / 0.352);  // half a millimetre
    const Session exact =
        sessionWith("spacing_m: 0.05", "measured: {spacings: 10, length_m: 0.352, std_m: 0}");
    QVERIFY(!exact.options.optimisation->free_board_size);
    const Session both = sessionWith(
        "spacing_m: 0.05", "spacing_m: 0.05\n  measured: {spacings: 10, length_m: 0.501, std_m: 0.0005}");
    QCOMPARE(both.board.spacing_m, 0.501 / 10);  // within the ruler's sigmas
  }

  void measuredLength_isWrittenAsItWasRead() {
    for (const char* const std_m : {"0.0005", "0"}) {
      const Session session = sessionWith(
          "spacing_m: 0.05", QString("measured: {spacings: 10, length_m: 0.352, std_m: %1}").arg(std_m));
      const std::string text = sessionYaml(session, folder());
      QVERIFY2(QString::fromStdString(text).contains(
                   QString("measured: {spacings: 10, length_m: 0.352, std_m: %1}").arg(std_m)),
               text.c_str());
      QVERIFY(!QString::fromStdString(text).contains("board_spacing_sigma"));
      QVERIFY(!QString::fromStdString(text).contains("free_board_size"));
      const Session again = readSession(write("again.yaml", text));
      QVERIFY(again.measured == session.measured);
      QVERIFY(again.board == session.board);
      QVERIFY(again.options == session.options);
    }
  }

  void spacingThatIsChangedByHand_isNoLongerMeasured() {
    Session session =
        sessionWith("spacing_m: 0.05", "measured: {spacings: 10, length_m: 0.352, std_m: 0.0005}");
    setMeasuredLength(std::nullopt, session);
    QCOMPARE(session.board.spacing_m, 0.352 / 10);
    QCOMPARE(session.options.optimisation->board_spacing_sigma, PriorOptions().board_spacing_sigma);
    setMeasuredLength(MeasuredLength{10, 0.352, 0.0}, session);
    QVERIFY(!session.options.optimisation->free_board_size);
    setMeasuredLength(MeasuredLength{10, 0.352, 0.0005}, session);
    QVERIFY(session.options.optimisation->free_board_size);
    session.board.spacing_m = 0.04;
    const QString text = QString::fromStdString(sessionYaml(session, folder()));
    QVERIFY(text.contains("spacing_m: 0.04") && !text.contains("measured"));
  }

  void mistake_isRefusedWithItsPlace_data() {
    QTest::addColumn<QString>("from");
    QTest::addColumn<QString>("to");
    QTest::addColumn<QStringList>("said");
    const auto row = [](const char* name, const char* from, const char* to, const QStringList& said) {
      QTest::newRow(name) << QString(from) << QString(to) << said;
    };
    row("no session", "evical_session: 1", "nothing: 1", {"evical_session"});
    row("points and a stream", "    stream: /left/events\n",
        "    points: recording.bag\n    stream: /left/events\n",
        {"cameras.left.stream", "cannot be combined with points"});
    row("points that are not there", "    stream: /left/events\n", "    points: gone.csv\n",
        {"cameras.left.points", "gone.csv' does not exist"});
    row("check of no sensor", "    stream: /left/events\n",
        "    stream: /left/events\n    same_sensor_check: true\n", {"same_sensor_check", "same_sensor_as"});
    row("rejected window before the start", "    stream: /left/events\n",
        "    stream: /left/events\n    rejected_windows_s: [-1]\n", {"rejected_windows_s", "below"});
    row("newer session", "evical_session: 1", "evical_session: 2", {"evical_session (line 1)", "above"});
    row("unknown key", "time_range_s:", "time_rang_s:", {"time_rang_s (line 3)", "'time_range_s'"});
    row("unknown export", "reference: left_imu", "reference: left_imu\nexport: [opnvins]",
        {"export", "'opnvins'", "Did you mean 'openvins'?"});
    row("unknown board key", "radius_m:", "radius:", {"board.radius (line 9)", "'radius_m'"});
    row("key twice", "cols: 4", "rows: 4", {"board.rows (line 7)", "twice"});
    row("control character in a stream", "stream: /left/events", "stream: \"/left\\r/events\"",
        {"cameras.left.stream", "'/left\\x0d/events'", "Remove the character"});
    row("control character in a name", "reference: left_imu", "reference: \"left_imu\\x1b\"",
        {"reference", "'left_imu\\x1b'"});
    row("missing key", "  rows: 11\n", "", {"board.rows", "missing"});
    row("missing recording", "recording.bag", "other.bag",
        {"recording (line 2)", "other.bag", "does not exist"});
    row("backward range", "[1, 30]", "[30, 1]", {"time_range_s (line 3)", "is not a range"});
    row("text for a number", "0.05", "5cm", {"board.spacing_m (line 8)", "'5cm'"});
    row("number out of range", "0.05", "50", {"board.spacing_m (line 8)", "50 m", "10 m"});
    row("spacing's sigma", "radius_m: 0.02", "radius_m: 0.02\n  spacing_std: -0.001",
        {"board.spacing_std", "below"});
    row("length that contradicts the spacing", "spacing_m: 0.05",
        "spacing_m: 0.05\n  measured: {spacings: 11, length_m: 0.5}",
        {"board.spacing_m (line 8)", "contradicts board.measured", "0.0454545", "n - 1 spacings"});
    row("sigma said twice", "radius_m: 0.02",
        "radius_m: 0.02\n  spacing_std: 0.001\n  measured: {spacings: 10, length_m: 0.5}",
        {"board.spacing_std", "std_m", "Remove one"});
    row("longer than the board", "spacing_m: 0.05", "measured: {spacings: 11, length_m: 0.55}",
        {"board.measured.spacings (line 8)", "which has 10"});
    row("millimetres for metres", "spacing_m: 0.05", "measured: {spacings: 10, length_m: 0.5, std_m: 0.5}",
        {"board.measured.std_m (line 8)", "a sigma of"});
    row("measured by nothing", "spacing_m: 0.05", "measured: {spacings: 10}",
        {"board.measured.length_m", "missing"});
    row("sigmas of no lens",
        "    intrinsics:\n      model: pinhole_radtan\n      focal_length_px: [260.5, 255]\n"
        "      principal_point_px: [170, 131]\n      distortion: [-0.3, 0.1, 0.001, 0.002]\n",
        "    intrinsics_std: {focal_length_px: [1, 1], principal_point_px: [1, 1], "
        "distortion: [0, 0, 0, 0]}\n",
        {"cameras.left.intrinsics_std", "without intrinsics"});
    row("axes", "angular_rate_unit: deg/s", "gyroscope_axes: x,x,z",
        {"imus.left_imu.gyroscope_axes", "'x,x,z'"});
    row("latitude", "reference: left_imu", "reference: left_imu\ngravity: {latitude_deg: 91}",
        {"gravity.latitude_deg", "90"});
    row("gravity without a latitude", "reference: left_imu", "reference: left_imu\ngravity: {height_m: 300}",
        {"gravity.latitude_deg", "missing"});
    row("circles that touch", "0.02", "0.2", {"board", "radius_m"});
    row("board type", "asymmetric_circles", "asymetric_circles", {"board.type (line 5)", "Did you mean"});
    row("even rows", "rows: 11", "rows: 10", {"board.rows", "180 degrees"});
    row("symmetric board", "asymmetric_circles", "symmetric_circles", {"board.type", "180 degrees"});
    row("camera without stream", "    stream: /left/events\n", "", {"cameras.left.stream", "missing"});
    row("same stream", "/left/imu", "/left/events", {"imus.left_imu.stream", "/left/events"});
    row("same stream by its file", "stream: /left/imu",
        "recording: ./recording.bag\n    stream: /left/events",
        {"imus.left_imu.stream", "already another sensor's"});
    row("resolution", "[346, 260]", "[346]", {"cameras.left.resolution_px (line 14)", "width, height"});
    row("negative focal length", "260.5", "-260.5", {"cameras.left.intrinsics", "focal_length_px"});
    row("exchanged principal point", "principal_point_px: [170, 131]", "principal_point_px: [131, 170]",
        {"cameras.left.intrinsics", "x and y exchanged"});
    row("distortion", "0.1, 0.001, 0.002", "0.1", {"intrinsics.distortion (line 19)", "k1, k2, p1, p2"});
    row("camera model", "pinhole_radtan", "pinhole", {"intrinsics.model (line 16)", "'pinhole'"});
    row("noise", "1.86e-3", "0", {"imus.left_imu.accelerometer_noise_density (line 23)", "below"});
    row("unit", "-g", "G", {"acceleration_unit (line 25)", "m/s^2, g, -g"});
    row("reference", "reference: left_imu", "reference: left",
        {"reference", "not one of the IMUs", "left_imu"});
    row("option", "min_circles: 7", "min_circle: 7", {"options.grid.min_circle (line 31)", "min_circles"});
    row("option's value", "min_circles: 7", "min_circles: 1", {"options.grid.min_circles", "minimum of 4"});
    row("option's group", "grid:", "gird:", {"options.gird (line 31)", "'grid'"});
    row("part of a group", "tuning.bursts.min_events: 3", "optimisation: {solve: {threads: 3}}",
        {"options.optimisation.solve (line 32)", "'optimisation.solver'"});
    row("tuning without its name", "tuning.bursts.min_events: 3", "bursts: {min_events: 3}",
        {"options.bursts.min_events (line 32)", "Write tuning.bursts.min_events"});
    row("options that exclude each other", "tuning.bursts.min_events: 3", "detection: {min_window_s: 0.1}",
        {"options (line 30)", "detection.min_window_s (0.1 s) is above", "max_window_s (0.05 s)"});
    row("prior", "time_offset_search_s: 0.5", "time_offset_search_s: 90",
        {"prior.time_offset_search_s", "60 s"});
    row("no YAML", "[346, 260]", "[346, 260", {"session.yaml (line", "not valid YAML"});
  }
  void mistake_isRefusedWithItsPlace() {
    QFETCH(QString, from);
    QFETCH(QString, to);
    QFETCH(QStringList, said);
    try {
      sessionWith(from, to);
      QFAIL("must throw");
    } catch (const CalibrationError& error) {
      test::verifyRefusal(error, said);
    }
  }

  // Sessions that a program builds.
  void controlCharacters_inMembers_areRefused() {
    for (const char* const name : {"a\nb",
                                   "a\xc2\x85"
                                   "b",
                                   "\x1b[2J"}) {
      Session camera = sessionWith({}, {}), imu = camera, stream = camera;
      camera.cameras.front().name = name;
      imu.imus.front().name = imu.reference = name;
      stream.cameras.front().stream = name;
      for (const Session& session : {camera, imu, stream})
        QVERIFY_THROWS_EXCEPTION(CalibrationError, validate(session, "session"));
    }
  }

  // Paths may have any character, comments of strangers none that ends a line.
  void pathsAndRemarks_withLineBreaks_areWritten() {
    write("line\nbreak\x1b.bag", "x");
    Session session = sessionWith({}, {});
    session.recording = folder() / "line\nbreak\x1b.bag";
    SessionRemarks remarks;
    remarks.board = "first\rcameras: {}\nsecond\xe2\x80\xa8third";
    remarks.sensors["left"] = {"a\rb: c"};
    const std::string text = sessionYaml(session, folder(), remarks);
    QVERIFY(text.find('\r') == std::string::npos && text.find('\x1b') == std::string::npos);
    QVERIFY(text.find("# first\\x0dcameras: {}\n# second\\u2028third\n") != std::string::npos);
    // A board with a remark is a comment, so the session is read without.
    QCOMPARE(readSession(write("breaks.yaml", sessionYaml(session, folder()))).recording, session.recording);
    session.imus.front().columns = "t_ns\tax\tay\taz\tgx\tgy\tgz";
    QCOMPARE(readSession(write("tabs.yaml", sessionYaml(session, folder()))).imus.front().columns,
             session.imus.front().columns);
  }

  void linkToARecording_staysALink() {
    const auto disk = folder() / "disk", work = folder() / "work";
    std::filesystem::create_directories(disk / "day1");
    std::filesystem::create_directories(work);
    write("disk/day1/recording.bag", "x");
    std::filesystem::create_symlink(disk / "day1" / "recording.bag", work / "linked.bag");
    std::filesystem::create_directory_symlink(disk, work / "disk");
    Session session = sessionWith({}, {});
    const auto recordingIn = [&](const std::filesystem::path& recording, const std::filesystem::path& of) {
      session.recording = recording;
      const YamlNode root = YamlNode::parse(sessionYaml(session, of), "session");
      return root["recording"].anyText();
    };
    QCOMPARE(recordingIn(work / "linked.bag", work), std::string("linked.bag"));
    QCOMPARE(recordingIn(work / "disk" / "day1" / "recording.bag", work),
             std::string("disk/day1/recording.bag"));
    QCOMPARE(recordingIn(work / "disk" / "day1" / "recording.bag", disk), std::string("day1/recording.bag"));
    QCOMPARE(recordingIn(work / ".." / "work" / "linked.bag", work), std::string("linked.bag"));
    QCOMPARE(recordingIn(work / "linked.bag", disk), (work / "linked.bag").string());
    QCOMPARE(recordingIn(disk / "day1" / "", disk), std::string("day1"));
  }

  // The recording is in the folder of the link, or in that of the file.
  void sessionThroughALink_findsItsRecording() {
    const auto archive = folder() / "archive", desk = folder() / "desk";
    std::filesystem::create_directories(archive);
    std::filesystem::create_directories(desk);
    write("archive/recording.bag", "x");
    write("archive/session.yaml", kGoodSession);
    std::filesystem::create_symlink(archive / "session.yaml", desk / "session.yaml");
    QVERIFY(
        std::filesystem::equivalent(readSession(desk / "session.yaml").recording, archive / "recording.bag"));
    write("desk/recording.bag", "y");
    QVERIFY(
        std::filesystem::equivalent(readSession(desk / "session.yaml").recording, desk / "recording.bag"));
  }

  void missingFile_isNamed() {
    try {
      readSession(folder() / "none.yaml");
      QFAIL("must throw");
    } catch (const CalibrationError& error) {
      QVERIFY2(error.place().find("none.yaml") != std::string::npos, error.what());
    }
  }
};

EVICAL_TEST(TestSession)
#include "tst_session.moc"
