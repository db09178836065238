// Keys of a session that can be set separately.
#pragma once

#include "core/base/yaml_node.h"
#include "core/pipeline/session/session.h"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace evical {

// Like readSession, but the recordings may be missing.
Session readSessionOfRun(const std::filesystem::path& file);

// The same from a text with paths relative to `folder`.
Session parseSession(const std::string& yaml, const std::filesystem::path& folder);

// One session for each entry if the file lists `recordings`; otherwise a single session. Throws as
// readSession.
std::vector<Session> readRepeatedSessions(const std::filesystem::path& file);

// Non-empty text. This and the next two throw CalibrationError (BadInput) at the node.
std::string nameFrom(const YamlNode& node);
std::filesystem::path pathFrom(const YamlNode& node);  // may have control characters

// Path in a session; the file must exist.
std::filesystem::path besideSession(const YamlNode& node, const std::filesystem::path& folder);

void setFromSession(const YamlNode& node, CalibrationOptions& options, const std::string& option);

// Seconds since the recording's start, [begin, end]. Throws CalibrationError (BadInput).
std::array<double, 2> timeRangeFrom(const YamlNode& node);

inline constexpr double kMinClockScale = 1e-7;

// acceleration_unit, angular_rate_unit, gyroscope_axes, accelerometer_axes or clock_scale. Throws
// CalibrationError (BadInput).
void setInImu(SessionImu& imu, const std::string& key, const std::string& value);

// Repairs of axes refer to samples after the session's axes are applied; the result refers to the sensor's
// raw axes.
Repair ofRawAxes(const Repair& repair, const Session& session);

}  // namespace evical
