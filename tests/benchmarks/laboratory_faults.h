// Single faults in random laboratories (tests/support/perturbations.h): which checks of the verdict notice
// them, and which checks give false alarms without a fault.
#pragma once

#include "tests/benchmarks/scenario_run.h"
#include "tests/support/perturbations.h"

#include <cstdint>
#include <map>
#include <string>

namespace evical::benchmarks {

class LaboratoryFaults {
 public:
  // Calibrates with `count` faults, drawn for this laboratory. `valid`: its outcome without a fault.
  void add(const Scenario& scenario, const DetectionResult& detections, const Outcome& valid, int count);
  bool print() const;  // false if a wrong result was called ok

 private:
  struct Fault {
    int cases = 0, right = 0, named = 0, other = 0, wrong_ok = 0;
  };
  struct Check {
    int false_alarms = 0, right = 0, other = 0;
  };

  void addCase(const test::Perturbation& fault, const Outcome& outcome, const Outcome& valid);

  std::map<std::string, Fault> faults_;
  std::map<std::string, Check> checks_;
  int laboratories_ = 0;
};

}  // namespace evical::benchmarks
