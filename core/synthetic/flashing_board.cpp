#include "core/synthetic/flashing_board.h"

#include <cmath>
#include <utility>

namespace evical {

FlashingBoard::FlashingBoard(const Scenario& scenario, std::size_t camera,
                             const RigidTransform& world_from_camera)
    : blink_hz_(scenario.scene.blink_hz),
      light_(scenario, camera, scenario.cameras[camera].pixel.blur_px),
      planes_(light_.at(world_from_camera)),
      last_(static_cast<std::size_t>(scenario.cameras[camera].intrinsics.resolution_px.pixelCount())) {
  for (std::size_t pixel = 0; pixel < last_.size(); ++pixel) last_[pixel] = light_.of(pixel, planes_);
}

FlashingBoard::Stretch FlashingBoard::take(std::size_t pixel) {
  const SceneLight::Light end = light_.of(pixel, planes_);
  return {std::exchange(last_[pixel], end), end};
}

bool FlashingBoard::isShown(double time_s) const {
  return std::fmod(time_s * blink_hz_, 1.0) < 0.5;
}

}  // namespace evical
