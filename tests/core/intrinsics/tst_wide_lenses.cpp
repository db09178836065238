// Intrinsics of lenses that see beyond 90 degrees off axis: double sphere, EUCM, omni.
#include "core/geometry/lens_fit.h"
#include "core/geometry/projection_difference.h"
#include "core/geometry/sphere_lens.h"
#include "core/intrinsics/estimate_intrinsics.h"
#include "core/intrinsics/intrinsics_checks.h"
#include "core/intrinsics/intrinsics_start.h"
#include "core/intrinsics/sensor_views.h"
#include "tests/core/intrinsics/wide_views.h"
#include "tests/support/seen_through.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

namespace {

using namespace evical;

constexpr double kRadius_m = 0.012;

Board boardOf(double radius_m) {
  Board board;
  board.type = BoardType::SymmetricCircles;
  board.rows = 7;
  board.cols = 9;
  board.spacing_m = 0.04;
  board.radius_m = radius_m;
  return board;
}

test::WideViews wideViews(CameraModel model, double radius_m) {
  test::WideViews wide{boardOf(radius_m), test::wideCamera(model)};
  if (radius_m > 0.0 || model == CameraModel::PinholeEquidistant) wide.furthest_deg = 60.0;
  return wide;
}

IntrinsicsOptions optionsOf(IntrinsicsModel model) {
  IntrinsicsOptions options;
  options.model = model;
  return options;
}

IntrinsicsModel named(CameraModel model) {
  return static_cast<IntrinsicsModel>(static_cast<int>(model) + 1);
}

IntrinsicsResult estimateForWideLenses(const test::WideViews& wide, unsigned seed, IntrinsicsModel model) {
  const BoardObservations observations = test::observeWide(wide, seed);
  return estimateIntrinsics({wide.board, wide.camera.resolution_px, observations, {}, {}}, optionsOf(model),
                            {});
}

IntrinsicsVector errorsOf(const IntrinsicsResult& result, const CameraIntrinsics& truth) {
  IntrinsicsVector found, expected;
  writeIntrinsics(result.intrinsics, found.data());
  writeIntrinsics(truth, expected.data());
  return found - expected;
}

// Angles at which the pixel is computed, with the smallest one.
double furthestCorner_deg(const test::WideViews& wide, unsigned seed) {
  double min_z = 1.0;
  for (const BoardView& view : test::observeWide(wide, seed).views)
    for (const CircleObservation& circle : view.circles)
      if (const auto ray = unprojectRay(wide.camera, circle.centre_px)) min_z = std::min(min_z, ray->z());
  return std::acos(min_z) * 180.0 / M_PI;
}

QString text(double value) {
  return QString::number(value);
}

}  // namespace

class TestWideLenses : public QObject {
  Q_OBJECT

 private slots:
  void recoversCamera_data() {
    QTest::addColumn<int>("model");
    QTest::addColumn<double>("radius_m");
    QTest::addColumn<bool>("automatic");
    const int sphere = static_cast<int>(CameraModel::DoubleSphere),
              eucm = static_cast<int>(CameraModel::Eucm), omni = static_cast<int>(CameraModel::OmniRadtan);
    QTest::newRow("equidistant, corners, model found")
        << static_cast<int>(CameraModel::PinholeEquidistant) << 0.0 << true;
    QTest::newRow("double sphere, corners") << sphere << 0.0 << false;
    QTest::newRow("double sphere, corners, model found") << sphere << 0.0 << true;
    QTest::newRow("double sphere, circles") << sphere << kRadius_m << false;
    QTest::newRow("eucm, corners") << eucm << 0.0 << false;
    QTest::newRow("eucm, circles") << eucm << kRadius_m << false;
    QTest::newRow("omni, corners") << omni << 0.0 << false;
  }
  void recoversCamera() {
    QFETCH(int, model);
    QFETCH(double, radius_m);
    QFETCH(bool, automatic);
    const auto lens = static_cast<CameraModel>(model);
    const test::WideViews wide = wideViews(lens, radius_m);
    const double furthest_deg = furthestCorner_deg(wide, 1);
    QVERIFY2(radius_m > 0.0 || furthest_deg > (isSphereModel(lens) ? 95.0 : 75.0),
             qPrintable(text(furthest_deg)));
    const IntrinsicsResult result =
        estimateForWideLenses(wide, 1, automatic ? IntrinsicsModel::Automatic : named(lens));
    QCOMPARE(result.intrinsics.model, lens);
    QVERIFY2(result.status == CalibrationStatus::Ok, result.reason.c_str());
    // Corners beyond 85 degrees, which have no ideal pixels, are used like all others.
    QVERIFY2(result.circles_rejected < result.circles_used / 100, qPrintable(text(result.circles_rejected)));
    const IntrinsicsVector error = errorsOf(result, wide.camera), sigmas = result.standardDeviations();
    for (int i = 0; i < 9; ++i)
      QVERIFY2(std::abs(error[i]) <= 4.0 * sigmas[i] + 1e-12,
               qPrintable(QString("%1: %2 +- %3").arg(i).arg(error[i]).arg(sigmas[i])));
    const double difference_px = projectionDifference(wide.camera, result.intrinsics).rms_px;
    qInfo("error %.4f px RMS (sigma %.4f), furthest point %.1f deg off axis, %d points, normalised RMS %.3f",
          difference_px, result.image.rms_px, furthest_deg, result.circles_used, result.normalised_rms);
    QVERIFY2(difference_px < 0.1, qPrintable(text(difference_px)));
    QVERIFY(difference_px < 3.0 * result.image.rms_px);
    QVERIFY2(result.normalised_rms > 0.9 && result.normalised_rms < 1.1,
             qPrintable(text(result.normalised_rms)));
  }

  void sigmas_areThoseOfTheErrors_data() {
    QTest::addColumn<int>("model");
    QTest::newRow("double sphere") << static_cast<int>(CameraModel::DoubleSphere);
    QTest::newRow("eucm") << static_cast<int>(CameraModel::Eucm);
  }
  void sigmas_areThoseOfTheErrors() {
    QFETCH(int, model);
    constexpr unsigned kSeeds = 12;
    test::WideViews wide = wideViews(static_cast<CameraModel>(model), 0.0);
    wide.views = 60;
    double sum2 = 0.0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const IntrinsicsResult result = estimateForWideLenses(wide, seed, named(wide.camera.model));
      const IntrinsicsVector error = errorsOf(result, wide.camera), sigmas = result.standardDeviations();
      sum2 += error.head<6>().cwiseQuotient(sigmas.head<6>()).squaredNorm() / 6.0;
      QCOMPARE(sigmas.tail<3>().norm(), 0.0);
    }
    const double rms = std::sqrt(sum2 / kSeeds);
    qInfo("errors are %.2f of their sigmas, RMS over %u seeds", rms, kSeeds);
    QVERIFY2(rms > 0.6 && rms < 1.3, qPrintable(text(rms)));
  }

  // Like the lens of the first look at such a recording. As the only start, it led to a fit without a third
  // of the circles, and a double sphere was selected.
  void equidistant_usesAllViews_ifTheGuessIsNearlyRight() {
    test::WideViews wide = wideViews(CameraModel::PinholeEquidistant, kRadius_m);
    wide.noise_px = 0.02;
    CameraIntrinsics guess = wide.camera;
    guess.distortion = {0.01132, -0.00468, 0.00197, -0.00073, 0.0};
    BoardObservations observations = test::observeWide(wide, 1);
    test::seeThrough(plainLens(guess, CameraModel::PinholeRadtan), guess, observations);
    const IntrinsicsResult result =
        estimateIntrinsics({wide.board, wide.camera.resolution_px, observations, guess, {}}, {}, {});
    QCOMPARE(result.intrinsics.model, CameraModel::PinholeEquidistant);
    QVERIFY2(result.circles_rejected < result.circles_used / 100, qPrintable(text(result.circles_rejected)));
  }

  // Views of a pinhole camera do not need a double sphere.
  void automatic_staysWithAPinhole() {
    test::WideViews wide = wideViews(CameraModel::PinholeRadtan, 0.0);
    wide.camera = {
        CameraModel::PinholeRadtan, {512, 512}, {400.0, 401.0}, {255.0, 257.0}, {-0.3, 0.1, 1e-4, 0.0, 0.0}};
    wide.furthest_deg = 30.0;
    const IntrinsicsResult result = estimateForWideLenses(wide, 3, IntrinsicsModel::Automatic);
    QCOMPARE(result.intrinsics.model, CameraModel::PinholeRadtan);
    QVERIFY(projectionDifference(wide.camera, result.intrinsics).rms_px < 0.1);
  }

  // Also for points behind the image plane and to the side.
  void boardPose_isFoundAtAnyAngle() {
    const test::WideViews wide = wideViews(CameraModel::DoubleSphere, 0.0);
    const IntrinsicsOptions options;
    int beside = 0;
    for (const SensorView& view : sensorViews(test::observeWide(wide, 5), wide.board, {}, options)) {
      const auto pose = boardPose(view, wide.board, wide.camera);
      QVERIFY(pose);
      double squares = 0.0;
      for (const SensorCircle& circle : view.circles) {
        const Eigen::Vector3d point =
            *pose * Eigen::Vector3d(circle.on_board_m.x(), circle.on_board_m.y(), 0.0);
        squares += (project(wide.camera, point).value() - circle.centre_px).squaredNorm();
        beside += point.z() < 0.0;
      }
      const double rms_px = std::sqrt(squares / static_cast<double>(view.circles.size()));
      QVERIFY2(rms_px < 3.0 * wide.noise_px, qPrintable(text(rms_px)));
    }
    QVERIFY2(beside > 50, qPrintable(text(beside)));
  }

  // One wide lens, expressed in the other models; an export states the fit error.
  void fitLens_comesNear_data() {
    QTest::addColumn<int>("from");
    QTest::addColumn<int>("to");
    QTest::addColumn<double>("at_most_px");
    const int sphere = static_cast<int>(CameraModel::DoubleSphere),
              eucm = static_cast<int>(CameraModel::Eucm), omni = static_cast<int>(CameraModel::OmniRadtan),
              equidistant = static_cast<int>(CameraModel::PinholeEquidistant);
    QTest::newRow("double sphere to eucm") << sphere << eucm << 1.0;
    QTest::newRow("eucm to double sphere") << eucm << sphere << 0.5;
    QTest::newRow("double sphere to omni") << sphere << omni << 0.5;
    QTest::newRow("omni to double sphere") << omni << sphere << 1.0;
    QTest::newRow("double sphere to equidistant") << sphere << equidistant << 0.1;
    QTest::newRow("itself") << sphere << sphere << 1e-9;
  }
  void fitLens_comesNear() {
    QFETCH(int, from);
    QFETCH(int, to);
    QFETCH(double, at_most_px);
    const CameraIntrinsics camera = test::wideCamera(static_cast<CameraModel>(from));
    const auto model = static_cast<CameraModel>(to);
    const LensFit fit = fitLens(camera, model, coefficientCount(model));
    QCOMPARE(fit.camera.model, model);
    QCOMPARE(fit.whole_image, model != CameraModel::PinholeEquidistant);
    qInfo("error %.3g px RMS, %.3g px at most", fit.rms_px, fit.worst_px);
    QVERIFY2(fit.worst_px <= at_most_px, qPrintable(text(fit.worst_px)));
  }

  // f and xi may both change much with little effect on the image.
  void focalLengthSigma_isThatOfTheScaleOnTheAxis() {
    CameraIntrinsics camera = test::wideCamera(CameraModel::DoubleSphere);
    IntrinsicsMatrix covariance = IntrinsicsMatrix::Zero();
    const double f = camera.focal_length_px.x(), xi = camera.distortion[0];
    camera.focal_length_px.y() = f;
    // d ln f = d ln (1 + xi): the scale is unchanged.
    IntrinsicsVector along = IntrinsicsVector::Zero();
    along << f, f, 0.0, 0.0, 1.0 + xi, 0.0, 0.0, 0.0, 0.0;
    covariance = 1e-2 * along * along.transpose();
    QVERIFY(focalLengthRelativeStd(camera, covariance) < 1e-9);
    covariance(0, 0) += 1e-4 * f * f;
    QVERIFY(std::abs(focalLengthRelativeStd(camera, covariance) - 1e-2) < 1e-9);
    camera.model = CameraModel::PinholeRadtan;
    QVERIFY(focalLengthRelativeStd(camera, covariance) > 0.1);
  }
};

EVICAL_TEST(TestWideLenses)
#include "tst_wide_lenses.moc"
