#include "core/base/error.h"

#include <fmt/format.h>

#include <utility>

namespace evical {
namespace {

std::string wholeMessage(const std::string& place, const std::string& problem, const std::string& advice) {
  std::string text = place.empty() ? problem : fmt::format("{}: {}", place, problem);
  if (!advice.empty()) text += fmt::format(". {}", advice);
  return text;
}

}  // namespace

CalibrationError::CalibrationError(ErrorKind kind, std::string place, std::string problem, std::string advice)
    : std::runtime_error(wholeMessage(place, problem, advice)),
      kind_(kind),
      place_(std::move(place)),
      problem_(std::move(problem)),
      advice_(std::move(advice)) {}

CalibrationError CalibrationError::repairedBy(std::optional<Repair> repair) && {
  repair_ = std::move(repair);
  return std::move(*this);
}

CalibrationError badInput(std::string place, std::string problem, std::string advice) {
  return {ErrorKind::BadInput, std::move(place), std::move(problem), std::move(advice)};
}

CalibrationError calibrationFailed(std::string place, std::string problem, std::string advice) {
  return {ErrorKind::CalibrationFailed, std::move(place), std::move(problem), std::move(advice)};
}

}  // namespace evical
