#include "core/pipeline/batch/batch_outcome.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/yaml_node.h"
#include "core/pipeline/session/session.h"
#include "core/pipeline/session/session_keys.h"

#include <fmt/format.h>

#include <array>
#include <span>
#include <system_error>

namespace evical {
namespace {

constexpr std::array<const char*, 8> kEndNames = {"not_run",   "elsewhere",     "done",   "failed",
                                                  "bad_input", "out_of_memory", "killed", "cancelled"};

// "recording /data/a.bag, 1234 bytes, changed 1732432"; for folders the time of the folder itself.
std::string stampOf(const char* role, const std::filesystem::path& path) {
  std::error_code error;
  const auto changed = std::filesystem::last_write_time(path, error);
  if (error) return fmt::format("{} {}, not there", role, path.string());
  const std::uintmax_t size_bytes = std::filesystem::file_size(path, error);
  return fmt::format("{} {}, {} bytes, changed {}", role, path.string(), error ? 0 : size_bytes,
                     changed.time_since_epoch().count());
}

// Recordings of a job. If the session cannot be read, only the job's own: the job will report the error.
std::vector<std::filesystem::path> recordingsOf(const BatchJob& job) {
  std::vector<std::filesystem::path> recordings = {job.recording};
  try {
    const Session session = readSessionOfRun(job.session);
    if (job.recording.empty()) {
      recordings = {session.recording};
      recordings.insert(recordings.end(), session.more_recordings.begin(), session.more_recordings.end());
    }
    for (const SessionCamera& camera : session.cameras) recordings.push_back(camera.recording);
    for (const SessionImu& imu : session.imus)
      recordings.insert(recordings.end(), {imu.recording, imu.accelerometer_recording});
  } catch (const CalibrationError&) {
  }
  std::erase_if(recordings, [](const std::filesystem::path& path) { return path.empty(); });
  return recordings;
}

}  // namespace

const char* jobEndName(JobEnd end) {
  return kEndNames.at(static_cast<std::size_t>(end));
}

std::vector<std::string> inputsOf(const BatchJob& job) {
  std::vector<std::string> inputs = {stampOf("session", job.session)};
  for (const std::filesystem::path& recording : recordingsOf(job))
    inputs.push_back(stampOf("recording", recording));
  for (const std::string& setting : job.settings) inputs.push_back("set " + setting);
  return inputs;
}

std::filesystem::path jobFile(const std::filesystem::path& folder, const BatchJob& job, const char* ending) {
  return folder / "jobs" / (job.name + ending);
}

std::optional<JobOutcome> readOutcome(const std::filesystem::path& folder, const BatchJob& job) {
  try {
    const YamlNode root = YamlNode::load(jobFile(folder, job, ".yaml"));
    root["evical_job"].integer(1, 1);
    JobOutcome outcome;
    outcome.end = static_cast<JobEnd>(root["end"].choice(std::span<const char* const>(kEndNames)));
    outcome.reason = root["reason"].text();
    outcome.wall_s = root["wall_s"].real();
    outcome.peak_memory_mb = root["peak_memory_mb"].real();
    for (const YamlNode& item : root["inputs"].items()) outcome.inputs.push_back(item.anyText());
    return outcome;
  } catch (const CalibrationError&) {
    return std::nullopt;
  }
}

void writeOutcome(const std::filesystem::path& folder, const BatchJob& job, const JobOutcome& outcome) {
  std::string yaml = fmt::format(
      "evical_job: 1\nname: {}\nend: {}\nreason: {}\nwall_s: {:.3f}\npeak_memory_mb: {:.1f}\ninputs:\n",
      yamlText(job.name), jobEndName(outcome.end), yamlLine(outcome.reason), outcome.wall_s,
      outcome.peak_memory_mb);
  for (const std::string& input : outcome.inputs) yaml += fmt::format("  - {}\n", yamlText(input));
  writeFileWhole(jobFile(folder, job, ".yaml"), yaml);
}

bool isSettled(const std::filesystem::path& folder, const BatchJob& job, const JobOutcome& outcome) {
  if (outcome.inputs != inputsOf(job)) return false;
  std::error_code ignored;
  if (outcome.end == JobEnd::Done) return std::filesystem::exists(folder / job.name / "result.yaml", ignored);
  return outcome.end == JobEnd::Failed;
}

}  // namespace evical
