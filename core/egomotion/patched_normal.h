// Normal equations of N numbers and of one depth per patch of the image; no equation contains two depths, so
// each depth is eliminated separately. Internal to this folder.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace evical {

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

}  // namespace evical
