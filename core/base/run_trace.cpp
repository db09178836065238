#include "core/base/run_trace.h"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <utility>

namespace evical {
namespace {

constexpr std::size_t kStageRow = 0;  // followed by the rows of threads
constexpr double kMicroseconds = 1e6;

std::string jsonText(std::string_view text) {
  std::string json = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      json += {'\\', c};
    else if (static_cast<unsigned char>(c) < 0x20)
      json += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      json += c;
  }
  return json + "\"";
}

std::string slice(std::string_view name, double begin_s, double end_s, std::size_t row,
                  const std::string& arguments = "{}") {
  return fmt::format(R"({{"ph":"X","pid":1,"tid":{},"name":{},"ts":{:.0f},"dur":{:.0f},"args":{}}})", row,
                     jsonText(name), kMicroseconds * begin_s, kMicroseconds * (end_s - begin_s), arguments);
}

std::string rowName(std::size_t row, std::string_view name) {
  return fmt::format(R"({{"ph":"M","pid":1,"tid":{},"name":"thread_name","args":{{"name":{}}}}})", row,
                     jsonText(name));
}

// Computing time since the process began.
std::optional<double> computing_s(const std::filesystem::path& task) {
  std::ifstream file(task / "schedstat");
  double nanoseconds = 0.0;
  if (!(file >> nanoseconds)) return std::nullopt;
  return 1e-9 * nanoseconds;
}

double processComputing_s() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double memory_mb() {
  std::ifstream file("/proc/self/statm");
  double all_pages = 0.0, resident_pages = 0.0;
  file >> all_pages >> resident_pages;
  return 1e-6 * resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

std::optional<int> threadId(const std::filesystem::path& task) {
  const std::string name = task.filename().string();
  int id = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), id);
  return error == std::errc{} && end == name.data() + name.size() ? std::optional(id) : std::nullopt;
}

}  // namespace

RunTrace::RunTrace(ProgressSink& shown)
    : shown_(shown),
      spent_s_(processComputing_s()),
      watcher_([this](const std::stop_token& stop) { watch(stop); }) {}

void RunTrace::stageStarted(const ProgressStage& stage) {
  {
    const std::lock_guard lock(mutex_);
    stages_.push_back({stopwatch_.elapsed_s(), stage.text()});
  }
  shown_.stageStarted(stage);
}

void RunTrace::log(LogLevel level, std::string_view text) {
  {
    const std::lock_guard lock(mutex_);
    logged_.push_back({stopwatch_.elapsed_s(), std::string(text)});
  }
  shown_.log(level, text);
}

void RunTrace::watch(const std::stop_token& stop) {
  using namespace std::chrono_literals;
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  watcher_id_ = gettid();
  while (!stop.stop_requested()) {
    sample();
    wake.wait_for(lock, stop, 10ms, [] { return false; });
  }
}

void RunTrace::sample() {
  namespace fs = std::filesystem;
  const std::lock_guard lock(mutex_);
  const double now_s = stopwatch_.elapsed_s();
  for (auto& [id, thread] : threads_) thread.seen = false;
  std::error_code none;
  for (fs::directory_iterator task("/proc/self/task", none), end; !none && task != end;
       task.increment(none)) {
    const std::optional<int> id = threadId(task->path());
    const std::optional<double> of_thread_s = computing_s(task->path());
    if (!id || !of_thread_s || *id == watcher_id_) continue;
    lookAt(*id, *of_thread_s, now_s);
  }
  std::erase_if(threads_, [](const auto& each) { return !each.second.seen; });
  const double spent_s = processComputing_s(), since_s = now_s - looked_s_;
  if (since_s > 0.0) counters_.push_back({now_s, (spent_s - spent_s_) / since_s, memory_mb()});
  spent_s_ = spent_s;
  looked_s_ = now_s;
}

// A new thread has begun since the last sample. A thread that waits for a processor counts as working.
void RunTrace::lookAt(int thread_id, double spent_s, double now_s) {
  constexpr double kMinShare = 0.02;
  const auto [found, is_new] = threads_.try_emplace(thread_id);
  Thread& thread = found->second;
  if (is_new) thread.row = freeRow();
  thread.seen = true;
  const double worked_s = spent_s - std::exchange(thread.computing_s, spent_s);
  if (worked_s < kMinShare * (now_s - looked_s_)) {
    thread.work = -1;
    return;
  }
  if (thread.work < 0) {
    thread.work = static_cast<std::ptrdiff_t>(work_.size());
    work_.push_back({std::max(looked_s_, now_s - worked_s), now_s, 0.0, thread.row});
  }
  Work& work = work_[static_cast<std::size_t>(thread.work)];
  work.end_s = now_s;
  work.computing_s += worked_s;
}

// Rows of ended threads are used again by new threads.
std::size_t RunTrace::freeRow() const {
  const auto isTaken = [&](std::size_t row) {
    return std::any_of(threads_.begin(), threads_.end(),
                       [&](const auto& each) { return each.second.row == row; });
  };
  std::size_t row = kStageRow + 1;
  while (isTaken(row)) ++row;
  return row;
}

std::string RunTrace::json() {
  sample();
  const std::lock_guard lock(mutex_);
  const double end_s = stopwatch_.elapsed_s();
  std::vector<std::string> events = {rowName(kStageRow, "stages")};
  std::set<std::size_t> rows;
  for (std::size_t i = 0; i < stages_.size(); ++i)
    events.push_back(slice(stages_[i].text, stages_[i].at_s,
                           i + 1 < stages_.size() ? stages_[i + 1].at_s : end_s, kStageRow));
  for (const Told& each : logged_)
    events.push_back(fmt::format(R"({{"ph":"i","s":"t","pid":1,"tid":{},"name":{},"ts":{:.0f}}})", kStageRow,
                                 jsonText(each.text), kMicroseconds * each.at_s));
  for (const Work& work : work_) {
    rows.insert(work.row);
    events.push_back(slice("at work", work.begin_s, work.end_s, work.row,
                           fmt::format(R"({{"computing_s":{:.6f}}})", work.computing_s)));
  }
  for (const std::size_t row : rows) events.push_back(rowName(row, fmt::format("thread {}", row)));
  for (const Counters& each : counters_) {
    const auto counter = [&](const char* name, double value) {
      events.push_back(
          fmt::format(R"({{"ph":"C","pid":1,"name":"{}","ts":{:.0f},"args":{{"value":{:.3f}}}}})", name,
                      kMicroseconds * each.at_s, value));
    };
    counter("processors in use", each.processors);
    counter("memory [MB]", each.memory_mb);
  }
  return fmt::format("{{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n{}\n]}}\n", fmt::join(events, ",\n"));
}

}  // namespace evical
