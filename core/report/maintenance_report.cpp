#include "core/report/maintenance_report.h"

#include "core/base/yaml_node.h"
#include "core/format/quantity_yaml.h"
#include "core/report/csv_text.h"
#include "core/report/html/html_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace evical {
namespace {

using Json = nlohmann::ordered_json;

std::string listYaml(const char* key, const std::vector<std::string>& texts) {
  std::string yaml = texts.empty() ? fmt::format("{}: []\n", key) : fmt::format("{}:\n", key);
  for (const std::string& text : texts) yaml += fmt::format("  - {}\n", yamlText(text));
  return yaml;
}

// JSON knows neither NaN nor infinity.
Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string numbersYaml(const std::vector<MaintainedNumber>& numbers, bool with_before) {
  std::string yaml = "    numbers:\n";
  for (const MaintainedNumber& each : numbers) {
    yaml += fmt::format("      - {{name: {}, unit: {}, ", each.name, yamlText(each.unit));
    if (with_before)
      yaml += fmt::format("before: {}, before_std: {}, now: {}, now_std: {}}}\n", exactYaml(each.before),
                          roundedYaml(each.before_sigma), exactYaml(each.now), roundedYaml(each.now_sigma));
    else
      yaml += fmt::format("by: {}, by_std: {}}}\n", exactYaml(each.now), roundedYaml(each.now_sigma));
  }
  return yaml;
}

std::string quantityYaml(const MaintainedQuantity& quantity) {
  return fmt::format(
             "  - sensor: {}\n    against: {}\n    quantity: {}\n    from: {}\n    unit: {}\n    changed: "
             "{}\n"
             "    change: {}\n    change_std: {}\n    chi_square: {}\n    limit: {}\n    would_notice: {}\n"
             "    matters: {}\n",
             yamlText(quantity.sensor), yamlText(quantity.against), quantity.name,
             sourceName(quantity.source), yamlText(quantity.unit), quantity.changed,
             roundedYaml(quantity.change), roundedYaml(quantity.change_sigma),
             roundedYaml(quantity.chi_square), roundedYaml(quantity.limit),
             roundedYaml(quantity.would_notice), roundedYaml(quantity.matters)) +
         numbersYaml(quantity.numbers, true);
}

std::string stepYaml(const MaintenanceStep& step) {
  std::string yaml = fmt::format(
      "  - sensor: {}\n    against: {}\n    quantity: {}\n    unit: {}\n    at_s: {:.2f}\n    noticed_s: "
      "{:.2f}\n"
      "    by: {}\n    by_std: {}\n    chi_square: {}\n    limit: {}\n",
      yamlText(step.sensor), yamlText(step.against), step.name, yamlText(step.unit), step.at_s,
      step.noticed_s, roundedYaml(step.size), roundedYaml(step.size_sigma), roundedYaml(step.chi_square),
      roundedYaml(step.limit));
  if (!step.or_else.empty()) {
    yaml += "    or_else: [";
    for (std::size_t i = 0; i < step.or_else.size(); ++i)
      yaml += (i == 0 ? "" : ", ") + yamlText(step.or_else[i]);
    yaml += "]\n";
  }
  return yaml + numbersYaml(step.numbers, false);
}

std::string imuYaml(const MaintainedImu& imu) {
  std::size_t used = 0;
  for (const MaintainedStop& stop : imu.stops) used += stop.used ? 1 : 0;
  return fmt::format(
      "  {}:\n    stream: {}\n    from_s: {:.3f}\n    to_s: {:.3f}\n    rate_hz: {:.2f}\n"
      "    stops: {{found: {}, used: {}, misfit: {}}}\n    weakest: {}\n    weakest_std: {}\n",
      yamlText(imu.name), yamlText(imu.stream), imu.from_s, imu.to_s, imu.rate_hz, imu.stops.size(), used,
      roundedYaml(imu.misfit), yamlText(imu.weakest), roundedYaml(imu.weakest_sigma));
}

Json numbersJson(const std::vector<MaintainedNumber>& numbers) {
  Json list = Json::array();
  for (const MaintainedNumber& each : numbers)
    list.push_back({{"name", each.name},
                    {"unit", each.unit},
                    {"before", finite(each.before)},
                    {"before_std", finite(each.before_sigma)},
                    {"now", finite(each.now)},
                    {"now_std", finite(each.now_sigma)}});
  return list;
}

std::string shown(double value) {
  return std::isfinite(value) ? html::significant(value, 3) : "-";
}

std::string ofText(const std::string& sensor, const std::string& against) {
  return against.empty() ? sensor : sensor + " against " + against;
}

std::string quantityRow(const MaintainedQuantity& quantity) {
  return fmt::format("{:<30}{:<28}{:>12} +- {:<10}{:<7}{:>12}  {}\n",
                     ofText(quantity.sensor, quantity.against), quantity.title, shown(quantity.change),
                     shown(quantity.change_sigma), quantity.unit == "1" ? "" : quantity.unit,
                     shown(quantity.would_notice),
                     quantity.changed  ? "changed"
                     : quantity.told() ? "unchanged"
                                       : "cannot tell");
}

}  // namespace

const char* verdictName(MaintenanceVerdict verdict) {
  static constexpr std::array<const char*, 3> kNames = {"unchanged", "changed", "cannot_tell"};
  return kNames.at(static_cast<std::size_t>(verdict));
}

const char* verdictWords(MaintenanceVerdict verdict) {
  static constexpr std::array<const char*, 3> kWords = {"nothing has changed", "changed", "cannot tell"};
  return kWords.at(static_cast<std::size_t>(verdict));
}

const char* sourceName(MaintenanceSource source) {
  static constexpr std::array<const char*, 3> kNames = {"stops", "trajectory", "other_imu"};
  return kNames.at(static_cast<std::size_t>(source));
}

std::string maintenanceYaml(const Maintenance& maintenance) {
  std::string yaml = fmt::format(
      "evical_maintenance: 1\nstatus: {}\nreason: {}\nresult: {}\nfalse_alarms: {}\nduration_s: {:.3f}\n",
      verdictName(maintenance.verdict), yamlText(maintenance.reason), yamlText(maintenance.before),
      maintenance.false_alarms, maintenance.duration_s);
  yaml += listYaml("logs", maintenance.logs);
  yaml += "imus:\n";
  for (const MaintainedImu& imu : maintenance.imus) yaml += imuYaml(imu);
  yaml += maintenance.quantities.empty() ? "quantities: []\n" : "quantities:\n";
  for (const MaintainedQuantity& quantity : maintenance.quantities) yaml += quantityYaml(quantity);
  yaml += maintenance.steps.empty() ? "steps: []\n" : "steps:\n";
  for (const MaintenanceStep& step : maintenance.steps) yaml += stepYaml(step);
  yaml += listYaml("advice", maintenance.advice) + listYaml("notes", maintenance.notes);
  return yaml + fmt::format("took_s: {:.1f}\nmemory_peak_mb: {:.0f}\nprogram: {{version: {}}}\n",
                            maintenance.took_s, maintenance.memory_peak_mb, yamlText(maintenance.version));
}

std::string maintenanceJson(const Maintenance& maintenance) {
  Json json = {{"evical_maintenance", 1},
               {"status", verdictName(maintenance.verdict)},
               {"reason", maintenance.reason},
               {"result", maintenance.before},
               {"false_alarms", maintenance.false_alarms},
               {"duration_s", maintenance.duration_s},
               {"logs", maintenance.logs},
               {"quantities", Json::array()},
               {"steps", Json::array()},
               {"advice", maintenance.advice},
               {"notes", maintenance.notes}};
  for (const MaintainedQuantity& quantity : maintenance.quantities)
    json["quantities"].push_back({{"sensor", quantity.sensor},
                                  {"against", quantity.against},
                                  {"quantity", quantity.name},
                                  {"from", sourceName(quantity.source)},
                                  {"unit", quantity.unit},
                                  {"changed", quantity.changed},
                                  {"change", finite(quantity.change)},
                                  {"change_std", finite(quantity.change_sigma)},
                                  {"would_notice", finite(quantity.would_notice)},
                                  {"numbers", numbersJson(quantity.numbers)}});
  for (const MaintenanceStep& step : maintenance.steps)
    json["steps"].push_back({{"sensor", step.sensor},
                             {"against", step.against},
                             {"quantity", step.name},
                             {"unit", step.unit},
                             {"at_s", step.at_s},
                             {"noticed_s", step.noticed_s},
                             {"by", finite(step.size)},
                             {"by_std", finite(step.size_sigma)},
                             {"or_else", step.or_else}});
  json["took_s"] = maintenance.took_s;
  json["program"] = {{"version", maintenance.version}};
  // Names of logs need not be UTF-8.
  return json.dump(2, ' ', false, decltype(json)::error_handler_t::replace) + "\n";
}

std::string maintenanceTable(const Maintenance& maintenance) {
  std::string text =
      fmt::format("{:<30}{:<28}{:>12}    {:<10}{:<7}{:>12}\n", "", "", "change", "", "", "would show");
  for (const MaintainedQuantity& quantity : maintenance.quantities) text += quantityRow(quantity);
  for (const MaintenanceStep& step : maintenance.steps) {
    text += fmt::format("at {:.1f} s (noticed at {:.1f} s): {} of {} by {} +- {} {}\n", step.at_s,
                        step.noticed_s, step.title, ofText(step.sensor, step.against), shown(step.size),
                        shown(step.size_sigma), step.unit == "1" ? "" : step.unit);
    for (const std::string& other : step.or_else) text += fmt::format("  or else: {}\n", other);
  }
  for (const MaintainedImu& imu : maintenance.imus)
    if (!imu.stops.empty())
      text +=
          fmt::format("{}: {} stops; least known from them: {}\n", imu.name, imu.stops.size(), imu.weakest);
  for (const std::string& note : maintenance.notes) text += fmt::format("Note: {}\n", note);
  text += fmt::format("{}: {}\n", verdictWords(maintenance.verdict), maintenance.reason);
  for (const std::string& advice : maintenance.advice) text += fmt::format("To do: {}\n", advice);
  return text;
}

std::string stopsCsv(const Maintenance& maintenance) {
  std::string text =
      "imu,from_s,to_s,force_x_m_s2,force_y_m_s2,force_z_m_s2,rate_x_rad_s,rate_y_rad_s,rate_z_rad_s,"
      "residual_m_s2,sigma_m_s2,used\n";
  for (const MaintainedImu& imu : maintenance.imus)
    for (const MaintainedStop& stop : imu.stops) {
      const Eigen::Vector3d &f = stop.force_m_s2, &w = stop.rate_rad_s;
      fmt::format_to(std::back_inserter(text),
                     "{},{:.3f},{:.3f},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.5g},{:.5g},{}\n",
                     csvWord(imu.name), stop.from_s, stop.to_s, f.x(), f.y(), f.z(), w.x(), w.y(), w.z(),
                     stop.residual_m_s2, stop.sigma_m_s2, stop.used ? 1 : 0);
    }
  return text;
}

std::string trackCsv(const MaintenanceTrack& track) {
  std::string text = "time_s";
  for (const std::string& column : track.columns)
    text += "," + csvWord(column) + "," + csvWord("std of " + column);
  text += "\n";
  for (std::size_t k = 0; k < track.times_s.size(); ++k) {
    fmt::format_to(std::back_inserter(text), "{:.3f}", track.times_s[k]);
    for (std::size_t c = 0; c < track.columns.size(); ++c)
      fmt::format_to(std::back_inserter(text), ",{:.7g},{:.4g}", track.values[c][k], track.sigmas[c][k]);
    text += "\n";
  }
  return text;
}

std::vector<TrackPart> partsOf(const MaintenanceTrack& track) {
  std::vector<TrackPart> all;
  for (std::size_t c = 0; c < track.columns.size(); ++c) {
    const std::string& column = track.columns[c];
    const std::string whole = column.substr(0, column.find(' '));
    const std::size_t dot = whole.find('.'), bracket = column.find('[');
    const std::string name = whole.substr(0, dot);
    if (all.empty() || all.back().name != name) {
      const std::string unit =
          bracket == std::string::npos ? "" : column.substr(bracket + 1, column.find(']') - bracket - 1);
      all.push_back({name, unit, {}, c});
    }
    all.back().parts.push_back(dot == std::string::npos ? "" : whole.substr(dot + 1));
  }
  return all;
}

}  // namespace evical
