#include "core/report/report_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kReportFields{
    Switch{"split_half_check", &ReportOptions::split_half_check, true,
           "Estimate again from each half of the recording, and report the differences.", Level::Public},
    Field{"split_half_check_block_s", &ReportOptions::split_half_check_block_s, 2.5, within(0.2, 1000.0), "s",
          "Length of the blocks that are assigned to the two halves in turn; shorter if there are fewer than "
          "4 blocks.",
          Level::Expert}};
constexpr auto kReportDefaults = defaultsOf<ReportOptions, kReportFields>();

}  // namespace

ReportOptions::ReportOptions() : ReportOptions(kReportDefaults) {}

const OptionTable<ReportOptions>& ReportOptions::table() {
  static const OptionTable<ReportOptions> table(kReportFields);
  return table;
}

}  // namespace evical
