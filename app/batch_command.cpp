#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "app/output.h"
#include "app/slurm.h"
#include "app/version.h"
#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/pipeline/batch/batch_run.h"
#include "core/pipeline/batch/batch_table.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace evical {
namespace {

struct BatchArguments {
  std::string jobs, output, job, slurm_options;
  int at_once = 0, memory_limit_mb = 0;  // 0: from the file
  bool slurm = false, collect = false, quiet = false;
};

Batch batchFrom(const BatchArguments& arguments) {
  Batch batch = readBatch(arguments.jobs);
  if (arguments.at_once > 0) batch.at_once = arguments.at_once;
  if (arguments.memory_limit_mb > 0) batch.memory_limit_mb = arguments.memory_limit_mb;
  if (arguments.job.empty()) return batch;
  std::vector<std::string> names;
  for (const BatchJob& job : batch.jobs) names.push_back(job.name);
  const auto found = std::find(names.begin(), names.end(), arguments.job);
  if (found == names.end())
    throw badInput(arguments.jobs, "has no job '" + arguments.job + "'", nameAdvice(arguments.job, names));
  batch.jobs = {batch.jobs[static_cast<std::size_t>(found - names.begin())]};
  return batch;
}

std::filesystem::path thisProgram() {
  return std::filesystem::read_symlink("/proc/self/exe");
}

int printTable(const BatchArguments& arguments, const Batch& batch, std::vector<JobOutcome> outcomes) {
  const std::vector<BatchRow> rows = batchRows(batch, std::move(outcomes), arguments.output);
  writeBatchFiles(arguments.output, rows, kVersion);
  print("{}", batchText(rows));
  if (!arguments.quiet) print("Files are in {}\n", arguments.output);
  return allDone(rows) ? kDone : kFailed;
}

// One task of an array job. It prints no table: --collect does.
int runOne(const Batch& batch, const BatchPlace& place, BatchWatcher& watcher) {
  const JobOutcome outcome = runBatch(batch, place, watcher, stopOnSignals()).front();
  if (outcome.end == JobEnd::Done) return kDone;
  throw CalibrationError(outcome.end == JobEnd::BadInput ? ErrorKind::BadInput : ErrorKind::CalibrationFailed,
                         batch.jobs.front().name, outcome.reason.empty() ? "cancelled" : outcome.reason);
}

int run(const BatchArguments& arguments) {
  const Batch batch = batchFrom(arguments);
  std::error_code ignored;
  const std::filesystem::path folder =
      std::filesystem::absolute(arguments.output, ignored).lexically_normal();
  if (arguments.collect) {
    if (!std::filesystem::is_directory(folder / "jobs", ignored))
      throw badInput(arguments.output, "does not contain a batch", "Give the folder of 'evical batch -o'");
    std::vector<JobOutcome> outcomes = collectBatch(batch, folder);
    addQueueStates(batch, folder, outcomes);
    return printTable(arguments, batch, std::move(outcomes));
  }
  makeBatchFolder(folder);
  if (arguments.slurm) {
    print("{}\n", submitToSlurm(batch, {thisProgram(), folder, arguments.slurm_options}));
    return kDone;
  }
  BatchLines lines(batch.jobs.size(), arguments.quiet);
  const BatchPlace place{folder, thisProgram(), !arguments.job.empty()};
  if (!arguments.job.empty()) return runOne(batch, place, lines);
  const std::stop_token stop = stopOnSignals();
  std::vector<JobOutcome> outcomes = runBatch(batch, place, lines, stop);
  const int exit_code = printTable(arguments, batch, std::move(outcomes));
  if (stop.stop_requested()) throw Cancelled{};
  return exit_code;
}

void addPlaces(Command& command, BatchArguments& arguments) {
  command.option("JOBS", arguments.jobs, "File that lists the jobs (docs/clusters.md)").required();
  command.option("-o,--output", arguments.output, "Folder for the results, with one folder per job")
      .required();
  command
      .option("--jobs,--at-once", arguments.at_once, "Number of simultaneous jobs; default: at_once of JOBS")
      .between(1, 1024);
  command
      .option("--memory-limit", arguments.memory_limit_mb,
              "Memory limit of a job in MB; default: memory_limit_mb of JOBS")
      .between(1, 1 << 24);
  command.flag("--quiet", arguments.quiet, "Print only the table and errors");
}

}  // namespace

void addBatchCommand(Command& app, int& exit_code) {
  auto arguments = std::make_shared<BatchArguments>();
  Command command = app.command(
      "batch", "Calibrate many recordings independently, on the cores of one machine or a cluster");
  addPlaces(command, *arguments);
  Argument job =
      command.option("--job", arguments->job, "Run only the job of this name, like a task of an array job");
  Argument slurm = command.flag("--slurm", arguments->slurm,
                                "Write FOLDER/slurm.sh and submit it as an array job with one task per job");
  command
      .option("--slurm-options", arguments->slurm_options,
              "Additional options of sbatch, in one string: \"--partition=short --time=30\"")
      .needs(slurm);
  Argument collect =
      command.flag("--collect", arguments->collect, "Only print the table of the jobs that have ended");
  slurm.excludes(job).excludes(collect);
  collect.excludes(job);
  command.footer(
      "A second run continues an interrupted batch. Exit codes: 0 all jobs have a result; 1 some have none, "
      "the table "
      "gives the reason, or cancelled; 2 bad usage or an invalid file of jobs.");
  command.example("evical batch jobs.yaml -o results");
  command.action([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace evical
