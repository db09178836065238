#include "core/synthetic/room_scene.h"

#include "core/base/error.h"
#include "core/synthetic/random.h"
#include "core/synthetic/scenario_fields.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace evical {
namespace {

constexpr double kPicture_m = 2.5;  // range of random offsets of a side's picture

Eigen::Vector3d boardMiddle_m(const Board& board) {
  const Eigen::Vector2d half = 0.5 * board.extent_m();
  return {half.x(), half.y(), 0.0};
}

// The six sides of a cuboid that is rotated about the vertical; `inside`: they face inwards.
std::array<RoomSide, 6> sidesOf(const Eigen::Vector3d& middle_m, const Eigen::Vector3d& half_m,
                                double turn_rad, bool inside, double tone, Random& random) {
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  std::array<RoomSide, 6> sides;
  for (int k = 0; k < 6; ++k) {
    const int axis = k / 2, first = (axis + 1) % 3, second = (axis + 2) % 3;
    const double sign = k % 2 == 0 ? 1.0 : -1.0;
    RoomSide& side = sides[static_cast<std::size_t>(k)];
    side.middle_m = middle_m + sign * half_m[axis] * axes.col(axis);
    const bool keep = (sign > 0.0) != inside;
    side.along = keep ? axes.col(first) : axes.col(second);
    side.down = keep ? axes.col(second) : axes.col(first);
    side.half_m = keep ? Eigen::Vector2d(half_m[first], half_m[second])
                       : Eigen::Vector2d(half_m[second], half_m[first]);
    side.picture_m = kPicture_m * random.uniformPair();
    side.log_tone = tone * random.normal();
  }
  return sides;
}

// True if a box at this place leaves the middle free, stays within the walls, and touches no other.
bool hasRoom(const Eigen::Vector3d& at_m, double radius_m, const RoomModel& room,
             const std::vector<RoomBox>& others, const Eigen::Vector3d& middle_m) {
  const Eigen::Vector3d away = (at_m - middle_m).cwiseAbs();
  if (away.norm() < room.free_radius_m + radius_m) return false;
  if (((away.array() + radius_m) > 0.5 * room.size_m.array()).any()) return false;
  return std::none_of(others.begin(), others.end(), [&](const RoomBox& other) {
    return (other.middle_m - at_m).norm() < other.radius_m + radius_m;
  });
}

}  // namespace

RoomScene furnishedRoom(const Scenario& scenario) {
  constexpr std::uint64_t kStream = 0x200u;
  constexpr int kTries = 200;
  const RoomModel& room = scenario.room;
  const Eigen::Vector3d middle = boardMiddle_m(scenario.board) + room.middle_m;
  Random random(scenario.seed, kStream);
  RoomScene scene;
  scene.walls = sidesOf(middle, 0.5 * room.size_m, 0.0, true, room.tone, random);
  for (int k = 0; k < room.boxes; ++k) {
    const double spread = room.largest_box_m - room.smallest_box_m;
    const Eigen::Vector3d half =
        Eigen::Vector3d::Constant(room.smallest_box_m) + spread * random.uniformVector();
    for (int attempt = 0; attempt < kTries; ++attempt) {
      const Eigen::Vector3d part = random.uniformVector() - Eigen::Vector3d::Constant(0.5);
      const Eigen::Vector3d at = middle + part.cwiseProduct(room.size_m);
      if (!hasRoom(at, half.norm(), room, scene.boxes, middle)) continue;
      const double turn = std::numbers::pi * random.uniform();
      scene.boxes.push_back({at, half.norm(), sidesOf(at, half, turn, false, room.tone, random)});
      break;
    }
  }
  return scene;
}

void readRoom(const YamlNode& map, RoomModel& room) {
  map.allowOnly(
      {"size_m", "middle_m", "boxes", "smallest_box_m", "largest_box_m", "free_radius_m", "texel_m", "tone"});
  get(map, "size_m", room.size_m, 0.0, 100.0);
  get(map, "middle_m", room.middle_m, -100.0, 100.0);
  get(map, "boxes", room.boxes, 0, 100);
  get(map, "smallest_box_m", room.smallest_box_m, 0.01, 10.0, "m");
  get(map, "largest_box_m", room.largest_box_m, 0.01, 10.0, "m");
  get(map, "free_radius_m", room.free_radius_m, 0.0, 100.0, "m");
  get(map, "texel_m", room.texel_m, 1e-4, 0.1, "m");
  get(map, "tone", room.tone, 0.0, 2.0, "");
  if (room.largest_box_m < room.smallest_box_m)
    throw map.error("largest_box_m must not be less than smallest_box_m");
}

void validateRoom(const Scenario& scenario, const std::string& file) {
  if (!scenario.room.exists()) return;
  const auto refuse = [&](const char* key, const std::string& problem, const std::string& advice) {
    throw badInput(fmt::format("{}: {}", file, key), problem, advice);
  };
  const MotionModel& motion = scenario.motion;
  const double root = std::sqrt(motion.sinusoids);
  const double arm_m = motion.distance_m + root * motion.distance_amplitude_m + motion.hand.walking_m;
  for (int axis = 0; axis < 3; ++axis) {
    const double target_m = axis < 2 ? motion.target_amplitude_m[axis] : 0.0;
    const double reach_m = root * (motion.walk_amplitude_m[axis] + target_m) + arm_m;
    if (reach_m + std::abs(scenario.room.middle_m[axis]) >= 0.5 * scenario.room.size_m[axis])
      refuse("room.size_m", "the camera might pass through a wall",
             "Increase size_m, or decrease the motion's amplitudes and distance_m");
  }
  for (const SimulatedCamera& camera : scenario.cameras)
    if (camera.frames)
      refuse("cameras",
             fmt::format("{} has frames, but rooms are rendered for event cameras only", camera.name),
             "Remove room, or the camera's frames");
  if (scenario.scene.blink_hz > 0.0)
    refuse("scene.blink_hz", "a room does not have a board that blinks", "Set it to 0");
}

}  // namespace evical
