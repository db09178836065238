// Combination of several estimates of the same unknowns: the sum of their normal equations, with common
// priors counted once (docs/maths.md, 14). To first order it equals the joint estimate from all their data.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace evical {

// Estimate from one recording. Weight and covariance include its priors. They are not inverses of each other
// if errors are larger than assumed, or correlated.
struct PartialEstimate {
  std::vector<Eigen::Index> unknowns;  // that it estimates, in ascending order
  Eigen::VectorXd value;               // of those
  Eigen::MatrixXd weight;              // its normal equations, reduced to these unknowns
  Eigen::MatrixXd covariance;
};

// Priors over all unknowns.
struct CommonKnowledge {
  Eigen::MatrixXd information;  // priors common to all recordings
  Eigen::VectorXd value;
  Eigen::MatrixXd moving;  // covariance of the allowed drift of unknowns between recordings
};

struct CombinedEstimate {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
};

// Distance of one estimate from others.
struct EstimateDistance {
  double chi_square = 0.0;
  int freedom = 0;
};

class EstimateCombination {
 public:
  EstimateCombination(std::span<const PartialEstimate> estimates, CommonKnowledge known);

  // Combination of the chosen estimates; unknowns that none of them estimates keep their priors, with huge
  // sigmas.
  CombinedEstimate combine(std::span<const std::size_t> chosen) const;

  // Derivative of the combination's unknowns with respect to those of one chosen estimate.
  Eigen::MatrixXd gain(std::size_t one, std::span<const std::size_t> chosen) const;

  // Distance beyond the allowed drift. Errors of common priors are equal and do not count.
  EstimateDistance distance(std::size_t one, std::span<const std::size_t> others) const;

  // Expected variation of one estimate between recordings from its sigmas, by its own unknowns.
  Eigen::VectorXd varyingSigmas(std::size_t one) const;

 private:
  // Information over all unknowns, without priors.
  struct Measured {
    Eigen::MatrixXd information;
    Eigen::VectorXd vector;   // information * value, from the data only
    Eigen::MatrixXd scatter;  // covariance of that vector
  };
  struct Solution {
    Eigen::MatrixXd inverse, scatter;
    Eigen::VectorXd vector;
  };
  Solution solve(std::span<const std::size_t> chosen) const;

  std::vector<PartialEstimate> estimates_;
  CommonKnowledge known_;
  std::vector<Measured> measured_;
};

// Probability of a larger distance by chance.
double probabilityBeyond(const EstimateDistance& distance);

}  // namespace evical
