// One row per option: the struct holds the default, the row holds name, member, range, unit and help. Session
// files,
// --set, validation, `evical options` and the forms all walk these rows.
//
//   struct NormalFlowOptions {
//     int plane_radius_px = 1;
//     bool operator==(const NormalFlowOptions&) const = default;
//   };
//   inline constexpr auto kNormalFlowFields = std::tuple{
//       Field{"plane_radius_px", &NormalFlowOptions::plane_radius_px, 1, 5, "px", "Half width of the
//       plane-fit window."}};
//   static_assert(fieldCount<NormalFlowOptions>() == std::tuple_size_v<decltype(kNormalFlowFields)>);
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace evical {

// A number with an inclusive range.
template <class Options, class Value>
struct Field {
  const char* name;
  Value Options::*member;
  Value minimum, maximum;
  const char* unit;
  const char* help;
};
template <class Options, class Value>
Field(const char*, Value Options::*, std::type_identity_t<Value>, std::type_identity_t<Value>, const char*,
      const char*) -> Field<Options, Value>;

// On or off.
template <class Options>
struct Switch {
  const char* name;
  bool Options::*member;
  const char* help;
};
template <class Options>
Switch(const char*, bool Options::*, const char*) -> Switch<Options>;

// One of a few words; enumerator i is written as choices[i].
template <class Options, class Enum, std::size_t Count>
struct Choice {
  const char* name;
  Enum Options::*member;
  std::array<const char*, Count> choices;
  const char* help;
};
template <class Options, class Enum, std::size_t Count>
Choice(const char*, Enum Options::*, std::array<const char*, Count>, const char*)
    -> Choice<Options, Enum, Count>;

namespace detail {

struct AnyValue {
  template <class T>
  constexpr operator T() const;  // NOLINT: converts to whatever the aggregate asks for
};

template <class Options, std::size_t... I>
constexpr bool bracesTake(std::index_sequence<I...>) {
  return requires {
    Options{(static_cast<void>(I), AnyValue{})...};
  };
}

template <class Options, std::size_t Count>
constexpr std::size_t countFields() {
  if constexpr (bracesTake<Options>(std::make_index_sequence<Count>{})) {
    return Count;
  } else {
    return countFields<Options, Count - 1>();
  }
}

}  // namespace detail

// Number of members of a plain option struct, so that a forgotten row is a build error.
template <class Options>
constexpr std::size_t fieldCount() {
  return detail::countFields<Options, 64>();
}

template <class Fields, class Visitor>
constexpr void forEachField(const Fields& fields, Visitor&& visit) {
  std::apply([&](const auto&... field) { (visit(field), ...); }, fields);
}

}  // namespace evical
