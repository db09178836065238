// Option structs by their tables of rows (option_field.h): set from text, checked against type and range,
// listed for people. All values travel as text here, so session files, --set and forms share one way in.
#pragma once

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/option_field.h"

#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace evical {

// One option as text; minimum and maximum are empty for switches and choices, whose words `choices` gives.
struct OptionRow {
  std::string name, default_value, value, minimum, maximum, unit, help;
  std::vector<std::string> choices;
};

namespace detail {

std::string numberText(double value);
std::string numberText(std::int64_t value);

// Throw CalibrationError (BadInput, place `name`) that names value, bound and unit.
double parseReal(const std::string& name, std::string_view text, double minimum, double maximum,
                 const char* unit);
std::int64_t parseInteger(const std::string& name, std::string_view text, std::int64_t minimum,
                          std::int64_t maximum, const char* unit);
bool parseSwitch(const std::string& name, std::string_view text);
std::size_t parseChoice(const std::string& name, std::string_view text, std::span<const char* const> choices);

template <std::floating_point T>
std::string textOf(T value) {
  return numberText(static_cast<double>(value));
}
template <std::integral T>
std::string textOf(T value) {
  return numberText(static_cast<std::int64_t>(value));
}

template <class Options, class Value>
std::string textOf(const Field<Options, Value>& field, const Options& options) {
  return textOf(options.*field.member);
}
template <class Options>
std::string textOf(const Switch<Options>& field, const Options& options) {
  return options.*field.member ? "true" : "false";
}
template <class Options, class Enum, std::size_t Count>
std::string textOf(const Choice<Options, Enum, Count>& field, const Options& options) {
  return field.choices.at(static_cast<std::size_t>(options.*field.member));
}

template <class Options, class Value>
void setFromText(const Field<Options, Value>& field, Options& options, const std::string& name,
                 std::string_view text) {
  if constexpr (std::integral<Value>)
    options.*field.member =
        static_cast<Value>(parseInteger(name, text, static_cast<std::int64_t>(field.minimum),
                                        static_cast<std::int64_t>(field.maximum), field.unit));
  else
    options.*field.member =
        static_cast<Value>(parseReal(name, text, field.minimum, field.maximum, field.unit));
}
template <class Options>
void setFromText(const Switch<Options>& field, Options& options, const std::string& name,
                 std::string_view text) {
  options.*field.member = parseSwitch(name, text);
}
template <class Options, class Enum, std::size_t Count>
void setFromText(const Choice<Options, Enum, Count>& field, Options& options, const std::string& name,
                 std::string_view text) {
  options.*field.member = static_cast<Enum>(parseChoice(name, text, field.choices));
}

template <class Options, class Value>
void describe(const Field<Options, Value>& field, OptionRow& row) {
  row.minimum = textOf(field.minimum);
  row.maximum = textOf(field.maximum);
  row.unit = field.unit;
}
template <class Options>
void describe(const Switch<Options>&, OptionRow& row) {
  row.choices = {"false", "true"};
}
template <class Options, class Enum, std::size_t Count>
void describe(const Choice<Options, Enum, Count>& field, OptionRow& row) {
  row.choices.assign(field.choices.begin(), field.choices.end());
}

}  // namespace detail

template <class Fields>
std::vector<std::string> optionNames(const Fields& fields) {
  std::vector<std::string> names;
  forEachField(fields, [&](const auto& field) { names.emplace_back(field.name); });
  return names;
}

// `group` precedes the name in messages ("grid" gives "grid.least_sine"); empty for none.
template <class Options, class Fields>
void setOption(Options& options, const Fields& fields, const std::string& group, std::string_view name,
               std::string_view text) {
  const std::string full = group.empty() ? std::string(name) : group + "." + std::string(name);
  bool found = false;
  forEachField(fields, [&](const auto& field) {
    if (name != field.name) return;
    found = true;
    detail::setFromText(field, options, full, text);
  });
  if (!found) throw badInput(full, "no such option", nameAdvice(name, optionNames(fields)));
}

template <class Options, class Fields>
std::vector<OptionRow> optionRows(const Options& options, const Fields& fields, const std::string& group) {
  const Options defaults{};
  std::vector<OptionRow> rows;
  forEachField(fields, [&](const auto& field) {
    OptionRow row;
    row.name = group.empty() ? field.name : group + "." + field.name;
    row.default_value = detail::textOf(field, defaults);
    row.value = detail::textOf(field, options);
    row.help = field.help;
    detail::describe(field, row);
    rows.push_back(std::move(row));
  });
  return rows;
}

}  // namespace evical
