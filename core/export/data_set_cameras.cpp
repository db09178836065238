#include "core/export/data_set_cameras.h"

#include "core/base/error.h"
#include "core/export/stereo.h"

#include <fmt/format.h>

namespace evical {
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
  constexpr std::size_t kMostOfAKind = 2;
  for (const Rig* const kind : {&events, &frames})
    for (std::size_t i = kMostOfAKind; i < kind->cameras.size(); ++i)
      notes.push_back(
          fmt::format("{} has two cameras per kind: {} is left out", program, kind->cameras[i].name));
  return placed;
}

}  // namespace evical
