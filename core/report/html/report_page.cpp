#include "core/report/html/report_page.h"

#include "core/report/html/html_text.h"

#include <fmt/format.h>

namespace evical::html {

void ReportPage::beginSection(std::string_view id, std::string_view title) {
  body_ += fmt::format("<section id=\"{0}\">\n<h2>{1}</h2>\n", id, escaped(title));
  contents_ += fmt::format("<a href=\"#{}\">{}</a>\n", id, escaped(title));
}

void ReportPage::heading(std::string_view text) {
  body_ += element("h3", "", escaped(text));
}

void ReportPage::figure(const std::string& svg, std::string_view caption, const PlotTable* table) {
  std::string source;
  if (table != nullptr) source = fmt::format(" <a class=\"csv\" href=\"{0}\">{0}</a>", escaped(table->file));
  body_ += fmt::format("<figure>\n<div class=\"wide\">{}</div>\n<figcaption>{}{}</figcaption>\n</figure>\n",
                       svg, caption, source);
}

std::string document(const PageHead& head, const ReportPage& verdict, const ReportPage& page) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta "
      "charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<meta name=\"generator\" content=\"evical {0}\"/>\n<title>{1}</title>\n<style>\n{2}</style>\n</head>\n"
      "<body>\n<main>\n<header><h1>{1}</h1><p "
      "class=\"small\">{3}{4}</p></header>\n{5}<nav>{6}</nav>\n{7}</main>\n"
      "</body>\n</html>\n",
      escaped(head.version), escaped(head.title), kReportStyle, "evical " + escaped(head.version),
      head.remark, verdict.body(), page.contents(), page.body());
}

std::string cameraName(const ReportData& data, std::size_t index) {
  if (index < data.named.cameras.size()) return data.named.cameras[index].name;
  return index < data.cameras.size() ? data.cameras[index].camera : fmt::format("camera {}", index + 1);
}

std::string imuName(const ReportData& data, std::size_t index) {
  if (index < data.named.imus.size()) return data.named.imus[index].name;
  return index < data.imus.size() ? data.imus[index].name : fmt::format("IMU {}", index + 1);
}

}  // namespace evical::html
