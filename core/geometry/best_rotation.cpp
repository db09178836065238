#include "core/geometry/best_rotation.h"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace evical {

BestRotation bestRotation(const Eigen::Matrix3d& sum_of_products, double determinant) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum_of_products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d free = svd.matrixU() * svd.matrixV().transpose();
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (free.determinant() * determinant < 0.0) signs[2] = -1.0;
  return {svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose(), svd.singularValues(),
          svd.matrixU().col(0)};
}

}  // namespace evical
