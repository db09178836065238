// Comparison of a result with the truth of a simulated recording: errors, and consistency of the sigmas.
#pragma once

#include "core/data/quantity_difference.h"
#include "core/report/result_yaml.h"

#include <string>
#include <vector>

namespace evical {

struct CameraError {
  std::string name;
  double rotation_deg = 0.0, translation_mm = 0.0, time_offset_ms = 0.0;  // size of the error
};

struct TruthComparison {
  std::vector<QuantityDifference> quantities;
  std::vector<CameraError> cameras;
  double gravity_direction_deg = 0.0;
  std::vector<std::string> notes = {};  // sensors with different names that were compared

  double normalisedRms() const { return evical::normalisedRms(quantities); }
};

// Compared quantities of a result.
Estimate estimateOf(const NamedResult& named);

// Compares sensors by name; the only camera and the only IMU of both, with any names. Throws CalibrationError
// (BadInput) when the two name different sensors or references.
TruthComparison compareWithTruth(const NamedResult& result, const NamedResult& truth);

std::string comparisonTable(const TruthComparison& comparison);

}  // namespace evical
