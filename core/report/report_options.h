// Options of the report.
#pragma once

#include "core/base/option_row.h"

namespace evical {

struct ReportOptions {
  bool split_half_check;
  double split_half_check_block_s;

  ReportOptions();  // the defaults
  constexpr explicit ReportOptions(NoDefaults) {}
  bool operator==(const ReportOptions&) const = default;
  static const OptionTable<ReportOptions>& table();
};

}  // namespace evical
