#include "core/report/assessment_report.h"

#include "core/base/number.h"
#include "core/base/yaml_node.h"
#include "core/format/quantity_yaml.h"
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

// Estimates read back unchanged. Times have milliseconds, all other numbers six digits.
std::string numberYaml(const std::string& key, double value) {
  static constexpr std::array kExact = {"numbers.before", "numbers.now", "numbers.joint",
                                        "numbers.change", "joint",       "mean"};
  if (std::find(kExact.begin(), kExact.end(), key) != kExact.end()) return exactYaml(value);
  return key.ends_with("_s") && std::isfinite(value) ? fmt::format("{:.3f}", value) : roundedYaml(value);
}

bool isFlat(const Json& json) {
  return std::none_of(json.begin(), json.end(), [](const Json& each) { return each.is_structured(); });
}

std::string scalarYaml(const std::string& key, const Json& json) {
  if (json.is_string()) return yamlText(json.get_ref<const std::string&>());
  return json.is_number_float() ? numberYaml(key, json.get<double>()) : json.dump();
}

// Flow style, on one line: a map of scalars, a list of numbers.
std::string flowYaml(const std::string& key, const Json& json) {
  std::string text;
  for (const auto& [name, value] : json.items()) {
    if (!text.empty()) text += ", ";
    text += json.is_object() ? fmt::format("{}: {}", name, scalarYaml(key + "." + name, value))
                             : scalarYaml(key, value);
  }
  return json.is_object() ? "{" + text + "}" : "[" + text + "]";
}

bool isFlow(const Json& json) {
  return json.empty() || (isFlat(json) && (json.is_object() || !json.front().is_string()));
}

// Lines of a map or a list; the caller has written the beginning of the first line.
std::string blockYaml(const std::string& key, const Json& json, std::size_t indent) {
  std::string text;
  for (const auto& [name, value] : json.items()) {
    if (!text.empty()) text += std::string(indent, ' ');
    text += json.is_object() ? name + ":" : "-";
    const std::string& of = json.is_object() ? name : key;
    if (!value.is_structured())
      text += " " + scalarYaml(of, value) + "\n";
    else if (isFlow(value))
      text += " " + flowYaml(of, value) + "\n";
    else if (json.is_object())
      text += "\n" + std::string(indent + 2, ' ') + blockYaml(of, value, indent + 2);
    else
      text += " " + blockYaml(of, value, indent + 2);
  }
  return text;
}

template <class List, class Function>
Json listOf(const List& list, const Function& jsonOf) {
  Json all = Json::array();
  for (const auto& each : list) all.push_back(jsonOf(each));
  return all;
}

Json comparedNumberJson(const ComparedNumber& number) {
  Json json = {{"name", number.name}, {"unit", number.unit}};
  const auto add = [&](const std::string& key, const ValueWithSigma& value) {
    if (!value.isKnown()) return;
    json[key] = value.value;
    json[key + "_std"] = value.sigma;
  };
  add("before", number.before);
  add("now", number.now);
  add("joint", number.joint);
  add("change", number.change);
  return json;
}

Json findingJson(const Finding& finding) {
  Json json = {{"sensor", finding.sensor}};
  if (!finding.against.empty()) json["against"] = finding.against;
  json.update({{"quantity", finding.quantity},
               {"from", sourceName(finding.source)},
               {"verdict", verdictName(finding.verdict())},
               {"unit", finding.unit},
               {"change", finding.change},
               {"change_std", finding.change_sigma},
               {"sigmas", finding.sigmas},
               {"limit_sigmas", finding.limit_sigmas}});
  const auto addPositive = [&](const char* key, double value) {
    if (value > 0.0) json[key] = value;
  };
  addPositive("at_edge_px", finding.edge_px);
  addPositive("smallest_detectable_change", finding.smallest_detectable_change);
  addPositive("allowed_drift", finding.allowed_drift);
  addPositive("required_detectability", finding.required_detectability);
  if (!finding.alternatives.empty()) json["alternatives"] = finding.alternatives;
  if (!finding.numbers.empty()) json["numbers"] = listOf(finding.numbers, comparedNumberJson);
  return json;
}

Json stepJson(const MaintenanceStep& step) {
  Json json = {{"at_s", step.at_s}, {"noticed_s", step.noticed_s}};
  json.update(findingJson(step));
  return json;
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

Json imuJson(const MaintainedImu& imu) {
  const auto used =
      std::count_if(imu.stops.begin(), imu.stops.end(), [](const auto& stop) { return stop.used; });
  return {{"name", imu.name},
          {"stream", imu.stream},
          {"from_s", imu.from_s},
          {"to_s", imu.to_s},
          {"rate_hz", imu.rate_hz},
          {"stops", {{"found", imu.stops.size()}, {"used", used}, {"misfit", imu.misfit}}},
          {"weakest", imu.weakest},
          {"weakest_std", imu.weakest_sigma}};
}

Json recordingJson(const RepeatedRecording& recording) {
  Json json = {{"name", recording.name},
               {"recording", recording.file},
               {"outcome", outcomeName(recording.outcome)},
               {"status", statusName(recording.status)},
               {"reason", recording.reason}};
  if (recording.freedom > 0)
    json.update({{"chi_square", recording.chi_square},
                 {"degrees_of_freedom", recording.freedom},
                 {"limit", recording.limit}});
  json["findings"] = listOf(recording.findings, findingJson);
  return json;
}

Json repeatedQuantityJson(const RepeatedQuantity& quantity) {
  const auto numberJson = [&](const RepeatedNumber& number) {
    Json json = {{"name", number.name},
                 {"unit", number.unit},
                 {"recordings", number.count},
                 {"mean", number.mean},
                 {"standard_deviation", number.deviation},
                 {"mean_std", number.mean_sigma},
                 {"ratio", number.ratio()}};
    if (quantity.common) json.update({{"joint", number.joint}, {"joint_std", number.joint_sigma}});
    json.update({{"values", number.values}, {"stds", number.sigmas}});
    return json;
  };
  return {{"sensor", quantity.sensor},
          {"quantity", quantity.name},
          {"common", quantity.common},
          {"numbers", listOf(quantity.numbers, numberJson)}};
}

Json headJson(const char* kind, const Assessment& assessment) {
  Json json = {{kind, 1},
               {"verdict", verdictName(assessment.verdict)},
               {"reason", assessment.reason},
               {"false_alarms", assessment.false_alarms}};
  if (!assessment.before.empty()) json["result"] = assessment.before;
  if (!assessment.inputs.empty()) json["inputs"] = assessment.inputs;
  return json;
}

Json ended(Json json, const Assessment& assessment) {
  json.update({{"advice", assessment.advice},
               {"notes", assessment.notes},
               {"program", {{"version", assessment.version}}}});
  return json;
}

Json jsonOf(const CalibrationCheck& check) {
  Json json = headJson("evical_check", check);
  if (check.without_board)
    json.update({{"without_board", true}, {"windows", listOf(check.windows, windowsJson)}});
  json["findings"] = listOf(check.findings, findingJson);
  return ended(std::move(json), check);
}

Json jsonOf(const Maintenance& maintenance) {
  Json json = headJson("evical_maintenance", maintenance);
  json.update({{"duration_s", maintenance.duration_s},
               {"imus", listOf(maintenance.imus, imuJson)},
               {"findings", listOf(maintenance.findings, findingJson)},
               {"steps", listOf(maintenance.steps, stepJson)},
               {"took_s", maintenance.took_s},
               {"memory_peak_mb", maintenance.memory_peak_mb}});
  return ended(std::move(json), maintenance);
}

Json jsonOf(const Repeatability& repeat) {
  Json json = headJson("evical_repeat", repeat);
  json["rms_ratio"] = repeat.rms_ratio;
  if (!repeat.own_values_of.empty()) json["own_values_of"] = repeat.own_values_of;
  json.update({{"recordings", listOf(repeat.recordings, recordingJson)},
               {"columns", repeat.columns},
               {"quantities", listOf(repeat.quantities, repeatedQuantityJson)},
               {"took_s", repeat.took_s}});
  return ended(std::move(json), repeat);
}

std::string yamlOf(const Json& json) {
  return blockYaml({}, json, 0);
}

// Names need not be UTF-8. Numbers that are not finite become null.
std::string textOf(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string withUnit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
}

std::string shown(const ValueWithSigma& number) {
  return number.isKnown() ? withSigma(number.value, number.sigma) : "";
}

std::string size(double value, const std::string& unit) {
  if (!std::isfinite(value)) return "-";
  const std::string shown = shownUnit(unit);
  return html::significant(value, 2) + (shown.empty() ? "" : " " + shown);
}

std::string changeText(const Finding& finding) {
  if (!std::isfinite(finding.change_sigma)) return "-";
  return fmt::format("{} +- {}", html::significant(finding.change, 2),
                     size(finding.change_sigma, finding.unit));
}

std::string findingText(const Finding& finding) {
  return fmt::format("{} of {}", finding.title, ofSensor(finding.sensor, finding.against));
}

std::string findingRow(const Finding& finding) {
  return fmt::format("{:<52}{:<12}{:>24}{:>9.1f}{:>12}{:>16}  {}\n", findingText(finding),
                     sourceWords(finding.source), changeText(finding), finding.sigmas,
                     finding.edge_px > 0.0 ? size(finding.edge_px, "px") : "",
                     size(finding.smallest_detectable_change, finding.unit), verdictWords(finding.verdict()));
}

std::string numberRow(const Finding& finding, const ComparedNumber& number) {
  const std::string name = ofSensor(finding.sensor, finding.against) + "." + number.name;
  std::string row = fmt::format("{:<52}{:>26}{:>26}", withUnit(name, shownUnit(number.unit)),
                                shown(number.before), shown(number.now));
  if (number.joint.isKnown()) row += fmt::format("{:>26}", shown(number.joint));
  return row + "\n";
}

// Each quantity, below its numbers.
std::string findingsTable(const std::vector<Finding>& findings) {
  if (findings.empty()) return {};
  const auto& first = findings.front().numbers;
  const bool joint = !first.empty() && first.front().joint.isKnown();
  std::string text = fmt::format("{:<52}{:>26}{:>26}{}\n", "number", "before", "now, alone",
                                 joint ? fmt::format("{:>26}", "both jointly") : "");
  for (const Finding& finding : findings)
    for (const ComparedNumber& number : finding.numbers) text += numberRow(finding, number);
  text += fmt::format("\n{:<52}{:<12}{:>24}{:>9}{:>12}{:>16}\n", "quantity", "from", "change", "sigmas",
                      "at edge", "detectable");
  for (const Finding& finding : findings) text += findingRow(finding);
  return text + "\n";
}

std::string endText(const Assessment& assessment) {
  std::string text;
  for (const std::string& note : assessment.notes) text += fmt::format("note: {}\n", note);
  text += fmt::format("{}: {}\n", verdictWords(assessment.verdict), assessment.reason);
  for (const std::string& advice : assessment.advice) text += fmt::format("to do: {}\n", advice);
  return text;
}

std::string stepText(const MaintenanceStep& step) {
  std::string text = fmt::format("at {:.1f} s (detected at {:.1f} s): {} by {}\n", step.at_s, step.noticed_s,
                                 findingText(step), changeText(step));
  for (const std::string& other : step.alternatives) text += fmt::format("  alternative: {}\n", other);
  return text;
}

std::string repeatedRow(const RepeatedQuantity& quantity, const RepeatedNumber& number) {
  double least = 0.0;  // of its variation
  for (const double each : {number.deviation, number.mean_sigma, number.joint_sigma})
    if (each > 0.0 && (least == 0.0 || each < least)) least = each;
  const int decimals = decimalsFor(least, 6, 6);
  std::string row = fmt::format("{:<44}{:>14.{}f}{:>12.{}f}{:>12.{}f}{:>8}",
                                withUnit(quantity.sensor + "." + number.name, number.unit), number.mean,
                                decimals, number.deviation, decimals, number.mean_sigma, decimals,
                                number.count > 1 ? fmt::format("{:.2f}", number.ratio()) : "");
  if (quantity.common)
    row += fmt::format("{:>14.{}f} +- {:.{}f}", number.joint, decimals, number.joint_sigma, decimals);
  return row + "\n";
}

std::string recordingRow(const RepeatedRecording& recording) {
  std::string row = fmt::format("{:<24}{:<16}", recording.name, outcomeWords(recording.outcome));
  if (recording.freedom > 0)
    row += fmt::format("{:>10.1f} of {:.1f} ({} numbers)", recording.chi_square, recording.limit,
                       recording.freedom);
  for (const Finding& finding : recording.findings)
    row += fmt::format("  {} by {}", findingText(finding), changeText(finding));
  if (!recording.reason.empty())
    row += fmt::format("  {}: {}", statusName(recording.status), recording.reason);
  return row + "\n";
}

}  // namespace

const char* verdictName(Verdict verdict) {
  static constexpr std::array<const char*, 3> kNames = {"unchanged", "changed", "cannot_tell"};
  return kNames.at(static_cast<std::size_t>(verdict));
}

const char* verdictWords(Verdict verdict) {
  return verdict == Verdict::CannotTell ? "cannot tell" : verdictName(verdict);
}

const char* sourceName(FindingSource source) {
  static constexpr std::array<const char*, 4> kNames = {"recording", "stops", "trajectory", "other_imu"};
  return kNames.at(static_cast<std::size_t>(source));
}

const char* sourceWords(FindingSource source) {
  return source == FindingSource::OtherImu ? "other IMU" : sourceName(source);
}

const char* outcomeName(RepeatOutcome outcome) {
  static constexpr std::array<const char*, 3> kNames = {"fits", "does_not_fit", "failed"};
  return kNames.at(static_cast<std::size_t>(outcome));
}

const char* outcomeWords(RepeatOutcome outcome) {
  return outcome == RepeatOutcome::DoesNotFit ? "does not fit" : outcomeName(outcome);
}

std::string ofSensor(const std::string& sensor, const std::string& against) {
  return against.empty() ? sensor : sensor + " against " + against;
}

std::string shownUnit(const std::string& unit) {
  return unit == "1" ? "" : unit;
}

std::string windowsText(const CheckedWindows& windows) {
  std::string text =
      fmt::format("event windows of {}: {} of {} used; rotation alone explains the motion in {}",
                  windows.sensor, windows.used, windows.all, windows.turning_alone);
  for (const CheckedWindows::LeftOut& one : windows.left_out)
    text += fmt::format("; {} excluded: {}", one.windows, one.words);
  return text;
}

std::string assessmentYaml(const CalibrationCheck& check) {
  return yamlOf(jsonOf(check));
}
std::string assessmentYaml(const Maintenance& maintenance) {
  return yamlOf(jsonOf(maintenance));
}
std::string assessmentYaml(const Repeatability& repeat) {
  return yamlOf(jsonOf(repeat));
}

std::string assessmentJson(const CalibrationCheck& check) {
  return textOf(jsonOf(check));
}
std::string assessmentJson(const Maintenance& maintenance) {
  return textOf(jsonOf(maintenance));
}
std::string assessmentJson(const Repeatability& repeat) {
  return textOf(jsonOf(repeat));
}

std::string assessmentTable(const CalibrationCheck& check) {
  std::string text = findingsTable(check.findings);
  for (const CheckedWindows& windows : check.windows) text += windowsText(windows) + "\n";
  return text + endText(check);
}

std::string assessmentTable(const Maintenance& maintenance) {
  std::string text = findingsTable(maintenance.findings);
  for (const MaintenanceStep& step : maintenance.steps) text += stepText(step);
  for (const MaintainedImu& imu : maintenance.imus)
    if (!imu.stops.empty())
      text += fmt::format("{}: {}; weakest direction: {}\n", imu.name, counted(imu.stops.size(), "stop"),
                          imu.weakest);
  return text + endText(maintenance);
}

std::string assessmentTable(const Repeatability& repeat) {
  std::string text;
  if (!repeat.quantities.empty()) {
    text += fmt::format("{:<44}{:>14}{:>12}{:>12}{:>8}{:>14}\n", "number", "mean", "deviation", "mean sigma",
                        "ratio", "together");
    for (const RepeatedQuantity& quantity : repeat.quantities)
      for (const RepeatedNumber& number : quantity.numbers) text += repeatedRow(quantity, number);
    text += fmt::format("\nratio over all numbers: {:.2f}\n\n", repeat.rms_ratio);
  }
  text += fmt::format("{:<24}{:<16}{:>10} against the others\n", "recording", "", "chi-square");
  for (const RepeatedRecording& recording : repeat.recordings) text += recordingRow(recording);
  return text + "\n" + endText(repeat);
}

}  // namespace evical
