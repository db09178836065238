#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/geometry/camera_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace evical {
namespace {

constexpr const char* kDmVioProgram = "DM-VIO";
constexpr KnownModels kDmVioModels{kDmVioProgram, true, false, true};

// Rectified image that DSO creates: a pinhole's, without distortion.
struct Rectified {
  Resolution size_px;
  Eigen::Vector2d least, most;  // x/z and y/z at the middles of its outer pixels
};

// Pyramids end at odd sizes, and with less than 3 levels it "will probably segfault": multiples of 16.
Resolution pyramidSize(const Resolution& sensor) {
  constexpr int kPyramid_px = 16;
  const auto whole = [](int size_px) {
    return size_px < kPyramid_px ? size_px : size_px - size_px % kPyramid_px;
  };
  return {whole(sensor.width_px), whole(sensor.height_px)};
}

// Number of rays on one side of the rectified image that are outside of the camera's image, or not visible.
int outsideOnSide(const CameraIntrinsics& camera, const Rectified& image, int axis, bool most) {
  constexpr int kSteps = 100;
  constexpr double kMargin_px = 0.1;  // for rays between the steps
  int outside = 0;
  for (int i = 0; i <= kSteps; ++i) {
    Eigen::Vector3d ray(0.0, 0.0, 1.0);
    ray[axis] = most ? image.most[axis] : image.least[axis];
    const int along = 1 - axis;
    ray[along] = image.least[along] + (image.most[along] - image.least[along]) * i / kSteps;
    const std::optional<Eigen::Vector2d> pixel = project(camera, ray);
    const bool inside = pixel && pixel->x() > kMargin_px && pixel->y() > kMargin_px &&
                        pixel->x() < camera.resolution_px.width_px - 1.0 - kMargin_px &&
                        pixel->y() < camera.resolution_px.height_px - 1.0 - kMargin_px;
    outside += inside ? 0 : 1;
  }
  return outside;
}

// Largest rectified image within the camera's: it starts at the middles of the image's edges, and its worst
// side is moved inwards until all sides are inside. DSO's "crop" searches along x/z up to 5, where
// polynomials fold back into the image.
Rectified rectifiedImage(const CameraIntrinsics& camera) {
  constexpr double kWithin = 4.0;  // of x/z: 76 degrees
  const Eigen::Vector2d last(camera.resolution_px.width_px - 1.0, camera.resolution_px.height_px - 1.0);
  Rectified image{pyramidSize(camera.resolution_px), {}, {}};
  for (int axis = 0; axis < 2; ++axis) {
    Eigen::Vector2d edge = camera.principal_point_px;
    edge[axis] = 0.0;
    const auto low = unproject(camera, edge);
    image.least[axis] = low ? std::max((*low)[axis], -kWithin) : -kWithin;
    edge[axis] = last[axis];
    const auto high = unproject(camera, edge);
    image.most[axis] = high ? std::min((*high)[axis], kWithin) : kWithin;
  }
  constexpr int kSteps = 2000;  // of half a percent each; an upper limit
  for (int step = 0; step < kSteps; ++step) {
    int worst = 0, worst_axis = 0;
    bool worst_most = false;
    for (int axis = 0; axis < 2; ++axis)
      for (const bool most : {false, true})
        if (const int outside = outsideOnSide(camera, image, axis, most); outside > worst) {
          worst = outside;
          worst_axis = axis;
          worst_most = most;
        }
    if (worst == 0) break;
    const double inward = 0.005 * (image.most - image.least)[worst_axis];
    (worst_most ? image.most : image.least)[worst_axis] += worst_most ? -inward : inward;
  }
  return image;
}

// Four lines, which DSO also reads: lens, size, the rectified camera relative to its image's size, that size.
std::string dmVioCameraText(const CameraIntrinsics& own) {
  const Rectified image = rectifiedImage(own);
  const Eigen::Vector2d size(image.size_px.width_px, image.size_px.height_px);
  const Eigen::Vector2d f = (size.array() - 1.0) / (image.most - image.least).array();
  const Eigen::Vector2d c = -image.least.cwiseProduct(f);
  std::string first_line = own.model == CameraModel::PinholeRadtan ? "RadTan" : "EquiDistant";
  for (const double value : {own.focal_length_px.x(), own.focal_length_px.y(), own.principal_point_px.x(),
                             own.principal_point_px.y()})
    first_line += " " + real(value);
  for (const double value : distortionOf(own, 4)) first_line += " " + real(value);
  return fmt::format("{}\n{} {}\n{} {} {} {} 0.0\n{} {}\n", first_line, own.resolution_px.width_px,
                     own.resolution_px.height_px, real(f.x() / size.x()), real(f.y() / size.y()),
                     real((c.x() + 0.5) / size.x()), real((c.y() + 0.5) / size.y()), image.size_px.width_px,
                     image.size_px.height_px);
}

std::string dmVioNoiseText(const Rig& rig, ExportNotes& notes) {
  const ImuNoise noise = statedNoise(rig.imus[0], notes);
  return headerComment(
             rig, {"Noise densities and random walks for DM-VIO: use settingsFile=noise.yaml, or copy them "
                   "into your own settings. The program's own configurations have values far above "
                   "their sensors': increase these if it diverges."}) +
         fmt::format(
             "accelerometer_noise_density: {}\ngyroscope_noise_density: {}\n"
             "accelerometer_random_walk: {}\ngyroscope_random_walk: {}\n",
             real(noise.accelerometer_density), real(noise.gyroscope_density),
             real(noise.accelerometer_random_walk), real(noise.gyroscope_random_walk));
}

}  // namespace

ExportedFiles exportDmVio(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  const RigCamera& camera = rig.cameras[0];
  noteLostCameras(rig, 1, kDmVioProgram, exported.notes);
  exported.files.push_back({"camera.txt", dmVioCameraText(cameraFor(camera, kDmVioModels, exported.notes))});
  std::vector<std::string> lines{
      "camera.txt (calib=) is for DM-VIO and DSO: lens, size of the images, then the rectified camera in "
      "shares of its size, and that size. Its third line may be crop or none instead.",
      "There is no photometric calibration (gamma=, vignette=) here: without one, mode=1."};
  if (!rig.imus.empty()) {
    noteLostImus(rig, kDmVioProgram, exported.notes);
    noteLostMapping(rig.imus[0], kDmVioProgram, exported.notes);
    exported.files.push_back(
        {"camchain.yaml",
         headerComment(
             rig, {"DM-VIO: imuCalib=camchain.yaml. T_cam_imu transforms points of the IMU to the camera.",
                   stampShifts(rig)}) +
             fmt::format("cam0:  # {}\n  T_cam_imu:\n{}", camera.file_name,
                         rowsYaml(matrixOf(inverse(camera.reference_from_camera)), 4))});
    exported.files.push_back({"noise.yaml", dmVioNoiseText(rig, exported.notes)});
    exported.notes.push_back(stampShifts(rig));
  }
  lines.insert(lines.end(), exported.notes.begin(), exported.notes.end());
  exported.files.push_back({"README.txt", readMe(rig, lines)});
  return exported;
}

}  // namespace evical
