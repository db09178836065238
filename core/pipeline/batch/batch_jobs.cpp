#include "core/pipeline/batch/batch_jobs.h"

#include "core/base/distinct_names.h"
#include "core/base/yaml_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>
#include <thread>

namespace evical {
namespace {

constexpr int kMostThreads = 256, kMostAtOnce = 1024, kMostMemory_mb = 1 << 24;

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
  if (const auto node = root.find("threads")) batch.threads = node->integer(1, kMostThreads);
  const int processors = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  batch.at_once = std::max(1, processors / batch.threads);
  if (const auto node = root.find("at_once")) batch.at_once = node->integer(1, kMostAtOnce);
  if (const auto node = root.find("memory_limit_mb"))
    batch.memory_limit_mb = node->integer(1, kMostMemory_mb);
  const YamlNode list = root["jobs"];
  const JobReader reader(root, batch.file.parent_path());
  for (const YamlNode& item : list.items()) batch.jobs.push_back(reader.read(item));
  if (batch.jobs.empty()) throw list.error("is empty", "Name at least one session or recording");
  nameJobs(list, batch.jobs);
  return batch;
}

}  // namespace evical
