// Results of a batch as a table for terminals, CSV and YAML.
#pragma once

#include "core/pipeline/batch/batch_jobs.h"
#include "core/report/result_yaml.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace evical {

struct BatchRow {
  const BatchJob* job = nullptr;
  JobOutcome outcome;
  std::optional<NamedResult> result;  // if Done

  std::string status() const;  // "ok", "doubtful", or the outcome
  std::string reason() const;
};

// Rows with the results in the folder; a result that cannot be read is a failure.
std::vector<BatchRow> batchRows(const Batch& batch, std::vector<JobOutcome> outcomes,
                                const std::filesystem::path& folder);

bool allDone(std::span<const BatchRow> rows);

// One line for each job: status, the worst sensor's standard deviations, time and memory; then the failures
// with reasons.
std::string batchText(std::span<const BatchRow> rows);

// One line for each job, two columns for each quantity of any result: value and standard deviation.
std::string batchCsv(std::span<const BatchRow> rows);
std::string batchYaml(std::span<const BatchRow> rows, const std::string& version);

// batch.csv and batch.yaml.
void writeBatchFiles(const std::filesystem::path& folder, std::span<const BatchRow> rows,
                     const std::string& version);

}  // namespace evical
