// Which of several groups of numbers has changed between two estimates: change_test.h, with changes of each group that are
// allowed. docs/maths.md, 13.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace evical {

// A group of neighbouring numbers. Sizes are of its change in a unit that suits it: |to_size * change|.
struct ChangeGroup {
  Eigen::Index first = 0, size = 0;
  Eigen::MatrixXd to_size;            // square, regular
  double allowed_drift = 0.0;         // a size that is no change
  Eigen::MatrixXd stable_covariance;  // of how far it moves by itself while another one is tested
  bool tested = true;                 // else it only has its say on the others
};

// Both with everything that is estimated of the groups, in one order.
struct EstimatedChange {
  Eigen::VectorXd difference;  // now - before
  Eigen::MatrixXd covariance;  // of both estimates together
};

struct GroupTestResult {
  bool tested = false;
  Eigen::VectorXd change;      // of the group, had nothing else changed
  Eigen::MatrixXd covariance;  // of that
  double sigmas = 0.0;         // by the covariance
  double beyond = 0.0;         // the same, of what exceeds the allowed drift
  double limit = 0.0;          // that chance does not reach
  double smallest_detectable_change =
      0.0;  // the size that is found with a probability of 95 %, in whatever direction
  bool changed = false;
};

struct GroupTestResults {
  std::vector<GroupTestResult> groups;
  std::size_t most_changed = 0;           // where any has
  std::vector<std::size_t> alternatives;  // those that explain the recording as well as that one
};

// `false_alarms`: how often any group is called changed where none is.
GroupTestResults testSingleChanges(const EstimatedChange& estimated, std::span<const ChangeGroup> groups,
                                   double false_alarms);

}  // namespace evical
