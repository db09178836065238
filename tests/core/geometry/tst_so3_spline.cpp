#include "core/geometry/so3_spline.h"

#include "core/geometry/so3.h"
#include "tests/support/numeric_jacobian.h"
#include "tests/support/random_vector.h"
#include "tests/support/test_program.h"

#include <random>

namespace {

using namespace evical;

Eigen::Vector3d randomVector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return size * test::randomVector<3>([&] { return uniform(random); });
}

So3Spline randomSpline(double step_rad, unsigned seed, double knot_spacing_s = 0.05) {
  std::mt19937 random(seed);
  So3Spline spline = makeUniformSo3Spline(1.0, 1.0 + 8.0 * knot_spacing_s, knot_spacing_s,
                                          quaternionExp(randomVector(random, 2.0)));
  for (std::size_t k = 1; k < spline.control_points.size(); ++k) {
    const Eigen::Vector3d direction = randomVector(random, 1.0).normalized();
    spline.control_points[k] = spline.control_points[k - 1] * quaternionExp(step_rad * direction);
  }
  return spline;
}

Eigen::VectorXd stacked(const RotationSample& sample, const Eigen::Matrix3d& reference) {
  Eigen::VectorXd values(9);
  values << so3Log(reference.transpose() * sample.rotation), sample.angular_velocity_rad_s,
      sample.angular_acceleration_rad_s2;
  return values;
}

class TestSo3Spline : public QObject {
  Q_OBJECT

 private slots:
  void jacobians_matchNumericDifferences_data() {
    QTest::addColumn<double>("step_rad");
    QTest::addColumn<double>("u");
    for (const double step : {0.0, 1e-9, 1e-5, 3e-4, 0.01, 0.3, 1.5, 3.0, 3.1}) {
      for (const double u : {0.0, 0.37, 0.999999, 1.0}) {
        QTest::addRow("step %g u %g", step, u) << step << u;
      }
    }
  }

  void jacobians_matchNumericDifferences() {
    QFETCH(double, step_rad);
    QFETCH(double, u);
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const So3Spline spline = randomSpline(step_rad, seed);
      constexpr int kSegment = 2;
      RotationSample sample;
      RotationJacobians jacobians;
      So3Segment(spline, kSegment, true).evaluate(u, RotationOrder::Acceleration, sample, &jacobians);
      const auto perturbed = [&](const Eigen::VectorXd& delta) {
        So3Spline moved = spline;
        for (int k = 0; k < 4; ++k) {
          auto& point = moved.control_points[static_cast<std::size_t>(kSegment + k)];
          point = point * quaternionExp(delta.segment<3>(3 * k));
        }
        RotationSample at;
        So3Segment(moved, kSegment, false).evaluate(u, RotationOrder::Acceleration, at);
        return stacked(at, sample.rotation);
      };
      Eigen::MatrixXd analytic(9, 12);
      for (int k = 0; k < 4; ++k) {
        const auto i = static_cast<std::size_t>(k);
        analytic.middleCols<3>(3 * k) << jacobians.rotation[i], jacobians.velocity[i],
            jacobians.acceleration[i];
      }
      const Eigen::MatrixXd numeric = test::numericJacobian(perturbed, 12, 1e-3);
      const auto worst = [&](int row) {
        return test::relativeDifference(analytic.middleRows(row, 3), numeric.middleRows(row, 3));
      };
      QVERIFY2(worst(0) < 1e-8, qPrintable(QString::number(worst(0))));
      QVERIFY2(worst(3) < 1e-8, qPrintable(QString::number(worst(3))));
      QVERIFY2(worst(6) < 1e-8, qPrintable(QString::number(worst(6))));
    }
  }

  void angularRates_areTimeDerivatives() {
    const So3Spline spline = randomSpline(0.4, 7);
    for (const double time_s : {1.012, 1.1, 1.1771, 1.2, 1.39}) {
      const RotationSample sample = evaluate(spline, time_s);
      const auto rotation = [&](const Eigen::VectorXd& dt) -> Eigen::VectorXd {
        return so3Log(sample.rotation.transpose() * evaluate(spline, time_s + dt[0]).rotation);
      };
      const auto velocity = [&](const Eigen::VectorXd& dt) -> Eigen::VectorXd {
        return evaluate(spline, time_s + dt[0]).angular_velocity_rad_s;
      };
      // At knots only two derivatives are continuous, so differences there are of second order in the step.
      QVERIFY((test::numericJacobian(rotation, 1, 1e-5) - sample.angular_velocity_rad_s).norm() < 1e-6);
      QVERIFY((test::numericJacobian(velocity, 1, 1e-6) - sample.angular_acceleration_rad_s2).norm() < 2e-2);
    }
  }

  void evaluate_acrossKnots_isContinuous() {
    const So3Spline spline = randomSpline(0.8, 3);
    const double knot_s = spline.start_s + 3 * spline.knot_spacing_s;
    const RotationSample before = evaluate(spline, knot_s - 1e-9), after = evaluate(spline, knot_s + 1e-9);
    QVERIFY(so3Log(before.rotation.transpose() * after.rotation).norm() < 1e-6);
    QVERIFY((before.angular_velocity_rad_s - after.angular_velocity_rad_s).norm() < 1e-5);
    QVERIFY((before.angular_acceleration_rad_s2 - after.angular_acceleration_rad_s2).norm() < 1e-3);
  }

  void evaluate_ofConstantSpin_isExact() {
    const Eigen::Vector3d rate_rad_s(0.7, -1.1, 2.0);
    So3Spline spline = makeUniformSo3Spline(0.0, 1.0, 0.1);
    for (std::size_t k = 0; k < spline.control_points.size(); ++k) {
      spline.control_points[k] = quaternionExp(rate_rad_s * (0.1 * (static_cast<double>(k) - 1.0)));
    }
    const RotationSample sample = evaluate(spline, 0.4321);
    QVERIFY(so3Log(so3Exp(rate_rad_s * 0.4321).transpose() * sample.rotation).norm() < 1e-12);
    QVERIFY((sample.angular_velocity_rad_s - rate_rad_s).norm() < 1e-11);
    QVERIFY(sample.angular_acceleration_rad_s2.norm() < 1e-9);
  }

  void fit_recoversSpline() {
    const So3Spline truth = randomSpline(0.3, 5);
    std::vector<double> times_s;
    std::vector<Eigen::Quaterniond> rotations;
    for (double t = truth.start_s; t <= truth.endTime_s(); t += 0.004) {
      times_s.push_back(t);
      rotations.emplace_back(evaluate(truth, t).rotation);
    }
    const So3Spline fit =
        fitSo3Spline(times_s, rotations, truth.start_s, truth.endTime_s(), truth.knot_spacing_s);
    QCOMPARE(fit.control_points.size(), truth.control_points.size());
    for (const double t : times_s) {
      QVERIFY(so3Log(evaluate(fit, t).rotation.transpose() * evaluate(truth, t).rotation).norm() < 1e-5);
    }
  }

  void fit_acrossGap_staysFinite() {
    const std::vector<double> times_s = {0.0, 0.05, 0.1, 0.9, 0.95};
    const std::vector<Eigen::Quaterniond> rotations(5, quaternionExp({0.1, 0.2, 0.3}));
    const So3Spline fit = fitSo3Spline(times_s, rotations, 0.0, 1.0, 0.02);
    for (const auto& point : fit.control_points) QVERIFY(point.angularDistance(rotations[0]) < 1e-6);
  }

  void place_isClampedToTheSegments() {
    const So3Spline spline = makeUniformSo3Spline(2.0, 3.0, 0.1);
    QCOMPARE(spline.segmentCount(), 10);
    QCOMPARE(placeInSpline(spline, 1.95).segment, 0);
    QVERIFY(placeInSpline(spline, 1.95).u < 0.0);
    QCOMPARE(placeInSpline(spline, 3.0).segment, 9);
    QCOMPARE(placeInSpline(spline, 2.55).segment, 5);
  }

  void evaluateWithJacobians_speed() {
    const So3Spline spline = randomSpline(0.3, 5);
    const So3Segment segment(spline, 2, true);
    RotationSample sample;
    RotationJacobians jacobians;
    double sum = 0.0;
    QBENCHMARK {
      for (int i = 0; i < 1000; ++i) {
        segment.evaluate(i * 1e-3, RotationOrder::Acceleration, sample, &jacobians);
        sum += jacobians.acceleration[2](1, 1);
      }
    }
    QVERIFY(std::isfinite(sum));
  }
};

}  // namespace

EVICAL_TEST(TestSo3Spline)
#include "tst_so3_spline.moc"
