// Keys of a session that are set one at a time.
#pragma once

#include "core/pipeline/session.h"

#include <string>

namespace evical {

// acceleration_unit, angular_rate_unit, gyroscope_axes or accelerometer_axes. Throws CalibrationError (BadInput).
void setInImu(SessionImu& imu, const std::string& key, const std::string& value);

// Repairs of axes are of samples as the session has them read; this is of those that the sensor gives.
Repair ofRawAxes(const Repair& repair, const Session& session);

}  // namespace evical
