// Basalt's calibration.json, which TUM-VIE has too.
#pragma once

#include "core/export/rig.h"

#include <string>
#include <vector>

namespace evical {

// Of all cameras, in this order; their lenses are such as the program takes. `more` are further members, each after a
// comma. Throws CalibrationError (BadInput) where there is no IMU.
std::string basaltCalibration(const Rig& rig, const char* program, ExportNotes& notes,
                              const std::string& more = {});

// What its keys mean.
std::vector<std::string> basaltMeanings(const RigImu& imu);

}  // namespace evical
