#include "core/base/how_to.h"
#include "core/base/nearest_name.h"
#include "core/format/intrinsics_yaml.h"
#include "core/pipeline/session/import_session.h"
#include "core/pipeline/session/session_guess.h"
#include "core/recording/inspection.h"
#include "core/recording/recording_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace evical {
namespace {

// Ratio of eKalibr's own boards, which is suitable for printing.
constexpr double kUsualRadiusRate = 2.5;  // spacing by radius

// Kalibr counts rows and columns of tags; its spacing is the gap between two tags relative to the tag size.
void readAprilGrid(const YamlNode& root, Board& board) {
  board.type = BoardType::AprilGrid;
  board.rows = root["tagRows"].integer(1, 100);
  board.cols = root["tagCols"].integer(1, 100);
  board.tag_size_m = root["tagSize"].real(1e-4, 10.0, "m");
  board.spacing_m = (1.0 + root["tagSpacing"].real(1e-3, 100.0, "")) * board.tag_size_m;
  board.radius_m = 0.0;
}

void readCheckerboard(const YamlNode& root, Board& board) {
  board.type = BoardType::Checkerboard;
  board.rows = root["targetRows"].integer(2, 100);
  board.cols = root["targetCols"].integer(2, 100);
  board.spacing_m = root["rowSpacingMeters"].real(1e-4, 10.0, "m");
  board.radius_m = 0.0;
  constexpr double kSame = 1e-6;
  const YamlNode other = root["colSpacingMeters"];
  if (std::abs(other.real(1e-4, 10.0, "m") / board.spacing_m - 1.0) > kSame)
    throw other.error("differs from rowSpacingMeters, but Evical's checkerboards have square fields",
                      "Measure the board again, or use another one");
}

void readTarget(const YamlNode& root, const ImportRequest& request, ImportedSession& imported) {
  const std::string type = root["target_type"].text();
  Board& board = imported.session.board;
  if (type == "aprilgrid") return readAprilGrid(root, board);
  if (type == "checkerboard") return readCheckerboard(root, board);
  if (type != "circlegrid")
    throw root["target_type"].error(fmt::format("'{}' is not a known target type", type),
                                    "Use aprilgrid, checkerboard or circlegrid");
  const bool asymmetric =
      root["asymmetricGrid"].choice({"false", "true", "False", "True", "0", "1"}) % 2 == 1;
  board.type = asymmetric ? BoardType::AsymmetricCircles : BoardType::SymmetricCircles;
  board.rows = root["targetRows"].integer(2, 100);
  board.cols = root["targetCols"].integer(2, 100);
  board.spacing_m = root["spacingMeters"].real(1e-4, 10.0, "m");
  board.radius_m = request.radius_m.value_or(board.spacing_m / kUsualRadiusRate);
  if (!request.radius_m)
    imported.notes.push_back(fmt::format(
        "board: Kalibr's target has no circle radius; {:.4g} mm are assumed. Measure it and give {}",
        1e3 * board.radius_m, howTo(HowTo::Option, {"radius-m"})));
}

// Files of Kimera and EuRoC do not name a topic. The recording's only IMU is then used.
std::string onlyImuOf(const YamlNode& map, const ImportRequest& request) {
  std::vector<std::string> streams;
  if (!request.recording.empty()) {
    const std::unique_ptr<RecordingReader> recording = openRecording(request.recording);
    for (const StreamInfo& stream : recording->streams())
      if (stream.type == StreamType::Imu) streams.push_back(stream.name);
  }
  if (streams.size() == 1) return streams.front();
  throw map.error("has no rostopic", streams.empty()
                                         ? "Add rostopic: with the IMU's topic, or give " +
                                               howTo(HowTo::Option, {"recording FILE"}) + " with one IMU"
                                         : "Add rostopic: with one of " + joined(streams));
}

void readImu(const YamlNode& map, const std::string& key, const ImportRequest& request,
             ImportedSession& imported) {
  SessionImu imu;
  const auto topic = map.find("rostopic");
  imu.stream = topic ? topic->text() : onlyImuOf(map, request);
  imu.name = key.empty() ? sensorName(imu.stream, true, imported.session) : key;
  imu.noise.accelerometer_density = map["accelerometer_noise_density"].real(1e-7, 10.0, "m/s^2/sqrt(Hz)");
  imu.noise.gyroscope_density = map["gyroscope_noise_density"].real(1e-8, 10.0, "rad/s/sqrt(Hz)");
  if (const auto walk = map.find("accelerometer_random_walk"))
    imu.noise.accelerometer_random_walk = walk->real(0.0, 10.0, "m/s^3/sqrt(Hz)");
  if (const auto walk = map.find("gyroscope_random_walk"))
    imu.noise.gyroscope_random_walk = walk->real(0.0, 10.0, "rad/s^2/sqrt(Hz)");
  const auto model = map.find("model");
  if (model && model->text() != "calibrated")
    imported.notes.push_back(fmt::format("{}: its model {} is ignored: scales and misalignment are estimated",
                                         imu.name, model->text()));
  imported.session.imus.push_back(std::move(imu));
}

void readImus(const YamlNode& root, const ImportRequest& request, ImportedSession& imported) {
  if (!root.has("imu0")) return readImu(root, "", request, imported);
  for (const std::string& key : root.keys()) readImu(root[key], key, request, imported);
}

void readCameras(const YamlNode& root, const ImportRequest& request, ImportedSession& imported) {
  for (const std::string& key : camchainCameras(root)) {
    const YamlNode map = root[key];
    SessionCamera camera;
    camera.name = key;
    if (const auto topic = map.find("rostopic"); topic || request.recording.empty())
      camera.stream = map["rostopic"].text();
    camera.intrinsics = readIntrinsics(map);
    camera.resolution_px = camera.intrinsics->resolution_px;
    imported.session.cameras.push_back(std::move(camera));
  }
}

// Names of the streams of a type that no camera has yet; none if the recording cannot be opened.
std::vector<std::string> freeStreams(const ImportRequest& request, const Session& session, StreamType type) {
  std::vector<std::string> names;
  try {
    const std::unique_ptr<RecordingReader> recording = openRecording(request.recording);
    for (const StreamInfo& stream : recording->streams()) {
      const auto is_own = [&](const SessionCamera& camera) { return camera.stream == stream.name; };
      if (stream.type == type && stream.readable &&
          std::none_of(session.cameras.begin(), session.cameras.end(), is_own))
        names.push_back(stream.name);
    }
  } catch (const CalibrationError&) {
  }
  return names;
}

// For a camera without a topic: the only free stream, or the only one that has the camera's name in its own.
void findStream(const ImportRequest& request, SessionCamera& camera, ImportedSession& imported) {
  const Session& session = imported.session;
  // Kalibr calibrates frame cameras by boards of squares.
  std::array types = {StreamType::Frames, StreamType::Events};
  if (session.board.hasCircles()) std::swap(types[0], types[1]);
  std::vector<std::string> all = freeStreams(request, session, types[0]);
  if (all.empty()) all = freeStreams(request, session, types[1]);
  std::vector<std::string> named;
  for (const std::string& stream : all)
    if (stream.find(camera.name) != std::string::npos) named.push_back(stream);
  const auto unnamed = std::count_if(session.cameras.begin(), session.cameras.end(),
                                     [](const SessionCamera& other) { return other.stream.empty(); });
  if (named.size() != 1 && (all.size() != 1 || unnamed != 1))
    throw badInput(camera.name, "has no rostopic",
                   all.empty()
                       ? fmt::format("Add rostopic: with the camera's topic; {} has no stream of events "
                                     "or frames",
                                     request.recording.string())
                       : "Add rostopic: with one of " + joined(all));
  camera.stream = named.size() == 1 ? named.front() : all.front();
  imported.notes.push_back(
      fmt::format("{}: its camchain has no rostopic; the stream {} is used", camera.name, camera.stream));
}

// Notes on streams that do not suit the board.
void checkStreams(const ImportRequest& request, ImportedSession& imported) {
  Session& session = imported.session;
  const std::vector<std::string> frames = freeStreams(request, {}, StreamType::Frames),
                                 events = freeStreams(request, {}, StreamType::Events);
  for (const SessionCamera& camera : session.cameras) {
    const bool opened = !frames.empty() || !events.empty();
    if (session.board.hasCircles() && camera.stream.find("image") != std::string::npos &&
        (!opened || !events.empty()))
      imported.notes.push_back(
          fmt::format("{}: {} seems to be an image topic: give the topic of the events {}", camera.name,
                      camera.stream, howTo(HowTo::EditSession)));
  }
}

void findStreams(const ImportRequest& request, ImportedSession& imported) {
  for (SessionCamera& camera : imported.session.cameras)
    if (camera.stream.empty()) findStream(request, camera, imported);
  checkStreams(request, imported);
}

const char* nameOf(ImportKind kind) {
  if (kind == ImportKind::KalibrTarget) return "target";
  return kind == ImportKind::KalibrImu ? "imu" : "camchain";
}

bool isCameraOf(const StreamSummary& stream, StreamType type) {
  return stream.info.readable && stream.count > 0 && stream.info.type == type;
}

void addCamerasOf(StreamType type, const Inspection& inspection, ImportedSession& imported) {
  Session& session = imported.session;
  for (const StreamSummary& stream : inspection.streams) {
    if (!isCameraOf(stream, type)) continue;
    session.cameras.push_back(withSeenResolution(guessedCamera(stream, session), stream));
    imported.notes.push_back(
        fmt::format("{}: camera of the stream {}; its lens is calibrated first, from the same recording",
                    session.cameras.back().name, stream.info.name));
  }
}

// Without a camchain (before Kalibr was run) every stream that can detect the board becomes a camera.
void addRecordedCameras(const ImportRequest& request, ImportedSession& imported) {
  if (request.recording.empty())
    throw badInput("cameras", "none of the files describes a camera",
                   "Give Kalibr's camchain file, too, or " + howTo(HowTo::Option, {"recording FILE"}) +
                       ", whose event streams become the cameras");
  const Inspection inspection = inspectRecording(*openRecording(request.recording));
  Session& session = imported.session;
  addCamerasOf(StreamType::Events, inspection, imported);
  addCamerasOf(StreamType::Frames, inspection, imported);
  if (session.cameras.empty())
    throw badInput(request.recording.string(), "has no stream of events or frames",
                   "Give the recording of the cameras");
}

}  // namespace

void importKalibr(const std::vector<ImportSource>& sources, const ImportRequest& request,
                  ImportedSession& imported) {
  std::array<bool, 6> seen{};
  for (const ImportSource& source : sources) {
    bool& before = seen.at(static_cast<std::size_t>(source.kind));
    if (before && source.kind != ImportKind::KalibrImu)
      throw badInput(source.path.string(), fmt::format("is the second {} file", nameOf(source.kind)),
                     "Give one of each kind");
    before = true;
    if (source.kind == ImportKind::KalibrTarget) readTarget(source.root, request, imported);
    if (source.kind == ImportKind::KalibrImu) readImus(source.root, request, imported);
    if (source.kind == ImportKind::KalibrCamchain) readCameras(source.root, request, imported);
    if (source.kind == ImportKind::Intrinsics || source.kind == ImportKind::LensFile)
      throw badInput(source.path.string(), "has only intrinsics, without the name of a stream",
                     "Give Kalibr's camchain, or import this file alone");
  }
  if (!seen[static_cast<std::size_t>(ImportKind::KalibrTarget)])
    throw badInput("board", "none of the files describes the board", "Give Kalibr's target file, too");
  if (seen[static_cast<std::size_t>(ImportKind::KalibrCamchain)])
    findStreams(request, imported);
  else
    addRecordedCameras(request, imported);
}

}  // namespace evical
