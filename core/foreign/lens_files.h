// Reads camera lenses from single files of other programs. The content decides the layout: all layouts that
// Evical exports, and similar ones. The same readers check exports. Layouts of Kalibr, ROS and eKalibr's
// intrinsics are in core/format/intrinsics_yaml.h.
#pragma once

#include "core/foreign/read_calibration.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

struct LensFile {
  const char* layout;  // for people: "a basalt calibration"
  ReadFile read;       // each of its cameras has a lens
};

// Empty if the file has none of these layouts. Throws CalibrationError (BadInput) with file and key if the
// file is damaged or its lens model is not supported.
std::optional<LensFile> readLensFile(const std::filesystem::path& file);

// For messages that list what can be imported.
std::string lensLayouts();

}  // namespace evical
