// What people may choose about the report.
#pragma once

#include "core/base/option_field.h"

namespace evical {

struct ReportOptions {
  bool cross_validation = true;
  double cross_validation_block_s = 2.5;

  bool operator==(const ReportOptions&) const = default;
};

inline constexpr auto kReportFields = std::tuple{
    Switch{"cross_validation", &ReportOptions::cross_validation,
           "Estimate once more from each half of the recording, and say how far the two differ."},
    Field{"cross_validation_block_s", &ReportOptions::cross_validation_block_s, 0.2, 1000.0, "s",
          "Blocks of this length go to the one half and to the other in turn; shorter where that makes fewer "
          "than 4."}};
static_assert(fieldCount<ReportOptions>() == std::tuple_size_v<decltype(kReportFields)>);

}  // namespace evical
