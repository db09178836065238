#include "core/base/file_places.h"
#include "core/base/how_to.h"
#include "core/base/nearest_name.h"
#include "core/base/plain_text.h"
#include "core/export/export_target.h"
#include "core/format/intrinsics_yaml.h"
#include "core/geometry/camera_model.h"
#include "core/initialisation/initialisation_options.h"
#include "core/numerics/normal_gravity.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/session/session_boards.h"
#include "core/pipeline/session/session_boards_reader.h"
#include "core/pipeline/session/session_keys.h"
#include "core/pipeline/session/session_priors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

struct SessionFolder {
  std::filesystem::path path;
  bool recordings_may_be_gone = false;
};

std::filesystem::path recordingBeside(const YamlNode& node, const SessionFolder& folder) {
  return folder.recordings_may_be_gone ? folder.path / pathFrom(node) : besideSession(node, folder.path);
}

Resolution readResolution(const YamlNode& node) {
  const std::vector<YamlNode> items = node.items();
  if (items.size() != 2) throw node.error("must be [width, height]");
  return {items[0].integer(1, 30000), items[1].integer(1, 30000)};
}

constexpr double kLargestOffset_s = 4.6e9;  // covers all times of recordings (kLatestTime_ns)

std::string columnsFrom(const YamlNode& node) {
  std::string columns = node.anyText();  // a table's header may have tabs
  if (columns.empty()) throw node.error("is empty", "Name the columns");
  if (columns.find('?') != std::string::npos)
    throw node.error("has a ?", "Replace it by the column's name, or by - if the column is not used");
  return columns;
}

void readColumns(const YamlNode& node, SessionCamera& camera) {
  camera.columns = columnsFrom(node);
}

// One line, or one for each of the two sensors.
void readColumns(const YamlNode& node, SessionImu& imu) {
  if (!node.isMap()) {
    imu.columns = columnsFrom(node);
    return;
  }
  node.allowOnly({"gyroscope", "accelerometer"});
  imu.columns = columnsFrom(node["gyroscope"]);
  imu.accelerometer_columns = columnsFrom(node["accelerometer"]);
}

// Reads clock and columns of a stream.
template <class Sensor>
void readTable(const YamlNode& map, Sensor& sensor) {
  if (const auto node = map.find("clock_offset_s"))
    sensor.clock_offset_s = node->real(-kLargestOffset_s, kLargestOffset_s, "s");
  if (const auto node = map.find("clock_scale"))
    sensor.clock_scale = node->real(kMinClockScale, 1.0 / kMinClockScale, "");
  if (const auto columns = map.find("columns")) readColumns(*columns, sensor);
}

// Files of the gyroscope and the accelerometer.
std::vector<YamlNode> recordingsOfSensors(const YamlNode& node) {
  std::vector<YamlNode> files = node.items();
  if (files.size() != 2)
    throw node.error("must name two files", "Give [gyroscope's file, accelerometer's file], or one file");
  return files;
}

void readRecording(const YamlNode& node, const SessionFolder& folder, SessionCamera& camera) {
  camera.recording = recordingBeside(node, folder);
}

void readRecording(const YamlNode& node, const SessionFolder& folder, SessionImu& imu) {
  if (!node.isSequence()) {
    imu.recording = recordingBeside(node, folder);
    return;
  }
  const std::vector<YamlNode> files = recordingsOfSensors(node);
  imu.recording = recordingBeside(files[0], folder);
  imu.accelerometer_recording = recordingBeside(files[1], folder);
  if (imu.accelerometer_stream.empty())
    throw node.error("names two files, but only one stream",
                     "Give gyroscope and accelerometer instead of stream");
}

void readStream(const YamlNode& map, SessionCamera& camera) {
  camera.stream = nameFrom(map["stream"]);
}

// One stream, or one for each of the two sensors.
void readStream(const YamlNode& map, SessionImu& imu) {
  const auto gyroscope = map.find("gyroscope"), accelerometer = map.find("accelerometer");
  const auto recording = map.find("recording");
  if (!gyroscope && !accelerometer && recording && recording->isSequence() && !map.has("stream")) {
    // Tables, whose only streams have the files' names.
    const std::vector<YamlNode> files = recordingsOfSensors(*recording);
    imu.stream = visible(pathFrom(files[0]).filename().string());
    imu.accelerometer_stream = accelerometerTable(pathFrom(files[0]), pathFrom(files[1]));
    return;
  }
  if (!gyroscope && !accelerometer) {
    imu.stream = nameFrom(map["stream"]);
    return;
  }
  if (const auto node = map.find("stream"))
    throw node->error("cannot be combined with gyroscope or accelerometer",
                      "Give either stream, or gyroscope and accelerometer");
  imu.stream = nameFrom(map["gyroscope"]);
  imu.accelerometer_stream = nameFrom(map["accelerometer"]);
}

// File, stream and clock of a sensor.
template <class Sensor>
Sensor readSource(const YamlNode& map, const std::string& sensor_name, const SessionFolder& folder) {
  Sensor sensor;
  sensor.name = sensor_name;
  readStream(map, sensor);
  if (const auto node = map.find("recording")) readRecording(*node, folder, sensor);
  readTable(map, sensor);
  return sensor;
}

// Points from another program are a separate table, whose only stream has the file's name.
SessionCamera readCameraSource(const YamlNode& map, const std::string& camera_name,
                               const SessionFolder& folder) {
  const auto points = map.find("points");
  if (!points) return readSource<SessionCamera>(map, camera_name, folder);
  for (const char* const other : {"stream", "recording"})
    if (const auto node = map.find(other))
      throw node->error("cannot be combined with points, which name a separate file", "Keep one of the two");
  SessionCamera camera;
  camera.name = camera_name;
  camera.recording = recordingBeside(*points, folder);
  camera.stream = camera.recording.filename().string();
  readTable(map, camera);
  return camera;
}

SessionCamera readCamera(const YamlNode& map, const std::string& camera_name, const SessionFolder& folder) {
  map.allowOnly({"recording", "stream", "points", "clock_offset_s", "clock_scale", "columns", "resolution_px",
                 "shutter", "same_sensor_as", "same_sensor_check", "board", "mirrored", "rejected_windows_s",
                 "intrinsics", "intrinsics_std", "intrinsics_correlation"});
  SessionCamera camera = readCameraSource(map, camera_name, folder);
  if (const auto node = map.find("resolution_px")) camera.resolution_px = readResolution(*node);
  if (const auto node = map.find("shutter"))
    camera.shutter = static_cast<Shutter>(node->choice({"global", "rolling"}));
  if (const auto node = map.find("same_sensor_as")) camera.same_sensor_as = nameFrom(*node);
  if (const auto node = map.find("board")) camera.board = nameFrom(*node);
  if (const auto node = map.find("mirrored"))
    camera.mirrored = static_cast<Mirroring>(node->choice(kMirroringNames));
  if (const auto node = map.find("rejected_windows_s"))
    for (const YamlNode& time : node->items())
      camera.rejected_windows_s.push_back(time.real(0.0, kLargestOffset_s, "s"));
  std::ranges::sort(camera.rejected_windows_s);
  const auto intrinsics = map.find("intrinsics"), sigmas = map.find("intrinsics_std");
  if (sigmas && !intrinsics) throw sigmas->error("is given without intrinsics", "Give intrinsics, too");
  if (!intrinsics) return camera;
  KnownIntrinsics known = intrinsics->isMap() ? KnownIntrinsics{readIntrinsics(*intrinsics), {}}
                                              : readKnownIntrinsics(besideSession(*intrinsics, folder.path),
                                                                    camera.name, camera.stream);
  if (sigmas)
    known.uncertainty = readLensUncertainty(*sigmas, map.find("intrinsics_correlation"), known.camera);
  camera.intrinsics = known.camera;
  camera.intrinsics_uncertainty = known.uncertainty;
  Resolution& own = camera.intrinsics->resolution_px;
  if (!own.known() && camera.resolution_px.known()) {
    own = camera.resolution_px;
    validate(*camera.intrinsics, intrinsics->place());
  }
  if (!camera.resolution_px.known()) camera.resolution_px = own;
  if (own != camera.resolution_px)
    throw intrinsics->error(
        fmt::format("is for {} x {} px, but resolution_px is {} x {}", own.width_px, own.height_px,
                    camera.resolution_px.width_px, camera.resolution_px.height_px),
        "Use intrinsics of this camera at this resolution");
  return camera;
}

void setFromNode(const YamlNode& node, const std::string& key, SessionImu& imu) {
  try {
    setInImu(imu, key, node.text());
  } catch (const CalibrationError& problem) {
    throw node.error(problem.problem(), problem.advice());
  }
}

SessionImu readImu(const YamlNode& map, const std::string& imu_name, const SessionFolder& folder) {
  map.allowOnly({"recording", "stream", "gyroscope", "accelerometer", "clock_offset_s", "clock_scale",
                 "columns", "accelerometer_noise_density", "gyroscope_noise_density",
                 "accelerometer_random_walk", "gyroscope_random_walk", "acceleration_unit",
                 "angular_rate_unit", "gyroscope_axes", "accelerometer_axes"});
  SessionImu imu = readSource<SessionImu>(map, imu_name, folder);
  const auto density = [&](const char* key, double least, const char* unit, double typical) {
    if (const auto node = map.find(key)) return node->real(least, 10.0, unit);
    throw map.error(
        fmt::format("{} is missing", key),
        fmt::format("Give the white noise of the data sheet in {}; typical: {:g}", unit, typical));
  };
  const ImuNoise typical;
  imu.noise.accelerometer_density =
      density("accelerometer_noise_density", 1e-7, "m/s^2/sqrt(Hz)", typical.accelerometer_density);
  imu.noise.gyroscope_density =
      density("gyroscope_noise_density", 1e-8, "rad/s/sqrt(Hz)", typical.gyroscope_density);
  if (const auto node = map.find("accelerometer_random_walk"))
    imu.noise.accelerometer_random_walk = node->real(0.0, 10.0, "m/s^3/sqrt(Hz)");
  if (const auto node = map.find("gyroscope_random_walk"))
    imu.noise.gyroscope_random_walk = node->real(0.0, 10.0, "rad/s^2/sqrt(Hz)");
  for (const char* const key :
       {"acceleration_unit", "angular_rate_unit", "gyroscope_axes", "accelerometer_axes"})
    if (const auto node = map.find(key)) setFromNode(*node, key, imu);
  return imu;
}

// Names of groups and of their parents: "optimisation" of "optimisation.solver".
std::vector<std::string> groupNames() {
  std::vector<std::string> names;
  for (const OptionSection& section : optionSections()) {
    for (std::size_t end = section.name.find('.'); end != std::string::npos;
         end = section.name.find('.', end + 1))
      if (std::string whole = section.name.substr(0, end);
          std::find(names.begin(), names.end(), whole) == names.end())
        names.push_back(std::move(whole));
    names.push_back(section.name);
  }
  return names;
}

// Accepts `grid: {min_circles: 7}` and `grid.min_circles: 7`, also below `tuning`.
void setOptions(const YamlNode& map, const std::string& group, CalibrationOptions& options) {
  for (const std::string& key : map.keys()) {
    const YamlNode value = map[key];
    const std::string name = group.empty() ? key : group + "." + key;
    if (!value.isMap()) {
      setFromSession(value, options, name);
      continue;
    }
    const std::vector<std::string> groups = groupNames();
    if (name + "." != kTuning && std::find(groups.begin(), groups.end(), nameInTables(name)) == groups.end())
      throw value.error("is not a group of options", nameAdvice(name, groups));
    setOptions(value, name, options);
  }
}

void readOptions(const YamlNode& map, CalibrationOptions& options) {
  if (map.isNull()) return;
  setOptions(map, "", options);
  try {
    validate(options);
  } catch (const OptionConflict& conflict) {
    throw map.error(conflict.problem(), conflict.advice());
  }
}

void readSensors(const YamlNode& root, const SessionFolder& folder, Session& session) {
  const YamlNode cameras = root["cameras"];
  for (const std::string& key : cameras.keys())
    session.cameras.push_back(readCamera(cameras[key], key, folder));
  if (session.cameras.empty()) throw cameras.error("is empty", "Describe at least one camera");
  if (const auto imus = root.find("imus"); imus && !imus->isNull())
    for (const std::string& key : imus->keys()) session.imus.push_back(readImu((*imus)[key], key, folder));
  if (const auto node = root.find("reference"))
    session.reference = node->text();
  else
    session.reference = session.imus.empty() ? session.cameras[0].name : session.imus[0].name;
}

// Cameras of one sensor share lens and pose; for all of them this can be checked instead.
void readSharing(const YamlNode& cameras, Session& session) {
  std::optional<bool> checked;
  for (const SessionCamera& camera : session.cameras) {
    const YamlNode map = cameras[camera.name];
    const auto node = map.find("same_sensor_check");
    if (node && camera.same_sensor_as.empty())
      throw node->error("has no effect without same_sensor_as",
                        "Add same_sensor_as with the other camera, or remove this");
    if (camera.same_sensor_as.empty()) continue;
    const bool check = node && node->choice({"false", "true"}) == 1;
    if (checked && *checked != check)
      throw node.value_or(map).error("differs between cameras that share a sensor",
                                     "Check all of them, or none");
    checked = check;
  }
  if (checked && *checked) session.options.optimisation.edit().share_sensors = false;
}

// Gravity from the place of the recording.
void readGravity(const YamlNode& map, CalibrationOptions& options) {
  map.allowOnly({"latitude_deg", "height_m"});
  const double latitude_deg = map["latitude_deg"].real(-90.0, 90.0, "deg");
  const auto height = map.find("height_m");
  const double height_m = height ? height->real(-1000.0, 10000.0, "m") : 0.0;
  options.initialisation.edit().gravity_m_s2 = normalGravity_m_s2(latitude_deg, height_m);
  options.optimisation.edit().gravity_norm_sigma_m_s2 = kGravityAnomaly_m_s2;
}

void readPriors(const YamlNode& map, Session& session) {
  map.allowOnly({"time_offset_search_s", "gravity_norm_m_s2", "gravity_norm_std_m_s2", "cameras", "imus"});
  if (const auto node = map.find("time_offset_search_s"))
    setFromSession(*node, session.options, "initialisation.time_offset_search_s");
  const auto gravity_std = map.find("gravity_norm_std_m_s2");
  if (const auto node = map.find("gravity_norm_m_s2")) {
    setFromSession(*node, session.options, "initialisation.gravity_m_s2");
    session.options.optimisation.edit().free_gravity_norm = gravity_std.has_value();  // otherwise fixed
  }
  if (gravity_std) setFromSession(*gravity_std, session.options, "optimisation.gravity_norm_sigma_m_s2");
  readSensorPriors(map, session);
}

// One recording, or several of a blinking board.
void readRecordings(const YamlNode& node, const SessionFolder& folder, Session& session) {
  if (!node.isSequence()) {
    session.recording = recordingBeside(node, folder);
    return;
  }
  const std::vector<YamlNode> items = node.items();
  if (items.empty()) throw node.error("is empty", "Name a recording");
  session.recording = recordingBeside(items.front(), folder);
  for (std::size_t k = 1; k < items.size(); ++k)
    session.more_recordings.push_back(recordingBeside(items[k], folder));
}

void checkSessionRoot(const YamlNode& root) {
  if (!root.isMap() || !root.has("evical_session"))
    throw root.error("is not a session file: the key evical_session is missing", howTo(HowTo::MakeSession));
  root.allowOnly({"evical_session", "recording", "recordings", "time_range_s", "board", "boards", "gravity",
                  "cameras", "imus", "reference", "prior", "options", "export"});
  root["evical_session"].integer(1, 1);
}

// Reads a session; `read_recording` sets its recording.
template <class ReadRecording>
Session sessionFrom(const YamlNode& root, const SessionFolder& folder, const std::filesystem::path& file,
                    const ReadRecording& read_recording) {
  Session session;
  session.source = file;
  read_recording(session);
  if (const auto node = root.find("time_range_s")) session.time_range_s = timeRangeFrom(*node);
  if (const auto node = root.find("gravity"); node && !node->isNull()) readGravity(*node, session.options);
  readSensors(root, folder, session);
  readBoards(root, folder.path, session);
  if (const auto node = root.find("prior"); node && !node->isNull()) readPriors(*node, session);
  if (const auto node = root.find("options")) readOptions(*node, session.options);
  readSharing(root["cameras"], session);
  if (const auto node = root.find("export"); node && !node->isNull())
    for (const YamlNode& item : node->items())
      session.exports.emplace_back(exportTarget(item.text(), item.place()).name);
  validate(session, file.string());
  return session;
}

Session oneSessionFrom(const YamlNode& root, const SessionFolder& folder, const std::filesystem::path& file) {
  checkSessionRoot(root);
  if (const auto several = root.find("recordings"))
    throw several->error("lists recordings to be calibrated one by one",
                         "Give it " + howTo(HowTo::CalibrateEach) + ", or name one as recording");
  return sessionFrom(root, folder, file,
                     [&](Session& session) { readRecordings(root["recording"], folder, session); });
}

// Folder to which paths in the session are relative. If the session is opened through a link, this is the
// link's folder if the recording is there, otherwise that of the file itself.
std::filesystem::path folderOfSession(const std::filesystem::path& file, const YamlNode& root) {
  std::error_code error;
  if (!std::filesystem::is_symlink(file, error) || !root.isMap()) return file.parent_path();
  auto node = root.find("recording");
  if (!node) node = root.find("recordings");
  if (node && node->isSequence() && !node->items().empty()) node = node->items().front();
  if (!node || !node->isScalar() || pathExists(file.parent_path() / node->anyText()))
    return file.parent_path();
  const std::filesystem::path own = std::filesystem::canonical(file, error);
  return error ? file.parent_path() : own.parent_path();
}

}  // namespace

Session readSession(const std::filesystem::path& file) {
  const YamlNode root = YamlNode::load(file);
  return oneSessionFrom(root, {folderOfSession(file, root)}, file);
}

std::vector<Session> readRepeatedSessions(const std::filesystem::path& file) {
  const YamlNode root = YamlNode::load(file);
  checkSessionRoot(root);
  const auto several = root.find("recordings");
  if (!several) return {readSession(file)};
  if (root.has("recording"))
    throw several->error("is given in addition to recording", "Keep one of the two: recordings lists all");
  const SessionFolder folder{folderOfSession(file, root)};
  std::vector<Session> sessions;
  for (const YamlNode& item : several->items())
    sessions.push_back(sessionFrom(
        root, folder, file, [&](Session& session) { session.recording = recordingBeside(item, folder); }));
  if (sessions.empty()) throw several->error("is empty", "Name at least two recordings");
  for (const Session& session : sessions) {
    const auto hasOwn = [](const auto& sensor) { return !sensor.recording.empty(); };
    if (std::any_of(session.cameras.begin(), session.cameras.end(), hasOwn) ||
        std::any_of(session.imus.begin(), session.imus.end(), hasOwn))
      throw several->error(
          "lists recordings, but a sensor has a separate recording",
          "Write a session for each recording, and give all of them " + howTo(HowTo::CalibrateEach));
    for (const SessionCamera& camera : session.cameras)
      if (!camera.rejected_windows_s.empty())
        throw several->error(
            fmt::format("lists recordings, but cameras.{}.rejected_windows_s is of one", camera.name),
            "Remove rejected_windows_s");
  }
  return sessions;
}

Session readSessionOfRun(const std::filesystem::path& file) {
  const YamlNode root = YamlNode::load(file);
  return oneSessionFrom(root, {folderOfSession(file, root), true}, file);
}

Session parseSession(const std::string& yaml, const std::filesystem::path& folder) {
  return oneSessionFrom(YamlNode::parse(yaml, "session"), {folder, true}, {});
}

// Validates the members by the same rules as a file: the session is written and read again.
void validateMembers(const Session& session) {
  const std::string place = session.source.empty() ? "session" : session.source.string();
  static_cast<void>(oneSessionFrom(YamlNode::parse(sessionYaml(session, "."), place), {".", true}, place));
}

}  // namespace evical
