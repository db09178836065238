#include "core/synthetic/visitors.h"

#include "core/numerics/angles.h"
#include "core/synthetic/random.h"

#include <Eigen/Geometry>

#include <initializer_list>
#include <numbers>

namespace evical {
namespace {

Eigen::Vector2d middle_m(const Scenario& scenario) {
  return 0.5 * scenario.board.extent_m();
}

void setLimbs(std::initializer_list<Limb> limbs, Figure& figure) {
  figure.low_m = figure.high_m = limbs.begin()->from_m;
  for (const Limb& limb : limbs) {
    figure.limbs[static_cast<std::size_t>(figure.limb_count++)] = limb;
    const Eigen::Array2f low = limb.from_m.cwiseMin(limb.to_m).array() - limb.radius_m,
                         high = limb.from_m.cwiseMax(limb.to_m).array() + limb.radius_m;
    figure.low_m = figure.low_m.cwiseMin(low.matrix());
    figure.high_m = figure.high_m.cwiseMax(high.matrix());
  }
}

Eigen::Vector2f anyPlaceInTexture(Random& random) {
  constexpr double kSide_m = 3.0;
  const double x = random.uniform(), y = random.uniform();
  return (kSide_m * Eigen::Vector2d(x, y)).cast<float>();
}

// Smooth pulse from 0 to 1 and back to 0 over the visit.
double presence(double since_s, double stay_s) {
  constexpr double kComes_s = 0.5 * kHandComesAndGoes_s;
  const double left_s = stay_s + kHandComesAndGoes_s - since_s;
  const double part = std::clamp(std::min(since_s, left_s) / kComes_s, 0.0, 1.0);
  return 0.5 - 0.5 * std::cos(std::numbers::pi * part);
}

// Palm, four fingers, thumb and forearm; fingers point along x.
void setHand(Figure& figure) {
  setLimbs({{{-0.03f, 0.0f}, {0.03f, 0.0f}, 0.042f},
            {{0.05f, -0.031f}, {0.105f, -0.042f}, 0.009f},
            {{0.05f, -0.010f}, {0.130f, -0.014f}, 0.010f},
            {{0.05f, 0.011f}, {0.135f, 0.014f}, 0.010f},
            {{0.05f, 0.031f}, {0.120f, 0.040f}, 0.009f},
            {{-0.02f, 0.03f}, {0.055f, 0.085f}, 0.012f},
            {{-0.05f, 0.0f}, {-0.9f, 0.0f}, 0.035f}},
           figure);
}

// Head, neck, trunk, legs and an arm; y points down, the middle of the trunk is the origin.
void setPerson(double step, Figure& figure) {
  const auto swung = [&](float x, float y, float length, double angle) {
    return Eigen::Vector2f(x + length * static_cast<float>(std::sin(angle)),
                           y + length * static_cast<float>(std::cos(angle)));
  };
  constexpr double kLegs_rad = 0.4, kArm_rad = 0.6;
  const double legs_rad = kLegs_rad * std::sin(step);
  setLimbs({{{0.0f, -0.2f}, {0.0f, 0.25f}, 0.17f},
            {{0.0f, -0.57f}, {0.0f, -0.53f}, 0.1f},
            {{0.0f, -0.5f}, {0.0f, -0.3f}, 0.05f},
            {{0.03f, 0.35f}, swung(0.03f, 0.35f, 0.85f, legs_rad), 0.08f},
            {{-0.03f, 0.35f}, swung(-0.03f, 0.35f, 0.85f, -legs_rad), 0.08f},
            {{0.1f, -0.28f}, swung(0.1f, -0.28f, 0.6f, kArm_rad * std::sin(step)), 0.05f}},
           figure);
}

}  // namespace

std::optional<Figure> handAt(const Scenario& scenario, double time_s) {
  const HandOverBoard& hand = scenario.scene.hand;
  if (hand.every_s <= 0.0) return std::nullopt;
  constexpr std::uint64_t kStream = 0x160u;
  constexpr double kReach_m = 1.2;      // start distance, outside the image
  constexpr double kPartOfBoard = 0.6;  // around the middle, to which it points
  const double turn = std::floor(time_s / hand.every_s);
  Random random(scenario.seed, kStream, static_cast<std::uint64_t>(static_cast<std::int64_t>(turn)));
  const double length_s = hand.stay_s + kHandComesAndGoes_s;
  const double since_s = time_s - turn * hand.every_s - random.uniform() * (hand.every_s - length_s);
  if (since_s < 0.0 || since_s > length_s) return std::nullopt;
  const double angle = kTwoPi * random.uniform(), u = random.uniform(), v = random.uniform();
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d target_m =
      middle_m(scenario) +
      kPartOfBoard * Eigen::Vector2d(u - 0.5, v - 0.5).cwiseProduct(scenario.board.extent_m());
  const Eigen::Vector2d sway_m(0.012 * std::sin(kTwoPi * 1.3 * since_s),
                               0.01 * std::sin(kTwoPi * 1.7 * since_s));
  const double away_m = kReach_m * (1.0 - presence(since_s, hand.stay_s));
  const double turned = angle + 0.08 * std::sin(kTwoPi * 0.9 * since_s);
  Figure figure;
  figure.visit = -1;
  figure.behind_board_m = -static_cast<float>(std::max(hand.height_m, 1e-4));
  figure.place_m = (target_m - away_m * along + sway_m).cast<float>();
  figure.own_from_plane = Eigen::Rotation2Dd(-turned).toRotationMatrix().cast<float>();
  setHand(figure);
  figure.log_tone = std::log(0.4f);
  figure.contrast = 0.25f;
  figure.texture_m = anyPlaceInTexture(random);
  return figure;
}

std::vector<Figure> peopleAt(const Scenario& scenario, double time_s) {
  const PeopleModel& people = scenario.scene.people;
  if (people.every_s <= 0.0) return {};
  constexpr std::uint64_t kStream = 0x170u;
  constexpr double kStride_m = 1.3;  // length of two steps
  // Twice the camera's view to either side: people start and end outside the image.
  const double half_way_m = 2.0 * (scenario.motion.distance_m + people.distance_m) + 0.6;
  const double half_time_s = half_way_m / people.speed_m_s;
  std::vector<Figure> figures;
  const auto first = static_cast<std::int64_t>(std::floor((time_s - half_time_s) / people.every_s)) - 1,
             last = static_cast<std::int64_t>(std::floor((time_s + half_time_s) / people.every_s));
  for (std::int64_t k = first; k <= last; ++k) {
    Random random(scenario.seed, kStream, static_cast<std::uint64_t>(k));
    const double passed_s = time_s - people.every_s * (static_cast<double>(k) + random.uniform());
    if (std::abs(passed_s) > half_time_s) continue;
    const double way = random.uniform() < 0.5 ? -1.0 : 1.0, height_m = 0.5 * random.uniform() - 0.2,
                 tone = 1.2 * random.uniform() - 0.6;
    const double walked_m = people.speed_m_s * passed_s, step = kTwoPi * walked_m / kStride_m;
    Figure figure;
    figure.visit = static_cast<int>(k);
    figure.behind_board_m = static_cast<float>(people.distance_m);
    const Eigen::Vector2d from_middle_m(way * walked_m, height_m + 0.02 * std::cos(2.0 * step));
    figure.place_m = (middle_m(scenario) + from_middle_m).cast<float>();
    setPerson(step, figure);
    constexpr double kMeanLogReflectance = -1.2;
    figure.log_tone = static_cast<float>(kMeanLogReflectance + tone);
    figure.texture_m = anyPlaceInTexture(random);
    figures.push_back(figure);
  }
  return figures;
}

bool isHidden(const Figure& hand, const Eigen::Vector3d& camera_m, const Eigen::Vector3d& centre_m,
              double radius_m) {
  const double part = (hand.behind_board_m - camera_m.z()) / (centre_m.z() - camera_m.z());
  if (!(part > 0.0)) return false;  // the hand is behind the camera
  const Eigen::Vector2d seen_at_m = (camera_m + part * (centre_m - camera_m)).head<2>();
  return hand.inside_m(hand.own_m(seen_at_m.cast<float>())) > -static_cast<float>(part * radius_m);
}

}  // namespace evical
