// Observations of a camera with a known motion, without events: edges in all directions with the slopes of
// this motion, in windows like those of a recording.
#pragma once

#include "core/data/edge_slope.h"
#include "core/egomotion/camera_record.h"
#include "core/egomotion/egomotion_options.h"
#include "core/egomotion/lens_rays.h"
#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <functional>
#include <random>
#include <vector>

namespace evical::test {

CameraIntrinsics davisLens();
// Long windows with few edges and few depths, so that tests are short.
EgomotionOptions quickEgomotion();

struct MovingCamera {
  std::function<Eigen::Vector3d(double time_s)> rate_rad_s, velocity_m_s;  // in the camera's frame
  double nearest_1_m = 0.3, further_1_m = 0.7;  // inverse depths, by squares of the image
  double noise = 0.0;                           // of slopes, sigma relative to their size
  int slopes = 500;                             // per window
};

// Times count from 0 ns.
std::vector<EdgeSlope> edgeSlopes(const MovingCamera& camera, const LensRays& lens, double begin_s,
                                  double duration_s, std::mt19937& generator);

// Windows from `begin_s` on.
CameraRecord cameraRecord(const MovingCamera& camera, const LensRays& lens, double begin_s, double end_s,
                          const EgomotionOptions& options, unsigned seed);

}  // namespace evical::test
