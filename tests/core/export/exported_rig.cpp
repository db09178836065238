#include "tests/core/export/exported_rig.h"

#include "core/geometry/so3.h"

#include "core/geometry/camera_model.h"

#include <Eigen/LU>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace evical::test {
namespace {

RigidTransform worldFromImu(double time_s) {
  return {quaternionExp({0.8 * std::sin(1.1 * time_s), 0.5 * std::cos(1.7 * time_s), 0.3 * time_s}),
          {0.3 * std::sin(2.0 * time_s), 0.2 * std::cos(3.0 * time_s), 0.1 * time_s}};
}

CameraIntrinsics intrinsics(const RigKind& kind, int camera) {
  CameraIntrinsics own;
  own.resolution_px = {346, 260};
  own.focal_length_px = {261.0 + 1.0 / 3.0, 259.5 + camera};
  own.principal_point_px = {171.25 - camera, 131.125};
  if (kind.fisheye) {
    own.model = CameraModel::PinholeEquidistant;
    own.distortion = {-0.03, 0.011, -0.004, 0.0007, 0.0};
  } else {
    own.distortion = {-0.31, 0.12, 1.1e-3, -7e-4, kind.third_radial ? -0.02 : 0.0};
  }
  return own;
}

ImuState imu(bool mapped, int number) {
  ImuState state;
  if (number == 1) {
    state.reference_from_imu = {quaternionExp({0.02, 1.3, -0.4}), {0.05, -0.02, 0.11}};
    state.time_offset_s = 0.000731;
  }
  state.gyroscope_bias_rad_s = {0.01, -0.02, 1.0 / 70.0};
  state.accelerometer_bias_m_s2 = {0.11, 0.2, -0.3};
  if (!mapped) return state;
  state.accelerometer_scale_misalignment << 1.011, 0.004, -0.003, 0.0, 0.992, 0.005, 0.0, 0.0, 1.003;
  state.gyroscope_scale_misalignment << 0.997, -0.002, 0.006, 0.0, 1.004, 0.003, 0.0, 0.0, 0.991;
  state.gyroscope_from_accelerometer = quaternionExp({0.011, -0.006, 0.009});
  return state;
}

cv::Mat matrixK(const std::vector<double>& k) {
  return (cv::Mat_<double>(3, 3) << k[0], 0.0, k[2], 0.0, k[1], k[3], 0.0, 0.0, 1.0);
}

}  // namespace

NamedResult rig(const RigKind& kind) {
  NamedResult named;
  CalibrationResult result;
  named.reference = kind.inertial ? "left imu" : "left";
  named.version = "0.1.0";
  const char* const names[] = {"left", "right", "third"};
  for (int i = 0; i < kind.cameras + kind.frames; ++i) {
    const bool events = i < kind.cameras;
    const std::string name = events ? names[i] : numbered("frame", i - kind.cameras);
    named.cameras.push_back({name, "/" + name + (events ? "/events" : "/image")});
    if (!events) named.cameras.back().kind = CameraKind::Frames;
    CameraState camera;
    camera.lens = givenLens(intrinsics(kind, i));
    camera.reference_from_camera = {quaternionExp({1.1 + 0.01 * i, -0.7 + 0.02 * i, 0.6}),
                                    {0.03, -0.01, 0.02}};
    camera.reference_from_camera.translation_m +=
        camera.reference_from_camera.rotation * Eigen::Vector3d(0.1 * i, 0.002 * i, 0.0);
    if (!events) camera.reference_from_camera.translation_m.z() += 0.013;
    camera.time_offset_s = i == 0 ? 0.007301 : -0.0021;
    result.state.cameras.push_back(camera);
    CameraFit fit;
    fit.reprojection_rms_px = 0.125;
    fit.windows_used = 300;
    result.cameras.push_back(fit);
  }
  for (int i = 0; kind.inertial && i < 2; ++i) {
    named.imus.push_back({i == 0 ? "left imu" : "far_imu",
                          i == 0 ? "/left/imu" : "/far/imu",
                          {1.5e-4, 1.75e-3, 2e-5, 3e-4},
                          997.5});
    result.state.imus.push_back(imu(kind.mapped, i));
    result.imus.push_back({0.002, 0.05});
  }
  result.state.gravity_in_world_m_s2 = {0.1, 9.7, 1.4};
  named.result = std::make_shared<const CalibrationResult>(std::move(result));
  return named;
}

Lens radtanLens(const std::vector<double>& k, const std::vector<double>& distortion) {
  return [k, distortion](const Eigen::Vector3d& point) {
    std::vector<cv::Point2d> pixels;
    cv::projectPoints(std::vector<cv::Point3d>{{point.x(), point.y(), point.z()}}, cv::Vec3d(), cv::Vec3d(),
                      matrixK(k), distortion, pixels);
    return Eigen::Vector2d(pixels[0].x, pixels[0].y);
  };
}

Lens fisheyeLens(const std::vector<double>& k, const std::vector<double>& distortion) {
  return [k, distortion](const Eigen::Vector3d& point) {
    std::vector<cv::Point2d> pixels;
    cv::fisheye::projectPoints(std::vector<cv::Point3d>{{point.x(), point.y(), point.z()}}, pixels,
                               cv::Vec3d(), cv::Vec3d(), matrixK(k), distortion);
    return Eigen::Vector2d(pixels[0].x, pixels[0].y);
  };
}

double worstDifference_px(const NamedResult& result, std::size_t camera, const ReadCamera& theirs) {
  const CameraState& ours = result.result->state.cameras.at(camera);
  const CameraIntrinsics own = ours.lens.inUse().value();
  double worst_px = 0.0;
  for (const double camera_time_s : {1.3, 2.9})
    for (int row = 0; row < 5; ++row)
      for (int col = 0; col < 5; ++col) {
        const Eigen::Vector2d pixel(345.0 * col / 4.0, 259.0 * row / 4.0);
        const auto ray = unproject(own, pixel);
        if (!ray) return std::numeric_limits<double>::infinity();
        const Eigen::Vector3d in_camera = 0.8 * ray->homogeneous();
        const Eigen::Vector3d in_world =
            worldFromImu(camera_time_s + ours.time_offset_s) * (ours.reference_from_camera * in_camera);
        const Eigen::Vector3d in_imu =
            theirs.their_imu_from_ours *
            (inverse(worldFromImu(camera_time_s + theirs.time_offset_s)) * in_world);
        const Eigen::Vector3d in_theirs = (theirs.camera_from_imu * in_imu.homogeneous()).head<3>();
        worst_px = std::max(worst_px, (theirs.lens(in_theirs) - *project(own, in_camera)).norm());
      }
  return worst_px;
}

ExportedFiles exportTo(const NamedResult& result, const std::string& target) {
  return exportResult(result, std::vector<std::string>{target});
}

bool hasNote(const ExportedFiles& exported, const char* part) {
  return std::any_of(exported.notes.begin(), exported.notes.end(),
                     [&](const std::string& note) { return note.find(part) != note.npos; });
}

std::string contentOf(const ExportedFiles& exported, const std::string& path) {
  for (const FileContent& file : exported.files)
    if (file.path == path) return file.content;
  throw std::runtime_error("there is no " + path);
}

YAML::Node yamlOf(const ExportedFiles& exported, const std::string& path) {
  std::string text = contentOf(exported, path);
  if (text.rfind("%YAML:1.0", 0) == 0) text.erase(0, text.find('\n') + 1);
  return YAML::Load(text);
}

std::string numbered(const char* prefix, Eigen::Index number, const char* suffix) {
  std::string text = prefix;
  return text.append(std::to_string(number)).append(suffix);
}

std::vector<double> numbers(const YAML::Node& list) {
  std::vector<double> values;
  for (const YAML::Node& item : list) values.push_back(item.as<double>());
  return values;
}

Eigen::MatrixXd matrix(const std::vector<double>& row_major, int rows, int cols) {
  if (row_major.size() != static_cast<std::size_t>(rows * cols))
    throw std::runtime_error("wrong size of a matrix");
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      row_major.data(), rows, cols);
}

Eigen::MatrixXd rowsMatrix(const YAML::Node& rows) {
  std::vector<double> all;
  for (const YAML::Node& row : rows)
    for (const double value : numbers(row)) all.push_back(value);
  const int count = static_cast<int>(rows.size());
  return matrix(all, count, static_cast<int>(all.size()) / count);
}

Eigen::MatrixXd dataMatrix(const YAML::Node& map) {
  return matrix(numbers(map["data"]), map["rows"].as<int>(), map["cols"].as<int>());
}

Eigen::Matrix4d pose(const Eigen::MatrixXd& rows) {
  Eigen::Matrix4d full = Eigen::Matrix4d::Identity();
  full.topRows(rows.rows()) = rows;
  return full;
}

}  // namespace evical::test
