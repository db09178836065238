#include "core/report/truth_comparison.h"

#include "core/geometry/so3.h"
#include "core/numerics/angles.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace evical {
namespace {

constexpr double kMmPerM = 1e3, kMsPerS = 1e3;

CameraError sizeOfError(const std::string& name, const CameraState& estimate, const CameraState& truth) {
  const RigidTransform &found = estimate.reference_from_camera, &actual = truth.reference_from_camera;
  return {name, kDegPerRad * quaternionLog(found.rotation * actual.rotation.conjugate()).norm(),
          kMmPerM * (found.translation_m - actual.translation_m).norm(),
          kMsPerS * std::abs(estimate.time_offset_s - truth.time_offset_s)};
}

}  // namespace

Estimate estimateOf(const NamedResult& named) {
  const CalibrationState& state = named.result->state;
  Estimate estimate{named.reference,
                    sensorNames(named.cameras),
                    sensorNames(named.imus),
                    state.cameras,
                    state.imus,
                    named.boards,
                    {state.board},
                    state.gravity_in_world_m_s2,
                    named.result->uncertainty};
  estimate.boards.insert(estimate.boards.end(), state.further_boards.begin(), state.further_boards.end());
  estimate.uncertainty.cameras.resize(estimate.cameras.size());
  estimate.uncertainty.imus.resize(estimate.imus.size());
  estimate.uncertainty.further_boards.resize(state.further_boards.size());
  return estimate;
}

TruthComparison compareWithTruth(const NamedResult& result, const NamedResult& truth) {
  const Estimate estimate = estimateOf(result);
  MatchedEstimate matched = matchedByPlace(estimate, estimateOf(truth));
  const Estimate& actual = matched.estimate;
  TruthComparison comparison;
  comparison.notes = std::move(matched.notes);
  comparison.quantities = difference(estimate, actual);
  for (std::size_t i = 0; i < estimate.cameras.size(); ++i) {
    const std::string& name = estimate.camera_names.at(i);
    const std::size_t j = sensorIndex(name, actual.camera_names, "cameras");
    comparison.cameras.push_back(sizeOfError(name, estimate.cameras[i], actual.cameras.at(j)));
  }
  comparison.gravity_direction_deg = kDegPerRad * gravityDirectionDifference_rad(estimate, actual);
  return comparison;
}

std::string comparisonTable(const TruthComparison& comparison) {
  std::string text;
  for (const std::string& note : comparison.notes) text += fmt::format("note: {}\n", note);
  text += fmt::format("{:<40}{:>14}{:>14}{:>14}\n", "quantity", "error", "sigma", "error/sigma");
  for (const QuantityDifference& q : comparison.quantities) {
    const std::string name = q.unit.empty() ? q.name : fmt::format("{} [{}]", q.name, q.unit);
    text += q.sigma > 0.0 ? fmt::format("{:<40}{:>14.6f}{:>14.6f}{:>14.2f}\n", name, q.difference, q.sigma,
                                        q.normalised())
                          : fmt::format("{:<40}{:>14.6f}{:>14}{:>14}\n", name, q.difference, "-", "-");
  }
  text += fmt::format("{:<40}{:>14.6f}\n", "gravity direction [deg]", comparison.gravity_direction_deg);
  for (const CameraError& camera : comparison.cameras)
    text += fmt::format("{}: errors: rotation {:.4f} deg, translation {:.3f} mm, time offset {:.4f} ms\n",
                        camera.name, camera.rotation_deg, camera.translation_mm, camera.time_offset_ms);
  return text + fmt::format("normalised errors: RMS {:.2f} (1 if the sigmas are correct)\n",
                            comparison.normalisedRms());
}

}  // namespace evical
