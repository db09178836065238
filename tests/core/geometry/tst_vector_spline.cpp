#include "core/geometry/vector_spline.h"

#include "core/geometry/so3.h"
#include "core/geometry/trajectory.h"
#include "tests/support/numeric_jacobian.h"
#include "tests/support/test_program.h"

namespace {

using namespace evical;

Eigen::Vector3d curve(double t) {
  return {std::sin(3.0 * t), std::cos(2.0 * t + 0.4), t * t - 0.3 * t};
}

VectorSpline curveSpline(double spacing_s) {
  std::vector<double> times_s;
  std::vector<Eigen::Vector3d> values;
  for (double t = -0.5; t <= 1.5; t += 0.002) {
    times_s.push_back(t);
    values.push_back(curve(t));
  }
  return fitVectorSpline(times_s, values, -0.5, 1.5, spacing_s);
}

class TestVectorSpline : public QObject {
  Q_OBJECT

 private slots:
  void derivatives_matchNumericDifferences() {
    const VectorSpline spline = curveSpline(0.05);
    for (const double time_s : {-0.41, 0.0131, 0.7777, 1.21}) {
      const VectorSample sample = evaluate(spline, time_s);
      const auto value = [&](const Eigen::VectorXd& dt) -> Eigen::VectorXd {
        return evaluate(spline, time_s + dt[0]).value;
      };
      const auto velocity = [&](const Eigen::VectorXd& dt) -> Eigen::VectorXd {
        return evaluate(spline, time_s + dt[0]).velocity;
      };
      QVERIFY((test::numericJacobian(value, 1, 1e-4) - sample.velocity).norm() < 1e-8);
      QVERIFY((test::numericJacobian(velocity, 1, 1e-4) - sample.acceleration).norm() < 1e-8);
    }
  }

  void weights_areTheJacobian() {
    const VectorSpline spline = curveSpline(0.05);
    const double time_s = 0.3123;
    const VectorSample sample = evaluate(spline, time_s);
    for (int k = 0; k < 4; ++k) {
      VectorSpline moved = spline;
      moved.control_points[static_cast<std::size_t>(sample.segment + k)].y() += 1.0;
      const VectorSample at = evaluate(moved, time_s);
      QVERIFY(std::abs(at.value.y() - sample.value.y() - sample.value_weights[k]) < 1e-12);
      QVERIFY(std::abs(at.velocity.y() - sample.velocity.y() - sample.velocity_weights[k]) < 1e-10);
      QVERIFY(std::abs(at.acceleration.y() - sample.acceleration.y() - sample.acceleration_weights[k]) <
              1e-8);
    }
  }

  void fit_errorFallsWithFourthPowerOfSpacing() {
    const auto worst = [](double spacing_s) {
      const VectorSpline spline = curveSpline(spacing_s);
      double error = 0.0;
      for (double t = -0.3; t < 1.3; t += 0.011)
        error = std::max(error, (evaluate(spline, t).value - curve(t)).norm());
      return error;
    };
    const double ratio = worst(0.2) / worst(0.1);
    QVERIFY2(ratio > 10.0 && ratio < 25.0, qPrintable(QString::number(ratio)));
  }

  void fit_bridgesGaps() {
    const std::vector<double> times_s = {0.0, 0.05, 0.1, 0.9, 0.95, 1.0};
    std::vector<Eigen::Vector3d> values;
    for (const double t : times_s) values.push_back(Eigen::Vector3d(t, 2.0 * t, 1.0));
    const VectorSpline spline = fitVectorSpline(times_s, values, 0.0, 1.0, 0.02);
    QVERIFY((evaluate(spline, 0.5).value - Eigen::Vector3d(0.5, 1.0, 1.0)).norm() < 1e-4);
  }

  void trajectory_ofCamera_addsOffsetAndExtrinsics() {
    const VectorSpline position = curveSpline(0.05);
    So3Spline rotation = makeUniformSo3Spline(-0.5, 1.5, 0.05);
    for (std::size_t k = 0; k < rotation.control_points.size(); ++k) {
      rotation.control_points[k] =
          quaternionExp(0.05 * static_cast<double>(k) * Eigen::Vector3d(0.3, -0.2, 0.5));
    }
    const RigidTransform reference_from_camera = {quaternionExp({0.1, 0.2, 0.3}), {0.01, 0.02, 0.03}};
    const RigidTransform camera_from_world =
        cameraFromWorld(rotation, position, reference_from_camera, 0.1, 0.4);
    const MotionSample motion = motionAt(rotation, position, 0.5);
    const Eigen::Vector3d point_in_world =
        motion.world_from_imu * (reference_from_camera * Eigen::Vector3d(1.0, 2.0, 3.0));
    QVERIFY((camera_from_world * point_in_world - Eigen::Vector3d(1.0, 2.0, 3.0)).norm() < 1e-12);
    QVERIFY((motion.velocity_m_s - evaluate(position, 0.5).velocity).norm() < 1e-12);
  }
};

}  // namespace

EVICAL_TEST(TestVectorSpline)
#include "tst_vector_spline.moc"
