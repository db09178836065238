// Streams described by the XML in the header of an AEDAT4 file.
#pragma once

#include "core/data/recording.h"
#include "core/geometry/resolution.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace evical::aedat {

struct StreamDescription {
  std::int32_t id = 0;
  std::string name;    // originalOutputName
  std::string type;    // typeIdentifier: "EVTS", "IMUS", ...
  std::string source;  // model and serial number: "DAVIS346_00000002"
  Resolution size_px;
};

// By id; empty if the text is not DV's. Tolerant: skips unknown content.
std::vector<StreamDescription> parseDescriptions(std::string_view xml);

// Text that DV and Evical read.
std::string descriptionsXml(const std::vector<StreamDescription>& streams, std::string_view compression);

// Names of the streams as shown in DV, made unique by the source, then by the id.
std::vector<std::string> uniqueNames(const std::vector<StreamDescription>& streams);

}  // namespace evical::aedat

// Names of streams and their devices in the AEDAT4 files that we write: dv-processing looks for the streams
// "events" and "imu" of a camera, which it identifies by their source.

namespace evical::aedat {

struct DeviceName {
  std::string source, output;  // "DAVIS346_00000002", "events"
};

// If the device of a stream is unknown, the source is the part before its name in a topic ("left" of
// "/left/imu"). A file of one camera belongs to that camera as a whole. If a source has two streams of a type
// these keep their names.
std::vector<DeviceName> deviceNames(const std::vector<StreamInfo>& streams);

}  // namespace evical::aedat
