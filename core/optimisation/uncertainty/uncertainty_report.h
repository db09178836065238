// A covariance in the format of results: addresses, standard deviations and correlation of all numbers, and
// each quantity's own sigmas.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/optimisation/uncertainty/quantity_covariance.h"

namespace evical {

UncertaintyReport makeReport(const CalibrationInput& input, const QuantityCovariance& quantities);

}  // namespace evical
