// Parameter blocks and measurements for tests of the batch's cost functions.
#pragma once

#include "core/geometry/so3.h"
#include "core/optimisation/view_cost.h"
#include "tests/core/optimisation/cost_check.h"

#include <array>
#include <random>
#include <utility>
#include <vector>

namespace evical::test {

using Eigen::Vector3d;

inline constexpr double kSpacing_s = 0.02;

class States {
 public:
  explicit States(unsigned seed) : random_(seed) {}
  double uniform(double size) { return std::uniform_real_distribution<double>(-size, size)(random_); }
  Vector3d vector(double size) { return {uniform(size), uniform(size), uniform(size)}; }

  void appendRotations(double step_rad, Blocks& blocks) {
    Eigen::Quaterniond rotation = quaternionExp(vector(0.4));
    for (int k = 0; k < 4; ++k) {
      blocks.push_back(numbers(rotation));
      rotation = (rotation * quaternionExp(step_rad * vector(1.0).normalized())).normalized();
    }
  }
  void appendPositions(Blocks& blocks) {
    Vector3d position = Vector3d(0.1, 0.2, -0.7) + vector(0.1);
    for (int k = 0; k < 4; ++k) {
      blocks.push_back({position.x(), position.y(), position.z()});
      position += vector(0.02);
    }
  }
  static std::vector<double> numbers(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }
  static std::vector<double> numbers(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

 private:
  std::mt19937_64 random_;
};

inline SegmentTimes segmentTimes() {
  SegmentTimes segment;
  segment.rotation_start_s = 1.0;
  segment.position_start_s = 0.99;  // splines need not share their knots
  segment.rotation_spacing_s = kSpacing_s;
  segment.position_spacing_s = 1.5 * kSpacing_s;
  return segment;
}

inline std::vector<double> mappingNumbers(States& states) {
  return {1.0 + states.uniform(0.05), states.uniform(0.05), states.uniform(0.05),
          1.0 + states.uniform(0.05), states.uniform(0.05), 1.0 + states.uniform(0.05)};
}

inline CircleModel circleModel() {
  CircleModel model;
  model.camera = {CameraModel::PinholeRadtan, {346, 260}, {260.0, 255.0}, {170.0, 131.0}, {}};
  model.radius_m = 0.02;
  model.huber_sigma = 2.5;
  return model;
}

inline Blocks circleBlocks(States& states, double step_rad) {
  Blocks blocks;
  states.appendRotations(step_rad, blocks);
  states.appendPositions(blocks);
  blocks.push_back(States::numbers(quaternionExp(states.vector(0.2))));
  blocks.push_back(States::numbers(states.vector(0.05)));
  blocks.push_back({states.uniform(0.004)});
  blocks.push_back({0.3});  // not random: the Huber kink must not be within a step of any of these draws
  blocks.push_back({30.0});
  blocks.push_back({states.uniform(0.3)});
  blocks.push_back({states.uniform(0.3)});
  for (const double of_board : {1.01, 0.02, 0.3, -0.2, 0.1})
    blocks.push_back({of_board});  // not random either
  blocks.push_back({0.05});
  // The board's pose in the world is not random either, which keeps it in front of the camera.
  blocks.push_back(States::numbers(quaternionExp(Eigen::Vector3d(0.05, -0.04, 0.1))));
  blocks.push_back({0.03, -0.02, 0.04});
  return blocks;
}

inline ViewCost exactCost(const CircleModel& model, std::vector<CircleMeasurement> circles) {
  return {model, segmentTimes(), std::move(circles), ViewCost::PoseColumns::ControlPoints};
}

// `near_sigma`: approximate distance of the measured centres from the predicted ones, in sigmas.
inline std::vector<CircleMeasurement> circlesNear(const CircleModel& model, const Blocks& blocks,
                                                  double near_sigma, States& states) {
  std::vector<CircleMeasurement> circles(3);
  for (std::size_t i = 0; i < circles.size(); ++i) {
    circles[i].time_s = 1.004 + 0.005 * static_cast<double>(i);
    circles[i].by_drift_s = 0.002 * (static_cast<double>(i) - 1.0);
    circles[i].by_line_s = 1e-4 * (static_cast<double>(i) - 0.7);
    circles[i].by_exposure_s = 2e-2 * (static_cast<double>(i) - 1.2);
    circles[i].on_board_m = {0.1 * static_cast<double>(i), 0.05 * static_cast<double>(i)};
    circles[i].centre_px.setZero();
    circles[i].whitening_px.setIdentity();
    circles[i].lead = {{0.6, -0.5}, {-0.3, 0.25}};
  }
  CircleModel linear = model;
  linear.huber_sigma = 1e9;
  const Eigen::VectorXd centres = residualsAt(exactCost(linear, circles), blocks);
  for (std::size_t i = 0; i < circles.size(); ++i) {
    circles[i].whitening_px << 12.0, 0.0, -3.0, 9.0;
    circles[i].centre_px = centres.segment<2>(static_cast<Eigen::Index>(2 * i)) +
                           near_sigma / 10.0 * states.vector(1.0).normalized().head<2>();
  }
  return circles;
}

// The same circles seen through a lens that differs slightly from the block of intrinsics.
inline CircleModel freeModel(CameraModel lens) {
  CircleModel model = circleModel();
  model.camera.model = lens;
  constexpr std::array<std::array<double, 5>, 5> kByModel = {{{-0.31, 0.11, 2e-3, -1e-3, 0.02},
                                                              {-0.04, 0.02, -0.01, 3e-3, 0.0},
                                                              {-0.2, 0.6, 0.0, 0.0, 0.0},
                                                              {0.6, 1.1, 0.0, 0.0, 0.0},
                                                              {1.2, -0.2, 0.05, 1e-3, -2e-3}}};
  model.camera.distortion = kByModel[static_cast<std::size_t>(lens)];
  model.free_intrinsics = true;
  return model;
}

inline CircleModel heldModel(CircleModel model) {
  model.free_intrinsics = false;
  return model;
}

inline std::vector<double> intrinsicsNumbers(const CameraIntrinsics& camera) {
  std::vector<double> numbers(9);
  writeIntrinsics(camera, numbers.data());
  return numbers;
}

inline CameraIntrinsics otherLens(const CameraIntrinsics& camera, States& states) {
  CameraIntrinsics other = camera;
  other.focal_length_px += states.vector(2.0).head<2>();
  other.principal_point_px += states.vector(2.0).head<2>();
  const std::size_t coefficients = coefficientCount(camera.model) == 2 ? 2 : 4;
  for (std::size_t k = 0; k < coefficients; ++k) other.distortion[k] += states.uniform(2e-3);
  return other;
}

}  // namespace evical::test
