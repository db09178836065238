#include "core/pipeline/maintain/changed_reference.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace evical {
namespace {

constexpr double kTogether_s = 3.0;  // accuracy of the times of steps

bool isAlike(const MaintenanceStep& a, const MaintenanceStep& b) {
  return a.quantity == b.quantity && a.against == b.against && std::abs(a.at_s - b.at_s) <= kTogether_s;
}

std::set<std::string> sensorsAgainst(const Maintenance& maintenance, const std::string& reference) {
  std::set<std::string> sensors;
  for (const MaintenanceTrack& track : maintenance.tracks)
    if (track.against == reference) sensors.insert(track.sensor);
  return sensors;
}

// The step that was detected first, with the most accurate size.
MaintenanceStep stepOfReference(const std::vector<MaintenanceStep>& alike) {
  MaintenanceStep step = *std::min_element(alike.begin(), alike.end(), [](const auto& a, const auto& b) {
    return a.change_sigma < b.change_sigma;
  });
  for (const MaintenanceStep& each : alike) step.noticed_s = std::min(step.noticed_s, each.noticed_s);
  step.sensor = step.against;
  step.against.clear();
  step.numbers.clear();
  return step;
}

}  // namespace

void nameChangedReference(Maintenance& maintenance) {
  std::vector<MaintenanceStep> left = maintenance.steps, named;
  while (!left.empty()) {
    const MaintenanceStep first = left.front();
    const auto others = std::stable_partition(left.begin(), left.end(),
                                              [&](const auto& step) { return isAlike(step, first); });
    const std::vector<MaintenanceStep> alike(left.begin(), others);
    left.erase(left.begin(), others);
    std::set<std::string> sensors;
    for (const MaintenanceStep& step : alike) sensors.insert(step.sensor);
    const std::set<std::string> all = sensorsAgainst(maintenance, first.against);
    if (all.size() > 1 && sensors == all)
      named.push_back(stepOfReference(alike));
    else
      named.insert(named.end(), alike.begin(), alike.end());
  }
  maintenance.steps = named;
}

}  // namespace evical
