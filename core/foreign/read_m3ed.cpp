// Source: daniilidis-group/m3ed: insert_calibration of build_system/bag_processing/rosbag2hdf5.py, which
// writes the groups, and load_remapping of build_system/semantics/internimage.py, which reads them (both at
// 2b39788). Readers of its users also require pinhole and radtan, four coefficients, and the identity at the
// left event camera. camera_name is Evical's addition.
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include "core/base/error.h"
#include "core/format/hdf5_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace evical {
namespace {

constexpr const char* kPlace = "/calib/T_to_prophesee_left";
constexpr std::array kCameraGroups = {"/prophesee/left", "/prophesee/right", "/ovc/left", "/ovc/right"};
constexpr std::array kCameraKeys = {"/calib/camera_name",
                                    "/calib/camera_model",
                                    "/calib/distortion_coeffs",
                                    "/calib/distortion_model",
                                    "/calib/intrinsics",
                                    "/calib/resolution",
                                    kPlace};

class Groups {
 public:
  explicit Groups(const std::filesystem::path& path)
      : file_(path.string()), datasets_(hdf5Source(textOf(path), file_)) {}

  bool has(const std::string& group) const {
    return std::any_of(kCameraKeys.begin(), kCameraKeys.end(),
                       [&](const char* key) { return datasets_(group + key).has_value(); });
  }

  template <class Data>
  Data get(const std::string& path, const std::vector<std::size_t>& shape) const {
    const std::optional<Hdf5Dataset> found = datasets_(path);
    if (!found) throw badInput(place(path), "is missing", "Export again");
    const auto* const data = std::get_if<Data>(&found->data);
    if (data == nullptr || found->shape != shape) throw badInput(place(path), "has another type or shape");
    return *data;
  }

  void demand(const std::string& path, const char* text) const {
    if (get<std::string>(path, {}) != text) throw badInput(place(path), fmt::format("must be {}", text));
  }

  RigidTransform placeOf(const std::string& group) const {
    const std::string path = group + kPlace;
    return rigidFrom(matrixFrom(get<std::vector<double>>(path, {4, 4}), 4, 4), place(path));
  }

 private:
  std::string place(const std::string& path) const { return file_ + ": " + path; }

  std::string file_;
  Hdf5Source datasets_;
};

ReadCamera m3edCameraOf(const Groups& groups, const std::string& group) {
  groups.demand(group + "/calib/camera_model", "pinhole");
  groups.demand(group + "/calib/distortion_model", "radtan");
  const auto size = groups.get<std::vector<std::int64_t>>(group + "/calib/resolution", {2});
  ReadCamera camera;
  camera.name = groups.get<std::string>(group + "/calib/camera_name", {});
  camera.lens =
      lensFrom(CameraModel::PinholeRadtan, groups.get<std::vector<double>>(group + "/calib/intrinsics", {4}),
               groups.get<std::vector<double>>(group + "/calib/distortion_coeffs", {4}),
               {static_cast<int>(size[0]), static_cast<int>(size[1])});
  camera.frame_from_camera = groups.placeOf(group);
  return camera;
}

}  // namespace

ReadBack readM3ed(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "calibration.h5";
  const Groups groups(path);
  ReadFile file{path, {}, {}, true};
  for (const char* const group : kCameraGroups)
    if (group == kCameraGroups.front() || groups.has(group))
      file.cameras.push_back(m3edCameraOf(groups, group));
  const RigidTransform& first = *file.cameras.front().frame_from_camera;
  if (!first.rotation.toRotationMatrix().isIdentity(0.0) || !first.translation_m.isZero(0.0))
    throw badInput(fmt::format("{}: {}{}", path.string(), kCameraGroups.front(), kPlace),
                   "must be the identity");
  ReadBack read;
  read.max_cameras = file.cameras.size();
  read.max_imus = 1;
  read.files = {file};
  if (!groups.has("/ovc/imu")) return read;
  ReadFile inertial{path};
  const RigidTransform imu_from_left = inverse(groups.placeOf("/ovc/imu"));
  for (const ReadCamera& camera : file.cameras) {
    ReadCamera& placed = inertial.cameras.emplace_back();
    placed.name = camera.name;
    placed.frame_from_camera = imu_from_left * *camera.frame_from_camera;
  }
  inertial.imus.emplace_back();  // the reference, without further data
  read.files.push_back(inertial);
  return read;
}

}  // namespace evical
