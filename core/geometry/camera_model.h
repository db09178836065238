// Pinhole cameras with radial-tangential or equidistant (fisheye) distortion. Camera frame: z
// forward, x right, y down; pixels with the centre of the top-left pixel at (0, 0). OpenCV's
// equations and order of coefficients.
//
// "Ideal" pixels are where a camera of the same focal length and principal point without distortion would see
// a point: u = fx x / z + cx. In ideal pixels, and only there, the image of a circle is an exact conic.
#pragma once

#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <optional>
#include <string>

namespace evical {

// Columns of the Jacobian with respect to the intrinsics: fx fy cx cy d0 d1 d2 d3 d4.
using IntrinsicsJacobian = Eigen::Matrix<double, 2, 9>;

// Pixel of a point in the camera frame; nothing if the point is behind the camera
// or beyond the distortion's range.
std::optional<Eigen::Vector2d> project(const CameraIntrinsics& camera, const Eigen::Vector3d& point_in_camera,
                                       Eigen::Matrix<double, 2, 3>* jacobian_point = nullptr,
                                       IntrinsicsJacobian* jacobian_intrinsics = nullptr);

// Distorts (x/z, y/z); the Jacobian is d(distorted)/d(normalised).
Eigen::Vector2d distort(const CameraIntrinsics& camera, const Eigen::Vector2d& normalised,
                        Eigen::Matrix2d* jacobian = nullptr);

// (x/z, y/z) of the ray through a pixel, by Newton's iteration; nothing where it does not converge or where
// the ray is more than 85 degrees off axis.
std::optional<Eigen::Vector2d> unproject(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel);

std::optional<Eigen::Vector2d> idealPixel(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel);
Eigen::Vector2d pixelFromIdeal(const CameraIntrinsics& camera, const Eigen::Vector2d& ideal_pixel);

// d(ideal pixel)/d(pixel) at an ideal pixel: how much larger a small figure is in ideal pixels.
Eigen::Matrix2d idealPixelScale(const CameraIntrinsics& camera, const Eigen::Vector2d& ideal_pixel);

// Throws CalibrationError (BadInput) when the numbers make no camera; `place` goes into the message.
void validate(const CameraIntrinsics& camera, const std::string& place);

}  // namespace evical
