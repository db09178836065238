#include "core/report/export/read_back/lens_files.h"

#include "core/base/error.h"
#include "core/report/export/read_back/read_numbers.h"
#include "core/report/export/read_back/readers.h"

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <system_error>

namespace evical {
namespace {

// A layout is known by keys that its files hold together, and others do not.
struct Layout {
  const char* name;
  std::initializer_list<std::string_view> keys;
  ReadFile (*read)(const std::filesystem::path& file);
};

const std::initializer_list<Layout> kLayouts = {
    {"basalt's calibration, as TUM-VIE has it", {"\"value0\"", "\"camera_type\""}, readBasaltFile},
    {"dv-processing's calibration", {"\"distortionModel\"", "\"focalLength\""}, readDvProcessingFile},
    {"a camera of camodocal, as VINS has it", {"model_type:", "projection_parameters:"}, readVinsCameraFile},
    {"settings of ORB-SLAM", {"Camera1.fx:"}, readOrbSlam3File},
    {"settings of ORB-SLAM", {"Camera.fx:", "Camera.cx:"}, readOrbSlam3File},
    {"a camera rig of SVO or Ultimate SLAM", {"T_B_C:", "cameras:", "label:"}, readSvoFile},
    {"DSEC's cam_to_cam.yaml", {"cam0:", "camRect0:"}, readDsecFile},
    {"eKalibr's results", {"CalibParam:", "INTRI:"}, readEkalibrFile},
    {"a camera of DSO or DM-VIO", {"RadTan "}, readDsoCameraFile},
    {"a camera of DSO or DM-VIO", {"EquiDistant "}, readDsoCameraFile},
    {"a calibration in OpenCV's XML, as DV has it", {"<opencv_storage>"}, readOpencvFile},
    {"a calibration in OpenCV's JSON, as Metavision 4 has it", {"\"opencv-matrix\""}, readOpencvFile},
    {"a calibration in OpenCV's YAML", {"!!opencv-matrix"}, readOpencvFile}};

// Of a file that may be one; nothing of large ones and of folders.
std::string smallText(const std::filesystem::path& file) {
  constexpr std::uintmax_t kLargest_bytes = 16 << 20;  // basalt's files hold vignettes
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  if (std::filesystem::file_size(file, error) > kLargest_bytes || error) return {};
  return textOf(file);
}

bool isOf(const Layout& layout, const std::string& text) {
  // What DSO reads has no keys: its first word is the model.
  if (layout.read == readDsoCameraFile) return text.starts_with(*layout.keys.begin());
  return std::all_of(layout.keys.begin(), layout.keys.end(),
                     [&](std::string_view key) { return text.find(key) != std::string::npos; });
}

// ROS and its relatives name the model; those are read with their kin.
bool isOfRos(const std::string& text) {
  return text.find("distortion_model") != std::string::npos &&
         text.find("camera_matrix") != std::string::npos && text.find("camRect0:") == std::string::npos;
}

}  // namespace

std::optional<LensFile> readLensFile(const std::filesystem::path& file) {
  const std::string text = smallText(file);
  if (text.empty() || isOfRos(text)) return std::nullopt;
  const auto layout =
      std::find_if(kLayouts.begin(), kLayouts.end(), [&](const Layout& each) { return isOf(each, text); });
  if (layout == kLayouts.end()) return std::nullopt;
  LensFile found{layout->name, layout->read(file)};
  std::erase_if(found.read.cameras, [](const ReadCamera& camera) { return !camera.lens; });
  if (found.read.cameras.empty())
    throw badInput(file.string(), std::string("is ") + layout->name + ", but holds no camera",
                   "Give a file with a camera's intrinsics");
  return found;
}

std::string lensLayouts() {
  return "basalt, TUM-VIE, DSEC, SVO, Ultimate SLAM, VINS (camodocal), Kimera, EuRoC, ORB-SLAM, DSO, "
         "dv-processing, DV, Metavision 4, OpenCV, eKalibr, Kalibr, OpenVINS, ROS (camera_info, ost.txt) or "
         "an OAK";
}

}  // namespace evical
