// Comparison of a calibrated lens with another one of the same camera: parameters, and projections in the
// image.
#pragma once

#include "core/data/intrinsics_result.h"
#include "core/format/intrinsics_yaml.h"

#include <array>
#include <optional>
#include <vector>

namespace evical {

struct LensComparison {
  struct Number {
    double difference = 0.0;  // calibrated - other
    double sigma = 0.0;       // of both together; 0 if neither is known
  };
  // fx fy cx cy d0..d4; absent if the models differ, since their parameters are not comparable.
  std::optional<std::array<Number, kIntrinsicsCount>> numbers;

  struct Place {
    std::optional<double> difference_px;  // absent if one of them has no ray there
    double sigma_px = 0.0;                // of both together
  };
  int columns = 0, rows = 0;  // as in the result's image map
  std::vector<Place> places;  // row by row
  double rms_px = 0.0, max_px = 0.0;
  double rms_sigmas = 0.0;  // RMS over the image of differences divided by their sigmas
};

// A rotation of the camera is removed, as in the projection's sigmas. Throws CalibrationError (BadInput) if
// the other lens has another image size, or no common field of view.
LensComparison compareLenses(const IntrinsicsResult& found, const KnownIntrinsics& other);

}  // namespace evical
