#include "core/export/export_text.h"
#include "core/export/kalibr_text.h"
#include "core/format/intrinsics_yaml.h"
#include "core/geometry/projection_difference.h"
#include "core/report/intrinsics_report.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <algorithm>
#include <filesystem>
#include <fstream>

using namespace evical;

namespace {

NamedIntrinsics sampleForIntrinsicsReport(CameraModel model) {
  NamedIntrinsics named;
  named.camera = "left";
  named.stream = "/davis/events";
  named.version = "0.1.0";
  IntrinsicsResult& result = named.result;
  result.intrinsics.model = model;
  result.intrinsics.resolution_px = {346, 260};
  result.intrinsics.focal_length_px = {1.0 / 3.0 + 260.0, 255.0};
  result.intrinsics.principal_point_px = {170.25, 131.0};
  result.intrinsics.distortion = {-0.3, 0.1, 1e-3, 2e-3, 0.0};
  result.covariance.diagonal().head<8>().setConstant(0.0025);
  result.covariance(0, 1) = result.covariance(1, 0) = 0.00125;
  result.image.columns = 2;
  result.image.rows = 1;
  result.image.cells = {{{86.5, 129.5}, 0, 0.2}, {{259.5, 129.5}, 30, 0.02}};
  result.image.rms_px = 0.14;
  result.image.max_px = 0.2;
  result.advice = {"No views in the left edge: move the board there"};
  return named;
}

}  // namespace

class TestIntrinsicsReport : public QObject {
  Q_OBJECT

 private slots:
  void files_readBackAsIntrinsics_data() {
    QTest::addColumn<bool>("fisheye");
    QTest::newRow("radtan") << false;
    QTest::newRow("equidistant") << true;
  }
  void files_readBackAsIntrinsics() {
    QFETCH(bool, fisheye);
    const NamedIntrinsics named =
        sampleForIntrinsicsReport(fisheye ? CameraModel::PinholeEquidistant : CameraModel::PinholeRadtan);
    const CameraIntrinsics& camera = named.result.intrinsics;
    for (const std::string& text : {intrinsicsResultYaml(named), cameraInfoYaml("left", camera),
                                    camchainYaml("/davis/events", camera)}) {
      const QTemporaryDir folder;
      const std::filesystem::path file = folder.filePath("camera.yaml").toStdString();
      std::ofstream(file) << text;
      QVERIFY2(readIntrinsicsFile(file, "left", "/davis/events") == camera, text.c_str());
    }
  }

  // ROS supports pinholes only: its file has an equidistant lens and states the fit error.
  void wideModels_readBackButFromRos_data() {
    QTest::addColumn<int>("model");
    QTest::addColumn<QString>("distortion");
    QTest::newRow("double sphere") << static_cast<int>(CameraModel::DoubleSphere)
                                   << "distortion: [-0.2, 0.6]  # xi, alpha";
    QTest::newRow("eucm") << static_cast<int>(CameraModel::Eucm) << "distortion: [0.6, 1.1]  # alpha, beta";
    QTest::newRow("omni") << static_cast<int>(CameraModel::OmniRadtan)
                          << "distortion: [1.2, -0.1, 0.01, 0.001, 0.002]  # xi, k1, k2, p1, p2";
  }
  void wideModels_readBackButFromRos() {
    QFETCH(int, model);
    QFETCH(QString, distortion);
    NamedIntrinsics named = sampleForIntrinsicsReport(static_cast<CameraModel>(model));
    CameraIntrinsics& camera = named.result.intrinsics;
    camera.distortion = {1.2, -0.1, 0.01, 0.001, 0.002};
    if (camera.model == CameraModel::DoubleSphere) camera.distortion = {-0.2, 0.6, 0.0, 0.0, 0.0};
    if (camera.model == CameraModel::Eucm) camera.distortion = {0.6, 1.1, 0.0, 0.0, 0.0};
    const std::string result = intrinsicsResultYaml(named);
    QVERIFY2(QString::fromStdString(result).contains(distortion), result.c_str());
    const YamlNode known = YamlNode::parse(result, "intrinsics.yaml");
    QVERIFY(readIntrinsics(known["intrinsics"]) == camera);
    QVERIFY(readIntrinsics(YamlNode::parse(camchainYaml("/events", camera), "camchain.yaml")["cam0"]) ==
            camera);
    const std::string info = cameraInfoYaml("left", camera);
    const QString first_line = QString::fromStdString(info).section('\n', 0, 0);
    QVERIFY2(first_line.startsWith("# ROS does not support the model "), info.c_str());
    const CameraIntrinsics fitted = readIntrinsics(YamlNode::parse(info, "camera_info.yaml"));
    QCOMPARE(fitted.model, CameraModel::PinholeEquidistant);
    QVERIFY(projectionDifference(camera, fitted).rms_px < 0.5);
    QCOMPARE(known["intrinsics_std"]["distortion"].reals().size(),
             static_cast<std::size_t>(distortionCount(camera)));
    QCOMPARE(known["correlation"].items().size(), static_cast<std::size_t>(4 + distortionCount(camera)));
  }

  void map_hasSigmasAndCorrelations() {
    NamedIntrinsics named = sampleForIntrinsicsReport(CameraModel::PinholeRadtan);
    named.notes = {"left: the tags are rotated"};
    const YamlNode root = YamlNode::parse(intrinsicsResultYaml(named), "x.yaml");
    QCOMPARE(root["notes"].items()[0].text(), named.notes[0]);
    QCOMPARE(root["status"].text(), std::string("ok"));
    QCOMPARE(root["intrinsics_std"]["focal_length_px"].reals(2)[0], 0.05);
    QCOMPARE(root["intrinsics_std"]["distortion"].reals(4)[3], 0.05);
    QCOMPARE(root["correlation"].items().size(), std::size_t{8});
    QCOMPARE(root["correlation"].items()[0].reals(8)[1], 0.5);
    QCOMPARE(root["projection_std_px"]["rms"].real(), 0.14);
    QCOMPARE(root["advice"].items().size(), std::size_t{1});
  }

  void table_showsSigmasCoverageAndAdvice() {
    const std::string text = intrinsicsTable(sampleForIntrinsicsReport(CameraModel::PinholeRadtan));
    for (const char* part :
         {"+- 0.05", "k1", "p2", ". # ", "Advice: No views in the left edge", "Verdict: ok"})
      QVERIFY2(text.find(part) != std::string::npos, part);
    QVERIFY(text.find("k3") == std::string::npos);
  }

  void imageMap_hasARowForEachCell() {
    const std::string text = imageMapCsv(sampleForIntrinsicsReport(CameraModel::PinholeRadtan).result.image);
    QCOMPARE(std::count(text.begin(), text.end(), '\n'), std::ptrdiff_t{3});
    QVERIFY(text.find("1,0,259.5,129.5,30,0.02000") != std::string::npos);
  }
};

EVICAL_TEST(TestIntrinsicsReport)
#include "tst_intrinsics_report.moc"
