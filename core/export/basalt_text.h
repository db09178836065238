// Basalt's calibration.json, which TUM-VIE also uses.
#pragma once

#include "core/export/rig.h"

#include <string>
#include <vector>

namespace evical {

// Text for all cameras, in this order, with supported lens models. `more`: further members, each after a
// comma. Throws CalibrationError (BadInput) without an IMU.
std::string basaltCalibration(const Rig& rig, const char* program, ExportNotes& notes,
                              const std::string& more = {});

// Explanations of its keys.
std::vector<std::string> basaltMeanings(const RigImu& imu);

}  // namespace evical
