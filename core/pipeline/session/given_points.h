// Targets without a pattern of ours: their points' places, from a table or in a session itself.
#pragma once

#include "core/base/yaml_node.h"
#include "core/geometry/board.h"

#include <filesystem>
#include <string>
#include <vector>

namespace evical {

// A list of [x, y] (or [x, y, z]) in metres, by index. Throws CalibrationError (BadInput) where it is none, or where
// the points do not lie in a plane of one z.
std::vector<Eigen::Vector2d> pointsFrom(const YamlNode& list);

// A table `point,x_m,y_m[,z_m]`, with or without that line of names, also packed with gzip: each point once, from
// 0 on, in any order; further columns are left out. Throws CalibrationError (BadInput, with file and line).
std::vector<Eigen::Vector2d> loadPoints(const std::filesystem::path& file);

// What pointsFrom reads.
std::string pointsYaml(const Board& board);

}  // namespace evical
