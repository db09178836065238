// Constants of all windows: the board, the sensor, and the lens between them.
#pragma once

#include "core/geometry/board.h"

#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/camera_model.h"

#include <Eigen/Core>

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

namespace evical {

// Stretch of a pixel by lens distortion: J J^T of J = d(ideal pixel) / d(pixel).
struct PixelStretch {
  float xx = 1.0f, xy = 0.0f, yy = 1.0f;

  // Ideal pixels per pixel for an edge with this normal (unit, in ideal pixels): |J^T n|.
  double across(const Eigen::Vector2d& normal) const {
    const double x = normal.x(), y = normal.y();
    return std::sqrt(x * x * xx + 2.0 * x * y * xy + y * y * yy);
  }
};

// The lens, pixel by pixel.
struct IdealPixels {
  UndistortionTable ideal;
  std::vector<PixelStretch> stretch;
};

// Copies are cheap: they share the lens's tables.
struct BoardScene {
  Board board;
  Resolution resolution_px;
  std::optional<CameraIntrinsics> camera;
  std::shared_ptr<const IdealPixels> pixels;  // null without a camera: ideal pixels are the sensor's own

  BoardScene(const Board& board, Resolution resolution_px, std::optional<CameraIntrinsics> camera);
};

}  // namespace evical
