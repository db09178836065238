// Files of an intrinsics calibration, and the lens as a result for other programs' formats.
#pragma once

#include "core/base/atomic_file.h"
#include "core/data/board_observations.h"
#include "core/pipeline/lens/intrinsics_calibration.h"
#include "core/report/intrinsics_report.h"
#include "core/report/result_yaml.h"

#include <filesystem>
#include <string>
#include <vector>

namespace evical {

// intrinsics.yaml, camera_info.yaml, camchain.yaml, projection_std.csv and detections.csv.
std::vector<FileContent> intrinsicsFiles(const std::filesystem::path& folder, const NamedIntrinsics& named,
                                         const std::vector<BoardObservations>& seen);

// With notes on the recording and the board.
NamedIntrinsics namedIntrinsics(const SessionCamera& camera, const IntrinsicsRun& run,
                                const std::string& version);

// Rig of this one camera for exporters (core/report/export), most of which accept a single lens.
NamedResult lensAsResult(const NamedIntrinsics& named, CameraKind kind);

}  // namespace evical
