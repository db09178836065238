// Checks that an earlier run's detections match a session. All functions throw CalibrationError (BadInput)
// with the key of detections.yaml that contradicts the session.
#pragma once

#include "core/base/progress.h"
#include "core/base/yaml_node.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/session/session.h"

#include <filesystem>
#include <vector>

namespace evical {

// Reads detections.yaml of a run's folder.
YamlNode loadDetections(const std::filesystem::path& folder);

// Compares a camera's board with its description.
void checkBoard(const YamlNode& said, const Board& board);

// Checks the time range. Different detection options, which have no effect any more, and another name of the
// recording are only logged.
void checkSession(const YamlNode& detections, const Session& session, const RunContext& context);

// Map of a camera, with stream and clock checked.
YamlNode checkedCamera(const YamlNode& detections, const SessionCamera& camera);
Resolution checkedResolution(const YamlNode& map, const SessionCamera& camera);
// Lens used for the detection: the session's, or the calibrated one if the session gives none.
CameraIntrinsics checkedLens(const YamlNode& map, const SessionCamera& camera);

// Checks that IMU samples overlap the detections in time; otherwise they are of another recording.
void checkOverlap(const Session& session, const DetectionResult& detections);

// Options that affect the detection and differ from their defaults.
std::vector<OptionRow> detectionOptions(const Session& session);

// A key of a camera on which its detections depend, as text. Board, resolution and lens are compared by
// value.
struct DetectionKey {
  const char* name;
  std::string value;
};
std::vector<DetectionKey> detectionKeys(const SessionCamera& camera);

bool isOfImu(const RecordingFault& fault, const Session& session);

}  // namespace evical
