#include "python/result.h"

#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/base/yaml_node.h"
#include "core/pipeline/runs/result_files.h"
#include "core/pipeline/runs/run_data.h"
#include "core/pipeline/runs/saved_run.h"

#include <fmt/format.h>

#include <limits>
#include <string_view>
#include <utility>

namespace evical::python {
namespace {

bool hasSensorsOf(const CalibrationResult& numbers, const NamedResult& named) {
  return numbers.state.cameras.size() == named.cameras.size() &&
         numbers.state.imus.size() == named.imus.size() &&
         numbers.state.further_boards.size() + 1 == named.boards.size();
}

constexpr std::string_view kResultHead = "evical_result: 1\n", kTruthHead = "evical_truth: 1\n";

// Adds the parts of run.data that result.yaml does not contain.
void addRunData(const std::filesystem::path& yaml, Result& result) {
  const std::filesystem::path file = yaml.parent_path() / "run.data";
  if (!pathExists(file)) {
    result.missing.push_back("the trajectory: there is no run.data next to result.yaml");
    return;
  }
  ReadRunData data = readRunData(file, contentOfFile(yaml));
  result.missing = std::move(data.missing);
  if (!data.has_result) return;
  if (!hasSensorsOf(data.run.result, result.named)) {
    result.missing.push_back("the trajectory: run.data belongs to another run than result.yaml");
    return;
  }
  result.named.result = std::make_shared<const CalibrationResult>(std::move(data.run.result));
}

}  // namespace

double Result::known(double number) const {
  const bool without = is_truth || numbers().uncertainty.columns.empty();
  return without && number == 0.0 ? std::numeric_limits<double>::quiet_NaN() : number;
}

std::string Result::status() const {
  return is_truth ? "truth" : statusName(numbers().status);
}

std::string Result::yaml() const {
  const std::string text = resultYaml(named);
  return is_truth ? std::string(kTruthHead) + text.substr(kResultHead.size()) : text;
}

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
  result->is_truth = YamlNode::load(file).has("evical_truth");
  // A file with another name is a copy without its run.data.
  if (file.filename() == kResultFile)
    addRunData(file, *result);
  else
    result->missing.push_back("the trajectory: run.data is read only next to a file named result.yaml");
  return result;
}

ResultState stateOf(const Result& result) {
  CalibrationRun run;
  run.result = result.numbers();
  return {result.yaml(), runData(run), result.missing};
}

std::shared_ptr<Result> resultFrom(const ResultState& state) {
  auto result = std::make_shared<Result>();
  result->named = parseResultYaml(state.yaml, "result");
  result->is_truth = state.yaml.starts_with(kTruthHead);
  ReadRunData data = parseRunData(state.data);
  if (!data.has_result || !hasSensorsOf(data.run.result, result->named))
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
