// Common parts of the sources of perturbations.
#pragma once

#include "core/geometry/camera_model.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/sinusoid_motion.h"
#include "tests/support/perturbations.h"

#include <algorithm>
#include <cstdint>
#include <random>

namespace evical::test {

// Grouped by the perturbed quantity; perturbations() has them all.
std::vector<Perturbation> boardPerturbations();  // and gravity
std::vector<Perturbation> cameraPerturbations();
std::vector<Perturbation> clockPerturbations();
std::vector<Perturbation> imuPerturbations();

inline std::vector<ImuSample>& samplesOf(Recorded& recorded) {
  return recorded.detections.imus.front().samples;
}

template <class Change>
void changeSamples(Recorded& recorded, Change&& change) {
  for (ImuSample& sample : samplesOf(recorded)) change(sample);
}

inline void simulateImuAnew(Recorded& recorded) {
  samplesOf(recorded) = simulateImu(recorded.scenario, 0);
}

template <class Change>
void simulateFaults(Recorded& recorded, Change&& change) {
  change(recorded.scenario.imus.front().faults);
  simulateImuAnew(recorded);
}

// Moves every circle by the displacement of the image of `pairAt(camera_from_world, point_m, view)`: from its
// true centre in the camera to the perturbed one, in metres.
template <class PairAt>
void moveCircles(Recorded& recorded, PairAt&& pairAt) {
  const SinusoidMotion motion(recorded.scenario);
  for (std::size_t k = 0; k < recorded.detections.cameras.size(); ++k) {
    const SimulatedCamera& camera = recorded.scenario.cameras[k];
    CameraIntrinsics ideal = *recorded.detections.lenses[k].detection_intrinsics;
    ideal.distortion = {};
    ideal.model = CameraModel::PinholeRadtan;
    for (BoardView& view : recorded.detections.cameras[k].views) {
      for (CircleObservation& circle : view.circles) {
        const double time_s = circle.time_s + camera.time_offset_s - camera.pixel.delay_s();
        const RigidTransform camera_from_world = inverse(motion.worldFromCamera(k, time_s));
        const Eigen::Vector2d on_board_m = recorded.scenario.board.point_m(circle.circle);
        const auto [true_m, seen_m] =
            pairAt(camera_from_world, Eigen::Vector3d(on_board_m.x(), on_board_m.y(), 0.0), view);
        const auto before = project(ideal, true_m);
        const auto after = project(ideal, seen_m);
        if (before && after) circle.centre_px += *after - *before;
      }
    }
  }
}

inline std::size_t anySample(Recorded& recorded, std::mt19937_64& generator) {
  return std::uniform_int_distribution<std::size_t>(0, samplesOf(recorded).size() - 1)(generator);
}

}  // namespace evical::test
