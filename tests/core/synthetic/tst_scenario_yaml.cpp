#include "core/base/error.h"
#include "core/base/yaml_node.h"
#include "core/format/intrinsics_yaml.h"
#include "core/geometry/so3.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <filesystem>
#include <fstream>

using namespace evical;

namespace {

const std::filesystem::path kScenarios = test::sourcePath("config/scenarios");

}  // namespace

class TestScenarioYaml : public QObject {
  Q_OBJECT
 private slots:
  void shippedScenarios_areValid() {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kScenarios)) {
      if (entry.is_directory()) continue;  // logs of IMUs alone
      const Scenario scenario = readScenario(entry.path());
      QVERIFY(scenario.cameras.front().intrinsics.resolution_px.known());
      const bool refused = scenario.name == "symmetric_board";
      QCOMPARE(scenario.board.hasHalfTurnAmbiguity() && !scenario.imus.empty(), refused);
      ++count;
    }
    QVERIFY(count >= 25);
  }
  void base_isChangedKeyByKey() {
    const Scenario base = readScenario(kScenarios / "davis346.yaml");
    const Scenario noisy = readScenario(kScenarios / "noisy.yaml");
    QCOMPARE(noisy.name, std::string("noisy"));
    QVERIFY(noisy.cameras[0].pixel.hot_pixels > base.cameras[0].pixel.hot_pixels);
    QCOMPARE(noisy.cameras[0].pixel.threshold_on, base.cameras[0].pixel.threshold_on);
    QVERIFY(noisy.cameras[0].intrinsics == base.cameras[0].intrinsics);
    QVERIFY(std::abs(noisy.gravity_in_world_m_s2.norm() - 9.81) < 1e-9);
  }
  void sensors_mayBeLists() {
    const Scenario scenario =
        read("base: davis346.yaml\nimus:\n- {}\n- {name: second, stream: /imu2, rate_hz: 400}\n");
    QCOMPARE(scenario.imus.size(), std::size_t{2});
    QCOMPARE(scenario.imus[0].name, std::string("left_imu"));
    QCOMPARE(scenario.imus[1].rate_hz, 400.0);
  }
  void errorsOfTheSession_areInItAndNotInTheTruth() {
    const Scenario scenario = read(
        "base: davis346.yaml\nsession: {spacing_error: 0.01, focal_length_error: 0.02, imu_noise_factor: "
        "3}\n");
    const std::string session = sessionYaml(scenario, "recording.bag"), truth = truthYaml(scenario);
    QVERIFY(session.find("spacing_m: 0.0505") != std::string::npos);
    QVERIFY(session.find("267.64") != std::string::npos);  // 262.4 and 2 %
    QVERIFY(session.find("gyroscope_noise_density: 0.000561") != std::string::npos);
    QVERIFY(truth.find("262.4") != std::string::npos);
  }
  void realisticScenarios_areLessKind() {
    for (const char* name : {"realistic.yaml", "realistic_10s.yaml"}) {
      const Scenario scenario = readScenario(kScenarios / name);
      QVERIFY(scenario.motion.hand.tremor_rad > 0.0);
      QVERIFY(scenario.imus[0].faults.clock_drift_ppm > 0.0);
      QVERIFY(scenario.cameras[0].pixel.low_pass_light_power > 0.0);
    }
  }
  void mistakes_areNamed_data() {
    QTest::addColumn<QString>("text");
    QTest::addColumn<QString>("place");
    QTest::addColumn<QString>("said");
    QTest::newRow("unknown key") << "base: davis346.yaml\nboard: {row: 11}\n"
                                 << "board.row"
                                 << "rows";
    QTest::newRow("unknown group") << "base: davis346.yaml\nmotoin: {}\n"
                                   << "motoin"
                                   << "motion";
    QTest::newRow("out of range") << "base: davis346.yaml\nduration_s: -3\n"
                                  << "duration_s"
                                  << "-3";
    QTest::newRow("no number") << "base: davis346.yaml\nimu: {rate_hz: fast}\n"
                               << "imu.rate_hz"
                               << "fast";
    QTest::newRow("unknown word") << "base: davis346.yaml\nformat: bags\n"
                                  << "format"
                                  << "bag";
    QTest::newRow("too few numbers") << "base: davis346.yaml\ngravity_m_s2: [0, 9.81]\n"
                                     << "gravity_m_s2"
                                     << "3";
    QTest::newRow("no gravity") << "base: davis346.yaml\ngravity_m_s2: [0, 0, 0]\n"
                                << "gravity_m_s2"
                                << "zero";
    QTest::newRow("lower triangle")
        << "base: davis346.yaml\nimu: {gyroscope_scale_misalignment: [[1,0,0],[0.1,1,0],[0,0,1]]}\n"
        << "imu.gyroscope_scale_misalignment"
        << "upper triangular";
    QTest::newRow("circles touch") << "base: davis346.yaml\nboard: {radius_m: 0.04}\n"
                                   << "board"
                                   << "";
    QTest::newRow("no camera") << "duration_s: 3\n"
                               << "intrinsics"
                               << "";
    QTest::newRow("through the board") << "base: davis346.yaml\nmotion: {distance_amplitude_m: 0.6}\n"
                                       << "motion"
                                       << "through the board";
    QTest::newRow("same names") << "base: davis346.yaml\nimus: [{}, {name: left_imu, stream: /b}]\n"
                                << ""
                                << "left_imu";
    QTest::newRow("endless stops") << "base: davis346.yaml\nmotion: {hand: {stop_every_s: 1}}\n"
                                   << "motion.hand"
                                   << "stop_every_s";
    QTest::newRow("unknown fault") << "base: davis346.yaml\nimu: {faults: {drift: 1}}\n"
                                   << "imu.faults.drift"
                                   << "clock_drift_ppm";
    QTest::newRow("hand without an end") << "base: davis346.yaml\nscene: {hand: {every_s: 2, stay_s: 1}}\n"
                                         << "scene.hand"
                                         << "every_s";
    QTest::newRow("lamp behind the board") << "base: davis346.yaml\nscene: {lamp_m: [0, 0, 1]}\n"
                                           << "scene"
                                           << "lamp_m";
    QTest::newRow("people behind the wall")
        << "base: davis346.yaml\nscene: {people: {every_s: 2, distance_m: 1}}\n"
        << "scene"
        << "clutter_distance_m";
    QTest::newRow("a crowd") << "base: davis346.yaml\nscene: {people: {every_s: 0.01}}\n"
                             << "scene.people.every_s"
                             << "too short";
    QTest::newRow("unknown gloss") << "base: davis346.yaml\nscene: {gloss: {width_deg: 3}}\n"
                                   << "scene.gloss.width_deg"
                                   << "spread_deg";
    QTest::newRow("a roll of paper") << "base: davis346.yaml\nboard: {row_bow_m: 0.5}\n"
                                     << "board.row_bow_m"
                                     << "0.5";
    QTest::newRow("endless base") << "base: scenario.yaml\n"
                                  << "base"
                                  << "has no end";
    QTest::newRow("missing base") << "base: davis347.yaml\n"
                                  << "davis347.yaml"
                                  << "";
  }
  void mistakes_areNamed() {
    QFETCH(QString, text);
    QFETCH(QString, place);
    QFETCH(QString, said);
    try {
      read(text.toStdString());
      QFAIL("no error");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      QVERIFY2(QString::fromStdString(error.place()).contains(place), error.what());
      QVERIFY2(QString(error.what()).contains(said), error.what());
    }
  }
  void truth_statesWhatAPerfectEstimatorReports() {
    Scenario scenario = readScenario(kScenarios / "davis346.yaml");
    scenario.cameras[0].pixel.latency_s = 2e-4;
    scenario.cameras[0].pixel.low_pass_s = 3e-4;
    const YamlNode truth = YamlNode::parse(truthYaml(scenario), "truth.yaml");
    const YamlNode camera = truth["cameras"]["left"], imu = truth["imus"]["left_imu"];
    QCOMPARE(camera["time_offset_s"].real(), 0.0073 - 5e-4);
    QCOMPARE(camera["clock_offset_s"].real(), 0.0073);
    QCOMPARE(camera["photoreceptor_delay_s"].real(), 5e-4);
    const std::vector<double> translation = camera["reference_from_camera"]["translation_m"].reals(3);
    const std::vector<double> rotation = camera["reference_from_camera"]["rotation_xyzw"].reals(4);
    for (int i = 0; i < 3; ++i)
      QCOMPARE(translation[static_cast<std::size_t>(i)],
               scenario.cameras[0].imu_from_camera.translation_m(i));
    for (int i = 0; i < 4; ++i)
      QCOMPARE(rotation[static_cast<std::size_t>(i)],
               scenario.cameras[0].imu_from_camera.rotation.coeffs()(i));
    QVERIFY(readIntrinsics(camera["intrinsics"]) == scenario.cameras[0].intrinsics);
    QCOMPARE(imu["gyroscope"]["bias_rad_s"].reals(3)[0], scenario.imus[0].gyroscope_bias_rad_s.x());
    QCOMPARE(imu["accelerometer"]["mapping"].items()[0].reals(3)[2],
             scenario.imus[0].accelerometer_scale_misalignment(0, 2));
    scenario.imus[0].gyroscope_from_accelerometer = quaternionExp({0.0, 0.02, 0.0});
    scenario.imus[0].accelerometer_delay_s = 0.0025;
    const YamlNode turned = YamlNode::parse(truthYaml(scenario), "truth.yaml");
    const std::vector<double> turn =
        turned["imus"]["left_imu"]["gyroscope"]["gyroscope_from_accelerometer_xyzw"].reals(4);
    QCOMPARE(turn[1], std::sin(0.01));
    QCOMPARE(turn[3], std::cos(0.01));
    QCOMPARE(turned["imus"]["left_imu"]["accelerometer_delay_s"].real(), 0.0025);
    QCOMPARE(truth["gravity_m_s2"].reals(3)[1], scenario.gravity_in_world_m_s2.y());
    QCOMPARE(truth["reference"].text(), std::string("left_imu"));
  }
  // Bow and spacing relative to the session: the middle of columns of 0.5 m is bowed by 1 mm.
  void truth_hasTheBoardsBow() {
    const Scenario scenario = read(
        "base: davis346.yaml\nboard: {column_bow_m: 0.001, twist_m: 0.0007}\nsession: {spacing_error: "
        "0.01}\n");
    const YamlNode board = YamlNode::parse(truthYaml(scenario), "truth.yaml")["board"];
    QVERIFY(std::abs(board["column_curvature_1_m"].real() - 0.001 * 8.0 / (0.5 * 0.5) / (1.01 * 1.01)) <
            1e-9);
    QVERIFY(std::abs(board["twist_1_m"].real() - 0.0007 * 4.0 / (0.5 * 0.35) / (1.01 * 1.01)) < 1e-9);
    QCOMPARE(board["row_curvature_1_m"].real(), 0.0);
    QVERIFY(std::abs(board["scale"].real() - 1.0 / 1.01) < 1e-12);
  }
  void session_fitsTheRecording() {
    Scenario scenario = readScenario(kScenarios / "davis346.yaml");
    const YamlNode bag = YamlNode::parse(sessionYaml(scenario, "recording.bag"), "session.yaml");
    QCOMPARE(bag["recording"].text(), std::string("recording.bag"));
    QCOMPARE(bag["cameras"]["left"]["stream"].text(), std::string("/davis_left/events"));
    QCOMPARE(bag["board"]["rows"].integer(1, 100), 11);
    QCOMPARE(bag["imus"]["left_imu"]["gyroscope_noise_density"].real(), 1.87e-4);
    scenario.intrinsics_in_session = false;
    scenario.imus.clear();
    const YamlNode less = YamlNode::parse(sessionYaml(scenario, "recording.bag"), "session.yaml");
    QVERIFY(!less["cameras"]["left"].has("intrinsics") && !less.has("imus"));
    QCOMPARE(less["reference"].text(), std::string("left"));
  }

 private:
  // The text as a scenario in davis346.yaml's folder.
  Scenario read(const std::string& text) {
    const QTemporaryDir folder;
    const std::filesystem::path path = folder.path().toStdString();
    std::filesystem::copy_file(kScenarios / "davis346.yaml", path / "davis346.yaml");
    std::ofstream(path / "scenario.yaml") << text;
    return readScenario(path / "scenario.yaml");
  }
};

EVICAL_TEST(TestScenarioYaml)
#include "tst_scenario_yaml.moc"
