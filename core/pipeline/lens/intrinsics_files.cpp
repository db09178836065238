#include "core/pipeline/lens/intrinsics_files.h"

#include "core/export/export_text.h"
#include "core/export/kalibr_text.h"
#include "core/pipeline/detection/session_recording.h"
#include "core/report/detections_csv.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace evical {

std::vector<FileContent> intrinsicsFiles(const std::filesystem::path& folder, const NamedIntrinsics& named,
                                         const std::vector<BoardObservations>& seen) {
  const CameraIntrinsics& camera = named.result.intrinsics;
  return {{folder / "intrinsics.yaml", intrinsicsResultYaml(named)},
          {folder / "camera_info.yaml", cameraInfoYaml(named.camera, camera)},
          {folder / "camchain.yaml", camchainYaml(named.stream, camera)},
          {folder / "projection_std.csv", imageMapCsv(named.result.image)},
          {folder / "detections.csv", detectionsCsv(seen)}};
}

NamedIntrinsics namedIntrinsics(const SessionCamera& camera, const IntrinsicsRun& run,
                                const std::string& version) {
  NamedIntrinsics named{camera.name, camera.stream, version, run.result, run.story};
  if (std::string note = reversalNote(camera); !note.empty()) named.notes.push_back(std::move(note));
  for (const RecordingFault& fault : run.detections.faults) named.notes.push_back(fault.text);
  return named;
}

NamedResult lensAsResult(const NamedIntrinsics& named, CameraKind kind) {
  auto result = std::make_shared<CalibrationResult>();
  result->status = named.result.status;
  result->reason = named.result.reason;
  result->state.cameras.emplace_back().lens.solved = named.result.intrinsics;
  CameraUncertainty& uncertainty = result->uncertainty.cameras.emplace_back();
  const IntrinsicsVector sigmas = named.result.standardDeviations();
  std::copy(sigmas.begin(), sigmas.end(), uncertainty.intrinsics_std.emplace().begin());
  result->cameras.emplace_back().reprojection_rms_px = named.result.reprojection_rms_px;
  NamedResult rig;
  rig.reference = named.camera;
  SensorDescription description;
  description.name = named.camera;
  description.stream = named.stream;
  description.kind = kind;
  rig.cameras = {description};
  rig.version = named.version;
  rig.result = std::move(result);
  return rig;
}

}  // namespace evical
