#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/export/stereo.h"

#include <fmt/format.h>

#include <cmath>

namespace evical {
namespace {

constexpr const char* kDvProcessingProgram = "dv-processing";
constexpr KnownModels kDvProcessingModels{kDvProcessingProgram, true, true, true};

// boost::property_tree writes every scalar as a string.
std::string quoted(double value) {
  return stringIn(Language::Json, real(value));
}

std::string quotedList(const Eigen::MatrixXd& matrix) {
  std::string text;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    for (Eigen::Index col = 0; col < matrix.cols(); ++col)
      text += (text.empty() ? "" : ", ") + quoted(matrix(row, col));
  return "[" + text + "]";
}

std::string field(const char* key, const std::string& value, int indent) {
  return fmt::format("{:{}}\"{}\": {},\n", "", indent, key, value);
}

// The program reads it for IMUs; for cameras it would require the pattern, and is optional.
std::string metadata(const std::string& comment) {
  return fmt::format("      \"metadata\": {{\"calibrationTime\": \"\", \"comment\": {}}}\n    }}",
                     stringIn(Language::Json, comment));
}

std::string lastField(const char* key, const std::string& value) {
  return fmt::format("      \"{}\": {}\n    }}", key, value);
}

std::string dvProcessingCameraText(const Rig& rig, std::size_t i, ExportNotes& notes) {
  const RigCamera& camera = rig.cameras[i];
  const CameraIntrinsics own = cameraFor(camera, kDvProcessingModels, notes);
  const bool radtan = own.model == CameraModel::PinholeRadtan;
  const std::vector<double> d = distortionOf(own, radtan && own.distortion[4] != 0.0 ? 5 : 4);
  const RigidTransform this_from_first =
      inverse(camera.reference_from_camera) * rig.cameras[0].reference_from_camera;
  return fmt::format("    \"C{}\": {{\n", i) + field("name", stringIn(Language::Json, camera.file_name), 6) +
         field("position", stringIn(Language::Json, camera.name), 6) +
         field("master", i == 0 ? "\"true\"" : "\"false\"", 6) +
         field("resolution",
               fmt::format("[\"{}\", \"{}\"]", own.resolution_px.width_px, own.resolution_px.height_px), 6) +
         field("principalPoint", quotedList(own.principal_point_px), 6) +
         field("focalLength", quotedList(own.focal_length_px), 6) +
         field("distortionCoefficients",
               quotedList(Eigen::Map<const Eigen::VectorXd>(d.data(), static_cast<Eigen::Index>(d.size()))),
               6) +
         field("distortionModel", radtan ? "\"radialTangential\"" : "\"equidistant\"", 6) +
         lastField("transformationToC0", quotedList(matrixOf(this_from_first)));
}

// It is looked up by its camera's name. The sensor's limits are on its data sheet, not in a calibration: 0
// means unknown.
std::string dvProcessingImuText(const Rig& rig, const RigImu& imu, ExportNotes& notes) {
  const ImuNoise noise = statedNoise(imu, notes);
  const auto number = [](const char* key, double value) { return field(key, quoted(value), 6); };
  return "    \"S0\": {\n" + field("name", stringIn(Language::Json, rig.cameras[0].file_name), 6) +
         number("omegaMax", 0.0) + number("accMax", 0.0) +
         field("omegaOffsetAvg", quotedList(imu.state.gyroscope_bias_rad_s), 6) +
         field("accOffsetAvg", quotedList(imu.state.accelerometer_bias_m_s2), 6) +
         number("omegaOffsetVar", 0.0) + number("accOffsetVar", 0.0) +
         number("omegaNoiseDensity", noise.gyroscope_density) +
         number("accNoiseDensity", noise.accelerometer_density) +
         number("omegaNoiseRandomWalk", noise.gyroscope_random_walk) +
         number("accNoiseRandomWalk", noise.accelerometer_random_walk) +
         field("timeOffsetMicros", fmt::format("\"{}\"", std::llround(1e6 * rig.cameras[0].time_offset_s)),
               6) +
         field("transformationToC0", quotedList(matrixOf(inverse(rig.cameras[0].reference_from_camera))), 6) +
         metadata(
             "transformationToC0 transforms points of the IMU to camera C0; t_C0 = t_imu - "
             "timeOffsetMicros. " +
             rig.program + ", " + rig.status);
}

std::string dvProcessingStereoText(const Rig& rig) {
  const RigidTransform right_from_left =
      inverse(rig.cameras[1].reference_from_camera) * rig.cameras[0].reference_from_camera;
  const Eigen::Matrix3d essential = essentialMatrix(right_from_left);
  const Eigen::Matrix3d fundamental =
      fundamentalMatrix(rig.cameras[0].intrinsics, rig.cameras[1].intrinsics, right_from_left);
  return "    \"C0_C1\": {\n" +
         field("leftCameraName", stringIn(Language::Json, rig.cameras[0].file_name), 6) +
         field("rightCameraName", stringIn(Language::Json, rig.cameras[1].file_name), 6) +
         field("fundamentalMatrix", quotedList(fundamental), 6) +
         field("essentialMatrix", quotedList(essential), 6) +
         "      \"metadata\": {\"epipolarError\": \"0.0\", \"comment\": \"from the estimated poses\"}\n    }";
}

}  // namespace

ExportedFiles exportDvProcessing(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  std::string text = "{\n  \"version\": \"2.0\",\n  \"cameras\": {\n";
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    text += (i == 0 ? "" : ",\n") + dvProcessingCameraText(rig, i, exported.notes);
  text += "\n  }";
  if (!rig.imus.empty()) {
    noteLostImus(rig, kDvProcessingProgram, exported.notes);
    noteLostOffsets(rig, kDvProcessingProgram, exported.notes);
    noteLostMapping(rig.imus[0], kDvProcessingProgram, exported.notes);
    text += ",\n  \"imus\": {\n" + dvProcessingImuText(rig, rig.imus[0], exported.notes) + "\n  }";
  }
  if (rig.imus.empty()) noteNoOffsets(rig, kDvProcessingProgram, exported.notes);
  if (rig.cameras.size() > 1) text += ",\n  \"stereo\": {\n" + dvProcessingStereoText(rig) + "\n  }";
  exported.files.push_back({"calibration.json", text + "\n}\n"});
  exported.notes.emplace_back(
      "rename the cameras to their devices' names (DAVIS346_00000002, as in a recording), and the IMU to its "
      "camera's name, by which it is looked up");
  if (!rig.imus.empty())
    exported.notes.emplace_back("omegaMax and accMax are 0: set the sensor's limits from its data sheet");
  std::vector<std::string> lines{
      "transformationToC0 of a camera transforms points of C0 to that camera, of the IMU points of the IMU "
      "to C0.",
      "t_C0 = t_imu - timeOffsetMicros."};
  lines.insert(lines.end(), exported.notes.begin(), exported.notes.end());
  exported.files.push_back({"README.txt", readMe(rig, lines)});
  return exported;
}

}  // namespace evical
