// The results of several recordings of one rig beside each other, and as one: extrinsics, lenses, IMU intrinsics and
// the board are the rig's, while biases, gravity and time offsets are each recording's (docs/maths.md, 14).
#pragma once

#include "core/data/repeatability.h"
#include "core/pipeline/compare/combined_estimates.h"
#include "core/pipeline/compare/rig_quantities.h"
#include "core/report/result_yaml.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace evical {

// One recording's.
struct RecordedEstimate {
  std::shared_ptr<const CalibrationResult> result;
  Eigen::MatrixXd as_weighed;       // CalibrationRun::as_weighed; empty: not known, its covariance is taken
  std::vector<CameraKind> cameras;  // as those of the state
};

class RepeatedEstimates {
 public:
  // `recorded`: at least one, of sessions with the same sensors in the same order, of which `session` is one.
  RepeatedEstimates(const Session& session, std::vector<RecordedEstimate> recorded);

  // One recording against others, by what they have in common.
  EstimateDistance distance(std::size_t one, std::span<const std::size_t> others) const;

  // The solution of those that are chosen. What each has of its own is that of the last of them, as it follows from
  // what all say. Its status is Ok; it has no trajectory, and no residuals.
  CalibrationResult joint(std::span<const std::size_t> chosen) const;

  // Numbers of all, statistics and joint values of those that are chosen.
  std::vector<RepeatedQuantity> quantities(std::span<const std::size_t> chosen) const;

 private:
  struct Unknowns {
    const RigQuantity* quantity;
    Eigen::Index first;
  };

  void linearise(const CalibrationState& at);
  const CalibrationResult& resultOf(std::size_t recording) const { return *recorded_[recording].result; }
  Eigen::MatrixXd asWeighed(std::size_t recording) const;
  std::vector<Eigen::Index> columnsOf(std::size_t recording) const;
  CalibrationState moved(const Eigen::VectorXd& by, CalibrationState state) const;
  void fillStatistics(std::span<const std::size_t> chosen, const CalibrationResult& joint,
                      const RigQuantity& quantity, RepeatedQuantity& shown) const;
  double varyingSigma(std::size_t recording, const RigQuantity& quantity, std::size_t part) const;

  const Session& session_;
  std::vector<RecordedEstimate> recorded_;
  RigQuantities quantities_;
  std::vector<Unknowns> unknowns_;        // of the common ones that any recording estimates
  std::vector<QuantityAddress> columns_;  // of the unknowns
  CalibrationState at_;                   // where values are counted from
  std::optional<EstimateCombination> combination_;
  std::vector<std::vector<Eigen::Index>> told_;  // unknowns by recording
  std::vector<Eigen::VectorXd> varying_;         // as those: what sigmas say of how they vary
};

}  // namespace evical
