// Detection of the few blocks of numbers that have changed between two estimates, or between the prior of a
// state and data (data snooping: W. Baarda, "A testing procedure for use in geodetic networks", 1968;
// docs/maths.md, 13 and 15.2).
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace evical {

// Numbers of a state that belong together.
struct StateBlock {
  Eigen::Index first = 0, size = 0;
};

struct BlockChange {
  Eigen::VectorXd step;        // if only this block has changed
  Eigen::MatrixXd covariance;  // of the step
  double chi_square = 0.0;     // reduction of chi squared by the step
  Eigen::Index rank = 0;       // number of its directions that the data constrain
};

class ChangeDetector {
 public:
  // Data with information H and score v (of the log likelihood, at a state of 0), compared with a prior of
  // mean 0 and covariance P. H may be singular.
  ChangeDetector(const Eigen::MatrixXd& information, const Eigen::VectorXd& score,
                 const Eigen::MatrixXd& covariance);
  // Difference of two estimates, with the sum of their covariances.
  ChangeDetector(const Eigen::VectorXd& difference, const Eigen::MatrixXd& covariance);

  BlockChange of(const StateBlock& block) const;
  // Largest sigma of any direction of the block; infinite if the data do not constrain a direction.
  double worstSigma(const StateBlock& block) const;

 private:
  Eigen::MatrixXd weight_;  // of a step
  Eigen::VectorXd pull_;
  bool regular_ = false;  // data constrain all directions
};

// Changed blocks, in order of the excess over their limit; each is tested with those before it estimated.
struct FoundChange {
  std::size_t block = 0;
  BlockChange change;
  std::vector<std::size_t> alternatives;  // blocks that explain it equally well, within three sigmas
};
// `beyond`: excess of each block's chi squared over its limit, with the given blocks free.
std::vector<FoundChange> findChanges(
    std::size_t blocks, const std::function<std::vector<double>(const std::vector<bool>& free)>& beyond);
std::vector<FoundChange> findChanges(const Eigen::MatrixXd& information, const Eigen::VectorXd& score,
                                     const Eigen::MatrixXd& covariance, std::span<const StateBlock> blocks,
                                     std::span<const double> limits);
// Limits of chi squared, one per block, all for the same false alarm probability.
std::vector<double> limitsFor(std::span<const StateBlock> blocks, double false_alarm_probability);

// The smallest change in the worst direction that is detected with a probability of 95 %.
double smallestDetectable(double worst_sigma, double limit);

}  // namespace evical
