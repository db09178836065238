#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/random_vector.h"

#include "core/base/time.h"
#include "core/data/intrinsics_result.h"
#include "core/geometry/circle_conic.h"
#include "core/geometry/so3.h"
#include "core/geometry/trajectory.h"
#include "core/optimisation/uncertainty/quantity_covariance.h"
#include "tests/support/seen_through.h"

#include <Eigen/LU>

#include <cmath>
#include <random>

namespace evical::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kMargin_s = 0.15;
constexpr std::int64_t kStart_ns = 1'700'000'000'123'456'789;

struct Sinusoids {
  Vector3d amplitude[2], frequency_rad_s[2], phase[2];

  // Derivative of this order with respect to time.
  Vector3d at(double t, int order) const {
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < 2; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const double w = frequency_rad_s[i][axis];
        sum[axis] +=
            amplitude[i][axis] * std::pow(w, order) * std::sin(w * t + phase[i][axis] + order * M_PI / 2.0);
      }
    }
    return sum;
  }
};

struct TrueMotion {
  RigidTransform world_from_camera_centre;  // about which the camera moves
  RigidTransform camera_from_imu;
  Sinusoids rotation, position;

  RigidTransform worldFromImu(double t) const {
    return world_from_camera_centre * RigidTransform{quaternionExp(rotation.at(t, 0)), position.at(t, 0)} *
           camera_from_imu;
  }
  Vector3d angularVelocity(double t) const {
    return camera_from_imu.rotation.conjugate() * (so3RightJacobian(rotation.at(t, 0)) * rotation.at(t, 1));
  }
  Vector3d angularAcceleration(double t) const {
    constexpr double h = 1e-4;
    return (8.0 * (angularVelocity(t + h) - angularVelocity(t - h)) -
            (angularVelocity(t + 2 * h) - angularVelocity(t - 2 * h))) /
           (12.0 * h);
  }
  Vector3d acceleration(double t) const {
    const Matrix3d turn =
        (world_from_camera_centre.rotation * quaternionExp(rotation.at(t, 0))).toRotationMatrix();
    const Vector3d lever = camera_from_imu.translation_m;
    const Vector3d w = so3RightJacobian(rotation.at(t, 0)) * rotation.at(t, 1);
    const Vector3d a = camera_from_imu.rotation * angularAcceleration(t);
    return world_from_camera_centre.rotation * position.at(t, 2) +
           turn * (a.cross(lever) + w.cross(w.cross(lever)));
  }
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double normal() { return normal_(engine_); }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Vector3d normal3() { return {normal(), normal(), normal()}; }
  Vector3d uniform3(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }

 private:
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
};

TrueMotion makeMotion(Motion kind, const Board& board, const RigidTransform& camera_from_imu,
                      Random& random) {
  TrueMotion motion;
  motion.camera_from_imu = camera_from_imu;
  const Eigen::Vector2d middle = 0.5 * (board.point_m(0) + board.point_m(board.rows - 1, board.cols - 1));
  motion.world_from_camera_centre = {quaternionExp({0.05, -0.1, 0.1}), {middle.x(), middle.y(), -0.7}};
  for (int i = 0; i < 2; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      motion.rotation.amplitude[i][axis] = i == 0 ? 0.25 : 0.08;
      motion.position.amplitude[i][axis] = i == 0 ? 0.12 : 0.04;
      motion.rotation.frequency_rad_s[i][axis] = 2.0 * M_PI * random.uniform(0.4, 0.8) * (i + 1);
      motion.position.frequency_rad_s[i][axis] = 2.0 * M_PI * random.uniform(0.4, 0.8) * (i + 1);
    }
    motion.rotation.phase[i] = random.uniform3(M_PI);
    motion.position.phase[i] = random.uniform3(M_PI);
    switch (kind) {
      case Motion::Rich:
        break;
      case Motion::OneAxisRotation:
        motion.rotation.amplitude[i].head<2>().setZero();
        break;
      case Motion::Planar:
        motion.rotation.amplitude[i].head<2>().setZero();
        motion.position.amplitude[i].z() = 0.0;
        break;
      case Motion::HardlyMoving:
        motion.rotation.amplitude[i] *= 0.01;
        motion.position.amplitude[i] *= 0.01;
        break;
    }
  }
  return motion;
}

void fitTruth(const TrueMotion& motion, const RigOptions& options, CalibrationState& truth) {
  std::vector<double> times_s;
  std::vector<Eigen::Quaterniond> rotations;
  std::vector<Vector3d> positions;
  const double begin_s = -kMargin_s, end_s = options.duration_s + kMargin_s;
  for (double t = begin_s; t <= end_s; t += options.knot_spacing_s / 4.0) {
    times_s.push_back(t);
    rotations.push_back(motion.worldFromImu(t).rotation);
    positions.push_back(motion.worldFromImu(t).translation_m);
  }
  truth.world_from_imu_rotation = fitSo3Spline(times_s, rotations, begin_s, end_s, options.knot_spacing_s);
  truth.imu_in_world_m = fitVectorSpline(times_s, positions, begin_s, end_s, options.knot_spacing_s);
}

// Exposure times like those of automatic exposure when the light changes.
double longerExposed_s(double time_s) {
  return 3e-3 * std::sin(4.1 * time_s);
}

CameraData observe(const TrueMotion& motion, const CameraState& camera, const Board& board,
                   const BoardState& true_board, const RigOptions& options, Random& random) {
  CameraData data;
  data.name = "left";
  data.lens =
      givenLens(CameraIntrinsics{CameraModel::PinholeRadtan, {346, 260}, {260.0, 260.0}, {173.0, 130.0}, {}});
  const auto centre = [&](double camera_time_s, int circle) {
    const RigidTransform world_from_camera =
        motion.worldFromImu(referenceTime_s(camera, camera_time_s)) * camera.reference_from_camera;
    const RigidTransform camera_from_world = inverse(world_from_camera);
    const auto projected = projectCircle(*data.lens.detection_intrinsics,
                                         camera_from_world * true_board.place_m(board.point_m(circle)),
                                         camera_from_world.rotation * true_board.normal(), board.radius_m);
    return projected ? std::optional(projected->centre_px) : std::nullopt;
  };
  // The row that sees the point at its own exposure time.
  const auto rowBelowMiddle = [&](double frame_time_s, int point) {
    constexpr double kMiddleRow = 129.5;
    constexpr int kRounds = 5;
    double row = 0.0;
    for (int round = 0; round < kRounds; ++round)
      if (const auto seen = centre(frame_time_s + 1e-6 * camera.line_delay_us * row, point))
        row = seen->y() - kMiddleRow;
    return row;
  };
  if (options.frames) data.observations.kind = CameraKind::Frames;
  if (options.line_delay_us != 0.0) data.shutter = Shutter::Rolling;
  std::vector<Eigen::Vector2d> noise(static_cast<std::size_t>(board.pointCount()), Eigen::Vector2d::Zero());
  const double keep =
      options.centre_correlation_s > 0.0 ? std::exp(-options.window_s / options.centre_correlation_s) : 0.0;
  for (double t = 0.0; t < options.duration_s; t += options.window_s) {
    BoardView view;
    view.time_s = t;
    for (int i = 0; i < board.pointCount(); ++i) {
      CircleObservation circle;
      circle.circle = i;
      circle.time_s = options.frames ? t : t + random.uniform(-5e-3, 5e-3);
      if (options.frames) circle.rows_below_middle = rowBelowMiddle(t, i);
      if (options.frames && camera.exposure_share != 0.0) circle.longer_exposed_s = longerExposed_s(t);
      const auto now = centre(circle.time_s + 1e-6 * camera.line_delay_us * circle.rows_below_middle +
                                  camera.exposure_share * circle.longer_exposed_s,
                              i);
      const auto before = centre(circle.time_s - 1e-4, i), after = centre(circle.time_s + 1e-4, i);
      auto& n = noise[static_cast<std::size_t>(i)];
      n = keep * n + std::sqrt(1.0 - keep * keep) * test::randomVector<2>([&] { return random.normal(); });
      if (!now || !before || !after || now->minCoeff() < 0.0 || now->x() > 345.0 || now->y() > 259.0)
        continue;
      circle.velocity_px_s = (*after - *before) / 2e-4;
      const double stated_px = options.centre_sigma_px > 0.0 ? options.centre_sigma_px : 0.05;
      circle.covariance_px2 = stated_px * stated_px * Eigen::Matrix2d::Identity();
      circle.centre_px = *now + options.centre_sigma_px * n;
      if (!options.frames) {
        circle.edge_localisation_bias_effect = circle.velocity_px_s.normalized();
        circle.centre_px += camera.edge_localisation_bias_px * circle.velocity_px_s /
                            std::hypot(circle.velocity_px_s.norm(), 5.0);
      }
      if (random.uniform(0.0, 1.0) < options.outlier_share)
        circle.centre_px += 10.0 * random.normal3().head<2>();
      view.circles.push_back(circle);
    }
    view.kind =
        static_cast<int>(view.circles.size()) == board.pointCount() ? ViewKind::Complete : ViewKind::Partial;
    if (view.circles.size() >= 4) data.observations.views.push_back(view);
  }
  return data;
}

Vector3d forceAt(const TrueMotion& motion, double time_s, const Vector3d& gravity, const Vector3d& lever) {
  const Vector3d w = motion.angularVelocity(time_s), a = motion.angularAcceleration(time_s);
  return motion.worldFromImu(time_s).rotation.conjugate() * (motion.acceleration(time_s) - gravity) +
         a.cross(lever) + w.cross(w.cross(lever));
}

// Biases start at the state's values and walk from there; the state's values become their means.
ImuData measure(const std::string& name, const TrueMotion& motion, ImuState& imu, const Vector3d& gravity,
                const RigOptions& options, Random& random) {
  ImuData data;
  data.name = name;
  const double root_rate = std::sqrt(options.imu_rate_hz);
  const Matrix3d imu_from_reference = imu.reference_from_imu.rotation.toRotationMatrix().transpose();
  const Vector3d lever = imu.reference_from_imu.translation_m;
  Vector3d gyroscope_bias = imu.gyroscope_bias_rad_s, accelerometer_bias = imu.accelerometer_bias_m_s2;
  Vector3d gyroscope_sum = Vector3d::Zero(), accelerometer_sum = Vector3d::Zero();
  for (double t = -kMargin_s; t < options.duration_s + kMargin_s; t += 1.0 / options.imu_rate_hz) {
    const double reference_s = referenceTime_s(imu, t);
    const Vector3d force = forceAt(motion, accelerometerTime_s(imu, t), gravity, lever);
    ImuSample sample;
    sample.time_ns = kStart_ns + nanosecondsFrom(t);
    sample.angular_rate_rad_s =
        imu.gyroscopeMatrix() * (imu_from_reference * motion.angularVelocity(reference_s)) + gyroscope_bias +
        options.imu_noise * data.noise.gyroscope_density * root_rate * random.normal3();
    sample.specific_force_m_s2 =
        imu.accelerometer_scale_misalignment * (imu_from_reference * force) + accelerometer_bias +
        options.imu_noise * data.noise.accelerometer_density * root_rate * random.normal3();
    data.samples.push_back(sample);
    gyroscope_sum += gyroscope_bias;
    accelerometer_sum += accelerometer_bias;
    if (options.gyroscope_walk > 0.0) gyroscope_bias += options.gyroscope_walk / root_rate * random.normal3();
    if (options.accelerometer_walk > 0.0)
      accelerometer_bias += options.accelerometer_walk / root_rate * random.normal3();
  }
  const auto count = static_cast<double>(data.samples.size());
  if (options.gyroscope_walk > 0.0) imu.gyroscope_bias_rad_s = gyroscope_sum / count;
  if (options.accelerometer_walk > 0.0) imu.accelerometer_bias_m_s2 = accelerometer_sum / count;
  data.noise.gyroscope_random_walk = options.gyroscope_walk;
  data.noise.accelerometer_random_walk = options.accelerometer_walk;
  return data;
}

void spreadScale(const RigOptions& options, CalibrationState& truth) {
  constexpr unsigned kOther = 77;  // a separate seed: other random draws are unchanged
  Random random(options.seed + kOther);
  const PriorOptions priors;
  truth.board = options.board;
  truth.board.scale += options.scale_spread * priors.board_spacing_sigma * random.normal();
  truth.board.stretch +=
      options.scale_spread * boardStretchSigma(priors.board_spacing_sigma) * random.normal();
  truth.gravity_in_world_m_s2 *=
      1.0 + options.scale_spread * priors.gravity_norm_sigma_m_s2 * random.normal() / options.gravity_m_s2;
}

void addFrames(const TrueMotion& motion, RigOptions options, SimulatedRig& rig) {
  constexpr unsigned kOther = 555;  // a separate seed: other random draws are unchanged
  Random random(options.seed + kOther);
  CameraState camera = rig.truth.cameras.front();
  camera.time_offset_s += random.uniform(0.0, 5e-3);
  camera.edge_localisation_bias_px = 0.0;
  camera.reference_from_camera.translation_m += options.frames_apart_m;
  options.frames = true;
  options.window_s = 0.05;
  CameraData data = observe(motion, camera, rig.input.board, rig.truth.board, options, random);
  data.name = "frames";
  data.same_sensor_as = 0;
  rig.input.cameras.push_back(std::move(data));
  rig.truth.cameras.push_back(camera);
}

// A second camera that looks in another direction, and in front of it a second, rotated board.
void addFurtherBoard(const TrueMotion& motion, RigOptions options, SimulatedRig& rig) {
  constexpr unsigned kOther = 333;  // a separate seed: other random draws are unchanged
  Random random(options.seed + kOther);
  const RigidTransform first_from_second = {quaternionExp(Vector3d(0.1, 0.6, -0.2) + random.uniform3(0.1)),
                                            Vector3d(0.05, -0.02, 0.03) + random.uniform3(0.02)};
  CameraState camera = rig.truth.cameras.front();
  camera.reference_from_camera = camera.reference_from_camera * first_from_second;
  camera.time_offset_s += random.uniform(0.0, 5e-3);
  BoardState board;
  board.world_from_board = motion.worldFromImu(0.5 * options.duration_s) * camera.reference_from_camera *
                           RigidTransform{quaternionExp(random.uniform3(0.3)), Vector3d(-0.12, -0.18, 0.6)};
  rig.input.further_boards = {{"tags", rig.input.board}};
  CameraData data = observe(motion, camera, rig.input.board, board, options, random);
  data.name = "right";
  data.board = 1;
  camera.lens = data.lens;
  camera.lens.solved = data.lens.given;
  rig.input.cameras.push_back(std::move(data));
  rig.truth.cameras.push_back(camera);
  rig.truth.further_boards = {board};
}

}  // namespace

SimulatedRig simulateRig(const RigOptions& options) {
  Random random(options.seed);
  SimulatedRig rig;
  rig.input.start_ns = kStart_ns;
  CameraState camera;
  camera.reference_from_camera = {quaternionExp(Vector3d(1.2, -1.15, 1.25) + random.uniform3(0.2)),
                                  Vector3d(0.04, -0.03, 0.05) + random.uniform3(0.02)};
  camera.time_offset_s = random.uniform(-0.01, 0.01);
  camera.edge_localisation_bias_px = random.uniform(-0.3, 0.3);
  camera.time_offset_drift_ppm = options.time_offset_drift_ppm;
  camera.line_delay_us = options.line_delay_us;
  camera.exposure_share = options.exposure_share;
  if (options.frames) camera.edge_localisation_bias_px = 0.0;
  rig.truth.cameras = {camera};
  rig.truth.gravity_in_world_m_s2 =
      quaternionExp(random.uniform3(0.15)) * Vector3d(0.0, options.gravity_m_s2, 0.0);
  spreadScale(options, rig.truth);
  const TrueMotion motion =
      makeMotion(options.motion, rig.input.board, inverse(camera.reference_from_camera), random);
  for (int i = 0; i < (options.second_imu ? 2 : 1); ++i) {
    ImuState imu;
    imu.gyroscope_bias_rad_s = random.uniform3(0.02);
    imu.accelerometer_bias_m_s2 = random.uniform3(0.1);
    for (int row = 0; row < 3; ++row) {
      for (int col = row; col < 3; ++col) {
        imu.gyroscope_scale_misalignment(row, col) += random.uniform(-0.01, 0.01);
        imu.accelerometer_scale_misalignment(row, col) += random.uniform(-0.01, 0.01);
      }
    }
    imu.gyroscope_from_accelerometer = quaternionExp(options.gyroscope_turn_rad * Vector3d(0.48, -0.6, 0.64));
    imu.accelerometer_delay_s = options.accelerometer_delay_s;
    if (i > 0) {
      imu.reference_from_imu = {quaternionExp(Vector3d(0.1, 1.4, -0.3)), {0.06, -0.09, 0.05}};
      imu.time_offset_s = 3.3e-3;
      imu.time_offset_drift_ppm = -options.time_offset_drift_ppm;
    }
    rig.truth.imus.push_back(imu);
  }
  rig.input.cameras = {observe(motion, camera, rig.input.board, rig.truth.board, options, random)};
  rig.truth.cameras[0].lens = rig.input.cameras[0].lens;
  rig.truth.cameras[0].lens.solved = rig.truth.cameras[0].lens.given;
  for (ImuState& imu : rig.truth.imus) {
    rig.input.imus.push_back(measure(rig.input.imus.empty() ? "imu" : "imu_2", motion, imu,
                                     rig.truth.gravity_in_world_m_s2, options, random));
  }
  fitTruth(motion, options, rig.truth);
  if (options.frames_too) addFrames(motion, options, rig);
  if (options.further_board) addFurtherBoard(motion, options, rig);
  return rig;
}

void seeThrough(const CameraIntrinsics& truth, const CameraIntrinsics& lens, SimulatedRig& rig) {
  CameraData& camera = rig.input.cameras.front();
  seeThrough(truth, lens, camera.observations);
  camera.lens = {std::nullopt, lens};  // found first
  rig.truth.cameras.front().lens.solved = truth;
}

CalibrationState disturbed(const CalibrationState& truth, unsigned seed, double time_offset_error_s) {
  Random random(seed + 1000);
  CalibrationState state = truth;
  const Eigen::Quaterniond turn = quaternionExp(random.uniform3(2e-3));
  const Vector3d shift = random.uniform3(5e-3);
  for (auto& point : state.world_from_imu_rotation.control_points) point = point * turn;
  for (auto& point : state.imu_in_world_m.control_points) point += shift;
  for (CameraState& camera : state.cameras) {
    camera.reference_from_camera.rotation =
        camera.reference_from_camera.rotation * quaternionExp(random.uniform3(0.01));
    camera.reference_from_camera.translation_m += random.uniform3(0.02);
    camera.time_offset_s += time_offset_error_s;
    camera.lens.solved.reset();
    camera.edge_localisation_bias_px = 0.0;
    camera.time_offset_drift_ppm = camera.line_delay_us = camera.exposure_share = 0.0;
  }
  for (std::size_t i = 0; i < state.imus.size(); ++i) {
    ImuState& imu = state.imus[i];
    imu.gyroscope_bias_rad_s.setZero();
    imu.accelerometer_bias_m_s2.setZero();
    imu.gyroscope_scale_misalignment.setIdentity();
    imu.accelerometer_scale_misalignment.setIdentity();
    imu.gyroscope_from_accelerometer.setIdentity();
    imu.accelerometer_delay_s = 0.0;
    if (i == 0) continue;
    imu.reference_from_imu.rotation = imu.reference_from_imu.rotation * quaternionExp(random.uniform3(0.01));
    imu.reference_from_imu.translation_m += random.uniform3(0.02);
    imu.time_offset_s += 1e-3;
    imu.time_offset_drift_ppm = 0.0;
  }
  state.board = {};
  for (BoardState& board : state.further_boards) {
    RigidTransform& place = board.world_from_board;
    board = {};
    board.world_from_board = {place.rotation * quaternionExp(random.uniform3(0.01)),
                              place.translation_m + random.uniform3(0.02)};
  }
  state.gravity_in_world_m_s2 = quaternionExp(random.uniform3(0.01)) * state.gravity_in_world_m_s2;
  return state;
}

Eigen::VectorXd reportedErrors(const CalibrationState& estimate, const CalibrationState& truth,
                               const OptimisationOptions& options) {
  std::vector<double> errors;
  const auto append = [&](const Eigen::VectorXd& values) {
    errors.insert(errors.end(), values.begin(), values.end());
  };
  const auto appendTransform = [&](const RigidTransform& a, const RigidTransform& b) {
    append(quaternionLog(a.rotation * b.rotation.conjugate()));
    append(a.translation_m - b.translation_m);
  };
  const auto appendClock = [&](const auto& a, const auto& b) {
    errors.push_back(a.time_offset_s - timeOffsetAt_s(b, a.time_offset_at_s));
    if (options.time_offset_drift) errors.push_back(a.time_offset_drift_ppm - b.time_offset_drift_ppm);
  };
  const auto appendUpperTriangle = [&](const Matrix3d& m) {
    for (int row = 0; row < 3; ++row) {
      for (int col = row; col < 3; ++col) errors.push_back(m(row, col));
    }
  };
  for (std::size_t i = 0; i < truth.cameras.size(); ++i) {
    appendTransform(estimate.cameras[i].reference_from_camera, truth.cameras[i].reference_from_camera);
    appendClock(estimate.cameras[i], truth.cameras[i]);
    if (truth.cameras[i].line_delay_us != 0.0)
      errors.push_back(estimate.cameras[i].line_delay_us - truth.cameras[i].line_delay_us);
    if (truth.cameras[i].exposure_share != 0.0)
      errors.push_back(estimate.cameras[i].exposure_share - truth.cameras[i].exposure_share);
    errors.push_back(estimate.cameras[i].edge_localisation_bias_px -
                     truth.cameras[i].edge_localisation_bias_px);
    errors.push_back(estimate.cameras[i].slow_edge_localisation_bias_px -
                     truth.cameras[i].slow_edge_localisation_bias_px);
    if (!estimate.cameras[i].lens.solved) continue;
    const CameraIntrinsics &a = *estimate.cameras[i].lens.solved, &b = truth.cameras[i].lens.solved.value();
    append(a.focal_length_px - b.focal_length_px);
    append(a.principal_point_px - b.principal_point_px);
    for (std::size_t k = 0; k < static_cast<std::size_t>(distortionCount(b)); ++k)
      errors.push_back(a.distortion[k] - b.distortion[k]);
  }
  for (std::size_t i = 0; i < truth.imus.size(); ++i) {
    const ImuState &a = estimate.imus[i], &b = truth.imus[i];
    if (i > 0) {
      appendTransform(a.reference_from_imu, b.reference_from_imu);
      appendClock(a, b);
    }
    append(a.gyroscope_bias_rad_s - b.gyroscope_bias_rad_s);
    append(a.accelerometer_bias_m_s2 - b.accelerometer_bias_m_s2);
    appendUpperTriangle(a.gyroscope_scale_misalignment - b.gyroscope_scale_misalignment);
    appendUpperTriangle(a.accelerometer_scale_misalignment - b.accelerometer_scale_misalignment);
    errors.push_back(a.accelerometer_delay_s - b.accelerometer_delay_s);
    if (options.estimatesGyroscopeRotations())
      append(quaternionLog(b.gyroscope_from_accelerometer.conjugate() * a.gyroscope_from_accelerometer));
  }
  if (options.free_board_size) {
    errors.push_back(estimate.board.scale - truth.board.scale);
    errors.push_back(estimate.board.stretch - truth.board.stretch);
  }
  if (options.board_bow) {
    errors.push_back(estimate.board.row_curvature_1_m - truth.board.row_curvature_1_m);
    errors.push_back(estimate.board.column_curvature_1_m - truth.board.column_curvature_1_m);
    errors.push_back(estimate.board.twist_1_m - truth.board.twist_1_m);
  }
  append(gravityTilts(truth.gravity_in_world_m_s2).transpose() *
         (estimate.gravity_in_world_m_s2.normalized() - truth.gravity_in_world_m_s2.normalized()));
  if (options.free_gravity_norm)
    errors.push_back(estimate.gravity_in_world_m_s2.norm() - truth.gravity_in_world_m_s2.norm());
  return Eigen::Map<const Eigen::VectorXd>(errors.data(), static_cast<Eigen::Index>(errors.size()));
}

}  // namespace evical::test
