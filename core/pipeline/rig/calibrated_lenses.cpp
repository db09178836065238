#include "core/pipeline/rig/calibrated_lenses.h"

#include "core/base/number.h"
#include "core/data/quality_warning.h"
#include "core/geometry/projection_difference.h"
#include "core/intrinsics/intrinsics_options.h"
#include "core/numerics/angles.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/lens/intrinsics_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace evical {
namespace {

// True if this camera's lens was calibrated alone. Cameras that share a sensor have the lens of the first
// one.
bool isCalibratedAlone(const Session& session, const CalibrationRun& run, std::size_t camera) {
  return session.sensorOf(camera) == camera && camera < run.intrinsics.size() &&
         run.intrinsics[camera].has_value();
}

}  // namespace

std::string adviceOnMovedLens(const CameraIntrinsics& given, const CameraIntrinsics& solved,
                              double noted_deg) {
  const Eigen::Vector2d moved_px = solved.principal_point_px - given.principal_point_px;
  const double turn_deg = kDegPerRad * moved_px.cwiseQuotient(solved.focal_length_px).norm();
  if (turn_deg < noted_deg) return {};
  return fmt::format(
      "the principal point is {:.1f} px from the given one, which turns the camera by {:.2f} deg. If you "
      "trust the given lens, compare with optimisation.model.camera_intrinsics: fixed",
      moved_px.norm(), turn_deg);
}

void setLensSigmas(const Session& session, CalibrationRun& run) {
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    if (!isCalibratedAlone(session, run, k) || run.result.state.cameras[k].lens.solved) continue;
    const IntrinsicsVector sigmas = run.intrinsics[k]->standardDeviations();
    std::copy(sigmas.begin(), sigmas.end(),
              run.result.uncertainty.cameras[k].intrinsics_std.emplace().begin());
  }
}

void addLensNotes(const Session& session, CalibrationRun& run) {
  std::vector<std::string> notes;
  std::string doubt;
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    if (session.sensorOf(k) != k) continue;
    const std::string name = "intrinsics of " + session.cameras[k].name;
    const CameraLens& lens = run.result.state.cameras[k].lens;
    if (isCalibratedAlone(session, run, k)) {
      const IntrinsicsResult found =
          lens.solved ? jointIntrinsics(*run.intrinsics[k], k, *lens.solved, run.result.uncertainty,
                                        *session.options.intrinsics)
                      : *run.intrinsics[k];
      notes.push_back(fmt::format("{}: calibrated from {} in {:.1f} s, projection sigma {:.3f} px", name,
                                  counted(static_cast<std::uint64_t>(found.views_used), "view"),
                                  found.elapsed_s, found.image.rms_px));
      for (const std::string& advice : found.advice) notes.push_back(fmt::format("{}: {}", name, advice));
      if (found.status != CalibrationStatus::Ok && doubt.empty())
        doubt = fmt::format("{}: {}", name, found.reason);
    }
    if (!lens.solved) continue;
    if (lens.given_with) notes.push_back(name + ": estimated, with the given values and sigmas as prior");
    notes.push_back(
        fmt::format("{}: refined in the joint optimisation, which changed the projection by {:.3f} px RMS",
                    name, projectionDifference(*lens.detection_intrinsics, *lens.solved).rms_px));
    const std::string advice = lens.given ? adviceOnMovedLens(*lens.given, *lens.solved,
                                                              session.options.optimisation->moved_lens_deg)
                                          : "";
    if (!advice.empty()) notes.push_back(name + ": " + advice);
  }
  run.result.notes.insert(run.result.notes.begin(), notes.begin(), notes.end());
  flagDoubtful(doubt, run.result, "first_look_at_lens");
}

}  // namespace evical
