// A camera's motion in a window from slopes that a known motion makes.
#include "core/egomotion/window_motion.h"

#include "core/geometry/so3.h"
#include "tests/support/test_program.h"

#include <Eigen/LU>
#include <QTest>

#include <cmath>
#include <random>
#include <vector>

using namespace evical;

namespace {

CameraIntrinsics davis() {
  CameraIntrinsics lens;
  lens.resolution_px = {346, 260};
  lens.focal_length_px = {262.4, 262.9};
  lens.principal_point_px = {171.8, 131.2};
  lens.distortion = {-0.33, 0.11, 0.0006, -0.0004};
  return lens;
}

struct Scene {
  Eigen::Vector3d rate{0.4, -0.7, 0.5}, velocity{0.3, -0.1, 0.2};
  double nearest_1_m = 0.3, further_1_m = 0.7;  // inverse depths, by patches of the image
  double noise = 0.0;                           // of slopes, sigma by their own size
  int slopes = 500;
};

double nearness(const Scene& scene, int x_px, int y_px) {
  return (x_px / 44 + y_px / 44) % 2 == 0 ? scene.nearest_1_m : scene.further_1_m;
}

std::vector<EdgeSlope> slopesOf(const Scene& scene, const LensRays& lens, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::normal_distribution<double> normal;
  std::vector<EdgeSlope> slopes;
  while (static_cast<int>(slopes.size()) < scene.slopes) {
    const int x = static_cast<int>(346 * part(generator)), y = static_cast<int>(260 * part(generator));
    const LensRays::Ray& ray = lens.at(x, y);
    const Eigen::Vector2d place = ray.place.cast<double>();
    const Eigen::Vector2d flow = ray.px_per_place.cast<double>() *
                                 (rotationalMotion(place) * scene.rate +
                                  nearness(scene, x, y) * (translationalMotion(place) * scene.velocity));
    const double angle = 6.2831853 * part(generator);
    const Eigen::Vector2d edge(std::cos(angle), std::sin(angle));
    const double speed = edge.dot(flow);
    if (std::abs(speed) < 20.0) continue;
    Eigen::Vector2d slope = edge / speed;
    const double sigma = scene.noise * slope.norm();
    slope += sigma * Eigen::Vector2d(normal(generator), normal(generator));
    EdgeSlope out;
    out.time_ns = static_cast<std::int64_t>(4e7 * part(generator));
    out.x_px = static_cast<std::uint16_t>(x);
    out.y_px = static_cast<std::uint16_t>(y);
    out.slope_s_px = slope.cast<float>();
    out.shape = Eigen::Matrix2f::Identity() / 50.0f;
    slopes.push_back(out);
  }
  return slopes;
}

}  // namespace

class TestWindowMotion : public QObject {
  Q_OBJECT

 private slots:
  // Of a point that stands still, seen by a camera that moves for a short time.
  void imageMotion_matchesNumericDifferences() {
    const Eigen::Vector3d point(0.4, -0.3, 1.7), rate(0.3, -0.5, 0.8), velocity(0.2, 0.6, -0.4);
    const Eigen::Vector2d place = point.hnormalized();
    constexpr double kStep_s = 1e-6;
    const auto seen = [&](double time_s) {
      const Eigen::Matrix3d turned = so3Exp(rate * time_s);
      return Eigen::Vector2d((turned.transpose() * (point - velocity * time_s)).hnormalized());
    };
    const Eigen::Vector2d numeric = (seen(kStep_s) - seen(-kStep_s)) / (2.0 * kStep_s);
    const Eigen::Vector2d analytic =
        rotationalMotion(place) * rate + translationalMotion(place) * velocity / point.z();
    QVERIFY2((numeric - analytic).norm() < 1e-8, "1/s");
  }

  void estimate_onPerfectSlopes_isTheTruth_data() {
    QTest::addColumn<double>("speed");
    QTest::addColumn<double>("further");
    QTest::newRow("rotation alone") << 0.0 << 0.5;
    QTest::newRow("one depth") << 1.0 << 0.3;
    QTest::newRow("two depths") << 1.0 << 0.7;
  }
  void estimate_onPerfectSlopes_isTheTruth() {
    QFETCH(double, speed);
    QFETCH(double, further);
    Scene scene;
    scene.velocity *= speed;
    scene.further_1_m = further;
    const LensRays lens(davis());
    EgomotionOptions options;
    options.depth_columns = 8;
    options.depth_rows = 6;
    const WindowMotion found = estimateWindowMotion(slopesOf(scene, lens, 1), lens, {}, options);
    QCOMPARE(found.use, WindowUse::Used);
    // Patches do not end where depths do: 2 % of the rate.
    QVERIFY2((found.rate_rad_s - scene.rate).norm() < (speed > 0.0 ? 0.02 : 1e-3), "rad/s");
    QVERIFY(found.inliers > 0.9);
    QCOMPARE(found.rotation_alone, speed == 0.0);
  }

  // It weighs windows only: what is said at the end is the scatter of blocks. Where nothing translates depths take some noise for
  // their own, and the sigma is too small by half.
  void covariance_isNearlyThatOfTheErrors() {
    Scene scene;
    scene.velocity.setZero();
    scene.noise = 0.05;
    const LensRays lens(davis());
    const EgomotionOptions options;
    constexpr int kSeeds = 60;
    constexpr double kShared = 12.0;  // what the estimate takes from slopes that overlap; these do not
    double squares = 0.0;
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
      const WindowMotion found = estimateWindowMotion(slopesOf(scene, lens, seed), lens, {}, options);
      const Eigen::Vector3d error = found.rate_rad_s - scene.rate;
      squares += kShared * error.dot(found.covariance.inverse() * error) / 3.0 / kSeeds;
    }
    QVERIFY2(squares > 0.5 && squares < 3.0, qPrintable(QString::number(squares)));
  }

  void tooFewSlopes_areAReason() {
    Scene scene;
    scene.slopes = 50;
    const LensRays lens(davis());
    const WindowMotion found = estimateWindowMotion(slopesOf(scene, lens, 1), lens, {}, {});
    QCOMPARE(found.use, WindowUse::FewEdges);
    QCOMPARE(found.slopes, std::size_t{50});
  }
};

EVICAL_TEST(TestWindowMotion)
#include "tst_window_motion.moc"
