#include "core/pipeline/check/check_verdict.h"

#include "core/base/nearest_name.h"
#include "core/report/html/html_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace evical {
namespace {

std::string wordsOf(const CheckedQuantity& quantity) {
  return fmt::format("the {} of {}", quantity.title, quantity.sensor);
}

std::string changeText(const CheckedQuantity& quantity) {
  return fmt::format("{} by {} {} ({:.1f} sigmas)", wordsOf(quantity), html::significant(quantity.change, 2),
                     quantity.unit, quantity.sigmas);
}

std::string openText(const CheckedQuantity& quantity) {
  return fmt::format("a change of {} below {} {} ({} matters)", wordsOf(quantity),
                     html::significant(quantity.would_notice, 2), quantity.unit,
                     html::plain(quantity.matters));
}

}  // namespace

void testQuantities(const ComparedQuantities& compared, const CheckOptions& options,
                    CalibrationCheck& check) {
  const GroupTestResults tests = testSingleChanges(compared.change, compared.groups, options.false_alarms);
  std::size_t shown = 0;
  std::vector<std::string> names(compared.groups.size());
  for (std::size_t g = 0; g < compared.groups.size(); ++g) {
    if (!compared.groups[g].tested) continue;
    const ComparedQuantity& quantity = compared.quantities[shown++];
    check.quantities.push_back(testedQuantity(quantity, tests.groups[g], compared.groups[g]));
    names[g] = wordsOf(quantity.shown);
  }
  for (const std::size_t g : tests.or_else) check.or_else.push_back(names[g]);
}

void judgeQuantities(CalibrationCheck& check) {
  std::vector<std::string> changed, open;
  for (const CheckedQuantity& quantity : check.quantities) {
    if (quantity.changed) changed.push_back(changeText(quantity));
    if (!quantity.toldEnough()) open.push_back(openText(quantity));
  }
  if (!changed.empty()) {
    check.verdict = CheckVerdict::Changed;
    check.reason = joined(changed) + " changed";
    if (!check.or_else.empty())
      check.reason += fmt::format(" (or {}: the recording does not tell which)", joined(check.or_else));
    addAdvice("Calibrate again, and look for what is loose", check);
  } else if (open.empty()) {
    check.verdict = CheckVerdict::StillGood;
    check.reason = "nothing has changed, and a change that matters would have shown";
  } else {
    setCannotTell("nothing is seen to have changed, but this recording would not have shown " + joined(open),
                  check);
  }
}

void setCannotTell(const std::string& reason, CalibrationCheck& check) {
  check.verdict = CheckVerdict::CannotTell;
  check.reason = reason;
}

void addAdvice(const std::string& advice, CalibrationCheck& check) {
  if (advice.empty()) return;
  const std::string sentence = advice.ends_with('.') ? advice : advice + ".";
  if (std::find(check.advice.begin(), check.advice.end(), sentence) == check.advice.end())
    check.advice.push_back(sentence);
}

}  // namespace evical
