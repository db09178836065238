// Robust least squares fit of one window's edges; internal to this folder. Unknown are the camera's rate and
// velocity, and the depths of the image's patches.
#pragma once

#include "core/egomotion/egomotion_options.h"
#include "core/egomotion/lens_rays.h"

#include "core/data/edge_slope.h"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace evical {

// One edge's equation for a camera's motion (docs/maths.md, 16.2): g . (A w + B v / Z) = 1. Internal to this
// folder.

using ImageMotion = Eigen::Matrix<double, 2, 3>;  // d(image velocity) / d(angular or linear velocity)

// Image motion of a point at rest, for a camera with angular velocity w and velocity v in its own frame: the
// point has the velocity -v - w x P in it.
ImageMotion rotationalMotion(const Eigen::Vector2d& place);
ImageMotion translationalMotion(const Eigen::Vector2d& place);  // at depth 1

struct EdgeRow {
  Eigen::Vector2d slope;     // s by place
  Eigen::Matrix2d variance;  // of the slope
  std::size_t patch = 0;
  double time_s = 0.0;          // since the window's begin
  double depth_variance = 0.0;  // of g . u, from depths that differ within the patch
  ImageMotion by_rotation, by_translation;
  Eigen::Vector3d known_rate_rad_s = Eigen::Vector3d::Zero();  // of the camera, in addition to the fitted one
};

// Every second, third ... slope if a window has more than options.max_slopes. Those outside the lens's view
// are omitted.
std::vector<EdgeRow> edgeRows(std::span<const EdgeSlope> slopes, const LensRays& lens, std::int64_t begin_ns,
                              const EgomotionOptions& options);

// (g . u - 1) / sqrt(u' V u): difference between the slope along the motion and one over the speed, in
// sigmas. Divided by the effect of the slope's noise on u, it has no bias from noise in g (total least
// squares).
struct EdgeResidual {
  double value = 0.0;
  double error = 0.0;  // g . u - 1
  Eigen::Vector2d by_flow = Eigen::Vector2d::Zero();
  Eigen::Vector2d translational = Eigen::Vector2d::Zero();  // part of the flow
};
EdgeResidual edgeResidual(const EdgeRow& row, const Eigen::Vector3d& rate_rad_s,
                          const Eigen::Vector3d& velocity_1_s);  // by this row's depth

// Normal equations of N numbers and of one depth per patch of the image; no equation contains two depths, so
// each depth is eliminated separately. Internal to this folder.
template <int N>
class PatchedNormal {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  // Depths are logarithms with prior 0 and sigma `spread`.
  void begin(const std::vector<double>& log_nearness, double spread) {
    normal_.setZero();
    right_.setZero();
    const double prior = prior_ = 1.0 / (spread * spread);
    cross_.assign(log_nearness.size(), Vector::Zero());
    depth_normal_.assign(log_nearness.size(), prior);
    depth_right_.resize(log_nearness.size());
    for (std::size_t k = 0; k < log_nearness.size(); ++k) depth_right_[k] = -prior * log_nearness[k];
  }

  // Adds an error with gradient `pull` and second derivative `curvature` of its cost; with its derivatives by
  // the numbers and by the depth of its patch.
  void add(double curvature, double pull, const Vector& by_numbers, std::size_t patch, double by_depth) {
    normal_.template selfadjointView<Eigen::Lower>().rankUpdate(by_numbers, curvature);
    right_ -= pull * by_numbers;
    cross_[patch] += curvature * by_depth * by_numbers;
    depth_normal_[patch] += curvature * by_depth * by_depth;
    depth_right_[patch] -= pull * by_depth;
  }

  // Adds a prior of 0 for the last three numbers, with this information.
  void expectNone(double information, const Eigen::Vector3d& value) {
    normal_.diagonal().template tail<3>().array() += information;
    right_.template tail<3>() -= information * value;
  }

  struct Reduced {
    Matrix normal;
    Vector right;
  };
  Reduced reduced(double damping = 0.0) const {
    Reduced out{normal_.template selfadjointView<Eigen::Lower>(), right_};
    for (std::size_t k = 0; k < cross_.size(); ++k) {
      const double own = std::max(depth_normal_[k], prior_) * (1.0 + damping);
      out.normal -= cross_[k] * cross_[k].transpose() / own;
      out.right -= cross_[k] * depth_right_[k] / own;
    }
    return out;
  }
  Vector diagonal() const { return normal_.diagonal(); }

  // Updates the depths for a change of the numbers by `step`, by at most a factor of e.
  void moveDepths(const Vector& step, double damping, std::vector<double>& log_nearness) const {
    for (std::size_t k = 0; k < log_nearness.size(); ++k) {
      const double own = std::max(depth_normal_[k], prior_) * (1.0 + damping);
      log_nearness[k] += std::clamp((depth_right_[k] - cross_[k].dot(step)) / own, -1.0, 1.0);
    }
  }

 private:
  Matrix normal_ = Matrix::Zero();  // lower triangle
  Vector right_ = Vector::Zero();
  std::vector<Vector> cross_;
  std::vector<double> depth_normal_, depth_right_;
  double prior_ = 0.0;
};

struct WindowState {
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();    // in addition to the rows' known rates
  Eigen::Vector3d velocity_1_s = Eigen::Vector3d::Zero();  // in mean depths per second
  std::vector<double> log_nearness;  // by patch: log of the mean depth over the patch's depth
};

enum class WindowUnknowns { Rotation, Translation, Both };

class WindowFit {
 public:
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  using Matrix6d = Eigen::Matrix<double, 6, 6>;

  // `velocity_information`: information of the prior velocity 0, for edges of unit sigma and in (1/s)^-2.
  WindowFit(std::vector<EdgeRow> rows, const EgomotionOptions& options, double velocity_information = 0.0);

  // Robust least squares of g . u - 1, which needs no start value. False if it has no solution.
  bool start(WindowUnknowns unknowns);
  // Starts from an earlier state, such as the result of refine().
  void startFrom(WindowState state, WindowUnknowns unknowns);
  // Gauss-Newton from the start.
  void refine();

  const WindowState& state() const { return state_; }
  const std::vector<EdgeRow>& rows() const { return rows_; }

  struct Seen {
    EdgeResidual residual;
    double nearness = 1.0;
  };
  Seen seen(const EdgeRow& row) const { return seenAs(row, state_); }
  double weightOf(const EdgeResidual& residual) const;  // 1 at 0
  // Change of the weighted residual with the residual: the weight, minus the weight's own change. Below 0 for
  // large residuals.
  double curvatureOf(const EdgeResidual& residual) const;
  double scale() const { return scale_; }  // robust scale of the residuals' values

  // With the depths eliminated; slopes that share their neighbourhood count little more than one.
  Matrix6d covariance(double shared) const;
  double inlierShare() const;
  double medianSquare() const;

 private:
  static Seen seenAs(const EdgeRow& row, const WindowState& state);
  Vector6d held(double size) const;  // added to the diagonal of fixed numbers
  void rescale();
  double costOf(const WindowState& state) const;
  void build();
  WindowState stepped(double damping) const;

  std::vector<EdgeRow> rows_;
  const EgomotionOptions& options_;
  double velocity_information_;
  WindowUnknowns unknowns_ = WindowUnknowns::Both;
  WindowState state_;
  double scale_ = 1.0;
  PatchedNormal<6> normal_;
};

}  // namespace evical
