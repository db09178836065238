#include "core/geometry/camera_model.h"

#include "core/base/error.h"
#include "core/geometry/undistortion_table.h"
#include "tests/support/numeric_jacobian.h"
#include "tests/support/test_program.h"

#include <Eigen/Dense>

#include <limits>
#include <numbers>
#include <vector>

namespace {

using namespace evical;
using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

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
  return {{"no distortion", camera(CameraModel::PinholeRadtan, {})},
          {"barrel", camera(CameraModel::PinholeRadtan, {-0.36, 0.16, 0.001, -0.0005, 0.0})},
          {"with k3", camera(CameraModel::PinholeRadtan, {-0.4, 0.25, -0.001, 0.002, -0.08})},
          {"pincushion", camera(CameraModel::PinholeRadtan, {0.1, 0.02, 0.0, 0.0, 0.0})},
          {"equidistant", camera(CameraModel::PinholeEquidistant, {})},
          {"fisheye", camera(CameraModel::PinholeEquidistant, {-0.02, 0.01, -0.004, 0.0007, 0.0})}};
}

void cameraRows() {
  QTest::addColumn<int>("index");
  const std::vector<NamedCamera> all = cameras();
  for (std::size_t i = 0; i < all.size(); ++i) QTest::newRow(all[i].name) << static_cast<int>(i);
}

// Pixels all over the image, its corners and its centre of distortion among them.
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
    const auto changed = [&](const Eigen::VectorXd& d) {
      CameraIntrinsics other = c;
      other.focal_length_px += d.head<2>();
      other.principal_point_px += d.segment<2>(2);
      for (std::size_t i = 0; i < 5; ++i) other.distortion[i] += d[4 + static_cast<Eigen::Index>(i)];
      return other;
    };
    for (const Vector2d& pixel : pixels(c)) {
      const Vector3d point = unproject(c, pixel)->homogeneous();
      IntrinsicsJacobian jacobian;
      QVERIFY(project(c, point, nullptr, &jacobian));
      const Eigen::MatrixXd numeric = test::numericJacobian(
          [&](const Eigen::VectorXd& d) -> Eigen::VectorXd { return *project(changed(d), point); }, 9, 1e-4);
      QVERIFY(test::relativeDifference(jacobian, numeric) < 1e-9);
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
    for (const Vector3d& point : {Vector3d(0.1, 0.2, 0.0), Vector3d(0.1, 0.2, -1.0), Vector3d(0.0, 0.0, -1.0),
                                  Vector3d(0.1, 0.2, kNan), Vector3d(kNan, 0.2, 1.0)})
      QVERIFY(!project(c, point));
  }

  void pointBeyondTheDistortionsFold_isNotSeen() {
    // r (1 - 0.5 r^2) grows up to r = sqrt(2/3) = 0.8165, where it is 0.5443; farther
    // points would come in again.
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
      const Vector2d ray = (*ideal - c.principal_point_px).cwiseQuotient(c.focal_length_px);
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
    if (says.isEmpty()) return validate(c, "left");
    try {
      validate(c, "left");
      QFAIL("must throw");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      QCOMPARE(error.place(), std::string("left"));
      QVERIFY2(QString(error.what()).contains(says), error.what());
    }
  }
};

EVICAL_TEST(TestCameraModel)
#include "tst_camera_model.moc"
