#include "core/report/check_report.h"

#include "core/base/yaml_node.h"
#include "core/format/quantity_yaml.h"
#include "core/report/html/html_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace evical {
namespace {

using Json = nlohmann::ordered_json;

std::string textsYaml(const char* key, const std::vector<std::string>& texts) {
  if (texts.empty()) return fmt::format("{}: []\n", key);
  std::string yaml = fmt::format("{}:\n", key);
  for (const std::string& text : texts) yaml += fmt::format("  - {}\n", yamlText(text));
  return yaml;
}

std::string numberYaml(const CheckedNumber& number) {
  return fmt::format(
      "      - {{name: {}, unit: {}, before: {}, before_std: {}, now: {}, now_std: {}, together: {}, "
      "together_std: "
      "{}}}\n",
      yamlText(number.name), yamlText(number.unit), roundedYaml(number.before),
      roundedYaml(number.before_sigma), roundedYaml(number.now), roundedYaml(number.now_sigma),
      roundedYaml(number.together), roundedYaml(number.together_sigma));
}

std::string quantityYaml(const CheckedQuantity& quantity) {
  std::string yaml = fmt::format(
      "  - sensor: {}\n    quantity: {}\n    changed: {}\n    unit: {}\n    change: {}\n    change_std: {}\n"
      "    sigmas: {}\n    limit_sigmas: {}\n",
      yamlText(quantity.sensor), quantity.name, quantity.changed, yamlText(quantity.unit),
      roundedYaml(quantity.change), roundedYaml(quantity.change_sigma), roundedYaml(quantity.sigmas),
      roundedYaml(quantity.limit_sigmas));
  if (quantity.edge_px > 0.0) yaml += fmt::format("    at_edge_px: {}\n", roundedYaml(quantity.edge_px));
  yaml += fmt::format("    would_notice: {}\n    stability: {}\n", roundedYaml(quantity.would_notice),
                      roundedYaml(quantity.stability));
  if (quantity.matters > 0.0) yaml += fmt::format("    matters: {}\n", roundedYaml(quantity.matters));
  yaml += "    numbers:\n";
  for (const CheckedNumber& number : quantity.numbers) yaml += numberYaml(number);
  return yaml;
}

std::string windowsYaml(const CheckedWindows& windows) {
  std::string yaml =
      fmt::format("  - sensor: {}\n    all: {}\n    used: {}\n    turning_alone: {}\n    left_out: {{",
                  yamlText(windows.sensor), windows.all, windows.used, windows.turning_alone);
  for (std::size_t k = 0; k < windows.left_out.size(); ++k)
    yaml += fmt::format("{}{}: {}", k == 0 ? "" : ", ", windows.left_out[k].key, windows.left_out[k].windows);
  return yaml + "}\n";
}

Json windowsJson(const CheckedWindows& windows) {
  Json left_out = Json::object();
  for (const CheckedWindows::LeftOut& one : windows.left_out) left_out[one.key] = one.windows;
  return {{"sensor", windows.sensor},
          {"all", windows.all},
          {"used", windows.used},
          {"turning_alone", windows.turning_alone},
          {"left_out", left_out}};
}

Json numberJson(const CheckedNumber& number) {
  return {{"name", number.name},         {"unit", number.unit},
          {"before", number.before},     {"before_std", number.before_sigma},
          {"now", number.now},           {"now_std", number.now_sigma},
          {"together", number.together}, {"together_std", number.together_sigma}};
}

Json quantityJson(const CheckedQuantity& quantity) {
  Json json = {{"sensor", quantity.sensor},   {"quantity", quantity.name},
               {"changed", quantity.changed}, {"unit", quantity.unit},
               {"change", quantity.change},   {"change_std", quantity.change_sigma},
               {"sigmas", quantity.sigmas},   {"limit_sigmas", quantity.limit_sigmas}};
  if (quantity.edge_px > 0.0) json["at_edge_px"] = quantity.edge_px;
  json["would_notice"] = quantity.would_notice;
  json["stability"] = quantity.stability;
  if (quantity.matters > 0.0) json["matters"] = quantity.matters;
  json["numbers"] = Json::array();
  for (const CheckedNumber& number : quantity.numbers) json["numbers"].push_back(numberJson(number));
  return json;
}

std::string quantityRow(const CheckedQuantity& quantity) {
  using html::significant;
  const std::string name = fmt::format("{} of {}", quantity.title, quantity.sensor);
  const std::string change = fmt::format("{} +- {} {}", significant(quantity.change, 2),
                                         significant(quantity.change_sigma, 2), quantity.unit);
  const std::string edge =
      quantity.edge_px > 0.0 ? fmt::format("{} px", significant(quantity.edge_px, 2)) : "";
  const std::string notice = fmt::format("{} {}", significant(quantity.would_notice, 2), quantity.unit);
  return fmt::format("{:<44}{:>24}{:>9.1f}{:>12}{:>16}{}\n", name, change, quantity.sigmas, edge, notice,
                     quantity.changed        ? "  changed"
                     : quantity.toldEnough() ? ""
                                             : "  too little");
}

// "1.5369 +- 0.0071": to the sigma's second digit.
std::string plusMinus(double value, double sigma) {
  constexpr int kMostDecimals = 6;
  if (!(sigma > 0.0) || !std::isfinite(sigma)) return fmt::format("{:.6g}", value);
  const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, kMostDecimals);
  return fmt::format("{:.{}f} +- {:.{}f}", value, decimals, sigma, decimals);
}

std::string numberRow(const std::string& sensor, const CheckedNumber& number) {
  const std::string name = number.unit.empty() ? sensor + "." + number.name
                                               : fmt::format("{}.{} [{}]", sensor, number.name, number.unit);
  return fmt::format("{:<44}{:>26}{:>26}{:>26}\n", name, plusMinus(number.before, number.before_sigma),
                     plusMinus(number.now, number.now_sigma),
                     plusMinus(number.together, number.together_sigma));
}

}  // namespace

std::string windowsText(const CheckedWindows& windows) {
  std::string text =
      fmt::format("windows of {}: {} of {} used, in {} of them rotation alone explains what moves",
                  windows.sensor, windows.used, windows.all, windows.turning_alone);
  for (const CheckedWindows::LeftOut& one : windows.left_out)
    text += fmt::format("; {} left out: {}", one.windows, one.words);
  return text;
}

const char* verdictName(CheckVerdict verdict) {
  static constexpr std::array<const char*, 3> kNames = {"still_good", "changed", "cannot_tell"};
  return kNames.at(static_cast<std::size_t>(verdict));
}

const char* verdictWords(CheckVerdict verdict) {
  static constexpr std::array<const char*, 3> kWords = {"still good", "changed", "cannot tell"};
  return kWords.at(static_cast<std::size_t>(verdict));
}

std::string checkYaml(const CalibrationCheck& check) {
  std::string yaml =
      fmt::format("evical_check: 1\nstatus: {}\nreason: {}\nresult: {}\nrecording: {}\nfalse_alarms: {}\n",
                  verdictName(check.verdict), yamlText(check.reason), yamlText(check.before),
                  yamlText(check.recording), check.false_alarms);
  yaml += textsYaml("or_else", check.or_else) + textsYaml("advice", check.advice) +
          textsYaml("notes", check.notes);
  if (check.without_board) {
    yaml += fmt::format("without_board: true\n{}", check.windows.empty() ? "windows: []\n" : "windows:\n");
    for (const CheckedWindows& windows : check.windows) yaml += windowsYaml(windows);
  }
  yaml += check.quantities.empty() ? "quantities: []\n" : "quantities:\n";
  for (const CheckedQuantity& quantity : check.quantities) yaml += quantityYaml(quantity);
  return yaml + fmt::format("program: {{version: {}}}\n", yamlText(check.version));
}

std::string checkJson(const CalibrationCheck& check) {
  Json json = {{"evical_check", 1},
               {"status", verdictName(check.verdict)},
               {"reason", check.reason},
               {"result", check.before},
               {"recording", check.recording},
               {"false_alarms", check.false_alarms},
               {"or_else", check.or_else},
               {"advice", check.advice},
               {"notes", check.notes}};
  if (check.without_board) {
    json["without_board"] = true;
    json["windows"] = Json::array();
    for (const CheckedWindows& windows : check.windows) json["windows"].push_back(windowsJson(windows));
  }
  json["quantities"] = Json::array();
  for (const CheckedQuantity& quantity : check.quantities)
    json["quantities"].push_back(quantityJson(quantity));
  json["program"] = {{"version", check.version}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string checkTable(const CalibrationCheck& check) {
  std::string text;
  if (!check.quantities.empty()) {
    text += fmt::format("{:<44}{:>26}{:>26}{:>26}\n", "number", "before", "now, alone", "both together");
    for (const CheckedQuantity& quantity : check.quantities)
      for (const CheckedNumber& number : quantity.numbers) text += numberRow(quantity.sensor, number);
    text += fmt::format("\n{:<44}{:>24}{:>9}{:>12}{:>16}\n", "quantity", "change", "sigmas", "at edge",
                        "would notice");
    for (const CheckedQuantity& quantity : check.quantities) text += quantityRow(quantity);
    text += "\n";
  }
  for (const CheckedWindows& windows : check.windows) text += windowsText(windows) + "\n";
  for (const std::string& note : check.notes) text += fmt::format("note: {}\n", note);
  text += fmt::format("{}: {}\n", verdictWords(check.verdict), check.reason);
  for (const std::string& advice : check.advice) text += fmt::format("  {}\n", advice);
  return text;
}

}  // namespace evical
