// The light of a board on a flashing screen at event pixels, in consecutive intervals of time.
#pragma once

#include "core/synthetic/scene_light.h"

#include <cstddef>
#include <vector>

namespace evical {

class FlashingBoard {
 public:
  // Initialised to the light at the beginning.
  FlashingBoard(const Scenario& scenario, std::size_t camera, const RigidTransform& world_from_camera);

  // Begins the next interval, of a few milliseconds; afterwards each of its pixels once, from any thread.
  void begin(const RigidTransform& world_from_camera_at_end) {
    planes_ = light_.at(world_from_camera_at_end);
  }

  // Reflectances at an interval's begin and end, assumed linear in between.
  struct Stretch {
    SceneLight::Light begin, end;
    // Light at this fraction of the interval.
    float reflectance(float part, bool shown) const {
      return shown ? begin.shown + part * (end.shown - begin.shown)
                   : begin.hidden + part * (end.hidden - begin.hidden);
    }
  };
  Stretch take(std::size_t pixel);

  // True if the pattern is on the screen; otherwise it is white.
  bool isShown(double time_s) const;
  // Light at the last interval's end.
  const SceneLight::Light& last(std::size_t pixel) const { return last_[pixel]; }

 private:
  double blink_hz_;
  SceneLight light_;
  SceneLight::Planes planes_;
  std::vector<SceneLight::Light> last_;  // at the end of the previous interval
};

}  // namespace evical
