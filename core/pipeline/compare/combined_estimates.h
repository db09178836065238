// Several estimates of the same unknowns as one: the sum of their normal equations, with what all of them were told
// beforehand counted once (docs/maths.md, 14). To first order the estimate that all their data have together.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace evical {

// What one recording says. Weight and covariance are with what it was told beforehand. They are no inverses of each
// other where errors are larger than they are weighed, or hang together.
struct PartialEstimate {
  std::vector<Eigen::Index> unknowns;  // that it tells, in ascending order
  Eigen::VectorXd value;               // of those
  Eigen::MatrixXd weight;              // its normal equations, reduced to these unknowns
  Eigen::MatrixXd covariance;
};

// Over all unknowns.
struct CommonKnowledge {
  Eigen::MatrixXd information;  // that every recording was told alike
  Eigen::VectorXd value;
  Eigen::MatrixXd moving;  // covariance of what unknowns move by themselves from one recording to the next
};

struct CombinedEstimate {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
};

// How far one estimate is from others.
struct EstimateDistance {
  double chi_square = 0.0;
  int freedom = 0;
};

class EstimateCombination {
 public:
  EstimateCombination(std::span<const PartialEstimate> estimates, CommonKnowledge known);

  // Of those that are named; unknowns that none of them tells stay as they are known, with huge sigmas.
  CombinedEstimate combine(std::span<const std::size_t> chosen) const;

  // All unknowns of the combination by those of one of the chosen.
  Eigen::MatrixXd gain(std::size_t one, std::span<const std::size_t> chosen) const;

  // Beyond what unknowns move by themselves. Errors of what both were told are the same, and do not count.
  EstimateDistance distance(std::size_t one, std::span<const std::size_t> others) const;

  // What one estimate's sigmas say of how it varies from recording to recording, by its own unknowns.
  Eigen::VectorXd varyingSigmas(std::size_t one) const;

 private:
  // Over all unknowns, without what was told.
  struct Measured {
    Eigen::MatrixXd information;
    Eigen::VectorXd vector;   // information * value, of the data alone
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

// The probability that chance makes a larger distance.
double probabilityBeyond(const EstimateDistance& distance);

}  // namespace evical
