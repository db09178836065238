// Single errors of a session or of a rig, for the benchmark evical_benchmarks stress, and for tests of
// verdicts. The events are not changed, so that all share the front end's results.
#pragma once

#include "core/data/mirroring.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/session/session.h"
#include "core/synthetic/scenario.h"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace evical::test {

// The truth of a recording, its session, and the measurements.
struct Recorded {
  Scenario scenario;
  Session session;
  DetectionResult detections;
};

enum class PerturbedStage {
  Measurements,  // of circles and samples, or of their description in the session
  FrontEnd,      // of the session before the front end uses it
};

struct Perturbation {
  std::string_view name;
  std::string_view unit;
  std::vector<double> sizes;
  // A reason that names the cause contains one of these, in any letter case.
  std::vector<std::string_view> causes;
  void (*apply)(Recorded& recorded, double size);
  PerturbedStage stage = PerturbedStage::Measurements;

  bool isNamedIn(std::string_view reason) const;
};

std::span<const Perturbation> perturbations();
// The perturbation of this name; throws CalibrationError (BadInput) if there is none.
const Perturbation& perturbation(std::string_view name);

// Mirrors a camera's image, as a driver may do: its observations, and its lens unless `same_lens`. Another
// mirror image of the board is found in it, if there is one: nothing of a board with tags is.
void mirrorImage(Mirroring how, std::size_t camera, bool same_lens, Session& session,
                 DetectionResult& detections);

// Restricts it to a session's time_range_s.
void cutTo(const std::array<double, 2>& range_s, Recorded& recorded);

// In the pipeline's form: several are joined by semicolons, and the first is the one to act on.
std::string_view firstReason(std::string_view reason);

}  // namespace evical::test
