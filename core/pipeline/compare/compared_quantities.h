// Two results of one rig as vectors with a covariance, by quantity, for a check.
#pragma once

#include "core/data/assessment.h"
#include "core/data/quantity.h"
#include "core/pipeline/compare/outlier_group_test.h"
#include "core/pipeline/session/calibration_options.h"
#include "core/report/result_yaml.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace evical {

// Relative size change of a paper sheet with humidity.
inline constexpr double kStableSheet = 2e-4;

struct ComparedQuantity {
  Finding shown;  // without the results of the tests
  // Derivatives of pixels at the image border of the affected camera, with respect to numbers in SI units.
  std::vector<Eigen::MatrixXd> at_edge;
};

struct ComparedQuantities {
  EstimatedChange change;  // in SI units
  std::vector<ChangeGroup> groups;
  std::vector<ComparedQuantity> quantities;  // in the order of the tested groups, which come first
  std::vector<std::string> not_told;         // "time offset of left": not estimated now
};

struct ComparedResults {
  const NamedResult& before;
  const NamedResult& now;
  bool same_board = true;
};

// Allowed drift of a quantity without a change of the rig, in SI units; for a lens in RMS pixels. Absent for
// biases, drifts and edge localisation biases, which each calibration estimates again.
std::optional<double> stabilityOf(const QuantityInfo& info, const CheckOptions& options);

// Covariance of a lens's first `count` intrinsics that moves its image by `rms_px`, isotropically.
Eigen::MatrixXd lensCovariance(const CameraIntrinsics& camera, Eigen::Index count, double rms_px);

// Compares sensors by name; all sensors of `now` must be in `before`.
ComparedQuantities compareQuantities(const ComparedResults& results, const CheckOptions& options);

// Finding of a quantity with the result of its group's test.
Finding testedQuantity(const ComparedQuantity& compared, const GroupTestResult& test,
                       const ChangeGroup& group);

}  // namespace evical
