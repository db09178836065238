// Rotation rates of the camera, from its views of the board only, and of the gyroscope. Their magnitudes do
// not depend on the camera's mounting, so their agreement only depends on the time offset.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/initialisation/initialisation_options.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace evical {

// One entry per pair of views, each averaged over the time between the two.
struct RotationRates {
  std::vector<double> time_s;  // camera clock, the pair's middle
  std::vector<double> camera_rad_s;
  std::vector<double> imu_before_rad_s;  // for equal clocks
  std::vector<double> imu_after_rad_s;   // with the calibrated offset between camera and IMU

  double rmsDifferenceBefore_rad_s() const;
  double rmsDifferenceAfter_rad_s() const;
};

// Pairs outside the IMU's samples are omitted. Throws Cancelled on a stop request.
RotationRates rotationRates(const CameraData& camera, const Board& board, const CameraState& camera_state,
                            const ImuData& imu, const ImuState& imu_state, std::int64_t start_ns,
                            const InitialisationOptions& options, const RunContext& context);

// Ratio of the gyroscope's rates to the camera's, and the correlation at the time offset where they agree
// best. Empty if they agree at none. A ratio far from 1 shows a wrong unit, or a lens with a wrong focal
// length.
struct RateRatio {
  double ratio = 1.0, correlation = 0.0;
};
std::optional<RateRatio> rateRatio(const CameraData& camera, const Board& board, const ImuData& imu,
                                   std::int64_t start_ns, const InitialisationOptions& options,
                                   const RunContext& context);

}  // namespace evical
