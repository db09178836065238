#include "core/foreign/lens_files.h"

#include "core/base/error.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <system_error>

namespace evical {
namespace {

// A layout is recognised by keys that only its files have.
struct Layout {
  const char* name;
  std::initializer_list<std::string_view> keys;
  ReadFile (*read)(const std::filesystem::path& file);
};

const std::initializer_list<Layout> kLayouts = {
    {"a basalt calibration (also TUM-VIE)", {"\"value0\"", "\"camera_type\""}, readBasaltFile},
    {"dv-processing's calibration", {"\"distortionModel\"", "\"focalLength\""}, readDvProcessingFile},
    {"a camodocal camera (VINS)", {"model_type:", "projection_parameters:"}, readVinsCameraFile},
    {"settings of ORB-SLAM", {"Camera1.fx:"}, readOrbSlam3File},
    {"settings of ORB-SLAM", {"Camera.fx:", "Camera.cx:"}, readOrbSlam3File},
    {"a camera rig of SVO or Ultimate SLAM", {"T_B_C:", "cameras:", "label:"}, readSvoFile},
    {"DSEC's cam_to_cam.yaml", {"cam0:", "camera_matrix:", "distortion_coeffs:"}, readDsecFile},
    {"eKalibr's results", {"CalibParam:", "INTRI:"}, readEkalibrFile},
    {"a camera of DSO or DM-VIO", {"RadTan "}, readDsoCameraFile},
    {"a camera of DSO or DM-VIO", {"EquiDistant "}, readDsoCameraFile},
    {"a camera of DSO or DM-VIO", {"KannalaBrandt "}, readDsoCameraFile},
    {"an OpenCV XML calibration (also DV)", {"<opencv_storage>"}, readOpencvFile},
    {"an OpenCV JSON calibration (also Metavision 4)", {"\"opencv-matrix\""}, readOpencvFile},
    {"an OpenCV YAML calibration", {"!!opencv-matrix"}, readOpencvFile}};

// The text of a file; empty for folders and for files that are too large.
std::string smallText(const std::filesystem::path& file) {
  constexpr std::uintmax_t kLargest_bytes = 16 << 20;  // basalt's files contain vignettes
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  if (std::filesystem::file_size(file, error) > kLargest_bytes || error) return {};
  return textOf(file);
}

bool isOf(const Layout& layout, const std::string& text) {
  // Files of DSO have no keys. Their first word is the model.
  if (layout.read == readDsoCameraFile) return text.starts_with(*layout.keys.begin());
  return std::all_of(layout.keys.begin(), layout.keys.end(),
                     [&](std::string_view key) { return text.find(key) != std::string::npos; });
}

// ROS files name the model. They are read elsewhere.
bool isOfRos(const std::string& text) {
  const auto has = [&](const char* key) { return text.find(key) != std::string::npos; };
  return has("distortion_model") && has("camera_matrix") && !has("distortion_coeffs:") &&
         !has("<opencv_storage>") && !has("opencv-matrix");
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
    throw badInput(file.string(), std::string("read as ") + layout->name + ", but has no complete camera",
                   "Give a file with a camera's intrinsics: its matrix and its distortion");
  return found;
}

std::string lensLayouts() {
  return "basalt, TUM-VIE, DSEC, SVO, Ultimate SLAM, VINS (camodocal), Kimera, EuRoC, ORB-SLAM, DSO, "
         "dv-processing, DV, Metavision 4, OpenCV, eKalibr, Kalibr, OpenVINS, ROS (camera_info, ost.txt) or "
         "an OAK";
}

}  // namespace evical
