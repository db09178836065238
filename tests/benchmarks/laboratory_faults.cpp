#include "tests/benchmarks/laboratory_faults.h"

#include "tests/support/scenario_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <vector>

namespace evical::benchmarks {
namespace {

// The front end's results are kept, so only faults of later stages are possible.
std::vector<const test::Perturbation*> faultsFor(const Scenario& scenario, int count) {
  std::vector<const test::Perturbation*> all;
  for (const test::Perturbation& each : test::perturbations())
    if (each.stage == test::PerturbedStage::Measurements && !each.causes.empty()) all.push_back(&each);
  std::mt19937_64 dice(scenario.seed);
  std::shuffle(all.begin(), all.end(), dice);
  all.resize(std::min(all.size(), static_cast<std::size_t>(count)));
  return all;
}

// Checks that gave a reason; "refused" if there is no result.
std::vector<std::string> checksOf(const Outcome& outcome) {
  if (!outcome.result) return {"refused"};
  std::vector<std::string> names;
  for (const QualityWarning& cause : outcome.result->causes) names.push_back(cause.name);
  return names;
}

}  // namespace

void LaboratoryFaults::add(const Scenario& scenario, const DetectionResult& detections, const Outcome& valid,
                           int count) {
  ++laboratories_;
  for (const std::string& check : checksOf(valid)) ++checks_[check].false_alarms;
  for (const test::Perturbation* const fault : faultsFor(scenario, count)) {
    test::Recorded recorded{scenario, test::sessionFor(scenario), detections};
    const double size = fault->sizes.back();
    fault->apply(recorded, size);
    const Outcome outcome =
        calibrateSession(recorded.scenario, recorded.session, std::move(recorded.detections));
    addCase(*fault, outcome, valid);
    fmt::print("| {} | {} {:g} {} | {}{} |\n", scenario.name, fault->name, size, fault->unit,
               isWrongOk(outcome) ? "WRONG but " : "", outcome.verdictText());
    std::fflush(stdout);
  }
}

// A result that is doubtful for the same first reason as without the fault has noticed nothing: it counts as
// right if its numbers are.
void LaboratoryFaults::addCase(const test::Perturbation& fault, const Outcome& outcome,
                               const Outcome& valid) {
  Fault& row = faults_[std::string(fault.name)];
  ++row.cases;
  if (isWrongOk(outcome)) {
    ++row.wrong_ok;
    return;
  }
  const std::vector<std::string> checks = checksOf(outcome), before = checksOf(valid);
  const bool as_before = outcome.result && valid.result && checks == before;
  if (outcome.verdict == "ok" || as_before) {
    ++row.right;
    return;
  }
  const bool named = fault.isNamedIn(test::firstReason(outcome.reason));
  ++(named ? row.named : row.other);
  const std::string first = checks.empty() ? "other" : checks.front();
  ++(named ? checks_[first].right : checks_[first].other);
}

bool LaboratoryFaults::print() const {
  fmt::print(
      "\n| fault | cases | corrected or harmless | first reason names it | another first reason | wrong and "
      "ok |\n"
      "|---|---|---|---|---|---|\n");
  bool good = true;
  for (const auto& [name, fault] : faults_) {
    fmt::print("| {} | {} | {} | {} | {} | {} |\n", name, fault.cases, fault.right, fault.named, fault.other,
               fault.wrong_ok);
    good = good && fault.wrong_ok == 0;
  }
  fmt::print(
      "\n| check | alarms in {} laboratories without a fault | first reason that names a fault | first "
      "reason that names "
      "another cause |\n|---|---|---|---|\n",
      laboratories_);
  for (const auto& [name, check] : checks_)
    fmt::print("| {} | {} | {} | {} |\n", name, check.false_alarms, check.right, check.other);
  return good;
}

}  // namespace evical::benchmarks
