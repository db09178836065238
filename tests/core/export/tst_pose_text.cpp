// Poses as text: other programs read the result from it, to the last digit.
#include "core/export/pose_text.h"

#include "core/export/rig.h"
#include "core/numerics/angles.h"
#include "core/report/result_table.h"
#include "core/report/shown_quantity.h"
#include "tests/core/export/exported_rig.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <regex>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

using namespace evical;
using namespace evical::test;

namespace {

const PoseForm& form(const std::string& name) {
  for (const PoseForm& each : poseForms())
    if (each.name == name) return each;
  throw std::runtime_error("no form " + name);
}

const SensorPose& poseOfPoseText(const std::vector<SensorPose>& poses, std::string_view sensor) {
  for (const SensorPose& pose : poses)
    if (pose.sensor == sensor) return pose;
  throw std::runtime_error("no sensor " + std::string(sensor));
}

// Every number with a decimal point, in their order.
std::vector<double> decimals(const std::string& text) {
  static const std::regex number(R"([-+]?[0-9]+\.[0-9]+(e[-+]?[0-9]+)?)");
  std::vector<double> values;
  for (auto at = std::sregex_iterator(text.begin(), text.end(), number); at != std::sregex_iterator(); ++at)
    values.push_back(std::stod(at->str()));
  return values;
}

std::string behind(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  if (at == std::string::npos) throw std::runtime_error("there is no " + words + " in " + text);
  return text.substr(at + words.size());
}

bool isRotationForPoseText(const Eigen::Matrix4d& matrix) {
  const Eigen::Matrix3d r = matrix.topLeftCorner<3, 3>();
  return (r * r.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-14 && r.determinant() > 0.0 &&
         matrix.row(3) == Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0);
}

Eigen::Vector4d xyzw(const SensorPose& pose) {
  return pose.reference_from_sensor.rotation.coeffs();  // Eigen keeps x, y, z, w
}

Eigen::Vector4d vector4(const std::vector<double>& values, std::size_t from = 0) {
  return {values.at(from), values.at(from + 1), values.at(from + 2), values.at(from + 3)};
}

}  // namespace

class TestPoseText : public QObject {
  Q_OBJECT

  const NamedResult rig_ = rig({});
  const std::vector<SensorPose> poses_ = sensorPoses(rig_);

 private slots:
  void poses_areOfAllButTheReference() {
    QCOMPARE(poses_.size(), std::size_t{3});
    QCOMPARE(poses_[0].sensor, std::string("left"));
    QCOMPARE(poses_[1].sensor, std::string("right"));
    QCOMPARE(poses_[2].sensor, std::string("far_imu"));
    const CameraState& left = rig_.result->state.cameras[0];
    QVERIFY(poses_[0].reference_from_sensor.translation_m == left.reference_from_camera.translation_m);
    QCOMPARE(poses_[0].time_offset_s, left.time_offset_s);
    QCOMPARE(directionWords(poses_[0]),
             std::string("transforms points of left to left imu: p_left imu = R p_left + t"));
  }

  void everyForm_saysDirectionAndTime() {
    for (const PoseForm& each : poseForms()) {
      const std::string text = each.write(poses_[0]);
      QVERIFY2(text.find("transforms points of ") != std::string::npos, each.name);
      QVERIFY2(text.find("t_left imu = t_left + 0.007301 s") != std::string::npos, each.name);
    }
  }

  void yaml_readsBackToTheLastDigit() {
    const YAML::Node all = YAML::Load(poseText(form("yaml"), poses_));
    QCOMPARE(all.size(), std::size_t{3});
    for (const SensorPose& pose : poses_) {
      const YAML::Node node = all[pose.sensor];
      QCOMPARE(node["reference"].as<std::string>(), std::string("left imu"));
      QVERIFY(vector4(numbers(node["rotation_xyzw"])) == xyzw(pose));
      QCOMPARE(node["time_offset_s"].as<double>(), pose.time_offset_s);
      const Eigen::Matrix4d matrix = rowsMatrix(node["matrix"]);
      QVERIFY(isRotationForPoseText(matrix));
      QVERIFY(matrix == matrixOf(pose.reference_from_sensor));
      const std::vector<double> t = numbers(node["translation_m"]);
      QVERIFY(Eigen::Vector3d(t[0], t[1], t[2]) == pose.reference_from_sensor.translation_m);
    }
  }

  void numpyArray_isTheMatrix() {
    const SensorPose& pose = poseOfPoseText(poses_, "far_imu");
    const std::string text = form("numpy").write(pose);
    const std::vector<double> values = decimals(behind(text, "left_imu_from_far_imu = np.array("));
    const Eigen::Matrix4d matrix =
        test::matrix(std::vector<double>(values.begin(), values.begin() + 16), 4, 4);
    QVERIFY(isRotationForPoseText(matrix));
    QVERIFY(matrix == matrixOf(pose.reference_from_sensor));
    QCOMPARE(decimals(behind(text, "far_imu_time_offset_s = ")), std::vector<double>{pose.time_offset_s});
  }

  // Eigen's constructor takes w first.
  void eigen_hasTheQuaternionInItsConstructorsOrder() {
    const SensorPose& pose = poses_[1];
    const std::string text = form("eigen").write(pose);
    QVERIFY(text.find("const Eigen::Isometry3d left_imu_from_right =") != std::string::npos);
    const std::vector<double> t = decimals(behind(text, "Translation3d("));
    const std::vector<double> q = decimals(behind(text, "Quaterniond("));
    const Eigen::Isometry3d made =
        Eigen::Translation3d(t[0], t[1], t[2]) * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    QVERIFY((made.matrix() - matrixOf(pose.reference_from_sensor)).norm() < 1e-15);
  }

  void ros_isThePoseOfTheChildInTheFrame() {
    const SensorPose& pose = poses_[0];
    const std::string publisher = form("ros").write(pose);
    QVERIFY(publisher.find("--frame-id left_imu --child-frame-id left_optical_frame") != std::string::npos);
    QVERIFY(vector4(decimals(behind(publisher, "--qx "))) == xyzw(pose));
    QCOMPARE(decimals(behind(publisher, "--x ")).front(), pose.reference_from_sensor.translation_m.x());
    const YAML::Node message = YAML::Load(form("ros-message").write(pose));
    QCOMPARE(message["header"]["frame_id"].as<std::string>(), std::string("left_imu"));
    QCOMPARE(message["child_frame_id"].as<std::string>(), std::string("left_optical_frame"));
    const YAML::Node q = message["transform"]["rotation"];
    QVERIFY(Eigen::Vector4d(q["x"].as<double>(), q["y"].as<double>(), q["z"].as<double>(),
                            q["w"].as<double>()) == xyzw(pose));
    QCOMPARE(message["transform"]["translation"]["z"].as<double>(),
             pose.reference_from_sensor.translation_m.z());
  }

  void kalibr_isTheInverse_belowItsSensor() {
    const YAML::Node chain = YAML::Load(poseText(form("kalibr"), poses_));
    const Eigen::Matrix4d camera_from_imu = rowsMatrix(chain["cam1"]["T_cam_imu"]);
    QVERIFY(isRotationForPoseText(camera_from_imu));
    QVERIFY(
        (camera_from_imu * matrixOf(poses_[1].reference_from_sensor) - Eigen::Matrix4d::Identity()).norm() <
        1e-14);
    QCOMPARE(chain["cam1"]["timeshift_cam_imu"].as<double>(), poses_[1].time_offset_s);
    const Eigen::Matrix4d far_from_reference = rowsMatrix(chain["imu1"]["T_i_b"]);
    QVERIFY((far_from_reference * matrixOf(poses_[2].reference_from_sensor) - Eigen::Matrix4d::Identity())
                .norm() < 1e-14);
    QCOMPARE(chain["imu1"]["time_offset"].as<double>(), poses_[2].time_offset_s);
  }

  void kalibrOfCamerasOnly_chainsEachToTheOneBefore() {
    const NamedResult cameras = rig({.inertial = false, .cameras = 3});
    const std::vector<SensorPose> poses = sensorPoses(cameras);
    QCOMPARE(poses.size(), std::size_t{2});  // the first is the reference
    const YAML::Node chain = YAML::Load(poseText(form("kalibr"), poses));
    const Eigen::Matrix4d third_from_second = rowsMatrix(chain["cam2"]["T_cn_cnm1"]);
    const auto& all = cameras.result->state.cameras;
    QVERIFY(
        (matrixOf(all[2].reference_from_camera) * third_from_second - matrixOf(all[1].reference_from_camera))
            .norm() < 1e-14);
    QVERIFY(!chain["cam2"]["timeshift_cam_imu"]);
  }

  void textForPeople_saysTheOrderAndTheUnits() {
    const std::string text = form("text").write(poses_[0]);
    QVERIFY(vector4(decimals(behind(text, "quaternion (x, y, z, w): "))) == xyzw(poses_[0]));
    QVERIFY(std::abs(decimals(behind(text, "translation t (mm): ")).front() -
                     1e3 * poses_[0].reference_from_sensor.translation_m.x()) < 1e-9);
    QVERIFY(text.find("not unique") == std::string::npos);
  }

  void anglesNearAQuarterTurnOfPitch_areWarnedOf_data() {
    QTest::addColumn<double>("pitch_deg");
    QTest::addColumn<bool>("warned");
    QTest::newRow("88.9") << 88.9 << false;
    QTest::newRow("89.2") << 89.2 << true;
    QTest::newRow("-89.8") << -89.8 << true;
    QTest::newRow("-60") << -60.0 << false;
  }
  void anglesNearAQuarterTurnOfPitch_areWarnedOf() {
    QFETCH(double, pitch_deg);
    QFETCH(bool, warned);
    NamedResult turned = rig({});
    ownResult(turned).state.cameras[0].reference_from_camera.rotation =
        Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
        Eigen::AngleAxisd(kRadPerDeg * pitch_deg, Eigen::Vector3d::UnitY());
    const std::string words = "angles are not unique here: use the quaternion";
    const std::string text = form("text").write(sensorPoses(turned)[0]);
    QCOMPARE(text.find(words) != std::string::npos, warned);
    QCOMPARE(resultTable(turned).find(words) != std::string::npos, warned);
    QCOMPARE(resultTable(turned).find("(quaternion x, y, z, w)") != std::string::npos, warned);
  }

  void quantities_areNamed_andSaidInWords() {
    NamedResult named;
    named.cameras = {{"left"}, {"dvs.left"}};
    named.imus = {{"imu"}};
    using enum QuantityId;
    constexpr auto kCamera = QuantityOwner::Camera, kImu = QuantityOwner::Imu, kRig = QuantityOwner::Rig;
    const std::vector<std::tuple<QuantityAddress, QString, QString>> all = {
        {{kCamera, 0, Rotation}, "left.rotation.x [rad]", "left: rotation vector x"},
        {{kCamera, 0, TimeOffset}, "left.time_offset [s]", "left: time offset"},
        {{kCamera, 0, SlowEdgeLocalisationBias},
         "left.slow_edge_localisation_bias [px]",
         "left: edge localisation bias at low speed"},
        {{kImu, 0, GyroscopeScaleMisalignment, 1},
         "imu.gyroscope_scale_misalignment.xy [1]",
         "imu: gyroscope scale and misalignment xy"},
        {{kCamera, 0, Intrinsics, 0, CameraModel::Eucm}, "left.focal_length.x [px]", "left: focal length x"},
        {{kCamera, 0, Intrinsics, 5, CameraModel::Eucm}, "left.distortion.beta [1]", "left: distortion beta"},
        {{kCamera, 1, Translation, 2}, "dvs.left.translation.z [m]", "dvs.left: translation z"},
        {{QuantityOwner::Board, 0, Scale}, "board.scale [1]", "board: size"},
        {{kRig, 0, Gravity, 1}, "gravity.direction.2 [rad]", "gravity: direction 2"},
        {{kRig, 0, Gravity, 2}, "gravity.norm [m/s^2]", "gravity: norm"}};
    for (const auto& [number, name, words] : all) {
      ownResult(named).uncertainty.columns = {number};
      QCOMPARE(QString::fromStdString(columnNames(named).front()), name);
      QCOMPARE(QString::fromStdString(quantitySentence(quantityWords(number, named))), words);
    }
  }
};

EVICAL_TEST(TestPoseText)
#include "tst_pose_text.moc"
