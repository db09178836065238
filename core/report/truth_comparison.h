// A result against the truth of a simulated recording: errors, and whether the reported sigmas are honest.
#pragma once

#include "core/report/result_yaml.h"

#include <string>
#include <vector>

namespace evical {

// estimate - truth; rotations as the vector Log(estimate * truth^-1), about the reference's axes.
struct QuantityError {
  std::string name;  // "left.rotation.x"
  std::string unit;
  double error = 0.0, sigma = 0.0;  // sigma 0: not estimated, or unknown

  double normalised() const { return sigma > 0.0 ? error / sigma : 0.0; }
};

struct CameraError {
  std::string name;
  double rotation_deg = 0.0, translation_mm = 0.0, time_offset_ms = 0.0;  // size of the error
};

struct TruthComparison {
  std::vector<QuantityError> quantities;
  std::vector<CameraError> cameras;
  double gravity_direction_deg = 0.0;

  double normalisedRms() const;  // of all quantities with a sigma
};

// Throws CalibrationError (BadInput) when the two name different sensors or references.
TruthComparison compareWithTruth(const NamedResult& result, const NamedResult& truth);

std::string comparisonTable(const TruthComparison& comparison);

}  // namespace evical
