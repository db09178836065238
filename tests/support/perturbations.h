// One thing at a time that a session says wrongly, or that a rig does: for the benchmark evical_benchmarks stress, and for
// tests of verdicts. What the events show is left as it is, so that the front end's work serves for all.
#pragma once

#include "core/pipeline/pass/recording_pass.h"
#include "core/pipeline/session/session.h"
#include "core/synthetic/scenario.h"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace evical::test {

// What is true of a recording, what its session says, and what was measured.
struct Recorded {
  Scenario scenario;
  Session session;
  DetectionResult pass;
};

enum class PerturbedStage {
  Measurements,  // of circles and samples, or what the session says of them
  FrontEnd,      // the session before the front end sees with it
};

struct Perturbation {
  std::string_view name;
  std::string_view unit;
  std::vector<double> sizes;
  // One of these is part of a reason that names the cause, whatever its letters' case.
  std::vector<std::string_view> causes;
  void (*apply)(Recorded& recorded, double size);
  PerturbedStage stage = PerturbedStage::Measurements;

  bool isNamedIn(std::string_view reason) const;
};

std::span<const Perturbation> perturbations();
// The one of this name; throws CalibrationError (BadInput) where there is none.
const Perturbation& perturbation(std::string_view name);

// What a session's time_range_s leaves of it.
void cutTo(const std::array<double, 2>& range_s, Recorded& recorded);

// As the pipeline tells it: several are joined by semicolons, the first is the one that people act on.
std::string_view firstReason(std::string_view reason);

}  // namespace evical::test
