#include "core/intrinsics/bundle.h"

#include "core/geometry/sphere_lens.h"
#include "core/intrinsics/circle_centre_cost.h"
#include "core/intrinsics/sensor_views.h"
#include "core/numerics/robust.h"
#include "core/numerics/solver_stop.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace evical {
namespace {

constexpr double kMinScale = 1e-3;

// Prior of the edge localisation bias, with mean 0.
class LeadPrior final : public ceres::SizedCostFunction<1, 1> {
 public:
  explicit LeadPrior(double sigma_px) : weight_(1.0 / sigma_px) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    residuals[0] = weight_ * *parameters[0];
    if (jacobians && jacobians[0]) jacobians[0][0] = weight_;
    return true;
  }

 private:
  double weight_;
};

class Adjustment {
 public:
  Adjustment(const CameraIntrinsics& start, const std::vector<SensorView>& views, const Board& board,
             const IntrinsicsOptions& options, const RunContext& context)
      : board_(board), options_(options), context_(context) {
    bundle_.intrinsics = start;
    bundle_.radius_m = board.radius_m;
    bundle_.views = views;
    for (SensorView& view : bundle_.views) {
      const auto pose = boardPose(view, board, start);
      bundle_.poses.push_back(pose.value_or(RigidTransform{}));
      if (!pose) drop(view);
    }
  }

  Bundle run() {
    updateWeights();
    adjust();
    // A wide lens starts with large errors; views with wrong initial poses were dropped, and get a second
    // chance.
    if (isSphereModel(bundle_.intrinsics.model) && placeDroppedViews()) {
      updateWeights();
      adjust();
    }
    return std::move(bundle_);
  }

 private:
  void adjust() {
    constexpr int kMaxRounds = 8;
    for (int round = 0; round < kMaxRounds; ++round) {
      solve();
      if (!updateWeights()) break;
    }
  }

  // Restores dropped views with the estimated intrinsics; true if there were any.
  bool placeDroppedViews() {
    bool any = false;
    for (std::size_t v = 0; v < bundle_.views.size(); ++v) {
      SensorView view = bundle_.views[v];
      if (std::any_of(view.circles.begin(), view.circles.end(), [](const auto& c) { return c.used; }))
        continue;
      for (SensorCircle& circle : view.circles) circle.used = true;
      const auto pose = boardPose(view, board_, bundle_.intrinsics);
      if (!pose) continue;
      bundle_.poses[v] = *pose;
      any = true;
    }
    return any;
  }

  static void drop(SensorView& view) {
    for (SensorCircle& circle : view.circles) circle.used = false;
  }

  // Squared errors in units of their sigmas, by view and circle.
  std::vector<std::vector<double>> errors() const {
    std::array<double, 9> intrinsics{};
    writeIntrinsics(bundle_.intrinsics, intrinsics.data());
    std::vector<std::vector<double>> all;
    for (std::size_t v = 0; v < bundle_.views.size(); ++v) {
      auto& of_view = all.emplace_back();
      std::array<double, kPoseBlock> pose{};
      writePose(bundle_.poses[v], pose.data());
      const std::array<const double*, 3> blocks = {intrinsics.data(), &bundle_.edge_localisation_bias_px,
                                                   pose.data()};
      for (const SensorCircle& circle : bundle_.views[v].circles) {
        Eigen::Vector2d residual;
        CircleCentreCost(bundle_.intrinsics.model, circle, board_.radius_m, 1.0)
            .Evaluate(blocks.data(), residual.data(), nullptr);
        const double squares = residual.squaredNorm();
        of_view.push_back(circle.only_known ? asOfTwoDirections(squares) : squares);
      }
    }
    return all;
  }

  // True if weights or outliers changed enough to solve again.
  bool updateWeights() {
    const std::vector<std::vector<double>> normalised2 = errors();
    const double before = bundle_.scale;
    bundle_.scale = std::max(scaleOf(normalised2), kMinScale);
    constexpr double kNoticeable = 0.02;
    bool changed = std::abs(bundle_.scale / before - 1.0) > kNoticeable;
    const double bound2 = std::pow(options_.outlier_sigma * bundle_.scale, 2);
    for (std::size_t v = 0; v < bundle_.views.size(); ++v) {
      SensorView& view = bundle_.views[v];
      const auto far = std::count_if(normalised2[v].begin(), normalised2[v].end(),
                                     [&](double error2) { return !(error2 <= bound2); });
      const bool all = static_cast<double>(far) >
                       options_.outlier_view_fraction * static_cast<double>(view.circles.size());
      for (std::size_t i = 0; i < view.circles.size(); ++i) {
        const bool use = !all && normalised2[v][i] <= bound2;
        changed = changed || use != view.circles[i].used;
        view.circles[i].used = use;
      }
    }
    return changed;
  }

  static double scaleOf(const std::vector<std::vector<double>>& normalised2) {
    std::vector<double> all;
    for (const std::vector<double>& of_view : normalised2)
      all.insert(all.end(), of_view.begin(), of_view.end());
    return scaleOfPoints(std::move(all));
  }

  void solve() {
    std::array<double, 9> intrinsics{};
    writeIntrinsics(bundle_.intrinsics, intrinsics.data());
    std::vector<std::array<double, kPoseBlock>> poses(bundle_.poses.size());
    ceres::Problem problem;
    addBlocks(problem, intrinsics, poses);
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_SCHUR;
    solver.max_num_iterations = options_.max_iterations;
    solver.function_tolerance = 1e-9;
    solver.gradient_tolerance = 1e-12;
    solver.parameter_tolerance = 1e-12;
    solver.logging_type = ceres::SILENT;
    const std::unique_ptr<ceres::IterationCallback> stop = stopCallback(context_.stop);
    solver.callbacks.push_back(stop.get());
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    context_.throwIfStopped();
    bundle_.converged = summary.termination_type == ceres::CONVERGENCE;
    bundle_.intrinsics =
        intrinsicsFrom(intrinsics.data(), bundle_.intrinsics.model, bundle_.intrinsics.resolution_px);
    for (std::size_t v = 0; v < poses.size(); ++v) {
      if (problem.HasParameterBlock(poses[v].data())) bundle_.poses[v] = poseFrom(poses[v].data());
    }
  }

  void addBlocks(ceres::Problem& problem, std::array<double, 9>& intrinsics,
                 std::vector<std::array<double, kPoseBlock>>& poses) {
    std::vector<int> fixed;
    const FreeIntrinsics free = freeIntrinsics(bundle_.intrinsics.model, options_);
    for (std::size_t i = 0; i < free.size(); ++i)
      if (!free[i]) fixed.push_back(static_cast<int>(i));
    problem.AddParameterBlock(intrinsics.data(), 9,
                              fixed.empty() ? nullptr : new ceres::SubsetManifold(9, fixed));
    setBounds(problem, intrinsics);
    problem.AddResidualBlock(new LeadPrior(options_.edge_localisation_bias_sigma_px), nullptr,
                             &bundle_.edge_localisation_bias_px);
    for (std::size_t v = 0; v < bundle_.views.size(); ++v) {
      writePose(bundle_.poses[v], poses[v].data());
      for (const SensorCircle& circle : bundle_.views[v].circles) {
        if (!circle.used) continue;
        problem.AddResidualBlock(
            new CircleCentreCost(bundle_.intrinsics.model, circle, board_.radius_m, bundle_.scale),
            new ceres::HuberLoss(options_.huber_sigma), intrinsics.data(), &bundle_.edge_localisation_bias_px,
            poses[v].data());
      }
      if (problem.HasParameterBlock(poses[v].data())) problem.SetManifold(poses[v].data(), new PoseManifold);
    }
  }

  void setBounds(ceres::Problem& problem, std::array<double, 9>& intrinsics) {
    const IntrinsicsBounds bounds = intrinsicsBounds(bundle_.intrinsics.model);
    for (std::size_t i = 0; i < intrinsics.size(); ++i) {
      if (!std::isfinite(bounds.lower[i])) continue;
      intrinsics[i] = std::clamp(intrinsics[i], bounds.lower[i], bounds.upper[i]);
      problem.SetParameterLowerBound(intrinsics.data(), static_cast<int>(i), bounds.lower[i]);
      problem.SetParameterUpperBound(intrinsics.data(), static_cast<int>(i), bounds.upper[i]);
    }
  }

  const Board& board_;
  const IntrinsicsOptions& options_;
  const RunContext& context_;
  Bundle bundle_;
};

}  // namespace

FreeIntrinsics freeIntrinsics(CameraModel model, const IntrinsicsOptions& options) {
  FreeIntrinsics free{};
  const int coefficients =
      model == CameraModel::PinholeRadtan ? options.radtan_coefficients : coefficientCount(model);
  std::fill_n(free.begin(), 4 + coefficients, true);
  return free;
}

Eigen::Vector2d Bundle::error_px(std::size_t view, const SensorCircle& circle) const {
  std::array<double, 9> block{};
  writeIntrinsics(intrinsics, block.data());
  std::array<double, kPoseBlock> pose{};
  writePose(poses[view], pose.data());
  const std::array<const double*, 3> blocks = {block.data(), &edge_localisation_bias_px, pose.data()};
  SensorCircle unweighted = circle;
  unweighted.covariance_px2.setIdentity();
  Eigen::Vector2d error;
  CircleCentreCost(intrinsics.model, unweighted, radius_m, 1.0)
      .Evaluate(blocks.data(), error.data(), nullptr);
  if (circle.only_known) error = circle.only_known->dot(error) * *circle.only_known;
  return error;
}

int Bundle::circlesUsed() const {
  std::ptrdiff_t count = 0;
  for (const SensorView& view : views)
    count += std::count_if(view.circles.begin(), view.circles.end(), [](const auto& c) { return c.used; });
  return static_cast<int>(count);
}

int Bundle::viewsUsed() const {
  return static_cast<int>(std::count_if(views.begin(), views.end(), [](const SensorView& view) {
    return std::any_of(view.circles.begin(), view.circles.end(), [](const auto& c) { return c.used; });
  }));
}

Bundle solveBundle(const CameraIntrinsics& start, const std::vector<SensorView>& views, const Board& board,
                   const IntrinsicsOptions& options, const RunContext& context) {
  return Adjustment(start, views, board, options, context).run();
}

}  // namespace evical
