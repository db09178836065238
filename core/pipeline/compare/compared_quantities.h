// Two results of one rig as two vectors with a covariance, quantity by quantity: what a check compares.
#pragma once

#include "core/data/assessment.h"
#include "core/data/quantity.h"
#include "core/pipeline/compare/outlier_group_test.h"
#include "core/pipeline/session/check_options.h"
#include "core/report/result_yaml.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace evical {

// What damp paper does to a sheet, relative.
inline constexpr double kStableSheet = 2e-4;

struct ComparedQuantity {
  Finding shown;  // but for what the tests say
  // Of the camera whose pixels its numbers move, at the image's border: pixels by numbers in SI units.
  std::vector<Eigen::MatrixXd> at_edge;
};

struct ComparedQuantities {
  EstimatedChange change;  // in SI units
  std::vector<ChangeGroup> groups;
  std::vector<ComparedQuantity> quantities;  // as the groups that are tested, which come first
  std::vector<std::string> not_told;         // "time offset of left": not estimated now
};

struct ComparedResults {
  const NamedResult& before;
  const NamedResult& now;
  bool same_board = true;
};

// How much a quantity may move without a change of the rig, in SI units; of a lens in RMS pixels. Empty for biases,
// drifts and edge leads, which every calibration estimates anew.
std::optional<double> stabilityOf(const QuantityInfo& info, const CheckOptions& options);

// Of a lens's first `count` intrinsics that move its image by so much, by RMS, in no direction more than in others.
Eigen::MatrixXd lensCovariance(const CameraIntrinsics& camera, Eigen::Index count, double rms_px);

// Sensors of both, by name; of `now` all are in `before`.
ComparedQuantities compareQuantities(const ComparedResults& results, const CheckOptions& options);

// With what the test of its group says.
Finding testedQuantity(const ComparedQuantity& compared, const GroupTestResult& test,
                       const ChangeGroup& group);

}  // namespace evical
