// Which part of a state has changed between what was known of it and what data say: docs/maths.md, 15.2.
#pragma once

#include <Eigen/Core>

#include <cstddef>
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

// Data with information H and score v (of the log likelihood, at a state of 0) against a state that was 0 with
// covariance P.
class ChangeDetector {
 public:
  ChangeDetector(const Eigen::MatrixXd& information, const Eigen::VectorXd& score,
                 const Eigen::MatrixXd& covariance);

  BlockChange of(const StateBlock& block) const;
  // Of data that cannot tell a direction at all: infinity.
  double worstSigma(const StateBlock& block) const;

 private:
  Eigen::MatrixXd weight_;  // of a step
  Eigen::VectorXd pull_;
};

// Those that have changed beyond their limits of chi squared, the one that goes furthest beyond its own first; each is tested with
// those before left free.
struct FoundChange {
  std::size_t block = 0;
  BlockChange change;
  std::vector<std::size_t> or_else;  // blocks that explain it to within three sigmas as well
};
std::vector<FoundChange> findChanges(const Eigen::MatrixXd& information, const Eigen::VectorXd& score,
                                     const Eigen::MatrixXd& covariance, std::span<const StateBlock> blocks,
                                     std::span<const double> limits);
// Of blocks alike.
std::vector<double> limitsFor(std::span<const StateBlock> blocks, double false_alarm_probability);

// The smallest change in the worst direction that is found with 95 %.
double wouldNotice(double worst_sigma, double limit);

}  // namespace evical
