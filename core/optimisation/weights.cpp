#include "core/optimisation/weights.h"

#include "core/data/calibration_setup.h"

namespace evical {

CircleSelection allCircles(const CalibrationInput& input) {
  CircleSelection used;
  for (const CameraData& camera : input.cameras) {
    auto& views = used.emplace_back();
    for (const BoardView& view : camera.observations.views)
      views.emplace_back(view.circles.size(), std::uint8_t{1});
  }
  return used;
}

Weights givenWeights(const CalibrationInput& input) {
  Weights weights;
  weights.scales.circles.assign(input.cameras.size(), 1.0);
  weights.scales.displacements.assign(input.cameras.size(), 1.0);
  weights.scales.gyroscopes.assign(input.imus.size(), 1.0);
  weights.scales.accelerometers.assign(input.imus.size(), 1.0);
  weights.used_circles = allCircles(input);
  for (const ImuData& imu : input.imus) weights.used_samples.push_back(fitSamples(imu.samples));
  weights.held_axes.resize(input.imus.size());
  return weights;
}

}  // namespace evical
