// Declarations for the header of an options struct. Its rows (defaults, ranges, help) are in its source file
// (option_field.h, option_table.h), so that a change of a default or a text rebuilds only that source.
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

// Tag of the constructor that leaves members uninitialised: defaultsOf (option_field.h) sets them.
struct NoDefaults {};

template <class Options>
class OptionTable;

}  // namespace evical
