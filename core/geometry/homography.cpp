#include "core/geometry/homography.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace evical {

std::optional<Eigen::Matrix3d> fitHomography(const std::vector<Eigen::Vector2d>& from,
                                             const std::vector<Eigen::Vector2d>& to) {
  const auto normaliser = [](const std::vector<Eigen::Vector2d>& points) {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : points) mean += p;
    mean /= static_cast<double>(points.size());
    double spread = 0.0;
    for (const Eigen::Vector2d& p : points) spread += (p - mean).squaredNorm();
    const double s = std::sqrt(2.0 * static_cast<double>(points.size()) / std::max(spread, 1e-30));
    return (Eigen::Matrix3d() << s, 0, -s * mean.x(), 0, s, -s * mean.y(), 0, 0, 1).finished();
  };
  if (from.size() < kMinForHomography) return std::nullopt;
  const Eigen::Matrix3d nf = normaliser(from), nt = normaliser(to);
  Eigen::Matrix<double, 9, 9> sums = Eigen::Matrix<double, 9, 9>::Zero();
  for (std::size_t k = 0; k < from.size(); ++k) {
    const Eigen::Vector3d f = nf * from[k].homogeneous();
    const Eigen::Vector2d t = (nt * to[k].homogeneous()).hnormalized();
    Eigen::Matrix<double, 2, 9> rows;
    rows << f.transpose(), Eigen::RowVector3d::Zero(), -t.x() * f.transpose(),  //
        Eigen::RowVector3d::Zero(), f.transpose(), -t.y() * f.transpose();
    sums += rows.transpose() * rows;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(sums);
  if (!(eigen.eigenvalues()(1) > 1e-9)) return std::nullopt;
  const Eigen::Matrix<double, 9, 1> v = eigen.eigenvectors().col(0);
  Eigen::Matrix3d h;
  h << v(0), v(1), v(2), v(3), v(4), v(5), v(6), v(7), v(8);
  h = nt.inverse() * h * nf;
  if (std::abs(h(2, 2)) < 1e-12) return std::nullopt;
  return h / h(2, 2);
}

}  // namespace evical
