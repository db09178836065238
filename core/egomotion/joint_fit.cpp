#include "core/egomotion/joint_fit.h"

#include "core/base/in_parallel.h"
#include "core/base/time.h"
#include "core/geometry/so3.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace evical {
namespace {

constexpr double kHeld = 1e12;

void take(const JointVector& step, AlignmentState& state) {
  state.imu_from_camera = so3Exp(step.head<3>()) * state.imu_from_camera;
  state.time_offset_s += step[3];
  state.bias_rad_s += step.segment<3>(4);
  state.scale += step[7];
  state.lever_left += step.tail<3>();
}

}  // namespace

JointFit::JointFit(const JointInput& input, const EgomotionOptions& options, bool still)
    : input_(input), options_(options), still_(still), velocity_information_(still ? kHeld : 0.0) {
  for (const KeptSlopes::Window& window : input.record.slopes.windows())
    if (input.record.windows[window.index].use == WindowUse::Used) windows_.push_back(&window);
  states_.resize(windows_.size());
  parts_.resize(windows_.size());
}

// Estimates the window's velocity and depths, with the camera's rotation from `model`.
std::optional<WindowFit> JointFit::fitWindow(std::size_t k, const TurningModel& model,
                                             const WindowRates& rates) {
  const KeptSlopes::Window& window = *windows_[k];
  std::vector<EdgeRow> rows = edgeRows(window.slopes, input_.lens, window.begin_ns, options_);
  for (EdgeRow& row : rows) row.known_rate_rad_s = model.cameraRate_rad_s(rates.at(row.time_s));
  WindowFit fit(std::move(rows), options_, velocity_information_);
  if (!states_[k].log_nearness.empty()) {
    fit.startFrom(std::move(states_[k]), WindowUnknowns::Translation);
  } else if (!fit.start(WindowUnknowns::Translation)) {
    return std::nullopt;
  }
  fit.refine();
  states_[k] = fit.state();
  return fit;
}

void JointFit::findPart(std::size_t k, const AlignmentState& state) {
  const double begin_s = secondsSince(input_.start_ns, windows_[k]->begin_ns);
  const WindowRates rates(input_.rates, begin_s + state.time_offset_s, options_.window_s);
  const TurningModel model(state, input_.imu_from_measured);
  parts_[k] = {};
  parts_[k].middle_s = begin_s + 0.5 * options_.window_s;
  const std::optional<WindowFit> fit = fitWindow(k, model, rates);
  if (!fit) return;
  PatchedNormal<kJointNumbers + 3> normal;
  normal.begin(fit->state().log_nearness, options_.depth_spread);
  normal.expectNone(velocity_information_, fit->state().velocity_1_s);
  const double unit = 1.0 / (fit->scale() * fit->scale());
  for (const EdgeRow& row : fit->rows()) {
    const auto [residual, nearness] = fit->seen(row);
    Eigen::Matrix<double, kJointNumbers + 3, 1> j;
    j << model.derivative(rates.at(row.time_s), rates.change_rad_s2(),
                          row.by_rotation.transpose() * residual.by_flow),
        nearness * (row.by_translation.transpose() * residual.by_flow);
    const double weight = fit->weightOf(residual);
    // Without translation, residuals are large, and curvatures would be negative.
    normal.add(unit * (still_ ? weight : fit->curvatureOf(residual)), unit * weight * residual.value, j,
               row.patch, residual.translational.dot(residual.by_flow));
  }
  const auto [all, right] = normal.reduced();
  const Eigen::Matrix3d velocity = all.bottomRightCorner<3, 3>() + 1e-9 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix<double, 3, kJointNumbers> shared =
      velocity.ldlt().solve(all.bottomLeftCorner<3, kJointNumbers>());
  parts_[k].normal =
      all.topLeftCorner<kJointNumbers, kJointNumbers>() - all.topRightCorner<kJointNumbers, 3>() * shared;
  parts_[k].right = right.head<kJointNumbers>() - shared.transpose() * right.tail<3>();
}

// Sets the prior that velocities are as large as those of all windows. If the rig does not translate, common
// errors of the slopes, which many edges do not average out, would otherwise be explained by velocity and
// bias the rotation.
void JointFit::expectVelocities() {
  if (still_) return;
  double squares = 0.0;
  for (const WindowState& state : states_) squares += state.velocity_1_s.squaredNorm() / 3.0;
  constexpr double kMin = 1e-8;
  const auto windows = static_cast<double>(std::max<std::size_t>(1, states_.size()));
  velocity_information_ = options_.velocity_weight / (squares / windows + kMin);
}

// Sum of all windows' parts, and the weak prior of lever_left.
JointVector JointFit::sumParts(const AlignmentState& state) {
  constexpr std::size_t kPartsATask = 8;
  inParallel(input_.threads, (windows_.size() + kPartsATask - 1) / kPartsATask, [&](std::size_t task) {
    input_.context.throwIfStopped();
    const std::size_t end = std::min((task + 1) * kPartsATask, windows_.size());
    for (std::size_t k = task * kPartsATask; k < end; ++k) findPart(k, state);
  });
  const double held = 1.0 / (options_.lever_sigma * options_.lever_sigma);
  JointVector right = JointVector::Zero();
  normal_.setZero();
  for (const Part& part : parts_) {
    normal_ += part.normal;
    right += part.right;
  }
  normal_.diagonal().tail<3>().array() += held;
  right.tail<3>() -= held * state.lever_left;
  return right;
}

bool JointFit::solve(AlignmentState& state, double from, double to) {
  constexpr int kIterations = 15;
  constexpr double kLargestTurn_rad = 0.2, kLargestDelay_s = 0.01;
  // Convergence limits in sigmas due to the noise of edges: for the results, and for the other numbers.
  constexpr double kDone = 0.1, kOthersDone = 1.0, kNearlyDone = 1.0;
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    input_.context.progress.stageProgress(from + (to - from) * iteration / kIterations);
    const JointVector right = sumParts(state);
    expectVelocities();
    const JointMatrix covariance = normal_.inverse();
    JointVector step = covariance * right;
    if (!step.allFinite()) return false;
    step *= std::min({1.0, kLargestTurn_rad / std::max(step.head<3>().norm(), 1e-12),
                      kLargestDelay_s / std::max(std::abs(step[3]), 1e-12)});
    take(step, state);
    if (!(state.scale > 0.0)) return false;
    const Eigen::Array<double, kJointNumbers, 1> sigmas =
        step.array().abs() / covariance.diagonal().array().max(1e-30).sqrt();
    last = sigmas.head<4>().maxCoeff();
    if (last < kDone && (sigmas < kOthersDone).all()) return true;
  }
  return last < kNearlyDone;
}

}  // namespace evical
