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
#pragma once

#include "core/base/option_row.h"
#include "core/base/option_struct.h"

#include <array>
#include <cstddef>
#include <tuple>
#include <type_traits>

namespace evical {

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

}  // namespace evical
