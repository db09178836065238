// Files for users' own programs: OpenCV's FileStorage, and a function for MATLAB and Octave.
#include "core/base/atomic_file.h"
#include "tests/core/export/exported_rig.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <QProcess>
#include <QRegularExpression>
#include <QStandardPaths>
#include <QTemporaryDir>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace {

using namespace evical;
using namespace evical::test;

constexpr double kExportNumbersSame_px = 1e-9;

cv::FileStorage openCvFile(const ExportedFiles& exported, const std::string& path) {
  return {contentOf(exported, "opencv/" + path), cv::FileStorage::READ | cv::FileStorage::MEMORY};
}

cv::Mat matAt(const cv::FileStorage& file, const char* key) {
  cv::Mat read;
  file[key] >> read;
  if (read.type() != CV_64F) throw std::runtime_error(std::string(key) + " is not a matrix of doubles");
  return read;
}

Eigen::MatrixXd fromMat(const cv::Mat& m) {
  return matrix(std::vector<double>(m.begin<double>(), m.end<double>()), m.rows, m.cols);
}

std::vector<double> fxFyCxCy(const Eigen::Matrix3d& k) {
  return {k(0, 0), k(1, 1), k(0, 2), k(1, 2)};
}

// Keys of OpenCV's sample: opencv/opencv,
// samples/cpp/tutorial_code/calib3d/camera_calibration/camera_calibration.cpp.
Lens openCvLens(const cv::FileStorage& camera) {
  if (static_cast<int>(camera["image_width"]) != 346 || static_cast<int>(camera["image_height"]) != 260)
    throw std::runtime_error("size");
  const Eigen::MatrixXd d = fromMat(matAt(camera, "distortion_coefficients"));
  const std::vector<double> k = fxFyCxCy(fromMat(matAt(camera, "camera_matrix")));
  const std::vector<double> distortion(d.reshaped().begin(), d.reshaped().end());
  return static_cast<int>(camera["fisheye_model"]) != 0 ? fisheyeLens(k, distortion)
                                                        : radtanLens(k, distortion);
}

// The numbers that a line of the function assigns.
std::vector<double> assigned(const std::string& script, const QString& name) {
  const QRegularExpression line("^" + QRegularExpression::escape(name) + R"( = \[?([^\]\n]*)\]?;$)",
                                QRegularExpression::MultilineOption);
  const auto match = line.match(QString::fromStdString(script));
  if (!match.hasMatch()) throw std::runtime_error("no " + name.toStdString());
  std::vector<double> values;
  for (const QString& number : match.captured(1).split(QRegularExpression("[,;] ")))
    values.push_back(number.toDouble());
  return values;
}

// OpenCV's pixels begin at 0.
std::vector<double> fromOne(const std::vector<double>& f, const std::vector<double>& c) {
  return {f[0], f[1], c[0] - 1.0, c[1] - 1.0};
}

}  // namespace

class TestExportNumbers : public QObject {
  Q_OBJECT

 private slots:
  void openCv_reprojects_data() {
    QTest::addColumn<bool>("fisheye");
    QTest::newRow("projectPoints") << false;
    QTest::newRow("fisheye::projectPoints") << true;
  }
  void openCv_reprojects() {
    QFETCH(bool, fisheye);
    RigKind kind;
    kind.fisheye = fisheye;
    kind.third_radial = !fisheye;
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "opencv");
    for (std::size_t i = 0; i < 2; ++i) {
      const cv::FileStorage camera = openCvFile(exported, result.cameras[i].name + ".yaml");
      const Eigen::Matrix4d imu_from_camera = fromMat(matAt(camera, "reference_from_camera"));
      QVERIFY(worstDifference_px(result, i,
                                 {imu_from_camera.inverse(), static_cast<double>(camera["time_offset_s"]),
                                  openCvLens(camera)}) < kExportNumbersSame_px);
      QCOMPARE(static_cast<double>(camera["avg_reprojection_error"]), 0.125);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      const ImuState& state = result.result->state.imus[i];
      const cv::FileStorage imu = openCvFile(exported, i == 0 ? "left_imu.yaml" : "far_imu.yaml");
      const Eigen::Vector3d in_imu(0.3, -0.2, 0.5);
      const Eigen::Vector4d in_reference =
          Eigen::Matrix4d(fromMat(matAt(imu, "reference_from_imu"))) * in_imu.homogeneous();
      QVERIFY((in_reference.head<3>() - state.reference_from_imu * in_imu).norm() < 1e-12);
      QCOMPARE(static_cast<double>(imu["time_offset_s"]), state.time_offset_s);
      const auto off = [&](const char* key, const Eigen::MatrixXd& ours) {
        return (fromMat(matAt(imu, key)) - ours).norm();
      };
      QVERIFY(off("accelerometer_matrix", state.accelerometer_scale_misalignment) < 1e-12);
      QVERIFY(off("gyroscope_matrix", state.gyroscopeMatrix()) < 1e-12);
      QVERIFY(off("accelerometer_bias", state.accelerometer_bias_m_s2) < 1e-12);
      QVERIFY(off("gyroscope_bias", state.gyroscope_bias_rad_s) < 1e-12);
    }
  }

  // samples/cpp/stereo_calib.cpp at aa2dde3 writes both files with these keys, and its readers undistort with
  // them.
  void openCv_rectifiesThePair() {
    RigKind kind;
    kind.third_radial = true;
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "opencv");
    const cv::FileStorage in = openCvFile(exported, "intrinsics.yml"),
                          ex = openCvFile(exported, "extrinsics.yml");
    const cv::Vec3d point(0.2, -0.1, 1.3);  // in the left camera
    cv::Mat second_from_first;
    cv::Rodrigues(matAt(ex, "R"), second_from_first);
    std::vector<cv::Point2d> left, right, level_left, level_right;
    const std::vector<cv::Point3d> points{cv::Point3d(point)};
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), matAt(in, "M1"), matAt(in, "D1"), left);
    cv::projectPoints(points, second_from_first, matAt(ex, "T"), matAt(in, "M2"), matAt(in, "D2"), right);
    const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-14);
    cv::undistortPoints(left, level_left, matAt(in, "M1"), matAt(in, "D1"), matAt(ex, "R1"), matAt(ex, "P1"),
                        until);
    cv::undistortPoints(right, level_right, matAt(in, "M2"), matAt(in, "D2"), matAt(ex, "R2"),
                        matAt(ex, "P2"), until);
    QVERIFY(std::abs(level_left[0].y - level_right[0].y) < 1e-6);
    const double disparity_px = level_left[0].x - level_right[0].x;
    QVERIFY(disparity_px > 5.0);
    const Eigen::Vector4d seen =
        fromMat(matAt(ex, "Q")) * Eigen::Vector4d(level_left[0].x, level_left[0].y, disparity_px, 1.0);
    const Eigen::Vector3d in_left(point[0], point[1], point[2]);
    QVERIFY((seen.hnormalized() - fromMat(matAt(ex, "R1")) * in_left).norm() < 1e-6);
    // E and F as cv::stereoCalibrate's: of normalised and of undistorted pixels.
    const Eigen::Vector3d in_right = fromMat(matAt(ex, "R")) * in_left + fromMat(matAt(ex, "T"));
    QVERIFY(std::abs(in_right.dot(fromMat(matAt(ex, "E")) * in_left)) < 1e-12);
    const Eigen::Vector3d left_px = fromMat(matAt(in, "M1")) * in_left,
                          right_px = fromMat(matAt(in, "M2")) * in_right;
    QVERIFY(std::abs(right_px.dot(fromMat(matAt(ex, "F")) * left_px)) < 1e-9);
  }

  // opencv/opencv_contrib, modules/ccalib/samples/omni_calibration.cpp: xi is a matrix of one number.
  void openCv_hasOmni() {
    NamedResult result = rig({});
    CameraIntrinsics own = *result.result->state.cameras[0].lens.inUse();
    own.model = CameraModel::OmniRadtan;
    own.distortion = {1.2, -0.03, 0.01, 4e-4, -3e-4};
    ownResult(result).state.cameras[0].lens = givenLens(own);
    const cv::FileStorage camera = openCvFile(exportTo(result, "opencv"), "left.yaml");
    QCOMPARE(matAt(camera, "xi").at<double>(0, 0), 1.2);
    const Eigen::MatrixXd d = fromMat(matAt(camera, "distortion_coefficients"));
    QVERIFY(d.rows() == 4 && d(0) == -0.03 && d(3) == -3e-4);
    QCOMPARE(static_cast<int>(camera["fisheye_model"]), 0);
  }

  void openCv_ofCamerasAboveEachOther_saysThatThereIsNoPair() {
    NamedResult result = rig({});
    CalibrationState& state = ownResult(result).state;
    state.cameras[1].reference_from_camera.translation_m =
        state.cameras[0].reference_from_camera * Eigen::Vector3d(0.0, 0.1, 0.0);
    const ExportedFiles exported = exportTo(result, "opencv");
    QVERIFY_THROWS_EXCEPTION(std::runtime_error, contentOf(exported, "opencv/extrinsics.yml"));
    QVERIFY(hasNote(exported, "left and right are not side by side"));
  }

  // MathWorks' stereoParametersFromOpenCV (2021-2024): principal points + 1, the rotation transposed, the
  // translation unchanged; its cameraParameters takes the transposed matrix, [k1 k2 k3] and [p1 p2].
  void matlab_reprojects() {
    RigKind kind;
    kind.third_radial = true;
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "matlab");
    const std::string script = contentOf(exported, "matlab/evical_rig.m");
    std::vector<Lens> lenses;
    for (int i = 0; i < 2; ++i) {
      const auto of = [&](const char* field) {
        return assigned(script, QString("rig.cameras(%1).%2").arg(i + 1).arg(field));
      };
      const auto radial = of("RadialDistortion"), tangential = of("TangentialDistortion");
      QCOMPARE(of("ImageSize"), (std::vector<double>{260, 346}));
      lenses.push_back(
          radtanLens(fromOne(of("FocalLength"), of("PrincipalPoint")),
                     {radial.at(0), radial.at(1), tangential.at(0), tangential.at(1), radial.at(2)}));
      const Eigen::Matrix4d imu_from_camera = matrix(of("ReferenceFromCamera"), 4, 4);
      QVERIFY(worstDifference_px(result, static_cast<std::size_t>(i),
                                 {imu_from_camera.inverse(), of("TimeOffset").at(0), lenses.back()}) <
              kExportNumbersSame_px);
    }
    const Eigen::Matrix3d rotation = matrix(assigned(script, "rig.stereo.RotationOfCamera2"), 3, 3);
    const Eigen::RowVector3d translation = matrix(assigned(script, "rig.stereo.TranslationOfCamera2"), 1, 3);
    QCOMPARE(assigned(script, "rig.stereo.Cameras"), (std::vector<double>{1, 2}));
    Eigen::Matrix4d second_from_first = Eigen::Matrix4d::Identity();
    second_from_first.block(0, 0, 3, 3) = rotation.transpose();  // p_2 = p_1 R + t, in rows
    second_from_first.block(0, 3, 3, 1) = translation.transpose();
    const Eigen::Matrix4d imu_from_first =
        matrix(assigned(script, "rig.cameras(1).ReferenceFromCamera"), 4, 4);
    const double offset_s = result.result->state.cameras[1].time_offset_s;
    QVERIFY(
        worstDifference_px(result, 1, {second_from_first * imu_from_first.inverse(), offset_s, lenses[1]}) <
        kExportNumbersSame_px);
    QCOMPARE(matrix(assigned(script, "rig.imus(2).GyroscopeMatrix"), 3, 3)(1, 1),
             result.result->state.imus[1].gyroscopeMatrix()(1, 1));
  }

  void matlab_ofAFisheye_hasNumbersAndSaysSo() {
    RigKind kind;
    kind.fisheye = true;
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "matlab");
    const std::string script = contentOf(exported, "matlab/evical_rig.m");
    QVERIFY(hasNote(exported, "do not support equidistant distortion"));
    const Eigen::Matrix4d imu_from_camera =
        matrix(assigned(script, "rig.cameras(1).ReferenceFromCamera"), 4, 4);
    const Lens lens = fisheyeLens(fromOne(assigned(script, "rig.cameras(1).FocalLength"),
                                          assigned(script, "rig.cameras(1).PrincipalPoint")),
                                  assigned(script, "rig.cameras(1).DistortionCoefficients"));
    QVERIFY(worstDifference_px(
                result, 0, {imu_from_camera.inverse(), result.result->state.cameras[0].time_offset_s, lens}) <
            kExportNumbersSame_px);
  }

  // The toolbox is missing: functions with its names accept the same arguments and return them.
  void matlab_runsInOctave_data() {
    QTest::addColumn<bool>("toolbox");
    QTest::newRow("without the toolbox") << false;
    QTest::newRow("with its functions' names") << true;
  }
  void matlab_runsInOctave() {
    QFETCH(bool, toolbox);
    const QString octave = QStandardPaths::findExecutable("octave-cli");
    if (octave.isEmpty()) QSKIP("octave-cli is not installed");
    RigKind kind;
    kind.cameras = 3;
    const ExportedFiles exported = exportTo(rig(kind), "matlab");
    QTemporaryDir scratch;
    const std::filesystem::path folder = scratch.path().toStdString();
    writeExportedFiles(folder, exported.files);
    if (toolbox) {
      writeFileWhole(
          folder / "matlab/cameraIntrinsics.m",
          "function c = cameraIntrinsics(f, p, size, varargin)\nc = struct(varargin{:}, 'F', f);\nend\n");
      writeFileWhole(folder / "matlab/cameraParameters.m",
                     "function c = cameraParameters(varargin)\nc = struct(varargin{:});\nend\n");
      writeFileWhole(
          folder / "matlab/stereoParameters.m",
          "function s = stereoParameters(a, b, R, t)\ns = struct('K', b.IntrinsicMatrix, 'R', R);\nend\n");
    }
    QProcess run;
    run.setWorkingDirectory(scratch.path() + "/matlab");
    const QString pair = toolbox ? "r.stereo.Parameters.K(3, 1), r.stereo.Parameters.R(1, 2)"
                                 : "r.cameras(2).PrincipalPoint(1), r.stereo.RotationOfCamera2(1, 2)";
    run.start(octave, {"--no-init-file", "--quiet", "--eval",
                       "r = evical_rig(); printf('%d %d %.17g %.17g', numel(r.cameras), numel(r.imus), " +
                           pair + ");"});
    QVERIFY(run.waitForFinished(60000));
    const QStringList printed = QString(run.readAllStandardOutput()).split(' ');
    QVERIFY2(printed.size() == 4, run.readAllStandardError().constData());
    const std::string script = contentOf(exported, "matlab/evical_rig.m");
    QCOMPARE(printed[0], QString("3"));
    QCOMPARE(printed[1], QString("2"));
    QCOMPARE(printed[2].toDouble(), assigned(script, "rig.cameras(2).PrincipalPoint")[0]);
    QCOMPARE(printed[3].toDouble(), assigned(script, "rig.stereo.RotationOfCamera2")[1]);
  }
};

EVICAL_TEST(TestExportNumbers)
#include "tst_export_numbers.moc"
