// The batch's measurement models again, with other formulas and for automatic derivatives: the product rule
// for matrices instead of the recursions of so3_spline.cpp, the dual conic as a 3 x 3 matrix instead of its
// entries.
#pragma once

#include "core/geometry/camera_model.h"
#include "core/optimisation/inertial_cost.h"
#include "tests/core/optimisation/residual_states.h"

#include <ceres/dynamic_autodiff_cost_function.h>
#include <ceres/rotation.h>
#include <Eigen/LU>

#include <optional>
#include <utility>

namespace evical::test {

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;

template <class T>
Vector3<T> vectorAt(const T* block) {
  return Eigen::Map<const Vector3<T>>(block);
}

template <class T>
Matrix3<T> cross(const Vector3<T>& v) {
  Matrix3<T> m;
  m << T(0.0), -v[2], v[1], v[2], T(0.0), -v[0], -v[1], v[0], T(0.0);
  return m;
}

// A quaternion block x y z w, multiplied on the right by the rotation of the twin's three parameters.
template <class T>
std::array<T, 4> turned(const std::vector<double>& xyzw, const T* delta) {
  const std::array<T, 4> base = {T(xyzw[3]), T(xyzw[0]), T(xyzw[1]), T(xyzw[2])};  // Ceres has w first
  std::array<T, 4> step, result;
  ceres::AngleAxisToQuaternion(delta, step.data());
  ceres::QuaternionProduct(base.data(), step.data(), result.data());
  return result;
}

template <class T>
Matrix3<T> matrixOf(const std::array<T, 4>& wxyz) {
  Matrix3<T> rotation;
  ceres::QuaternionToRotation(wxyz.data(), ceres::ColumnMajorAdapter3x3(rotation.data()));
  return rotation;
}

// Log(a^T b).
template <class T>
Vector3<T> logBetween(const std::array<T, 4>& a, const std::array<T, 4>& b) {
  const std::array<T, 4> inverse = {a[0], -a[1], -a[2], -a[3]};
  std::array<T, 4> between;
  ceres::QuaternionProduct(inverse.data(), b.data(), between.data());
  Vector3<T> log;
  ceres::QuaternionToAngleAxis(between.data(), log.data());
  return log;
}

template <class T>
struct TwinRotation {
  Matrix3<T> value, first_s, second_s2;  // R, dR/dt, d2R/dt2

  Vector3<T> velocity() const { return unskew(value.transpose() * first_s); }
  Vector3<T> acceleration() const {
    const Matrix3<T> w = value.transpose() * first_s;
    return unskew(value.transpose() * second_s2 - w * w);
  }
  static Vector3<T> unskew(const Matrix3<T>& m) { return {m(2, 1), m(0, 2), m(1, 0)}; }
};

// R_0 Exp(l_1 d_1) Exp(l_2 d_2) Exp(l_3 d_3), the product rule for its derivatives.
template <class T>
TwinRotation<T> rotationAt(const Blocks& base, T const* const* parameters, const T& place, double spacing_s) {
  const T u = place, u2 = u * u, u3 = u2 * u;
  const double rate = 1.0 / spacing_s;
  const std::array<T, 3> l = {(5.0 + 3.0 * u - 3.0 * u2 + u3) / 6.0,
                              (1.0 + 3.0 * u + 3.0 * u2 - 2.0 * u3) / 6.0, u3 / 6.0};
  const std::array<T, 3> l1 = {rate * (1.0 - 2.0 * u + u2) / 2.0, rate * (1.0 + 2.0 * u - 2.0 * u2) / 2.0,
                               rate * u2 / 2.0};
  const std::array<T, 3> l2 = {rate * rate * (u - 1.0), rate * rate * (1.0 - 2.0 * u), rate * rate * u};
  std::array<std::array<T, 4>, 4> points;
  for (std::size_t k = 0; k < 4; ++k) points[k] = turned(base[k], parameters[k]);
  TwinRotation<T> r = {matrixOf(points[0]), Matrix3<T>::Zero(), Matrix3<T>::Zero()};
  for (std::size_t j = 0; j < 3; ++j) {
    const Vector3<T> d = logBetween(points[j], points[j + 1]), angle = l[j] * d;
    Matrix3<T> a;
    ceres::AngleAxisToRotationMatrix(angle.data(), ceres::ColumnMajorAdapter3x3(a.data()));
    const Matrix3<T> k = cross(d);
    const Matrix3<T> a1 = l1[j] * a * k, a2 = l2[j] * a * k + l1[j] * l1[j] * a * k * k;
    r = {r.value * a, r.first_s * a + r.value * a1,
         r.second_s2 * a + T(2.0) * (r.first_s * a1).eval() + r.value * a2};
  }
  return r;
}

// Sum of the control points by de Boor's basis, or by its second derivative.
template <class T>
Vector3<T> positionAt(T const* const* parameters, const T& place) {
  const T u = place, v = 1.0 - u;
  return v * v * v / 6.0 * vectorAt(parameters[0]) +
         (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0 * vectorAt(parameters[1]) +
         (3.0 * v * v * v - 6.0 * v * v + 4.0) / 6.0 * vectorAt(parameters[2]) +
         u * u * u / 6.0 * vectorAt(parameters[3]);
}
template <class T>
Vector3<T> accelerationAt(T const* const* parameters, const T& place, double spacing_s) {
  const T u = place, v = 1.0 - u;
  const Vector3<T> sum = v * vectorAt(parameters[0]) + (3.0 * u - 2.0) * vectorAt(parameters[1]) +
                         (3.0 * v - 2.0) * vectorAt(parameters[2]) + u * vectorAt(parameters[3]);
  return sum / T(spacing_s * spacing_s);
}

template <class T>
Matrix3<T> mappingAt(const T* upper) {
  Matrix3<T> m;
  m << upper[0], upper[1], upper[2], T(0.0), upper[3], upper[4], T(0.0), T(0.0), upper[5];
  return m;
}

// Deviation of a bias from its mean, linear between two knots.
template <class T>
Vector3<T> driftAt(const DriftTimes& drift, double time_s, const T* before, const T* after) {
  const double share = (time_s - drift.start_s) / drift.length_s;
  return T(1.0 - share) * vectorAt(before) + T(share) * vectorAt(after);
}

struct GyroscopeTwin {
  Blocks base;
  bool further;
  double sigma;
  SegmentTimes segment;
  std::vector<InertialMeasurement> samples;
  std::optional<DriftTimes> drift;

  template <class T>
  bool operator()(T const* const* p, T* residuals) const {
    const std::size_t last = further ? 10 : 7;
    const Matrix3<T> mapping = mappingAt(p[5]) * matrixOf(turned(base[6], p[6]));
    const Matrix3<T> reference_from_imu =
        further ? matrixOf(turned(base[7], p[7])) : Matrix3<T>(Matrix3<T>::Identity());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const T time_s =
          further ? samples[i].time_s + p[8][0] + samples[i].by_drift_s * p[9][0] : T(samples[i].time_s);
      const T place = (time_s - segment.rotation_start_s) / segment.rotation_spacing_s;
      Vector3<T> rate = mapping * (reference_from_imu.transpose() *
                                   rotationAt(base, p, place, segment.rotation_spacing_s).velocity()) +
                        vectorAt(p[4]) - samples[i].value.template cast<T>();
      if (drift) rate += driftAt(*drift, samples[i].time_s, p[last], p[last + 1]);
      Eigen::Map<Vector3<T>>(residuals + 3 * i) = rate / T(sigma);
    }
    return true;
  }
};

struct AccelerometerTwin {
  Blocks base;
  bool further;
  double sigma;
  SegmentTimes segment;
  std::vector<InertialMeasurement> samples;
  std::optional<DriftTimes> drift;

  template <class T>
  bool operator()(T const* const* p, T* residuals) const {
    const std::size_t last = further ? 16 : 12;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      T time_s = samples[i].time_s - p[11][0];
      if (further) time_s += p[14][0] + samples[i].by_drift_s * p[15][0];
      const T place = (time_s - segment.rotation_start_s) / segment.rotation_spacing_s;
      const TwinRotation<T> rotation = rotationAt(base, p, place, segment.rotation_spacing_s);
      const T position_place = (time_s - segment.position_start_s) / segment.position_spacing_s;
      Vector3<T> in_world =
          accelerationAt(p + 4, position_place, segment.position_spacing_s) - vectorAt(p[8]);
      // The lever arm's own acceleration, in the world: R'' l.
      if (further) in_world += rotation.second_s2 * vectorAt(p[13]);
      Vector3<T> force = rotation.value.transpose() * in_world;
      if (further) force = matrixOf(turned(base[12], p[12])).transpose() * force;
      Vector3<T> error = mappingAt(p[10]) * force + vectorAt(p[9]) - samples[i].value.template cast<T>();
      if (drift) error += driftAt(*drift, samples[i].time_s, p[last], p[last + 1]);
      Eigen::Map<Vector3<T>>(residuals + 3 * i) = error / T(sigma);
    }
    return true;
  }
};

// OpenCV's equations; `d`: k1 k2 p1 p2 k3.
template <class T>
Eigen::Matrix<T, 2, 1> radtanPoint(const std::array<T, 5>& d, const T& x, const T& y) {
  const T r2 = x * x + y * y;
  const T radial = 1.0 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]));
  return {x * radial + 2.0 * d[2] * x * y + d[3] * (r2 + 2.0 * x * x),
          y * radial + d[2] * (r2 + 2.0 * y * y) + 2.0 * d[3] * x * y};
}

// Image radius of a point at r = tan(theta), by angles: from the point xi behind the first sphere's centre at
// tan(phi) = sin(theta) / (cos(theta) + xi), and from there, on the second sphere, sin(phi) / (alpha + (1 -
// alpha) cos(phi)).
template <class T>
T radiusOf(CameraModel model, const T* d, const T& r) {
  const T theta = atan(r), theta2 = theta * theta;
  if (model == CameraModel::PinholeEquidistant)
    return theta * (1.0 + theta2 * (d[0] + theta2 * (d[1] + theta2 * (d[2] + theta2 * d[3]))));
  if (model == CameraModel::OmniRadtan) return sin(theta) / (cos(theta) + d[0]);
  if (model == CameraModel::DoubleSphere) {
    const T phi = atan2(sin(theta), cos(theta) + d[0]);
    return sin(phi) / (d[1] + (1.0 - d[1]) * cos(phi));
  }
  const T phi = atan(sqrt(d[1]) * r);  // EUCM: an ellipsoid for the sphere
  return sin(phi) / sqrt(d[1]) / (d[0] + (1.0 - d[0]) * cos(phi));
}

// Sensor position of a point at (x/z, y/z). `numbers`: fx fy cx cy d0..d4.
template <class T>
Eigen::Matrix<T, 2, 1> pixelOf(CameraModel model, const T* numbers, const T& x, const T& y) {
  const T* d = numbers + 4;
  Eigen::Matrix<T, 2, 1> point(x, y);
  if (model != CameraModel::PinholeRadtan) {
    const T r = sqrt(x * x + y * y);
    point *= radiusOf(model, d, r) / r;
  }
  if (model == CameraModel::PinholeRadtan) point = radtanPoint<T>({d[0], d[1], d[2], d[3], d[4]}, x, y);
  if (model == CameraModel::OmniRadtan)
    point = radtanPoint<T>({d[1], d[2], d[3], d[4], T(0.0)}, T(point[0]), T(point[1]));
  return {numbers[0] * point[0] + numbers[2], numbers[1] * point[1] + numbers[3]};
}

struct CircleTwin {
  Blocks base;
  CircleModel model;
  SegmentTimes segment;
  std::vector<CircleMeasurement> circles;

  // (x/z, y/z) of the centre of the ellipse: the last column of H C* H^T, C* = diag(r^2, r^2, -1).
  template <class T>
  Eigen::Matrix<T, 2, 1> normalisedCentre(T const* const* p, const CircleMeasurement& circle) const {
    const T time_s = circle.time_s + p[10][0] + circle.by_drift_s * p[11][0] + circle.by_line_s * p[12][0] +
                     circle.by_exposure_s * p[20][0];
    const T rotation_place = (time_s - segment.rotation_start_s) / segment.rotation_spacing_s;
    const T position_place = (time_s - segment.position_start_s) / segment.position_spacing_s;
    const Matrix3<T> world_from_imu = rotationAt(base, p, rotation_place, segment.rotation_spacing_s).value;
    const Matrix3<T> imu_from_camera = matrixOf(turned(base[8], p[8]));
    const Matrix3<T> camera_from_world = (world_from_imu * imu_from_camera).transpose();
    const Vector3<T> camera_in_world = world_from_imu * vectorAt(p[9]) + positionAt(p + 4, position_place);
    const Matrix3<T> world_from_board = matrixOf(turned(base[21], p[21]));
    const Vector3<T> centre_on_sheet(p[15][0] * (1.0 + p[16][0] / 2.0) * circle.on_board_m.x(),
                                     p[15][0] * (1.0 - p[16][0] / 2.0) * circle.on_board_m.y(),
                                     (p[17][0] * circle.on_board_m.x() * circle.on_board_m.x() +
                                      p[18][0] * circle.on_board_m.y() * circle.on_board_m.y()) /
                                             2.0 +
                                         p[19][0] * circle.on_board_m.x() * circle.on_board_m.y());
    Matrix3<T> h = camera_from_world * world_from_board;
    h.col(2) = camera_from_world * (world_from_board * centre_on_sheet + vectorAt(p[22]) - camera_in_world);
    const T r2(model.radius_m * model.radius_m);
    const Vector3<T> dual(r2, r2, T(-1.0));
    const Matrix3<T> conic = h * dual.asDiagonal() * h.transpose();
    return {conic(0, 2) / conic(2, 2), conic(1, 2) / conic(2, 2)};
  }

  template <class T>
  Eigen::Matrix<T, 2, 1> idealPixelOf(T const* const* p, const CircleMeasurement& circle) const {
    const Eigen::Matrix<T, 2, 1> centre = normalisedCentre(p, circle);
    if (!model.free_intrinsics)
      return centre.cwiseProduct(idealFocalLength_px(model.camera).template cast<T>()) +
             model.camera.principal_point_px.template cast<T>();
    const Eigen::Matrix2d ideal_from_sensor = idealPixelScale(model.camera, circle.centre_px);
    const Eigen::Vector2d seen = pixelFromIdeal(model.camera, circle.centre_px);
    const Eigen::Matrix<T, 2, 1> off =
        pixelOf(model.camera.model, p[23], centre[0], centre[1]) - seen.template cast<T>();
    return circle.centre_px.template cast<T>() + ideal_from_sensor.template cast<T>() * off;
  }

  template <class T>
  bool operator()(T const* const* p, T* residuals) const {
    for (std::size_t i = 0; i < circles.size(); ++i) {
      const CircleMeasurement& circle = circles[i];
      const Eigen::Matrix<T, 2, 1> lead = p[13][0] * circle.lead.of_lead.template cast<T>() +
                                          p[14][0] * circle.lead.of_slow.template cast<T>();
      Eigen::Matrix<T, 2, 1> error = circle.whitening_px.template cast<T>() *
                                     (idealPixelOf(p, circle) + lead - circle.centre_px.template cast<T>());
      const T length = sqrt(error.squaredNorm());
      const double huber = model.huber_sigma;
      if (length > huber) error *= sqrt(2.0 * huber * length - huber * huber) / length;
      Eigen::Map<Eigen::Matrix<T, 2, 1>>(residuals + 2 * i) = error;
    }
    return true;
  }
};

// Largest difference of residuals and of derivatives, relative to the largest of a block (but at least 1).
template <class Twin>
double worstDifference(const ceres::CostFunction& cost, Twin twin, const Blocks& blocks) {
  using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  twin.base = blocks;
  ceres::DynamicAutoDiffCostFunction<Twin, 8> automatic(new Twin(std::move(twin)));
  Blocks at = blocks;
  std::vector<RowMajorMatrix> expected, analytic;
  for (std::vector<double>& block : at) {
    if (isQuaternion(block)) block.assign(3, 0.0);
    automatic.AddParameterBlock(static_cast<int>(block.size()));
    expected.emplace_back(cost.num_residuals(), static_cast<Eigen::Index>(block.size()));
  }
  automatic.SetNumResiduals(cost.num_residuals());
  for (const std::vector<double>& block : blocks)
    analytic.emplace_back(cost.num_residuals(), static_cast<Eigen::Index>(block.size()));
  const auto evaluate = [&](const ceres::CostFunction& function, const Blocks& values,
                            std::vector<RowMajorMatrix>& matrices) {
    std::vector<const double*> pointers;
    std::vector<double*> jacobians;
    for (const std::vector<double>& block : values) pointers.push_back(block.data());
    for (RowMajorMatrix& matrix : matrices) jacobians.push_back(matrix.data());
    Eigen::VectorXd residuals(cost.num_residuals());
    function.Evaluate(pointers.data(), residuals.data(), jacobians.data());
    return residuals;
  };
  const Eigen::VectorXd residuals = evaluate(cost, blocks, analytic);
  double worst = relativeDifference(residuals, evaluate(automatic, at, expected));
  for (std::size_t i = 0; i < blocks.size(); ++i)
    worst = std::max(worst, relativeDifference(analytic[i].leftCols(expected[i].cols()), expected[i]));
  return worst;
}

}  // namespace evical::test
