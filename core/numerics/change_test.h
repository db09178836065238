// Which of several blocks of numbers has changed, if only few have: between two estimates, or between what was known of
// a state and what data say (data snooping: W. Baarda, "A testing procedure for use in geodetic networks", 1968;
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
  Eigen::VectorXd step;        // if this alone has changed
  Eigen::MatrixXd covariance;  // of it
  double chi_square = 0.0;     // that it explains
  Eigen::Index rank = 0;       // directions of it that data tell anything of
};

class ChangeDetector {
 public:
  // Data with information H and score v (of the log likelihood, at a state of 0) against a state that was 0 with
  // covariance P. H may be singular.
  ChangeDetector(const Eigen::MatrixXd& information, const Eigen::VectorXd& score,
                 const Eigen::MatrixXd& covariance);
  // Two estimates that differ by so much, with the covariance of both together.
  ChangeDetector(const Eigen::VectorXd& difference, const Eigen::MatrixXd& covariance);

  BlockChange of(const StateBlock& block) const;
  // Of data that cannot tell a direction at all: infinity.
  double worstSigma(const StateBlock& block) const;

 private:
  Eigen::MatrixXd weight_;  // of a step
  Eigen::VectorXd pull_;
  bool regular_ = false;  // data tell all directions
};

// Those that have changed, the one that goes furthest beyond its own limit first; each is tested with those before left
// free.
struct FoundChange {
  std::size_t block = 0;
  BlockChange change;
  std::vector<std::size_t> alternatives;  // blocks that explain it to within three sigmas as well
};
// `beyond`: by how much chi squared of each block is more than its limit, with those left free of which it is told.
std::vector<FoundChange> findChanges(
    std::size_t blocks, const std::function<std::vector<double>(const std::vector<bool>& free)>& beyond);
std::vector<FoundChange> findChanges(const Eigen::MatrixXd& information, const Eigen::VectorXd& score,
                                     const Eigen::MatrixXd& covariance, std::span<const StateBlock> blocks,
                                     std::span<const double> limits);
// Of chi squared, of blocks alike.
std::vector<double> limitsFor(std::span<const StateBlock> blocks, double false_alarm_probability);

// The smallest change in the worst direction that is found with 95 %.
double smallestDetectable(double worst_sigma, double limit);

}  // namespace evical
