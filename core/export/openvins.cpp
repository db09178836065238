#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/export/kalibr_text.h"
#include "core/export/rig.h"

#include <fmt/format.h>

namespace evical {
namespace {

// `rpng` uses upper triangular matrices like Evical, so no frame is rotated.
std::string openvinsMappingText(const RigImu& imu) {
  const TriangularTimesRotation gyroscope = splitUpper(imu.state.gyroscopeMatrix());
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  const bool mapped = hasMapping(imu.state);
  return fmt::format("  model: {}\n  Tw:\n{}  R_IMUtoGYRO:\n{}  Ta:\n{}  R_IMUtoACC:\n{}  Tg:\n{}",
                     mapped ? "rpng" : "calibrated", rowsYaml(mapped ? gyroscope.triangular : identity, 4),
                     rowsYaml(mapped ? gyroscope.rotation : identity, 4),
                     rowsYaml(imu.state.accelerometer_scale_misalignment, 4), rowsYaml(identity, 4),
                     rowsYaml(Eigen::Matrix3d::Zero(), 4));
}

}  // namespace

ExportedFiles exportOpenVins(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  const RigImu& imu = neededImu(rig, "OpenVINS");
  noteLostImus(rig, "OpenVINS", exported.notes);
  noteLostOffsets(rig, "OpenVINS", exported.notes);
  const std::string first_line = "%YAML:1.0\n";
  exported.files.push_back(
      {"kalibr_imucam_chain.yaml",
       first_line +
           kalibrChain(rig, lensesFor({"OpenVINS"}, rig, exported.notes), Eigen::Matrix3d::Identity(),
                       {"OpenVINS. T_cam_imu transforms points of the IMU to the camera; t_imu = t_cam + "
                        "timeshift_cam_imu (that of cam0 is used)."})});
  exported.files.push_back(
      {"kalibr_imu_chain.yaml",
       first_line +
           headerComment(
               rig, {"OpenVINS. measured force = Ta R_IMUtoACC f + bias, measured rate = Tw R_IMUtoGYRO w "
                     "+ Tg f + bias."}) +
           fmt::format("imu0:  # {}\n", imu.file_name) + kalibrNoise(imu, 2, exported.notes) +
           kalibrPlacing(rig, imu) + biasComment(imu) + openvinsMappingText(imu)});
  return exported;
}

}  // namespace evical
