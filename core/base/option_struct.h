// What the header of an options struct needs; its rows, which hold defaults, ranges and help, are
// in the source beside it (option_field.h, option_table.h), so that a change of a default or a
// text rebuilds that source only.
//
//   struct NormalFlowOptions {
//     int plane_radius_px;
//     double most_error_s;
//
//     NormalFlowOptions();  // the defaults
//     constexpr explicit NormalFlowOptions(NoDefaults) {}
//     bool operator==(const NormalFlowOptions&) const = default;
//     static const OptionTable<NormalFlowOptions>& table();
//   };
#pragma once

namespace evical {

// Makes a struct whose members have no values yet: defaultsOf (option_field.h) gives them theirs.
struct NoDefaults {};

template <class Options>
class OptionTable;

}  // namespace evical
