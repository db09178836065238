// The image of a printed circle is an ellipse whose centre isn't the image of the circle's centre (J.
// Heikkila, "Geometric camera calibration using circular control points", PAMI 2000). With the dual conic C*
// of a circle (X, Y, r) in the board and H = K [r1 r2 t], Q* = H C* H^T and the ellipse's centre is (Q*_13,
// Q*_23) / Q*_33, in ideal pixels (camera_model.h). With p the circle's centre and n the board's normal, both
// in the camera frame, and without K, that is
//   Q*_13 = p_x p_z + r^2 n_x n_z,  Q*_23 = p_y p_z + r^2 n_y n_z,  Q*_33 = p_z^2 - r^2 (1 - n_z^2).
#pragma once

#include "core/geometry/so3.h"

#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <optional>

namespace evical {

struct ProjectedCircle {
  Eigen::Vector2d centre_px;                         // of the ellipse, ideal pixels
  Eigen::Matrix<double, 2, 3> by_centre, by_normal;  // derivatives with respect to p and n
};

// Empty unless the whole circle is in front of the camera.
std::optional<ProjectedCircle> projectCircle(const CameraIntrinsics& camera,
                                             const Eigen::Vector3d& centre_in_camera_m,
                                             const Eigen::Vector3d& normal_in_camera, double radius_m);

// The same from the board's pose. Jacobian columns: rotation, perturbed as camera_from_board.rotation *
// Exp(delta), then translation.
std::optional<Eigen::Vector2d> projectedCircleCentre(const CameraIntrinsics& camera,
                                                     const RigidTransform& camera_from_board,
                                                     const Eigen::Vector2d& centre_on_board_m,
                                                     double radius_m,
                                                     Eigen::Matrix<double, 2, 6>* jacobian = nullptr);

}  // namespace evical
