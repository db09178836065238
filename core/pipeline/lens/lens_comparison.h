// A calibrated lens beside another of the same camera: by number, and by where rays are seen in the image.
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
    double sigma = 0.0;       // of both together; 0 where neither is known
  };
  // fx fy cx cy d0..d4; nothing where the models differ: their numbers mean other things.
  std::optional<std::array<Number, kIntrinsicsCount>> numbers;

  struct Place {
    std::optional<double> difference_px;  // nothing where one of both sees no ray
    double sigma_px = 0.0;                // of both together
  };
  int columns = 0, rows = 0;  // as in the result's image
  std::vector<Place> places;  // row by row
  double rms_px = 0.0, max_px = 0.0;
  double rms_sigmas = 0.0;  // of differences divided by their sigmas, over the image
};

// A turn of the camera is taken out, as in the projection's sigmas. Throws CalibrationError (BadInput) where the other
// one is for an image of another size, or sees nothing that this one sees.
LensComparison compareLenses(const IntrinsicsResult& found, const KnownIntrinsics& other);

}  // namespace evical
