#include "core/synthetic/session_errors.h"

namespace evical {

Scenario asSessionSays(Scenario scenario) {
  const SessionErrors& errors = scenario.session_errors;
  scenario.board.spacing_m *= 1.0 + errors.spacing;
  scenario.board.radius_m *= 1.0 + errors.spacing;
  for (SimulatedCamera& camera : scenario.cameras) {
    camera.intrinsics.focal_length_px *= 1.0 + errors.focal_length;
    camera.intrinsics.principal_point_px.x() += errors.principal_point_px;
  }
  for (SimulatedImu& imu : scenario.imus) {
    imu.gyroscope_density *= errors.imu_noise_factor;
    imu.accelerometer_density *= errors.imu_noise_factor;
  }
  return scenario;
}

}  // namespace evical
