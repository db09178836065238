// Names of streams and their devices in the AEDAT4 files that we write: dv-processing looks for the streams
// "events" and "imu" of a camera, which it identifies by their source.
#pragma once

#include "core/data/recording.h"

#include <string>
#include <vector>

namespace evical::aedat {

struct DeviceName {
  std::string source, output;  // "DAVIS346_00000002", "events"
};

// If the device of a stream is unknown, the source is the part before its name in a topic ("left" of
// "/left/imu"). A file of one camera belongs to that camera as a whole. If a source has two streams of a type
// these keep their names.
std::vector<DeviceName> deviceNames(const std::vector<StreamInfo>& streams);

}  // namespace evical::aedat
