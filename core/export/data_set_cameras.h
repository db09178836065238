// Cameras by their names in data sets of stereo event and frame cameras.
#pragma once

#include "core/export/rig.h"

#include <optional>

namespace evical {

struct DataSetCameras {
  std::optional<RigCamera> left_event, right_event;  // left_event always exists
  std::optional<RigCamera> left_frame, right_frame;
};

// The first two cameras of each kind; a single one is the left one. Cameras of another program's points count
// as event cameras. Notes state the assignment, and the omitted cameras. Throws CalibrationError (BadInput)
// if there is no event camera, or if two of a kind are not side by side.
DataSetCameras dataSetCameras(const Rig& rig, const char* program, ExportNotes& notes);

}  // namespace evical
