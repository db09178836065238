// Result as text for a terminal: every number with its +- (one standard deviation), and the verdict.
#pragma once

#include "core/report/result_yaml.h"

#include <string>

namespace evical {

std::string resultTable(const NamedResult& named);

// Quantities of a sensor that were given and not estimated: "rotation, time offset"; empty if none.
std::string givenOf(const UncertaintyReport& uncertainty, const std::string& sensor);

// Roll, pitch, yaw in degrees about x, y, z (R = Rz Ry Rx), for people only.
Eigen::Vector3d rollPitchYaw_deg(const Eigen::Quaterniond& rotation);

// One row of a table for terminals: a name, a number with its +-, a unit.

std::string tableRow(const std::string& name, double value, double sigma, const char* unit, int decimals = 5);

}  // namespace evical
