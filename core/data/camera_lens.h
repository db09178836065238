// One camera's lens in a calibration, from what was known of it to what came out.
#pragma once

#include "core/data/lens_uncertainty.h"
#include "core/geometry/camera_intrinsics.h"

#include <optional>

namespace evical {

struct CameraLens {
  std::optional<CameraIntrinsics> given = {};  // by the session; absent: not known beforehand
  std::optional<CameraIntrinsics> detection_intrinsics =
      {};                                       // by the front end: observations are in its ideal pixels
  std::optional<CameraIntrinsics> solved = {};  // together with everything else, where it was free
  std::optional<LensUncertainty> given_with =
      {};  // how well the session knows what it gives; absent: not said

  // Calibrated before everything else, from the same recording.
  bool foundFirst() const { return detection_intrinsics && !given; }
  // The best that is known: what projects points to where the camera sees them.
  const std::optional<CameraIntrinsics>& inUse() const { return solved ? solved : detection_intrinsics; }
  // What the calibration itself found; nothing where the lens stayed as it was given.
  std::optional<CameraIntrinsics> found() const { return solved || !given ? inUse() : std::nullopt; }

  bool operator==(const CameraLens&) const = default;
};

// A lens that is known beforehand, or is not.
inline CameraLens givenLens(const std::optional<CameraIntrinsics>& intrinsics,
                            const std::optional<LensUncertainty>& uncertainty = {}) {
  return {intrinsics, intrinsics, {}, intrinsics ? uncertainty : std::nullopt};
}

}  // namespace evical
