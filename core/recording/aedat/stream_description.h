// Streams described by the XML in the header of an AEDAT4 file.
#pragma once

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
