// Source: Unsigned-Long/eKalibr: include/calib/calib_param_mgr.h (at d9e93fd: CalibParamManager::load), and
// its library veta's camera/pinhole*.h, which requires the notes since 29195b0. cereal's YAML archive looks
// up each name and throws if it is missing; a std::map is a list of {key, value}, a pointer has an id, whose
// highest bit marks its first occurrence.
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace evical {
namespace {

constexpr std::int64_t kFirstOccurrence = 0x80000000;

// A std::map keeps one of two entries of one key.
std::map<std::string, YamlNode> mapOf(const YamlNode& list) {
  std::map<std::string, YamlNode> map;
  for (const YamlNode& entry : list.items())
    if (!map.emplace(entry["key"].text(), entry["value"]).second) throw entry["key"].error("occurs twice");
  return map;
}

Eigen::VectorXd ekalibrVectorOf(const YamlNode& node, Eigen::Index size) {
  Eigen::VectorXd vector(size);
  for (Eigen::Index i = 0; i < size; ++i) vector[i] = node[fmt::format("r{}c0", i)].real();
  return vector;
}

Eigen::Quaterniond rotationOf(const YamlNode& node) {
  const Eigen::Quaterniond q(node["qw"].real(), node["qx"].real(), node["qy"].real(), node["qz"].real());
  constexpr double kUnit = 1e-9;
  if (std::abs(q.norm() - 1.0) > kUnit) throw node.error("is not a unit quaternion");
  return q;
}

YamlNode ekalibrDataOf(const YamlNode& value) {
  const YamlNode wrapper = value["ptr_wrapper"];
  if ((wrapper["id"].nanoseconds() & kFirstOccurrence) == 0)
    throw wrapper["id"].error("has data, but not the highest bit");
  return wrapper["data"];
}

// Names of polymorphic types by their ids, in order of occurrence.
class Types {
 public:
  std::string nameOf(const YamlNode& value) {
    const std::int64_t id = value["polymorphic_id"].nanoseconds();
    if ((id & kFirstOccurrence) != 0) names_[id & ~kFirstOccurrence] = value["polymorphic_name"].text();
    const auto found = names_.find(id & ~kFirstOccurrence);
    if (found == names_.end()) throw value["polymorphic_id"].error("is used before its definition");
    return found->second;
  }

 private:
  std::map<std::int64_t, std::string> names_;
};

CameraIntrinsics ekalibrLensOf(const YamlNode& value, Types& types) {
  const std::string type = types.nameOf(value);
  const bool radtan = type == "pinhole_brown_t2";
  if (!radtan && type != "pinhole_fisheye")
    throw value["polymorphic_id"].error("must be pinhole_brown_t2 or pinhole_fisheye");
  const YamlNode data = ekalibrDataOf(value);
  for (const char* key : {"focal_length_note", "principal_point_note", "disto_param_note"}) data[key].text();
  std::vector<double> k = data["focal_length"].reals(2);
  const std::vector<double> principal = data["principal_point"].reals(2);
  k.insert(k.end(), principal.begin(), principal.end());
  std::vector<double> d = data["disto_param"].reals(radtan ? 5 : 4);
  if (radtan) d = {d[0], d[1], d[3], d[4], d[2]};  // k1 k2 k3 t1 t2 there
  constexpr int kLargest_px = 100000;
  return lensFrom(radtan ? CameraModel::PinholeRadtan : CameraModel::PinholeEquidistant, k, d,
                  {data["img_width"].integer(1, kLargest_px), data["img_height"].integer(1, kLargest_px)});
}

// measured = MAP true + BIAS; diagonal first, then 01, 02, 12.
Eigen::Matrix3d mappingOf(const YamlNode& sensor) {
  const Eigen::VectorXd m = ekalibrVectorOf(sensor["MAP_COEFF"], 6);
  Eigen::Matrix3d matrix;
  matrix << m[0], m[3], m[4], 0.0, m[1], m[5], 0.0, 0.0, m[2];
  return matrix;
}

void readIntrinsics(const YamlNode& imu_value, ReadImu& imu) {
  const YamlNode data = ekalibrDataOf(imu_value);
  imu.accelerometer = mappingOf(data["ACCE"]);
  imu.gyroscope = mappingOf(data["GYRO"]) * rotationOf(data["SO3_AtoG"]).toRotationMatrix();
  imu.accelerometer_bias_m_s2 = ekalibrVectorOf(data["ACCE"]["BIAS"], 3);
  imu.gyroscope_bias_rad_s = ekalibrVectorOf(data["GYRO"]["BIAS"], 3);
}

const YamlNode& ekalibrAt(const std::map<std::string, YamlNode>& map, const std::string& topic,
                          const YamlNode& of) {
  const auto found = map.find(topic);
  if (found == map.end()) throw of.error(fmt::format("has no entry for {}", topic));
  return found->second;
}

ReadFile readParameters(const std::filesystem::path& path) {
  const YamlNode root = YamlNode::load(path)["CalibParam"], extrinsics = root["EXTRI"],
                 times = root["TEMPORAL"], intrinsics = root["INTRI"];
  ReadFile file{path};
  // A topic's entry in each of the maps.
  const auto pose = [&](const char* rotations, const char* positions, const std::string& topic) {
    return RigidTransform{
        rotationOf(ekalibrAt(mapOf(extrinsics[rotations]), topic, extrinsics[rotations])),
        ekalibrVectorOf(ekalibrAt(mapOf(extrinsics[positions]), topic, extrinsics[positions]), 3)};
  };
  const auto time = [&](const char* key, const std::string& topic) {
    return ekalibrAt(mapOf(times[key]), topic, times[key]).real();
  };
  for (const auto& [topic, value] : mapOf(intrinsics["IMU"])) {
    ReadImu imu;
    imu.name = topic;
    readIntrinsics(value, imu);
    imu.reference_from_imu = pose("SO3_BiToBr", "POS_BiInBr", topic);
    imu.time_offset_s = time("TO_BiToBr", topic);
    file.imus.push_back(imu);
  }
  Types types;
  mapOf(intrinsics["Camera"]);
  for (const YamlNode& entry :
       intrinsics["Camera"].items()) {  // in the file's order, in which types are defined
    ReadCamera camera;
    camera.name = entry["key"].text();
    camera.lens = ekalibrLensOf(entry["value"], types);
    camera.frame_from_camera = pose("SO3_CjToBr", "POS_CjInBr", camera.name);
    camera.time_offset_s = time("TO_CjToBr", camera.name);
    file.cameras.push_back(camera);
  }
  file.gravity_m_s2 = ekalibrVectorOf(root["GRAVITY"], 3).norm();
  return file;
}

}  // namespace

ReadFile readEkalibrFile(const std::filesystem::path& path) {
  return readParameters(path);
}

ReadBack readEkalibr(const std::filesystem::path& folder) {
  ReadBack read;
  read.files.push_back(readParameters(folder / "ekalibr_param.yaml"));
  const std::string kBeginning = "intrinsics-";
  const std::vector<std::filesystem::path> paths = filesLike(folder, kBeginning, ".yaml");
  if (paths.size() < read.files.front().cameras.size())
    throw badInput(folder.string(), fmt::format("has {} intrinsics-*.yaml for {} cameras", paths.size(),
                                                read.files.front().cameras.size()));
  for (const std::filesystem::path& path : paths) {
    Types types;
    ReadCamera camera;
    camera.name = path.stem().string().substr(kBeginning.size());
    camera.lens = ekalibrLensOf(YamlNode::load(path)["Intrinsics"], types);
    read.files.push_back({path, {camera}});
  }
  return read;
}

}  // namespace evical
