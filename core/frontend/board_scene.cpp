#include "core/frontend/board_scene.h"

#include "core/geometry/camera_model.h"

#include <limits>
#include <utility>

namespace evical {
namespace {

std::shared_ptr<const IdealPixels> idealPixels(const CameraIntrinsics& camera, Resolution resolution_px) {
  auto pixels = std::make_shared<IdealPixels>();
  pixels->ideal = UndistortionTable(camera);
  pixels->stretch.reserve(static_cast<std::size_t>(resolution_px.pixelCount()));
  for (int y = 0; y < resolution_px.height_px; ++y) {
    for (int x = 0; x < resolution_px.width_px; ++x) {
      const Eigen::Vector2d pixel = pixels->ideal(x, y).cast<double>();
      Eigen::Matrix2f j = Eigen::Matrix2f::Constant(std::numeric_limits<float>::quiet_NaN());
      if (pixel.allFinite()) j = idealPixelScale(camera, pixel).cast<float>();
      const Eigen::Matrix2f jj = j * j.transpose();
      pixels->stretch.push_back({jj(0, 0), jj(0, 1), jj(1, 1)});
    }
  }
  return pixels;
}

}  // namespace

BoardScene::BoardScene(const Board& the_board, Resolution resolution,
                       std::optional<CameraIntrinsics> intrinsics)
    : board(the_board), resolution_px(resolution), camera(std::move(intrinsics)) {
  if (camera) pixels = idealPixels(*camera, resolution);
}

}  // namespace evical
