// Whether an earlier run's detections are those of a session. All of it throws CalibrationError (BadInput) that says
// which key of detections.yaml contradicts the session.
#pragma once

#include "core/base/progress.h"
#include "core/base/yaml_node.h"
#include "core/pipeline/pass/recording_pass.h"
#include "core/pipeline/session/session.h"

#include <filesystem>
#include <vector>

namespace evical {

// detections.yaml of a run's folder.
YamlNode loadDetections(const std::filesystem::path& folder);

// The board that a camera sees, by what is said of it.
void checkBoard(const YamlNode& said, const Board& board);

// The time range. That options of detection differ, which change nothing now, and that the recording
// has another name is only logged.
void checkSession(const YamlNode& detections, const Session& session, const RunContext& context);

// The camera's map, of the same stream and clock.
YamlNode checkedCamera(const YamlNode& detections, const SessionCamera& camera);
Resolution checkedResolution(const YamlNode& map, const SessionCamera& camera);
// What the camera was seen with, which is what the session gives, or was found where it gives nothing.
CameraIntrinsics checkedLens(const YamlNode& map, const SessionCamera& camera);

// IMUs whose samples lie elsewhere in time are of another recording.
void checkOverlap(const Session& session, const DetectionResult& pass);

// Those that decide what is detected, where they are not at their defaults.
std::vector<OptionRow> detectionOptions(const CalibrationOptions& options);

bool isOfImu(const RecordingFault& fault, const Session& session);

}  // namespace evical
