// Parts of Kalibr's files, which OpenVINS and Ultimate SLAM also read.
#pragma once

#include "core/export/distortion_fit.h"
#include "core/export/rig.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace evical {

// The rig's cameras in models that the program supports.
std::vector<CameraIntrinsics> lensesFor(const KnownModels& known, const Rig& rig, ExportNotes& notes);

// Kalibr's camera_model, distortion_coeffs, distortion_model and intrinsics. Its radtan has no k3.
std::string kalibrLensText(const CameraIntrinsics& camera);

// The camchain of a single camera, with a comment if Kalibr does not support k3.
std::string camchainYaml(const std::string& stream, const CameraIntrinsics& camera);

// camchain-imucam.yaml: T_cam_imu, timeshift_cam_imu and all of camchain.yaml. The IMU's
// frame is rotated by other_from_imu.
std::string kalibrChain(const Rig& rig, const std::vector<CameraIntrinsics>& lenses,
                        const Eigen::Matrix3d& other_from_imu, const std::vector<std::string>& comment);

// rostopic, update_rate, densities and random walks.
std::string kalibrNoise(const RigImu& imu, int indent, ExportNotes& notes);

// T_i_b and time_offset, below imuN.
std::string kalibrPlacing(const Rig& rig, const RigImu& imu);

// The format has no key for them.
std::string biasComment(const RigImu& imu);

}  // namespace evical
