#include "app/slurm.h"

#include "core/base/atomic_file.h"
#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/base/number.h"
#include "core/base/plain_text.h"
#include "core/base/yaml_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

namespace evical {
namespace {

std::filesystem::path scriptOf(const std::filesystem::path& folder) {
  return folder / "slurm.sh";
}
std::filesystem::path submittedOf(const std::filesystem::path& folder) {
  return folder / "jobs" / "slurm.yaml";
}

// Who reads a text of the script: sbatch the lines of #SBATCH, the shell the others.
enum class ScriptReader { Sbatch, Shell };

// A text of the script with its quotes. Control characters are refused: sbatch's lines end at a line break
// within quotes, too, and the shell would run the rest.
std::string inScript(ScriptReader reader, const std::string& text) {
  requirePlain(text, "--slurm", "a path or a name");
  if (reader == ScriptReader::Shell) return shellWord(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

// For sbatch, where a per cent sign in a file's name begins a pattern such as `name`.
std::string withoutPatterns(const std::string& path) {
  std::string text;
  for (const char c : path) text += c == '%' ? "%%" : std::string(1, c);
  return text;
}

std::string scriptText(const Batch& batch, const SlurmRequest& request,
                       const std::vector<std::string>& names) {
  std::string text = "#!/bin/bash\n#SBATCH --job-name=evical\n";
  text += fmt::format("#SBATCH --array=0-{}\n#SBATCH --cpus-per-task={}\n", names.size() - 1, batch.threads);
  if (batch.memory_limit_mb > 0) text += fmt::format("#SBATCH --mem={}M\n", batch.memory_limit_mb);
  // Tasks of a lost node are queued again; their output is appended to the same file.
  text += fmt::format(
      "#SBATCH --requeue\n#SBATCH --open-mode=append\n#SBATCH --output={}\n",
      inScript(ScriptReader::Sbatch, withoutPatterns((request.folder / "jobs").string()) + "/slurm-%a.txt"));
  text += "jobs=(";
  for (const std::string& name : names)
    text += (text.back() == '(' ? "" : " ") + inScript(ScriptReader::Shell, name);
  return text + fmt::format(")\nexec {} batch {} -o {} --job \"${{jobs[$SLURM_ARRAY_TASK_ID]}}\"\n",
                            inScript(ScriptReader::Shell, request.program.string()),
                            inScript(ScriptReader::Shell, batch.file.string()),
                            inScript(ScriptReader::Shell, request.folder.string()));
}

std::string trimmedContent(const std::filesystem::path& file) {
  std::string text = contentOfFile(file);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.pop_back();
  return text;
}

// Output of a Slurm tool, or nothing if it fails; `said` then receives its message.
std::optional<std::string> askSlurm(std::vector<std::string> command, const std::filesystem::path& folder,
                                    std::string* said = nullptr) {
  const std::filesystem::path file = folder / "jobs" / (command.front() + ".txt");
  ChildProcess process({std::move(command), file, 0, -1});
  const ProcessEnd end = process.wait();
  std::string text = trimmedContent(file);
  if (said != nullptr) *said = text;
  return end.exit_code == 0 ? std::optional(std::move(text)) : std::nullopt;
}

std::vector<std::string> unsettledJobs(const Batch& batch, const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const BatchJob& job : batch.jobs)
    if (const std::optional<JobOutcome> outcome = readOutcome(folder, job);
        !outcome || !isSettled(folder, job, *outcome))
      names.push_back(job.name);
  return names;
}

// The id is the last number: some sites print a greeting before it, and federations append ";cluster".
std::string idFrom(const std::string& answer) {
  const std::string line = answer.substr(answer.rfind('\n') + 1);
  return line.substr(0, line.find(';'));
}

std::map<std::string, std::string> queueStates(const std::filesystem::path& folder) {
  std::map<std::string, std::string> states;
  const YamlNode submitted = YamlNode::load(submittedOf(folder));
  const std::vector<YamlNode> names = submitted["jobs"].items();
  const std::optional<std::string> answer = askSlurm(
      {"squeue", "--noheader", "--array", "--jobs=" + submitted["id"].text(), "--format=%K %T"}, folder);
  std::istringstream lines(answer.value_or(""));
  std::size_t index = 0;
  for (std::string state; lines >> index >> state;)
    if (index < names.size()) states[names[index].text()] = state;
  return states;
}

}  // namespace

std::string submitToSlurm(const Batch& batch, const SlurmRequest& request) {
  const std::vector<std::string> names = unsettledJobs(batch, request.folder);
  if (names.empty()) return "All jobs have ended: nothing was submitted";
  const std::filesystem::path script = scriptOf(request.folder);
  writeFileWhole(script, scriptText(batch, request, names));
  std::vector<std::string> command = {"sbatch", "--parsable"};
  std::istringstream options(request.options);
  for (std::string word; options >> word;) command.push_back(word);
  command.push_back(script.string());
  std::string said;
  const std::optional<std::string> answer = askSlurm(std::move(command), request.folder, &said);
  if (!answer)
    throw calibrationFailed("sbatch", said.empty() ? "rejected the job" : said,
                            fmt::format("Correct --slurm-options, or {}", script.string()));
  const std::string id = idFrom(*answer);
  std::string yaml = fmt::format("evical_slurm: 1\nid: {}\njobs:\n", yamlText(id));
  for (const std::string& name : names) yaml += fmt::format("  - {}\n", yamlText(name));
  writeFileWhole(submittedOf(request.folder), yaml);
  return fmt::format("Submitted {} as Slurm's job {}", counted(names.size(), "job"), id);
}

void addQueueStates(const Batch& batch, const std::filesystem::path& folder, std::span<JobOutcome> outcomes) {
  std::map<std::string, std::string> states;
  try {
    states = queueStates(folder);
  } catch (const CalibrationError&) {
    return;  // not submitted, or no access to the queue
  }
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    const auto state = states.find(batch.jobs[k].name);
    if (state == states.end() || outcomes[k].end != JobEnd::NotRun) continue;
    std::string word = state->second;
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    outcomes[k].end = JobEnd::Elsewhere;
    outcomes[k].reason = "is in Slurm's queue: " + word;
  }
}

}  // namespace evical
