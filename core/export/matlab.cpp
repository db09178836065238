#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/export/stereo.h"

#include <fmt/format.h>

namespace evical {
namespace {

// Its objects support radial-tangential distortion only; equidistant coefficients are plain numbers.
constexpr KnownModels kMatlabModels{"MATLAB", true, true, true};

std::string matlabMatrixText(const Eigen::MatrixXd& matrix) {
  std::string text;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    text += (row == 0 ? "" : "; ") + rowMajor(matrix.row(row));
  return "[" + text + "]";
}

// rig.cameras(1).Name = value;
std::string line(const std::string& owner, const char* field, const std::string& value) {
  return fmt::format("{}.{} = {};\n", owner, field, value);
}

std::string matlabCameraText(const RigCamera& camera, const CameraIntrinsics& own, std::size_t number) {
  const std::string owner = fmt::format("rig.cameras({})", number);
  const auto& d = own.distortion;
  const bool radtan = own.model == CameraModel::PinholeRadtan;
  const Eigen::Vector2d from_one = own.principal_point_px + Eigen::Vector2d::Ones();
  std::string text = line(owner, "Name", stringIn(Language::Matlab, camera.file_name)) +
                     line(owner, "ImageSize",
                          fmt::format("[{}, {}]", own.resolution_px.height_px, own.resolution_px.width_px)) +
                     line(owner, "FocalLength", matlabMatrixText(own.focal_length_px.transpose())) +
                     line(owner, "PrincipalPoint", matlabMatrixText(from_one.transpose())) +
                     line(owner, "Model", radtan ? "'RadialTangential'" : "'KannalaBrandt'");
  text += radtan ? line(owner, "RadialDistortion", matlabMatrixText(Eigen::RowVector3d(d[0], d[1], d[4]))) +
                       line(owner, "TangentialDistortion", matlabMatrixText(Eigen::RowVector2d(d[2], d[3])))
                 : line(owner, "DistortionCoefficients",
                        matlabMatrixText(Eigen::RowVector4d(d[0], d[1], d[2], d[3])));
  return text + line(owner, "ReferenceFromCamera", matlabMatrixText(matrixOf(camera.reference_from_camera))) +
         line(owner, "TimeOffset", real(camera.time_offset_s));
}

std::string matlabImuText(const RigImu& imu, std::size_t number, ExportNotes& notes) {
  const std::string owner = fmt::format("rig.imus({})", number);
  const ImuNoise noise = statedNoise(imu, notes);
  return line(owner, "Name", stringIn(Language::Matlab, imu.file_name)) +
         line(owner, "ReferenceFromImu", matlabMatrixText(matrixOf(imu.state.reference_from_imu))) +
         line(owner, "TimeOffset", real(imu.state.time_offset_s)) +
         line(owner, "AccelerometerMatrix", matlabMatrixText(imu.state.accelerometer_scale_misalignment)) +
         line(owner, "GyroscopeMatrix", matlabMatrixText(imu.state.gyroscopeMatrix())) +
         line(owner, "AccelerometerBias", matlabMatrixText(imu.state.accelerometer_bias_m_s2)) +
         line(owner, "GyroscopeBias", matlabMatrixText(imu.state.gyroscope_bias_rad_s)) +
         line(owner, "SampleRate", real(statedRate_hz(imu, notes))) +
         line(owner, "AccelerometerNoiseDensity", real(noise.accelerometer_density)) +
         line(owner, "GyroscopeNoiseDensity", real(noise.gyroscope_density)) +
         line(owner, "AccelerometerRandomWalk", real(noise.accelerometer_random_walk)) +
         line(owner, "GyroscopeRandomWalk", real(noise.gyroscope_random_walk));
}

// stereoParameters requires the rotation of row vectors: the transpose of that of columns.
std::string matlabStereoText(const Rig& rig) {
  const std::optional<StereoPair> level = sideBySide(rig);
  const bool swapped = level && level->left.name != rig.cameras[0].name;
  const RigCamera& first = rig.cameras[swapped ? 1 : 0];
  const RigCamera& second = rig.cameras[swapped ? 0 : 1];
  const RigidTransform second_from_first =
      inverse(second.reference_from_camera) * first.reference_from_camera;
  return line("rig.stereo", "Cameras", swapped ? "[2, 1]" : "[1, 2]") +
         line("rig.stereo", "RotationOfCamera2",
              matlabMatrixText(second_from_first.rotation.toRotationMatrix().transpose())) +
         line("rig.stereo", "TranslationOfCamera2",
              matlabMatrixText(second_from_first.translation_m.transpose()));
}

// Objects of the Computer Vision Toolbox if it is installed; Octave does not have them.
constexpr const char* kCameraObjects =
    "if exist('cameraIntrinsics') > 0\n"
    "  for k = 1:numel(rig.cameras)\n"
    "    c = rig.cameras(k);\n"
    "    if strcmp(c.Model, 'RadialTangential')\n"
    "      rig.cameras(k).Intrinsics = cameraIntrinsics(c.FocalLength, c.PrincipalPoint, c.ImageSize, ...\n"
    "        'RadialDistortion', c.RadialDistortion, 'TangentialDistortion', c.TangentialDistortion);\n"
    "      K = [c.FocalLength(1), 0, c.PrincipalPoint(1); 0, c.FocalLength(2), c.PrincipalPoint(2); 0, 0, "
    "1];\n"
    "      rig.cameras(k).Parameters = cameraParameters('IntrinsicMatrix', K', ...\n"
    "        'RadialDistortion', c.RadialDistortion, 'TangentialDistortion', c.TangentialDistortion, ...\n"
    "        'ImageSize', c.ImageSize, 'WorldUnits', 'm');\n"
    "    end\n"
    "  end\n"
    "end\n";
constexpr const char* kStereoObject =
    "pair = rig.cameras(rig.stereo.Cameras);\n"
    "if exist('stereoParameters') > 0 && all(strcmp({pair.Model}, 'RadialTangential'))\n"
    "  rig.stereo.Parameters = stereoParameters(pair(1).Parameters, pair(2).Parameters, ...\n"
    "    rig.stereo.RotationOfCamera2, rig.stereo.TranslationOfCamera2);\n"
    "end\n";

const std::vector<std::string> kHelp{
    "rig = evical_rig() returns cameras, IMUs and, for two cameras, a stereo pair: numbers, and objects "
    "(Intrinsics, Parameters) if the Computer Vision Toolbox is installed. It also runs in Octave.",
    "Pixels are MATLAB's: the centre of the first one is (1, 1), so PrincipalPoint is OpenCV's + 1.",
    "4x4 matrices apply to columns: [p_reference; 1] = ReferenceFromCamera * [p_camera; 1], in metres. "
    "RotationOfCamera2 applies to rows, as in stereoParameters: p_2 = p_1 * RotationOfCamera2 + "
    "TranslationOfCamera2.",
    "t_reference = t_camera + TimeOffset, in seconds; the same for IMUs.",
    "measured force = AccelerometerMatrix * f + AccelerometerBias, measured rate = GyroscopeMatrix * w + "
    "GyroscopeBias (SI units)."};

}  // namespace

ExportedFiles exportMatlab(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  const bool inertial = !rig.imus.empty();
  std::string text = "function rig = evical_rig()\n" + headerComment(rig, kHelp, Language::Matlab);
  text += line("rig", "Reference",
               stringIn(Language::Matlab, inertial ? rig.imus[0].file_name : rig.cameras[0].file_name));
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const CameraIntrinsics own = cameraFor(rig.cameras[i], kMatlabModels, exported.notes);
    if (own.model != CameraModel::PinholeRadtan)
      exported.notes.push_back(
          fmt::format("{}: cameraParameters and cameraIntrinsics do not support equidistant distortion: its "
                      "numbers are written "
                      "without an object (create cameraIntrinsicsKB by cameraIntrinsicsFromOpenCV, from "
                      "R2024a on, with the "
                      "principal point - 1)",
                      rig.cameras[i].name));
    text += matlabCameraText(rig.cameras[i], own, i + 1);
  }
  for (std::size_t i = 0; i < rig.imus.size(); ++i) text += matlabImuText(rig.imus[i], i + 1, exported.notes);
  if (inertial) text += line("rig", "Gravity", real(rig.gravity_m_s2.norm()));
  text += kCameraObjects;
  if (rig.cameras.size() > 1) text += matlabStereoText(rig) + kStereoObject;
  exported.files.push_back({"evical_rig.m", text + "end\n"});
  return exported;
}

}  // namespace evical
