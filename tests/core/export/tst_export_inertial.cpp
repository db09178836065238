// Files for visual-inertial programs, read back with each program's own convention: a world point must
// project to the same pixel, and the IMU must measure the same.
#include "core/base/error.h"
#include "core/geometry/lens_fit.h"
#include "tests/core/export/exported_rig.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/LU>

#include <limits>
#include <opencv2/core.hpp>

using namespace evical;
using namespace evical::test;

namespace {

constexpr double kExportInertialSame_px = 1e-9;
constexpr double kExportInertialSame = 1e-12;  // of measured rad/s and m/s^2

Lens kalibrLens(const YAML::Node& camera) {
  const auto intrinsics = numbers(camera["intrinsics"]), distortion = numbers(camera["distortion_coeffs"]);
  return camera["distortion_model"].as<std::string>() == "radtan" ? radtanLens(intrinsics, distortion)
                                                                  : fisheyeLens(intrinsics, distortion);
}

// The measurement of our IMU for a specific force and a rate in our IMU's frame.
struct Measured {
  Eigen::Vector3d force, rate;
};
Measured ours(const ImuState& imu, const Eigen::Vector3d& force, const Eigen::Vector3d& rate) {
  return {imu.accelerometer_scale_misalignment * force + imu.accelerometer_bias_m_s2,
          imu.gyroscopeMatrix() * rate + imu.gyroscope_bias_rad_s};
}

// The largest difference on random inputs.
double worstMeasured(const ImuState& imu,
                     const std::function<Measured(const Eigen::Vector3d&, const Eigen::Vector3d&)>& theirs) {
  std::srand(7);
  double worst = 0.0;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d force = 10.0 * Eigen::Vector3d::Random(), rate = 5.0 * Eigen::Vector3d::Random();
    const Measured a = ours(imu, force, rate), b = theirs(force, rate);
    worst = std::max({worst, (a.force - b.force).norm(), (a.rate - b.rate).norm()});
  }
  return worst;
}

bool isRotationForExportInertial(const Eigen::Matrix3d& r) {
  return (r * r.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-12 && r.determinant() > 0.0;
}

}  // namespace

class TestExportInertial : public QObject {
  Q_OBJECT

 private slots:
  void kalibr_reprojects_data() {
    QTest::addColumn<bool>("fisheye");
    QTest::addColumn<bool>("mapped");
    QTest::newRow("radtan") << false << false;
    QTest::newRow("radtan, scales") << false << true;
    QTest::newRow("equidistant, scales") << true << true;
  }
  void kalibr_reprojects() {
    QFETCH(bool, fisheye);
    QFETCH(bool, mapped);
    RigKind kind;
    kind.fisheye = fisheye;
    kind.mapped = mapped;
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "kalibr");
    const YAML::Node chain = yamlOf(exported, "kalibr/camchain-imucam.yaml"),
                     imus = yamlOf(exported, "kalibr/imu.yaml");
    std::vector<Eigen::Matrix3d> turns;
    for (std::size_t i = 0; i < 2; ++i) {
      const YAML::Node imu = imus[numbered("imu", static_cast<Eigen::Index>(i))];
      QCOMPARE(imu["model"].as<std::string>(), std::string(mapped ? "scale-misalignment" : "calibrated"));
      const ImuState& state = result.result->state.imus[i];
      turns.emplace_back(Eigen::Matrix3d::Identity());
      if (!mapped) continue;
      const Eigen::Matrix3d lower = rowsMatrix(imu["accelerometers"]["M"]),
                            gyro = rowsMatrix(imu["gyroscopes"]["M"]),
                            gyro_from_imu = rowsMatrix(imu["gyroscopes"]["C_gyro_i"]);
      QVERIFY(Eigen::Matrix3d(lower.triangularView<Eigen::StrictlyUpper>()).norm() < 1e-15);
      QVERIFY(Eigen::Matrix3d(gyro.triangularView<Eigen::StrictlyUpper>()).norm() < 1e-15);
      turns[i] = lower.inverse() * state.accelerometer_scale_misalignment;  // Kalibr's IMU frame from ours
      QVERIFY(isRotationForExportInertial(turns[i]) && isRotationForExportInertial(gyro_from_imu));
      QVERIFY(worstMeasured(state, [&](const Eigen::Vector3d& force, const Eigen::Vector3d& rate) {
                return Measured{lower * (turns[i] * force) + state.accelerometer_bias_m_s2,
                                gyro * gyro_from_imu * (turns[i] * rate) + state.gyroscope_bias_rad_s};
              }) < kExportInertialSame);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      const YAML::Node camera = chain[numbered("cam", static_cast<Eigen::Index>(i))];
      const ReadCamera read{rowsMatrix(camera["T_cam_imu"]), camera["timeshift_cam_imu"].as<double>(),
                            kalibrLens(camera), turns[0]};
      QVERIFY(worstDifference_px(result, i, read) < kExportInertialSame_px);
    }
    const Eigen::Matrix4d step = rowsMatrix(chain["cam1"]["T_cn_cnm1"]);
    const Eigen::Matrix4d direct = rowsMatrix(chain["cam1"]["T_cam_imu"]) *
                                   Eigen::Matrix4d(rowsMatrix(chain["cam0"]["T_cam_imu"])).inverse();
    QVERIFY((step - direct).norm() < 1e-12);
    QVERIFY((step - rowsMatrix(yamlOf(exported, "kalibr/camchain.yaml")["cam1"]["T_cn_cnm1"])).norm() <
            1e-15);
    // T_i_b takes points of the reference (in Kalibr's frames) to this IMU.
    const ImuState& far = result.result->state.imus[1];
    const Eigen::Vector3d in_far(0.3, -0.2, 0.5), in_reference = far.reference_from_imu * in_far;
    const Eigen::Vector4d read = Eigen::Matrix4d(rowsMatrix(imus["imu1"]["T_i_b"])) *
                                 Eigen::Vector3d(turns[0] * in_reference).homogeneous();
    QVERIFY((read.head<3>() - turns[1] * in_far).norm() < 1e-12);
    QCOMPARE(imus["imu1"]["time_offset"].as<double>(), far.time_offset_s);
    QCOMPARE(imus["imu0"]["update_rate"].as<double>(), 997.5);
    QCOMPARE(imus["imu0"]["accelerometer_random_walk"].as<double>(), 3e-4);
    QCOMPARE(imus["imu0"]["gyroscope_noise_density"].as<double>(), 1.5e-4);
    QVERIFY(exported.notes.empty());
  }

  // PyYAML reads 1e-05 as a string, OpenCV and ORB-SLAM3 read 0 as an integer.
  void numbers_haveDecimalPoints() {
    NamedResult result = rig({});
    test::ownResult(result).state.cameras[0].time_offset_s = 1e-5;
    const ExportedFiles exported = exportTo(result, "kalibr");
    QVERIFY(contentOf(exported, "kalibr/camchain-imucam.yaml").find("timeshift_cam_imu: 1.0e-05\n") !=
            std::string::npos);
  }

  void kalibr_thirdRadialCoefficient_isRefittedAndSaid() {
    RigKind kind;
    kind.third_radial = true;
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "kalibr");
    const LensFit fitted =
        fitLens(*result.result->state.cameras[0].lens.inUse(), CameraModel::PinholeRadtan, 4);
    QVERIFY(fitted.worst_px > 1e-6 && fitted.worst_px < 2.0);
    const YAML::Node imu = yamlOf(exported, "kalibr/imu.yaml")["imu0"],
                     camera = yamlOf(exported, "kalibr/camchain-imucam.yaml")["cam0"];
    QCOMPARE(camera["distortion_coeffs"].size(), 4U);
    const Eigen::Matrix3d turn = rowsMatrix(imu["accelerometers"]["M"]).inverse() *
                                 result.result->state.imus[0].accelerometer_scale_misalignment;
    const double worst_px =
        worstDifference_px(result, 0,
                           {rowsMatrix(camera["T_cam_imu"]), camera["timeshift_cam_imu"].as<double>(),
                            kalibrLens(camera), turn});
    QVERIFY(worst_px <= fitted.worst_px + kExportInertialSame_px);
    QCOMPARE(exported.notes.size(), 2U);  // one per camera
    QVERIFY(QString::fromStdString(exported.notes[0])
                .contains("left: Kalibr does not support radial-tangential distortion with k3"));
  }

  void openVins_reprojects() {
    const NamedResult result = rig({});
    const ExportedFiles exported = exportTo(result, "openvins");
    const std::string chain_text = contentOf(exported, "openvins/kalibr_imucam_chain.yaml");
    QVERIFY(cv::FileStorage(chain_text, cv::FileStorage::READ | cv::FileStorage::MEMORY).isOpened());
    const YAML::Node chain = yamlOf(exported, "openvins/kalibr_imucam_chain.yaml"),
                     imu = yamlOf(exported, "openvins/kalibr_imu_chain.yaml")["imu0"];
    for (std::size_t i = 0; i < 2; ++i) {
      const YAML::Node camera = chain[numbered("cam", static_cast<Eigen::Index>(i))];
      QVERIFY(worstDifference_px(result, i,
                                 {rowsMatrix(camera["T_cam_imu"]), camera["timeshift_cam_imu"].as<double>(),
                                  kalibrLens(camera)}) < kExportInertialSame_px);
    }
    QCOMPARE(imu["model"].as<std::string>(), std::string("rpng"));
    const ImuState& state = result.result->state.imus[0];
    const Eigen::Matrix3d tw = rowsMatrix(imu["Tw"]), ta = rowsMatrix(imu["Ta"]),
                          to_gyro = rowsMatrix(imu["R_IMUtoGYRO"]), to_acc = rowsMatrix(imu["R_IMUtoACC"]);
    // rpng uses the upper triangles of the inverses only.
    const Eigen::Matrix3d dw = Eigen::Matrix3d(tw.inverse()).triangularView<Eigen::Upper>(),
                          da = Eigen::Matrix3d(ta.inverse()).triangularView<Eigen::Upper>();
    QVERIFY(worstMeasured(state, [&](const Eigen::Vector3d& force, const Eigen::Vector3d& rate) {
              return Measured{da.inverse() * to_acc * force + state.accelerometer_bias_m_s2,
                              dw.inverse() * to_gyro * rate + state.gyroscope_bias_rad_s};
            }) < kExportInertialSame);
    const QString notes = QString::fromStdString(exported.notes[0] + exported.notes[1]);
    QVERIFY(notes.contains("only left imu is written") && notes.contains("differ by up to 9.401 ms"));
  }

  void vinsFusion_reprojects_data() {
    QTest::addColumn<bool>("fisheye");
    QTest::newRow("PINHOLE") << false;
    QTest::newRow("KANNALA_BRANDT") << true;
  }
  void vinsFusion_reprojects() {
    QFETCH(bool, fisheye);
    RigKind kind;
    kind.fisheye = fisheye;
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "vins-fusion");
    const cv::FileStorage vins(contentOf(exported, "vins-fusion/vins.yaml"),
                               cv::FileStorage::READ | cv::FileStorage::MEMORY);
    cv::Mat body_from_camera;
    vins["body_T_cam0"] >> body_from_camera;
    Eigen::Matrix4d reference_from_camera;
    for (int row = 0; row < 4; ++row)
      for (int col = 0; col < 4; ++col)
        reference_from_camera(row, col) = body_from_camera.at<double>(row, col);
    const cv::FileStorage camera(contentOf(exported, "vins-fusion/left.yaml"),
                                 cv::FileStorage::READ | cv::FileStorage::MEMORY);
    const auto read = [](const cv::FileNode& node, const std::vector<const char*>& keys) {
      std::vector<double> values;
      for (const char* key : keys) values.push_back(static_cast<double>(node[key]));
      return values;
    };
    const cv::FileNode k = camera["projection_parameters"];
    const Lens lens = fisheye
                          ? fisheyeLens(read(k, {"mu", "mv", "u0", "v0"}), read(k, {"k2", "k3", "k4", "k5"}))
                          : radtanLens(read(k, {"fx", "fy", "cx", "cy"}),
                                       read(camera["distortion_parameters"], {"k1", "k2", "p1", "p2"}));
    QCOMPARE(static_cast<std::string>(camera["model_type"]),
             std::string(fisheye ? "KANNALA_BRANDT" : "PINHOLE"));
    QVERIFY(worstDifference_px(result, 0,
                               {reference_from_camera.inverse(), static_cast<double>(vins["td"]), lens}) <
            kExportInertialSame_px);
    // Per sample; and without these keys the program finds no features, and solves nothing.
    const auto off = [&](const char* key, double value) {
      return std::abs(static_cast<double>(vins[key]) / value - 1.0);
    };
    QVERIFY(off("acc_n", 1.75e-3 * std::sqrt(997.5)) < 1e-6);
    for (const char* const key :
         {"max_cnt", "min_dist", "freq", "F_threshold", "max_solver_time", "max_num_iterations",
          "keyframe_parallax", "multiple_thread", "show_track", "flow_back", "imu", "num_of_cam"})
      QVERIFY2(vins[key].isReal() || vins[key].isInt(), key);
    for (const char* const key :
         {"output_path", "pose_graph_save_path", "imu_topic", "image0_topic", "cam0_calib"})
      QVERIFY2(vins[key].isString(), key);
    QVERIFY(QString::fromStdString(exported.notes.back())
                .contains("does not support scales and misalignment, which are up to 1.1 %"));
  }

  void orbSlam3_reprojects_data() { vinsFusion_reprojects_data(); }
  void orbSlam3_reprojects() {
    QFETCH(bool, fisheye);
    RigKind kind;
    kind.fisheye = fisheye;
    kind.third_radial = !fisheye;  // the format has a field for k3
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "orb-slam3");
    // ORB-SLAM3 itself rounds the matrices to float (dt: f): the text has more digits.
    const YAML::Node settings = yamlOf(exported, "orb-slam3/settings.yaml");
    const auto camera = [&](int number, const std::vector<const char*>& keys) {
      std::vector<double> values;
      for (const char* key : keys)
        values.push_back(settings[numbered("Camera", number, ".").append(key)].as<double>());
      return values;
    };
    const auto lens = [&](int number) {
      const auto k = camera(number, {"fx", "fy", "cx", "cy"});
      return fisheye ? fisheyeLens(k, camera(number, {"k1", "k2", "k3", "k4"}))
                     : radtanLens(k, camera(number, {"k1", "k2", "p1", "p2", "k3"}));
    };
    const Eigen::Matrix4d imu_from_first = dataMatrix(settings["IMU.T_b_c1"]);
    const Eigen::Matrix4d first_from_second = dataMatrix(settings["Stereo.T_c1_c2"]);
    const auto& cameras = result.result->state.cameras;
    // The comment and the note state by how much the stamps must be shifted.
    QVERIFY(QString::fromStdString(exported.notes.back()).contains("0.007301 s (left) -0.0021 s (right)"));
    QVERIFY(worstDifference_px(result, 0, {imu_from_first.inverse(), cameras[0].time_offset_s, lens(1)}) <
            kExportInertialSame_px);
    QVERIFY(worstDifference_px(result, 1,
                               {(imu_from_first * first_from_second).inverse(), cameras[1].time_offset_s,
                                lens(2)}) < kExportInertialSame_px);
    QCOMPARE(settings["IMU.Frequency"].as<double>(), 997.5);
    cv::FileStorage opened(contentOf(exported, "orb-slam3/settings.yaml"),
                           cv::FileStorage::READ | cv::FileStorage::MEMORY);
    QVERIFY(opened["Camera1.fx"].isReal() && opened["IMU.GyroWalk"].isReal());
    // Settings.cc: required keys and their types.
    for (const char* const key : {"Camera.fps", "Camera.RGB", "Camera.width", "Camera.height",
                                  "ORBextractor.nFeatures", "ORBextractor.nLevels", "ORBextractor.iniThFAST",
                                  "ORBextractor.minThFAST", "IMU.InsertKFsWhenLost"})
      QVERIFY2(opened[key].isInt(), key);
    for (const char* const key :
         {"ORBextractor.scaleFactor", "Viewer.KeyFrameSize", "Viewer.KeyFrameLineWidth",
          "Viewer.GraphLineWidth", "Viewer.PointSize", "Viewer.CameraSize", "Viewer.CameraLineWidth",
          "Viewer.ViewpointX", "Viewer.ViewpointY", "Viewer.ViewpointZ", "Viewer.ViewpointF",
          "Viewer.imageViewScale", "Stereo.ThDepth", "IMU.NoiseGyro", "IMU.NoiseAcc", "IMU.AccWalk",
          "IMU.Frequency"})
      QVERIFY2(opened[key].isReal(), key);
    const auto of_lens = [](const std::string& note) {
      return note.find("uses camera 1's distortion for camera 2") != std::string::npos;
    };
    QCOMPARE(std::count_if(exported.notes.begin(), exported.notes.end(), of_lens), 1);
  }

  void orbSlam3_withoutImu_countsTimeByTheFirstCamera() {
    RigKind kind;
    kind.inertial = false;
    const std::string settings = contentOf(exportTo(rig(kind), "orb-slam3"), "orb-slam3/settings.yaml");
    QVERIFY(settings.find("so that t_left = t_cam + offset") != std::string::npos);
    QVERIFY(settings.find("IMU.Frequency") == std::string::npos);
  }

  void basalt_reprojects() {
    RigKind kind;
    kind.fisheye = true;
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "basalt");
    const YAML::Node value = yamlOf(exported, "basalt/calibration.json")["value0"];
    const auto accelerometer = numbers(value["calib_accel_bias"]),
               gyroscope = numbers(value["calib_gyro_bias"]);
    QCOMPARE(accelerometer.size(), 9U);
    QCOMPARE(gyroscope.size(), 12U);
    Eigen::Matrix3d a = Eigen::Matrix3d::Identity(), g = Eigen::Matrix3d::Identity();
    a.col(0) += Eigen::Vector3d(accelerometer[3], accelerometer[4], accelerometer[5]);
    a(1, 1) += accelerometer[6];
    a(2, 1) += accelerometer[7];
    a(2, 2) += accelerometer[8];
    for (int i = 0; i < 9; ++i) g(i % 3, i / 3) += gyroscope[static_cast<std::size_t>(3 + i)];
    const Eigen::Vector3d a_bias(accelerometer.data()), g_bias(gyroscope.data());
    const ImuState& state = result.result->state.imus[0];
    const Eigen::Matrix3d turn = a * state.accelerometer_scale_misalignment;  // Basalt's IMU frame from ours
    QVERIFY(isRotationForExportInertial(turn));
    QVERIFY(worstMeasured(state, [&](const Eigen::Vector3d& force, const Eigen::Vector3d& rate) {
              return Measured{a.inverse() * (turn * force + a_bias), g.inverse() * (turn * rate + g_bias)};
            }) < kExportInertialSame);
    for (std::size_t i = 0; i < 2; ++i) {
      const YAML::Node p = value["T_imu_cam"][i], lens = value["intrinsics"][i]["intrinsics"];
      QCOMPARE(value["intrinsics"][i]["camera_type"].as<std::string>(), std::string("kb4"));
      const auto number = [](const YAML::Node& node, const char* key) { return node[key].as<double>(); };
      Eigen::Isometry3d reference_from_camera = Eigen::Isometry3d::Identity();
      reference_from_camera.linear() =
          Eigen::Quaterniond(number(p, "qw"), number(p, "qx"), number(p, "qy"), number(p, "qz"))
              .toRotationMatrix();
      reference_from_camera.translation() << number(p, "px"), number(p, "py"), number(p, "pz");
      const double offset_s =
          i == 0 ? 1e-9 * value["cam_time_offset_ns"].as<double>() : -0.0021;  // one for all cameras
      QVERIFY(
          worstDifference_px(
              result, i,
              {reference_from_camera.inverse().matrix(), offset_s,
               fisheyeLens({number(lens, "fx"), number(lens, "fy"), number(lens, "cx"), number(lens, "cy")},
                           {number(lens, "k1"), number(lens, "k2"), number(lens, "k3"), number(lens, "k4")}),
               turn}) < kExportInertialSame_px);
    }
  }

  // kb4 is not radtan: the lens is refitted within the stated error.
  void basalt_ofRadtan_isRefitted() {
    RigKind kind;
    kind.mapped = false;
    const NamedResult result = rig(kind);
    const LensFit fitted =
        fitLens(*result.result->state.cameras[0].lens.inUse(), CameraModel::PinholeEquidistant, 4);
    const ExportedFiles exported = exportTo(result, "basalt");
    const YAML::Node lens =
        yamlOf(exported, "basalt/calibration.json")["value0"]["intrinsics"][0]["intrinsics"];
    const auto number = [&](const char* key) { return lens[key].as<double>(); };
    const CameraState& camera = result.result->state.cameras[0];
    Eigen::Isometry3d reference_from_camera = Eigen::Isometry3d::Identity();
    reference_from_camera.linear() = camera.reference_from_camera.rotation.toRotationMatrix();
    reference_from_camera.translation() = camera.reference_from_camera.translation_m;
    const double worst_px =
        worstDifference_px(result, 0,
                           {reference_from_camera.inverse().matrix(), camera.time_offset_s,
                            fisheyeLens({number("fx"), number("fy"), number("cx"), number("cy")},
                                        {number("k1"), number("k2"), number("k3"), number("k4")})});
    QVERIFY(fitted.worst_px < 2.0);
    QVERIFY(worst_px <= fitted.worst_px + kExportInertialSame_px);
    const QString readme = QString::fromStdString(contentOf(exported, "basalt/README.txt"));
    QVERIFY(readme.contains("left: Basalt does not support radial-tangential distortion: refitted"));
  }

  // The program shifts images and uses events unchanged.
  void ultimateSlam_shiftsImagesOnly() {
    NamedResult result = rig({});
    result.cameras[1].kind = CameraKind::Frames;
    const ExportedFiles exported = exportTo(result, "ultimate-slam");
    const std::string flags = contentOf(exported, "ultimate-slam/imu.flags");
    QVERIFY2(flags.find(fmt::format("--timeshift_cam_imu={}\n",
                                    result.result->state.cameras[1].time_offset_s)) != std::string::npos,
             flags.c_str());
    result.cameras[0].kind = CameraKind::Frames;
    result.cameras[1].kind = CameraKind::Events;
    const YAML::Node calib = yamlOf(exportTo(result, "ultimate-slam"), "ultimate-slam/calib.yaml");
    QVERIFY(calib["cameras"][0]["camera"]["label"].as<std::string>() != "dvs");
    QCOMPARE(calib["cameras"][1]["camera"]["label"].as<std::string>(), std::string("dvs"));
  }

  void svoAndUltimateSlam_reproject() {
    const NamedResult result = rig({});
    for (const std::string target : {"svo", "ultimate-slam"}) {
      const ExportedFiles exported = exportTo(result, target);
      const YAML::Node calib = yamlOf(exported, target + "/calib.yaml");
      double offset_s = 0.0;
      if (target == "svo") {
        // svo_factory.cpp reads cameras, imu_params and imu_initialization from one calib_file.
        offset_s = -calib["imu_params"]["delay_imu_cam"].as<double>();
        QVERIFY(calib["imu_initialization"]["omega_bias"].IsSequence());
      } else {
        const std::string flags = contentOf(exported, "ultimate-slam/imu.flags");
        const auto flag = [&](const std::string& name) {
          const std::size_t at = flags.find("\n--" + name + "=");
          return at == std::string::npos ? 0.0 : std::stod(flags.substr(at + name.size() + 4));
        };
        QCOMPARE(flag("timeshift_cam_imu"), 0.0);  // of images, and there are no images
        offset_s = result.result->state.cameras[0].time_offset_s;
        const std::string notes = fmt::format("{}", fmt::join(exported.notes, "\n"));
        QVERIFY2(
            notes.find(fmt::format("add {} s to the time stamps of left", offset_s)) != std::string::npos,
            notes.c_str());
        QCOMPARE(flag("swe_imu_rate"), 997.5);
        QCOMPARE(flag("acc_noise_density"), 1.75e-3);
        QVERIFY(flag("vio_ceres_sigma_gyro_drift") > 0.0 && flag("vio_ceres_sigma_gyro_drift") < 1e-3);
        QVERIFY(flags.find("bias_random_walk") == std::string::npos);  // the sigma of a prior in that program
        QCOMPARE(flag("vio_gyr_bias_init_y"), -0.02);
        QCOMPARE(calib["cameras"][0]["camera"]["label"].as<std::string>(), std::string("dvs"));
      }
      const YAML::Node entry = calib["cameras"][0], camera = entry["camera"];
      QCOMPARE(camera["distortion"]["type"].as<std::string>(), std::string("radial-tangential"));
      const Eigen::Matrix4d reference_from_camera = dataMatrix(entry["T_B_C"]);
      QVERIFY(worstDifference_px(result, 0,
                                 {reference_from_camera.inverse(), offset_s,
                                  radtanLens(numbers(camera["intrinsics"]["data"]),
                                             numbers(camera["distortion"]["parameters"]["data"]))}) <
              kExportInertialSame_px);
    }
  }
};

EVICAL_TEST(TestExportInertial)
#include "tst_export_inertial.moc"
