// Test for groups of numbers that have changed between two estimates, like change_test.h, with an allowed
// drift of each group (docs/maths.md, 13).
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace evical {

// Group of consecutive numbers. The size of its change is |to_size * change|.
struct ChangeGroup {
  Eigen::Index first = 0, size = 0;
  Eigen::MatrixXd to_size;            // square and invertible
  double allowed_drift = 0.0;         // largest size that does not count as a change
  Eigen::MatrixXd stable_covariance;  // of its allowed drift while another group is tested
  bool tested = true;                 // if false, it only affects the test of others
};

// Both contain all estimated numbers of the groups, in the same order.
struct EstimatedChange {
  Eigen::VectorXd difference;  // now - before
  Eigen::MatrixXd covariance;  // of the difference
};

struct GroupTestResult {
  bool tested = false;
  Eigen::VectorXd change;      // of the group, if nothing else has changed
  Eigen::MatrixXd covariance;  // of `change`
  double sigmas = 0.0;         // size of the change in sigmas
  double beyond = 0.0;         // the same for the part that exceeds the allowed drift
  double limit = 0.0;          // critical value of `beyond`
  double smallest_detectable_change =
      0.0;  // size that is detected with a probability of 95 % in any direction
  bool changed = false;
};

struct GroupTestResults {
  std::vector<GroupTestResult> groups;
  std::size_t max_changed = 0;            // valid if any group has changed
  std::vector<std::size_t> alternatives;  // groups that explain the recording equally well
};

// `false_alarms`: probability that any group is reported as changed if none has.
GroupTestResults testSingleChanges(const EstimatedChange& estimated, std::span<const ChangeGroup> groups,
                                   double false_alarms);

}  // namespace evical
