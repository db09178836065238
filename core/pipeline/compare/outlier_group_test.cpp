#include "core/pipeline/compare/outlier_group_test.h"

#include "core/numerics/change_test.h"
#include "core/numerics/chi_squared.h"
#include "core/numerics/dense.h"

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr double kMissed = 0.05;  // share of missed changes of the detectable size

// Tests with each group's numbers divided by its allowed drift, so that groups are comparable and the drift
// is a ball.
class SingleChanges {
 public:
  SingleChanges(const EstimatedChange& estimated, std::span<const ChangeGroup> groups, double false_alarms)
      : groups_(groups) {
    const auto tested = std::count_if(groups.begin(), groups.end(), [](const auto& g) { return g.tested; });
    false_alarms_ = false_alarms / static_cast<double>(std::max<std::ptrdiff_t>(1, tested));
    const Eigen::Index size = estimated.difference.size();
    to_size_ = Eigen::MatrixXd::Zero(size, size);
    for (const ChangeGroup& group : groups)
      to_size_.block(group.first, group.first, group.size, group.size) = group.to_size;
    difference_ = to_size_ * estimated.difference;
    covariance_ = congruence(to_size_, estimated.covariance);
  }

  // Test of one group, given the other groups that are not free.
  GroupTestResult test(std::size_t tested, const std::vector<bool>& free) const {
    const std::vector<Eigen::Index> kept = keptNumbers(tested, free);
    const auto count = static_cast<Eigen::Index>(kept.size());
    Eigen::VectorXd difference(count);
    Eigen::MatrixXd covariance(count, count);
    const Eigen::MatrixXd moving = movingCovariance(tested);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index a = kept[static_cast<std::size_t>(i)];
      difference[i] = difference_[a];
      for (Eigen::Index j = 0; j < count; ++j) {
        const Eigen::Index b = kept[static_cast<std::size_t>(j)];
        covariance(i, j) = covariance_(a, b) + moving(a, b);
      }
    }
    const auto first = std::find(kept.begin(), kept.end(), groups_[tested].first) - kept.begin();
    const BlockChange alone = ChangeDetector(difference, covariance).of({first, groups_[tested].size});
    return judged(groups_[tested], alone.step, alone.covariance);
  }

 private:
  std::vector<Eigen::Index> keptNumbers(std::size_t tested, const std::vector<bool>& free) const {
    std::vector<Eigen::Index> kept;
    for (std::size_t g = 0; g < groups_.size(); ++g)
      for (Eigen::Index k = 0; (g == tested || !free[g]) && k < groups_[g].size; ++k)
        kept.push_back(groups_[g].first + k);
    return kept;
  }

  Eigen::MatrixXd movingCovariance(std::size_t tested) const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(difference_.size(), difference_.size());
    for (std::size_t g = 0; g < groups_.size(); ++g)
      if (const ChangeGroup& group = groups_[g]; g != tested)
        all.block(group.first, group.first, group.size, group.size) =
            congruence(group.to_size, group.stable_covariance);
    return all;
  }

  // Distance in sigmas from the ball of allowed changes. If the truth is in the ball, it is at most the
  // distance of the estimate from the truth, whose square is chi-square distributed with the group's size. If
  // the truth is outside, the distance is at least that along the direction to the ball, so the power below
  // is a lower bound.
  GroupTestResult judged(const ChangeGroup& group, const Eigen::VectorXd& change,
                         const Eigen::MatrixXd& covariance) const {
    const SymmetricEigen eigen = symmetricEigen(covariance);
    const Eigen::VectorXd variances = eigen.values.cwiseMax(1e-30);
    const Eigen::VectorXd along = eigen.vectors.transpose() * change;
    GroupTestResult test;
    test.tested = true;
    test.sigmas = std::sqrt((along.cwiseAbs2().cwiseQuotient(variances)).sum());
    test.beyond = distanceFromBall(along, variances, group.allowed_drift);
    test.limit = std::sqrt(chiSquaredLimit(false_alarms_, static_cast<int>(group.size)));
    test.smallest_detectable_change =
        group.allowed_drift + (test.limit + normalLimit(kMissed)) * std::sqrt(variances.maxCoeff());
    const Eigen::MatrixXd from_size = inverseOf(group.to_size);
    test.change = from_size * change;
    test.covariance = congruence(from_size, covariance);
    return test;
  }

  // The nearest point of the ball, in sigmas, is point / (1 + multiplier * variance), elementwise.
  static double distanceFromBall(const Eigen::VectorXd& point, const Eigen::VectorXd& variances,
                                 double radius) {
    if (point.norm() <= radius) return 0.0;
    constexpr int kHalvings = 200;
    const auto nearest = [&](double multiplier) -> Eigen::VectorXd {
      return point.array() / (1.0 + multiplier * variances.array());
    };
    double low = 0.0, high = 1.0 / variances.minCoeff();
    while (nearest(high).norm() > radius && std::isfinite(high)) high *= 2.0;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (low + high);
      (nearest(middle).norm() > radius ? low : high) = middle;
    }
    const Eigen::VectorXd beyond = radius > 0.0 ? Eigen::VectorXd(point - nearest(high)) : point;
    return std::sqrt(beyond.cwiseAbs2().cwiseQuotient(variances).sum());
  }

  std::span<const ChangeGroup> groups_;
  double false_alarms_ = 0.0;
  Eigen::MatrixXd to_size_, covariance_;
  Eigen::VectorXd difference_;
};

}  // namespace

GroupTestResults testSingleChanges(const EstimatedChange& estimated, std::span<const ChangeGroup> groups,
                                   double false_alarms) {
  const SingleChanges changes(estimated, groups, false_alarms);
  GroupTestResults tests;
  tests.groups.resize(groups.size());
  // Groups that have changed give no information about the others.
  const std::vector<FoundChange> found = findChanges(groups.size(), [&](const std::vector<bool>& free) {
    std::vector<double> beyond(groups.size(), 0.0);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (!groups[g].tested) continue;
      const GroupTestResult& test = tests.groups[g] = changes.test(g, free);
      beyond[g] = test.beyond * test.beyond - test.limit * test.limit;
    }
    return beyond;
  });
  for (const FoundChange& each : found) tests.groups[each.block].changed = true;
  if (found.empty()) return tests;
  tests.max_changed = found.front().block;
  for (const std::size_t g : found.front().alternatives)
    if (!tests.groups[g].changed) tests.alternatives.push_back(g);
  return tests;
}

}  // namespace evical
