// Exported files in other programs' own loaders, and in the libraries that those use, if Debian has them as a
// package: the results of our readers (core/report/export/read_back) for the same files must be correct.
#include "core/export/read_back.h"
#include "tests/core/export/exported_rig.h"
#include "tests/support/test_program.h"

#include <QFile>
#include <QProcess>
#include <QTemporaryDir>

#include <cmath>

#if __has_include(<boost/property_tree/json_parser.hpp>)
#define BOOST_BIND_GLOBAL_PLACEHOLDERS  // boost's own header needs them
#include <boost/property_tree/json_parser.hpp>
#define EVICAL_BOOST_TREE
#endif
#if __has_include(<cereal/archives/json.hpp>)
#include <cereal/archives/json.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#define EVICAL_CEREAL
#endif
#ifdef EVICAL_GFLAGS
#include <gflags/gflags.h>

DEFINE_double(timeshift_cam_imu, 0.0, "");
DEFINE_double(swe_imu_rate, 0.0, "");
DEFINE_double(gyro_noise_density, 0.0, "");
DEFINE_double(acc_noise_density, 0.0, "");
DEFINE_double(vio_ceres_sigma_gyro_drift, 0.0, "");
DEFINE_double(vio_ceres_sigma_accel_drift, 0.0, "");
DEFINE_double(vio_ceres_gravity, 0.0, "");
DEFINE_double(vio_acc_bias_init_x, 0.0, "");
DEFINE_double(vio_acc_bias_init_y, 0.0, "");
DEFINE_double(vio_acc_bias_init_z, 0.0, "");
DEFINE_double(vio_gyr_bias_init_x, 0.0, "");
DEFINE_double(vio_gyr_bias_init_y, 0.0, "");
DEFINE_double(vio_gyr_bias_init_z, 0.0, "");
#endif

using namespace evical;
using namespace evical::test;

namespace {

// The rig's files of one target, on disk, and our reader's result for them.
struct OnDisk {
  explicit OnDisk(const std::string& target) {
    const NamedResult result = rig({});
    writeExportedFiles(folder.path().toStdString(),
                       exportResult(result, std::vector<std::string>{target}).files);
    read = exportTarget(target, "test").read(std::filesystem::path(folder.path().toStdString()) / target);
  }
  QTemporaryDir folder;
  ReadBack read;
};

struct Ran {
  bool started = false;
  int code = -1;
  QString output;
};
Ran run(const QString& program, const QStringList& arguments) {
  QProcess process;
  process.setProcessChannelMode(QProcess::MergedChannels);
  process.start(program, arguments);
  if (!process.waitForStarted()) return {};
  process.waitForFinished();
  return {true, process.exitCode(), QString::fromUtf8(process.readAll())};
}

// Debian's own, in which Debian's modules are.
Ran runPython(const QString& script, const QStringList& arguments) {
  return run("/usr/bin/python3", QStringList{"-c", script} + arguments);
}
bool hasModule(const char* module) {
  const Ran ran = runPython(QString("import ") + module, {});
  return ran.started && ran.code == 0;
}

}  // namespace

#ifdef EVICAL_CEREAL
// Structures with the names of basalt-headers' headers_serialization.h.
namespace {

struct BasaltPose {
  double px = 0.0, py = 0.0, pz = 0.0, qx = 0.0, qy = 0.0, qz = 0.0, qw = 0.0;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(CEREAL_NVP(px), CEREAL_NVP(py), CEREAL_NVP(pz), CEREAL_NVP(qx), CEREAL_NVP(qy), CEREAL_NVP(qz),
            CEREAL_NVP(qw));
  }
};
struct BasaltKb4 {
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0, k1 = 0.0, k2 = 0.0, k3 = 0.0, k4 = 0.0;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(CEREAL_NVP(fx), CEREAL_NVP(fy), CEREAL_NVP(cx), CEREAL_NVP(cy), CEREAL_NVP(k1), CEREAL_NVP(k2),
            CEREAL_NVP(k3), CEREAL_NVP(k4));
  }
};
struct BasaltCamera {
  std::string camera_type;
  BasaltKb4 intrinsics;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(CEREAL_NVP(camera_type), CEREAL_NVP(intrinsics));
  }
};
struct BasaltCalibration {
  std::vector<BasaltPose> T_imu_cam;
  std::vector<BasaltCamera> intrinsics;
  std::vector<std::vector<int>> resolution;
  std::vector<double> calib_accel_bias, calib_gyro_bias, accel_noise_std, gyro_noise_std, accel_bias_std,
      gyro_bias_std;
  double imu_update_rate = 0.0;
  std::int64_t cam_time_offset_ns = 0;
  std::vector<double> vignette;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(CEREAL_NVP(T_imu_cam), CEREAL_NVP(intrinsics), CEREAL_NVP(resolution),
            CEREAL_NVP(calib_accel_bias), CEREAL_NVP(calib_gyro_bias), CEREAL_NVP(imu_update_rate),
            CEREAL_NVP(accel_noise_std), CEREAL_NVP(gyro_noise_std), CEREAL_NVP(accel_bias_std),
            CEREAL_NVP(gyro_bias_std), CEREAL_NVP(cam_time_offset_ns), CEREAL_NVP(vignette));
  }
};

}  // namespace
#endif

class TestExportLoaders : public QObject {
  Q_OBJECT

 private slots:
  // Debian's camera_calibration_parsers: image_common 1.12, as of ROS 1.
  void cameraInfo_isTakenByRos() {
    if (!hasModule("camera_calibration_parsers"))
      QSKIP("python3-camera-calibration-parsers is not installed");
    const OnDisk ros("ros");
    for (const ReadFile& file : ros.read.files) {
      if (file.path.extension() != ".yaml") continue;
      const Ran ran = runPython(
          "import sys, camera_calibration_parsers as parsers\n"
          "name, info = parsers.readCalibration(sys.argv[1])\n"
          "print(name, info.width, info.height, info.distortion_model, *map(repr, list(info.K) + "
          "list(info.D)))",
          {QString::fromStdString(file.path.string())});
      QVERIFY2(ran.code == 0, qPrintable(ran.output));
      const QStringList words = ran.output.trimmed().split('\n').last().split(' ');
      QCOMPARE(words.size(), 4 + 9 + 5);
      const evical::ReadCamera& camera = file.cameras.front();
      const CameraIntrinsics& lens = camera.lens.value();
      QCOMPARE(words.mid(0, 4),
               (QStringList{QString::fromStdString(camera.name), QString::number(lens.resolution_px.width_px),
                            QString::number(lens.resolution_px.height_px), "plumb_bob"}));
      const auto number = [&](qsizetype i) { return words.at(4 + i).toDouble(); };
      QCOMPARE(number(0), lens.focal_length_px.x());
      QCOMPARE(number(4), lens.focal_length_px.y());
      QCOMPARE(number(2), lens.principal_point_px.x());
      QCOMPARE(number(5), lens.principal_point_px.y());
      for (std::size_t k = 0; k < 5; ++k) QCOMPARE(number(9 + static_cast<qsizetype>(k)), lens.distortion[k]);
    }
  }

  // Debian's urdfdom 3.0.1.
  void urdf_isTakenByUrdfdom() {
    const OnDisk ros("ros");
    const Ran ran = run("check_urdf", {ros.folder.filePath("ros/rig.urdf")});
    if (!ran.started) QSKIP("liburdfdom-tools is not installed");
    QVERIFY2(ran.code == 0 && ran.output.contains("Successfully Parsed XML"), qPrintable(ran.output));
    QVERIFY2(ran.output.contains("root Link: left_imu has 3 child(ren)"), qPrintable(ran.output));
    for (const char* const frame : {"left_optical_frame", "right_optical_frame", "far_imu"})
      QVERIFY2(ran.output.contains(frame), qPrintable(ran.output));
  }

  // Types that Kalibr's ConfigReader.py requires from PyYAML: floats must be floats, and ints must be ints.
  void kalibrFiles_haveTheTypesOfPyYaml() {
    if (!hasModule("yaml")) QSKIP("python3-yaml is not installed");
    const OnDisk kalibr("kalibr");
    const Ran ran = runPython(
        "import sys, yaml\n"
        "load = lambda name: yaml.safe_load(open(sys.argv[1] + name))\n"
        "chain, imus = load('/camchain-imucam.yaml'), load('/imu.yaml')\n"
        "for name, camera in chain.items():\n"
        "  assert all(isinstance(x, float) for x in camera['intrinsics'] + camera['distortion_coeffs']), "
        "name\n"
        "  assert all(isinstance(x, int) for x in camera['resolution'] + camera['cam_overlaps']), name\n"
        "  assert isinstance(camera['timeshift_cam_imu'], float) and isinstance(camera['rostopic'], str), "
        "name\n"
        "  assert all(isinstance(x, float) for row in camera['T_cam_imu'] for x in row), name\n"
        "for name in ('imu0', 'imu1'):\n"
        "  assert isinstance(imus[name]['time_offset'], float) and imus[name]['update_rate'] > 0.0, name\n"
        "print(len(chain), repr(chain['cam0']['timeshift_cam_imu']), repr(chain['cam1']['intrinsics'][0]))",
        {kalibr.folder.filePath("kalibr")});
    QVERIFY2(ran.code == 0, qPrintable(ran.output));
    const QStringList words = ran.output.trimmed().split(' ');
    const std::vector<evical::ReadCamera>& cameras = kalibr.read.files.at(1).cameras;
    QCOMPARE(words.at(0).toULongLong(), cameras.size());
    QCOMPARE(words.at(1).toDouble(), cameras.at(0).time_offset_s.value());
    QCOMPARE(words.at(2).toDouble(), cameras.at(1).lens.value().focal_length_px.x());
  }

  // boost::property_tree, with which dv-processing parses calibrations.
  void dvCalibration_isTakenByBoost() {
#ifdef EVICAL_BOOST_TREE
    const OnDisk dv("dv-processing");
    boost::property_tree::ptree tree;
    boost::property_tree::read_json(dv.folder.filePath("dv-processing/calibration.json").toStdString(), tree);
    QCOMPARE(tree.get_child("version").get_value<float>(), 2.0F);
    const auto floats = [&](const std::string& path) {
      std::vector<float> values;
      for (const auto& cell : tree.get_child(path)) values.push_back(cell.second.get_value<float>());
      return values;
    };
    const ReadFile& read = dv.read.files.front();
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string camera = numbered("cameras.C", static_cast<Eigen::Index>(i), ".");
      const CameraIntrinsics& lens = read.cameras.at(i).lens.value();
      QCOMPARE(static_cast<double>(floats(camera + "focalLength").at(0)), lens.focal_length_px.x());
      const std::vector<float> distortion = floats(camera + "distortionCoefficients");
      for (std::size_t k = 0; k < distortion.size(); ++k)
        QCOMPARE(static_cast<double>(distortion[k]), lens.distortion[k]);
      QCOMPARE(floats(camera + "transformationToC0").size(), 16U);
      QCOMPARE(tree.get_child(camera + "master").get_value<bool>(), i == 0);
      QVERIFY(!tree.get_child_optional(camera + "metadata"));
    }
    QCOMPARE(1e-6 * static_cast<double>(tree.get_child("imus.S0.timeOffsetMicros").get_value<std::int64_t>()),
             read.cameras.at(0).time_offset_s.value());
    QCOMPARE(static_cast<double>(tree.get_child("imus.S0.accNoiseDensity").get_value<float>()),
             read.imus.at(0).noise.value().accelerometer_density);
#else
    QSKIP("libboost-dev is not installed");
#endif
  }

  // cereal, with which Basalt parses calibrations.
  void basaltCalibration_isTakenByCereal() {
#ifdef EVICAL_CEREAL
    const OnDisk basalt("basalt");
    std::ifstream stream(basalt.folder.filePath("basalt/calibration.json").toStdString());
    BasaltCalibration calibration;
    cereal::JSONInputArchive archive(stream);
    archive(calibration);
    const ReadFile& read = basalt.read.files.front();
    QCOMPARE(calibration.T_imu_cam.size(), read.cameras.size());
    for (std::size_t i = 0; i < read.cameras.size(); ++i) {
      const CameraIntrinsics& lens = read.cameras[i].lens.value();
      const BasaltKb4& theirs = calibration.intrinsics.at(i).intrinsics;
      QCOMPARE(calibration.intrinsics[i].camera_type, std::string("kb4"));
      QCOMPARE(theirs.fx, lens.focal_length_px.x());
      QCOMPARE(theirs.k4, lens.distortion[3]);
      QCOMPARE(calibration.T_imu_cam[i].qw, read.cameras[i].frame_from_camera.value().rotation.w());
      QCOMPARE(calibration.resolution.at(i), (std::vector<int>{346, 260}));
    }
    QCOMPARE(calibration.calib_accel_bias.size(), 9U);
    QCOMPARE(calibration.calib_gyro_bias.size(), 12U);
    for (const auto* const three : {&calibration.accel_noise_std, &calibration.gyro_noise_std,
                                    &calibration.accel_bias_std, &calibration.gyro_bias_std})
      QCOMPARE(three->size(), 3U);
    QCOMPARE(calibration.imu_update_rate, 997.5);
    QCOMPARE(1e-9 * static_cast<double>(calibration.cam_time_offset_ns),
             read.cameras[0].time_offset_s.value());
#else
    QSKIP("libcereal-dev is not installed");
#endif
  }

  // gflags, which ends the program at an unknown flag.
  void flags_areTakenByGflags() {
#ifdef EVICAL_GFLAGS
    const OnDisk slam("ultimate-slam");
    QVERIFY(gflags::ReadFromFlagsFile(slam.folder.filePath("ultimate-slam/imu.flags").toStdString(), "slam",
                                      false));
    const ReadFile& read = slam.read.files.back();
    QVERIFY(FLAGS_timeshift_cam_imu == 0.0 && read.cameras.empty());  // it shifts images; there are none
    QCOMPARE(FLAGS_swe_imu_rate, read.imus.at(0).rate_hz.value());
    QCOMPARE(FLAGS_gyro_noise_density, read.imus[0].noise.value().gyroscope_density);
    QCOMPARE(FLAGS_acc_noise_density, read.imus[0].noise.value().accelerometer_density);
    QCOMPARE(FLAGS_vio_ceres_sigma_gyro_drift, read.imus[0].noise.value().gyroscope_random_walk);
    QCOMPARE(FLAGS_vio_ceres_sigma_accel_drift, read.imus[0].noise.value().accelerometer_random_walk);
    QCOMPARE(FLAGS_vio_ceres_gravity, read.gravity_m_s2.value());
    QCOMPARE(Eigen::Vector3d(FLAGS_vio_acc_bias_init_x, FLAGS_vio_acc_bias_init_y, FLAGS_vio_acc_bias_init_z),
             read.imus[0].accelerometer_bias_m_s2.value());
    QCOMPARE(Eigen::Vector3d(FLAGS_vio_gyr_bias_init_x, FLAGS_vio_gyr_bias_init_y, FLAGS_vio_gyr_bias_init_z),
             read.imus[0].gyroscope_bias_rad_s.value());
#else
    QSKIP("libgflags-dev is not installed");
#endif
  }
};

EVICAL_TEST(TestExportLoaders)
#include "tst_export_loaders.moc"
