// Furniture of a simulated room: flat sides in the world, of walls that are seen from inside and boxes that
// are seen from outside. docs/maths.md, 12.
#pragma once

#include "core/base/yaml_node.h"
#include "core/synthetic/scenario.h"

#include <Eigen/Core>

#include <array>
#include <string>
#include <vector>

namespace evical {

// A rectangle; its picture's coordinates are those along its sides.
struct RoomSide {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d along = Eigen::Vector3d::UnitX(), down = Eigen::Vector3d::UnitY();  // unit
  Eigen::Vector2d half_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d picture_m = Eigen::Vector2d::Zero();  // place of its middle in the picture
  double log_tone = 0.0;

  Eigen::Vector3d normal() const { return along.cross(down); }  // out of boxes, into the room
};

struct RoomBox {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;  // of the sphere around it
  std::array<RoomSide, 6> sides;
};

struct RoomScene {
  std::array<RoomSide, 6> walls;
  std::vector<RoomBox> boxes;  // do not touch each other
};

// Scene from the scenario's seed. Boxes without a free place are omitted.
RoomScene furnishedRoom(const Scenario& scenario);

// Name of the key in scenarios.
void readRoom(const YamlNode& map, RoomModel& room);

// Throws CalibrationError (BadInput) if cameras would pass through walls or boxes, or if the scenario has
// something that rooms do not support.
void validateRoom(const Scenario& scenario, const std::string& file);

}  // namespace evical
