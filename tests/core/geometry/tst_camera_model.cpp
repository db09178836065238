#include "core/geometry/camera_model.h"

#include "core/base/error.h"
#include "tests/support/numeric_jacobian.h"
#include "tests/support/test_program.h"

#include <Eigen/Dense>

#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace {

using namespace evical;
using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::optional<CalibrationError> refusalOf(const CameraIntrinsics& camera) {
  try {
    validate(camera, "left");
    return std::nullopt;
  } catch (const CalibrationError& error) {
    return error;
  }
}

CameraIntrinsics camera(CameraModel model, const std::array<double, 5>& distortion) {
  CameraIntrinsics made;
  made.model = model;
  made.resolution_px = {346, 260};
  made.focal_length_px = {260.0, 250.0};
  made.principal_point_px = {170.0, 131.0};
  made.distortion = distortion;
  return made;
}

struct NamedCamera {
  const char* name;
  CameraIntrinsics camera;
};

std::vector<NamedCamera> cameras() {
  CameraIntrinsics omni = camera(CameraModel::OmniRadtan, {1.3, -0.2, 0.05, 0.001, -0.0005});
  omni.focal_length_px *= 2.0;  // otherwise it sees more than 85 degrees
  return {{"no distortion", camera(CameraModel::PinholeRadtan, {})},
          {"barrel", camera(CameraModel::PinholeRadtan, {-0.36, 0.16, 0.001, -0.0005, 0.0})},
          {"with k3", camera(CameraModel::PinholeRadtan, {-0.4, 0.25, -0.001, 0.002, -0.08})},
          {"pincushion", camera(CameraModel::PinholeRadtan, {0.1, 0.02, 0.0, 0.0, 0.0})},
          {"equidistant", camera(CameraModel::PinholeEquidistant, {})},
          {"fisheye", camera(CameraModel::PinholeEquidistant, {-0.02, 0.01, -0.004, 0.0007, 0.0})},
          {"double sphere", camera(CameraModel::DoubleSphere, {-0.17, 0.59, 0.0, 0.0, 0.0})},
          {"double sphere, xi > 0", camera(CameraModel::DoubleSphere, {0.3, 0.4, 0.0, 0.0, 0.0})},
          {"double sphere that is a pinhole", camera(CameraModel::DoubleSphere, {})},
          {"eucm", camera(CameraModel::Eucm, {0.63, 1.04, 0.0, 0.0, 0.0})},
          {"eucm, alpha < 1/2", camera(CameraModel::Eucm, {0.35, 0.8, 0.0, 0.0, 0.0})},
          {"omni", omni},
          {"omni, xi < 1", camera(CameraModel::OmniRadtan, {0.8, -0.15, 0.03, -0.001, 0.002})}};
}

// Models that see beyond 90 degrees, as far as their pixels reach.
std::vector<NamedCamera> wideCameras() {
  CameraIntrinsics sphere = camera(CameraModel::DoubleSphere, {-0.17, 0.59, 0.0, 0.0, 0.0});
  CameraIntrinsics forward = camera(CameraModel::DoubleSphere, {0.3, 0.7, 0.0, 0.0, 0.0});
  CameraIntrinsics eucm = camera(CameraModel::Eucm, {0.63, 1.04, 0.0, 0.0, 0.0});
  CameraIntrinsics omni = camera(CameraModel::OmniRadtan, {1.3, -0.02, 0.01, 0.001, -0.0005});
  sphere.focal_length_px = {46.0, 47.0};
  forward.focal_length_px = {80.0, 78.0};
  eucm.focal_length_px = {60.0, 61.0};
  omni.focal_length_px = {140.0, 142.0};
  return {{"double sphere", sphere}, {"double sphere, xi > 0", forward}, {"eucm", eucm}, {"omni", omni}};
}

// A ray at this angle from the optical axis, in this direction.
Vector3d direction(double angle_deg, double round_rad) {
  const double angle = angle_deg * pi / 180.0;
  return {std::sin(angle) * std::cos(round_rad), std::sin(angle) * std::sin(round_rad), std::cos(angle)};
}

void addRows(const std::vector<NamedCamera>& all) {
  QTest::addColumn<int>("index");
  for (std::size_t i = 0; i < all.size(); ++i) QTest::newRow(all[i].name) << static_cast<int>(i);
}
void cameraRows() {
  addRows(cameras());
}
void wideRows() {
  addRows(wideCameras());
}

CameraIntrinsics withChange(const CameraIntrinsics& camera, const Eigen::VectorXd& delta) {
  CameraIntrinsics other = camera;
  other.focal_length_px += delta.head<2>();
  other.principal_point_px += delta.segment<2>(2);
  for (std::size_t i = 0; i < 5; ++i) other.distortion[i] += delta[4 + static_cast<Eigen::Index>(i)];
  return other;
}

// Pixels all over the image, including its corners and its centre of distortion.
std::vector<Vector2d> pixels(const CameraIntrinsics& camera) {
  std::vector<Vector2d> all = {camera.principal_point_px};
  const int right = camera.resolution_px.width_px - 1, bottom = camera.resolution_px.height_px - 1;
  for (int row = 0; row <= 6; ++row)
    for (int column = 0; column <= 8; ++column) all.emplace_back(column * right / 8.0, row * bottom / 6.0);
  return all;
}

}  // namespace

class TestCameraModel : public QObject {
  Q_OBJECT

 private slots:
  void pixelOfAPoint_byHand() {
    const CameraIntrinsics plain = camera(CameraModel::PinholeRadtan, {});
    QVERIFY((*project(plain, {0.2, -0.4, 2.0}) - Vector2d(170.0 + 26.0, 131.0 - 50.0)).norm() < 1e-12);
    // (x, y) = (0.3, 0.4): r^2 = 0.25; 1 + k1 r^2 + k2 r^4 + k3 r^6 = 1 - 0.1 + 0.0125 - 0.00125 = 0.91125;
    // x' = 0.3 * 0.91125 + 2 p1 x y + p2 (r^2 + 2 x^2) = 0.273375 + 0.00024 + 0.00086 = 0.274475;
    // y' = 0.4 * 0.91125 + p1 (r^2 + 2 y^2) + 2 p2 x y = 0.3645 + 0.00057 + 0.00048 = 0.36555.
    const CameraIntrinsics radtan = camera(CameraModel::PinholeRadtan, {-0.4, 0.2, 0.001, 0.002, -0.08});
    QVERIFY((distort(radtan, {0.3, 0.4}) - Vector2d(0.274475, 0.36555)).norm() < 1e-15);
    // 45 degrees off axis, to the right: the angle is pi/4, with k1 = 0.1 it is seen at
    // pi/4 (1 + 0.1 pi^2/16).
    const CameraIntrinsics fisheye = camera(CameraModel::PinholeEquidistant, {0.1, 0.0, 0.0, 0.0, 0.0});
    const double seen = pi / 4.0 * (1.0 + 0.1 * pi * pi / 16.0);
    QVERIFY((*project(fisheye, {3.0, 0.0, 3.0}) - Vector2d(170.0 + 260.0 * seen, 131.0)).norm() < 1e-12);
  }

  void principalPoint_isWhereTheAxisIsSeen_data() { cameraRows(); }
  void principalPoint_isWhereTheAxisIsSeen() {
    QFETCH(int, index);
    const CameraIntrinsics c = cameras()[static_cast<std::size_t>(index)].camera;
    QVERIFY((*project(c, {0.0, 0.0, 0.7}) - c.principal_point_px).norm() < 1e-13);
    QVERIFY(unproject(c, c.principal_point_px)->norm() < 1e-13);
  }

  void ray_ofAPixel_isSeenAtThatPixel_data() { cameraRows(); }
  void ray_ofAPixel_isSeenAtThatPixel() {
    QFETCH(int, index);
    const CameraIntrinsics c = cameras()[static_cast<std::size_t>(index)].camera;
    for (const Vector2d& pixel : pixels(c)) {
      const std::optional<Vector2d> ray = unproject(c, pixel);
      QVERIFY(ray);
      const std::optional<Vector2d> seen = project(c, 1.7 * ray->homogeneous());
      QVERIFY(seen);
      QVERIFY((*seen - pixel).norm() < 1e-9);
      const std::optional<Vector2d> again = unproject(c, *seen);
      QVERIFY(again && (*again - *ray).norm() < 1e-11);
    }
  }

  void jacobianOfThePoint_matchesNumericDifferences_data() { cameraRows(); }
  void jacobianOfThePoint_matchesNumericDifferences() {
    QFETCH(int, index);
    const CameraIntrinsics c = cameras()[static_cast<std::size_t>(index)].camera;
    for (const Vector2d& pixel : pixels(c)) {
      const Vector3d point = 0.8 * unproject(c, pixel)->homogeneous();
      Eigen::Matrix<double, 2, 3> jacobian;
      QVERIFY(project(c, point, &jacobian));
      const Eigen::MatrixXd numeric = test::numericJacobian(
          [&](const Eigen::VectorXd& d) -> Eigen::VectorXd { return *project(c, point + d); }, 3, 1e-4);
      QVERIFY(test::relativeDifference(jacobian, numeric) < 1e-9);
    }
  }

  void jacobianOfTheIntrinsics_matchesNumericDifferences_data() { cameraRows(); }
  void jacobianOfTheIntrinsics_matchesNumericDifferences() {
    QFETCH(int, index);
    const CameraIntrinsics c = cameras()[static_cast<std::size_t>(index)].camera;
    for (const Vector2d& pixel : pixels(c)) {
      const Vector3d point = unproject(c, pixel)->homogeneous();
      IntrinsicsJacobian jacobian;
      QVERIFY(project(c, point, nullptr, &jacobian));
      const Eigen::MatrixXd numeric = test::numericJacobian(
          [&](const Eigen::VectorXd& d) -> Eigen::VectorXd { return *project(withChange(c, d), point); }, 9,
          1e-4);
      QVERIFY(test::relativeDifference(jacobian, numeric) < 1e-8);
    }
  }

  void jacobianOfDistortion_matchesNumericDifferences_data() { cameraRows(); }
  void jacobianOfDistortion_matchesNumericDifferences() {
    QFETCH(int, index);
    const CameraIntrinsics c = cameras()[static_cast<std::size_t>(index)].camera;
    for (const Vector2d& n :
         {Vector2d(0.0, 0.0), Vector2d(1e-9, 0.0), Vector2d(0.3, -0.2), Vector2d(-0.5, 0.45)}) {
      Eigen::Matrix2d jacobian;
      QCOMPARE(distort(c, n, &jacobian), distort(c, n));
      const Eigen::MatrixXd numeric = test::numericJacobian(
          [&](const Eigen::VectorXd& d) -> Eigen::VectorXd { return distort(c, n + d); }, 2, 1e-4);
      QVERIFY(test::relativeDifference(jacobian, numeric) < 1e-7);  // differences cross the centre's cone
    }
  }

  void pointThatIsNotInFront_isNotSeen_data() { cameraRows(); }
  void pointThatIsNotInFront_isNotSeen() {
    QFETCH(int, index);
    const CameraIntrinsics c = cameras()[static_cast<std::size_t>(index)].camera;
    for (const Vector3d& point :
         {Vector3d(0.0, 0.0, -1.0), Vector3d(0.01, 0.02, -1.0), Vector3d(0.0, 0.0, 0.0),
          Vector3d(0.1, 0.2, kNan), Vector3d(kNan, 0.2, 1.0)})
      QVERIFY(!project(c, point));
    const bool wide = c.model != CameraModel::PinholeRadtan && c.model != CameraModel::PinholeEquidistant;
    if (wide) return;
    for (const Vector3d& point : {Vector3d(0.1, 0.2, 0.0), Vector3d(0.1, 0.2, -1.0)})
      QVERIFY(!project(c, point));
  }

  void pointBeyondTheDistortionsFold_isNotSeen() {
    // r (1 - 0.5 r^2) increases up to r = sqrt(2/3) = 0.8165, where it is 0.5443; points farther away would
    // be imaged nearer to the centre again.
    const CameraIntrinsics c = camera(CameraModel::PinholeRadtan, {-0.5, 0.0, 0.0, 0.0, 0.0});
    QVERIFY(project(c, {0.816, 0.0, 1.0}));
    QVERIFY(!project(c, {0.817, 0.0, 1.0}));
    QVERIFY(!project(c, {0.0, 3.0, 1.0}));
    QVERIFY(unproject(c, {170.0 + 260.0 * 0.544, 131.0}));
    QVERIFY(!unproject(c, {170.0 + 260.0 * 0.545, 131.0}));
  }

  void rayMoreThan85DegreesOffAxis_isNone() {
    const CameraIntrinsics c = camera(CameraModel::PinholeEquidistant, {});
    const auto pixelAt = [](double angle_deg) {
      return Vector2d(170.0, 131.0 + 250.0 * angle_deg * pi / 180.0);
    };
    const std::optional<Vector2d> inside = unproject(c, pixelAt(84.9));
    QVERIFY(inside);
    QVERIFY(std::abs(std::atan(inside->y()) * 180.0 / pi - 84.9) < 1e-9);
    QVERIFY(!unproject(c, pixelAt(85.1)));
    QVERIFY(!unproject(c, pixelAt(120.0)));
  }

  void idealPixel_andPixelFromIdeal_areInverse_data() { cameraRows(); }
  void idealPixel_andPixelFromIdeal_areInverse() {
    QFETCH(int, index);
    const CameraIntrinsics c = cameras()[static_cast<std::size_t>(index)].camera;
    for (const Vector2d& pixel : pixels(c)) {
      const std::optional<Vector2d> ideal = idealPixel(c, pixel);
      QVERIFY(ideal);
      QVERIFY((pixelFromIdeal(c, *ideal) - pixel).norm() < 1e-9);
      const Vector2d ray = (*ideal - c.principal_point_px).cwiseQuotient(idealFocalLength_px(c));
      QVERIFY((ray - *unproject(c, pixel)).norm() < 1e-12);
    }
  }

  void idealPixelScale_isTheDerivativeOfTheIdealPixel_data() { cameraRows(); }
  void idealPixelScale_isTheDerivativeOfTheIdealPixel() {
    QFETCH(int, index);
    const CameraIntrinsics c = cameras()[static_cast<std::size_t>(index)].camera;
    for (const Vector2d& pixel : pixels(c)) {
      const Eigen::MatrixXd numeric = test::numericJacobian(
          [&](const Eigen::VectorXd& d) -> Eigen::VectorXd { return *idealPixel(c, pixel + d); }, 2, 1e-2);
      QVERIFY(test::relativeDifference(idealPixelScale(c, *idealPixel(c, pixel)), numeric) < 1e-7);
    }
  }

  // In the image centre, a size in ideal pixels is the same size on the sensor.
  void idealPixels_haveTheSensorsScaleOnTheAxis_data() { cameraRows(); }
  void idealPixels_haveTheSensorsScaleOnTheAxis() {
    QFETCH(int, index);
    const CameraIntrinsics c = cameras()[static_cast<std::size_t>(index)].camera;
    QVERIFY((idealPixelScale(c, c.principal_point_px) - Eigen::Matrix2d::Identity()).norm() < 1e-12);
    Eigen::Matrix<double, 2, 3> jacobian;
    QVERIFY(project(c, {0.0, 0.0, 2.0}, &jacobian));
    QVERIFY((2.0 * jacobian.leftCols<2>().diagonal() - idealFocalLength_px(c)).norm() < 1e-9);
  }

  // Every pixel of a wide image has one ray, which may point behind the camera and projects to that pixel.
  void rayAtAnyAngle_isSeenAtItsPixel_data() { wideRows(); }
  void rayAtAnyAngle_isSeenAtItsPixel() {
    QFETCH(int, index);
    const CameraIntrinsics c = wideCameras()[static_cast<std::size_t>(index)].camera;
    double min_z = 1.0;
    for (const Vector2d& pixel : pixels(c)) {
      const std::optional<Vector3d> ray = unprojectRay(c, pixel);
      if (!ray) continue;  // beyond the image circle
      QVERIFY(std::abs(ray->norm() - 1.0) < 1e-12);
      const std::optional<Vector2d> seen = project(c, 3.0 * *ray);
      QVERIFY(seen);
      QVERIFY2((*seen - pixel).norm() < 1e-8, qPrintable(QString::number((*seen - pixel).norm())));
      QCOMPARE(unproject(c, pixel).has_value(), ray->z() > std::cos(85.0 * pi / 180.0));
      min_z = std::min(min_z, ray->z());
    }
    QVERIFY2(min_z < std::cos(95.0 * pi / 180.0), qPrintable(QString::number(min_z)));
  }

  void directionBeyond90Degrees_isTheRayOfItsPixel_data() { wideRows(); }
  void directionBeyond90Degrees_isTheRayOfItsPixel() {
    QFETCH(int, index);
    const CameraIntrinsics c = wideCameras()[static_cast<std::size_t>(index)].camera;
    for (const double angle_deg : {30.0, 80.0, 89.9999, 90.0, 90.0001, 97.0, 105.0}) {
      for (double round_rad = 0.0; round_rad < 6.0; round_rad += 0.7) {
        const Vector3d point = 0.6 * direction(angle_deg, round_rad);
        Eigen::Matrix<double, 2, 3> by_point;
        IntrinsicsJacobian by_intrinsics;
        const auto pixel = project(c, point, &by_point, &by_intrinsics);
        QVERIFY(pixel);
        QVERIFY((*unprojectRay(c, *pixel) - point.normalized()).norm() < 1e-9);
        const Eigen::MatrixXd point_numeric = test::numericJacobian(
            [&](const Eigen::VectorXd& d) -> Eigen::VectorXd { return *project(c, point + d); }, 3, 1e-4);
        QVERIFY(test::relativeDifference(by_point, point_numeric) < 1e-8);
        const Eigen::MatrixXd numeric = test::numericJacobian(
            [&](const Eigen::VectorXd& d) -> Eigen::VectorXd { return *project(withChange(c, d), point); }, 9,
            1e-4);
        QVERIFY(test::relativeDifference(by_intrinsics, numeric) < 1e-8);
      }
    }
  }

  // Up to the model's limit the image radius increases with the angle; at the limit it reaches its maximum,
  // and beyond it there is no image. The angles for a unit circle seen through a further one are found by
  // bisection (docs/maths.md, 3.1).
  void imageRadius_growsUpToTheModelsEnd_data() { addRows(cameras()); }
  void imageRadius_growsUpToTheModelsEnd() {
    QFETCH(int, index);
    const CameraIntrinsics c = cameras()[static_cast<std::size_t>(index)].camera;
    double before = -1.0;
    bool ended = false;
    for (double angle_deg = 0.0; angle_deg < 180.0; angle_deg += 0.25) {
      const auto pixel = project(c, direction(angle_deg, 0.4));
      QVERIFY(!(ended && pixel));
      ended = ended || !pixel;
      if (!pixel) continue;
      const double radius = (*pixel - c.principal_point_px).cwiseQuotient(c.focal_length_px).norm();
      QVERIFY2(radius > before, qPrintable(QString::number(angle_deg)));
      before = radius;
    }
    QVERIFY(ended);
  }

  void doubleSphere_endsWhereItsImageTurnsBack_data() {
    QTest::addColumn<double>("xi");
    QTest::addColumn<double>("alpha");
    QTest::addColumn<double>("end_deg");
    // With w = cos(pi - angle) at the second sphere, min(alpha, 1 - alpha) / max(alpha, 1 - alpha), the angle
    // at the first is pi - acos(xi (1 - w^2) + w sqrt(1 - xi^2 (1 - w^2))).
    QTest::newRow("xi = 0, alpha = 0.6") << 0.0 << 0.6 << 131.810315;            // acos(-2/3)
    QTest::newRow("xi = 0, alpha = 0.4") << 0.0 << 0.4 << 131.810315;            // the image goes to infinity
    QTest::newRow("xi = -0.5, alpha = 1") << -0.5 << 1.0 << 60.0;                // acos(1/2)
    QTest::newRow("xi = -0.2, alpha = 2/3") << -0.2 << 2.0 / 3.0 << 110.025778;  // -0.2 0.75 + 0.5 sqrt(0.97)
  }
  void doubleSphere_endsWhereItsImageTurnsBack() {
    QFETCH(double, xi);
    QFETCH(double, alpha);
    QFETCH(double, end_deg);
    const CameraIntrinsics c = camera(CameraModel::DoubleSphere, {xi, alpha, 0.0, 0.0, 0.0});
    QVERIFY(project(c, direction(end_deg - 1e-3, 1.0)));
    QVERIFY(!project(c, direction(end_deg + 1e-3, 1.0)));
  }

  // alpha = 0.5 and beta = 1, or xi = 0, is the stereographic projection, 2 tan(angle / 2); so is omni with
  // xi = 1.
  void stereographicProjection_isAmongAllThree() {
    const CameraIntrinsics sphere = camera(CameraModel::DoubleSphere, {0.0, 0.5, 0.0, 0.0, 0.0});
    const CameraIntrinsics eucm = camera(CameraModel::Eucm, {0.5, 1.0, 0.0, 0.0, 0.0});
    CameraIntrinsics omni = camera(CameraModel::OmniRadtan, {1.0, 0.0, 0.0, 0.0, 0.0});
    omni.focal_length_px *= 2.0;
    for (const double angle_deg : {10.0, 60.0, 90.0, 120.0, 170.0}) {
      const double radius = 2.0 * std::tan(0.5 * angle_deg * pi / 180.0);
      const Vector2d expected(170.0 + 260.0 * radius * std::cos(0.3), 131.0 + 250.0 * radius * std::sin(0.3));
      for (const CameraIntrinsics& c : {sphere, eucm, omni})
        QVERIFY((*project(c, direction(angle_deg, 0.3)) - expected).norm() < 1e-9);
    }
  }

  // One lens, calibrated three times: the left camera of the data set TUM VI (512 x 512), as a pinhole with
  // equidistant distortion by Kalibr, and as EUCM and double sphere by Basalt's authors. Up to 80 degrees
  // from the optical axis, at 266 px from the centre, they agree to less than a pixel.
  void publishedCamerasOfOneLens_agree() {
    const auto lens = [](CameraModel model, Vector2d f, Vector2d c, const std::array<double, 5>& d) {
      return CameraIntrinsics{model, {512, 512}, f, c, d};
    };
    const CameraIntrinsics kb4 =
        lens(CameraModel::PinholeEquidistant, {190.978477, 190.973307}, {254.931706, 256.897443},
             {0.00348238940, 0.000715034845, -0.00205323614, 0.000202936736, 0.0});
    const CameraIntrinsics sphere =
        lens(CameraModel::DoubleSphere, {158.286000, 158.274346}, {254.961166, 256.889439},
             {-0.172130860, 0.593117759, 0.0, 0.0, 0.0});
    const CameraIntrinsics eucm = lens(CameraModel::Eucm, {191.147998, 191.131509}, {254.958577, 256.881547},
                                       {0.629106087, 1.04180674, 0.0, 0.0, 0.0});
    double sphere_px = 0.0, eucm_px = 0.0;
    for (double angle_deg = 0.0; angle_deg <= 80.0; angle_deg += 5.0) {
      for (double round_rad = 0.0; round_rad < 6.0; round_rad += 1.0) {
        const Vector3d ray = direction(angle_deg, round_rad);
        sphere_px = std::max(sphere_px, (*project(sphere, ray) - *project(kb4, ray)).norm());
        eucm_px = std::max(eucm_px, (*project(eucm, ray) - *project(kb4, ray)).norm());
      }
    }
    qInfo("double sphere %.2f px, EUCM %.2f px from Kalibr's", sphere_px, eucm_px);
    QVERIFY2(sphere_px < 0.8, qPrintable(QString::number(sphere_px)));
    QVERIFY2(eucm_px < 1.5, qPrintable(QString::number(eucm_px)));
  }

  void undistortionTable_holdsTheIdealPixelOfEveryPixel() {
    CameraIntrinsics c = cameras()[1].camera;
    c.resolution_px = {40, 30};
    const UndistortionTable table(c);
    QVERIFY(!table.empty());
    QVERIFY(UndistortionTable().empty());
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 40; ++x) QCOMPARE(table(x, y), idealPixel(c, Vector2d(x, y))->cast<float>().eval());
    c.distortion = {-0.5, 0.0, 0.0, 0.0, 0.0};
    c.focal_length_px = {20.0, 20.0};  // the first pixel is beyond the fold
    QVERIFY(!UndistortionTable(c)(0, 0).allFinite());
  }

  void numbersThatMakeNoCamera_areRefused_data() {
    QTest::addColumn<double>("focal_length_px");
    QTest::addColumn<double>("principal_point_px");
    QTest::addColumn<double>("distortion");
    QTest::addColumn<int>("width_px");
    QTest::addColumn<QString>("says");
    QTest::newRow("good") << 260.0 << 170.0 << 0.1 << 346 << QString();
    QTest::newRow("no resolution") << 260.0 << 170.0 << 0.1 << 0 << "resolution_px";
    QTest::newRow("focal length 0") << 0.0 << 170.0 << 0.1 << 346 << "focal_length_px";
    QTest::newRow("negative focal length") << -260.0 << 170.0 << 0.1 << 346 << "focal_length_px";
    QTest::newRow("focal length nan") << kNan << 170.0 << 0.1 << 346 << "focal_length_px";
    QTest::newRow("principal point nan") << 260.0 << kNan << 0.1 << 346 << "principal_point_px";
    QTest::newRow("distortion nan") << 260.0 << 170.0 << kNan << 346 << "distortion";
  }
  void numbersThatMakeNoCamera_areRefused() {
    QFETCH(double, focal_length_px);
    QFETCH(double, principal_point_px);
    QFETCH(double, distortion);
    QFETCH(int, width_px);
    QFETCH(QString, says);
    CameraIntrinsics c = camera(CameraModel::PinholeRadtan, {0.0, 0.0, 0.0, distortion, 0.0});
    c.focal_length_px.x() = focal_length_px;
    c.principal_point_px.y() = principal_point_px;
    c.resolution_px.width_px = width_px;
    const std::optional<CalibrationError> error = refusalOf(c);
    QCOMPARE(error.has_value(), !says.isEmpty());
    if (!error) return;
    QVERIFY(error->kind() == ErrorKind::BadInput);
    QCOMPARE(error->place(), std::string("left"));
    QVERIFY2(QString(error->what()).contains(says), error->what());
  }

  void exchangedPrincipalPoint_isRefused_data() {
    QTest::addColumn<double>("x_px");
    QTest::addColumn<double>("y_px");
    QTest::addColumn<int>("height_px");
    QTest::addColumn<bool>("is_refused");
    QTest::newRow("exchanged") << 131.0 << 170.0 << 260 << true;
    QTest::newRow("in order") << 170.0 << 131.0 << 260 << false;
    QTest::newRow("shifted lens") << 110.0 << 131.0 << 260 << false;
    QTest::newRow("lens shifted towards the exchanged one") << 110.0 << 145.0 << 260 << false;
    QTest::newRow("square image") << 131.0 << 170.0 << 346 << false;
  }
  void exchangedPrincipalPoint_isRefused() {
    QFETCH(double, x_px);
    QFETCH(double, y_px);
    QFETCH(int, height_px);
    QFETCH(bool, is_refused);
    CameraIntrinsics c = camera(CameraModel::PinholeRadtan, {});
    c.principal_point_px = {x_px, y_px};
    c.resolution_px.height_px = height_px;
    const std::optional<CalibrationError> error = refusalOf(c);
    QCOMPARE(error.has_value(), is_refused);
    if (!error) return;
    QVERIFY(error->kind() == ErrorKind::BadInput);
    QVERIFY2(QString(error->what()).contains("x and y exchanged"), error->what());
  }

  void coefficientsOutOfRange_areRefused_data() {
    QTest::addColumn<int>("model");
    QTest::addColumn<double>("first");
    QTest::addColumn<double>("second");
    QTest::addColumn<QString>("says");
    const int sphere = static_cast<int>(CameraModel::DoubleSphere),
              eucm = static_cast<int>(CameraModel::Eucm), omni = static_cast<int>(CameraModel::OmniRadtan);
    QTest::newRow("double sphere") << sphere << -0.2 << 0.6 << QString();
    QTest::newRow("order of EUCM in a double sphere") << sphere << 0.6 << 1.1 << "alpha is 1.1";
    QTest::newRow("alpha below 0") << sphere << -0.2 << -0.1 << "alpha is -0.1";
    QTest::newRow("xi of 1") << sphere << 1.0 << 0.6 << "xi is 1";
    QTest::newRow("eucm") << eucm << 0.6 << 1.1 << QString();
    QTest::newRow("beta of 0") << eucm << 0.6 << 0.0 << "beta is 0";
    QTest::newRow("alpha above 1") << eucm << 1.1 << 0.6 << "alpha is 1.1";
    QTest::newRow("omni") << omni << 1.5 << -0.2 << QString();
    QTest::newRow("omni, xi below 0") << omni << -0.1 << -0.2 << "xi is -0.1";
  }
  void coefficientsOutOfRange_areRefused() {
    QFETCH(int, model);
    QFETCH(double, first);
    QFETCH(double, second);
    QFETCH(QString, says);
    const CameraIntrinsics c = camera(static_cast<CameraModel>(model), {first, second, 0.0, 0.0, 0.0});
    const std::optional<CalibrationError> error = refusalOf(c);
    QCOMPARE(error.has_value(), !says.isEmpty());
    if (error) QVERIFY2(QString(error->what()).contains(says), error->what());
  }
};

EVICAL_TEST(TestCameraModel)
#include "tst_camera_model.moc"
