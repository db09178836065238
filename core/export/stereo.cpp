#include "core/export/stereo.h"

#include "core/export/export_text.h"

#include "core/base/error.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/so3.h"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical {
namespace {

// Mean of the image corners in normalised rectified coordinates.
Eigen::Vector2d cornersMean(const CameraIntrinsics& camera, const Eigen::Matrix3d& rectified_from_camera) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (const double x : {0.0, camera.resolution_px.width_px - 1.0})
    for (const double y : {0.0, camera.resolution_px.height_px - 1.0})
      if (const auto ray = unproject(camera, {x, y})) {
        sum += (rectified_from_camera * ray->homogeneous()).hnormalized();
        ++count;
      }
  return count == 0 ? sum : Eigen::Vector2d(sum / count);
}

}  // namespace

std::optional<StereoPair> sideBySide(const Rig& rig) {
  if (rig.cameras.size() < 2) return std::nullopt;
  StereoPair pair{rig.cameras[0], rig.cameras[1], {}};
  const RigidTransform second_from_first =
      inverse(rig.cameras[1].reference_from_camera) * rig.cameras[0].reference_from_camera;
  const Eigen::Matrix3d half = so3Exp(0.5 * so3Log(second_from_first.rotation.toRotationMatrix()));
  const Eigen::Vector3d baseline = half.transpose() * second_from_first.translation_m;
  if (!(std::abs(baseline.x()) > std::max(std::abs(baseline.y()), std::abs(baseline.z()))))
    return std::nullopt;
  if (baseline.x() > 0.0) std::swap(pair.left, pair.right);
  pair.right_from_left = inverse(pair.right.reference_from_camera) * pair.left.reference_from_camera;
  return pair;
}

StereoPair stereoPair(const Rig& rig, const char* program) {
  if (rig.cameras.size() < 2)
    throw badInput("result", fmt::format("has one camera, and {} requires two", program),
                   fmt::format("Omit the target {}, or calibrate two cameras", program));
  std::optional<StereoPair> pair = sideBySide(rig);
  if (!pair)
    throw badInput("result",
                   fmt::format("{} and {} are not side by side, as {} requires", rig.cameras[0].name,
                               rig.cameras[1].name, program),
                   fmt::format("Omit the target {}", program));
  return *std::move(pair);
}

Eigen::Matrix3d essentialMatrix(const RigidTransform& second_from_first) {
  return skew(second_from_first.translation_m) * second_from_first.rotation.toRotationMatrix();
}

Eigen::Matrix3d fundamentalMatrix(const CameraIntrinsics& first, const CameraIntrinsics& second,
                                  const RigidTransform& second_from_first) {
  return cameraMatrix(second).inverse().transpose() * essentialMatrix(second_from_first) *
         cameraMatrix(first).inverse();
}

Rectification rectify(const CameraIntrinsics& left, const CameraIntrinsics& right,
                      const RigidTransform& right_from_left) {
  const Eigen::Matrix3d half = so3Exp(0.5 * so3Log(right_from_left.rotation.toRotationMatrix()));
  const Eigen::Vector3d baseline = half.transpose() * right_from_left.translation_m;
  const Eigen::Vector3d axis(baseline.x() < 0.0 ? -1.0 : 1.0, 0.0, 0.0);
  const Eigen::Matrix3d level = rotationBetween(baseline, axis).toRotationMatrix();
  Rectification result;
  result.rectified_from_left = level * half;
  result.rectified_from_right = level * half.transpose();
  const double focal_px = std::min(left.focal_length_px.mean(), right.focal_length_px.mean());
  const Eigen::Vector2d middle =
      0.5 * (cornersMean(left, result.rectified_from_left) + cornersMean(right, result.rectified_from_right));
  const Eigen::Vector2d image_middle(0.5 * (left.resolution_px.width_px - 1.0),
                                     0.5 * (left.resolution_px.height_px - 1.0));
  const Eigen::Vector2d principal_px = image_middle - focal_px * middle;
  result.left_projection << focal_px, 0.0, principal_px.x(), 0.0, 0.0, focal_px, principal_px.y(), 0.0, 0.0,
      0.0, 1.0, 0.0;
  result.right_projection = result.left_projection;
  result.right_projection(0, 3) = focal_px * axis.x() * baseline.norm();
  return result;
}

namespace {

// Cameras of one kind, as a separate rig.
Rig rigOfKind(const Rig& rig, bool frames) {
  Rig own = rig;
  std::erase_if(own.cameras,
                [&](const RigCamera& camera) { return (camera.kind == CameraKind::Frames) != frames; });
  return own;
}

void dataSetCamerasPlace(const Rig& rig, const char* program, std::optional<RigCamera>& left,
                         std::optional<RigCamera>& right) {
  if (rig.cameras.size() == 1) left = rig.cameras.front();
  if (rig.cameras.size() < 2) return;
  StereoPair pair = stereoPair(rig, program);
  left = std::move(pair.left);
  right = std::move(pair.right);
}

std::string placeDataSetCamerasText(const char* name, const std::optional<RigCamera>& camera) {
  return fmt::format("{}: {}", name, camera ? camera->name : "none");
}

}  // namespace

DataSetCameras dataSetCameras(const Rig& rig, const char* program, ExportNotes& notes) {
  const Rig events = rigOfKind(rig, false), frames = rigOfKind(rig, true);
  if (events.cameras.empty())
    throw badInput("result", fmt::format("has no event camera, which {} requires", program),
                   fmt::format("Omit the target {}", program));
  DataSetCameras placed;
  dataSetCamerasPlace(events, program, placed.left_event, placed.right_event);
  dataSetCamerasPlace(frames, program, placed.left_frame, placed.right_frame);
  notes.push_back(fmt::format("{} identifies cameras by their places: {}, {}, {}, {}", program,
                              placeDataSetCamerasText("left event camera", placed.left_event),
                              placeDataSetCamerasText("right event camera", placed.right_event),
                              placeDataSetCamerasText("left frame camera", placed.left_frame),
                              placeDataSetCamerasText("right frame camera", placed.right_frame)));
  constexpr std::size_t kMaxOfAKind = 2;
  for (const Rig* const kind : {&events, &frames})
    for (std::size_t i = kMaxOfAKind; i < kind->cameras.size(); ++i)
      notes.push_back(
          fmt::format("{} has two cameras per kind: {} is left out", program, kind->cameras[i].name));
  return placed;
}

}  // namespace evical
