// Calibrated quantities of a rig as a list independent of their types: those common to several recordings,
// and those of each recording. States list the same sensors in the same order.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/quantity.h"
#include "core/pipeline/session/calibration_options.h"
#include "core/pipeline/session/session.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace evical {

enum class QuantityShare {
  Common,    // the rig's, or the board's: the same in all recordings
  Compared,  // separate for each recording, but compared: time offsets
  Own        // biases, drifts, edge localisation biases
};

// Numbers are in SI units, one for each part.
struct RigQuantity {
  std::string sensor;
  const QuantityInfo* info = nullptr;
  QuantityAddress first;  // address of its first number
  std::vector<QuantityPart> parts;
  QuantityShare share = QuantityShare::Own;
  double stability = 0.0;  // see stabilityOf; of each number, for a lens in RMS pixels
  // Prior information of a common quantity from session and options, with the mean in
  // RigQuantities::prior_means. Empty: no prior.
  Eigen::MatrixXd prior_information = {};

  Eigen::Index size() const { return static_cast<Eigen::Index>(parts.size()); }
  QuantityAddress address(std::size_t part) const;
  Eigen::VectorXd numbers(const CalibrationState& state) const;  // values in the state
  Eigen::VectorXd difference(const CalibrationState& a,
                             const CalibrationState& b) const;  // in the coordinates of the sigmas
  void move(const Eigen::VectorXd& by, CalibrationState& state) const;
  void copy(const CalibrationState& from, CalibrationState& to) const;
  // Covariance of its drift between recordings, from its stability.
  Eigen::MatrixXd moving(const CalibrationState& at) const;
};

struct RigQuantities {
  // Quantities of all sensors and boards; the number of lens coefficients is that of `state`.
  RigQuantities(const Session& session, const CalibrationState& state);

  std::vector<RigQuantity> all;
  CalibrationState prior_means;
};

}  // namespace evical
