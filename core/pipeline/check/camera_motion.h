// Rotation of a camera over time from its events: bursts, slopes of their times, and the motion in each
// window.
#pragma once

#include "core/egomotion/camera_record.h"
#include "core/egomotion/egomotion_options.h"
#include "core/egomotion/lens_rays.h"
#include "core/frontend/edge_crossings.h"
#include "core/frontend/edge_slopes.h"
#include "core/pipeline/session/calibration_options.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace evical {

class CameraMotion {
 public:
  // `start_ns`: start of the recording, the origin of the windows' times.
  CameraMotion(const CameraIntrinsics& lens, const CalibrationOptions& options, std::int64_t start_ns);

  // Adds bursts from BurstExtractor.
  void add(const std::vector<EdgeCrossing>& bursts, std::int64_t complete_until_ns) {
    slopes_.add(bursts, complete_until_ns);
  }
  CameraRecord finish();

 private:
  LensRays lens_;
  EgomotionOptions options_;
  std::int64_t start_ns_;
  CameraRecord record_;
  EdgeSlopeFinder slopes_;
};

}  // namespace evical
