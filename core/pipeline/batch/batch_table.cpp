#include "core/pipeline/batch/batch_table.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/yaml_node.h"
#include "core/format/quantity_yaml.h"
#include "core/report/csv_text.h"
#include "core/report/shown_quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace evical {
namespace {

std::vector<ShownQuantity> quantitiesOf(const NamedResult& result) {
  std::vector<ShownQuantity> all;
  const auto add = [&](std::vector<ShownQuantity> more) {
    std::move(more.begin(), more.end(), std::back_inserter(all));
  };
  for (std::size_t k = 0; k < result.cameras.size(); ++k)
    add(shownCamera(result, k, result.cameras[k].name != result.reference));
  for (std::size_t k = 0; k < result.imus.size(); ++k)
    add(shownImu(result, k, result.imus[k].name != result.reference));
  for (std::size_t k = 0; k < result.boards.size(); ++k) add(shownBoard(result, k));
  return all;
}

std::string columnOf(const ShownNumber& number) {
  return number.unit.empty() ? number.key : fmt::format("{} [{}]", number.key, number.unit);
}

// Largest sigma of a required quantity, in displayed units; empty if none was estimated.
std::string worstSigma(const BatchRow& row, QuantityNeed need, int decimals) {
  double worst = 0.0;
  if (row.result)
    for (const ShownQuantity& quantity : quantitiesOf(*row.result))
      if (quantity.info->need == need)
        for (const ShownNumber& number : quantity.numbers) worst = std::max(worst, number.sigma);
  return worst > 0.0 ? fmt::format("{:.{}f}", worst, decimals) : std::string();
}

std::size_t countOf(std::span<const BatchRow> rows, const std::string& status) {
  return static_cast<std::size_t>(
      std::count_if(rows.begin(), rows.end(), [&](const BatchRow& row) { return row.status() == status; }));
}

std::size_t countWithoutResult(std::span<const BatchRow> rows) {
  return static_cast<std::size_t>(std::count_if(
      rows.begin(), rows.end(), [](const BatchRow& row) { return row.outcome.end != JobEnd::Done; }));
}

std::string failuresText(std::span<const BatchRow> rows) {
  if (allDone(rows)) return {};
  std::string text = fmt::format("{} of {} have no result:\n", countWithoutResult(rows), rows.size());
  for (const BatchRow& row : rows)
    if (row.outcome.end != JobEnd::Done) text += fmt::format("  {}: {}\n", row.job->name, row.reason());
  return text;
}

}  // namespace

std::string BatchRow::status() const {
  return result ? statusName(result->result->status) : jobEndName(outcome.end);
}

std::string BatchRow::reason() const {
  if (result) return result->result->reason;
  return outcome.reason.empty() ? "was not run" : outcome.reason;
}

std::vector<BatchRow> batchRows(const Batch& batch, std::vector<JobOutcome> outcomes,
                                const std::filesystem::path& folder) {
  std::vector<BatchRow> rows;
  for (std::size_t k = 0; k < batch.jobs.size(); ++k) {
    BatchRow row{&batch.jobs[k], std::move(outcomes.at(k)), {}};
    if (row.outcome.end == JobEnd::Done) {
      try {
        row.result = readResultYaml(folder / row.job->name / "result.yaml");
      } catch (const CalibrationError& error) {
        row.outcome.end = JobEnd::Failed;
        row.outcome.reason = error.what();
      }
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

bool allDone(std::span<const BatchRow> rows) {
  return std::all_of(rows.begin(), rows.end(),
                     [](const BatchRow& row) { return row.outcome.end == JobEnd::Done; });
}

std::string batchText(std::span<const BatchRow> rows) {
  std::size_t width = 4;
  for (const BatchRow& row : rows) width = std::max(width, row.job->name.size());
  std::string text =
      fmt::format("{:<{}}  {:<13}  {:>14}  {:>16}  {:>16}  {:>8}  {:>11}\n", "job", width, "status",
                  "rotation [deg]", "translation [mm]", "time offset [ms]", "time [s]", "memory [MB]");
  for (const BatchRow& row : rows)
    text += fmt::format(
        "{:<{}}  {:<13}  {:>14}  {:>16}  {:>16}  {:>8.1f}  {:>11.0f}\n", row.job->name, width, row.status(),
        worstSigma(row, QuantityNeed::Rotation, 4), worstSigma(row, QuantityNeed::Translation, 3),
        worstSigma(row, QuantityNeed::TimeOffset, 4), row.outcome.wall_s, row.outcome.peak_memory_mb);
  return text + "Rotation, translation, time offset: one standard deviation of the least accurate sensor.\n" +
         failuresText(rows);
}

std::string batchCsv(std::span<const BatchRow> rows) {
  std::vector<std::string> columns;  // in the order of the results
  std::vector<std::map<std::string, ShownNumber>> numbers;
  for (const BatchRow& row : rows) {
    numbers.emplace_back();
    if (!row.result) continue;
    for (const ShownQuantity& quantity : quantitiesOf(*row.result))
      for (const ShownNumber& number : quantity.numbers) {
        const std::string column = columnOf(number);
        if (std::find(columns.begin(), columns.end(), column) == columns.end()) columns.push_back(column);
        numbers.back()[column] = number;
      }
  }
  std::string csv = "name,status,reason";
  for (const std::string& column : columns)
    csv += fmt::format(",{},{}", csvWord(column), csvWord(column + " std"));
  csv += ",wall_s,peak_memory_mb\n";
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const BatchRow& row = rows[k];
    csv += fmt::format("{},{},{}", csvWord(row.job->name), row.status(), csvWord(row.reason()));
    for (const std::string& column : columns) {
      const auto at = numbers[k].find(column);
      csv += at == numbers[k].end() ? std::string(",,")
                                    : fmt::format(",{:.9g},{:.4g}", at->second.value, at->second.sigma);
    }
    csv += fmt::format(",{:.3f},{:.1f}\n", row.outcome.wall_s, row.outcome.peak_memory_mb);
  }
  return csv;
}

std::string batchYaml(std::span<const BatchRow> rows, const std::string& version) {
  const bool done = allDone(rows);
  const std::string reason =
      done ? std::string()
           : fmt::format("{} of {} jobs have no result", countWithoutResult(rows), rows.size());
  std::string yaml = fmt::format(
      "evical_batch: 1\nstatus: {}\nreason: {}\nversion: {}\njobs: {}\nok: {}\ndoubtful: {}\nlist:\n",
      done ? "ok" : "failed", yamlLine(reason), yamlLine(version), rows.size(), countOf(rows, "ok"),
      countOf(rows, "doubtful"));
  for (const BatchRow& row : rows) {
    yaml += fmt::format("  - name: {}\n    status: {}\n    reason: {}\n    session: {}\n",
                        yamlText(row.job->name), row.status(), yamlLine(row.reason()),
                        yamlText(row.job->session.string()));
    if (!row.job->recording.empty())
      yaml += fmt::format("    recording: {}\n", yamlText(row.job->recording.string()));
    if (row.result) yaml += fmt::format("    result: {}\n", yamlText(row.job->name + "/result.yaml"));
    yaml += fmt::format("    wall_s: {:.3f}\n    peak_memory_mb: {:.1f}\n", row.outcome.wall_s,
                        row.outcome.peak_memory_mb);
  }
  return yaml;
}

void writeBatchFiles(const std::filesystem::path& folder, std::span<const BatchRow> rows,
                     const std::string& version) {
  const std::array<FileContent, 2> files = {FileContent{folder / "batch.csv", batchCsv(rows)},
                                            FileContent{folder / "batch.yaml", batchYaml(rows, version)}};
  writeFilesWhole(files);
}

}  // namespace evical
