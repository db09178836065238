// Targets defined by the positions of their points, from a table or from the session.
#pragma once

#include "core/base/yaml_node.h"
#include "core/geometry/board.h"

#include <filesystem>
#include <string>
#include <vector>

namespace evical {

// A list of [x, y] (or [x, y, z]) in metres, by index. Throws CalibrationError (BadInput) if it is not such a
// list, or if z is not constant.
std::vector<Eigen::Vector2d> pointsFrom(const YamlNode& list);

// A table `point,x_m,y_m[,z_m]`, with or without this header, optionally compressed with gzip: each point
// once, counted from 0, in any order. Further columns are ignored. Throws CalibrationError (BadInput, with
// file and line).
std::vector<Eigen::Vector2d> loadPoints(const std::filesystem::path& file);

// YAML list that pointsFrom reads.
std::string pointsYaml(const Board& board);

}  // namespace evical
