#include "core/base/option_table.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

namespace evical {
namespace {

std::string withUnit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

std::string conflictText(const OptionRow& lower, const OptionRow& upper) {
  return fmt::format("{} ({}) is above {} ({})", lower.name, withUnit(lower.value, lower.unit), upper.name,
                     withUnit(upper.value, upper.unit));
}

std::string conflictAdvice(const OptionRow& lower, const OptionRow& upper) {
  return fmt::format("Set {} to at most {}, or {} to at least {}", lower.name,
                     withUnit(upper.value, upper.unit), upper.name, withUnit(lower.value, lower.unit));
}

}  // namespace

OptionConflict::OptionConflict(const OptionRow& lower, const OptionRow& upper)
    : CalibrationError(ErrorKind::BadInput, "options", conflictText(lower, upper),
                       conflictAdvice(lower, upper)),
      lower_(lower.name),
      upper_(upper.name) {}

namespace detail {
namespace {

// Parses all of `text` as a number; false if it is not one. from_chars: no locale, no blanks, no hexadecimal.
template <class Number>
bool parseWhole(std::string_view text, Number& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && !text.empty();
}

// For values that are too large: the units in which data sheets and rulers have them.
std::string otherUnits(const std::string& unit) {
  if (unit == "m") return "; 50 mm are 0.05 m";
  if (unit == "rad/s/sqrt(Hz)") return "; multiply deg/s/sqrt(Hz) by 0.01745, and deg/h/sqrt(Hz) by 4.848e-6";
  if (unit == "m/s^2/sqrt(Hz)") return "; multiply micro-g/sqrt(Hz) by 9.81e-6, and mg/sqrt(Hz) by 9.81e-3";
  return "";
}

template <class Number>
void checkRange(const std::string& name, Number value, Number minimum, Number maximum, const char* unit) {
  if (value >= minimum && value <= maximum) return;
  const bool below = value < minimum;
  throw badInput(
      name,
      fmt::format("{} is {} the {} of {}", withUnit(numberText(value), unit), below ? "below" : "above",
                  below ? "minimum" : "maximum", withUnit(numberText(below ? minimum : maximum), unit)),
      fmt::format("Give a value from {} to {}{}", numberText(minimum), withUnit(numberText(maximum), unit),
                  below ? "" : otherUnits(unit)));
}

}  // namespace

std::string fullName(const OptionRow& row, const std::string& group) {
  if (group.empty()) return row.name;
  return fmt::format("{}{}.{}", row.level == Level::Tuning ? kTuning : "", group, row.name);
}

std::string numberText(double value) {
  return fmt::format("{}", value);
}
std::string numberText(std::int64_t value) {
  return fmt::format("{}", value);
}

template <class Number>
std::string rangeText(const char* what, Number minimum, Number maximum, const char* unit) {
  if (minimum == std::numeric_limits<Number>::lowest() && maximum == std::numeric_limits<Number>::max())
    return fmt::format("Give {}", what);
  return fmt::format("Give {} from {} to {}", what, minimum, withUnit(numberText(maximum), unit));
}

double parseReal(const std::string& name, std::string_view text, double minimum, double maximum,
                 const char* unit) {
  double value = 0.0;
  if (!parseWhole(text, value) || !std::isfinite(value))
    throw badInput(name, fmt::format("'{}' is not a number", text),
                   rangeText("a number", minimum, maximum, unit));
  checkRange(name, value, minimum, maximum, unit);
  return value;
}

std::int64_t parseInteger(const std::string& name, std::string_view text, std::int64_t minimum,
                          std::int64_t maximum, const char* unit) {
  std::int64_t value = 0;
  if (!parseWhole(text, value))
    throw badInput(name, fmt::format("'{}' is not a whole number", text),
                   rangeText("a whole number", minimum, maximum, unit));
  checkRange(name, value, minimum, maximum, unit);
  return value;
}

bool parseSwitch(const std::string& name, std::string_view text) {
  for (const char* word : {"true", "on", "yes", "1"})
    if (text == word) return true;
  for (const char* word : {"false", "off", "no", "0"})
    if (text == word) return false;
  throw badInput(name, fmt::format("'{}' is neither true nor false", text), "Give true or false");
}

std::size_t parseChoice(const std::string& name, std::string_view text,
                        std::span<const char* const> choices) {
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (text == choices[i]) return i;
  const std::vector<std::string> known(choices.begin(), choices.end());
  const std::string nearest = nearestName(text, known);
  throw badInput(name,
                 fmt::format("'{}' is not {}{}", text, known.size() == 1 ? "" : "one of ", joined(known)),
                 nearest.empty() ? "" : fmt::format("Did you mean '{}'?", nearest));
}

}  // namespace detail
}  // namespace evical
