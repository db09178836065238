// Exported files, read from disk like in each target's program: they differ from the result by rounding only,
// and content that the program would reject is found and named.
#include "core/base/error.h"
#include "core/export/read_back.h"
#include "tests/core/export/exported_rig.h"
#include "tests/support/german_locale.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"

#include <QFile>
#include <QTemporaryDir>

#include <algorithm>
#include <cstdlib>

using namespace evical;
using namespace evical::test;

namespace {

constexpr double kExportReadBackSame_px = 1e-9, kSame_deg = 1e-11, kSame_mm = 1e-11,
                 kExportReadBackSame = 1e-12;

// The target's files below the folder; none if the target cannot represent the result.
bool exportInto(const QTemporaryDir& folder, const NamedResult& result, const std::string& target) {
  try {
    writeExportedFiles(folder.path().toStdString(),
                       exportResult(result, std::vector<std::string>{target}).files);
    return true;
  } catch (const CalibrationError&) {
    return false;
  }
}

// Without the exporter's check that a file is on disk.
void overwrite(const QTemporaryDir& folder, const FileContent& file) {
  QFile written(folder.filePath(QString::fromStdString(file.path.string())));
  QVERIFY(written.open(QIODevice::WriteOnly));
  written.write(file.content.data(), static_cast<qint64>(file.content.size()));
}

void setWideLenses(NamedResult& result, CameraModel model) {
  CameraIntrinsics lens{model, {346, 260}, {102.5, 101.25}, {171.25, 131.125}, {-0.17, 0.593, 0.0, 0.0, 0.0}};
  if (model == CameraModel::Eucm) lens.distortion = {0.63, 1.04, 0.0, 0.0, 0.0};
  if (model == CameraModel::OmniRadtan) {
    lens.focal_length_px *= 2.5;
    lens.distortion = {1.2, -0.03, 0.01, 4e-4, -3e-4};
  }
  for (CameraState& camera : ownResult(result).state.cameras) camera.lens = givenLens(lens);
}

void replaceIn(const QString& path, const QByteArray& before, const QByteArray& after) {
  QFile file(path);
  QVERIFY2(file.open(QIODevice::ReadOnly), qPrintable(path));
  QByteArray text = file.readAll();
  file.close();
  const qsizetype at = text.indexOf(before);
  QVERIFY2(at >= 0, qPrintable(path + " lacks " + before));
  text.replace(at, before.size(), after);
  QVERIFY(file.open(QIODevice::WriteOnly));
  file.write(text);
}

}  // namespace

class TestExportReadBack : public QObject {
  Q_OBJECT

 private slots:
  void everyTarget_readsBack_whereNumbersHaveCommas() {
    const NamedResult result = rig({});
    const GermanLocale german;
    if (!german.isInstalled())
      QSKIP("localedef cannot create the locale de_DE: the package locales is missing");
    for (const ExportTarget& target : exportTargets()) {
      const QTemporaryDir folder;
      if (!exportInto(folder, result, target.name)) continue;
      const ExportCheck check = checkExport(result, target, folder.path().toStdString());
      QVERIFY2(check.same, check.text.c_str());
    }
  }

  void everyTarget_readsBack_data() {
    QTest::addColumn<QString>("target");
    QTest::addColumn<bool>("fisheye");
    QTest::addColumn<bool>("third_radial");
    QTest::addColumn<bool>("mapped");
    QTest::addColumn<bool>("inertial");
    QTest::addColumn<int>("cameras");
    QTest::addColumn<int>("model");  // CameraModel; -1: the rig's own
    const auto row = [](const char* target, const char* what, const RigKind& kind, int model = -1) {
      QTest::addRow("%s, %s", target, what) << target << kind.fisheye << kind.third_radial << kind.mapped
                                            << kind.inertial << kind.cameras << model;
    };
    for (const ExportTarget& target : exportTargets()) {
      row(target.name, "radtan", {});
      row(target.name, "radtan with k3", {false, true, true, true, 2});
      row(target.name, "equidistant", {true, false, true, true, 2});
      row(target.name, "ideal IMUs", {false, false, false, true, 2});
      row(target.name, "one camera", {false, false, true, true, 1});
      row(target.name, "three cameras", {false, false, true, true, 3});
      row(target.name, "cameras only", {false, false, true, false, 2});
      row(target.name, "one camera only", {false, false, true, false, 1});
      row(target.name, "double sphere", {}, static_cast<int>(CameraModel::DoubleSphere));
      row(target.name, "EUCM", {}, static_cast<int>(CameraModel::Eucm));
      row(target.name, "omni", {}, static_cast<int>(CameraModel::OmniRadtan));
    }
  }
  void everyTarget_readsBack() {
    QFETCH(QString, target);
    QFETCH(bool, fisheye);
    QFETCH(bool, third_radial);
    QFETCH(bool, mapped);
    QFETCH(bool, inertial);
    QFETCH(int, cameras);
    QFETCH(int, model);
    NamedResult result = rig({fisheye, third_radial, mapped, inertial, cameras});
    if (model >= 0) setWideLenses(result, static_cast<CameraModel>(model));
    const ExportTarget& row = exportTarget(target.toStdString(), "test");
    QTemporaryDir folder;
    if (!exportInto(folder, result, row.name)) {
      // A target may refuse wide lenses, and rigs without an IMU or a second camera that it requires.
      QVERIFY(model >= 0 || !inertial || cameras == 1);
      return;
    }
    const ReadBack read = row.read((folder.path() + "/" + target).toStdString());
    const ReadBackDifference difference = differenceOf(result, read);
    QVERIFY2(difference.problems.empty(), difference.problems.empty() ? "" : difference.problems[0].c_str());
    QCOMPARE(difference.cameras, std::min(result.cameras.size(), read.max_cameras));
    QVERIFY(difference.imus <= std::min(result.imus.size(), read.max_imus));
    QVERIFY(difference.lens_px || difference.refitted_px);
    // Only the rounding of the files.
    double rounding = 0.0, step_s = 0.0;
    for (const ReadFile& file : read.files) {
      rounding = std::max(rounding, file.rounding);
      step_s = std::max(step_s, file.time_step_s);
    }
    const bool exact = rounding <= kExportReadBackSame;
    QVERIFY(difference.lens_px.value_or(0.0) < (exact ? kExportReadBackSame_px : 1e-3));
    QVERIFY(difference.refitted_px.value_or(0.0) < 2.0);
    QVERIFY(difference.rotation_deg.value_or(0.0) < (exact ? kSame_deg : 1e-4));
    QVERIFY(difference.translation_mm.value_or(0.0) < (exact ? kSame_mm : 1e-3));
    QVERIFY(difference.time_ms.value_or(0.0) <= 500.0 * step_s + kExportReadBackSame);
    QVERIFY(difference.numbers.value_or(0.0) < (exact ? kExportReadBackSame : 1e-6));
    const ExportCheck check = checkExport(result, row, folder.path().toStdString());
    QVERIFY2(check.same, check.text.c_str());
    QVERIFY(QString::fromStdString(check.text).startsWith(target + ": reads back: "));
  }

  // Each quantity of a result is in the files of every target that supports it: a modified result must not
  // read back as equal.
  void anotherResult_isFound_data() {
    QTest::addColumn<QString>("target");
    for (const ExportTarget& target : exportTargets()) QTest::newRow(target.name) << target.name;
  }
  void anotherResult_isFound() {
    QFETCH(QString, target);
    const NamedResult result = rig({});
    const ExportTarget& row = exportTarget(target.toStdString(), "test");
    QTemporaryDir folder;
    QVERIFY(exportInto(folder, result, row.name));
    const std::filesystem::path path = folder.path().toStdString();
    const ReadBack read = row.read(path / row.name);
    const ReadBackDifference same = differenceOf(result, read);
    const std::size_t last = std::min(result.cameras.size(), read.max_cameras) - 1;
    const auto found = [&](auto&& change) {
      NamedResult other = result;
      change(ownResult(other).state);
      // In the numbers: the comments alone may state others, too.
      return !differenceOf(other, read).problems.empty() && !checkExport(other, row, path).same;
    };
    const auto lens = [](CalibrationState& state) {
      CameraIntrinsics own = *state.cameras[0].lens.inUse();
      own.focal_length_px.x() += 0.1;
      state.cameras[0].lens = givenLens(own);
    };
    // 0.1 px of focal length is less than the error of some lenses' refits.
    QVERIFY(found(lens) || !same.lens_px);
    QCOMPARE(found([&](CalibrationState& state) {
               state.cameras[last].reference_from_camera.translation_m.y() += 1e-5;
             }),
             same.translation_mm.has_value());
    QCOMPARE(found([](CalibrationState& state) { state.cameras[0].time_offset_s += 1e-5; }),
             same.time_ms.has_value());
  }

  // Programs that use one value for both cameras: the rig is refused or refitted, so that the written values
  // read back.
  void unlikeCameras_readBackOrAreRefused_data() { anotherResult_isFound_data(); }
  void unlikeCameras_readBackOrAreRefused() {
    QFETCH(QString, target);
    const ExportTarget& row = exportTarget(target.toStdString(), "test");
    for (const bool other_size : {false, true}) {
      NamedResult result = rig({});
      CameraIntrinsics right = *result.result->state.cameras[1].lens.inUse();
      if (other_size) {
        right.resolution_px = {640, 480};
        right.principal_point_px *= 1.85;
        right.focal_length_px *= 1.85;
      } else {
        right.model = CameraModel::PinholeEquidistant;
        right.distortion = {-0.03, 0.011, -0.004, 0.0007, 0.0};
      }
      ownResult(result).state.cameras[1].lens = givenLens(right);
      QTemporaryDir folder;
      if (!exportInto(folder, result, row.name)) {
        QVERIFY(other_size && (target.startsWith("esvo") || target == "orb-slam3"));
        continue;
      }
      const ExportCheck check = checkExport(result, row, folder.path().toStdString());
      QVERIFY2(check.same, check.text.c_str());
    }
  }

  void damage_isFoundAndNamed_data() {
    QTest::addColumn<QString>("target");
    QTest::addColumn<QString>("file");
    QTest::addColumn<QByteArray>("before");
    QTest::addColumn<QByteArray>("after");
    QTest::addColumn<QString>("said");
    const auto row = [](const char* target, const char* file, const char* before, const char* after,
                        const char* said) {
      QTest::addRow("%s/%s: %s", target, file, said)
          << target << file << QByteArray(before) << QByteArray(after) << said;
    };
    row("kalibr", "camchain-imucam.yaml", "timeshift_cam_imu: 0.007301", "timeshift_cam_imu: 7.301e-03x",
        "cam0.timeshift_cam_imu");
    row("kalibr", "camchain-imucam.yaml", "timeshift_cam_imu: 0.007301", "timeshift_cam_imu: 0.0073",
        "left: the time offset differs by 0.001 ms");
    row("kalibr", "camchain.yaml", "camera_model", "model", "cam0.camera_model");
    row("kalibr", "imu.yaml", "update_rate: 997.5", "", "imu0.update_rate");
    row("kalibr", "input-left_imu.yaml", "update_rate: 997.5", "update_rate: 99e1", "update_rate");
    row("openvins", "kalibr_imucam_chain.yaml", "T_cam_imu:", "T_camera:", "cam0.T_cam_imu");
    row("openvins", "kalibr_imucam_chain.yaml", "timeshift_cam_imu: 0.", "timeshift: 0.",
        "left: the time offset differs by 7.3 ms");  // the program uses 0 then
    row("openvins", "kalibr_imu_chain.yaml", "model: rpng", "model: kalibr",
        "the accelerometer's scales and misalignment differ");
    row("vins-fusion", "vins.yaml", "max_cnt: 150", "", "max_cnt");
    row("vins-fusion", "vins.yaml", "td: 0.007301", "td: -0.007301",
        "left: the time offset differs by 14.6 ms");
    row("vins-fusion", "right.yaml", "fx: ", "f: ", "projection_parameters.fx");
    row("orb-slam3", "settings.yaml", "Camera.fps: 20", "Camera.fps: 20.0", "Camera.fps");
    row("orb-slam3", "settings.yaml", "dt: f", "dt: d", "Stereo.T_c1_c2: must have dt f");
    row("orb-slam3", "settings.yaml", "Viewer.ViewpointF", "Viewer.F", "Viewer.ViewpointF");
    row("basalt", "calibration.json", "\"qw\"", "\"w\"", "value0.T_imu_cam[0].qw");
    row("basalt", "calibration.json", "7301000", "7301000.0", "value0.cam_time_offset_ns");
    row("basalt", "calibration.json", "kb4", "kb8", "value0.intrinsics[0].camera_type");
    row("svo", "calib.yaml", "imu_params:", "imu:", "imu_params");
    row("svo", "calib.yaml", "delay_imu_cam: -0.007301", "delay_imu_cam: 0.007301",
        "left: the time offset differs by 14.6 ms");
    row("ultimate-slam", "calib.yaml", "label: dvs", "label: left", "cameras[0].camera.label");
    row("ultimate-slam", "imu.flags", "--acc_noise_density", "--acc_noise", "--acc_noise is not a flag");
    row("esvo", "left.yaml", "T_right_left:", "T_left_right:", "T_right_left");
    row("esvo", "right.yaml", "distortion_coefficients", "coefficients", "distortion_coefficients");
    row("esvo", "right.yaml", "projection_matrix:\n  rows: 3\n  cols: 4\n  data: [2",
        "projection_matrix:\n  data: [3", "rectification_matrix");
    row("esvo2", "right.yaml", "T_b_c:", "T_c_b:", "T_b_c");
    row("esvo2", "left.yaml", "T_b_c:", "T_c_b:", "T_b_c");
    // An earlier version of Evical wrote this: "No such node (patternType)".
    row("dv-processing", "calibration.json", "\"position\"",
        "\"metadata\": {\"comment\": \"\"}, \"position\"", "cameras.C0.metadata.patternType");
    row("dv-processing", "calibration.json", "\"S0\": {\n      \"name\": \"left\"",
        "\"S0\": {\n      \"name\": \"left_imu\"", "imus.S0.name");
    row("dv-processing", "calibration.json", "\"7301\"", "\"7301.0\"", "imus.S0.timeOffsetMicros");
    row("metavision", "left/intrinsics.json", "\"camera_matrix\"", "\"K\"", "camera_matrix");
    row("metavision", "right/intrinsics.json", "\"dt\": \"d\"", "\"dt\": \"f\"", "must have dt d");
    row("ekalibr", "ekalibr_param.yaml", "focal_length_note", "note", "data.focal_length_note");
    row("ekalibr", "ekalibr_param.yaml", "key: /right/events", "key: /left/events", "occurs twice");
    row("ekalibr", "intrinsics-left.yaml", "pinhole_brown_t2", "pinhole_brown", "Intrinsics.polymorphic_id");
    row("ros", "left.yaml", "cols: 5", "cols: 4", "distortion_coefficients");
    row("ros", "left.yaml", "image_width: 346", "image_width: 347", "the resolution is 347 x 260");
    row("ros", "right.yaml", "camera_name: right", "camera_name: rigth", "no file has the camera right");
    row("ros", "static_transforms.sh", "--qx ", "--rx ", "'--rx' is not an option");
    row("ros", "static_transforms.launch", "static_transform_2", "static_transform_1",
        "a name that occurs twice");
    row("ros", "static_transforms.launch", " left_imu left_optical_frame", " left_imu", "have nine args");
    row("ros", "static_transforms.launch.py", "'--qw', ", "", "is not an option of");
    row("ros", "rig.urdf", "</robot>", "", "is not XML");
    row("ros", "rig.urdf", "link=\"left_imu\"", "link=\"imu\"", "there is no link imu");
    row("dsec", "cam_to_cam.yaml", "R_rect3:", "R_3:", "extrinsics.R_rect3");
    row("dsec", "cam_to_cam.yaml", "T_32:", "T_31:", "extrinsics.T_32");
    row("dsec", "cam_to_cam.yaml", "camera_type: event", "camera_type: frame", "cam0.camera_type");
    row("dsec", "cam_to_cam.yaml", "- [0.0, 1.0, 0.0, -", "- [0.0, 1.0, 0.0, ",
        "cams_03 (line");  // the principal point's sign
    row("dsec", "cam_to_cam.yaml", "resolution: [346, 260]", "resolution: [346, 260.0]", "cam0.resolution");
    row("m3ed", "calibration.h5", "radtan", "radtam",
        "/prophesee/left/calib/distortion_model: must be radtan");
    row("m3ed", "calibration.h5", "SNOD", "SNOT", "/prophesee/left/calib");
    row("evimo2", "left/params.txt", "res_x: 260", "res_x: 346", "the resolution is 346 x 346");
    row("evimo2", "left/params.txt", "radtan", "none", "dist_model must be radtan or equidistant");
    row("evimo2", "right/extrinsics.txt", "0.0021", "-0.0021", "right: the time offset differs by 4.2 ms");
    row("evimo2", "right/extrinsics.txt", "\n0.0\n", "\n", "must have lines of 6, 7, 1 and 1 numbers");
    row("tum-vie", "camera-calibrationA.json", "kb4", "ds", "value0.intrinsics[0].intrinsics.xi");
    row("tum-vie", "camera-calibrationA.json", "[\"left\", \"right\", \"left\", \"right\"]",
        "[\"right\", \"right\", \"left\", \"right\"]", "right: the pose differs");
    row("numpy", "calibration.npz", "<f8", "<f4", "its checksum is wrong");
    row("numpy", "calibration.npz", "PK\x05\x06", "PK\x05\x05", "is not an .npz file, or is cut off");
  }
  void damageOfNewerTargets_isFoundAndNamed_data() {
    QTest::addColumn<QString>("target");
    QTest::addColumn<QString>("file");
    QTest::addColumn<QByteArray>("before");
    QTest::addColumn<QByteArray>("after");
    QTest::addColumn<QString>("said");
    const auto row = [](const char* target, const char* file, const char* before, const char* after,
                        const char* said) {
      QTest::addRow("%s/%s: %s", target, file, said)
          << target << file << QByteArray(before) << QByteArray(after) << said;
    };
    row("kimera", "LeftCameraParams.yaml", "rate_hz: 20", "rate_hz: 20.0", "rate_hz: is not a whole number");
    row("kimera", "LeftCameraParams.yaml", "T_BS:", "T_SB:", "T_BS");
    row("kimera", "RightCameraParams.yaml", "camera_model: pinhole", "", "camera_model");
    row("kimera", "RightCameraParams.yaml", "resolution: [346", "resolution: [345",
        "the resolution is 345 x 260");
    row("kimera", "ImuParams.yaml", "data: [1.0", "data: [0.9", "T_BS.data");
    row("kimera", "ImuParams.yaml", "n_gravity: [0.0, ", "n_gravity: [", "n_gravity: has 2 numbers");
    row("kimera", "ImuParams.yaml", "imu_time_shift: 0.007301", "imu_time_shift: -0.007301",
        "left: the time offset differs by 14.6 ms");
    row("kimera", "ImuParams.yaml", "gyroscope_random_walk: 2", "gyroscope_random_walk: 3", "gyroscope");
    row("kimera", "PipelineParams.yaml", "frontend_type: 1", "frontend: 1", "frontend_type");
    row("dm-vio", "camera.txt", "RadTan ", "", "is not supported");
    row("dm-vio", "camera.txt", "RadTan ", "EquiDistant ", "left: the lens differs");
    row("dm-vio", "camera.txt", "346 260", "346 261", "the resolution is 346 x 261");
    row("dm-vio", "camera.txt", "\n336 256", "\n335 256", "fewer than three pyramid levels");
    row("dm-vio", "camera.txt", " 0.0\n336", "\n336", "camera.txt (line 3): must have 5 numbers");
    row("dm-vio", "camchain.yaml", "cam0:", "cam1:", "cam0");
    row("dm-vio", "camchain.yaml", "- [0.0, 0.0, 0.0, 1.0]", "", "has 3 rows");
    row("dm-vio", "noise.yaml", "gyroscope_noise_density: 0.00015", "gyroscope_noise_density: 0.00016",
        "gyroscope");
    row("rtabmap", "left.yaml", "camera_name: left", "camera_name: lefty", "differs from its camera_name");
    row("rtabmap", "right.yaml", "cols: 5", "cols: 4", "distortion_coefficients");
    row("rtabmap", "right.yaml", "local_transform:", "transform:", "local_transform");
    row("rtabmap", "imu_local_transform.txt", "far_imu: ", "far_imu: 1 ", "12 numbers");
    row("rtabmap", "stereo/stereo_left.yaml", "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [2",
        "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [3", "a lens that no camera's own file has");
    row("rtabmap", "stereo/stereo_pose.yaml", "essential_matrix", "essential", "essential_matrix");
    row("rtabmap", "stereo/stereo_pose.yaml", "translation_matrix:\n   rows: 3\n   cols: 1\n   data: [-0.1",
        "translation_matrix:\n   rows: 3\n   cols: 1\n   data: [-0.2",
        "is inconsistent with the cameras' R and P");
    row("opencv", "left.yaml", "fisheye_model: 0", "fisheye_model: 1", "fisheye_model");
    row("opencv", "left.yaml", "dt: d", "dt: f", "camera_matrix: must have dt d");
    row("matlab", "evical_rig.m", "rig.stereo.TranslationOfCamera2 = [",
        "rig.stereo.TranslationOfCamera2 = [0, ", "does not have 3 columns");
    row("opencv", "right.yaml", "image_width: 346", "image_width: 346.0",
        "image_width: is not a whole number");
    row("opencv", "far_imu.yaml", "time_offset_s: 0.000731", "time_offset_s: 0.000732",
        "far_imu: the time offset differs by 0.001 ms");
    row("opencv", "intrinsics.yml", "M2:", "K2:", "M2");
    row("opencv", "extrinsics.yml", "T: !!opencv-matrix\n   rows: 3", "T: !!opencv-matrix\n   rows: 1", "T");
    row("matlab", "evical_rig.m", "PrincipalPoint = [172.25", "PrincipalPoint = [171.25",
        "left: the lens differs by up to 1 px");
    row("matlab", "evical_rig.m", "rig.cameras(2).Name", "rig.cameras(3).Name", "names a missing camera");
    row("matlab", "evical_rig.m", "'RadialTangential'", "'Brown'", "is not a known model");
    row("matlab", "evical_rig.m", "rig.stereo.RotationOfCamera2 = [0", "rig.stereo.RotationOfCamera2 = [1",
        "is not a rotation");
  }
  void damageOfNewerTargets_isFoundAndNamed() { damage_isFoundAndNamed(); }
  // Layouts of data sets store cameras in separate places.
  void eventsAndFrames_readBack_data() {
    QTest::addColumn<QString>("target");
    for (const char* const target : {"dsec", "m3ed", "evimo2", "tum-vie", "numpy"})
      QTest::newRow(target) << target;
  }
  void eventsAndFrames_readBack() {
    QFETCH(QString, target);
    RigKind kind;
    kind.frames = 2;
    kind.fisheye = target == "tum-vie";
    NamedResult result = rig(kind);
    std::swap(result.cameras[0], result.cameras[3]);
    CalibrationState& state = ownResult(result).state;
    std::swap(state.cameras[0], state.cameras[3]);
    QTemporaryDir folder;
    const ExportTarget& row = exportTarget(target.toStdString(), "test");
    QVERIFY(exportInto(folder, result, row.name));
    const ReadBackDifference difference =
        differenceOf(result, row.read((folder.path() + "/" + target).toStdString()));
    QVERIFY2(difference.problems.empty(), difference.problems.empty() ? "" : difference.problems[0].c_str());
    QCOMPARE(difference.cameras, 4U);
    QVERIFY(difference.lens_px.value_or(1.0) < kExportReadBackSame_px &&
            difference.rotation_deg.value_or(1.0) < kSame_deg);
  }

  void damage_isFoundAndNamed() {
    QFETCH(QString, target);
    QFETCH(QString, file);
    QFETCH(QByteArray, before);
    QFETCH(QByteArray, after);
    QFETCH(QString, said);
    const NamedResult result = rig({});
    const ExportTarget& row = exportTarget(target.toStdString(), "test");
    QTemporaryDir folder;
    QVERIFY(exportInto(folder, result, row.name));
    replaceIn(folder.filePath(target + "/" + file), before, after);
    const ExportCheck check = checkExport(result, row, folder.path().toStdString());
    QVERIFY2(!check.same, check.text.c_str());
    const QString text = QString::fromStdString(check.text);
    QVERIFY2(text.startsWith(target + ": does not read back: ") && text.contains(said), qPrintable(text));
  }

  // A missing or truncated file is reported, and nothing is read past its end.
  void missingAndCutFiles_areFound_data() { anotherResult_isFound_data(); }
  void missingAndCutFiles_areFound() {
    QFETCH(QString, target);
    const NamedResult result = rig({});
    const ExportTarget& row = exportTarget(target.toStdString(), "test");
    QTemporaryDir folder;
    QVERIFY(exportInto(folder, result, row.name));
    for (const FileContent& file : exportResult(result, std::vector<std::string>{row.name}).files) {
      if (file.path.filename() == "README.txt") continue;
      const QString path = folder.filePath(QString::fromStdString(file.path.string()));
      for (const double share : {-1.0, 0.0, 0.3, 0.6}) {
        if (share < 0.0)
          QVERIFY(QFile::remove(path));
        else
          QVERIFY(QFile::resize(path, static_cast<qint64>(share * static_cast<double>(file.content.size()))));
        const ExportCheck check = checkExport(result, row, folder.path().toStdString());
        QVERIFY2(!check.same, qPrintable(path + " " + QString::number(share)));
        overwrite(folder, file);
      }
    }
    QVERIFY(checkExport(result, row, folder.path().toStdString()).same);
  }

  // Any changed byte is reported or harmless: only CalibrationError is thrown, and memory stays valid.
  void spoiltFiles_endNothing_data() { anotherResult_isFound_data(); }
  void spoiltFiles_endNothing() {
    QFETCH(QString, target);
    const NamedResult result = rig({true, false, true, true, 2});
    const ExportTarget& row = exportTarget(target.toStdString(), "test");
    QTemporaryDir folder;
    QVERIFY(exportInto(folder, result, row.name));
    const std::filesystem::path path = folder.path().toStdString();
    std::srand(11);
    int found = 0;
    constexpr int kTimes = 60;
    const auto files = exportResult(result, std::vector<std::string>{row.name}).files;
    for (int i = 0; i < kTimes; ++i) {
      const FileContent& file = files.at(static_cast<std::size_t>(std::rand()) % files.size());
      FileContent spoilt = file;
      // After the comments at the top.
      const std::size_t at =
          file.content.size() / 4 + static_cast<std::size_t>(std::rand()) % (3 * file.content.size() / 4);
      spoilt.content[at] = "\0x-9.:[]{}\"\n #"[std::rand() % 14];
      overwrite(folder, spoilt);
      found += checkExport(result, row, path).same ? 0 : 1;
      overwrite(folder, file);
    }
    // README.txt is not read, and HDF5 pads its files.
    QVERIFY(found > kTimes / (target == "m3ed" ? 20 : 6) && checkExport(result, row, path).same);
  }
};

EVICAL_TEST(TestExportReadBack)
#include "tst_export_read_back.moc"
