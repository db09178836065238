#include "core/pipeline/check/check_verdict.h"

#include "core/base/nearest_name.h"
#include "core/report/html/html_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace evical {
namespace {

std::string wordsOf(const Finding& finding) {
  return fmt::format("the {} of {}", finding.title, finding.sensor);
}

std::string changeText(const Finding& finding) {
  return fmt::format("{} by {} {} ({:.1f} sigmas)", wordsOf(finding), html::significant(finding.change, 2),
                     finding.unit, finding.sigmas);
}

std::string openText(const Finding& finding) {
  return fmt::format("a change of {} below {} {} (required: {})", wordsOf(finding),
                     html::significant(finding.smallest_detectable_change, 2), finding.unit,
                     html::plain(finding.required_detectability));
}

}  // namespace

void testQuantities(const ComparedQuantities& compared, const CheckOptions& options,
                    CalibrationCheck& check) {
  const GroupTestResults tests = testSingleChanges(compared.change, compared.groups, options.false_alarms);
  std::size_t shown = 0, max_changed = 0;
  std::vector<std::string> names(compared.groups.size());
  for (std::size_t g = 0; g < compared.groups.size(); ++g) {
    if (!compared.groups[g].tested) continue;
    const ComparedQuantity& quantity = compared.quantities[shown++];
    check.findings.push_back(testedQuantity(quantity, tests.groups[g], compared.groups[g]));
    names[g] = wordsOf(quantity.shown);
    if (g == tests.max_changed) max_changed = check.findings.size() - 1;
  }
  for (const std::size_t g : tests.alternatives)
    check.findings.at(max_changed).alternatives.push_back(names[g]);
}

void judgeFindings(CalibrationCheck& check) {
  std::vector<std::string> changed, open, alternatives;
  for (const Finding& finding : check.findings) {
    if (finding.changed) changed.push_back(changeText(finding));
    if (!finding.isConclusive()) open.push_back(openText(finding));
    alternatives.insert(alternatives.end(), finding.alternatives.begin(), finding.alternatives.end());
  }
  if (!changed.empty()) {
    check.verdict = Verdict::Changed;
    check.reason = joined(changed) + " changed";
    if (!alternatives.empty())
      check.reason += fmt::format(" (or {}: the recording cannot distinguish them)", joined(alternatives));
    addAdvice("Check the rig for loose parts, then calibrate again", check);
  } else if (open.empty()) {
    check.verdict = Verdict::Unchanged;
    check.reason = "nothing has changed, and a relevant change would have been detected";
  } else {
    setCannotTell("no change was detected, but this recording would not have shown " + joined(open), check);
  }
}

void setCannotTell(const std::string& reason, CalibrationCheck& check) {
  check.verdict = Verdict::CannotTell;
  check.reason = reason;
}

void judgeDuplicate(CalibrationCheck& check) {
  if (check.verdict == Verdict::Changed) return;
  check.advice.clear();
  setCannotTell(
      "this is the recording of the old result, which agrees with itself even if the rig has changed", check);
  addAdvice("Check with a new recording", check);
}

void addAdvice(const std::string& advice, CalibrationCheck& check) {
  if (advice.empty()) return;
  const std::string sentence = advice.ends_with('.') ? advice : advice + ".";
  if (std::find(check.advice.begin(), check.advice.end(), sentence) == check.advice.end())
    check.advice.push_back(sentence);
}

}  // namespace evical
