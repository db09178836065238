// Parts of Kalibr's files, which OpenVINS and Ultimate SLAM read too.
#pragma once

#include "core/report/export/rig.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace evical {

// camchain-imucam.yaml: T_cam_imu, timeshift_cam_imu and all of camchain.yaml. The IMU's frame is turned by
// other_from_imu.
std::string kalibrChain(const Rig& rig, const Eigen::Matrix3d& other_from_imu,
                        const std::vector<std::string>& comment);

// rostopic, update_rate, densities and random walks.
std::string kalibrNoise(const Rig& rig, const RigImu& imu, int indent);

// T_i_b and time_offset, below imuN.
std::string kalibrPlacing(const Rig& rig, const RigImu& imu);

// The format has no key for them.
std::string biasComment(const RigImu& imu);

}  // namespace evical
