// What came of a batch, as a table for terminals, CSV and YAML.
#pragma once

#include "core/pipeline/batch/batch_jobs.h"
#include "core/pipeline/batch/batch_outcome.h"
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
  std::optional<NamedResult> result;  // of what is done

  std::string status() const;  // "ok", "doubtful", or how it ended
  std::string reason() const;
};

// With the results that jobs left in the folder; one that can't be read is a failure.
std::vector<BatchRow> batchRows(const Batch& batch, std::vector<JobOutcome> outcomes,
                                const std::filesystem::path& folder);

bool allDone(std::span<const BatchRow> rows);

// One line a job: status, the worst sensor's standard deviations, time and memory; then what failed, with reasons.
std::string batchText(std::span<const BatchRow> rows);

// One line a job, two columns for each quantity that some result has: its value and its standard deviation.
std::string batchCsv(std::span<const BatchRow> rows);
std::string batchYaml(std::span<const BatchRow> rows, const std::string& version);

// batch.csv and batch.yaml.
void writeBatchFiles(const std::filesystem::path& folder, std::span<const BatchRow> rows,
                     const std::string& version);

}  // namespace evical
