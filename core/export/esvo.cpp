#include "core/base/error.h"
#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/export/stereo.h"

#include <fmt/format.h>

namespace evical {
namespace {

// ESVO's own calibration files have 4 coefficients of plumb_bob.
CameraIntrinsics leftCamera(const RigCamera& camera, const char* program, ExportNotes& notes) {
  return cameraFor(camera, {program, true, false, true}, notes);
}

// The program uses size and distortion model of the left camera's file for both cameras.
CameraIntrinsics rightCamera(const RigCamera& camera, const CameraIntrinsics& left, const char* program,
                             ExportNotes& notes) {
  if (camera.intrinsics.resolution_px != left.resolution_px)
    throw badInput(
        fmt::format("result: cameras.{}", camera.name),
        fmt::format("has a different resolution from the left camera; {} has one for both", program),
        fmt::format("Omit the target {}", program));
  const bool radtan = left.model == CameraModel::PinholeRadtan;
  return cameraFor(camera, {program, radtan, false, !radtan}, notes);
}

std::string esvoCameraFile(const Rig& rig, const RigCamera& camera, const CameraIntrinsics& own,
                           const std::vector<std::string>& comment, const Eigen::Matrix3d& rectification,
                           const Eigen::Matrix<double, 3, 4>& projection, const StereoPair& pair) {
  return headerComment(rig, comment) + cameraInfoBody(camera.file_name, own, 4) + "rectification_matrix:\n" +
         dataMatrix(rectification, 2) + "projection_matrix:\n" + dataMatrix(projection, 2) +
         "T_right_left:\n" + dataMatrix(matrixOf(pair.right_from_left).topRows<3>(), 2);
}

ExportedFiles exportPair(const NamedResult& result, const char* program, bool with_imu) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  const StereoPair pair = stereoPair(rig, program);
  noteLostCameras(rig, 2, program, exported.notes);
  std::string imu_pose;
  if (with_imu) {
    noteLostImus(rig, program, exported.notes);
    noteLostMapping(neededImu(rig, program), program, exported.notes);
    imu_pose = "T_b_c:\n" + dataMatrix(matrixOf(pair.left.reference_from_camera).topRows<3>(), 2);
  }
  const CameraIntrinsics left = leftCamera(pair.left, program, exported.notes);
  const CameraIntrinsics right = rightCamera(pair.right, left, program, exported.notes);
  const Rectification rectified = rectify(left, right, pair.right_from_left);
  std::string offsets = fmt::format(
      "{} does not support time offsets: add {} s to the stamps of {} and {} s to those of {}, so that "
      "t_reference = t_cam + offset",
      program, real(pair.left.time_offset_s), pair.left.file_name, real(pair.right.time_offset_s),
      pair.right.file_name);
  std::vector<std::string> comment{
      fmt::format("{} stereo pair. T_right_left transforms points of the left camera to the "
                  "right{}.",
                  program, with_imu ? ", T_b_c points of the left camera to the IMU" : ""),
      offsets + "."};
  exported.files.push_back(
      {"left.yaml", esvoCameraFile(rig, pair.left, left, comment, rectified.rectified_from_left,
                                   rectified.left_projection, pair) +
                        imu_pose});
  exported.files.push_back(
      {"right.yaml", esvoCameraFile(rig, pair.right, right, comment, rectified.rectified_from_right,
                                    rectified.right_projection, pair) +
                         imu_pose});
  exported.notes.push_back(std::move(offsets));
  return exported;
}

}  // namespace

ExportedFiles exportEsvo(const NamedResult& result) {
  return exportPair(result, "ESVO", false);
}

ExportedFiles exportEsvo2(const NamedResult& result) {
  return exportPair(result, "ESVO2", true);
}

}  // namespace evical
