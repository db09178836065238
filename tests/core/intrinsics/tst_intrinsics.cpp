#include "core/base/error.h"
#include "core/geometry/lens_fit.h"
#include "core/geometry/projection_difference.h"
#include "core/geometry/so3.h"
#include "core/intrinsics/circle_centre_cost.h"
#include "core/intrinsics/estimate_intrinsics.h"
#include "core/intrinsics/intrinsics_start.h"
#include "core/synthetic/board_truth.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/numeric_jacobian.h"
#include "tests/support/seen_through.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>

namespace {

using namespace evical;

constexpr double kNoise_px = 0.08;

Scenario scenarioOf(const char* name, std::uint64_t seed = 0) {
  Scenario scenario = readScenario(test::scenarioPath(name));
  scenario.duration_s = 20.0;
  if (seed != 0) scenario.seed = seed;
  return scenario;
}

// Measurements of a front end without intrinsics: the sensor's own pixels, edges ahead by `lead_px`.
BoardObservations sensorObservations(const Scenario& scenario, double lead_px = 0.0,
                                     double noise_px = kNoise_px) {
  const CameraIntrinsics& camera = scenario.cameras.front().intrinsics;
  BoardObservations observations = simulateObservations(scenario, 0, 1e-9, 0.1);
  std::mt19937_64 generator(scenario.seed);
  std::normal_distribution<double> normal;
  for (BoardView& view : observations.views) {
    for (CircleObservation& circle : view.circles) {
      const Eigen::Matrix2d sensor_from_ideal = idealPixelScale(camera, circle.centre_px).inverse();
      circle.velocity_px_s = sensor_from_ideal * circle.velocity_px_s;
      circle.edge_localisation_bias_effect = circle.velocity_px_s.normalized();
      const double x = normal(generator), y = normal(generator);
      circle.centre_px = pixelFromIdeal(camera, circle.centre_px) +
                         lead_px * circle.edge_localisation_bias_effect + noise_px * Eigen::Vector2d(x, y);
      circle.covariance_px2 = noise_px * noise_px * Eigen::Matrix2d::Identity();
    }
  }
  return observations;
}

IntrinsicsResult estimateForIntrinsics(const Scenario& scenario, const BoardObservations& observations,
                                       const IntrinsicsOptions& options = {}) {
  return estimateIntrinsics(
      {scenario.board, scenario.cameras.front().intrinsics.resolution_px, observations, {}, {}}, options, {});
}

IntrinsicsVector parametersOf(const CameraIntrinsics& camera) {
  IntrinsicsVector parameters;
  writeIntrinsics(camera, parameters.data());
  return parameters;
}

std::string failure(const std::function<void()>& run) {
  try {
    run();
  } catch (const CalibrationError& error) {
    return error.what();
  }
  return {};
}

// The views that `keep` accepts.
BoardObservations onlyViews(BoardObservations observations,
                            const std::function<bool(const BoardView&)>& keep) {
  std::erase_if(observations.views, [&](const BoardView& view) { return !keep(view); });
  return observations;
}

}  // namespace

class TestIntrinsics : public QObject {
  Q_OBJECT

 private slots:
  void jacobians_agreeWithDifferences() {
    const RigidTransform pose{quaternionExp({0.3, -0.4, 0.2}), {-0.1, 0.05, 0.6}};
    SensorCircle circle;
    circle.on_board_m = {0.15, 0.1};
    circle.centre_px = {200.0, 150.0};
    circle.covariance_px2 << 0.02, 0.005, 0.005, 0.01;
    circle.lead_effect = {0.8, -0.5};
    struct Case {
      CameraModel model;
      double radius_m;
      std::array<double, 5> distortion;
    };
    const Case cases[] = {{CameraModel::PinholeRadtan, 0.02, {-0.3, 0.1, 0.001, -0.002, 0.01}},
                          {CameraModel::PinholeRadtan, 0.0, {-0.3, 0.1, 0.001, -0.002, 0.01}},
                          {CameraModel::PinholeEquidistant, 0.02, {-0.3, 0.1, 0.001, -0.002, 0.0}},
                          {CameraModel::DoubleSphere, 0.02, {-0.2, 0.6, 0.0, 0.0, 0.0}},
                          {CameraModel::DoubleSphere, 0.0, {-0.2, 0.6, 0.0, 0.0, 0.0}},
                          {CameraModel::Eucm, 0.02, {0.6, 1.1, 0.0, 0.0, 0.0}},
                          {CameraModel::Eucm, 0.0, {0.6, 1.1, 0.0, 0.0, 0.0}},
                          {CameraModel::OmniRadtan, 0.02, {1.2, -0.1, 0.02, 0.001, -0.002}},
                          {CameraModel::OmniRadtan, 0.0, {1.2, -0.1, 0.02, 0.001, -0.002}}};
    for (const auto& [model, radius_m, distortion] : cases) {
      const CircleCentreCost cost(model, circle, radius_m, 1.3);
      Eigen::VectorXd shared(10);
      shared << 262.0, 263.0, 171.0, 131.0, Eigen::Map<const Eigen::VectorXd>(distortion.data(), 5), 0.2;
      const auto residualAt = [&](const Eigen::VectorXd& delta) -> Eigen::VectorXd {
        // Distortion coefficients are small numbers, lengths in pixels are large ones.
        Eigen::VectorXd moved = shared + delta.head(10);
        std::array<double, kPoseBlock> start{}, at{};
        writePose(pose, start.data());
        PoseManifold().Plus(start.data(), delta.data() + 10, at.data());
        const std::array<const double*, 3> blocks = {moved.data(), moved.data() + 9, at.data()};
        Eigen::VectorXd residual(2);
        cost.Evaluate(blocks.data(), residual.data(), nullptr);
        return residual;
      };
      std::array<double, kPoseBlock> at{};
      writePose(pose, at.data());
      const std::array<const double*, 3> blocks = {shared.data(), shared.data() + 9, at.data()};
      Eigen::Matrix<double, 2, 9, Eigen::RowMajor> by_intrinsics;
      Eigen::Vector2d residual, by_lead;
      Eigen::Matrix<double, 2, kPoseBlock, Eigen::RowMajor> by_pose;
      std::array<double*, 3> jacobians = {by_intrinsics.data(), by_lead.data(), by_pose.data()};
      cost.Evaluate(blocks.data(), residual.data(), jacobians.data());
      Eigen::MatrixXd analytic(2, 16);
      analytic << by_intrinsics, by_lead, by_pose.leftCols<3>(), by_pose.rightCols<3>();
      const Eigen::MatrixXd numeric = test::numericJacobian(residualAt, 16, 1e-4);
      QVERIFY2(test::relativeDifference(analytic, numeric) < 1e-8,
               qPrintable(QString::number(test::relativeDifference(analytic, numeric))));
      QCOMPARE(by_pose.col(3).norm(), 0.0);
    }
  }

  void recoversCamera_data() {
    QTest::addColumn<QString>("scenario");
    QTest::addColumn<int>("coefficients");
    QTest::newRow("radtan") << "intrinsics_davis346" << 4;
    QTest::newRow("radtan with k3") << "intrinsics_davis346" << 5;
    QTest::newRow("fisheye, model found") << "intrinsics_fisheye" << 4;
    QTest::newRow("symmetric board") << "intrinsics_symmetric" << 4;
  }
  void recoversCamera() {
    QFETCH(QString, scenario);
    QFETCH(int, coefficients);
    const Scenario truth = scenarioOf(qPrintable(scenario));
    IntrinsicsOptions options;
    options.radtan_coefficients = coefficients;
    const IntrinsicsResult result = estimateForIntrinsics(truth, sensorObservations(truth), options);
    const CameraIntrinsics& camera = truth.cameras.front().intrinsics;
    QCOMPARE(result.status, CalibrationStatus::Ok);
    QCOMPARE(result.intrinsics.model, camera.model);
    QCOMPARE(result.intrinsics.resolution_px, camera.resolution_px);
    const IntrinsicsVector error = parametersOf(result.intrinsics) - parametersOf(camera);
    const IntrinsicsVector sigmas = result.standardDeviations();
    for (int i = 0; i < 9; ++i) QVERIFY(std::abs(error[i]) <= 4.0 * sigmas[i] + 1e-12);
    QVERIFY(sigmas[0] > 0.0 && sigmas[0] < 1e-3 * camera.focal_length_px.x());
    const ProjectionDifference difference = projectionDifference(camera, result.intrinsics, 0.95);
    QVERIFY2(difference.rms_px < 0.1, qPrintable(QString::number(difference.rms_px)));
    QVERIFY(difference.rms_px < 3.0 * result.image.rms_px);
    QVERIFY(result.normalised_rms > 0.85 && result.normalised_rms < 1.15);
  }

  void sigmas_areThoseOfTheErrors() {
    constexpr int kSeeds = 12;
    double sum2 = 0.0;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      Scenario truth = scenarioOf("intrinsics_davis346", static_cast<std::uint64_t>(100 + seed));
      truth.duration_s = 6.0;
      IntrinsicsOptions options;
      options.model = IntrinsicsModel::PinholeRadtan;
      const IntrinsicsResult result = estimateForIntrinsics(truth, sensorObservations(truth), options);
      const IntrinsicsVector error =
          parametersOf(result.intrinsics) - parametersOf(truth.cameras.front().intrinsics);
      sum2 += (error.head<8>().array() / result.standardDeviations().head<8>().array()).square().mean();
    }
    const double rms = std::sqrt(sum2 / kSeeds);
    QVERIFY2(rms > 0.7 && rms < 1.4, qPrintable(QString::number(rms)));
  }

  // The scenario's board is 0.7 m away, plus or minus 0.14 m and its offset from the optical axis, and tilted
  // by up to 32 deg to each side.
  void story_tellsOfModelsAndViews() {
    const Scenario scenario = scenarioOf("intrinsics_davis346");
    IntrinsicsStory story;
    const IntrinsicsResult result = estimateIntrinsics({scenario.board,
                                                        scenario.cameras.front().intrinsics.resolution_px,
                                                        sensorObservations(scenario),
                                                        {},
                                                        {}},
                                                       {}, {}, &story);
    const auto taken = std::find_if(story.tried.begin(), story.tried.end(), [&](const TriedModel& tried) {
      return tried.model == result.intrinsics.model;
    });
    QVERIFY(story.tried.size() >= 2);
    QVERIFY(taken != story.tried.end());
    QVERIFY(taken->circles_used > 0 && taken->circles_used <= taken->circles);
    for (const TriedModel& tried : story.tried)
      QVERIFY(tried.spread_sigma > IntrinsicsOptions{}.equidistant_gain * taken->spread_sigma);
    QCOMPARE(static_cast<int>(story.views.size()), result.views_used);
    int circles = 0;
    double previous_s = -1.0, max_deg = 0.0;
    for (const IntrinsicsView& view : story.views) {
      QVERIFY(view.time_s > previous_s);
      QVERIFY2(view.distance_m > 0.4 && view.distance_m < 1.2, qPrintable(QString::number(view.distance_m)));
      QVERIFY(view.reprojection_rms_px > 0.3 * kNoise_px && view.reprojection_rms_px < 4.0 * kNoise_px);
      previous_s = view.time_s;
      max_deg = std::max(max_deg, view.tilt_deg);
      circles += view.circles;
    }
    QCOMPARE(circles, result.circles_used);
    QVERIFY(max_deg >= result.largest_tilt_deg);
  }

  void edgeLocalisationBias_isFoundAndDoesNoHarm() {
    const Scenario truth = scenarioOf("intrinsics_davis346");
    const IntrinsicsResult result = estimateForIntrinsics(truth, sensorObservations(truth, 0.3));
    QVERIFY(std::abs(result.edge_localisation_bias_px - 0.3) < 4.0 * result.edge_localisation_bias_std_px);
    QVERIFY(result.edge_localisation_bias_std_px < 0.05);
    const IntrinsicsVector error =
        parametersOf(result.intrinsics) - parametersOf(truth.cameras.front().intrinsics);
    for (int i = 0; i < 8; ++i) QVERIFY(std::abs(error[i]) <= 4.0 * result.standardDeviations()[i]);
  }

  void outliers_areDropped() {
    const Scenario truth = scenarioOf("intrinsics_davis346");
    BoardObservations observations = sensorObservations(truth);
    for (std::size_t v = 0; v < observations.views.size(); v += 3)
      observations.views[v].circles[v % 7].centre_px += Eigen::Vector2d(4.0, -3.0);
    const IntrinsicsResult result = estimateForIntrinsics(truth, observations);
    QVERIFY(result.circles_rejected >= result.views_used / 6);
    QVERIFY(projectionDifference(truth.cameras.front().intrinsics, result.intrinsics).rms_px < 0.1);
  }

  void observationsInIdealPixels_giveTheSame() {
    const Scenario truth = scenarioOf("intrinsics_davis346");
    const BoardObservations sensor = sensorObservations(truth);
    CameraIntrinsics rough = truth.cameras.front().intrinsics;
    rough.focal_length_px *= 1.03;
    rough.distortion[0] += 0.02;
    BoardObservations ideal = sensor;
    test::seeThrough(plainLens(rough, CameraModel::PinholeRadtan), rough, ideal);
    const Resolution size = rough.resolution_px;
    const IntrinsicsResult one = estimateIntrinsics({truth.board, size, sensor, {}, rough}, {}, {});
    const IntrinsicsResult other = estimateIntrinsics({truth.board, size, ideal, rough, rough}, {}, {});
    QVERIFY(projectionDifference(one.intrinsics, other.intrinsics).rms_px < 0.01);
  }

  void selection_isRepeatableAndSpread() {
    const Scenario truth = scenarioOf("intrinsics_davis346");
    const CameraIntrinsics& camera = truth.cameras.front().intrinsics;
    IntrinsicsOptions options;
    options.max_views = 40;
    options.min_view_spacing_s = 0.15;
    const auto all = sensorViews(sensorObservations(truth), truth.board, {}, options);
    const auto once = selectViews(all, truth.board, camera, options);
    const auto again = selectViews(all, truth.board, camera, options);
    QCOMPARE(once.size(), std::size_t{40});
    for (std::size_t i = 0; i < once.size(); ++i) QCOMPARE(once[i].time_s, again[i].time_s);
    for (std::size_t i = 1; i < once.size(); ++i) QVERIFY(once[i].time_s - once[i - 1].time_s >= 0.149);
  }

  void squareViewsOnly_areRefused() {
    Scenario truth = scenarioOf("intrinsics_davis346");
    truth.motion.angle_amplitude_rad = {0.02, 0.02, 0.3};
    const std::string reason = failure([&] { estimateForIntrinsics(truth, sensorObservations(truth)); });
    QVERIFY2(reason.find("focal length is not observable") != std::string::npos, reason.c_str());
  }

  void tooFewViews_areRefused() {
    const Scenario truth = scenarioOf("intrinsics_davis346");
    const auto few =
        onlyViews(sensorObservations(truth), [](const BoardView& view) { return view.time_s < 0.6; });
    const std::string reason = failure([&] { estimateForIntrinsics(truth, few); });
    QVERIFY2(reason.find("views show at least 50 % of the board") != std::string::npos, reason.c_str());
    QVERIFY2(reason.find("none reaches the ") != std::string::npos, reason.c_str());
  }

  void missingCorner_isNamed() {
    const Scenario truth = scenarioOf("intrinsics_davis346");
    const auto right = onlyViews(sensorObservations(truth), [](const BoardView& view) {
      return std::none_of(view.circles.begin(), view.circles.end(),
                          [](const auto& c) { return c.centre_px.x() < 110.0; });
    });
    const IntrinsicsResult result = estimateForIntrinsics(truth, right);
    QVERIFY(!result.advice.empty());
    QVERIFY2(result.advice[0].find("the lower left corner") != std::string::npos, result.advice[0].c_str());
    QVERIFY(result.status == CalibrationStatus::Doubtful);
    QVERIFY2(result.reason.find("no views reach the left side of the image") != std::string::npos,
             result.reason.c_str());
    // Image regions without observations have a larger uncertainty than those with views.
    const IntrinsicsResult whole = estimateForIntrinsics(truth, sensorObservations(truth));
    QVERIFY(whole.advice.empty());
    const auto left = static_cast<std::size_t>(whole.image.columns * (whole.image.rows / 2));
    QCOMPARE(result.image.cells[left].circles, 0);
    QVERIFY2(result.image.cells[left].sigma_px > 1.5 * whole.image.cells[left].sigma_px,
             qPrintable(QString("%1 and %2")
                            .arg(result.image.cells[left].sigma_px)
                            .arg(whole.image.cells[left].sigma_px)));
  }

  void sameLens_seesTheSame() {
    CameraIntrinsics fisheye;
    fisheye.model = CameraModel::PinholeEquidistant;
    fisheye.resolution_px = {346, 260};
    fisheye.focal_length_px = {300.0, 300.0};
    fisheye.principal_point_px = {172.5, 129.5};
    const CameraIntrinsics radtan = sameLens(fisheye, CameraModel::PinholeRadtan);
    QCOMPARE(radtan.model, CameraModel::PinholeRadtan);
    QVERIFY(projectionDifference(fisheye, radtan).rms_px < 0.1);
  }

  void projectionDifference_leavesOutATurn() {
    CameraIntrinsics camera;
    camera.resolution_px = {346, 260};
    camera.focal_length_px = {262.0, 262.0};
    camera.principal_point_px = {172.0, 130.0};
    CameraIntrinsics moved = camera;
    moved.principal_point_px.x() += 0.1;
    QVERIFY(projectionDifference(camera, moved).rms_px < 0.03);
    moved = camera;
    moved.focal_length_px *= 1.01;
    const ProjectionDifference difference = projectionDifference(camera, moved);
    // 1 % of each pixel's distance from the centre.
    QVERIFY(difference.rms_px > 1.1 && difference.rms_px < 1.4);
    QVERIFY(difference.max_px > 1.9 && difference.max_px < 2.3);
  }
};

EVICAL_TEST(TestIntrinsics)
#include "tst_intrinsics.moc"
