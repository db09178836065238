#include "core/export/imu_frames.h"

#include <Eigen/QR>

namespace evical {

TriangularTimesRotation splitLower(const Eigen::Matrix3d& matrix) {
  // matrix^T = Q R, so matrix = R^T Q^T.
  const Eigen::HouseholderQR<Eigen::Matrix3d> qr(matrix.transpose());
  Eigen::Matrix3d lower = Eigen::Matrix3d(qr.matrixQR().triangularView<Eigen::Upper>()).transpose();
  Eigen::Matrix3d rotation = Eigen::Matrix3d(qr.householderQ()).transpose();
  for (int i = 0; i < 3; ++i)
    if (lower(i, i) < 0.0) {
      lower.col(i) *= -1.0;
      rotation.row(i) *= -1.0;
    }
  return {lower, rotation};
}

TriangularTimesRotation splitUpper(const Eigen::Matrix3d& matrix) {
  const Eigen::Matrix3d turned = matrix.rowwise().reverse().colwise().reverse();
  const TriangularTimesRotation split = splitLower(turned);
  return {split.triangular.rowwise().reverse().colwise().reverse(),
          split.rotation.rowwise().reverse().colwise().reverse()};
}

bool hasMapping(const ImuState& imu) {
  return imu.accelerometer_scale_misalignment != Eigen::Matrix3d::Identity() ||
         imu.gyroscopeMatrix() != Eigen::Matrix3d::Identity();
}

LowerTriangularImu lowerTriangular(const ImuState& imu) {
  if (!hasMapping(imu)) return {};
  const TriangularTimesRotation accelerometer = splitLower(imu.accelerometer_scale_misalignment);
  const TriangularTimesRotation gyroscope =
      splitLower(imu.gyroscopeMatrix() * accelerometer.rotation.transpose());
  return {accelerometer.rotation, accelerometer.triangular, gyroscope.triangular, gyroscope.rotation};
}

RigidTransform turnOf(const Eigen::Matrix3d& other_from_imu) {
  return {Eigen::Quaterniond(other_from_imu), Eigen::Vector3d::Zero()};
}

}  // namespace evical
