// Dense matrices of any size. Eigen's templates for these take seconds to compile in each source that uses
// them; here they are compiled once.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace evical {

struct SymmetricEigen {
  Eigen::VectorXd values;   // in ascending order
  Eigen::MatrixXd vectors;  // by column
};
SymmetricEigen symmetricEigen(const Eigen::MatrixXd& symmetric);  // reads the lower triangle

Eigen::MatrixXd inverseOf(const Eigen::MatrixXd& square);
Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::MatrixXd productTransposed(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);  // a b^T
Eigen::MatrixXd congruence(const Eigen::MatrixXd& a, const Eigen::MatrixXd& m);         // a m a^T

// Inverse of symmetric matrices whose columns have different units: scaled to a unit diagonal before
// factorisation.
class ScaledInverse {
 public:
  explicit ScaledInverse(const Eigen::MatrixXd& symmetric)
      : scale_(symmetric.diagonal().cwiseMax(kMinDiagonal).cwiseSqrt().cwiseInverse()),
        solver_(scale_.asDiagonal() * symmetric * scale_.asDiagonal()) {}

  Eigen::MatrixXd times(const Eigen::MatrixXd& right) const {
    return scale_.asDiagonal() * solver_.solve(scale_.asDiagonal() * right);
  }
  Eigen::VectorXd times(const Eigen::VectorXd& right) const {
    return scale_.cwiseProduct(solver_.solve(scale_.cwiseProduct(right)));
  }
  double sigma(Eigen::Index i) const {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(scale_.size(), i);
    return std::sqrt(std::max(0.0, times(unit)[i]));
  }

 private:
  static constexpr double kMinDiagonal = 1e-300;

  Eigen::VectorXd scale_;
  Eigen::LDLT<Eigen::MatrixXd> solver_;
};

}  // namespace evical

// Function attribute for tight numerical loops: a second version is compiled for processors of the last ten
// years, and selected at program start. Sums of the two versions differ in the last digit.

// Not with sanitizers: the selection runs before they are initialised.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define EVICAL_VECTOR_CLONES __attribute__((target_clones("arch=haswell", "default")))
#else
#define EVICAL_VECTOR_CLONES
#endif
