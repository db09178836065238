// Scores of stretches of time scatter as their information says where residuals are uncorrelated and the model holds.
#pragma once

#include "core/numerics/newey_west.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace evical {

// Scores come in stretches of the correlation time: weights that fall to zero over the next three see
// correlation over up to about that time in full.
inline constexpr std::size_t kScoreLags = 3;

inline Eigen::MatrixXd scoreScatter(const std::vector<Eigen::VectorXd>& scores, Eigen::Index size) {
  return neweyWestByLag(scores, size, kScoreLags);
}

// Their variance over what the information says, by its mean over the numbers; 1 where all is as stated.
inline double scatterRatio(const Eigen::MatrixXd& scatter, const Eigen::MatrixXd& information) {
  constexpr double kNone = 1e-300;
  return scatter.diagonal().cwiseQuotient(information.diagonal().cwiseMax(kNone)).mean();
}

}  // namespace evical
