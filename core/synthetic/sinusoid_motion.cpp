#include "core/synthetic/sinusoid_motion.h"

#include "core/synthetic/random.h"
#include "core/synthetic/scenario_boards.h"

#include "core/geometry/camera_model.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

namespace evical {
namespace {

constexpr double kStopRamp_s = 0.25;  // from full speed to rest

// Smooth step from 0 to 1 over u = 0 to 1, its derivative, and its integral from 0; flat to the second order
// at both ends.
double smoothFraction(double u) {
  return u * u * u * (10.0 + u * (6.0 * u - 15.0));
}
double smoothStepSlope(double u) {
  return 30.0 * u * u * (1.0 - u) * (1.0 - u);
}
double smoothStepIntegral(double u) {
  return u * u * u * u * (2.5 + u * (u - 3.0));
}

}  // namespace

MotionValue& MotionValue::operator+=(const MotionValue& other) {
  value += other.value;
  first += other.first;
  second += other.second;
  return *this;
}

MotionValue MotionSinusoid::at(double time_s) const {
  const double angle = angular_frequency * time_s + phase;
  const double sine = amplitude * std::sin(angle), cosine = amplitude * std::cos(angle);
  return {sine, angular_frequency * cosine, -angular_frequency * angular_frequency * sine};
}

MotionValue Jerk::at(double time_s) const {
  constexpr double kWidth_s = 0.04;
  const double u = (time_s - middle_s) / kWidth_s;
  const double value = size * std::exp(-0.5 * u * u);
  return {value, -u / kWidth_s * value, (u * u - 1.0) / (kWidth_s * kWidth_s) * value};
}

// Each period ends with a ramp down, a stop, and a ramp up.
MotionValue motionTime(const HandModel& hand, double time_s) {
  if (hand.stop_every_s <= 0.0) return {time_s, 1.0, 0.0};
  const double period_s = hand.stop_every_s, moving_s = period_s - hand.stop_s - 2.0 * kStopRamp_s;
  const double period = std::floor(time_s / period_s), since_s = time_s - period * period_s;
  const double before_s = period * (moving_s + kStopRamp_s);  // two ramps of half the speed on average
  const double down = std::clamp((since_s - moving_s) / kStopRamp_s, 0.0, 1.0);
  const double up = std::clamp((since_s - (period_s - kStopRamp_s)) / kStopRamp_s, 0.0, 1.0);
  return {before_s + std::min(since_s, moving_s) +
              kStopRamp_s * (down - smoothStepIntegral(down) + smoothStepIntegral(up)),
          1.0 - smoothFraction(down) + smoothFraction(up),
          (smoothStepSlope(up) - smoothStepSlope(down)) / kStopRamp_s};
}

MotionValue throughTime(const MotionValue& value, const MotionValue& time) {
  return {value.value, value.first * time.first,
          value.second * time.first * time.first + value.first * time.second};
}

std::vector<MotionSinusoid> tremor(double sigma, std::uint64_t seed, std::size_t quantity) {
  if (sigma <= 0.0) return {};
  constexpr std::uint64_t kStream = 0x210;
  constexpr int kSinusoids = 3;
  constexpr double kLowest_hz = 8.0, kHighest_hz = 12.0;
  Random random(seed, kStream, quantity);
  std::vector<MotionSinusoid> all;
  for (int k = 0; k < kSinusoids; ++k) {
    const double frequency_hz = kLowest_hz + (kHighest_hz - kLowest_hz) * (k + random.uniform()) / kSinusoids;
    all.push_back({sigma * std::sqrt(2.0 / kSinusoids), kTwoPi * frequency_hz, kTwoPi * random.uniform()});
  }
  return all;
}

std::vector<Jerk> jerks(const HandModel& hand, double duration_s, std::uint64_t seed, std::size_t quantity) {
  std::vector<Jerk> all;
  if (hand.jerks_per_s <= 0.0) return all;
  constexpr std::uint64_t kMoments = 0x220, kSizes = 0x221;
  Random moments(seed, kMoments), sizes(seed, kSizes, quantity);  // all quantities at the same moments
  for (double t = moments.exponential(1.0 / hand.jerks_per_s); t < duration_s;
       t += moments.exponential(1.0 / hand.jerks_per_s))
    all.push_back({hand.jerk_rad * sizes.normal(), t});
  return all;
}

namespace {

constexpr double kWalkSpread = 3.0;  // spread of its frequencies, about one per period

// Reproducible numbers for the same seed with any standard library.
double uniform(std::mt19937_64& generator) {
  return static_cast<double>(generator() >> 11) * 0x1.0p-53;
}

Eigen::Vector3d middleOf(const Board& board) {
  Eigen::Vector2d low = board.point_m(0), high = low;
  for (const Eigen::Vector2d& centre : boardPoints_m(board)) {
    low = low.cwiseMin(centre);
    high = high.cwiseMax(centre);
  }
  const Eigen::Vector2d middle = 0.5 * (low + high);
  return {middle.x(), middle.y(), 0.0};
}

bool isInside(const Resolution& resolution, const Eigen::Vector2d& pixel) {
  return pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= resolution.width_px - 1 &&
         pixel.y() <= resolution.height_px - 1;
}

}  // namespace

MotionState motionOfFrame(const MotionState& body, const RigidTransform& body_from_frame) {
  const Eigen::Vector3d& lever = body_from_frame.translation_m;
  const Eigen::Vector3d& w = body.angular_velocity_in_body_rad_s;
  const Eigen::Vector3d& a = body.angular_acceleration_in_body_rad_s2;
  const Eigen::Quaterniond& r = body.world_from_body.rotation;
  const Eigen::Quaterniond frame_from_body = body_from_frame.rotation.conjugate();
  MotionState frame;
  frame.world_from_body = body.world_from_body * body_from_frame;
  frame.velocity_in_world_m_s = body.velocity_in_world_m_s + r * w.cross(lever);
  frame.acceleration_in_world_m_s2 =
      body.acceleration_in_world_m_s2 + r * (a.cross(lever) + w.cross(w.cross(lever)));
  frame.angular_velocity_in_body_rad_s = frame_from_body * w;
  frame.angular_acceleration_in_body_rad_s2 = frame_from_body * a;
  return frame;
}

SinusoidMotion::SinusoidMotion(const Scenario& scenario)
    : scenario_(scenario),
      board_middle_m_(middleOf(scenario.board)),
      camera_from_imu_(inverse(scenario.cameras.front().imu_from_camera)) {
  const MotionModel& m = scenario.motion;
  std::mt19937_64 generator(scenario.seed * 7919 + 17);
  const std::array<double, kQuantities> amplitudes = {
      m.angle_amplitude_rad.x(), m.angle_amplitude_rad.y(), m.angle_amplitude_rad.z(),
      m.target_amplitude_m.x(),  m.target_amplitude_m.y(),  m.distance_amplitude_m,
      m.walk_amplitude_m.x(),    m.walk_amplitude_m.y(),    m.walk_amplitude_m.z()};
  for (std::size_t q = 0; q < kQuantities; ++q) {
    for (int k = 0; k < m.sinusoids; ++k) {
      // Frequencies spread evenly in the logarithm, each shifted at random, so that
      // no two axes move together.
      const double part = (k + uniform(generator)) / m.sinusoids;
      const bool walks = q >= WalkX;
      const double lowest_hz = walks ? 1.0 / (kWalkSpread * m.walk_period_s) : m.lowest_frequency_hz,
                   highest_hz = walks ? kWalkSpread / m.walk_period_s : m.highest_frequency_hz;
      const double frequency = lowest_hz * std::pow(highest_hz / lowest_hz, part);
      const double share = std::sqrt(1.0 / m.sinusoids);
      sinusoids_[q].push_back({amplitudes[q] * share, kTwoPi * frequency, kTwoPi * uniform(generator)});
    }
  }
  // The speed is that of the sinusoids alone, without stops and other hand-held motion.
  scenario_.motion.hand = {};
  const double speed = m.image_speed_px_s > 0.0 ? imageSpeedRms_px_s() : 0.0;
  for (auto& quantity : sinusoids_) {
    for (Sinusoid& s : quantity)
      if (speed > 0.0) s.angular_frequency *= m.image_speed_px_s / speed;
  }
  scenario_.motion.hand = m.hand;
  addHand();
}

void SinusoidMotion::addHand() {
  const HandModel& hand = scenario_.motion.hand;
  for (std::size_t q = 0; q < kQuantities; ++q) {
    const bool turns = q <= AngleZ;
    unstopped_[q] = tremor(turns ? hand.tremor_rad : hand.tremor_m, scenario_.seed, q);
    if (turns) jerks_[q] = jerks(hand, scenario_.duration_s, scenario_.seed, q);
  }
  if (hand.walking_m <= 0.0) return;
  constexpr double kSteps_hz = 1.9;
  sinusoids_[TargetY].push_back({hand.walking_m, kTwoPi * kSteps_hz, 0.0});
  sinusoids_[TargetX].push_back({0.5 * hand.walking_m, 0.5 * kTwoPi * kSteps_hz, 1.0});
}

SinusoidMotion::Value SinusoidMotion::at(Quantity quantity, double time_s) const {
  const Value time = motionTime(scenario_.motion.hand, time_s);
  Value sum;
  for (const Sinusoid& s : sinusoids_[quantity]) sum += s.at(time.value);
  sum = throughTime(sum, time);
  for (const Sinusoid& s : unstopped_[quantity]) sum += s.at(time_s);
  for (const Jerk& jerk : jerks_[quantity]) sum += jerk.at(time_s);
  return sum;
}

namespace {

struct Swing {
  double amplitude_rad, frequency_rad_s;
};

// Rotation about the state's axis, back and forth about a mean angle.
MotionState turned(MotionState state, const Eigen::Vector3d& axis, double mean_rad, Swing swing,
                   double time_s) {
  const double phase = swing.frequency_rad_s * time_s;
  const double rate = swing.amplitude_rad * swing.frequency_rad_s * std::cos(phase),
               acceleration =
                   -swing.amplitude_rad * swing.frequency_rad_s * swing.frequency_rad_s * std::sin(phase);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(mean_rad + swing.amplitude_rad * std::sin(phase), axis));
  const Eigen::Vector3d w = turn.conjugate() * state.angular_velocity_in_body_rad_s,
                        dw = turn.conjugate() * state.angular_acceleration_in_body_rad_s2;
  state.world_from_body.rotation = state.world_from_body.rotation * turn;
  state.angular_velocity_in_body_rad_s = w + rate * axis;
  state.angular_acceleration_in_body_rad_s2 = dw + w.cross(rate * axis) + acceleration * axis;
  return state;
}

}  // namespace

// Rotation Rz(c) Ry(b) Rx(a) after the mean roll; the camera looks along its z axis at the target.
MotionState SinusoidMotion::gazeAt(double time_s) const {
  const Value a = at(AngleX, time_s), b = at(AngleY, time_s), c = at(AngleZ, time_s);
  const Value x = at(TargetX, time_s), y = at(TargetY, time_s), d = at(Distance, time_s);
  const double sa = std::sin(a.value), ca = std::cos(a.value), sb = std::sin(b.value), cb = std::cos(b.value);
  MotionState state;
  const Eigen::Quaterniond rotation =
      Eigen::AngleAxisd(scenario_.motion.roll_rad + c.value, Eigen::Vector3d::UnitZ()) *
      Eigen::AngleAxisd(b.value, Eigen::Vector3d::UnitY()) *
      Eigen::AngleAxisd(a.value, Eigen::Vector3d::UnitX());
  const Eigen::Vector3d w(a.first - c.first * sb, b.first * ca + c.first * sa * cb,
                          -b.first * sa + c.first * ca * cb);
  const Eigen::Vector3d dw(a.second - c.second * sb - c.first * cb * b.first,
                           b.second * ca - b.first * sa * a.first + c.second * sa * cb +
                               c.first * (ca * cb * a.first - sa * sb * b.first),
                           -b.second * sa - b.first * ca * a.first + c.second * ca * cb -
                               c.first * (sa * cb * a.first + ca * sb * b.first));
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const double distance = scenario_.motion.distance_m + d.value;
  const Eigen::Vector3d turned = w.cross(z), bent = dw.cross(z) + w.cross(w.cross(z));
  state.world_from_body.rotation = rotation;
  state.world_from_body.translation_m =
      board_middle_m_ + Eigen::Vector3d(x.value, y.value, 0.0) - rotation * (distance * z);
  state.velocity_in_world_m_s =
      Eigen::Vector3d(x.first, y.first, 0.0) - rotation * (d.first * z + distance * turned);
  state.acceleration_in_world_m_s2 = Eigen::Vector3d(x.second, y.second, 0.0) -
                                     rotation * (d.second * z + 2.0 * d.first * turned + distance * bent);
  state.angular_velocity_in_body_rad_s = w;
  state.angular_acceleration_in_body_rad_s2 = dw;
  const Value walk_x = at(WalkX, time_s), walk_y = at(WalkY, time_s), walk_z = at(WalkZ, time_s);
  state.world_from_body.translation_m += Eigen::Vector3d(walk_x.value, walk_y.value, walk_z.value);
  state.velocity_in_world_m_s += Eigen::Vector3d(walk_x.first, walk_y.first, walk_z.first);
  state.acceleration_in_world_m_s2 += Eigen::Vector3d(walk_x.second, walk_y.second, walk_z.second);
  return state;
}

MotionState SinusoidMotion::firstCameraAt(double time_s) const {
  const MotionModel& m = scenario_.motion;
  const MotionState aside = turned(gazeAt(time_s), Eigen::Vector3d::UnitY(), m.turn_rad,
                                   {m.turn_amplitude_rad, kTwoPi / m.turn_period_s}, time_s);
  if (m.tilt_amplitude_rad == 0.0) return aside;
  return turned(aside, Eigen::Vector3d::UnitX(), 0.0, {m.tilt_amplitude_rad, kTwoPi / m.tilt_period_s},
                time_s);
}

MotionState SinusoidMotion::imuAt(double time_s) const {
  return motionOfFrame(firstCameraAt(time_s), camera_from_imu_);
}

MotionState SinusoidMotion::cameraAt(std::size_t camera, double time_s) const {
  return motionOfFrame(imuAt(time_s), scenario_.cameras[camera].imu_from_camera);
}

RigidTransform SinusoidMotion::worldFromCamera(std::size_t camera, double time_s) const {
  const RigidTransform world_from_first = firstCameraAt(time_s).world_from_body;
  if (camera == 0) return world_from_first;
  return world_from_first * camera_from_imu_ * scenario_.cameras[camera].imu_from_camera;
}

RigidTransform SinusoidMotion::boardFromCamera(std::size_t camera, double time_s) const {
  return boardFromWorld(scenario_, camera) * worldFromCamera(camera, time_s);
}

double SinusoidMotion::imageSpeedRms_px_s() const {
  constexpr int kInstants = 400;
  const SimulatedCamera& camera = scenario_.cameras.front();
  double squares = 0.0;
  int count = 0;
  for (int k = 0; k < kInstants; ++k) {
    const MotionState state = firstCameraAt(scenario_.duration_s * k / kInstants);
    const RigidTransform camera_from_world = inverse(state.world_from_body);
    const Eigen::Vector3d velocity = camera_from_world.rotation * state.velocity_in_world_m_s;
    for (const Eigen::Vector2d& centre : boardPoints_m(scenario_.board)) {
      const Eigen::Vector3d point = camera_from_world * Eigen::Vector3d(centre.x(), centre.y(), 0.0);
      Eigen::Matrix<double, 2, 3> jacobian;
      const std::optional<Eigen::Vector2d> pixel = project(camera.intrinsics, point, &jacobian);
      // Far outside the image the distortion's polynomial is meaningless, and so are speeds there.
      if (!pixel || !isInside(camera.intrinsics.resolution_px, *pixel)) continue;
      squares += (jacobian * (-velocity - state.angular_velocity_in_body_rad_s.cross(point))).squaredNorm();
      ++count;
    }
  }
  return count == 0 ? 0.0 : std::sqrt(squares / count);
}

}  // namespace evical
