#include "core/report/repeat_comparison.h"

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

bool isInJoint(const Repeatability& repeat, std::size_t column) {
  const auto found = std::find_if(
      repeat.recordings.begin(), repeat.recordings.end(),
      [&](const RepeatedRecording& recording) { return recording.name == repeat.columns.at(column); });
  return found != repeat.recordings.end() && found->outcome == RepeatOutcome::Fits;
}

}  // namespace

std::optional<ValueWithSigma> numberOf(const RepeatedNumber& number, std::size_t column) {
  if (column == kAllTogether)
    return number.joint_sigma > 0.0 ? std::optional(ValueWithSigma{number.joint, number.joint_sigma})
                                    : std::nullopt;
  if (column >= number.values.size() || !std::isfinite(number.values[column])) return std::nullopt;
  return ValueWithSigma{number.values[column], number.sigmas.at(column)};
}

std::optional<ValueWithSigma> differenceOf(const Repeatability& repeat, const RepeatedNumber& number,
                                           std::size_t a, std::size_t b) {
  const std::optional<ValueWithSigma> left = numberOf(number, a), right = numberOf(number, b);
  if (a == b || !left || !right) return std::nullopt;
  const double squares_left = left->sigma * left->sigma, squares_right = right->sigma * right->sigma;
  const bool part_of_all =
      (a == kAllTogether && isInJoint(repeat, b)) || (b == kAllTogether && isInJoint(repeat, a));
  const double squares = part_of_all ? std::abs(squares_left - squares_right) : squares_left + squares_right;
  return ValueWithSigma{right->value - left->value, std::sqrt(squares)};
}

}  // namespace evical
