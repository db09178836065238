#include "core/pipeline/runs/saved_run.h"

#include "core/pipeline/runs/result_files.h"
#include "core/pipeline/runs/run_data.h"

#include "core/base/file_places.h"
#include "core/base/yaml_node.h"
#include "core/pipeline/detection/detections_check.h"
#include "core/pipeline/session/given_points.h"
#include "core/pipeline/session/session_keys.h"
#include "core/report/detections_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

namespace evical {
namespace {

constexpr const char *kRun = "run.yaml", *kData = "run.data", *kLog = "log.txt";

// Paths of recordings relative to the folder, which may be moved together with them.
std::string placesYaml(const std::filesystem::path& folder, const Session& session) {
  std::string text;
  forEachRecording(session, [&](const std::filesystem::path& recording) {
    const auto place = std::filesystem::weakly_canonical(recording).lexically_relative(
        std::filesystem::weakly_canonical(folder));
    text += fmt::format("  - {}\n", yamlText(place.string()));
  });
  return "recordings_from_here:\n" + text;
}

std::string optionsYaml(const std::vector<OptionRow>& rows) {
  std::string text = rows.empty() ? "options: {}\n" : "options:\n";
  for (const OptionRow& row : rows) text += fmt::format("  {}: {}\n", row.name, yamlText(row.value));
  return text;
}

std::string summaryYaml(const RunSummary& summary, const std::string& places) {
  return fmt::format(
             "evical_run: 1\nname: {}\nmade_s: {}\nstatus: {}\nreason: {}\nrecording: {}\ntook_s: {:.3f}\n"
             "rejected_windows: {}\n",
             yamlLine(summary.name), summary.made_s, statusName(summary.status), yamlLine(summary.reason),
             yamlText(summary.recording), summary.took_s, summary.rejected_windows) +
         optionsYaml(summary.options) + places;
}

RunSummary summaryOf(const Session& session, const CalibrationResult& result) {
  RunSummary summary;
  summary.status = result.status;
  summary.reason = result.reason;
  summary.recording = session.recording.filename().string();
  summary.took_s = result.timing.total_s;
  summary.rejected_windows = static_cast<int>(result.rejected_windows.size());
  summary.options = differingOptions(session.options);
  return summary;
}

RunSummary summaryFrom(const YamlNode& root, const std::filesystem::path& folder) {
  if (!root.isMap() || !root.has("evical_run"))
    throw root.error("is not a list entry of a run", "Open result.yaml instead");
  root["evical_run"].integer(1, 1);
  constexpr int kMax = 1'000'000'000;
  RunSummary summary;
  summary.folder = folder;
  summary.name = root["name"].text();
  summary.made_s = root["made_s"].nanoseconds();
  summary.status = static_cast<CalibrationStatus>(root["status"].choice({"ok", "doubtful", "failed"}));
  summary.reason = root["reason"].text();
  summary.recording = root["recording"].anyText();
  summary.took_s = root["took_s"].real();
  summary.rejected_windows = root["rejected_windows"].integer(0, kMax);
  const YamlNode options = root["options"];
  for (const std::string& key : options.keys()) {
    OptionRow& row = summary.options.emplace_back();
    row.name = key;
    row.value = options[key].text();
  }
  return summary;
}

// Recordings that are missing at their old path may have been moved together with the folder.
void findRecordings(const YamlNode& places, const std::filesystem::path& folder, Session& session) {
  const std::vector<YamlNode> items = places.items();
  std::size_t next = 0;
  forEachRecording(session, [&](std::filesystem::path& recording) {
    const std::size_t place = next++;
    if (place >= items.size() || pathExists(recording)) return;
    const auto moved = (folder / items[place].anyText()).lexically_normal();
    if (pathExists(moved)) recording = moved;
  });
}

// Session for folders of earlier versions: sensors from result.yaml, board from detections.yaml.
Session sessionFrom(const NamedResult& named, const std::filesystem::path& folder) {
  Session session;
  session.source = folder / kResultFile;
  session.recording = folder / "recording";
  session.reference = named.reference;
  session.board_name = named.boards.front();
  for (std::size_t k = 0; k < named.cameras.size(); ++k) {
    SessionCamera camera;
    camera.name = named.cameras[k].name;
    camera.stream = named.cameras[k].stream;
    camera.intrinsics = named.result->state.cameras.at(k).lens.inUse();
    if (camera.intrinsics) camera.resolution_px = camera.intrinsics->resolution_px;
    session.cameras.push_back(std::move(camera));
  }
  for (const SensorDescription& known : named.imus) {
    SessionImu& imu = session.imus.emplace_back();
    imu.name = known.name;
    imu.stream = known.stream;
    imu.accelerometer_stream = known.accelerometer_stream;
    imu.noise = known.noise;
  }
  return session;
}

void readBoard(const YamlNode& detections, Session& session) {
  constexpr int kMax = 1000;
  constexpr double kMax_m = 100.0;
  const YamlNode map = detections["board"];
  session.recording = session.source.parent_path() / detections["recording"].anyText();
  session.board.type = static_cast<BoardType>(map["type"].choice(kBoardTypeNames));
  if (!session.board.hasPattern()) {
    session.board = boardOfPoints(pointsFrom(map["points_m"]));
    return;
  }
  session.board.rows = map["rows"].integer(1, kMax);
  session.board.cols = map["cols"].integer(1, kMax);
  session.board.spacing_m = map["spacing_m"].real(1e-6, kMax_m, "m");
  session.board.radius_m = map["radius_m"].real(0.0, kMax_m, "m");
  session.board.tag_size_m = map["tag_size_m"].real(0.0, kMax_m, "m");
  if (const auto node = map.find("first_tag")) session.board.first_tag = node->integer(0, kMax);
}

// Reads the files of a folder one by one; unreadable ones are noted.
class FolderReader {
 public:
  explicit FolderReader(std::filesystem::path folder) : folder_(std::move(folder)) {}

  SavedRun read() {
    saved_.log = contentOfFile(folder_ / kLog);
    readResult();
    readData();
    readSession();
    readSummary();
    if (!has_pass_) readTables();
    checkSizes();
    saved_.summary.folder = folder_;
    saved_.run = std::make_shared<const CalibrationRun>(std::move(run_));
    return std::move(saved_);
  }

 private:
  void note(const std::string& what, const CalibrationError& error) {
    saved_.missing.push_back(fmt::format("{}: {}", what, error.what()));
  }

  void readResult() {
    try {
      named_ = readResultYaml(folder_ / kResultFile);
      run_.result = *named_->result;
    } catch (const CalibrationError& error) {
      result_error_ = error;
      note("result.yaml", error);
    }
  }

  void readData() {
    ReadRunData data = readRunData(
        folder_ / kData, named_ ? std::optional(contentOfFile(folder_ / kResultFile)) : std::nullopt);
    if (!data.has_result && !named_) throw CalibrationError(*result_error_);
    if (data.has_result) run_.result = std::move(data.run.result);
    run_.intrinsics = std::move(data.run.intrinsics);
    has_pass_ = data.has_pass && data.run.detections.cameras.size() == run_.result.state.cameras.size() &&
                data.run.detections.imus.size() == run_.result.state.imus.size();
    if (has_pass_) run_.detections = std::move(data.run.detections);
    saved_.missing.insert(saved_.missing.end(), data.missing.begin(), data.missing.end());
  }

  void readSummary() {
    try {
      const YamlNode root = YamlNode::load(folder_ / kRun);
      saved_.summary = summaryFrom(root, folder_);
      findRecordings(root["recordings_from_here"], folder_, saved_.session);
    } catch (const CalibrationError& error) {
      saved_.summary = summaryOf(saved_.session, run_.result);
      if (pathExists(folder_ / kRun)) note("its name and date", error);
    }
  }

  void readSession() {
    try {
      if (!pathExists(folder_ / kSessionFile))
        throw badInput(kSessionFile, "is missing",
                       "Choose the recording again: earlier versions did not write this file");
      saved_.session = readSessionOfRun(folder_ / kSessionFile);
      return;
    } catch (const CalibrationError& error) {
      if (!named_) throw;
      note("the session of the run", error);
    }
    saved_.session = sessionFrom(*named_, folder_);
    try {
      readBoard(loadDetections(folder_), saved_.session);
    } catch (const CalibrationError& error) {
      note("the board", error);
    }
  }

  // Reads names, views and windows from the tables.
  void readTables() {
    run_.detections = {};
    run_.detections.start_ns = run_.result.start_ns.value_or(0);
    for (std::size_t k = 0; k < run_.result.state.cameras.size(); ++k) {
      const CameraLens& lens = run_.result.state.cameras[k].lens;
      run_.detections.cameras.emplace_back();
      run_.detections.lenses.push_back(lens);
      run_.detections.resolutions_px.push_back(lens.inUse() ? lens.inUse()->resolution_px : Resolution{});
      if (k < saved_.session.cameras.size())
        run_.detections.cameras[k].camera = saved_.session.cameras[k].name;
    }
    int points = saved_.session.board.pointCount();
    for (const SessionBoard& board : saved_.session.further_boards)
      points = std::max(points, board.board.pointCount());
    try {
      for (BoardObservations& found : readDetections(folder_, points))
        for (BoardObservations& camera : run_.detections.cameras)
          if (camera.camera == found.camera) camera = found;
    } catch (const CalibrationError& error) {
      note("the detections of the board", error);
    }
  }

  // Checks that the data match the session's lists and the board's points, on which pages rely.
  void checkSizes() {
    const Session& session = saved_.session;
    bool same = session.cameras.size() == run_.result.state.cameras.size() &&
                session.imus.size() == run_.result.state.imus.size() &&
                session.further_boards.size() == run_.result.state.further_boards.size();
    for (std::size_t k = 0; same && k < run_.detections.cameras.size(); ++k)
      for (const BoardView& view : run_.detections.cameras[k].views)
        for (const CircleObservation& circle : view.circles)
          same = same && circle.circle < session.boardOf(k).pointCount();
    dropResidualsOfNoView();
    if (!same && run_.result.status != CalibrationStatus::Failed)
      throw badInput((folder_ / kSessionFile).string(), "it is not the session of the result in this folder",
                     "Export or calibrate again: the folder contains parts of two runs");
  }

  // The tables may have fewer views.
  void dropResidualsOfNoView() {
    std::erase_if(run_.result.circle_residuals, [&](const CircleResidual& r) {
      return static_cast<std::size_t>(r.view) >=
             run_.detections.cameras.at(static_cast<std::size_t>(r.camera)).views.size();
    });
  }

  std::filesystem::path folder_;
  SavedRun saved_;
  CalibrationRun run_;
  std::optional<NamedResult> named_;
  std::optional<CalibrationError> result_error_;
  bool has_pass_ = false;
};

std::uintmax_t sizeOf(const std::filesystem::path& folder) {
  std::uintmax_t bytes = 0;
  std::error_code error;
  for (std::filesystem::recursive_directory_iterator file(folder, error), end; !error && file != end;
       file.increment(error)) {
    std::error_code ignored;
    if (file->is_regular_file(ignored)) bytes += file->file_size(ignored);
  }
  return bytes;
}

}  // namespace

std::filesystem::path resultFileOf(const std::filesystem::path& path, const char* name) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored) ? path / name : path;
}

NamedResult readOldResult(const std::filesystem::path& path, const std::string& what) {
  const std::filesystem::path file = resultFileOf(path);
  if (!pathExists(file))
    throw badInput(file.string(), "does not exist", "Give the folder of a calibration, or its result.yaml");
  NamedResult named = readResultYaml(file);
  if (named.result->status == CalibrationStatus::Failed)
    throw badInput(file.string(), "the calibration failed: " + named.result->reason,
                   fmt::format("Calibrate again: a failed calibration cannot be {}", what));
  return named;
}

std::optional<Session> sessionOfOldResult(const std::filesystem::path& path) {
  const std::filesystem::path kept = resultFileOf(path).parent_path() / kSessionFile;
  return pathExists(kept) ? std::optional(readSessionOfRun(kept)) : std::nullopt;
}

std::vector<FileContent> runFiles(const std::filesystem::path& folder, const Session& session,
                                  const CalibrationRun& run, const std::string& result_yaml,
                                  std::int64_t made_s) {
  RunSummary summary = summaryOf(session, run.result);
  summary.made_s = made_s;
  return {{kSessionFile, sessionYaml(session, folder)},
          {kData, {}, [&run, result_yaml](const TextSink& sink) { writeRunData(run, result_yaml, sink); }},
          {kRun, summaryYaml(summary, placesYaml(folder, session))}};
}

void keepRun(const std::filesystem::path& folder, const Session& session,
             const std::shared_ptr<const CalibrationRun>& run, const std::string& version,
             const std::string& log, std::int64_t made_s) {
  makeOutputFolder(folder);
  const std::string result_yaml = resultYaml(namedRun(session, run, version));
  std::vector<FileContent> files = runFiles(folder, session, *run, result_yaml, made_s);
  files.push_back({kLog, log});
  files.push_back({kResultFile, result_yaml});  // written last: marks a complete result
  for (FileContent& file : files) file.path = folder / file.path;
  writeFilesWhole(files);
}

bool isSavedRun(const std::filesystem::path& path) {
  const std::filesystem::path name = path.filename();
  if (name == kResultFile || name == kRun) return pathExists(path);
  return pathExists(path / kResultFile) || pathExists(path / kRun);
}

SavedRun readSavedRun(const std::filesystem::path& path) {
  return FolderReader(resultFileOf(path).parent_path()).read();
}

RunSummary readRunSummary(const std::filesystem::path& folder) {
  return summaryFrom(YamlNode::load(folder / kRun), folder);
}

void renameRun(const std::filesystem::path& folder, const std::string& name) {
  const YamlNode root = YamlNode::load(folder / kRun);
  RunSummary summary = summaryFrom(root, folder);
  summary.name = name;
  std::string places = "recordings_from_here:\n";
  for (const YamlNode& place : root["recordings_from_here"].items())
    places += fmt::format("  - {}\n", yamlText(place.anyText()));
  writeFileWhole(folder / kRun, summaryYaml(summary, places));
}

std::vector<RunSummary> listRuns(const std::filesystem::path& folder) {
  std::vector<RunSummary> runs;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (!pathExists(entry->path() / kRun)) continue;
    try {
      runs.push_back(readRunSummary(entry->path()));
    } catch (const CalibrationError&) {
      // The error is reported when the run is opened.
    }
  }
  std::sort(runs.begin(), runs.end(), [](const RunSummary& a, const RunSummary& b) {
    return std::pair(a.made_s, a.folder) < std::pair(b.made_s, b.folder);
  });
  return runs;
}

std::vector<std::string> differingFrom(const RunSummary& before, const RunSummary& run) {
  const auto valueIn = [](const RunSummary& summary, const std::string& name) {
    const auto found = std::find_if(summary.options.begin(), summary.options.end(),
                                    [&](const OptionRow& row) { return row.name == name; });
    return found == summary.options.end() ? std::string("default") : found->value;
  };
  std::vector<std::string> texts;
  for (const OptionRow& row : run.options)
    if (const std::string was = valueIn(before, row.name); was != row.value)
      texts.push_back(fmt::format("{} {} (was {})", row.name, row.value, was));
  for (const OptionRow& row : before.options)
    if (valueIn(run, row.name) == "default")
      texts.push_back(fmt::format("{} default (was {})", row.name, row.value));
  return texts;
}

void removeOldRuns(std::vector<RunSummary> runs, std::size_t most, std::uintmax_t max_bytes) {
  if (runs.empty()) return;
  std::sort(runs.begin(), runs.end(),
            [](const RunSummary& a, const RunSummary& b) { return a.made_s < b.made_s; });
  std::stable_partition(runs.begin(), runs.end() - 1, [](const RunSummary& run) { return run.name.empty(); });
  std::vector<std::uintmax_t> sizes;
  for (const RunSummary& run : runs) sizes.push_back(sizeOf(run.folder));
  std::uintmax_t bytes = 0;
  for (const std::uintmax_t size : sizes) bytes += size;
  for (std::size_t k = 0; k + 1 < runs.size() && (runs.size() - k > most || bytes > max_bytes); ++k) {
    std::error_code ignored;
    std::filesystem::remove_all(runs[k].folder, ignored);
    bytes -= sizes[k];
  }
}

namespace {

std::optional<QualityWarning> causeToTell(const CalibrationOutcome& outcome, bool folder_was_there) {
  if (outcome.error && outcome.error->kind() == ErrorKind::CalibrationFailed)
    return QualityWarning{outcome.error->what(), outcome.error->repair(), "failure"};
  if (outcome.status == RunStatus::Cancelled && folder_was_there)
    return QualityWarning{"cancelled", {}, "cancelled"};
  return std::nullopt;
}

}  // namespace

void writeUnfinishedRun(const std::filesystem::path& folder, bool folder_was_there, const Session& session,
                        const CalibrationOutcome& outcome, const std::string& version,
                        const std::string& log) {
  const std::optional<QualityWarning> cause = causeToTell(outcome, folder_was_there);
  std::error_code ignored;
  if (!cause || !std::filesystem::is_directory(folder, ignored)) return;
  // A failed run keeps an earlier result of the same folder: that is still valid for its recording.
  if (std::filesystem::exists(folder / "trajectory.csv", ignored)) return;
  writeFailure(folder, session, *cause, version, log, outcome.detections);
}

}  // namespace evical
