// Dense matrices of any size. Eigen's templates for these take seconds to compile in each source that uses
// them; here they are compiled once.
#pragma once

#include <Eigen/Core>

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

}  // namespace evical
