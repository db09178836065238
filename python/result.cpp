#include "python/result.h"

#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/pipeline/runs/result_files.h"
#include "core/pipeline/runs/run_data.h"
#include "core/pipeline/runs/saved_run.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

namespace evical::python {
namespace {

// Adds the parts of run.data that result.yaml does not contain. Both must have the same sensors.
void addRunData(const std::filesystem::path& file, Result& result) {
  if (!isThere(file)) {
    result.missing.push_back("the trajectory: there is no run.data next to result.yaml");
    return;
  }
  ReadRunData data = readRunData(file);
  result.missing = std::move(data.missing);
  if (!data.has_result) return;
  const CalibrationState& known = result.numbers().state;
  const CalibrationState& kept = data.run.result.state;
  if (kept.cameras.size() != known.cameras.size() || kept.imus.size() != known.imus.size()) {
    result.missing.push_back("the trajectory: run.data belongs to another run than result.yaml");
    return;
  }
  result.named.result = std::make_shared<const CalibrationResult>(std::move(data.run.result));
}

}  // namespace

std::shared_ptr<const Result> resultOf(const Session& session, const CalibrationRun& run) {
  const std::shared_ptr<const CalibrationRun> not_owned(std::shared_ptr<void>(), &run);
  auto result = std::make_shared<Result>();
  result->named = namedRun(session, not_owned, EVICAL_VERSION);
  result->named.result = std::make_shared<const CalibrationResult>(run.result);
  return result;
}

std::shared_ptr<const Result> loadResult(const std::filesystem::path& path) {
  const std::filesystem::path file = resultFileOf(path);
  auto result = std::make_shared<Result>();
  result->named = readResultYaml(file);
  // A file with another name is a copy without its run.data.
  if (file.filename() == kResultFile)
    addRunData(file.parent_path() / "run.data", *result);
  else
    result->missing.push_back("the trajectory: run.data is read only next to a file named result.yaml");
  return result;
}

ResultState stateOf(const Result& result) {
  CalibrationRun run;
  run.result = result.numbers();
  return {resultYaml(result.named), runData(run), result.missing};
}

std::shared_ptr<Result> resultFrom(const ResultState& state) {
  auto result = std::make_shared<Result>();
  result->named = parseResultYaml(state.yaml, "result");
  ReadRunData data = parseRunData(state.data);
  if (!data.has_result)
    throw badInput("result", "comes from another version of Evical", "Use the same version in all processes");
  result->named.result = std::make_shared<const CalibrationResult>(std::move(data.run.result));
  result->missing = state.missing;
  return result;
}

Trajectory trajectoryOf(const std::shared_ptr<const Result>& result) {
  if (result->hasTrajectory()) return {result};
  std::string why;
  for (const std::string& each : result->missing) why += (why.empty() ? "" : "; ") + each;
  throw badInput("trajectory", why.empty() ? "the result has none" : "the result has none (" + why + ")",
                 "Load the folder that a calibration wrote, or calibrate again");
}

}  // namespace evical::python
