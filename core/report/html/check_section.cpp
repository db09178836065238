// Is the old calibration still good?
#include "core/report/check_report.h"
#include "core/report/html/html_text.h"
#include "core/report/html/report_page.h"

#include <fmt/format.h>

namespace evical::html {
namespace {

using Rows = std::vector<std::vector<std::string>>;

const char* cssClass(CheckVerdict verdict) {
  switch (verdict) {
    case CheckVerdict::StillGood:
      return "ok";
    case CheckVerdict::Changed:
      return "failed";
    case CheckVerdict::CannotTell:
      break;
  }
  return "doubtful";
}

std::string outcomeOf(const CheckedQuantity& quantity) {
  if (quantity.changed) return "<b class=\"bad\">changed</b>";
  return quantity.toldEnough() ? "" : "not told well enough";
}

std::string withUnit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + escaped(unit);
}

void writeChanges(const CalibrationCheck& check, ReportPage& page) {
  Rows rows;
  for (const CheckedQuantity& quantity : check.quantities)
    rows.push_back({escaped(fmt::format("{} of {}", quantity.title, quantity.sensor)),
                    withUnit(withSigma(quantity.change, quantity.change_sigma), quantity.unit),
                    number(quantity.sigmas, 1),
                    quantity.edge_px > 0.0 ? significant(quantity.edge_px, 2) + " px" : "",
                    withUnit(significant(quantity.would_notice, 2), quantity.unit),
                    quantity.matters > 0.0 ? withUnit(plain(quantity.matters), quantity.unit) : "",
                    outcomeOf(quantity)});
  page.text(table(
      {"", "change", "in sigmas", "at the image's edge", "would have been noticed", "matters", ""}, rows));
  page.text(paragraph(
      "small",
      fmt::format(
          "A change is what this quantity has moved by if it alone has moved; of a lens it is the RMS over "
          "the image. What would have been noticed is found with a probability of 95 %, in whatever "
          "direction it goes. A calibration that has not changed is called changed in {} % of all checks "
          "at most.",
          plain(100.0 * check.false_alarms))));
}

void writeNumbersOf(const CalibrationCheck& check, ReportPage& page) {
  Rows rows;
  for (const CheckedQuantity& quantity : check.quantities)
    for (const CheckedNumber& number : quantity.numbers)
      rows.push_back({escaped(quantity.sensor + "." + number.name),
                      withSigma(number.before, number.before_sigma), withSigma(number.now, number.now_sigma),
                      withSigma(number.together, number.together_sigma), escaped(number.unit)});
  page.text(table({"", "before", "now, alone", "both together", "unit"}, rows));
}

void writeList(const char* title, const std::vector<std::string>& texts, ReportPage& page) {
  if (texts.empty()) return;
  std::string items;
  for (const std::string& text : texts) items += element("li", "", escaped(text));
  page.text(paragraph("title", title) + "<ul>" + items + "</ul>\n");
}

}  // namespace

void writeCheckVerdict(const ReportData& data, ReportPage& page) {
  if (data.check == nullptr) return;
  const CalibrationCheck& check = *data.check;
  page.text(fmt::format("<div class=\"verdict {}\"><b>{}</b><div><p>{}</p>{}</div></div>\n",
                        cssClass(check.verdict), verdictWords(check.verdict),
                        escaped(fmt::format("Is the calibration {} still good?", check.before)),
                        paragraph("reason", escaped(check.reason) + ".")));
}

void writeCheck(const ReportData& data, ReportPage& page) {
  if (data.check == nullptr) return;
  const CalibrationCheck& check = *data.check;
  page.beginSection("check", "Is the old calibration still good?");
  writeList("What to do", check.advice, page);
  if (!check.quantities.empty()) {
    writeChanges(check, page);
    writeNumbersOf(check, page);
  }
  for (const CheckedWindows& windows : check.windows)
    page.text(paragraph("small", escaped(windowsText(windows)) + "."));
  writeList("To know", check.notes, page);
  page.endSection();
}

}  // namespace evical::html
