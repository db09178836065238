#include "core/report/report_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kReportFields{
    Switch{"split_half_check", &ReportOptions::split_half_check, true,
           "Estimate once more from each half of the recording, and say how far the two differ.",
           Level::Public},
    Field{"split_half_check_block_s", &ReportOptions::split_half_check_block_s, 2.5, within(0.2, 1000.0), "s",
          "Blocks of this length go to the one half and to the other in turn; shorter where that makes fewer "
          "than 4.",
          Level::Expert}};
constexpr auto kReportDefaults = defaultsOf<ReportOptions, kReportFields>();

}  // namespace

ReportOptions::ReportOptions() : ReportOptions(kReportDefaults) {}

const OptionTable<ReportOptions>& ReportOptions::table() {
  static const OptionTable<ReportOptions> table(kReportFields);
  return table;
}

}  // namespace evical
