// The calibrated quantities of a rig as a list, their types out of the way: what several recordings of it have in
// common, and what each has of its own. States list the same sensors in the same order.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/quantity.h"
#include "core/pipeline/session/check_options.h"
#include "core/pipeline/session/session.h"

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace evical {

enum class QuantityShare {
  Common,    // the rig's, or the board's: the same in all recordings
  Compared,  // each recording's, but worth looking at beside each other: time offsets
  Own        // biases, drifts, leads of edges
};

// What a session and its options tell of a quantity beforehand.
struct WeighedPrior {
  Eigen::MatrixXd information;
  std::function<Eigen::VectorXd(const CalibrationState& from)> value;  // as RigQuantity::difference
};

struct RigQuantity {
  std::string sensor;
  const QuantityInfo* info = nullptr;
  QuantityShare share = QuantityShare::Own;
  std::vector<QuantityPart> parts;
  std::vector<std::string> names;  // of the parts, as uncertainty reports have them

  // In SI units, as many as there are parts: numbers as states have them, and a - b as sigmas count it.
  std::function<Eigen::VectorXd(const CalibrationState&)> numbers;
  std::function<Eigen::VectorXd(const CalibrationState& a, const CalibrationState& b)> difference;
  std::function<void(const Eigen::VectorXd& by, CalibrationState&)> move;
  std::function<void(const CalibrationState& from, CalibrationState& to)> copy;
  std::function<void(const Eigen::VectorXd& sigmas, UncertaintyReport&)> setSigmas;
  std::optional<WeighedPrior> prior;  // of common ones
  // Of common ones: covariance of what they move by themselves from one recording to the next (CheckOptions).
  std::function<Eigen::MatrixXd(const CalibrationState& at)> moving;
};

// Of all sensors, and of how the boards are: what a lens has of coefficients is as `state` has it.
std::vector<RigQuantity> rigQuantities(const Session& session, const CalibrationState& state);

}  // namespace evical
