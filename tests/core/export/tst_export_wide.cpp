// Cameras of the wide models for other programs: unchanged if a program has the model, else refitted.
#include "core/base/yaml_node.h"
#include "core/format/intrinsics_yaml.h"
#include "core/geometry/camera_model.h"
#include "tests/core/export/exported_rig.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>

namespace {

using namespace evical;
using namespace evical::test;

constexpr double kExportWideSame_px = 1e-9;

CameraIntrinsics wideCamera(CameraModel model) {
  CameraIntrinsics camera{
      model, {346, 260}, {102.5, 101.25}, {171.25, 131.125}, {-0.17, 0.593, 0.0, 0.0, 0.0}};
  if (model == CameraModel::Eucm) camera.distortion = {0.63, 1.04, 0.0, 0.0, 0.0};
  if (model == CameraModel::OmniRadtan) {
    camera.focal_length_px *= 2.5;
    camera.distortion = {1.2, -0.03, 0.01, 4e-4, -3e-4};
  }
  return camera;
}

NamedResult wideRig(CameraModel model) {
  NamedResult result = rig({});
  for (CameraState& camera : ownResult(result).state.cameras) camera.lens = givenLens(wideCamera(model));
  return result;
}

// By angles, while our code uses vectors: theta from the optical axis is phi as seen from the second sphere's
// centre.
Lens angleLens(const std::vector<double>& k, double xi, double alpha, double beta) {
  return [=](const Eigen::Vector3d& point) {
    const double theta = std::atan2(std::sqrt(beta) * point.head<2>().norm(), point.z());
    const double phi = std::atan2(std::sin(theta), std::cos(theta) + xi);
    const double radius = std::sin(phi) / std::sqrt(beta) / (alpha + (1.0 - alpha) * std::cos(phi));
    const Eigen::Vector2d image = radius * point.head<2>().normalized();
    return Eigen::Vector2d(k[0] * image.x() + k[2], k[1] * image.y() + k[3]);
  };
}

// Alpha = 0: seen from the point xi behind the sphere's centre; then OpenCV's distortion.
Lens omniLens(const std::vector<double>& k, double xi, const std::vector<double>& radtan) {
  return [k, xi, radtan](const Eigen::Vector3d& point) {
    const Eigen::Vector2d on_plane = angleLens({1.0, 1.0, 0.0, 0.0}, xi, 0.0, 1.0)(point);
    return radtanLens(k, radtan)(on_plane.homogeneous());
  };
}

std::vector<double> from(const std::vector<double>& values, std::ptrdiff_t first) {
  return {values.begin() + first, values.end()};
}

std::vector<double> read(const cv::FileNode& node, const std::vector<const char*>& keys) {
  std::vector<double> values;
  for (const char* key : keys) values.push_back(static_cast<double>(node[key]));
  return values;
}

}  // namespace

class TestExportWide : public QObject {
  Q_OBJECT

 private slots:
  void kalibr_hasThem_data() {
    QTest::addColumn<int>("model");
    QTest::addColumn<QString>("name");
    QTest::newRow("ds") << static_cast<int>(CameraModel::DoubleSphere) << "ds";
    QTest::newRow("eucm") << static_cast<int>(CameraModel::Eucm) << "eucm";
    QTest::newRow("omni") << static_cast<int>(CameraModel::OmniRadtan) << "omni";
  }
  void kalibr_hasThem() {
    QFETCH(int, model);
    QFETCH(QString, name);
    const NamedResult result = wideRig(static_cast<CameraModel>(model));
    const ExportedFiles exported = exportTo(result, "kalibr");
    for (const std::string& note : exported.notes) QVERIFY2(note.find("refitted") == note.npos, note.c_str());
    const YAML::Node camera = yamlOf(exported, "kalibr/camchain.yaml")["cam0"];
    QCOMPARE(camera["camera_model"].as<std::string>(), name.toStdString());
    const auto k = numbers(camera["intrinsics"]), d = numbers(camera["distortion_coeffs"]);
    const bool omni = name == "omni";
    QCOMPARE(camera["distortion_model"].as<std::string>(), std::string(omni ? "radtan" : "none"));
    QCOMPARE(k.size(), omni ? 5U : 6U);
    QCOMPARE(d.size(), omni ? 4U : 0U);
    const Lens lens = omni           ? omniLens(from(k, 1), k[0], d)
                      : name == "ds" ? angleLens(from(k, 2), k[0], k[1], 1.0)
                                     : angleLens(from(k, 2), 0.0, k[0], k[1]);
    const CameraIntrinsics own = wideCamera(static_cast<CameraModel>(model));
    for (const Eigen::Vector3d& point : {Eigen::Vector3d(0.3, -0.2, 1.0), Eigen::Vector3d(-1.0, 0.4, 0.3)})
      QVERIFY((lens(point) - project(own, point).value()).norm() < kExportWideSame_px);
    // And back.
    const YamlNode chain = YamlNode::parse(contentOf(exported, "kalibr/camchain.yaml"), "camchain.yaml");
    QVERIFY(readIntrinsics(chain["cam0"]) == own);
  }

  void kalibr_otherDistortionOfAWideModel_isRefused() {
    const YamlNode omni = YamlNode::parse(
        "camera_model: omni\nintrinsics: [1.2, 250.0, 250.0, 170.0, 130.0]\ndistortion_model: equidistant\n"
        "distortion_coeffs: [0.0, 0.0, 0.0, 0.0]\nresolution: [346, 260]\n",
        "camchain.yaml");
    QVERIFY_THROWS_EXCEPTION(CalibrationError, readIntrinsics(omni));
    const YamlNode sphere = YamlNode::parse(
        "camera_model: ds\nintrinsics: [-0.2, 1.6, 250.0, 250.0, 170.0, 130.0]\ndistortion_model: none\n"
        "distortion_coeffs: []\nresolution: [346, 260]\n",
        "camchain.yaml");
    QVERIFY_THROWS_EXCEPTION(CalibrationError, readIntrinsics(sphere));
  }

  void basalt_hasDoubleSphereAndEucm() {
    for (const CameraModel model : {CameraModel::DoubleSphere, CameraModel::Eucm}) {
      const ExportedFiles exported = exportTo(wideRig(model), "basalt");
      const YAML::Node camera = yamlOf(exported, "basalt/calibration.json")["value0"]["intrinsics"][0];
      const bool sphere = model == CameraModel::DoubleSphere;
      QCOMPARE(camera["camera_type"].as<std::string>(), std::string(sphere ? "ds" : "eucm"));
      QCOMPARE(camera["intrinsics"].size(), 6U);
      const auto number = [&](const char* key) { return camera["intrinsics"][key].as<double>(); };
      const std::vector<double> k = {number("fx"), number("fy"), number("cx"), number("cy")};
      const Lens lens = sphere ? angleLens(k, number("xi"), number("alpha"), 1.0)
                               : angleLens(k, 0.0, number("alpha"), number("beta"));
      const Eigen::Vector3d point(-1.0, 0.4, 0.3);
      QVERIFY((lens(point) - project(wideCamera(model), point).value()).norm() < kExportWideSame_px);
    }
  }

  void vinsFusion_hasOmni() {
    const ExportedFiles exported = exportTo(wideRig(CameraModel::OmniRadtan), "vins-fusion");
    const cv::FileStorage camera(contentOf(exported, "vins-fusion/left.yaml"),
                                 cv::FileStorage::READ | cv::FileStorage::MEMORY);
    QCOMPARE(static_cast<std::string>(camera["model_type"]), std::string("MEI"));
    const Lens lens = omniLens(read(camera["projection_parameters"], {"gamma1", "gamma2", "u0", "v0"}),
                               static_cast<double>(camera["mirror_parameters"]["xi"]),
                               read(camera["distortion_parameters"], {"k1", "k2", "p1", "p2"}));
    const Eigen::Vector3d point(-1.0, 0.4, 0.3);
    QVERIFY((lens(point) - project(wideCamera(CameraModel::OmniRadtan), point).value()).norm() < 1e-6);
  }

  // OpenVINS supports pinholes only: equidistant is close enough, and the fit error is reported.
  void openVins_getsAnEquidistantOne() {
    NamedResult result = wideRig(CameraModel::DoubleSphere);
    CameraIntrinsics within_85_deg = wideCamera(CameraModel::DoubleSphere);
    within_85_deg.focal_length_px *= 2.0;
    for (CameraState& camera : ownResult(result).state.cameras) camera.lens = givenLens(within_85_deg);
    const ExportedFiles exported = exportTo(result, "openvins");
    const YAML::Node camera = yamlOf(exported, "openvins/kalibr_imucam_chain.yaml")["cam0"];
    QCOMPARE(camera["camera_model"].as<std::string>(), std::string("pinhole"));
    QCOMPARE(camera["distortion_model"].as<std::string>(), std::string("equidistant"));
    const double worst_px = worstDifference_px(
        result, 0,
        {rowsMatrix(camera["T_cam_imu"]), camera["timeshift_cam_imu"].as<double>(),
         fisheyeLens(numbers(camera["intrinsics"]), numbers(camera["distortion_coeffs"]))});
    QVERIFY2(worst_px < 2.0, qPrintable(QString::number(worst_px)));
    QVERIFY(std::any_of(exported.notes.begin(), exported.notes.end(), [](const std::string& note) {
      return note.find("OpenVINS does not support the model double_sphere: refitted") != note.npos;
    }));
  }

  // A file for one camera alone: Kalibr has the model, ROS does not.
  void rosAndMetavision_getNoDoubleSphere() {
    const NamedResult result = wideRig(CameraModel::DoubleSphere);
    const YAML::Node info = yamlOf(exportTo(result, "ros"), "ros/left.yaml");
    QCOMPARE(info["distortion_model"].as<std::string>(), std::string("equidistant"));
    QVERIFY_THROWS_EXCEPTION(CalibrationError, exportTo(result, "metavision"));
  }
};

EVICAL_TEST(TestExportWide)
#include "tst_export_wide.moc"
