// Files for Kimera-VIO, DM-VIO (DSO) and RTAB-Map, read key by key like in their parsers.
#include "core/base/error.h"
#include "core/geometry/camera_model.h"
#include "tests/core/export/exported_rig.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace {

using namespace evical;
using namespace evical::test;

constexpr double kExportSlamSame_px = 1e-9;

// MIT-SPARK/Kimera-VIO, include/kimera-vio/utils/YamlParser.h at decef91: a missing key ends the program, and
// so does a nested key of a non-map; values are read with OpenCV's >>, which leaves the target unchanged for
// another type.
class KimeraFile {
 public:
  explicit KimeraFile(const std::string& text)
      : file_(text, cv::FileStorage::READ | cv::FileStorage::MEMORY) {}

  template <class Value>
  Value get(const char* key) const {
    return read<Value>(file_[key], key);
  }
  template <class Value>
  Value nested(const char* key, const char* below) const {
    if (!file_[key].isMap()) throw std::runtime_error(std::string(key) + " is not a map");
    return read<Value>(file_[key][below], below);
  }
  bool isInt(const char* key) const { return file_[key].isInt(); }

 private:
  template <class Value>
  static Value read(const cv::FileNode& node, const char* key) {
    if (node.type() == cv::FileNode::NONE) throw std::runtime_error(std::string("Missing parameter: ") + key);
    Value value{};
    node >> value;
    return value;
  }

  cv::FileStorage file_;
};

// src/frontend/CameraParams.cpp at 2b79043; poseVectorToGtsamPose3 takes 16 numbers, row by row.
Eigen::Matrix4d kimeraPose(const KimeraFile& file) {
  return matrix(file.nested<std::vector<double>>("T_BS", "data"), 4, 4);
}

Lens kimeraLens(const KimeraFile& camera) {
  if (camera.get<std::string>("camera_id").empty()) throw std::runtime_error("Camera id cannot be empty");
  if (camera.get<std::string>("camera_model") != "pinhole") throw std::runtime_error("camera_model");
  if (camera.get<int>("rate_hz") <= 0) throw std::runtime_error("rate_hz");
  if (camera.get<std::vector<int>>("resolution") != std::vector<int>{346, 260})
    throw std::runtime_error("resolution");
  const auto intrinsics = camera.get<std::vector<double>>("intrinsics");
  const auto distortion = camera.get<std::vector<double>>("distortion_coefficients");
  if (intrinsics.size() != 4 || distortion.size() < 4) throw std::runtime_error("too few numbers");
  const auto model = camera.get<std::string>("distortion_model");
  if (model != "radtan" && model != "equidistant") throw std::runtime_error("Unrecognized distortion model");
  return model == "radtan" ? radtanLens(intrinsics, distortion) : fisheyeLens(intrinsics, distortion);
}

KimeraFile kimeraFile(const ExportedFiles& exported, const char* name) {
  return KimeraFile(contentOf(exported, std::string("kimera/") + name));
}

// DSO's Undistort::getUndistorterForFile and readFromFile: JakobEngel/dso, src/util/Undistort.cpp at 927edc6,
// which lukasvst/dm-vio has unchanged (src/dso/util/Undistort.cpp at fcc306b).
struct DsoCamera {
  Lens lens;
  int width_px = 0, height_px = 0;
  int out_width_px = 0, out_height_px = 0;
  Eigen::Vector2d out_focal_px, out_principal_px;  // of the rectified image

  Eigen::Vector3d rayOf(double x_px, double y_px) const {
    return {(x_px - out_principal_px.x()) / out_focal_px.x(),
            (y_px - out_principal_px.y()) / out_focal_px.y(), 1.0};
  }
};

DsoCamera dsoCamera(const std::string& text) {
  std::istringstream lines(text);
  std::string l1, l2, l3, l4;
  std::getline(lines, l1);
  std::getline(lines, l2);
  std::getline(lines, l3);
  std::getline(lines, l4);
  double p[8], out[5];
  // Without a name, eight numbers would be RadTan, five FOV or a pinhole.
  if (std::sscanf(l1.c_str(), "%lf", &p[0]) == 1) throw std::runtime_error("no model's name");
  const auto is = [&](const char* format) {
    return std::sscanf(l1.c_str(), format, &p[0], &p[1], &p[2], &p[3], &p[4], &p[5], &p[6], &p[7]) == 8;
  };
  const bool radtan = is("RadTan %lf %lf %lf %lf %lf %lf %lf %lf");
  if (!radtan && !is("EquiDistant %lf %lf %lf %lf %lf %lf %lf %lf"))
    throw std::runtime_error("could not read calib file! exit.");
  if (p[2] < 1 && p[3] < 1) throw std::runtime_error("would be taken for shares of the image's size");
  const std::vector<double> k{p[0], p[1], p[2], p[3]}, d{p[4], p[5], p[6], p[7]};
  DsoCamera camera;
  camera.lens = radtan ? radtanLens(k, d) : fisheyeLens(k, d);
  if (std::sscanf(l2.c_str(), "%d %d", &camera.width_px, &camera.height_px) != 2 ||
      std::sscanf(l3.c_str(), "%lf %lf %lf %lf %lf", &out[0], &out[1], &out[2], &out[3], &out[4]) != 5 ||
      std::sscanf(l4.c_str(), "%d %d", &camera.out_width_px, &camera.out_height_px) != 2)
    throw std::runtime_error("Failed to read");
  if (out[2] > 1 || out[3] > 1) throw std::runtime_error("needs to be relative to image width / height");
  camera.out_focal_px = {out[0] * camera.out_width_px, out[1] * camera.out_height_px};
  camera.out_principal_px = {out[2] * camera.out_width_px - 0.5, out[3] * camera.out_height_px - 0.5};
  return camera;
}

// Smallest distance of the outer pixels of the rectified image from the border of the camera's image, in px.
// Below 0: outside.
double minMargin_px(const DsoCamera& camera) {
  double min_px = 1e9;
  for (int y = 0; y < camera.out_height_px; ++y)
    for (int x = 0; x < camera.out_width_px; ++x) {
      if (y > 0 && y < camera.out_height_px - 1 && x > 0 && x < camera.out_width_px - 1) continue;
      const Eigen::Vector2d pixel = camera.lens(camera.rayOf(x, y));
      min_px = std::min({min_px, pixel.x(), pixel.y(), camera.width_px - 1.0 - pixel.x(),
                         camera.height_px - 1.0 - pixel.y()});
    }
  return min_px;
}

// introlab/rtabmap, corelib/src/CameraModel.cpp at 191e165, CameraModel::load.
struct RtabmapCamera {
  Lens lens;
  Eigen::Matrix<double, 3, 4> projection;
  Eigen::Matrix3d rectification;
  Eigen::Matrix4d base_from_camera;
};

class RtabmapFile {
 public:
  RtabmapFile(const ExportedFiles& exported, const std::string& path)
      : file_(contentOf(exported, "rtabmap/" + path), cv::FileStorage::READ | cv::FileStorage::MEMORY) {}

  // rows and cols are integers, data is a list of as many numbers: else UASSERT ends the program.
  Eigen::MatrixXd matrixAt(const char* key, int rows, int cols) const {
    const cv::FileNode node = file_[key];
    std::vector<double> data;
    node["data"] >> data;
    if (!node["rows"].isInt() || static_cast<int>(node["rows"]) != rows ||
        static_cast<int>(node["cols"]) != cols)
      throw std::runtime_error(std::string(key) + " has another shape");
    return matrix(data, rows, cols);
  }
  const cv::FileStorage& file() const { return file_; }

 private:
  cv::FileStorage file_;
};

RtabmapCamera rtabmapCamera(const ExportedFiles& exported, const std::string& folder,
                            const std::string& name) {
  const RtabmapFile read(exported, folder + name + ".yaml");
  if (static_cast<std::string>(read.file()["camera_name"]) != name ||
      static_cast<int>(read.file()["image_width"]) != 346 ||
      static_cast<int>(read.file()["image_height"]) != 260)
    throw std::runtime_error("name or size");
  const Eigen::Matrix3d k = read.matrixAt("camera_matrix", 3, 3);
  const int cols = static_cast<int>(read.file()["distortion_coefficients"]["cols"]);
  if (cols != 4 && cols != 5) throw std::runtime_error("distortion_coefficients");
  const Eigen::RowVectorXd d = read.matrixAt("distortion_coefficients", 1, cols);
  const std::vector<double> intrinsics{k(0, 0), k(1, 1), k(0, 2), k(1, 2)}, distortion(d.begin(), d.end());
  const bool fisheye =
      static_cast<std::string>(read.file()["distortion_model"]).find("equidistant") != std::string::npos;
  return {fisheye ? fisheyeLens(intrinsics, distortion) : radtanLens(intrinsics, distortion),
          read.matrixAt("projection_matrix", 3, 4), read.matrixAt("rectification_matrix", 3, 3),
          pose(read.matrixAt("local_transform", 3, 4))};
}

// corelib/src/Transform.cpp, Transform::fromString: 12 numbers with blanks between them, row by row.
Eigen::Matrix4d rtabmapTransform(const ExportedFiles& exported, const std::string& imu) {
  const std::string text = contentOf(exported, "rtabmap/imu_local_transform.txt");
  const std::size_t found = text.find(imu + ": ");
  if (found == std::string::npos) throw std::runtime_error("no " + imu);
  std::istringstream line(text.substr(found + imu.size() + 2));
  std::vector<double> numbers(12);
  for (double& number : numbers) line >> number;
  if (!line || line.get() != '\n') throw std::runtime_error("not twelve numbers");
  return pose(matrix(numbers, 3, 4));
}

}  // namespace

class TestExportSlam : public QObject {
  Q_OBJECT

 private slots:
  void kimera_reprojects_data() {
    QTest::addColumn<bool>("fisheye");
    QTest::newRow("radtan") << false;
    QTest::newRow("equidistant") << true;
  }
  void kimera_reprojects() {
    QFETCH(bool, fisheye);
    RigKind kind;
    kind.fisheye = fisheye;
    kind.third_radial = !fisheye;  // at 2b79043 five numbers go on to OpenCV
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "kimera");
    // src/imu-frontend/ImuFrontendParams.cpp at db6748d.
    const KimeraFile imu = kimeraFile(exported, "ImuParams.yaml");
    QVERIFY(imu.isInt("imu_preintegration_type"));
    QCOMPARE(imu.get<int>("imu_preintegration_type"), 1);
    QVERIFY(kimeraPose(imu) == Eigen::Matrix4d::Identity());  // else it ends: the IMU is the body
    QCOMPARE(imu.get<double>("rate_hz"), 997.5);
    QCOMPARE(imu.get<double>("gyroscope_noise_density"), 1.5e-4);
    QCOMPARE(imu.get<double>("accelerometer_noise_density"), 1.75e-3);
    QCOMPARE(imu.get<double>("gyroscope_random_walk"), 2e-5);
    QCOMPARE(imu.get<double>("accelerometer_random_walk"), 3e-4);
    QVERIFY(imu.get<double>("imu_integration_sigma") > 0.0);
    const auto gravity = imu.get<std::vector<double>>("n_gravity");
    QCOMPARE(gravity.size(), 3U);
    QVERIFY(gravity[0] == 0.0 && gravity[1] == 0.0);
    QVERIFY(std::abs(gravity[2] + result.result->state.gravity_in_world_m_s2.norm()) < 1e-12);
    // DataProviderModule.cpp at 980ff72 uses the IMU at the frame's stamp + shift.
    const double shift_s = imu.get<double>("imu_time_shift");
    const KimeraFile left = kimeraFile(exported, "LeftCameraParams.yaml"),
                     right = kimeraFile(exported, "RightCameraParams.yaml");
    QVERIFY(worstDifference_px(result, 0, {kimeraPose(left).inverse(), shift_s, kimeraLens(left)}) <
            kExportSlamSame_px);
    QVERIFY(worstDifference_px(result, 1, {kimeraPose(right).inverse(), -0.0021, kimeraLens(right)}) <
            kExportSlamSame_px);
    QVERIFY(left.isInt("rate_hz"));
    QVERIFY(hasNote(exported, "others differ by up to 9.401 ms"));
    QVERIFY(hasNote(exported, "does not support scales and misalignment"));
  }

  // Its StereoCamera ends if the baseline, with the right camera on the right, is below 0.
  void kimera_findsTheLeftCamera() {
    const NamedResult result = rig({});
    NamedResult swapped = result;
    std::swap(swapped.cameras[0], swapped.cameras[1]);
    CalibrationState& state = ownResult(swapped).state;
    std::swap(state.cameras[0], state.cameras[1]);
    for (const char* const name : {"kimera/LeftCameraParams.yaml", "kimera/ImuParams.yaml"})
      QVERIFY2(contentOf(exportTo(result, "kimera"), name) == contentOf(exportTo(swapped, "kimera"), name),
               name);
  }

  void kimera_ofCamerasAboveEachOther_isMono() {
    NamedResult result = rig({});
    CalibrationState& state = ownResult(result).state;
    state.cameras[1].reference_from_camera.translation_m =
        state.cameras[0].reference_from_camera * Eigen::Vector3d(0.0, 0.1, 0.0);
    const ExportedFiles exported = exportTo(result, "kimera");
    QVERIFY_THROWS_EXCEPTION(std::runtime_error, contentOf(exported, "kimera/RightCameraParams.yaml"));
    QVERIFY(hasNote(exported, "left and right are not side by side"));
    // Pipeline-definitions.cpp at 6b8ec96 reads the right camera's file if the front end is 1, StereoImu.
    QCOMPARE(kimeraFile(exported, "PipelineParams.yaml").get<int>("frontend_type"), 0);
    const KimeraFile of_a_pair = kimeraFile(exportTo(rig({}), "kimera"), "PipelineParams.yaml");
    for (const char* const key : {"frontend_type", "backend_type", "display_type", "parallel_run"})
      QVERIFY2(of_a_pair.isInt(key), key);
    QCOMPARE(of_a_pair.get<int>("frontend_type"), 1);
    QVERIFY(hasNote(exported, "right is left out"));
  }

  void dmVio_reprojects_data() { kimera_reprojects_data(); }
  void dmVio_reprojects() {
    QFETCH(bool, fisheye);
    RigKind kind;
    kind.fisheye = fisheye;
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "dm-vio");
    const DsoCamera camera = dsoCamera(contentOf(exported, "dm-vio/camera.txt"));
    QVERIFY(camera.width_px == 346 && camera.height_px == 260);
    // IMUCalibration::loadFromFile, src/IMU/IMUSettings.cpp at 432b7af: a list of lists below cam0.
    const YAML::Node chain = yamlOf(exported, "dm-vio/camchain.yaml")["cam0"]["T_cam_imu"];
    QVERIFY(chain.IsSequence() && chain.size() == 4 && chain[0].IsSequence());
    const double offset_s = result.result->state.cameras[0].time_offset_s;  // stated in a comment and a note
    QVERIFY(hasNote(exported, "0.007301 s (left)"));
    QVERIFY(worstDifference_px(result, 0, {rowsMatrix(chain), offset_s, camera.lens}) < kExportSlamSame_px);
    // SettingsUtil::tryReadFromYaml at fcc306b reads them at the top level.
    const YAML::Node noise = yamlOf(exported, "dm-vio/noise.yaml");
    QCOMPARE(noise["accelerometer_noise_density"].as<double>(), 1.75e-3);
    QCOMPARE(noise["gyroscope_noise_density"].as<double>(), 1.5e-4);
    QCOMPARE(noise["accelerometer_random_walk"].as<double>(), 3e-4);
    QCOMPARE(noise["gyroscope_random_walk"].as<double>(), 2e-5);
    QVERIFY(hasNote(exported, "right is left out"));
    // globalCalib.cpp: three halvings at least, of more than 5000 px.
    QVERIFY(camera.out_width_px % 16 == 0 && camera.out_height_px % 16 == 0);
    QVERIFY(camera.out_width_px > 346 - 16 && camera.out_height_px > 260 - 16);
    const double margin_px = minMargin_px(camera);
    QVERIFY2(margin_px > 0.0 && margin_px < 3.0, qPrintable(QString::number(margin_px)));
  }

  // DSO's "crop" would use rays far beyond the valid range, which the polynomial maps back into the image.
  void dmVio_ofALensThatFolds_staysInItsRange() {
    RigKind kind;
    kind.cameras = 1;
    NamedResult result = rig(kind);
    CameraIntrinsics& own = *ownResult(result).state.cameras[0].lens.detection_intrinsics;
    own.distortion = {-0.4, 0.05, 0.0, 0.0, 0.0};
    const DsoCamera camera = dsoCamera(contentOf(exportTo(result, "dm-vio"), "dm-vio/camera.txt"));
    const Eigen::Vector2d beyond = camera.lens({1.9, 0.0, 1.0});
    QVERIFY2(beyond.x() > 0.0 && beyond.x() < 345.0, "this lens does not fold");
    QVERIFY(minMargin_px(camera) > 0.0);
    for (const double x_px : {0.0, camera.out_width_px - 1.0})
      for (const double y_px : {0.0, camera.out_height_px - 1.0})
        QVERIFY(project(own, camera.rayOf(x_px, y_px)).has_value());
  }

  void dmVio_ofACameraAlone_isDsosCamera() {
    RigKind kind;
    kind.inertial = false;
    kind.cameras = 1;
    const ExportedFiles exported = exportTo(rig(kind), "dm-vio");
    QCOMPARE(exported.files.size(), 2U);  // and README.txt
    QCOMPARE(dsoCamera(contentOf(exported, "dm-vio/camera.txt")).width_px, 346);
  }

  void rtabmap_reprojects_data() { kimera_reprojects_data(); }
  void rtabmap_reprojects() {
    QFETCH(bool, fisheye);
    RigKind kind;
    kind.fisheye = fisheye;
    kind.third_radial = !fisheye;
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "rtabmap");
    const auto& cameras = result.result->state.cameras;
    const Eigen::Matrix4d base_from_imu = rtabmapTransform(exported, "left_imu");
    for (std::size_t i = 0; i < 2; ++i) {
      const RtabmapCamera camera = rtabmapCamera(exported, "", result.cameras[i].name);
      QVERIFY(worstDifference_px(result, i,
                                 {camera.base_from_camera.inverse() * base_from_imu, cameras[i].time_offset_s,
                                  camera.lens}) < kExportSlamSame_px);
      QVERIFY(camera.rectification == Eigen::Matrix3d::Identity());
    }
    QVERIFY(hasNote(exported, "0.007301 s (left) -0.0021 s (right)"));
    // CameraModel::opticalRotation, for which the program takes a camera without local_transform.
    const RtabmapCamera left = rtabmapCamera(exported, "stereo/", "stereo_left"),
                        right = rtabmapCamera(exported, "stereo/", "stereo_right");
    Eigen::Matrix3d optical;
    optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    Eigen::Matrix4d at_the_base = Eigen::Matrix4d::Identity();
    at_the_base.block(0, 0, 3, 3) = optical;
    QVERIFY((left.base_from_camera - at_the_base).norm() < 1e-12);
    // corelib/src/StereoCameraModel.cpp at 4d44b61: its R and T are cv::stereoRectify's, from left to right.
    const RtabmapFile pair(exported, "stereo/stereo_pose.yaml");
    Eigen::Matrix4d right_from_left = Eigen::Matrix4d::Identity();
    right_from_left.topLeftCorner<3, 3>() = pair.matrixAt("rotation_matrix", 3, 3);
    right_from_left.topRightCorner<3, 1>() = pair.matrixAt("translation_matrix", 3, 1);
    QVERIFY(worstDifference_px(result, 1,
                               {right_from_left * left.base_from_camera.inverse() * base_from_imu,
                                cameras[1].time_offset_s, right.lens}) < kExportSlamSame_px);
    const Eigen::Vector3d in_left(0.1, 0.2, 1.2),
        in_right = (right_from_left * in_left.homogeneous()).head<3>();
    QVERIFY(std::abs(in_right.dot(pair.matrixAt("essential_matrix", 3, 3) * in_left)) < 1e-12);
    QVERIFY(pair.matrixAt("fundamental_matrix", 3, 3).norm() > 0.0);
    // baseline() is -P(0,3) / P(0,0) of the right camera; rectified, a point is in one row.
    const double baseline_m = pair.matrixAt("translation_matrix", 3, 1).norm();
    QVERIFY(std::abs(-right.projection(0, 3) / right.projection(0, 0) - baseline_m) < 1e-12);
    const Eigen::Vector3d level = left.rectification * in_left;
    const Eigen::Vector2d a = (left.projection * level.homogeneous()).hnormalized();
    const Eigen::Vector2d b = (right.projection * level.homogeneous()).hnormalized();
    const Eigen::Vector2d direct =
        (right.projection.leftCols<3>() * (right.rectification * in_right)).hnormalized();
    QVERIFY(std::abs(a.y() - b.y()) < kExportSlamSame_px && (b - direct).norm() < kExportSlamSame_px);
  }

  void rtabmap_imusHaveTheirOwnTransform() {
    const NamedResult result = rig({});
    const ExportedFiles exported = exportTo(result, "rtabmap");
    const RigidTransform& far = result.result->state.imus[1].reference_from_imu;
    const Eigen::Vector3d in_far(0.3, -0.2, 0.5);
    const Eigen::Vector4d by_far = rtabmapTransform(exported, "far_imu") * in_far.homogeneous();
    const Eigen::Vector4d by_reference =
        rtabmapTransform(exported, "left_imu") * Eigen::Vector3d(far * in_far).homogeneous();
    QVERIFY((by_far - by_reference).norm() < 1e-12);
  }

  // A file of the pair must not overwrite a camera's.
  void rtabmap_aCameraMayBeCalledAsTheProgramsPair() {
    NamedResult result = rig({});
    result.cameras[0].name = "stereo_left";
    const ExportedFiles exported = exportTo(result, "rtabmap");
    const RtabmapCamera own = rtabmapCamera(exported, "", "stereo_left"),
                        of_pair = rtabmapCamera(exported, "stereo/", "stereo_left");
    QVERIFY(own.rectification == Eigen::Matrix3d::Identity());
    QVERIFY(of_pair.rectification != Eigen::Matrix3d::Identity());
  }
};

EVICAL_TEST(TestExportSlam)
#include "tst_export_slam.moc"
