// Keys of a session that are set one at a time.
#pragma once

#include "core/base/yaml_node.h"
#include "core/pipeline/session/session.h"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace evical {

// As readSession; but the recordings of a run may be gone since.
Session readSessionOfRun(const std::filesystem::path& file);

// The same from a text; its paths are as seen from `folder`.
Session parseSession(const std::string& yaml, const std::filesystem::path& folder);

// Of a file that lists `recordings`, a session for each; of any other the one that it is. Throws as readSession.
std::vector<Session> readRepeatedSessions(const std::filesystem::path& file);

// A text that is not empty. These three throw CalibrationError (BadInput) at the node.
std::string nameFrom(const YamlNode& node);

// A file that a session names, which must exist.
std::filesystem::path besideSession(const YamlNode& node, const std::filesystem::path& folder);

void setFromSession(const YamlNode& node, CalibrationOptions& options, const std::string& option);

// Seconds since the recording's start, [begin, end]. Throws CalibrationError (BadInput).
std::array<double, 2> timeRangeFrom(const YamlNode& node);

inline constexpr double kLeastClockScale = 1e-7;

// acceleration_unit, angular_rate_unit, gyroscope_axes, accelerometer_axes or clock_scale. Throws CalibrationError (BadInput).
void setInImu(SessionImu& imu, const std::string& key, const std::string& value);

// Repairs of axes are of samples as the session has them read; this is of those that the sensor gives.
Repair ofRawAxes(const Repair& repair, const Session& session);

}  // namespace evical
