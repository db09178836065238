// Camera lenses in single files of other programs, by what a file holds: the layouts that Evical exports, and their
// relatives. The readers are those that check exports. Layouts of Kalibr, ROS and eKalibr's intrinsics are read elsewhere
// (core/data/intrinsics_yaml.h).
#pragma once

#include "core/report/export/read_back.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

struct LensFile {
  const char* layout;  // for people: "basalt's calibration"
  ReadFile read;       // each of its cameras has a lens
};

// Nothing where the file is of none of these layouts. Throws CalibrationError (BadInput) at file and key where it is of one of
// them, but damaged, or with a lens that Evical does not have.
std::optional<LensFile> readLensFile(const std::filesystem::path& file);

// For people who ask what can be imported.
std::string lensLayouts();

}  // namespace evical
