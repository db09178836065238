#include "python/interruptible.h"

#include "python/errors.h"
#include "python/interpreter.h"

#include <cxxabi.h>
#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

namespace evical::python {
namespace {

namespace py = pybind11;

constexpr std::chrono::milliseconds kBetweenLooks(50);

// A function in a separate thread.
class Worker {
 public:
  explicit Worker(std::function<void(std::stop_token)> work)
      : thread_([this, call = std::move(work)](const std::stop_token& stop) {
          const Inside inside;
          try {
            call(stop);
          } catch (...) {
            failure_ = std::current_exception();
          }
          const std::lock_guard lock(mutex_);
          ended_ = true;
          end_.notify_all();
        }) {}

  bool endsWithin(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return end_.wait_for(lock, time, [this] { return ended_; });
  }
  void stop() { thread_.request_stop(); }
  std::exception_ptr join() {
    thread_.join();
    return failure_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable end_;
  bool ended_ = false;
  std::exception_ptr failure_;
  std::jthread thread_;  // the last member: it uses the others
};

void handOn(const RunLog::News& news, const py::object& progress) {
  if (!news.lines.empty()) {
    const py::object logger = py::module_::import("logging").attr("getLogger")("evical");
    for (const RunLog::Line& line : news.lines)
      called(logger.attr(levelName(line.level)), py::make_tuple("%s", textOf(line.text)));
  }
  if (news.moved && !progress.is_none()) called(progress, py::make_tuple(textOf(news.stage), news.fraction));
}

// Checks for signals and news until the worker ends. Returns what Python raised meanwhile.
std::exception_ptr attend(Worker& worker, RunLog& log, const py::object& progress) {
  std::optional<std::stop_callback<std::function<void()>>> stop_with_interpreter;
  if (!endOfInterpreter().stop_requested())  // else this thread ends it, and works until it is done
    stop_with_interpreter.emplace(endOfInterpreter(), [&worker] { worker.stop(); });
  try {
    for (bool ended = false; !ended;) {
      {
        const OthersWork others_work;
        ended = worker.endsWithin(kBetweenLooks);
      }
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      handOn(log.takeNews(), progress);
    }
  } catch (abi::__forced_unwind&) {
    stayForever();
  } catch (...) {
    return std::current_exception();
  }
  return nullptr;
}

}  // namespace

void RunLog::stageStarted(const ProgressStage& stage) {
  const std::lock_guard lock(mutex_);
  news_.stage = stage.text();
  news_.fraction = 0.0;
  news_.moved = true;
  text_ += fmt::format("{:9.3f} s  stage    {}\n", since_start_.elapsed_s(), news_.stage);
}

void RunLog::stageProgress(double fraction_of_stage) {
  const std::lock_guard lock(mutex_);
  news_.fraction = fraction_of_stage;
  news_.moved = true;
}

void RunLog::log(LogLevel level, std::string_view text) {
  const std::lock_guard lock(mutex_);
  text_ += fmt::format("{:9.3f} s  {:<7}  {}\n", since_start_.elapsed_s(), levelName(level), text);
  news_.lines.push_back({level, std::string(text)});
}

std::string RunLog::text() const {
  const std::lock_guard lock(mutex_);
  return text_;
}

RunLog::News RunLog::takeNews() {
  const std::lock_guard lock(mutex_);
  News taken = news_;
  news_.moved = false;
  news_.lines.clear();
  return taken;
}

void runInterruptibly(const py::object& progress, RunLog& log,
                      const std::function<void(const RunContext&)>& work) {
  checkProgress(progress);
  { const OthersWork stays_if_interpreter_ends; }
  Worker worker([&](std::stop_token stop) { work(RunContext{log, std::move(stop)}); });
  const std::exception_ptr interruption = attend(worker, log, progress);
  if (interruption) worker.stop();
  std::exception_ptr failure;
  {
    const OthersWork others_work;
    failure = worker.join();
  }
  if (interruption) std::rethrow_exception(interruption);
  if (failure) std::rethrow_exception(failure);
}

void checkProgress(const py::object& progress) {
  if (!progress.is_none() && PyCallable_Check(progress.ptr()) == 0)
    throw py::type_error("progress must be a function of a stage's name and its fraction done, or None");
}

}  // namespace evical::python
