// Rotation that best maps source directions to target directions: W. Kabsch, "A solution for the best
// rotation to relate two sets of vectors", 1976.
#pragma once

#include <Eigen/Core>

namespace evical {

struct BestRotation {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();  // target_from_source
  Eigen::Vector3d strengths;                             // singular values, the largest first
  Eigen::Vector3d main_axis;  // of the largest singular value, in the target's frame
};

// Rotation for the sum of weight * target * source^T over all pairs; with determinant -1 the best reflection.
BestRotation bestRotation(const Eigen::Matrix3d& sum_of_products, double determinant = 1.0);

}  // namespace evical
