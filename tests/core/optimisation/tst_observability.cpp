// Interpretation of given covariances: the requirement that is not met, and its direction.
#include "core/optimisation/uncertainty/observability.h"

#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/optimisation/uncertainty/scale_check.h"
#include "tests/support/test_program.h"

#include <cmath>
#include <limits>

namespace {

using namespace evical;
using Eigen::Vector3d;

// One camera and one IMU; the camera's rotation, translation and time offset in columns 0 to 6.
struct Rig {
  CalibrationInput input;
  CalibrationState state;
  QuantityCovariance covariance;
  OptimisationOptions options;

  Rig() {
    input.cameras.resize(1);
    input.cameras[0].name = "left";
    input.imus.resize(1);
    input.imus[0].name = "imu";
    state.cameras.resize(1);
    state.imus.resize(1);
    options.needed_rotation_deg = 0.1;
    options.needed_translation_mm = 3.0;
    options.needed_time_offset_ms = 0.1;
    forEachQuantity(kCameraQuantities, [&](const auto& row) {
      if (row.info.need != QuantityNeed::None) covariance.quantities.push_back({&row.info, 0, nullptr});
    });
    covariance.first_column = {0, 3, 6, 7};
    covariance.covariance = Eigen::MatrixXd::Zero(7, 7);
    setSigmas(0.5, 0.5, 0.5);
  }
  // In units of the requirements.
  void setSigmas(double rotation, double translation, double time_offset) {
    const double units[] = {kRadPerDeg * 0.1 * rotation, 3e-3 * translation, 0.1e-3 * time_offset};
    for (Eigen::Index i = 0; i < 7; ++i) {
      const double sigma = units[i / 3];
      covariance.covariance(i, i) = sigma * sigma;
    }
  }
  // The uncertainty of the part at `column` is this multiple of the requirement along a direction in the
  // reference's frame.
  void stretch(Eigen::Index column, const Vector3d& direction, double sigma) {
    covariance.covariance.block<3, 3>(column, column) += sigma * sigma * direction * direction.transpose();
  }
  Observability judge() const {
    return judgeObservability(input, state, covariance, withScaleKnown(covariance), options);
  }
};

class TestObservability : public QObject {
  Q_OBJECT

 private slots:
  void judge_onSigmasBelowTheNeeds_isOkWithAnEigenvalueForEachDirection() {
    Rig rig;
    rig.setSigmas(0.5, 0.25, 0.1);
    const Observability seen = rig.judge();
    QCOMPARE(seen.status, CalibrationStatus::Ok);
    QVERIFY(seen.reason.empty());
    // Inverse squared sigmas in units of the requirements, the weakest first: 3 of 1/0.5^2, 3 of 1/0.25^2, 1
    // of 1/0.1^2.
    QCOMPARE(seen.eigenvalues.size(), std::size_t{7});
    const double expected[] = {4.0, 4.0, 4.0, 16.0, 16.0, 16.0, 100.0};
    for (std::size_t i = 0; i < 7; ++i) QVERIFY(std::abs(seen.eigenvalues[i] - expected[i]) < 1e-6);
  }

  void judge_onATranslationThatIsUnsure_namesTheCamerasOwnAxisAndTheSigma() {
    Rig rig;
    // The camera's z axis is the reference's x axis.
    rig.state.cameras[0].reference_from_camera.rotation =
        rotationBetween(Vector3d::UnitZ(), Vector3d::UnitX());
    rig.stretch(3, Vector3d::UnitX(), 6e-3);
    const Observability seen = rig.judge();
    QCOMPARE(seen.status, CalibrationStatus::Doubtful);
    QCOMPARE(seen.directions.front(), std::string("translation along the camera's z axis"));
    // sqrt(6^2 + 1.5^2) = 6.18 mm.
    QVERIFY2(
        seen.reason.starts_with("translation along the camera's z axis has a sigma of 6.2 mm (needed: 3)"),
        seen.reason.c_str());
    QVERIFY(seen.eigenvalues.front() < 1.0);
  }

  void judge_ofTwoCameras_saysWhichSensor() {
    Rig rig;
    rig.input.cameras.resize(2);
    rig.state.cameras.resize(2);
    rig.stretch(0, Vector3d::UnitY(), kRadPerDeg * 0.3);
    QVERIFY(
        rig.judge().reason.starts_with("rotation about left's y axis has a sigma of 0.3 deg (needed: 0.1)"));
  }

  void judge_alongNoAxis_givesTheDirectionsComponents() {
    Rig rig;
    rig.stretch(3, Vector3d(1.0, -1.0, 0.0).normalized(), 6e-3);
    const std::string weakest = rig.judge().directions.front();
    QVERIFY2(weakest == "translation along (0.71, -0.71, 0.00) in the camera's frame" ||
                 weakest == "translation along (-0.71, 0.71, 0.00) in the camera's frame",
             weakest.c_str());
  }

  // NaN compares false with every number, and must not count as certain.
  void judge_onSigmasThatAreNoNumbers_isDoubtful() {
    for (const double variance : {std::numeric_limits<double>::quiet_NaN(), -1.0, 0.0}) {
      Rig rig;
      rig.setSigmas(0.1, 0.1, 0.1);
      rig.covariance.covariance(4, 4) = variance;
      const Observability judged = rig.judge();
      QCOMPARE(judged.status, CalibrationStatus::Doubtful);
      QVERIFY2(judged.reason.find("the translation of left has no sigma") != std::string::npos,
               judged.reason.c_str());
    }
  }
  void judge_onAHundredTimesTheNeed_callsItUnobservable() {
    Rig rig;
    rig.setSigmas(0.5, 0.5, 101.0);
    QVERIFY(rig.judge().reason.starts_with("time offset of left is not observable in this recording"));
  }

  void judge_onWhatGoesTogether_namesBoth() {
    Rig rig;
    // Rotation about x and translation along y, correlated: the weakest direction has both.
    const double rotation = kRadPerDeg * 0.1, translation = 3e-3;
    rig.covariance.covariance(0, 0) = 4.0 * rotation * rotation;
    rig.covariance.covariance(4, 4) = 4.0 * translation * translation;
    rig.covariance.covariance(0, 4) = rig.covariance.covariance(4, 0) = 3.9 * rotation * translation;
    const std::string weakest = rig.judge().directions.front();
    QVERIFY2(weakest.find("rotation about the camera's x axis") != std::string::npos, weakest.c_str());
    QVERIFY2(weakest.find(" together with ") != std::string::npos, weakest.c_str());
    QVERIFY2(weakest.find("translation along the camera's y axis") != std::string::npos, weakest.c_str());
  }

  // The effect of a wrong board size is not due to the motion: it has a separate requirement.
  void judge_onWhatTheBoardLeavesOpen_asksForABetterMeasure() {
    Rig rig;
    rig.options.needed_translation_mm = 1.0;
    rig.setSigmas(0.5, 0.1, 0.5);
    const QuantityInfo& scale = quantityInfo(QuantityOwner::Board, QuantityId::Scale);
    rig.covariance.quantities.push_back({&scale, 0, nullptr});
    rig.covariance.first_column.push_back(8);
    rig.covariance.covariance.conservativeResizeLike(Eigen::MatrixXd::Zero(8, 8));
    const auto openBy = [&](double sigma_m) {
      Rig open = rig;
      constexpr double kScaleSigma = 2e-3;
      open.covariance.covariance(7, 7) = kScaleSigma * kScaleSigma;
      open.covariance.covariance(5, 7) = open.covariance.covariance(7, 5) = kScaleSigma * sigma_m;
      open.covariance.covariance(5, 5) += sigma_m * sigma_m;
      return open.judge();
    };
    const Observability near = openBy(2e-3), far = openBy(4e-3);
    QCOMPARE(near.status, CalibrationStatus::Ok);
    QVERIFY(near.eigenvalues.front() > 1.0);
    QCOMPARE(far.status, CalibrationStatus::Doubtful);
    QVERIFY2(far.reason.starts_with("the translation of left has a sigma of 4 mm with"), far.reason.c_str());
    QVERIFY(far.reason.find("Record again") == std::string::npos);
  }

  void judge_withoutQuantitiesThatAreNeeded_isOk() {
    Rig rig;
    rig.covariance = {{}, {0}, Eigen::MatrixXd(0, 0)};
    const Observability seen = rig.judge();
    QCOMPARE(seen.status, CalibrationStatus::Ok);
    QVERIFY(seen.eigenvalues.empty());
  }
};

}  // namespace

EVICAL_TEST(TestObservability)
#include "tst_observability.moc"
