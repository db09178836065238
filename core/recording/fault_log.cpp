#include "core/recording/fault_log.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical {
namespace {

constexpr std::size_t kListedOfAKind = 5;  // enough to see a pattern, few enough to read

}  // namespace

void FaultLog::add(const std::string& stream, const std::string& kind, double at_s, const std::string& text) {
  auto tally = std::find_if(tallies_.begin(), tallies_.end(),
                            [&](const Tally& t) { return t.stream == stream && t.kind == kind; });
  if (tally == tallies_.end()) tally = tallies_.insert(tallies_.end(), Tally{stream, kind, 0, 0, 0, {}});
  if (tally->listed < kListedOfAKind) {
    tally->listed += 1;
    tally->last = faults_.size();
    tally->last_text = text;
    faults_.push_back({stream, kind, at_s, text});
    return;
  }
  tally->more += 1;
  faults_[tally->last].text = fmt::format("{} (and {} more like this)", tally->last_text, tally->more);
}

}  // namespace evical
