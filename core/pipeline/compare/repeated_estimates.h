// Results of several recordings of one rig, compared and combined: extrinsics, lenses, IMU intrinsics and the
// board belong to the rig; biases, gravity and time offsets to each recording (docs/maths.md, 14).
#pragma once

#include "core/data/assessment.h"
#include "core/pipeline/compare/combined_estimates.h"
#include "core/pipeline/compare/rig_quantities.h"
#include "core/report/result_yaml.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace evical {

// Result of one recording.
struct RecordedEstimate {
  std::shared_ptr<const CalibrationResult> result;
  Eigen::MatrixXd as_weighed;       // CalibrationRun::as_weighed; empty: unknown, its covariance is used
  std::vector<CameraKind> cameras;  // in the order of the state
};

class RepeatedEstimates {
 public:
  // `recorded`: at least one, from sessions with the same sensors in the same order; `session` is one of
  // them.
  RepeatedEstimates(const Session& session, std::vector<RecordedEstimate> recorded);

  // Distance of one recording from others, in their common quantities.
  EstimateDistance distance(std::size_t one, std::span<const std::size_t> others) const;

  // Joint solution of the chosen recordings. Values that belong to each recording are those of the last one,
  // updated by the joint solution. Its status is Ok; it has neither trajectory nor residuals.
  CalibrationResult joint(std::span<const std::size_t> chosen) const;

  // Numbers of all recordings, with statistics and joint values of the chosen ones.
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
  std::vector<Unknowns> unknowns_;        // common ones that any recording estimates
  std::vector<QuantityAddress> columns_;  // of the unknowns
  CalibrationState at_;                   // linearisation point
  std::optional<EstimateCombination> combination_;
  std::vector<std::vector<Eigen::Index>> estimated_;  // unknowns by recording
  std::vector<Eigen::VectorXd> varying_;              // in the same order: expected variation from sigmas
};

}  // namespace evical
