// What streams and their devices are called in the AEDAT4 files that we write: dv-processing looks for the streams
// "events" and "imu" of a camera, which it knows by their source.
#pragma once

#include "core/data/recording.h"

#include <string>
#include <vector>

namespace evical::aedat {

struct DeviceName {
  std::string source, output;  // "DAVIS346_00000002", "events"
};

// Of a stream whose device nobody states, the source is what stands before its name in a topic ("left" of "/left/imu"). One
// camera's file is that camera's altogether. Where a source has two streams of a type these keep their names.
std::vector<DeviceName> deviceNames(const std::vector<StreamInfo>& streams);

}  // namespace evical::aedat
