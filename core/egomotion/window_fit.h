// The robust least squares of one window's edges; not for other folders. Unknown are rate and velocity of the camera, and the
// depths of the image's patches.
#pragma once

#include "core/egomotion/edge_row.h"
#include "core/egomotion/egomotion_options.h"
#include "core/egomotion/patched_normal.h"

#include <Eigen/Core>

#include <vector>

namespace evical {

struct WindowState {
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();    // in addition to the rows' known rates
  Eigen::Vector3d velocity_1_s = Eigen::Vector3d::Zero();  // by the mean depth
  std::vector<double> log_nearness;                        // by patch: of the mean depth by its own
};

enum class WindowUnknowns { Rotation, Translation, Both };

class WindowFit {
 public:
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  using Matrix6d = Eigen::Matrix<double, 6, 6>;

  // `velocity_information`: of a velocity of 0, in squares of sigmas of edges by (1/s)^2.
  WindowFit(std::vector<EdgeRow> rows, const EgomotionOptions& options, double velocity_information = 0.0);

  // Least squares of g . u - 1, robust: a start that needs none. False where it has no solution.
  bool start(WindowUnknowns unknowns);
  // From a state of before, such as an earlier refine() has left it.
  void startFrom(WindowState state, WindowUnknowns unknowns);
  // Gauss-Newton from there.
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
  double scale() const { return scale_; }  // of the residuals' values, robust

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
