// Residuals and derivatives of priors, fixed axes and smoothness at known states.
#include "core/optimisation/bias_knots.h"
#include "core/optimisation/prior_cost.h"
#include "core/optimisation/trajectory_smoothness.h"
#include "tests/core/optimisation/residual_states.h"
#include "tests/support/test_program.h"

namespace {

using namespace evical;
using namespace evical::test;

class TestPriorCost : public QObject {
  Q_OBJECT

 private slots:
  void driftPriors_areZeroWithoutDrift() {
    BiasDrift drift{0.0, 2.0, std::vector<Vector3d>(4, Vector3d::Zero()), {}};
    const BiasStepCost step(0.1);
    QCOMPARE(residualsAt(step, {{1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}}).norm(), 0.0);
    QVERIFY(std::abs(residualsAt(step, {{1.0, 2.0, 3.0}, {1.0, 2.2, 3.0}})[1] - 2.0) < 1e-12);
    QVERIFY(worstJacobianError(step, {{1.0, 2.0, 3.0}, {1.1, 2.2, 3.1}}) < 1e-9);
    // Outer knots represent half as much time.
    const BiasMeanCost mean(drift, 0.1);
    const Blocks balanced = {{2.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, {-1.0, 0.0, 0.0}};
    QVERIFY(residualsAt(mean, balanced).norm() < 1e-12);
    QVERIFY(residualsAt(mean, {{3.0, 0, 0}, {3.0, 0, 0}, {3.0, 0, 0}, {3.0, 0, 0}}).norm() > 29.0);
    QVERIFY(worstJacobianError(mean, balanced) < 1e-9);
  }

  void prior_isZeroAtItsMean() {
    const double mean[3] = {1.0, 2.0, 3.0};
    const PriorCost cost(mean, 3, 0.5);
    QCOMPARE(residualsAt(cost, {{1.0, 2.0, 3.0}}).norm(), 0.0);
    QVERIFY(worstJacobianError(cost, {{1.5, 2.5, 2.0}}) < 1e-9);
  }

  void priors_countTheirSigmasAxisByAxis() {
    const PriorCost cost(Vector3d(1.0, 2.0, 3.0), Vector3d(0.1, 0.2, 0.5));
    QVERIFY((residualsAt(cost, {{1.1, 2.2, 3.5}}) - Vector3d::Ones()).norm() < 1e-12);
    QVERIFY(worstJacobianError(cost, {{1.5, 2.5, 2.0}}) < 1e-9);
    const NormCost norm(9.79, 0.05);
    QVERIFY(std::abs(residualsAt(norm, {{0.0, 5.904, 7.872}})[0] - 1.0) < 1e-9);
    QVERIFY(worstJacobianError(norm, {{0.3, 5.9, 7.8}}) < 1e-7);
  }

  // About the axes of the frame into which the rotation turns, as sigmas are reported.
  void rotationPrior_countsTurnsAboutTheReferencesAxes() {
    const Eigen::Quaterniond mean = quaternionExp({1.2, -1.1, 0.9});
    const RotationPriorCost cost(mean, Vector3d(0.01, 0.02, 0.04));
    QVERIFY(residualsAt(cost, {States::numbers(mean)}).norm() < 1e-12);
    const Eigen::Quaterniond turned = quaternionExp({0.01, 0.02, 0.04}) * mean;
    QVERIFY((residualsAt(cost, {States::numbers(turned)}) - Vector3d::Ones()).norm() < 1e-9);
    const Eigen::Quaterniond far = quaternionExp({0.4, -0.6, 0.3}) * mean;
    QVERIFY(worstJacobianError(cost, {States::numbers(far)}) < 1e-6);
    const RotationPriorCost local(mean, Vector3d(0.01, 0.02, 0.04), PriorAxes::Source);
    const Eigen::Quaterniond turned_before = mean * quaternionExp({0.01, 0.02, 0.04});
    QVERIFY((residualsAt(local, {States::numbers(turned_before)}) - Vector3d::Ones()).norm() < 1e-9);
    QVERIFY(worstJacobianError(local, {States::numbers(far)}) < 1e-6);
  }

  void heldTranslations_stayAtTheirPriors() {
    const HeldTranslationCost translation(Vector3d::UnitZ(), Vector3d(9.0, 9.0, 0.05), 0.01);
    QVERIFY(std::abs(residualsAt(translation, {{0.3, 0.8, 0.06}})[0] - 1.0) < 1e-12);
  }

  void rotationPrior_isItsAngleInSigmas() {
    const RotationPriorCost cost(Eigen::Quaterniond::Identity(), Vector3d::Constant(0.02));
    const Vector3d turn(0.006, -0.01, 0.004);
    const Blocks blocks = {States::numbers(quaternionExp(turn))};
    QVERIFY((residualsAt(cost, blocks) - turn / 0.02).norm() < 1e-4);
    QVERIFY(worstJacobianError(cost, blocks) < 1e-7);
    Eigen::Quaterniond same = quaternionExp(turn);
    same.coeffs() = -same.coeffs();
    QVERIFY((residualsAt(cost, {States::numbers(same)}) - turn / 0.02).norm() < 1e-4);
    QVERIFY(worstJacobianError(cost, {States::numbers(same)}) < 1e-7);
  }

  void heldTranslation_isZeroAcrossItsAxis() {
    const HeldTranslationCost cost(Vector3d(0.0, 0.6, 0.8), Vector3d::Zero(), 0.01);
    QVERIFY(residualsAt(cost, {{0.3, 0.8, -0.6}}).norm() < 1e-12);
    QVERIFY(std::abs(residualsAt(cost, {{0.3, 0.006, 0.008}})[0] - 1.0) < 1e-12);
    QVERIFY(worstJacobianError(cost, {{0.3, 0.1, 0.2}}) < 1e-9);
  }

  void smoothness_isZeroAtConstantVelocity() {
    const SmoothPositionCost position(kSpacing_s, 30.0);
    QVERIFY(residualsAt(position, {{1.0, 2.0, 3.0}, {1.1, 2.0, 2.9}, {1.2, 2.0, 2.8}}).norm() < 1e-9);
    QVERIFY(std::abs(residualsAt(position, {{0, 0, 0}, {0, 0, 0}, {0, 0.012, 0}})[1] - 1.0) < 1e-9);
    QVERIFY(worstJacobianError(position, {{1.0, 2.0, 3.0}, {1.3, 2.2, 2.9}, {1.2, 2.1, 2.8}}) < 1e-7);
    const SmoothRotationCost rotation(kSpacing_s, 200.0);
    const auto block = [](const Vector3d& angle) {
      const Eigen::Vector4d xyzw = quaternionExp(angle).coeffs();
      return std::vector<double>(xyzw.data(), xyzw.data() + 4);
    };
    const Vector3d step(0.05, -0.1, 0.2);
    QVERIFY(residualsAt(rotation, {block(step), block(2.0 * step), block(3.0 * step)}).norm() < 1e-9);
    const Vector3d bent(0.0, 0.0, 0.08);  // 200 rad/s^2
    QVERIFY(std::abs(residualsAt(rotation, {block({0, 0, 0}), block({0, 0, 0}), block(bent)})[2] - 1.0) <
            1e-9);
    QVERIFY(worstJacobianError(rotation, {block(step), block({0.3, 0.2, 0.1}), block({-0.1, 0.4, 0.3})}) <
            1e-6);
  }
};

}  // namespace

EVICAL_TEST(TestPriorCost)
#include "tst_prior_cost.moc"
