// Cameras by the names that data sets of stereo event and frame cameras have for them.
#pragma once

#include "core/export/rig.h"

#include <optional>

namespace evical {

struct DataSetCameras {
  std::optional<RigCamera> left_event, right_event;  // the left one is there
  std::optional<RigCamera> left_frame, right_frame;
};

// Of both kinds the first two; a single one is the left one. Cameras of another program's points count as event
// cameras. Notes say who is who, and who is left out. Throws CalibrationError (BadInput) where there is no event camera,
// or where two of a kind do not sit side by side.
DataSetCameras dataSetCameras(const Rig& rig, const char* program, ExportNotes& notes);

}  // namespace evical
