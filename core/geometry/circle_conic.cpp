#include "core/geometry/circle_conic.h"

#include "core/geometry/camera_model.h"
#include "core/geometry/so3.h"

namespace evical {

std::optional<ProjectedCircle> projectCircle(const CameraIntrinsics& camera,
                                             const Eigen::Vector3d& centre_in_camera_m,
                                             const Eigen::Vector3d& normal_in_camera, double radius_m) {
  const Eigen::Vector3d &p = centre_in_camera_m, &n = normal_in_camera;
  const double r2 = radius_m * radius_m;
  const double denominator = p.z() * p.z() - r2 * (1.0 - n.z() * n.z());
  if (!(p.z() > 0.0) || !(denominator > 1e-6 * p.z() * p.z())) return std::nullopt;
  const Eigen::Vector2d numerator = p.head<2>() * p.z() + r2 * n.z() * n.head<2>();
  const Eigen::Vector2d normalised = numerator / denominator;
  const Eigen::Vector2d focal_length_px = idealFocalLength_px(camera);
  const Eigen::Vector2d scale = focal_length_px / denominator;

  ProjectedCircle projected;
  projected.centre_px = focal_length_px.cwiseProduct(normalised) + camera.principal_point_px;
  projected.by_centre << p.z(), 0.0, p.x() - 2.0 * normalised.x() * p.z(),  //
      0.0, p.z(), p.y() - 2.0 * normalised.y() * p.z();
  projected.by_normal << n.z(), 0.0, n.x() - 2.0 * normalised.x() * n.z(),  //
      0.0, n.z(), n.y() - 2.0 * normalised.y() * n.z();
  projected.by_centre = (scale.asDiagonal() * projected.by_centre).eval();
  projected.by_normal = (r2 * scale.asDiagonal() * projected.by_normal).eval();
  return projected;
}

std::optional<Eigen::Vector2d> projectedCircleCentre(const CameraIntrinsics& camera,
                                                     const RigidTransform& camera_from_board,
                                                     const Eigen::Vector2d& centre_on_board_m,
                                                     double radius_m, Eigen::Matrix<double, 2, 6>* jacobian) {
  const Eigen::Matrix3d rotation = camera_from_board.rotation.toRotationMatrix();
  const Eigen::Vector3d centre_in_board(centre_on_board_m.x(), centre_on_board_m.y(), 0.0);
  const auto projected = projectCircle(camera, rotation * centre_in_board + camera_from_board.translation_m,
                                       rotation.col(2), radius_m);
  if (!projected) return std::nullopt;
  if (jacobian) {
    jacobian->leftCols<3>() = -projected->by_centre * rotation * skew(centre_in_board) -
                              projected->by_normal * rotation * skew(Eigen::Vector3d::UnitZ());
    jacobian->rightCols<3>() = projected->by_centre;
  }
  return projected->centre_px;
}

}  // namespace evical
