#include "core/report/repeat_report.h"

#include "core/base/yaml_node.h"
#include "core/format/quantity_yaml.h"
#include "core/report/csv_text.h"
#include "core/report/html/html_text.h"
#include "core/report/result_yaml.h"

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

std::string listYaml(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + roundedYaml(value);
  return "[" + text + "]";
}

// JSON knows no NaN.
Json listJson(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
  return list;
}

std::string differsYaml(const CheckedQuantity& quantity) {
  return fmt::format(
      "      - {{sensor: {}, quantity: {}, by: {}, std: {}, unit: {}, sigmas: {}, beyond_chance: {}}}\n",
      yamlText(quantity.sensor), quantity.name, roundedYaml(quantity.change),
      roundedYaml(quantity.change_sigma), yamlText(quantity.unit), roundedYaml(quantity.sigmas),
      quantity.changed);
}

std::string recordingYaml(const RepeatedRecording& recording) {
  std::string yaml =
      fmt::format("  - name: {}\n    recording: {}\n    outcome: {}\n    status: {}\n    reason: {}\n",
                  yamlText(recording.name), yamlText(recording.file), outcomeName(recording.outcome),
                  statusName(recording.status), yamlText(recording.reason));
  if (recording.freedom > 0)
    yaml += fmt::format("    chi_square: {}\n    degrees_of_freedom: {}\n    limit: {}\n",
                        roundedYaml(recording.chi_square), recording.freedom, roundedYaml(recording.limit));
  if (!recording.differs.empty()) yaml += "    differs:\n";
  for (const CheckedQuantity& quantity : recording.differs) yaml += differsYaml(quantity);
  return yaml;
}

std::string numberYaml(const RepeatedNumber& number, bool common) {
  std::string yaml = fmt::format(
      "      - name: {}\n        unit: {}\n        recordings: {}\n        mean: {}\n        "
      "standard_deviation: {}\n"
      "        mean_std: {}\n        ratio: {}\n",
      yamlText(number.name), yamlText(number.unit), number.count, exactYaml(number.mean),
      roundedYaml(number.deviation), roundedYaml(number.mean_sigma), roundedYaml(number.ratio()));
  if (common)
    yaml += fmt::format("        joint: {}\n        joint_std: {}\n", exactYaml(number.joint),
                        roundedYaml(number.joint_sigma));
  return yaml + fmt::format("        values: {}\n        stds: {}\n", listYaml(number.values),
                            listYaml(number.sigmas));
}

Json recordingJson(const RepeatedRecording& recording) {
  Json json = {{"name", recording.name},
               {"recording", recording.file},
               {"outcome", outcomeName(recording.outcome)},
               {"status", statusName(recording.status)},
               {"reason", recording.reason}};
  if (recording.freedom > 0) {
    json["chi_square"] = recording.chi_square;
    json["degrees_of_freedom"] = recording.freedom;
    json["limit"] = recording.limit;
  }
  json["differs"] = Json::array();
  for (const CheckedQuantity& quantity : recording.differs)
    json["differs"].push_back({{"sensor", quantity.sensor},
                               {"quantity", quantity.name},
                               {"by", quantity.change},
                               {"std", quantity.change_sigma},
                               {"unit", quantity.unit},
                               {"sigmas", quantity.sigmas},
                               {"beyond_chance", quantity.changed}});
  return json;
}

Json numberJson(const RepeatedNumber& number, bool common) {
  Json json = {{"name", number.name},
               {"unit", number.unit},
               {"recordings", number.count},
               {"mean", number.mean},
               {"standard_deviation", number.deviation},
               {"mean_std", number.mean_sigma},
               {"ratio", number.ratio()}};
  if (common) {
    json["joint"] = number.joint;
    json["joint_std"] = number.joint_sigma;
  }
  json["values"] = listJson(number.values);
  json["stds"] = listJson(number.sigmas);
  return json;
}

// To the second digit of what it varies by.
int decimalsFor(const RepeatedNumber& number) {
  constexpr int kMost = 6;
  double size = 0.0;
  for (const double each : {number.deviation, number.mean_sigma, number.joint_sigma})
    if (each > 0.0 && (size == 0.0 || each < size)) size = each;
  if (!(size > 0.0)) return kMost;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(size))), 0, kMost);
}

std::string fullName(const RepeatedQuantity& quantity, const RepeatedNumber& number) {
  const std::string name = quantity.sensor + "." + number.name;
  return number.unit.empty() ? name : fmt::format("{} [{}]", name, number.unit);
}

std::string numberRow(const RepeatedQuantity& quantity, const RepeatedNumber& number) {
  const int decimals = decimalsFor(number);
  std::string row = fmt::format("{:<44}{:>14.{}f}{:>12.{}f}{:>12.{}f}{:>8}", fullName(quantity, number),
                                number.mean, decimals, number.deviation, decimals, number.mean_sigma,
                                decimals, number.count > 1 ? fmt::format("{:.2f}", number.ratio()) : "");
  if (quantity.common)
    row += fmt::format("{:>14.{}f} +- {:.{}f}", number.joint, decimals, number.joint_sigma, decimals);
  return row + "\n";
}

std::string recordingRow(const RepeatedRecording& recording) {
  std::string row = fmt::format(
      "{:<24}{:<16}", recording.name,
      recording.outcome == RepeatOutcome::DoesNotFit ? "does not fit" : outcomeName(recording.outcome));
  if (recording.freedom > 0)
    row += fmt::format("{:>10.1f} of {:.1f} ({} numbers)", recording.chi_square, recording.limit,
                       recording.freedom);
  for (const CheckedQuantity& quantity : recording.differs)
    row += fmt::format("  {} of {} by {} +- {} {}", quantity.title, quantity.sensor,
                       html::significant(quantity.change, 2), html::significant(quantity.change_sigma, 2),
                       quantity.unit);
  if (!recording.reason.empty())
    row += fmt::format("  {}: {}", statusName(recording.status), recording.reason);
  return row + "\n";
}

}  // namespace

const char* verdictName(RepeatVerdict verdict) {
  static constexpr std::array<const char*, 3> kNames = {"agree", "disagree", "failed"};
  return kNames.at(static_cast<std::size_t>(verdict));
}

const char* verdictWords(RepeatVerdict verdict) {
  static constexpr std::array<const char*, 3> kWords = {"they agree", "they do not agree", "failed"};
  return kWords.at(static_cast<std::size_t>(verdict));
}

const char* outcomeName(RepeatOutcome outcome) {
  static constexpr std::array<const char*, 3> kNames = {"fits", "does_not_fit", "failed"};
  return kNames.at(static_cast<std::size_t>(outcome));
}

std::string repeatYaml(const Repeatability& repeat) {
  std::string yaml =
      fmt::format("evical_repeat: 1\nstatus: {}\nreason: {}\nfalse_alarms: {}\nrms_ratio: {}\n",
                  verdictName(repeat.verdict), yamlText(repeat.reason), repeat.false_alarms,
                  roundedYaml(repeat.rms_ratio));
  if (!repeat.own_values_of.empty())
    yaml += fmt::format("own_values_of: {}\n", yamlText(repeat.own_values_of));
  yaml += "recordings:\n";
  for (const RepeatedRecording& recording : repeat.recordings) yaml += recordingYaml(recording);
  yaml += repeat.columns.empty() ? "columns: []\n" : "columns:\n";
  for (const std::string& column : repeat.columns) yaml += fmt::format("  - {}\n", yamlText(column));
  yaml += repeat.quantities.empty() ? "quantities: []\n" : "quantities:\n";
  for (const RepeatedQuantity& quantity : repeat.quantities) {
    yaml += fmt::format("  - sensor: {}\n    quantity: {}\n    common: {}\n    numbers:\n",
                        yamlText(quantity.sensor), quantity.name, quantity.common);
    for (const RepeatedNumber& number : quantity.numbers) yaml += numberYaml(number, quantity.common);
  }
  yaml += repeat.notes.empty() ? "notes: []\n" : "notes:\n";
  for (const std::string& note : repeat.notes) yaml += fmt::format("  - {}\n", yamlText(note));
  return yaml +
         fmt::format("took_s: {:.1f}\nprogram: {{version: {}}}\n", repeat.took_s, yamlText(repeat.version));
}

std::string repeatJson(const Repeatability& repeat) {
  Json json = {{"evical_repeat", 1},
               {"status", verdictName(repeat.verdict)},
               {"reason", repeat.reason},
               {"false_alarms", repeat.false_alarms},
               {"rms_ratio", repeat.rms_ratio},
               {"own_values_of", repeat.own_values_of},
               {"recordings", Json::array()},
               {"columns", repeat.columns},
               {"quantities", Json::array()},
               {"notes", repeat.notes}};
  for (const RepeatedRecording& recording : repeat.recordings)
    json["recordings"].push_back(recordingJson(recording));
  for (const RepeatedQuantity& quantity : repeat.quantities) {
    Json numbers = Json::array();
    for (const RepeatedNumber& number : quantity.numbers)
      numbers.push_back(numberJson(number, quantity.common));
    json["quantities"].push_back({{"sensor", quantity.sensor},
                                  {"quantity", quantity.name},
                                  {"common", quantity.common},
                                  {"numbers", numbers}});
  }
  json["took_s"] = repeat.took_s;
  json["program"] = {{"version", repeat.version}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string repeatTable(const Repeatability& repeat) {
  std::string text;
  if (!repeat.quantities.empty()) {
    text += fmt::format("{:<44}{:>14}{:>12}{:>12}{:>8}{:>14}\n", "number", "mean", "deviation", "mean sigma",
                        "ratio", "together");
    for (const RepeatedQuantity& quantity : repeat.quantities)
      for (const RepeatedNumber& number : quantity.numbers) text += numberRow(quantity, number);
    text += fmt::format("\nratio over all numbers: {:.2f}\n\n", repeat.rms_ratio);
  }
  text += fmt::format("{:<24}{:<16}{:>10} against the others\n", "recording", "", "chi-square");
  for (const RepeatedRecording& recording : repeat.recordings) text += recordingRow(recording);
  text += "\n";
  for (const std::string& note : repeat.notes) text += fmt::format("note: {}\n", note);
  return text + fmt::format("{}: {}\n", verdictWords(repeat.verdict), repeat.reason);
}

std::string repeatCsv(const Repeatability& repeat) {
  std::string csv =
      "sensor,number,unit,common,recordings,mean,standard_deviation,mean_std,ratio,joint,joint_std";
  for (const std::string& column : repeat.columns)
    csv += fmt::format(",{},{}", csvWord(column), csvWord(column + "_std"));
  csv += "\n";
  const auto cell = [](double value) { return std::isfinite(value) ? fmt::format(",{:.10g}", value) : ","; };
  for (const RepeatedQuantity& quantity : repeat.quantities)
    for (const RepeatedNumber& number : quantity.numbers) {
      csv += fmt::format("{},{},{},{},{}", csvWord(quantity.sensor), csvWord(number.name),
                         csvWord(number.unit), quantity.common ? 1 : 0, number.count);
      for (const double value : {number.mean, number.deviation, number.mean_sigma, number.ratio()})
        csv += cell(value);
      csv += quantity.common ? cell(number.joint) + cell(number.joint_sigma) : ",,";
      for (std::size_t k = 0; k < number.values.size(); ++k)
        csv += cell(number.values[k]) + cell(number.sigmas[k]);
      csv += "\n";
    }
  return csv;
}

}  // namespace evical
