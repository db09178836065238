#include "core/pipeline/batch/batch_jobs.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/yaml_node.h"
#include "core/pipeline/session/session.h"
#include "core/pipeline/session/session_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <system_error>
#include <thread>

namespace evical {
namespace {

constexpr int kMaxThreads = 256, kMaxAtOnce = 1024, kMaxMemory_mb = 1 << 24;

std::filesystem::path beside(const YamlNode& node, const std::filesystem::path& folder) {
  const std::string text = node.anyText();
  if (text.empty()) throw node.error("is empty", "Name a file");
  return (folder / text).lexically_normal();
}

std::vector<std::string> settingsFrom(const YamlNode& map) {
  std::vector<std::string> settings;
  if (map.isNull()) return settings;
  for (const std::string& key : map.keys()) settings.push_back(key + "=" + map[key].text());
  return settings;
}

bool namesSession(const std::filesystem::path& path) {
  return path.extension() == ".yaml" || path.extension() == ".yml";
}

class JobReader {
 public:
  JobReader(const YamlNode& root, const std::filesystem::path& folder) : folder_(folder) {
    if (const auto node = root.find("session")) template_ = beside(*node, folder);
    if (const auto node = root.find("set")) settings_ = settingsFrom(*node);
  }

  BatchJob read(const YamlNode& node) const {
    BatchJob job;
    job.settings = settings_;
    if (node.isScalar()) {
      const std::filesystem::path path = beside(node, folder_);
      (namesSession(path) ? job.session : job.recording) = path;
    } else {
      readMap(node, job);
    }
    if (job.session.empty()) job.session = template_;
    if (job.session.empty())
      throw node.error("names a recording, but no session describes it",
                       "Add 'session: FILE' at the top for all jobs, or to this job");
    if (job.session == template_ && job.recording.empty())
      throw node.error("has neither a recording nor a session", "Name one of them");
    return job;
  }

 private:
  void readMap(const YamlNode& node, BatchJob& job) const {
    node.allowOnly({"name", "session", "recording", "set"});
    if (const auto name = node.find("name")) {
      job.name = name->text();
      if (job.name.empty() || job.name != fitForFolder(job.name) || job.name == "jobs")
        throw name->error(fmt::format("'{}' is not a valid name for a result folder", job.name),
                          "Use letters, digits, '-', '_' and '.', and not 'jobs'");
    }
    if (const auto session = node.find("session")) job.session = beside(*session, folder_);
    if (const auto recording = node.find("recording")) job.recording = beside(*recording, folder_);
    if (const auto set = node.find("set"))
      for (std::string& setting : settingsFrom(*set)) job.settings.push_back(std::move(setting));
  }

  std::filesystem::path folder_, template_;
  std::vector<std::string> settings_;
};

// Derives names from session or recording for jobs without a name.
void nameJobs(const YamlNode& list, std::vector<BatchJob>& jobs) {
  std::vector<std::filesystem::path> paths;
  std::set<std::string> taken = {"jobs"};
  for (const BatchJob& job : jobs) {
    if (job.name.empty()) paths.push_back(job.recording.empty() ? job.session : job.recording);
    if (!job.name.empty() && !taken.insert(job.name).second)
      throw list.error(fmt::format("two jobs have the name '{}'", job.name),
                       "Give each job a different name");
  }
  const std::vector<std::string> names = distinctNames(paths);
  std::size_t next = 0;
  for (BatchJob& job : jobs) {
    if (!job.name.empty()) continue;
    const std::string& stem = names.at(next++);
    job.name = stem;
    for (int k = 2; !taken.insert(job.name).second; ++k) job.name = fmt::format("{}_{}", stem, k);
  }
}

}  // namespace

Batch readBatch(const std::filesystem::path& file) {
  const YamlNode root = YamlNode::load(file);
  root.allowOnly({"evical_batch", "session", "set", "at_once", "threads", "memory_limit_mb", "jobs"});
  root["evical_batch"].integer(1, 1);
  std::error_code ignored;
  Batch batch;
  batch.file = std::filesystem::absolute(file, ignored).lexically_normal();
  if (const auto node = root.find("threads")) batch.threads = node->integer(1, kMaxThreads);
  const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  batch.at_once = std::max(1, processors / batch.threads);
  if (const auto node = root.find("at_once")) batch.at_once = node->integer(1, kMaxAtOnce);
  if (const auto node = root.find("memory_limit_mb")) batch.memory_limit_mb = node->integer(1, kMaxMemory_mb);
  const YamlNode list = root["jobs"];
  const JobReader reader(root, batch.file.parent_path());
  for (const YamlNode& item : list.items()) batch.jobs.push_back(reader.read(item));
  if (batch.jobs.empty()) throw list.error("is empty", "Name at least one session or recording");
  nameJobs(list, batch.jobs);
  return batch;
}

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
