// Files for programs about cameras and frames, read back with each program's own convention.
#include "core/base/error.h"
#include "core/export/distortion_fit.h"
#include "tests/core/export/exported_rig.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <QRegularExpression>
#include <QTemporaryDir>
#include <QXmlStreamReader>
#include <opencv2/core.hpp>

#include <filesystem>

using namespace evical;
using namespace evical::test;

namespace {

constexpr double kExportCamerasSame_px = 1e-9;

std::vector<double> fromMatrix(const std::vector<double>& k) {
  return {k[0], k[4], k[2], k[5]};
}

Lens rosLens(const YAML::Node& camera) {
  const auto k = fromMatrix(numbers(camera["camera_matrix"]["data"]));
  const auto distortion = numbers(camera["distortion_coefficients"]["data"]);
  return camera["distortion_model"].as<std::string>() == "plumb_bob" ? radtanLens(k, distortion)
                                                                     : fisheyeLens(k, distortion);
}

// args of the nodes of a ROS 1 launch file, which is XML and names each node once.
QStringList ros1Arguments(const std::string& launch) {
  QXmlStreamReader xml(QByteArray::fromStdString(launch));
  QStringList arguments, names;
  while (!xml.atEnd()) {
    if (xml.readNext() != QXmlStreamReader::StartElement || xml.name() != QString("node")) continue;
    const auto attributes = xml.attributes();
    if (attributes.value("pkg") != QString("tf2_ros") ||
        attributes.value("type") != QString("static_transform_publisher") ||
        names.contains(attributes.value("name").toString()))
      return {};
    names << attributes.value("name").toString();
    arguments << attributes.value("args").toString();
  }
  return xml.hasError() ? QStringList() : arguments;
}

Eigen::Matrix4d poseOfExportCameras(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation) {
  Eigen::Isometry3d full = Eigen::Isometry3d::Identity();
  full.linear() = rotation.toRotationMatrix();
  full.translation() = translation;
  return full.matrix();
}

}  // namespace

class TestExportCameras : public QObject {
  Q_OBJECT

 private slots:
  void ros_reprojects_data() {
    QTest::addColumn<bool>("fisheye");
    QTest::newRow("plumb_bob") << false;
    QTest::newRow("equidistant") << true;
  }
  void ros_reprojects() {
    QFETCH(bool, fisheye);
    RigKind kind;
    kind.fisheye = fisheye;
    kind.third_radial = !fisheye;
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "ros");
    const Lens lens = rosLens(yamlOf(exported, "ros/left.yaml"));
    const double offset_s = result.result->state.cameras[0].time_offset_s;  // stated in a comment
    const QString script = QString::fromStdString(contentOf(exported, "ros/static_transforms.sh"));
    QVERIFY(script.contains("left 0.007301 s"));
    const auto tf = QRegularExpression(
                        "--x (\\S+) --y (\\S+) --z (\\S+) --qx (\\S+) --qy (\\S+) --qz (\\S+) --qw (\\S+) "
                        "--frame-id left_imu --child-frame-id left_optical_frame")
                        .match(script);
    QVERIFY(tf.hasMatch());
    const auto number = [](const QRegularExpressionMatch& match, int i) {
      return match.captured(i).toDouble();
    };
    const Eigen::Matrix4d by_tf =
        poseOfExportCameras({number(tf, 7), number(tf, 4), number(tf, 5), number(tf, 6)},
                            {number(tf, 1), number(tf, 2), number(tf, 3)});
    QVERIFY(worstDifference_px(result, 0, {by_tf.inverse(), offset_s, lens}) < kExportCamerasSame_px);
    const auto joint =
        QRegularExpression(
            "left_optical_frame\"/>\\s*<origin xyz=\"(\\S+) (\\S+) (\\S+)\" rpy=\"(\\S+) (\\S+) (\\S+)\"")
            .match(QString::fromStdString(contentOf(exported, "ros/rig.urdf")));
    QVERIFY(joint.hasMatch());
    using Axis = Eigen::AngleAxisd;
    const Eigen::Quaterniond rotation = Axis(number(joint, 6), Eigen::Vector3d::UnitZ()) *
                                        Axis(number(joint, 5), Eigen::Vector3d::UnitY()) *
                                        Axis(number(joint, 4), Eigen::Vector3d::UnitX());
    const Eigen::Matrix4d by_urdf =
        poseOfExportCameras(rotation, {number(joint, 1), number(joint, 2), number(joint, 3)});
    QVERIFY(worstDifference_px(result, 0, {by_urdf.inverse(), offset_s, lens}) < kExportCamerasSame_px);
    QVERIFY(script.contains("--child-frame-id far_imu"));
    // tf2_ros' static_transform_publisher: ROS 1 takes nine words, ROS 2 flags; the numbers are the script's.
    QStringList words = tf.capturedTexts().mid(1);
    words << "left_imu"
          << "left_optical_frame";
    QCOMPARE(ros1Arguments(contentOf(exported, "ros/static_transforms.launch")).value(0), words.join(' '));
    QStringList flagged;
    const QStringList flags{
        "--x", "--y", "--z", "--qx", "--qy", "--qz", "--qw", "--frame-id", "--child-frame-id"};
    for (qsizetype i = 0; i < flags.size(); ++i) flagged << flags[i] << words[i];
    const QString python = QString::fromStdString(contentOf(exported, "ros/static_transforms.launch.py"));
    QVERIFY2(python.contains("arguments=['" + flagged.join("', '") + "']"), qPrintable(python));
    QVERIFY(python.contains("def generate_launch_description():"));
    QCOMPARE(python.count("Node(package='tf2_ros', executable='static_transform_publisher',"), 3);
    const std::string description = contentOf(exported, "ros/rig.urdf");
    QVERIFY(description.find("right -0.0021 s") != std::string::npos);
    QXmlStreamReader urdf(QByteArray::fromStdString(description));
    QStringList links, elements;
    while (!urdf.atEnd()) {
      if (urdf.readNext() != QXmlStreamReader::StartElement) continue;
      elements << urdf.name().toString();
      if (elements.back() == "link") links << urdf.attributes().value("name").toString();
      if (elements.back() == "parent" || elements.back() == "child")
        QVERIFY(elements.back() == "child" || links.contains(urdf.attributes().value("link").toString()));
    }
    QVERIFY2(!urdf.hasError(), qPrintable(urdf.errorString()));
    QCOMPARE(elements.front(), QString("robot"));
  }

  // Roll and yaw are one rotation there.
  void urdf_ofAnUprightCamera_isRightToo() {
    NamedResult result = rig({});
    const Eigen::Quaterniond upright =
        Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
        Eigen::AngleAxisd(0.5 * 3.14159265358979323846, Eigen::Vector3d::UnitY());
    test::ownResult(result).state.cameras[0].reference_from_camera.rotation = upright;
    const auto joint =
        QRegularExpression(
            "left_optical_frame\"/>\\s*<origin xyz=\"\\S+ \\S+ \\S+\" rpy=\"(\\S+) (\\S+) (\\S+)\"")
            .match(QString::fromStdString(contentOf(exportTo(result, "ros"), "ros/rig.urdf")));
    const Eigen::Quaterniond read =
        Eigen::AngleAxisd(joint.captured(3).toDouble(), Eigen::Vector3d::UnitZ()) *
        Eigen::AngleAxisd(joint.captured(2).toDouble(), Eigen::Vector3d::UnitY()) *
        Eigen::AngleAxisd(joint.captured(1).toDouble(), Eigen::Vector3d::UnitX());
    QVERIFY(read.angularDistance(upright) < 1e-9);
  }

  void esvo_reprojects_data() { ros_reprojects_data(); }
  void esvo_reprojects() {
    QFETCH(bool, fisheye);
    RigKind kind;
    kind.fisheye = fisheye;
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "esvo2");
    const YAML::Node left = yamlOf(exported, "esvo2/left.yaml"), right = yamlOf(exported, "esvo2/right.yaml");
    const Eigen::Matrix4d imu_from_left = pose(dataMatrix(left["T_b_c"]));
    const Eigen::Matrix4d right_from_left = pose(dataMatrix(right["T_right_left"]));
    const auto& cameras = result.result->state.cameras;
    QVERIFY(
        worstDifference_px(result, 0, {imu_from_left.inverse(), cameras[0].time_offset_s, rosLens(left)}) <
        kExportCamerasSame_px);
    QVERIFY(worstDifference_px(result, 1,
                               {right_from_left * imu_from_left.inverse(), cameras[1].time_offset_s,
                                rosLens(right)}) < kExportCamerasSame_px);
    // A point's rectified pixels are in one row, and their distance in x is f B / z.
    const Eigen::Vector3d in_left(0.2, -0.3, 1.5),
        in_right = (right_from_left * in_left.homogeneous()).head<3>();
    const Eigen::Vector3d level_left = dataMatrix(left["rectification_matrix"]) * in_left;
    const Eigen::Vector3d level_right = dataMatrix(right["rectification_matrix"]) * in_right;
    const Eigen::Vector2d a =
        (dataMatrix(left["projection_matrix"]) * level_left.homogeneous()).hnormalized();
    const Eigen::Vector2d b =
        (dataMatrix(right["projection_matrix"]) * level_left.homogeneous()).hnormalized();
    const Eigen::Matrix<double, 3, 4> p = dataMatrix(right["projection_matrix"]);
    const Eigen::Vector2d direct = (p.leftCols<3>() * level_right).hnormalized();
    QVERIFY((b - direct).norm() < kExportCamerasSame_px);
    QVERIFY(std::abs(a.y() - b.y()) < kExportCamerasSame_px);
    QVERIFY(a.x() - b.x() > 5.0);
    QVERIFY(!yamlOf(exportTo(result, "esvo"), "esvo/left.yaml")["T_b_c"]);
  }

  void esvo_findsTheLeftCamera() {
    const NamedResult result = rig({});
    NamedResult swapped = result;
    std::swap(swapped.cameras[0], swapped.cameras[1]);
    CalibrationState& state = test::ownResult(swapped).state;
    std::swap(state.cameras[0], state.cameras[1]);
    QVERIFY(contentOf(exportTo(result, "esvo"), "esvo/left.yaml") ==
            contentOf(exportTo(swapped, "esvo"), "esvo/left.yaml"));
    RigKind one;
    one.cameras = 1;
    QVERIFY_THROWS_EXCEPTION(CalibrationError, exportTo(rig(one), "esvo"));
  }

  void dvProcessing_reprojects() {
    RigKind kind;
    kind.third_radial = true;
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "dv-processing");
    const std::string text = contentOf(exported, "dv-processing/calibration.json");
    const YAML::Node root = YAML::Load(text), imu = root["imus"]["S0"];
    // Scalars are strings, as boost::property_tree writes them.
    QVERIFY(text.find("\"timeOffsetMicros\": \"7301\"") != std::string::npos);
    const Eigen::Matrix4d first_from_imu = matrix(numbers(imu["transformationToC0"]), 4, 4);
    for (std::size_t i = 0; i < 2; ++i) {
      const YAML::Node camera = root["cameras"][numbered("C", static_cast<Eigen::Index>(i))];
      const auto f = numbers(camera["focalLength"]), c = numbers(camera["principalPoint"]);
      const Eigen::Matrix4d this_from_first = matrix(numbers(camera["transformationToC0"]), 4, 4);
      const double offset_s =
          i == 0 ? 1e-6 * imu["timeOffsetMicros"].as<double>() : -0.0021;  // one for all cameras
      QVERIFY(worstDifference_px(
                  result, i,
                  {this_from_first * first_from_imu, offset_s,
                   radtanLens({f[0], f[1], c[0], c[1]}, numbers(camera["distortionCoefficients"]))}) <
              kExportCamerasSame_px);
    }
    QCOMPARE(numbers(imu["omegaOffsetAvg"])[1], -0.02);
    // Metadata of a camera must have all four keys or be absent; an IMU is found by its camera's name.
    QVERIFY(!root["cameras"]["C0"]["metadata"]);
    QVERIFY(imu["metadata"]["calibrationTime"] && imu["metadata"]["comment"]);
    QCOMPARE(imu["name"].as<std::string>(), root["cameras"]["C0"]["name"].as<std::string>());
    const Eigen::Matrix3d fundamental = matrix(numbers(root["stereo"]["C0_C1"]["fundamentalMatrix"]), 3, 3);
    const Eigen::Vector3d in_first(0.1, 0.2, 1.2);
    const Eigen::Matrix4d second_from_first =
        matrix(numbers(root["cameras"]["C1"]["transformationToC0"]), 4, 4);
    const auto undistorted = [&](std::size_t i, const Eigen::Vector3d& p) {
      const CameraIntrinsics& own = *result.result->state.cameras[i].lens.inUse();
      return Eigen::Vector3d((own.focal_length_px.array() * p.hnormalized().array()).matrix().homogeneous() +
                             Eigen::Vector3d(own.principal_point_px.x(), own.principal_point_px.y(), 0.0));
    };
    const Eigen::Vector3d in_second = (second_from_first * in_first.homogeneous()).head<3>();
    QVERIFY(std::abs(undistorted(1, in_second).dot(fundamental * undistorted(0, in_first))) < 1e-12);
  }

  void metavision_hasTheIntrinsics() {
    RigKind kind;
    kind.third_radial = true;
    kind.cameras = 1;
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "metavision");
    const cv::FileStorage file(
        contentOf(exported, "metavision/intrinsics.json"),
        cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_JSON);
    cv::Mat k, distortion;
    file["camera_matrix"] >> k;
    file["distortion_coefficients"] >> distortion;
    const Lens lens =
        radtanLens({k.at<double>(0, 0), k.at<double>(1, 1), k.at<double>(0, 2), k.at<double>(1, 2)},
                   std::vector<double>(distortion.begin<double>(), distortion.end<double>()));
    const CameraState& camera = result.result->state.cameras[0];
    const Eigen::Matrix4d reference_from_camera = poseOfExportCameras(
        camera.reference_from_camera.rotation, camera.reference_from_camera.translation_m);
    QVERIFY(worstDifference_px(result, 0, {reference_from_camera.inverse(), camera.time_offset_s, lens}) <
            kExportCamerasSame_px);
    QCOMPARE(static_cast<int>(file["image_size"][0]), 346);
    QCOMPARE(static_cast<double>(file["overall_rms_reprojection_error"]), 0.125);
  }

  // A lens that no set of coefficients approximates is refused, not written with large errors.
  void metavision_ofAStrongFisheye_isRefused() {
    RigKind kind;
    kind.fisheye = true;
    NamedResult result = rig(kind);
    test::ownResult(result).state.cameras[0].lens.detection_intrinsics->focal_length_px = {110.0, 110.0};
    try {
      exportTo(result, "metavision");
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      QVERIFY2(error.problem().find("equidistant distortion") != std::string::npos, error.what());
    }
  }

  void ekalibr_reprojects_data() { ros_reprojects_data(); }
  void ekalibr_reprojects() {
    QFETCH(bool, fisheye);
    RigKind kind;
    kind.fisheye = fisheye;
    kind.third_radial = !fisheye;
    const NamedResult result = rig(kind);
    const ExportedFiles exported = exportTo(result, "ekalibr");
    const YAML::Node root = yamlOf(exported, "ekalibr/ekalibr_param.yaml")["CalibParam"];
    const auto rotation = [](const YAML::Node& q) {
      return Eigen::Quaterniond(q["qw"].as<double>(), q["qx"].as<double>(), q["qy"].as<double>(),
                                q["qz"].as<double>());
    };
    const auto vector = [](const YAML::Node& map) {
      Eigen::VectorXd values(static_cast<Eigen::Index>(map.size()));
      for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = map[numbered("r", i, "c0")].as<double>();
      return values;
    };
    for (std::size_t i = 0; i < 2; ++i) {
      const YAML::Node place = root["EXTRI"]["SO3_CjToBr"][i];
      QCOMPARE(place["key"].as<std::string>(), result.cameras[i].stream);
      const YAML::Node camera = root["INTRI"]["Camera"][i]["value"], data = camera["ptr_wrapper"]["data"];
      const auto f = numbers(data["focal_length"]), c = numbers(data["principal_point"]),
                 d = numbers(data["disto_param"]);
      const std::vector<double> k{f[0], f[1], c[0], c[1]};
      const Lens lens = fisheye ? fisheyeLens(k, d) : radtanLens(k, {d[0], d[1], d[3], d[4], d[2]});
      const Eigen::Matrix4d reference_from_camera =
          poseOfExportCameras(rotation(place["value"]), vector(root["EXTRI"]["POS_CjInBr"][i]["value"]));
      QVERIFY(worstDifference_px(result, i,
                                 {reference_from_camera.inverse(),
                                  root["TEMPORAL"]["TO_CjToBr"][i]["value"].as<double>(), lens}) <
              kExportCamerasSame_px);
    }
    // A type's name is written at its first appearance only, and pointer numbers increase.
    const YAML::Node cameras = root["INTRI"]["Camera"];
    QCOMPARE(cameras[0]["value"]["polymorphic_id"].as<unsigned>(), 2147483649U);
    QCOMPARE(cameras[0]["value"]["polymorphic_name"].as<std::string>(),
             std::string(fisheye ? "pinhole_fisheye" : "pinhole_brown_t2"));
    QCOMPARE(cameras[1]["value"]["polymorphic_id"].as<unsigned>(), 1U);
    QCOMPARE(cameras[1]["value"]["ptr_wrapper"]["id"].as<unsigned>(), 2147483652U);
    for (std::size_t i = 0; i < 2; ++i) {
      const ImuState& state = result.result->state.imus[i];
      const YAML::Node data = root["INTRI"]["IMU"][i]["value"]["ptr_wrapper"]["data"];
      const auto mapping = [&](const char* sensor) {
        const Eigen::VectorXd m = vector(data[sensor]["MAP_COEFF"]);
        return (Eigen::Matrix3d() << m[0], m[3], m[4], 0.0, m[1], m[5], 0.0, 0.0, m[2]).finished();
      };
      QVERIFY((mapping("ACCE") - state.accelerometer_scale_misalignment).norm() < 1e-15);
      QVERIFY(
          (mapping("GYRO") * rotation(data["SO3_AtoG"]).toRotationMatrix() - state.gyroscopeMatrix()).norm() <
          1e-12);
      QVERIFY((vector(data["GYRO"]["BIAS"]) - state.gyroscope_bias_rad_s).norm() < 1e-15);
      const Eigen::Vector3d position = vector(root["EXTRI"]["POS_BiInBr"][i]["value"]);
      QVERIFY((position - state.reference_from_imu.translation_m).norm() < 1e-15);
      QCOMPARE(root["TEMPORAL"]["TO_BiToBr"][i]["value"].as<double>(), state.time_offset_s);
    }
    // veta's cereal archive (29195b0) throws where a note is missing.
    const YAML::Node alone =
        yamlOf(exported, "ekalibr/intrinsics-left.yaml")["Intrinsics"]["ptr_wrapper"]["data"];
    QCOMPARE(alone["img_width"].as<int>(), 346);
    for (const YAML::Node& data : {alone, cameras[0]["value"]["ptr_wrapper"]["data"]})
      for (const char* const note : {"focal_length_note", "principal_point_note", "disto_param_note"})
        QVERIFY2(data[note] && data[note].IsScalar(), note);
  }

  // Every target writes the files that its source comments describe, for every kind of rig that it supports.
  void everyTarget_statesWhoWroteIt() {
    const NamedResult result = rig({});
    for (const ExportTarget& target : exportTargets()) {
      const ExportedFiles exported = exportTo(result, target.name);
      QVERIFY(!exported.files.empty());
      bool said = false;
      for (const FileContent& file : exported.files) {
        QVERIFY2(*file.path.begin() == target.name, target.name);
        said = said || file.content.find("Written by Evical 0.1.0. Calibration: ok") != std::string::npos;
      }
      QVERIFY2(said, target.name);
    }
  }

  void files_areWrittenAllOrNone() {
    QTemporaryDir scratch;
    const std::filesystem::path folder = scratch.path().toStdString();
    writeExportedFiles(folder / "new", exportTo(rig({}), "kalibr").files);
    QVERIFY(std::filesystem::exists(folder / "new/kalibr/camchain-imucam.yaml"));
    // A folder that cannot be created: a file has its name.
    const std::vector<FileContent> files{{"a/one.txt", "1"}, {"two.txt/b", "2"}};
    writeFileWhole(folder / "two.txt", "in the way");
    QVERIFY_THROWS_EXCEPTION(CalibrationError, writeExportedFiles(folder, files));
    QVERIFY(!std::filesystem::exists(folder / "a"));
  }
};

EVICAL_TEST(TestExportCameras)
#include "tst_export_cameras.moc"
