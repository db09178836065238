// Robust least squares fit of one window's edges; internal to this folder. Unknown are the camera's rate and
// velocity, and the depths of the image's patches.
#pragma once

#include "core/egomotion/edge_row.h"
#include "core/egomotion/egomotion_options.h"
#include "core/egomotion/patched_normal.h"

#include <Eigen/Core>

#include <vector>

namespace evical {

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
