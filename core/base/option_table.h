// Rows of one options struct, and text access to them: set from text, validated against type,
// range and each other, listed for users. All values are passed as text, so that session files, --set and
// forms share one code path.
#pragma once

#include "core/base/nearest_name.h"
#include "core/base/option_row.h"

#include <array>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace evical {

// One row per option: name, member, default, range, unit and help. Session files, --set, validation, `evical
// options` and the forms all use these rows. They are defined in the source file of the struct:
//
//   constexpr std::tuple kFields{
//       Field{"plane_radius_px", &NormalFlowOptions::plane_radius_px, 1, within(1, 5), "px", "Half width."},
//       Switch{"quick", &NormalFlowOptions::quick, false, "Fits fewer planes.", Level::Public}};
//   constexpr auto kDefaults = defaultsOf<NormalFlowOptions>(kFields);  // a missing row does not compile
//   NormalFlowOptions::NormalFlowOptions() : NormalFlowOptions(kDefaults) {}
//   const OptionTable<NormalFlowOptions>& NormalFlowOptions::table() {
//     static const OptionTable<NormalFlowOptions> table(kFields);
//     return table;
//   }
template <class Value>
struct Range {
  Value least, most;  // inclusive
};
template <class Value>
constexpr Range<Value> within(Value least, Value most) {
  return {least, most};
}

template <class Options, class Value>
struct Field {
  const char* name;
  Value Options::*member;
  Value initial;
  Range<Value> range;
  const char* unit;
  const char* help;
  Level level = Level::Tuning;
  Applies applies = Applies::Always;
};
template <class Options, class Value>
Field(const char*, Value Options::*, std::type_identity_t<Value>, Range<std::type_identity_t<Value>>,
      const char*, const char*, Level = Level::Tuning, Applies = Applies::Always) -> Field<Options, Value>;

// A boolean option.
template <class Options>
struct Switch {
  const char* name;
  bool Options::*member;
  bool initial;
  const char* help;
  Level level = Level::Tuning;
  Applies applies = Applies::Always;
};
template <class Options>
Switch(const char*, bool Options::*, bool, const char*, Level = Level::Tuning, Applies = Applies::Always)
    -> Switch<Options>;

// One of several words; enumerator i is written as choices[i].
template <class Options, class Enum, std::size_t Count>
struct Choice {
  const char* name;
  Enum Options::*member;
  Enum initial;
  std::array<const char*, Count> choices;
  const char* help;
  Level level = Level::Tuning;
  Applies applies = Applies::Always;
};
template <class Options, class Enum, std::size_t Count>
Choice(const char*, Enum Options::*, std::type_identity_t<Enum>, std::array<const char*, Count>, const char*,
       Level = Level::Tuning, Applies = Applies::Always) -> Choice<Options, Enum, Count>;

// A constraint on two options: the first must not exceed the second.
template <class Options, class Value>
struct Ordered {
  Value Options::*lower;
  Value Options::*upper;
};
template <class Options, class Value>
Ordered(Value Options::*, Value Options::*) -> Ordered<Options, Value>;

template <class Fields, class Visitor>
constexpr void forEachField(const Fields& fields, Visitor&& visit) {
  std::apply([&](const auto&... field) { (visit(field), ...); }, fields);
}

namespace detail {

template <class Options, class Fields>
constexpr void giveDefaults(Options& options, const Fields& fields) {
  forEachField(fields, [&](const auto& field) { options.*field.member = field.initial; });
}

// The comparison reads every member. A member without a row is uninitialised, so the expression is not
// constant and does not compile. (GCC 12 misses that if a function returns the struct, so the defaults are
// set here again.)
template <class Options, class Fields>
constexpr bool giveEveryMember(const Fields& fields) {
  Options options{NoDefaults{}};
  giveDefaults(options, fields);
  const Options copy = options;
  return copy == options;
}

}  // namespace detail

// The defaults; does not compile if a member has no row.
template <class Options, const auto& kFields>
constexpr Options defaultsOf() {
  static_assert(detail::giveEveryMember<Options>(kFields), "every option needs a row");
  Options options{NoDefaults{}};
  detail::giveDefaults(options, kFields);
  return options;
}

namespace detail {

std::string fullName(const OptionRow& row, const std::string& group);
std::string numberText(double value);
std::string numberText(std::int64_t value);

// Throw CalibrationError (BadInput, place `name`) that gives value, bound and unit.
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
std::string textOf(const Field<Options, Value>&, Value value) {
  return textOf(value);
}
template <class Options>
std::string textOf(const Switch<Options>&, bool value) {
  return value ? "true" : "false";
}
template <class Options, class Enum, std::size_t Count>
std::string textOf(const Choice<Options, Enum, Count>& field, Enum value) {
  return field.choices.at(static_cast<std::size_t>(value));
}

template <class Options, class Value>
Value valueOf(const Field<Options, Value>& field, const std::string& name, std::string_view text) {
  if constexpr (std::integral<Value>)
    return static_cast<Value>(parseInteger(name, text, static_cast<std::int64_t>(field.range.least),
                                           static_cast<std::int64_t>(field.range.most), field.unit));
  else
    return static_cast<Value>(parseReal(name, text, field.range.least, field.range.most, field.unit));
}
template <class Options>
bool valueOf(const Switch<Options>&, const std::string& name, std::string_view text) {
  return parseSwitch(name, text);
}
template <class Options, class Enum, std::size_t Count>
Enum valueOf(const Choice<Options, Enum, Count>& field, const std::string& name, std::string_view text) {
  return static_cast<Enum>(parseChoice(name, text, field.choices));
}

template <class Options, class Value>
void describe(const Field<Options, Value>& field, OptionRow& row) {
  row.minimum = textOf(field.range.least);
  row.maximum = textOf(field.range.most);
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

template <class Options>
class OptionTable {
 public:
  template <class Fields, class... Values>
  explicit OptionTable(const Fields& fields, const Ordered<Options, Values>&... orders);

  // Name without group and "tuning."; null if there is no such option.
  const OptionRow* find(std::string_view name) const;

  // `group` is the prefix of names here and in messages ("grid" gives "grid.min_circles"), followed by
  // "tuning." for tuning options; may be empty.
  std::vector<OptionRow> rows(const Options& options, const std::string& group) const;

  // Throws CalibrationError (BadInput) with the option's name, and the problem or the nearest known name.
  // Contradictions between options are found by checkOrder, after all are set.
  void set(Options& options, const std::string& group, std::string_view name, std::string_view text) const;

  // Throws OptionConflict for the first pair whose lower option exceeds the upper one.
  void checkOrder(const Options& options, const std::string& group) const;

 private:
  struct Entry {
    OptionRow row;  // group and value are not set
    std::function<std::string(const Options&)> text;
    std::function<void(Options&, const std::string& full_name, std::string_view)> set;
  };
  struct Order {
    std::size_t lower, upper;  // indices of entries_
    std::function<bool(const Options&)> holds;
  };

  template <class FieldOfTable>
  void add(const FieldOfTable& field);
  template <class Fields, class Value>
  void addOrder(const Fields& fields, const Ordered<Options, Value>& order);
  OptionRow rowOf(const Entry& entry, const Options& options, const std::string& group) const;

  std::vector<Entry> entries_;
  std::vector<Order> orders_;
};

template <class Options>
template <class Fields, class... Values>
OptionTable<Options>::OptionTable(const Fields& fields, const Ordered<Options, Values>&... orders) {
  forEachField(fields, [&](const auto& field) { add(field); });
  (addOrder(fields, orders), ...);
}

template <class Options>
template <class FieldOfTable>
void OptionTable<Options>::add(const FieldOfTable& field) {
  Entry entry;
  entry.row.name = field.name;
  entry.row.default_value = detail::textOf(field, field.initial);
  entry.row.help = field.help;
  entry.row.level = field.level;
  if (field.applies != Applies::Always) entry.row.applies = {field.applies};
  detail::describe(field, entry.row);
  entry.text = [field](const Options& options) { return detail::textOf(field, options.*field.member); };
  entry.set = [field](Options& options, const std::string& full_name, std::string_view text) {
    options.*field.member = detail::valueOf(field, full_name, text);
  };
  entries_.push_back(std::move(entry));
}

template <class Options>
template <class Fields, class Value>
void OptionTable<Options>::addOrder(const Fields& fields, const Ordered<Options, Value>& order) {
  const auto indexOf = [&](Value Options::*member) {
    std::size_t index = 0, found = entries_.size();
    forEachField(fields, [&](const auto& field) {
      if constexpr (std::is_same_v<decltype(field.member), Value Options::*>)
        if (field.member == member) found = index;
      ++index;
    });
    assert(found < entries_.size());
    return found;
  };
  orders_.push_back({indexOf(order.lower), indexOf(order.upper), [order](const Options& options) {
                       return options.*order.lower <= options.*order.upper;
                     }});
}

template <class Options>
const OptionRow* OptionTable<Options>::find(std::string_view name) const {
  for (const Entry& entry : entries_)
    if (entry.row.name == name) return &entry.row;
  return nullptr;
}

template <class Options>
OptionRow OptionTable<Options>::rowOf(const Entry& entry, const Options& options,
                                      const std::string& group) const {
  OptionRow row = entry.row;
  row.value = entry.text(options);
  row.name = detail::fullName(row, group);
  return row;
}

template <class Options>
std::vector<OptionRow> OptionTable<Options>::rows(const Options& options, const std::string& group) const {
  std::vector<OptionRow> rows;
  rows.reserve(entries_.size());
  for (const Entry& entry : entries_) rows.push_back(rowOf(entry, options, group));
  return rows;
}

template <class Options>
void OptionTable<Options>::set(Options& options, const std::string& group, std::string_view name,
                               std::string_view text) const {
  std::vector<std::string> names;
  for (const Entry& entry : entries_) {
    if (entry.row.name == name) return entry.set(options, detail::fullName(entry.row, group), text);
    names.push_back(entry.row.name);
  }
  throw badInput(group + "." + std::string(name), "no such option", nameAdvice(name, names));
}

template <class Options>
void OptionTable<Options>::checkOrder(const Options& options, const std::string& group) const {
  for (const Order& order : orders_)
    if (!order.holds(options))
      throw OptionConflict(rowOf(entries_[order.lower], options, group),
                           rowOf(entries_[order.upper], options, group));
}

// Shared, immutable options for code that only copies them. They are kept by pointer, so that a file that
// copies them does not need their definition and is not rebuilt when they change.
template <class Options>
class SharedOptions {
 public:
  SharedOptions() : options_(std::make_shared<const Options>()) {}  // the defaults

  const Options& operator*() const { return *options_; }
  const Options* operator->() const { return options_.get(); }
  SharedOptions& operator=(Options options) {
    options_ = std::make_shared<const Options>(std::move(options));
    return *this;
  }
  // Copies the options before a change. Do not keep the reference: later copies share it.
  Options& edit() {
    auto copy = std::make_shared<Options>(*options_);
    Options& own = *copy;
    options_ = std::move(copy);
    return own;
  }
  bool operator==(const SharedOptions& other) const {
    return options_ == other.options_ || *options_ == *other.options_;
  }

 private:
  std::shared_ptr<const Options> options_;  // immutable; replaced on change
};

}  // namespace evical
