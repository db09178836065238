// Cameras in single files of other programs: every layout that is exported, and files as their own programs
// write them.
#include "core/base/error.h"
#include "core/foreign/lens_files.h"
#include "core/format/intrinsics_yaml.h"
#include "tests/core/export/exported_rig.h"
#include "tests/support/file_cost.h"
#include "tests/support/test_program.h"

#include <QFile>
#include <QTemporaryDir>

#include <filesystem>

using namespace evical;
using namespace evical::test;

namespace {

// Imports the file with the reader that recognises it; empty if none does.
std::vector<CameraIntrinsics> lensesIn(const std::filesystem::path& path) {
  std::vector<CameraIntrinsics> lenses;
  if (const auto file = readLensFile(path)) {
    for (const evical::ReadCamera& camera : file->read.cameras) lenses.push_back(*camera.lens);
    return lenses;
  }
  YamlNode root = loadIntrinsics(path);
  if (!root.isMap()) return lenses;
  for (const std::string& name : camchainCameras(root)) lenses.push_back(readIntrinsics(root[name]));
  if (lenses.empty() && isLens(root)) lenses.push_back(readIntrinsicsFile(path, "", ""));
  return lenses;
}

bool isSame(const CameraIntrinsics& a, const CameraIntrinsics& b) {
  constexpr double kFloat = 1e-6;
  const auto near = [](double x, double y) { return std::abs(x - y) <= kFloat * std::max(1.0, std::abs(y)); };
  bool same = a.model == b.model && near(a.focal_length_px.x(), b.focal_length_px.x()) &&
              near(a.focal_length_px.y(), b.focal_length_px.y()) &&
              near(a.principal_point_px.x(), b.principal_point_px.x()) &&
              near(a.principal_point_px.y(), b.principal_point_px.y());
  for (std::size_t i = 0; i < a.distortion.size(); ++i) same = same && near(a.distortion[i], b.distortion[i]);
  return same;
}

// Number of the result's cameras that the target's files contain.
int camerasBack(const NamedResult& result, const std::filesystem::path& folder) {
  std::vector<CameraIntrinsics> all;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    try {
      for (const CameraIntrinsics& lens : lensesIn(entry.path())) all.push_back(lens);
    } catch (const CalibrationError&) {
      continue;  // a launch file, a README
    }
  }
  int found = 0;
  for (const CameraState& camera : result.result->state.cameras)
    found += std::any_of(all.begin(), all.end(),
                         [&](const CameraIntrinsics& lens) { return isSame(lens, *camera.lens.inUse()); });
  return found;
}

struct Sample {
  const char* name;
  const char* content;
  CameraModel model;
  double fx, last;  // the last coefficient that is not 0
};

const Sample kSamples[] = {
    {"camodocal.yaml",
     "%YAML:1.0\n---\nmodel_type: PINHOLE\ncamera_name: camera\nimage_width: 640\nimage_height: 480\n"
     "distortion_parameters:\n   k1: 0.1\n   k2: -0.2\n   p1: 0.001\n   p2: -0.002\n"
     "projection_parameters:\n   fx: 385.75\n   fy: 385.5\n   cx: 323.1\n   cy: 236.7\n",
     CameraModel::PinholeRadtan, 385.75, -0.002},
    {"kannala.yaml",
     "%YAML:1.0\n---\nmodel_type: KANNALA_BRANDT\ncamera_name: cam0\nimage_width: 752\nimage_height: 480\n"
     "projection_parameters:\n   k2: 0.01\n   k3: -0.02\n   k4: 0.03\n   k5: -0.04\n   mu: 350.5\n   mv: "
     "351.5\n"
     "   u0: 366.5\n   v0: 246.5\n",
     CameraModel::PinholeEquidistant, 350.5, -0.04},
    {"LeftCameraParams.yaml",
     "%YAML:1.0\n# General sensor definitions.\ncamera_id: left_cam\n\n# Sensor extrinsics wrt. the "
     "body-frame.\n"
     "T_BS:\n  cols: 4\n  rows: 4\n  data: [0.0148655429818, -0.999880929698, 0.00414029679422, "
     "-0.0216401454975,\n"
     "         0.999557249008, 0.0149672133247, 0.025715529948, -0.064676986768,\n"
     "        -0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949,\n         0.0, 0.0, 0.0, "
     "1.0]\n"
     "rate_hz: 20\nresolution: [752, 480]\ncamera_model: pinhole\n"
     "intrinsics: [458.654, 457.296, 367.215, 248.375] #fu, fv, cu, cv\ndistortion_model: radial-tangential\n"
     "distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]\n",
     CameraModel::PinholeRadtan, 458.654, 1.76187114e-05},
    {"sensor.yaml",
     "sensor_type: camera\ncomment: VI-Sensor cam0 (MT9M034)\nT_BS:\n  cols: 4\n  rows: 4\n"
     "  data: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\nrate_hz: 20\nresolution: [752, 480]\n"
     "camera_model: pinhole\nintrinsics: [458.654, 457.296, 367.215, 248.375]\ndistortion_model: "
     "radial-tangential\n"
     "distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]\n",
     CameraModel::PinholeRadtan, 458.654, 1.76187114e-05},
    {"svo.yaml",
     "label: \"rig\"\nid: 412eab8e4058621f7036b5e765dfe812\ncameras:\n- camera:\n    label: cam0\n"
     "    id: 54812562fa109c40fe90b29a59dd7723\n    line-delay-nanoseconds: 0\n    image_height: 480\n"
     "    image_width: 640\n    type: pinhole\n    intrinsics:\n      cols: 1\n      rows: 4\n"
     "      data: [329.11, 329.12, 320.13, 240.14]\n    distortion:\n      type: equidistant\n      "
     "parameters:\n"
     "        cols: 1\n        rows: 4\n        data: [-0.01, 0.02, -0.03, 0.04]\n  T_B_C:\n    cols: 4\n    "
     "rows: 4\n"
     "    data: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n",
     CameraModel::PinholeEquidistant, 329.11, 0.04},
    {"out_camera_data.yml",
     "%YAML:1.0\n---\ncalibration_time: \"Mon Nov 23\"\nnr_of_frames: 25\nimage_width: 640\nimage_height: "
     "480\n"
     "board_width: 9\nflags: 0\nfisheye_model: 0\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   "
     "dt: d\n"
     "   data: [ 535.35, 0., 320.5, 0., 535.36, 240.5, 0., 0., 1. ]\ndistortion_coefficients: "
     "!!opencv-matrix\n"
     "   rows: 5\n   cols: 1\n   dt: d\n   data: [ -0.26, -0.04, 0.001, -0.0003, 0.23 ]\n",
     CameraModel::PinholeRadtan, 535.35, 0.23},
    {"fisheye.yml",
     "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\nfisheye_model: 1\ncamera_matrix: "
     "!!opencv-matrix\n   rows: 3\n"
     "   cols: 3\n   dt: d\n   data: [ 335.35, 0., 320.5, 0., 335.36, 240.5, 0., 0., 1. ]\n"
     "distortion_coefficients: !!opencv-matrix\n   rows: 4\n   cols: 1\n   dt: d\n   data: [ 0.01, 0.02, "
     "0.03, 0.05 ]\n",
     CameraModel::PinholeEquidistant, 335.35, 0.05},
    // The name is that of DV 1.x; the values are by the keys of its source.
    {"calibration_camera_DAVIS346.xml",
     "<?xml version=\"1.0\"?>\n<opencv_storage>\n<DAVIS346_00000499>\n<camera_matrix "
     "type_id=\"opencv-matrix\">\n"
     "<rows>3</rows><cols>3</cols><dt>d</dt>\n<data>261.5 0. 172.5 0. 262.5 131.5 0. 0. "
     "1.</data></camera_matrix>\n"
     "<distortion_coefficients type_id=\"opencv-matrix\">\n<rows>1</rows><cols>5</cols><dt>d</dt>\n"
     "<data>-0.36 0.14 0.0001 -0.0002 0.</data></distortion_coefficients>\n<image_width>346</image_width>\n"
     "<image_height>260</image_height>\n</DAVIS346_00000499>\n<type>camera</type>\n"
     "<use_fisheye_model>0</use_fisheye_model>\n</opencv_storage>\n",
     CameraModel::PinholeRadtan, 261.5, -0.0002},
    {"calibration_camera_fisheye.xml",
     "<?xml version=\"1.0\"?>\n<opencv_storage>\n<DAVIS346_00000499>\n<camera_matrix "
     "type_id=\"opencv-matrix\">\n"
     "<rows>3</rows><cols>3</cols><dt>d</dt>\n<data>261.5 0. 172.5 0. 262.5 131.5 0. 0. "
     "1.</data></camera_matrix>\n"
     "<distortion_coefficients type_id=\"opencv-matrix\">\n<rows>1</rows><cols>4</cols><dt>d</dt>\n"
     "<data>0.01 0.02 0.03 0.04</data></distortion_coefficients>\n</DAVIS346_00000499>\n"
     "<image_width>346</image_width>\n<image_height>260</image_height>\n"
     "<use_fisheye_model>1</use_fisheye_model>\n<comment></comment>\n</opencv_storage>\n",
     CameraModel::PinholeEquidistant, 261.5, 0.04},
    // Written like by DV's newer module: the flag is always 0.
    {"calibration_imu_DAVIS346.xml",
     "<?xml version=\"1.0\"?>\n<opencv_storage>\n<camera_matrix type_id=\"opencv-matrix\">\n"
     "<rows>3</rows><cols>3</cols><dt>d</dt>\n<data>261.5 0. 172.5 0. 262.5 131.5 0. 0. "
     "1.</data></camera_matrix>\n"
     "<distortion_coefficients type_id=\"opencv-matrix\">\n<rows>1</rows><cols>4</cols><dt>d</dt>\n"
     "<data>0.01 0.02 0.03 0.04</data></distortion_coefficients>\n<image_width>346</image_width>\n"
     "<image_height>260</image_height>\n<use_fisheye_model>0</use_fisheye_model>\n"
     "<distortion_model>Equidistant</distortion_model>\n</opencv_storage>\n",
     CameraModel::PinholeEquidistant, 261.5, 0.04},
    // Stereo settings of ORB-SLAM2 for EuRoC: Camera.* is the rectified camera.
    {"EuRoC.yaml",
     "%YAML:1.0\nCamera.fx: 435.2046959714599\nCamera.fy: 435.2046959714599\nCamera.cx: 367.4517211914062\n"
     "Camera.cy: 252.2008514404297\nCamera.k1: 0.0\nCamera.k2: 0.0\nCamera.p1: 0.0\nCamera.p2: 0.0\n"
     "Camera.width: 752\nCamera.height: 480\nLEFT.height: 480\nLEFT.width: 752\n"
     "LEFT.D: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n"
     "   data: [ -0.28340811, 0.07395907, 0.00019359, 1.76187114e-05, 0.0 ]\n"
     "LEFT.K: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
     "   data: [ 458.654, 0.0, 367.215, 0.0, 457.296, 248.375, 0.0, 0.0, 1.0 ]\n",
     CameraModel::PinholeRadtan, 458.654, 1.76187114e-05},
    {"stereo.yml",
     "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\nK1: !!opencv-matrix\n   rows: 3\n   cols: 3\n   "
     "dt: d\n"
     "   data: [ 512.5, 0., 320., 0., 512.5, 240., 0., 0., 1. ]\n"
     "D1: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n   data: [ -0.1, 0.02, 0.003, 0.004, 0. ]\n",
     CameraModel::PinholeRadtan, 512.5, 0.004},
    {"intrinsics.json",
     "{\"image_size\": [1280, 720], \"camera_matrix\": {\"type_id\": \"opencv-matrix\", \"rows\": 3, "
     "\"cols\": 3, \"dt\": "
     "\"d\", \"data\": [1714.5, 0.0, 639.5, 0.0, 1715.5, 359.5, 0.0, 0.0, 1.0]}, "
     "\"distortion_coefficients\": "
     "{\"type_id\": \"opencv-matrix\", \"rows\": 1, \"cols\": 5, \"dt\": \"d\", \"data\": [-0.1, 0.2, 0.0, "
     "0.001, 0.0]}}\n",
     CameraModel::PinholeRadtan, 1714.5, 0.001},
    {"camera.txt", "RadTan 512.5 513.5 320.25 240.25 -0.1 0.02 0.003 -0.004\n640 480\ncrop\n640 480\n",
     CameraModel::PinholeRadtan, 512.5, -0.004},
    {"orb_slam2.yaml",
     "%YAML:1.0\nCamera.fx: 458.654\nCamera.fy: 457.296\nCamera.cx: 367.215\nCamera.cy: 248.375\n"
     "Camera.k1: -0.28340811\nCamera.k2: 0.07395907\nCamera.p1: 0.00019359\nCamera.p2: 1.76187114e-05\n"
     "Camera.width: 752\nCamera.height: 480\nCamera.fps: 20.0\nCamera.RGB: 1\n",
     CameraModel::PinholeRadtan, 458.654, 1.76187114e-05}};

}  // namespace

class TestLensFiles : public QObject {
  Q_OBJECT

  QTemporaryDir folder_;

  std::filesystem::path write(const char* name, const QByteArray& content) const {
    QFile file(folder_.filePath(name));
    if (!file.open(QIODevice::WriteOnly)) qFatal("%s cannot be written", name);
    file.write(content);
    return file.fileName().toStdString();
  }
  QString refusal(const char* name, const QByteArray& content) const {
    try {
      lensesIn(write(name, content));
    } catch (const CalibrationError& error) {
      return error.what();
    }
    return {};
  }

 private slots:
  void exportedLayouts_comeBack_data() {
    QTest::addColumn<QString>("target");
    QTest::addColumn<bool>("fisheye");
    QTest::addColumn<int>("cameras");
    for (const ExportTarget& target : exportTargets()) {
      const std::string name = target.name;
      // HDF5, NumPy archives and programs are not files of intrinsics.
      if (name == "m3ed" || name == "numpy" || name == "matlab" || name == "evimo2") continue;
      const bool one = name == "dm-vio";
      const bool pinhole = name == "dsec" || name == "metavision";
      if (name != "basalt" && name != "tum-vie")
        QTest::newRow((name + ", radtan").c_str()) << QString(target.name) << false << (one ? 1 : 2);
      if (!pinhole)
        QTest::newRow((name + ", equidistant").c_str()) << QString(target.name) << true << (one ? 1 : 2);
    }
  }
  void exportedLayouts_comeBack() {
    QFETCH(QString, target);
    QFETCH(bool, fisheye);
    QFETCH(int, cameras);
    RigKind kind;
    kind.fisheye = fisheye;
    kind.cameras = target == "dm-vio" ? 1 : 2;
    const NamedResult result = rig(kind);
    const QTemporaryDir folder;
    writeExportedFiles(folder.path().toStdString(),
                       exportResult(result, std::vector<std::string>{target.toStdString()}).files);
    QCOMPARE(camerasBack(result, folder.path().toStdString()), cameras);
  }

  void otherProgramsFiles_areRead_data() {
    QTest::addColumn<int>("index");
    for (std::size_t i = 0; i < std::size(kSamples); ++i)
      QTest::newRow(kSamples[i].name) << static_cast<int>(i);
  }
  void otherProgramsFiles_areRead() {
    QFETCH(int, index);
    const Sample& sample = kSamples[index];
    const std::vector<CameraIntrinsics> lenses = lensesIn(write(sample.name, sample.content));
    QCOMPARE(lenses.size(), std::size_t{1});
    QVERIFY(lenses[0].model == sample.model);
    QVERIFY(std::abs(lenses[0].focal_length_px.x() - sample.fx) < 1e-4);
    double last = 0.0;
    for (const double each : lenses[0].distortion)
      if (each != 0.0) last = each;
    QVERIFY2(std::abs(last - sample.last) < 1e-9, qPrintable(QString::number(last)));
    QVERIFY(lenses[0].resolution_px.known());
  }

  void realFiles_areRead_data() {
    QTest::addColumn<QString>("file");
    QTest::addColumn<int>("cameras");
    QTest::addColumn<double>("fx");
    QTest::newRow("basalt, double sphere") << "basalt_euroc_ds_calib.json" << 2 << 349.7560023050409;
    QTest::newRow("TUM-VIE") << "basalt_tumvie_camera-calibrationA.json" << 4 << 0.0;
    QTest::newRow("DSEC") << "dsec_zurich_city_04_a_cam_to_cam.yaml" << 4 << 553.4686750102932;
  }
  void realFiles_areRead() {
    const QString data = qEnvironmentVariable("EVICAL_DATA");
    if (data.isEmpty()) QSKIP("EVICAL_DATA is not set");
    QFETCH(QString, file);
    QFETCH(int, cameras);
    QFETCH(double, fx);
    const std::vector<CameraIntrinsics> lenses =
        lensesIn((data + "/formats/calibration/examples/" + file).toStdString());
    QCOMPARE(static_cast<int>(lenses.size()), cameras);
    if (fx > 0.0) QCOMPARE(lenses[0].focal_length_px.x(), fx);
  }

  // Files that would be misread, or that harm their reader.
  void wrongFiles_areRefused_data() {
    QTest::addColumn<QByteArray>("content");
    QTest::addColumn<QString>("says");
    const auto row = [](const char* name, const QByteArray& content, const char* says) {
      QTest::newRow(name) << content << QString(says);
    };
    const auto opencv = [](const char* dt, const char* data, const char* rest = "") {
      return QByteArray(
                 "%YAML:1.0\n---\nimage_width: 346\nimage_height: 260\nK1: !!opencv-matrix\n   rows: 3\n   "
                 "cols: 3\n") +
             "   dt: " + dt + "\n   data: [ " + data + " ]\n" + rest +
             "D1: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n   data: [ 0., 0., 0., 0., 0. ]\n";
    };
    const char* const kGood = "262.4, 0., 171.8, 0., 262.9, 131.2, 0., 0., 1.";
    row("long dt", opencv(QByteArray(1000, 'f').constData(), kGood), "dt: is not a type of single numbers");
    row("pairs", opencv("2d", kGood), "dt: is not a type of single numbers");
    row("bytes", opencv("u", kGood), "262.4, which does not fit in whole numbers of the type u");
    row("whole numbers", opencv("i", kGood), "262.4, which does not fit");
    row("beyond a byte", opencv("u", "262, 0, 171, 0, 262, 131, 0, 0, 1"), "262, which does not fit");
    row("beyond 32 bits", opencv("d", "4294967558, 0., 171.8, 0., 262.9, 131.2, 0., 0., 1."), "32 bits");
    row("transposed", opencv("d", "262.4, 0., 0., 0., 262.9, 0., 171.8, 131.2, 1."),
        "as if it were transposed");
    row("scaled", opencv("d", "524.8, 0., 343.6, 0., 525.8, 262.4, 0., 0., 2."),
        "2 as its last number instead of 1");
    row("skew", opencv("d", "262.4, 1., 171.8, 0., 262.9, 131.2, 0., 0., 1."), "has a skew");
    row("too few", opencv("d", "262.4, 0., 171.8, 0., 262.9, 131.2, 0., 0."), "has 8 numbers, 9 are needed");
    row("not finite", opencv("d", "262.4, 0., .Inf, 0., 262.9, 131.2, 0., 0., 1."), "is not a finite number");
    row("text", opencv("d", "262.4, 0., x, 0., 262.9, 131.2, 0., 0., 1."), "is not a number");
    row("twice", opencv("d", kGood, "D1: 3\n"), "D1 .line 11.: occurs twice, first in line 10");
    row("empty key", opencv("d", kGood, ": [ 1. ]\n"), "a key that is not a plain word");
    row("second camera without distortion",
        opencv("d", kGood, "K2: [ 262.4, 0, 170, 0, 262.9, 131, 0, 0, 1 ]\n"),
        "K2: has no distortion: D2 is missing");
    row("include", opencv("d", kGood, "xi1: !include other.yaml\n"), "tag !include, which is not read");
    row("deep YAML", opencv("d", kGood, ("a: " + QByteArray(100'000, '[')).constData()), "nested too deeply");
    const auto xml = [](const QByteArray& head, const QByteArray& inside) {
      return "<?xml version=\"1.0\"?>\n" + head + "<opencv_storage>\n" + inside + "</opencv_storage>\n";
    };
    const QByteArray matrix =
        "<K type_id=\"opencv-matrix\"><rows>3</rows><cols>3</cols><dt>d</dt><data>\n262.4 0. 171.8 0. 262.9 "
        "131.2 "
        "0. 0. 1.</data></K>\n";
    row("XML, twice", xml("", matrix + matrix), "K .line 5.: occurs twice, first in line 3");
    row("XML, entity of a file",
        xml("<!DOCTYPE a [<!ENTITY b SYSTEM \"file:///etc/passwd\">]>\n", "<K>&b;</K>"),
        "has a document type, which is not read");
    row("XML, unknown entity", xml("", "<K>&b;</K>"), "has the entity &b;, which is not read");
    row("XML, deep", xml("", QByteArray("<a>").repeated(100'000)), "is nested too deeply");
    const QByteArray pose = "{\"px\":0,\"py\":0,\"pz\":0,\"qx\":0,\"qy\":0,\"qz\":0,\"qw\":1}";
    const auto basalt = [&](const QByteArray& width, const QByteArray& more) {
      return "{\"value0\": {\"T_imu_cam\": [" + pose + "],\n" + more +
             "\"intrinsics\": [{\"camera_type\": \"pinhole\", \"intrinsics\": {\"fx\": 260, \"fy\": 260, "
             "\"cx\": 170, \"cy\": 130}}],\n\"resolution\": [[" +
             width + ", 260]]}}\n";
    };
    row("basalt, twice", basalt("346", "\"intrinsics\": [],\n"),
        "line 3.: intrinsics occurs twice, first in line 2");
    row("basalt, width", basalt("2147483648", ""), "must be a whole number of pixels");
    row("JSON, deep", basalt("346", "\"a\": " + QByteArray(100'000, '[')), "is nested too deeply");
    row("dv-processing, twice",
        "{\"cameras\": {\"C0\": {\"focalLength\": [260, 260],\n\"focalLength\": [99, 99],\n"
        "\"principalPoint\": [170, 130], \"distortionModel\": \"radialTangential\"}}}",
        "focalLength occurs twice, first in line 1");
    row("DSO, nine numbers",
        "RadTan 512.5 513.5 320.25 240.25 -0.1 0.02 0.003 -0.004 7\n640 480\ncrop\n640 480\n",
        "must have eight numbers");
    row("eKalibr, twice",
        "Intrinsics:\n  polymorphic_name: pinhole_brown_t2\n  ptr_wrapper:\n    data:\n      img_width: 346\n"
        "      img_height: 260\n      focal_length: [99, 99]\n      focal_length: [262, 262]\n",
        "focal_length .line 8.: occurs twice, first in line 7");
  }
  void wrongFiles_areRefused() {
    QFETCH(QByteArray, content);
    QFETCH(QString, says);
    const FileCost cost = costOf([&] { return refusal("file", content).toStdString(); });
    VERIFY_COST(cost, says);
  }

  void wholeNumbers_areRead() {
    const QByteArray file =
        "%YAML:1.0\n---\nimage_width: 346\nimage_height: 260\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   "
        "cols: 3\n"
        "   dt: i\n   data: [ 262, 0, 171, 0, 263, 131, 0, 0, 1 ]\ndistortion_coefficients: !!opencv-matrix\n"
        "   rows: 1\n   cols: 5\n   dt: f\n   data: [ 1.0000000149011612e-01, 0., 0., 0., 0. ]\n";
    const std::vector<CameraIntrinsics> lenses = lensesIn(write("whole.yml", file));
    QCOMPARE(lenses.size(), std::size_t{1});
    QCOMPARE(lenses[0].focal_length_px.y(), 263.0);
    QCOMPARE(lenses[0].distortion[0], static_cast<double>(0.1F));
  }

  void largeFiles_costLittle_data() {
    QTest::addColumn<QByteArray>("head");
    QTest::addColumn<QByteArray>("part");
    QTest::addColumn<QString>("says");
    QTest::newRow("YAML") << QByteArray("x: !!opencv-matrix\ny: [") << QByteArray("0,")
                          << "too many for a YAML file";
    QTest::newRow("JSON keys") << QByteArray("{\"value0\": {\"camera_type\": 1,") << QByteArray("\"%1\":1,")
                               << "too many keys";
    QTest::newRow("JSON lists") << QByteArray("{\"value0\": {\"camera_type\": [") << QByteArray("[],")
                                << "too many values";
    QTest::newRow("XML") << QByteArray("<opencv_storage>") << QByteArray("<a/>") << "too many elements";
  }
  void largeFiles_costLittle() {
    QFETCH(QByteArray, head);
    QFETCH(QByteArray, part);
    QFETCH(QString, says);
    constexpr int kLargest_bytes = 15'000'000;
    QByteArray content = head;
    for (int i = 0; content.size() < kLargest_bytes; ++i)
      content += QByteArray(part).replace("%1", QByteArray::number(i));
    const FileCost cost = costOf([&] { return refusal("large", content).toStdString(); });
    VERIFY_COST(cost, says);
  }

  void lensesOfOtherKinds_areNamed() {
    const QString fov =
        refusal("fov.json",
                "{\"value0\": {\"T_imu_cam\": [{\"px\":0,\"py\":0,\"pz\":0,\"qx\":0,\"qy\":0,\"qz\":0,"
                "\"qw\":1}], \"intrinsics\": [{\"camera_type\": \"fov\", \"intrinsics\": {\"fx\": 1}}],"
                " \"resolution\": [[640, 480]]}}");
    QVERIFY2(fov.contains("is 'fov'"), qPrintable(fov));
    const QString rational =
        refusal("rational.yml",
                "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\nfisheye_model: 0\ncamera_matrix: "
                "!!opencv-matrix\n   rows: 3\n"
                "   cols: 3\n   dt: d\n   data: [ 535., 0., 320., 0., 535., 240., 0., 0., 1. ]\n"
                "distortion_coefficients: !!opencv-matrix\n   rows: 8\n   cols: 1\n   dt: d\n"
                "   data: [ 0.1, 0.2, 0., 0., 0.3, 0.1, 0.2, 0.3 ]\n");
    QVERIFY2(rational.contains("rational"), qPrintable(rational));
    const QByteArray four =
        "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
        "   data: [ 535., 0., 320., 0., 535., 240., 0., 0., 1. ]\n"
        "distortion_coefficients: !!opencv-matrix\n   rows: 4\n   cols: 1\n   dt: d\n"
        "   data: [ 0.1, 0.2, 0., 0. ]\n";
    const QString either = refusal("either.yml", "%YAML:1.0\n---\n" + four);
    QVERIFY2(either.contains("fits two lens models"), qPrintable(either));
    const QString unknown = refusal("unknown.yml", "%YAML:1.0\n---\nfisheye_model: \"yes\"\n" + four);
    QVERIFY2(unknown.contains("must be 0 or 1"), qPrintable(unknown));
    const QString flat =
        refusal("flat.yml", "%YAML:1.0\n---\nfisheye_model: 1\nimage_width: 640\nimage_height: 0\n" + four);
    QVERIFY2(flat.contains("whole number of pixels"), qPrintable(flat));
    const QString config =
        refusal("vins.yaml",
                "%YAML:1.0\n---\nimu: 1\nbody_T_cam0: !!opencv-matrix\n   rows: 1\n   cols: 1\n   dt: d\n"
                "   data: [ 1. ]\n");
    QVERIFY2(config.contains("has no complete camera"), qPrintable(config));
  }
};

EVICAL_TEST(TestLensFiles)
#include "tst_lens_files.moc"
