// The calibrated quantities of a rig as a list, their types out of the way: what several recordings of it have in
// common, and what each has of its own. States list the same sensors in the same order.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/quantity.h"
#include "core/pipeline/session/check_options.h"
#include "core/pipeline/session/session.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace evical {

enum class QuantityShare {
  Common,    // the rig's, or the board's: the same in all recordings
  Compared,  // each recording's, but worth looking at beside each other: time offsets
  Own        // biases, drifts, leads of edges
};

// Numbers are in SI units, as many as there are parts.
struct RigQuantity {
  std::string sensor;
  const QuantityInfo* info = nullptr;
  QuantityAddress first;  // its first number's
  std::vector<QuantityPart> parts;
  QuantityShare share = QuantityShare::Own;
  double stability = 0.0;  // as stabilityOf: of each number; of a lens RMS pixels
  // What a session and its options tell of a common one beforehand, around what RigQuantities::prior_means has. Empty:
  // nothing.
  Eigen::MatrixXd prior_information = {};

  Eigen::Index size() const { return static_cast<Eigen::Index>(parts.size()); }
  QuantityAddress address(std::size_t part) const;
  Eigen::VectorXd numbers(const CalibrationState& state) const;  // as it has them
  Eigen::VectorXd difference(const CalibrationState& a,
                             const CalibrationState& b) const;  // as sigmas count it
  void move(const Eigen::VectorXd& by, CalibrationState& state) const;
  void copy(const CalibrationState& from, CalibrationState& to) const;
  // Covariance of its motion between recordings, by its stability.
  Eigen::MatrixXd moving(const CalibrationState& at) const;
};

struct RigQuantities {
  // Of all sensors, and of how the boards are: what a lens has of coefficients is as `state` has it.
  RigQuantities(const Session& session, const CalibrationState& state);

  std::vector<RigQuantity> all;
  CalibrationState prior_means;
};

}  // namespace evical
