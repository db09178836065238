// Displacement of the circles of an event window that its covariances do not contain: pixels remember the
// earlier motion, and neighbouring circles have the same history. So their errors agree, less so with
// distance on the board.
//
// The displacement of a view is a Gaussian field over the board. In units of the circles' own sigmas, its
// covariance is
//   rho_i rho_j k(|p_i - p_j|),   k(d) = c + (1 - c) exp(-d^2 / (2 l^2)),
// p the circles' places on the board, in spacings, and rho_i the field's sigma (displacementSigma_px) over
// the circle's own. It is marginalised in closed form. In whitened coordinates the errors of a view have the
// covariance (I + B B^T) of each of their two directions, B = diag(rho) F, where k(|p_i - p_j|) = F F^T has
// few columns (FieldModes). Residuals and Jacobians of the view are multiplied by
//   (I + B B^T)^(-1/2) = I + B G B^T,  G = V diag((1 / sqrt(1 + l) - 1) / l) V^T,  V diag(l) V^T = B^T B.
#pragma once

#include "core/data/board_observations.h"
#include "core/geometry/board.h"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace evical {

struct ModelOptions;

// The field's sigma per axis, ideal pixels. 0 for cameras that are not event cameras.
double displacementSigma_px(CameraKind kind, const CircleObservation& circle, const ModelOptions& options);

// k, of a distance in spacings.
double fieldCovariance(double distance_spacings, const ModelOptions& options);

// F: a row for each point of the board. Its columns leave at most displacement_remainder of the variance of a
// point, except on boards that need more than 32 of them.
using FieldModes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
FieldModes fieldModes(const Board& board, const ModelOptions& options);

// Such an F with more columns, which leave a hundredth: what the modes leave would count as errors of the
// circles.
FieldModes fieldRoot(const Board& board, const ModelOptions& options);

class DisplacementField {
 public:
  struct Circle {
    int point = 0;     // of the board
    double rho = 0.0;  // the field's sigma over the circle's
  };
  DisplacementField() = default;  // none
  DisplacementField(const FieldModes& modes, std::span<const Circle> circles);

  // Multiplies the view's rows, two for each circle, of a row-major matrix of so many columns by (I + B
  // B^T)^(-1/2).
  void whiten(double* matrix, Eigen::Index columns) const;

 private:
  FieldModes by_circle_;   // B
  Eigen::MatrixXd gains_;  // G
};

// Size of a camera's fields in their expected sigmas: the most probable one for errors of many views, by
// restricted likelihood. What a motion of the camera explains is removed, since the trajectory follows the
// errors.
class FieldSize {
 public:
  struct Circle {
    DisplacementField::Circle displaced;
    Eigen::Vector2d centre_px, error_sigmas;  // whitened by the circle's own covariance
    Eigen::Matrix2d whitening_px;             // L^-1
  };
  // `prior_sigma`: of the size's logarithm.
  FieldSize(const FieldModes& root, double prior_sigma) : root_(root), prior_sigma_(prior_sigma) {}

  void add(std::span<const Circle> view);
  double mostProbable() const;  // 1 without views

 private:
  void addSeparated(const Eigen::MatrixXd& left);
  double misfit(double size) const;

  const FieldModes& root_;
  double prior_sigma_;
  struct Products {  // of a view's modes: tridiagonal, and with the errors (b)
    Eigen::VectorXd diagonal, below, with_errors;
  };
  std::vector<Products> views_;
  double squares_ = 0.0, count_ = 0.0;  // of all errors: sum of squares, and numbers
};

}  // namespace evical
