// The light of a board on a screen that flashes, to event pixels, in stretches of time one after the other.
#pragma once

#include "core/synthetic/scene_light.h"

#include <cstddef>
#include <vector>

namespace evical {

class FlashingBoard {
 public:
  // Settled on what is seen at the beginning.
  FlashingBoard(const Scenario& scenario, std::size_t camera, const RigidTransform& world_from_camera);

  // The next stretch, of few milliseconds; then each of its pixels once, from any thread.
  void begin(const RigidTransform& world_from_camera_at_end) {
    planes_ = light_.at(world_from_camera_at_end);
  }

  // Reflectances at a stretch's begin and end, assumed linear in between.
  struct Stretch {
    SceneLight::Light begin, end;
    // At this part of the stretch.
    float reflectance(float part, bool shown) const {
      return shown ? begin.shown + part * (end.shown - begin.shown)
                   : begin.hidden + part * (end.hidden - begin.hidden);
    }
  };
  Stretch take(std::size_t pixel);

  // True if the pattern is on the screen; otherwise it is white.
  bool isShown(double time_s) const;
  // At the last stretch's end.
  const SceneLight::Light& last(std::size_t pixel) const { return last_[pixel]; }

 private:
  double blink_hz_;
  SceneLight light_;
  SceneLight::Planes planes_;
  std::vector<SceneLight::Light> last_;  // at the end of the stretch before
};

}  // namespace evical
