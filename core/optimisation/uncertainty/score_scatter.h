// Scatter of the scores of stretches of time; equal to their information for white residuals and a correct
// model.
#pragma once

#include "core/numerics/newey_west.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace evical {

// Scores are summed over stretches of one correlation time. Weights fall to zero over the next three
// stretches, so that correlations of up to about that time count in full.
inline constexpr std::size_t kScoreLags = 3;

inline Eigen::MatrixXd scoreScatter(const std::vector<Eigen::VectorXd>& scores, Eigen::Index size) {
  return neweyWestByLag(scores, size, kScoreLags);
}

// Ratio of their variance to the information, mean over the numbers; 1 if model and sigmas are correct.
inline double scatterRatio(const Eigen::MatrixXd& scatter, const Eigen::MatrixXd& information) {
  constexpr double kNone = 1e-300;
  return scatter.diagonal().cwiseQuotient(information.diagonal().cwiseMax(kNone)).mean();
}

}  // namespace evical
