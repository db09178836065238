// Calibrated intrinsics as text: Evical's YAML map with sigmas, and a table.
#pragma once

#include "core/data/intrinsics_result.h"

#include <array>
#include <string>
#include <vector>

namespace evical {

struct NamedIntrinsics {
  std::string camera, stream;
  std::string version;
  IntrinsicsResult result;
  IntrinsicsStory story = {};
  std::vector<std::string> notes = {};  // on the recording and the board
};

// Readable as intrinsics of a session (core/format/intrinsics_yaml.h).
std::string intrinsicsResultYaml(const NamedIntrinsics& named);

// Sigmas fx fy cx cy d0..d4 with the keys of intrinsicsYaml; and rows of a table with intrinsics and sigmas.
std::string intrinsicsStdYaml(const CameraIntrinsics& camera, const std::array<double, 9>& sigmas,
                              int indent);
std::string intrinsicsRows(const CameraIntrinsics& camera, const std::array<double, 9>& sigmas);

// Every number with its +-, coverage of the image, advice, and the verdict.
std::string intrinsicsTable(const NamedIntrinsics& named);

// column,row,x_px,y_px,circles,sigma_px of every cell of the image.
std::string imageMapCsv(const ImageMap& map);

}  // namespace evical
