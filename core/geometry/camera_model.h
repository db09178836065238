// Cameras: pinholes with radial-tangential or equidistant (fisheye) distortion, OpenCV's equations and order
// of coefficients; and for wide lenses the double sphere (V. Usenko, N. Demmel, D. Cremers, "The double
// sphere camera model", 3DV 2018), the enhanced unified model, EUCM (B. Khomutenko, G. Garcia, P. Martinet,
// RA-L 2016), and the unified model with radial-tangential distortion, omni (C. Mei, P. Rives, ICRA 2007).
// docs/maths.md, 3.1. Camera frame: z forward, x right, y down; pixels with the centre of the top-left pixel
// at (0, 0).
//
// "Ideal" pixels are where a camera without distortion, with the same scale on its axis, would see a point: u
// = f x / z + cx with idealFocalLength_px. Only in ideal pixels is the image of a circle an exact conic.
// Towards 90 degrees off axis they go to infinity: they are undefined beyond 85 degrees.
#pragma once

#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>
#include <Eigen/LU>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// Columns of the Jacobian with respect to the intrinsics: fx fy cx cy d0 d1 d2 d3 d4.
using IntrinsicsJacobian = Eigen::Matrix<double, 2, 9>;

// Pixel of a point in the camera frame; empty if the camera does not see it. Pinholes do not see points
// behind the camera or beyond the distortion's range. Wide models, which see more than 90 degrees off axis,
// do not see directions that would share a pixel with another one.
std::optional<Eigen::Vector2d> project(const CameraIntrinsics& camera, const Eigen::Vector3d& point_in_camera,
                                       Eigen::Matrix<double, 2, 3>* jacobian_point = nullptr,
                                       IntrinsicsJacobian* jacobian_intrinsics = nullptr);

// Distorts (x/z, y/z), so that pixel = focal length * distorted + principal point; the Jacobian is
// d(distorted)/d(normalised).
Eigen::Vector2d distort(const CameraIntrinsics& camera, const Eigen::Vector2d& normalised,
                        Eigen::Matrix2d* jacobian = nullptr);

// (x/z, y/z) of the ray through a pixel; empty without a ray, or if it is more than 85 degrees from the axis.
std::optional<Eigen::Vector2d> unproject(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel);

// The same ray as a unit vector; for the wide models at any angle.
std::optional<Eigen::Vector3d> unprojectRay(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel);

// Pixels per x/z and y/z on the axis: the focal length, times 1 / (1 + xi) for models with two spheres.
Eigen::Vector2d idealFocalLength_px(const CameraIntrinsics& camera);

std::optional<Eigen::Vector2d> idealPixel(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel);
Eigen::Vector2d pixelFromIdeal(const CameraIntrinsics& camera, const Eigen::Vector2d& ideal_pixel);

// d(ideal pixel)/d(pixel) at an ideal pixel: local magnification of ideal pixels.
Eigen::Matrix2d idealPixelScale(const CameraIntrinsics& camera, const Eigen::Vector2d& ideal_pixel);

// Throws CalibrationError (BadInput) if the parameters are invalid; `place` is part of the message.
void validate(const CameraIntrinsics& camera, const std::string& place);

// A pinhole of focal length 1: its image coordinates are rays on the plane z = 1.
const CameraIntrinsics& normalisedCamera();

// Ideal pixels (camera_model.h) of every pixel of a camera, computed once.

struct CameraIntrinsics;

// The ideal pixel of every pixel, row by row; NaN if there is none.
class UndistortionTable {
 public:
  UndistortionTable() = default;
  explicit UndistortionTable(const CameraIntrinsics& camera);

  const Eigen::Vector2f& operator()(int x_px, int y_px) const {
    return ideal_px_[static_cast<std::size_t>(y_px) * static_cast<std::size_t>(width_px_) +
                     static_cast<std::size_t>(x_px)];
  }
  bool empty() const { return ideal_px_.empty(); }

 private:
  int width_px_ = 0;
  std::vector<Eigen::Vector2f> ideal_px_;
};

// Distortion of (x/z, y/z) for pinhole cameras; OpenCV's equations (docs/maths.md, 3.1).

using DistortionJacobian = Eigen::Matrix<double, 2, 5>;  // by the coefficients

// k1 k2 p1 p2 k3.
Eigen::Vector2d distortRadtan(const std::array<double, 5>& coefficients, const Eigen::Vector2d& normalised,
                              Eigen::Matrix2d* jacobian, DistortionJacobian* by_coefficients);

// k1 k2 k3 k4.
Eigen::Vector2d distortEquidistant(const std::array<double, 5>& coefficients,
                                   const Eigen::Vector2d& normalised, Eigen::Matrix2d* jacobian,
                                   DistortionJacobian* by_coefficients);

// Beyond the radius where a distortion folds back, points would move inwards again.
inline bool foldsBack(const Eigen::Matrix2d& jacobian) {
  return !(jacobian.determinant() > 0.0) || jacobian.trace() <= 0.0;
}

// The point whose distortion is `target`, by Newton's iteration from `start`; empty if it does not converge.
// `distort`: (normalised, &jacobian) -> distorted.
template <class Distort>
std::optional<Eigen::Vector2d> undistorted(const Eigen::Vector2d& target, const Eigen::Vector2d& start,
                                           Distort&& distort) {
  constexpr int kIterations = 30;
  Eigen::Vector2d n = start;
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Matrix2d jacobian;
    const Eigen::Vector2d error = distort(n, &jacobian) - target;
    if (!(jacobian.determinant() > 0.0)) return std::nullopt;
    Eigen::Vector2d step = jacobian.inverse() * error;
    const double longest = 0.5 * (1.0 + n.norm());
    if (step.norm() > longest) step *= longest / step.norm();
    n -= step;
    if (!n.allFinite()) return std::nullopt;
    if (step.norm() < 1e-12 * (1.0 + n.norm())) return n;
  }
  return std::nullopt;
}

}  // namespace evical
