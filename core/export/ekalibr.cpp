#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/export/rig.h"

#include <fmt/format.h>

namespace evical {
namespace {

constexpr KnownModels kEkalibrModels{"eKalibr", true, true, true};

// cereal marks the first appearance of a shared pointer or type with the highest bit.
constexpr unsigned kEkalibrFirst = 0x80000000U;

std::string key(const std::string& stream, const std::string& file_name) {
  return stringIn(Language::Yaml, stream.empty() ? "/" + file_name : stream);
}

std::string vectorText(const Eigen::VectorXd& values) {
  std::string text;
  for (Eigen::Index i = 0; i < values.size(); ++i)
    text += fmt::format("{}r{}c0: {}", i == 0 ? "" : ", ", i, real(values[i]));
  return "{" + text + "}";
}

std::string rotationText(const Eigen::Quaterniond& q) {
  return fmt::format("{{qx: {}, qy: {}, qz: {}, qw: {}}}", real(q.x()), real(q.y()), real(q.z()),
                     real(q.w()));
}

template <class Sensor, class Value>
std::string mapText(const char* name, const std::vector<Sensor>& sensors, Value&& value) {
  std::string text = fmt::format("    {}:{}\n", name, sensors.empty() ? " []" : "");
  for (const Sensor& sensor : sensors)
    text += fmt::format("      - key: {}\n        value: {}\n", key(sensor.stream, sensor.file_name),
                        value(sensor));
  return text;
}

// Order of radial-tangential coefficients: k1 k2 k3 t1 t2. Since the end of 2024 cameras without notes are
// refused.
std::string ekalibrCameraText(const CameraIntrinsics& camera, unsigned pointer_id,
                              const std::string& polymorphic, const std::string& blanks) {
  const auto& d = camera.distortion;
  const bool radtan = camera.model == CameraModel::PinholeRadtan;
  const std::vector<double> distortion =
      radtan ? std::vector<double>{d[0], d[1], d[4], d[2], d[3]} : distortionOf(camera, 4);
  return fmt::format(
      "{0}{1}\n{0}ptr_wrapper:\n{0}  id: {2}\n{0}  data:\n{0}    img_width: {3}\n{0}    img_height: {4}\n"
      "{0}    focal_length: [{5}, {6}]\n{0}    focal_length_note: \"fx, fy\"\n"
      "{0}    principal_point: [{7}, {8}]\n{0}    principal_point_note: \"cx, cy\"\n"
      "{0}    disto_param: [{9}]\n{0}    disto_param_note: \"{10}\"\n",
      blanks, polymorphic, kEkalibrFirst | pointer_id, camera.resolution_px.width_px,
      camera.resolution_px.height_px, real(camera.focal_length_px.x()), real(camera.focal_length_px.y()),
      real(camera.principal_point_px.x()), real(camera.principal_point_px.y()), realList(distortion),
      radtan ? "k1, k2, k3, t1, t2" : "k1, k2, k3, k4");
}

const char* polymorphicName(CameraModel model) {
  return model == CameraModel::PinholeRadtan ? "pinhole_brown_t2" : "pinhole_fisheye";
}

std::string firstOfType(unsigned type_id, CameraModel model, const std::string& blanks) {
  return fmt::format("polymorphic_id: {}\n{}polymorphic_name: {}", kEkalibrFirst | type_id, blanks,
                     polymorphicName(model));
}

// Upper triangle in eKalibr's order: diagonal first, then 01, 02, 12.
std::string sensorText(const char* name, const Eigen::Vector3d& bias, const Eigen::Matrix3d& m,
                       const std::string& blanks) {
  Eigen::Matrix<double, 6, 1> coefficients;
  coefficients << m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2);
  return fmt::format("{0}{1}:\n{0}  BIAS: {2}\n{0}  MAP_COEFF: {3}\n", blanks, name, vectorText(bias),
                     vectorText(coefficients));
}

std::string ekalibrImuText(const RigImu& imu, unsigned pointer_id) {
  const std::string blanks(14, ' ');
  const TriangularTimesRotation gyroscope = splitUpper(imu.state.gyroscopeMatrix());
  const bool mapped = hasMapping(imu.state);
  return fmt::format(
             "      - key: {}\n        value:\n          ptr_wrapper:\n            id: {}\n            "
             "data:\n",
             key(imu.stream, imu.file_name), kEkalibrFirst | pointer_id) +
         sensorText("ACCE", imu.state.accelerometer_bias_m_s2, imu.state.accelerometer_scale_misalignment,
                    blanks) +
         sensorText("GYRO", imu.state.gyroscope_bias_rad_s,
                    mapped ? gyroscope.triangular : Eigen::Matrix3d(Eigen::Matrix3d::Identity()), blanks) +
         fmt::format(
             "{}SO3_AtoG: {}\n", blanks,
             rotationText(mapped ? Eigen::Quaterniond(gyroscope.rotation) : Eigen::Quaterniond::Identity()));
}

std::string intrinsicsText(const Rig& rig) {
  std::string text = fmt::format("  INTRI:\n    IMU:{}\n", rig.imus.empty() ? " []" : "");
  unsigned pointer_id = 0, types = 0;
  for (const RigImu& imu : rig.imus) text += ekalibrImuText(imu, ++pointer_id);
  text += "    Camera:\n";
  std::vector<unsigned> type_ids(2, 0);  // by model; 0: not used yet
  for (const RigCamera& camera : rig.cameras) {
    const CameraModel model = camera.intrinsics.model;
    unsigned& type_id = type_ids[static_cast<std::size_t>(model)];
    const std::string blanks(10, ' ');
    const std::string polymorphic =
        type_id == 0 ? firstOfType(++types, model, blanks) : fmt::format("polymorphic_id: {}", type_id);
    if (type_id == 0) type_id = types;
    text += fmt::format("      - key: {}\n        value:\n", key(camera.stream, camera.file_name)) +
            ekalibrCameraText(camera.intrinsics, ++pointer_id, polymorphic, blanks);
  }
  return text;
}

std::string parameterFile(const Rig& rig) {
  const auto camera_rotation = [](const RigCamera& c) {
    return rotationText(c.reference_from_camera.rotation);
  };
  const auto camera_position = [](const RigCamera& c) {
    return vectorText(c.reference_from_camera.translation_m);
  };
  const auto camera_time = [](const RigCamera& c) { return real(c.time_offset_s); };
  const auto imu_rotation = [](const RigImu& i) { return rotationText(i.state.reference_from_imu.rotation); };
  const auto imu_position = [](const RigImu& i) {
    return vectorText(i.state.reference_from_imu.translation_m);
  };
  const auto imu_time = [](const RigImu& i) { return real(i.state.time_offset_s); };
  return headerComment(
             rig,
             {"eKalibr parameters. ...ToBr and ...InBr transform points of that sensor to the reference IMU; "
              "t_Br = t_sensor + TO.",
              "measured = MAP true + BIAS, MAP upper triangular. GRAVITY is in the board's frame."}) +
         fmt::format(
             "CalibParam:\n  Header:\n    Software: Evical\n    Version: {}\n    Address: \"\"\n  EXTRI:\n",
             stringIn(Language::Yaml, rig.program)) +
         mapText("SO3_BiToBr", rig.imus, imu_rotation) + mapText("POS_BiInBr", rig.imus, imu_position) +
         mapText("SO3_CjToBr", rig.cameras, camera_rotation) +
         mapText("POS_CjInBr", rig.cameras, camera_position) + "  TEMPORAL:\n" +
         mapText("TO_BiToBr", rig.imus, imu_time) + mapText("TO_CjToBr", rig.cameras, camera_time) +
         intrinsicsText(rig) + fmt::format("  GRAVITY: {}\n", vectorText(rig.gravity_m_s2));
}

}  // namespace

ExportedFiles exportEkalibr(const NamedResult& result) {
  ExportedFiles exported;
  Rig rig = rigOf(result);
  for (RigCamera& camera : rig.cameras) camera.intrinsics = cameraFor(camera, kEkalibrModels, exported.notes);
  exported.files.push_back({"ekalibr_param.yaml", parameterFile(rig)});
  for (const RigCamera& camera : rig.cameras)
    if (camera.intrinsics.model == CameraModel::PinholeEquidistant)
      exported.notes.push_back(fmt::format(
          "{}: eKalibr reads equidistant lenses in ekalibr_param.yaml, but does not accept them as input "
          "(PinholeIntrinsicBrownT2 only)",
          camera.name));
  for (const RigCamera& camera : rig.cameras)
    exported.files.push_back(
        {fmt::format("intrinsics-{}.yaml", camera.file_name),
         headerComment(
             rig,
             {"Intrinsics in the format of eKalibr's configuration. Distortion: k1 k2 k3 t1 t2, or fisheye "
              "k1..k4."}) +
             "Intrinsics:\n" +
             ekalibrCameraText(camera.intrinsics, 1, firstOfType(1, camera.intrinsics.model, "  "), "  ")});
  return exported;
}

}  // namespace evical
