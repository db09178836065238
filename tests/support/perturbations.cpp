#include "tests/support/perturbations.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "tests/support/perturbing.h"

#include <algorithm>
#include <cctype>

namespace evical::test {
namespace {

void nothing(Recorded&, double) {}

const std::vector<Perturbation>& table() {
  static const std::vector<Perturbation> all = [] {
    std::vector<Perturbation> rows = {{"none", "", {0}, {}, nothing}};
    for (const auto& part :
         {boardPerturbations(), cameraPerturbations(), clockPerturbations(), imuPerturbations()})
      rows.insert(rows.end(), part.begin(), part.end());
    return rows;
  }();
  return all;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

}  // namespace

bool Perturbation::isNamedIn(std::string_view reason) const {
  const std::string text = lower(reason);
  return std::any_of(causes.begin(), causes.end(),
                     [&](std::string_view cause) { return text.find(lower(cause)) != std::string::npos; });
}

std::span<const Perturbation> perturbations() {
  return table();
}

const Perturbation& perturbation(std::string_view name) {
  for (const Perturbation& each : table())
    if (each.name == name) return each;
  std::string names;
  for (const Perturbation& each : table()) names += (names.empty() ? "" : ", ") + std::string(each.name);
  throw badInput("perturbation", "there is none called " + std::string(name), "There are " + names);
}

void cutTo(const std::array<double, 2>& range_s, Recorded& recorded) {
  const auto isOutside = [&](double time_s) { return time_s < range_s[0] || time_s > range_s[1]; };
  for (BoardObservations& camera : recorded.detections.cameras) {
    std::erase_if(camera.views, [&](const BoardView& view) { return isOutside(view.time_s); });
    std::erase_if(camera.windows, [&](const auto& window) { return isOutside(window.time_s); });
  }
  for (ImuData& imu : recorded.detections.imus)
    std::erase_if(imu.samples, [&](const ImuSample& sample) {
      return isOutside(secondsSince(recorded.detections.start_ns, sample.time_ns));
    });
}

std::string_view firstReason(std::string_view reason) {
  return reason.substr(0, reason.find("; "));
}

}  // namespace evical::test
