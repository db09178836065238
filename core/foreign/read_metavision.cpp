// The SDK's loader is closed source; its metavision_mono_calibration writes these keys with OpenCV's
// FileStorage, and OpenCV reads them here.
#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/foreign/opencv_file.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include <algorithm>

namespace evical {
namespace {

ReadFile readMetavisionCamera(const std::filesystem::path& path, const std::string& name) {
  const OpencvFile file(path);
  const Resolution size = file["image_size"].resolution();
  const Eigen::Matrix3d k = file["camera_matrix"].matrix(3, 3);
  const Eigen::RowVectorXd distortion = file["distortion_coefficients"].matrix(1, 5);
  file["overall_rms_reprojection_error"].number();
  file["n_kept_views"].integer();
  ReadCamera camera;
  camera.name = name;
  camera.lens = lensFrom(CameraModel::PinholeRadtan, {k(0, 0), k(1, 1), k(0, 2), k(1, 2)},
                         {distortion.begin(), distortion.end()}, size);
  return {path, {camera}};
}

}  // namespace

ReadBack readMetavision(const std::filesystem::path& folder) {
  const std::string kFile = "intrinsics.json";
  ReadBack read;
  read.max_imus = 0;
  if (pathExists(folder / kFile)) read.files.push_back(readMetavisionCamera(folder / kFile, ""));
  for (const std::filesystem::path& below : filesLike(folder, "", ""))
    if (pathExists(below / kFile))
      read.files.push_back(readMetavisionCamera(below / kFile, below.filename().string()));
  if (read.files.empty()) throw badInput(folder.string(), "has no " + kFile);
  return read;
}

}  // namespace evical
