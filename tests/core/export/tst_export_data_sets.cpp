// Calibration files in the layouts of data sets, read like in the data sets' own tools and in their users'
// tools.
#include "core/base/error.h"
#include "core/geometry/camera_model.h"
#include "tests/core/export/exported_rig.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <opencv2/core.hpp>

#include <algorithm>
#include <map>
#include <sstream>

using namespace evical;
using namespace evical::test;

namespace {

constexpr double kExportDataSetsSame_px = 1e-9;

Eigen::Matrix4d poseOfExportDataSets(const RigidTransform& pose) {
  Eigen::Isometry3d full = Eigen::Isometry3d::Identity();
  full.linear() = pose.rotation.toRotationMatrix();
  full.translation() = pose.translation_m;
  return full.matrix();
}

Eigen::Matrix4d imuFromCamera(const NamedResult& result, std::size_t camera) {
  return poseOfExportDataSets(result.result->state.cameras.at(camera).reference_from_camera);
}

double offset_s(const NamedResult& result, std::size_t camera) {
  return result.result->state.cameras.at(camera).time_offset_s;
}

bool isSaid(const ExportedFiles& exported, const std::string& text) {
  for (const std::string& note : exported.notes)
    if (note.find(text) != std::string::npos) return true;
  return false;
}

std::string refusal(const NamedResult& result, const std::string& target) {
  try {
    exportTo(result, target);
    return "taken";
  } catch (const CalibrationError& error) {
    return error.what();
  }
}

Eigen::Matrix3d threeByThree(const YAML::Node& camera_matrix) {
  const std::vector<double> k = numbers(camera_matrix);
  return (Eigen::Matrix3d() << k.at(0), 0.0, k.at(2), 0.0, k.at(1), k.at(3), 0.0, 0.0, 1.0).finished();
}

// Reads a camera like get_camera_calib_dsec_yaml of tub-rip/ES-PTAM (mapper_emvs_stereo/src/calib.cpp,
// 79ef978).
Lens dsecLens(const YAML::Node& camera, const std::string& type) {
  if (camera["camera_type"].as<std::string>() != type) throw std::runtime_error("another type");
  if (camera["resolution"][1].as<int>() != 260 || camera["resolution"][0].as<int>() != 346)
    throw std::runtime_error("resolution");
  if (camera["distortion_model"].as<std::string>() != "radtan") throw std::runtime_error("another lens");
  std::vector<double> k, d;
  for (int i = 0; i < 4; ++i) {
    k.push_back(camera["camera_matrix"][i].as<double>());
    d.push_back(camera["distortion_coeffs"][i].as<double>());
  }
  return radtanLens(k, d);
}

Eigen::Matrix4d poseOfExportDataSets(const cv::FileNode& pose) {
  Eigen::Isometry3d full = Eigen::Isometry3d::Identity();
  full.linear() = Eigen::Quaterniond(static_cast<double>(pose["qw"]), static_cast<double>(pose["qx"]),
                                     static_cast<double>(pose["qy"]), static_cast<double>(pose["qz"]))
                      .toRotationMatrix();
  full.translation() = Eigen::Vector3d(static_cast<double>(pose["px"]), static_cast<double>(pose["py"]),
                                       static_cast<double>(pose["pz"]));
  return full.matrix();
}

// Reads a camera of TUM-VIE like get_camera_calib_json of tub-rip/ES-PTAM (mapper_emvs_stereo/src/calib.cpp,
// 79ef978).
Lens tumVieLens(const cv::FileNode& root, int i) {
  if (static_cast<double>(root["resolution"][i][0]) != 346.0 ||
      static_cast<double>(root["resolution"][i][1]) != 260.0)
    throw std::runtime_error("resolution");
  const cv::FileNode camera = root["intrinsics"][i];
  if (static_cast<std::string>(camera["camera_type"]) != "kb4") throw std::runtime_error("another lens");
  std::vector<double> k, d;
  for (const char* const key : {"fx", "fy", "cx", "cy"})
    k.push_back(static_cast<double>(camera["intrinsics"][key]));
  for (const char* const key : {"k1", "k2", "k3", "k4"}) {
    if (!camera["intrinsics"][key].isReal()) throw std::runtime_error(key);
    d.push_back(static_cast<double>(camera["intrinsics"][key]));
  }
  return fisheyeLens(k, d);
}

cv::FileStorage tumVieFile(const ExportedFiles& exported) {
  return {contentOf(exported, "tum-vie/camera-calibrationA.json"),
          cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_JSON};
}

// Reads a camera's folder like evimo/dataset.h of better-flow/evimo (02db528): read_params, read_cam_intr,
// read_extr; the time offset has its name in read_camera_extrinsics of
// tools/evimo2_v2_generate/generate_extrinsics_npz.py (35286e2).
struct EvimoCamera {
  std::map<std::string, std::string> parameters;
  std::vector<double> lens, place, background;
  double pose_to_event_s, image_to_event_s;
};

EvimoCamera evimoCamera(const ExportedFiles& exported, const std::string& name) {
  EvimoCamera camera{};
  std::istringstream parameters(contentOf(exported, "evimo2/" + name + "/params.txt"));
  for (std::string line; std::getline(parameters, line);) {
    const std::size_t colon = line.find(':');
    camera.parameters[line.substr(0, colon)] =
        QString::fromStdString(line.substr(colon + 1)).trimmed().toStdString();
  }
  const auto read = [](std::istream& stream, int count) {
    std::vector<double> numbers(static_cast<std::size_t>(count));
    for (double& number : numbers)
      if (!(stream >> number)) throw std::runtime_error("too few numbers");
    return numbers;
  };
  std::istringstream lens(contentOf(exported, "evimo2/" + name + "/calib.txt"));
  camera.lens = read(lens, 8);
  const std::string text = contentOf(exported, "evimo2/" + name + "/extrinsics.txt");
  if (std::count(text.begin(), text.end(), '\n') != 4) throw std::runtime_error("not four lines");
  std::istringstream place(text);
  camera.place = read(place, 6);
  camera.background = read(place, 7);
  camera.pose_to_event_s = read(place, 1)[0];
  camera.image_to_event_s = read(place, 1)[0];
  return camera;
}

// tf's setRPY, about fixed axes.
Eigen::Matrix4d evimoPose(const std::vector<double>& place) {
  Eigen::Isometry3d full = Eigen::Isometry3d::Identity();
  full.linear() = (Eigen::AngleAxisd(place[5], Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(place[4], Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(place[3], Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  full.translation() = Eigen::Vector3d(place[0], place[1], place[2]);
  return full.matrix();
}

NamedResult eventsAndFramesForExportDataSets(bool fisheye = false) {
  RigKind kind;
  kind.frames = 2;
  kind.fisheye = fisheye;
  return rig(kind);
}

}  // namespace

class TestExportDataSets : public QObject {
  Q_OBJECT

 private slots:
  // Names and directions: uzh-rpg/DSEC, README.md (0df8d87).
  void dsec_reprojects() {
    const NamedResult result = eventsAndFramesForExportDataSets();
    const YAML::Node root = yamlOf(exportTo(result, "dsec"), "dsec/cam_to_cam.yaml");
    const YAML::Node cameras = root["intrinsics"], places = root["extrinsics"];
    Eigen::Matrix4d this_from_first = Eigen::Matrix4d::Identity();
    const std::size_t ours[] = {0, 2, 3, 1};
    for (int i = 0; i < 4; ++i) {
      if (i > 0) {
        const Eigen::Matrix4d step = rowsMatrix(places["T_" + std::to_string(i) + std::to_string(i - 1)]);
        QVERIFY(step == rowsMatrix(cameras[numbered("cam", i)]["T_cn_cnm1"]));
        this_from_first = step * this_from_first;
      }
      const YAML::Node camera = cameras[numbered("cam", i)], level = cameras[numbered("camRect", i)];
      QVERIFY(
          worstDifference_px(result, ours[i],
                             {this_from_first * imuFromCamera(result, 0).inverse(), offset_s(result, ours[i]),
                              dsecLens(camera, i % 3 == 0 ? "event" : "frame")}) < kExportDataSetsSame_px);
      QCOMPARE(camera["camera_location"].as<std::string>(), std::string(i < 2 ? "left" : "right"));
      QCOMPARE(camera["camera_model"].as<std::string>(), std::string("pinhole"));
      QVERIFY(!camera["is_rectified"].as<bool>() && level["is_rectified"].as<bool>());
      QVERIFY(!level["distortion_coeffs"]);
      QCOMPARE(level["resolution"][0].as<int>(), 346);
    }
  }

  // A point has the same row in both rectified images, and its disparity determines the point.
  void dsec_disparityIsDepth_data() {
    QTest::addColumn<int>("left");
    QTest::addColumn<int>("right");
    QTest::addColumn<QString>("key");
    QTest::newRow("events") << 0 << 3 << "cams_03";
    QTest::newRow("frames") << 1 << 2 << "cams_12";
  }
  void dsec_disparityIsDepth() {
    QFETCH(int, left);
    QFETCH(int, right);
    QFETCH(QString, key);
    const NamedResult result = eventsAndFramesForExportDataSets();
    const YAML::Node root = yamlOf(exportTo(result, "dsec"), "dsec/cam_to_cam.yaml");
    const auto leveled = [&](int i) -> Eigen::Matrix3d {
      return rowsMatrix(root["extrinsics"][numbered("R_rect", i)]);
    };
    const auto k = [&](int i) {
      return threeByThree(root["intrinsics"][numbered("camRect", i)]["camera_matrix"]);
    };
    const std::size_t ours[] = {0, 2, 3, 1};
    const Eigen::Matrix4d right_from_left =
        imuFromCamera(result, ours[right]).inverse() * imuFromCamera(result, ours[left]);
    const Eigen::Vector3d on_left(0.2, -0.3, 1.5);  // rectified
    const Eigen::Vector3d in_left = leveled(left).transpose() * on_left;
    const Eigen::Vector3d on_right = leveled(right) * (right_from_left * in_left.homogeneous()).head<3>();
    const Eigen::Vector2d a = (k(left) * on_left).hnormalized(), b = (k(right) * on_right).hnormalized();
    QVERIFY(std::abs(a.y() - b.y()) < kExportDataSetsSame_px && a.x() - b.x() > 5.0);
    const Eigen::Matrix4d q = rowsMatrix(root["disparity_to_depth"][key.toStdString()]);
    const Eigen::Vector3d back = (q * Eigen::Vector4d(a.x(), a.y(), a.x() - b.x(), 1.0)).hnormalized();
    QVERIFY((back - on_left).norm() < 1e-12);
    // Loaders split it into baseline and focal length.
    QVERIFY(std::abs(1.0 / q(3, 2) - right_from_left.topRightCorner<3, 1>().norm()) < 1e-12);
    QVERIFY(q(2, 3) == k(left)(0, 0) && q(2, 3) > 0.0);
  }

  // compute_remapping of uzh-rpg/dsec-det (src/dsec_det/remapping.py, db941c2), of points far away.
  void dsec_mapsFramesToEvents() {
    const NamedResult result = eventsAndFramesForExportDataSets();
    const YAML::Node root = yamlOf(exportTo(result, "dsec"), "dsec/cam_to_cam.yaml");
    const Eigen::Matrix3d k0 = threeByThree(root["intrinsics"]["camRect0"]["camera_matrix"]),
                          k1 = threeByThree(root["intrinsics"]["camRect1"]["camera_matrix"]),
                          r0 = rowsMatrix(root["extrinsics"]["R_rect0"]),
                          r1 = rowsMatrix(root["extrinsics"]["R_rect1"]),
                          r10 = rowsMatrix(root["extrinsics"]["T_10"]).topLeftCorner<3, 3>();
    const Eigen::Matrix3d p_r0_r1 = k0 * r0 * r10.transpose() * r1.transpose() * k1.inverse();
    const Eigen::Vector3d in_event(0.1, -0.2, 1.0);
    const Eigen::Vector3d in_frame =
        (imuFromCamera(result, 2).inverse() * imuFromCamera(result, 0)).topLeftCorner<3, 3>() * in_event;
    const Eigen::Vector2d event_px = (k0 * r0 * in_event).hnormalized(),
                          frame_px = (k1 * r1 * in_frame).hnormalized();
    QVERIFY(((p_r0_r1 * frame_px.homogeneous()).hnormalized() - event_px).norm() < kExportDataSetsSame_px);
  }

  void dsec_ofEventsAlone_goesFromCamera0To3() {
    const NamedResult result = rig({});
    const ExportedFiles exported = exportTo(result, "dsec");
    const YAML::Node root = yamlOf(exported, "dsec/cam_to_cam.yaml"), places = root["extrinsics"];
    const Eigen::Matrix4d right_from_left =
        rowsMatrix(places["T_32"]) * rowsMatrix(places["T_21"]) * rowsMatrix(places["T_10"]);
    QVERIFY(worstDifference_px(result, 1,
                               {right_from_left * imuFromCamera(result, 0).inverse(), offset_s(result, 1),
                                dsecLens(root["intrinsics"]["cam3"], "event")}) < kExportDataSetsSame_px);
    QVERIFY(!root["intrinsics"]["cam1"] && !places["R_rect1"] && !root["disparity_to_depth"]["cams_12"]);
    QVERIFY(isSaid(exported, "left event camera: left, right event camera: right, left frame camera: none"));
    QVERIFY(isSaid(exported, "add to the stamps of left 0.007301 s, right -0.0021 s"));
    QVERIFY(isSaid(exported, "DSEC has no IMUs: left imu"));
    const std::string text = contentOf(exported, "dsec/cam_to_cam.yaml");
    QVERIFY(text.find("right -0.0021 s") != std::string::npos);

    RigKind one;
    one.cameras = 1;
    const YAML::Node alone = yamlOf(exportTo(rig(one), "dsec"), "dsec/cam_to_cam.yaml");
    QVERIFY(!alone["extrinsics"]["T_10"] && !alone["disparity_to_depth"]);
    QVERIFY(rowsMatrix(alone["extrinsics"]["R_rect0"]).isIdentity(0.0));
    QVERIFY(numbers(alone["intrinsics"]["camRect0"]["camera_matrix"]) ==
            numbers(alone["intrinsics"]["cam0"]["camera_matrix"]));
  }

  // Whichever of them comes first.
  void dsec_findsTheLeftCamera() {
    const NamedResult result = eventsAndFramesForExportDataSets();
    NamedResult swapped = result;
    CalibrationState& state = ownResult(swapped).state;
    std::swap(swapped.cameras[0], swapped.cameras[3]);
    std::swap(state.cameras[0], state.cameras[3]);
    std::swap(swapped.cameras[1], swapped.cameras[2]);
    std::swap(state.cameras[1], state.cameras[2]);
    const YAML::Node a = yamlOf(exportTo(result, "dsec"), "dsec/cam_to_cam.yaml"),
                     b = yamlOf(exportTo(swapped, "dsec"), "dsec/cam_to_cam.yaml");
    QCOMPARE(YAML::Dump(a), YAML::Dump(b));
  }

  void dsec_refusesWhatItCannotHold() {
    NamedResult frames = eventsAndFramesForExportDataSets();
    for (SensorDescription& camera : frames.cameras) camera.kind = CameraKind::Frames;
    QVERIFY(refusal(frames, "dsec").find("has no event camera") != std::string::npos);
    RigKind wide;
    wide.fisheye = true;
    NamedResult strong = rig(wide);
    ownResult(strong).state.cameras[0].lens.detection_intrinsics->focal_length_px = {110.0, 110.0};
    QVERIFY(refusal(strong, "dsec").find("DSEC does not support equidistant distortion") !=
            std::string::npos);
    RigKind third;
    third.third_radial = true;
    QVERIFY(
        isSaid(exportTo(rig(third), "dsec"), "DSEC does not support radial-tangential distortion with k3"));
    RigKind three;
    three.cameras = 3;
    QVERIFY(isSaid(exportTo(rig(three), "dsec"), "DSEC has two cameras per kind: third is left out"));
  }

  // Event cameras are 2 and 3 there, whether or not there are frames.
  void tumVie_reprojects_data() {
    QTest::addColumn<bool>("frames");
    QTest::newRow("events and frames") << true;
    QTest::newRow("events alone") << false;
  }
  void tumVie_reprojects() {
    QFETCH(bool, frames);
    RigKind kind;
    kind.fisheye = true;
    NamedResult result = frames ? eventsAndFramesForExportDataSets(true) : rig(kind);
    for (CameraState& camera : ownResult(result).state.cameras)
      camera.time_offset_s = 0.007301;  // one for all cameras
    const ExportedFiles exported = exportTo(result, "tum-vie");
    const cv::FileStorage file = tumVieFile(exported);
    const cv::FileNode root = file["value0"];
    QCOMPARE(root["T_imu_cam"].size(), 4U);
    const std::vector<std::size_t> ours =
        frames ? std::vector<std::size_t>{2, 3, 0, 1} : std::vector<std::size_t>{0, 1, 0, 1};
    const ImuState& imu = result.result->state.imus[0];
    for (int i = 0; i < 4; ++i) {
      ReadCamera read{poseOfExportDataSets(root["T_imu_cam"][i]).inverse(),
                      1e-9 * static_cast<double>(root["cam_time_offset_ns"]), tumVieLens(root, i)};
      // Its IMU's frame is the one in which the accelerometer's matrix is lower triangular.
      const Eigen::Matrix4d turn = poseOfExportDataSets(root["T_imu_cam"][i]) *
                                   imuFromCamera(result, ours[static_cast<std::size_t>(i)]).inverse();
      QVERIFY((turn.topRightCorner<3, 1>().norm()) < 1e-12);
      const Eigen::Matrix3d theirs =
          imu.accelerometer_scale_misalignment * turn.topLeftCorner<3, 3>().transpose();
      QVERIFY(Eigen::Matrix3d(theirs.triangularView<Eigen::StrictlyUpper>()).norm() < 1e-12);
      read.their_imu_from_ours = turn.topLeftCorner<3, 3>();
      QVERIFY(worstDifference_px(result, ours[static_cast<std::size_t>(i)], read) < kExportDataSetsSame_px);
    }
    QCOMPARE(isSaid(exported, "TUM-VIE expects four cameras"), !frames);
    QVERIFY(contentOf(exported, "tum-vie/README.txt").find("right event camera: right") != std::string::npos);
  }

  void tumVie_holdsItsOneLensOnly() {
    const ExportedFiles exported = exportTo(eventsAndFramesForExportDataSets(), "tum-vie");
    QVERIFY(isSaid(exported, "frame1: TUM-VIE does not support radial-tangential distortion: refitted"));
    QVERIFY(isSaid(exported, "TUM-VIE supports one time offset for all cameras: that of frame0"));
    RigKind one;
    one.cameras = 1;
    QVERIFY(refusal(rig(one), "tum-vie").find("Use the target basalt") != std::string::npos);
  }

  void evimo2_reprojects_data() {
    QTest::addColumn<bool>("fisheye");
    QTest::newRow("radtan") << false;
    QTest::newRow("equidistant") << true;
  }
  void evimo2_reprojects() {
    QFETCH(bool, fisheye);
    const NamedResult result = eventsAndFramesForExportDataSets(fisheye);
    const ExportedFiles exported = exportTo(result, "evimo2");
    for (std::size_t i = 0; i < result.cameras.size(); ++i) {
      const EvimoCamera camera = evimoCamera(exported, result.cameras[i].name);
      const std::vector<double> k(camera.lens.begin(), camera.lens.begin() + 4),
          d(camera.lens.begin() + 4, camera.lens.end());
      // A pose's stamp becomes the events' time by pose_to_event: t_imu + that = t_camera.
      QVERIFY(worstDifference_px(result, i,
                                 {evimoPose(camera.place).inverse(), -camera.pose_to_event_s,
                                  fisheye ? fisheyeLens(k, d) : radtanLens(k, d)}) < kExportDataSetsSame_px);
      QCOMPARE(camera.parameters.at("dist_model"), std::string(fisheye ? "equidistant" : "radtan"));
      QCOMPARE(std::stoi(camera.parameters.at("res_x")), 260);  // rows
      QCOMPARE(std::stoi(camera.parameters.at("res_y")), 346);
      QCOMPARE(camera.parameters.at(i < 2 ? "ros_event_topic" : "ros_image_topic"), result.cameras[i].stream);
      QVERIFY(camera.image_to_event_s == 0.0 && camera.background[3] == 1.0);
    }
    QVERIFY(isSaid(exported, "here it is that of left imu"));
  }
};

EVICAL_TEST(TestExportDataSets)
#include "tst_export_data_sets.moc"
