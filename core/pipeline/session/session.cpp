#include "core/pipeline/session/session.h"

#include "core/base/atomic_file.h"
#include "core/base/how_to.h"
#include "core/base/nearest_name.h"
#include "core/base/plain_text.h"
#include "core/format/intrinsics_yaml.h"
#include "core/pipeline/session/session_boards.h"
#include "core/pipeline/session/session_priors.h"
#include "core/recording/separate_imu.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>

namespace evical {
namespace {

void checkReference(const Session& session, const std::string& place) {
  std::vector<std::string> names;
  for (const SessionImu& imu : session.imus) names.push_back(imu.name);
  if (names.empty())
    for (const SessionCamera& camera : session.cameras) names.push_back(camera.name);
  if (std::find(names.begin(), names.end(), session.reference) != names.end()) return;
  throw badInput(place + ": reference",
                 fmt::format("'{}' is not {}", session.reference,
                             session.imus.empty() ? "one of the cameras" : "one of the IMUs"),
                 nameAdvice(session.reference, names));
}

std::string separateAccelerometer(const SessionCamera&) {
  return {};
}
std::string separateAccelerometer(const SessionImu& imu) {
  return imu.accelerometer_stream;
}

std::filesystem::path accelerometerRecording(const SessionCamera&) {
  return {};
}
std::filesystem::path accelerometerRecording(const SessionImu& imu) {
  return imu.accelerometer_recording;
}
std::string accelerometerColumns(const SessionCamera&) {
  return {};
}
std::string accelerometerColumns(const SessionImu& imu) {
  return imu.accelerometer_columns;
}

void checkDifferent(const Session& session, const std::string& place) {
  std::set<std::string> names;
  std::set<std::tuple<std::filesystem::path, std::string, std::string>> streams;
  const auto check = [&](const std::string& kind, const auto& sensor) {
    const std::string key = fmt::format("{}: {}.{}", place, kind, sensor.name);
    requirePlain(sensor.name, key, "the name");
    requirePlain(sensor.stream, key + ".stream", "the name");
    requirePlain(separateAccelerometer(sensor), key + ".accelerometer", "the name");
    if (!names.insert(sensor.name).second)
      throw badInput(key, "this name is already used", "Give every sensor a different name");
    const std::filesystem::path& gyroscope = sensor.recording.empty() ? session.recording : sensor.recording;
    const auto take = [&](const char* what, const std::string& stream,
                          const std::filesystem::path& recording) {
      // A table may have columns of several sensors.
      if (!streams.insert({std::filesystem::weakly_canonical(recording), stream, sensor.columns}).second)
        throw badInput(key + what, fmt::format("'{}' is already another sensor's stream", stream),
                       "Give every sensor a different stream");
    };
    const std::string accelerometer = separateAccelerometer(sensor);
    const std::filesystem::path own = accelerometerRecording(sensor);
    take(accelerometer.empty() ? ".stream" : ".gyroscope", sensor.stream, gyroscope);
    if (!accelerometer.empty() && (accelerometer != sensor.stream || !own.empty()))
      take(".accelerometer", accelerometer, own.empty() ? gyroscope : own);
  };
  for (const SessionCamera& camera : session.cameras) check("cameras", camera);
  for (const SessionImu& imu : session.imus) check("imus", imu);
}

// Checks that a camera with same_sensor_as has no separate pose, lens or clock.
void checkSharedSensor(const Session& session, const SessionCamera& camera, const std::string& place) {
  const std::string key = fmt::format("{}: cameras.{}.same_sensor_as", place, camera.name);
  std::vector<std::string> others;
  for (const SessionCamera& other : session.cameras)
    if (other.name != camera.name && other.same_sensor_as.empty()) others.push_back(other.name);
  if (std::find(others.begin(), others.end(), camera.same_sensor_as) == others.end())
    throw badInput(
        key, fmt::format("'{}' is not another camera with its own sensor", camera.same_sensor_as),
        others.empty() ? "Remove it: there is no such camera" : nameAdvice(camera.same_sensor_as, others));
  const std::string whose =
      fmt::format("'{}' already gives it: both cameras share one sensor", camera.same_sensor_as);
  if (camera.intrinsics)
    throw badInput(fmt::format("{}: cameras.{}.intrinsics", place, camera.name), whose,
                   fmt::format("Give intrinsics only for '{}'", camera.same_sensor_as));
  const SensorPrior& prior = camera.prior;
  if (prior.rotation || prior.translation || prior.time_offset_drift)
    throw badInput(
        fmt::format("{}: prior.cameras.{}", place, camera.name), whose,
        fmt::format("Give the prior only for '{}'; only time offsets are separate", camera.same_sensor_as));
  if (session.imus.empty() && session.reference == camera.name)
    throw badInput(place + ": reference",
                   fmt::format("'{}' shares the pose of '{}' (same_sensor_as), so it cannot be the reference",
                               camera.name, camera.same_sensor_as),
                   fmt::format("Make '{}' the reference", camera.same_sensor_as));
}

void checkRecordings(const Session& session, const std::string& place) {
  if (session.more_recordings.empty()) return;
  if (!session.board_blinks)
    throw badInput(place + ": recording", "is a list, which is possible only for a blinking board",
                   "Name one recording. If the board blinks, " + howTo(HowTo::SayThatBoardFlashes));
  if (session.time_range_s)
    throw badInput(place + ": time_range_s", "is ambiguous with several recordings",
                   "Remove it, or name one recording");
  for (const SessionCamera& camera : session.cameras)
    if (!camera.recording.empty())
      throw badInput(fmt::format("{}: cameras.{}.recording", place, camera.name),
                     "names a recording in addition to the list", "Remove it, or name one recording");
}

// Priors of the reference: checked here, since the reference may change after reading.
void checkPriors(const Session& session, const std::string& place) {
  const auto check = [&](const char* kind, const std::string& name, const SensorPrior& prior) {
    if (name != session.reference || (!prior.rotation && !prior.translation && !prior.time_offset)) return;
    throw badInput(fmt::format("{}: prior.{}.{}", place, kind, name),
                   "gives a transform or time offset of the reference itself",
                   "Remove it, or choose another reference: priors are relative to it");
  };
  for (const SessionImu& imu : session.imus) check("imus", imu.name, imu.prior);
  if (!session.imus.empty()) return;
  for (const SessionCamera& camera : session.cameras) check("cameras", camera.name, camera.prior);
}

std::string recordingText(const std::filesystem::path& file, const std::filesystem::path& folder) {
  const auto within = [](const std::filesystem::path& path, const std::filesystem::path& base) {
    const std::filesystem::path relative = path.lexically_relative(base);
    return relative.empty() || *relative.begin() == ".." ? std::filesystem::path() : relative;
  };
  const auto absolute = [](const std::filesystem::path& path) {
    const std::filesystem::path whole = std::filesystem::absolute(path.empty() ? "." : path);
    return whole.filename().empty() ? whole.parent_path() : whole;  // without a slash at the end
  };
  const std::filesystem::path own = absolute(file), base = absolute(folder);
  const auto as_given = within(own.lexically_normal(), base.lexically_normal());
  const bool plain = std::find(own.begin(), own.end(), "..") == own.end() &&
                     std::find(base.begin(), base.end(), "..") == base.end();
  if (plain && !as_given.empty()) return as_given.string();
  // A link to the recording stays one: only links to folders are resolved.
  const std::filesystem::path recording =
      own.filename() == ".." || own.filename() == "."
          ? std::filesystem::weakly_canonical(own)
          : std::filesystem::weakly_canonical(own.parent_path()) / own.filename();
  const auto relative = within(recording, std::filesystem::weakly_canonical(base));
  return relative.empty() ? recording.string() : relative.string();
}

std::string recordingsText(const Session& session, const std::filesystem::path& folder) {
  if (session.more_recordings.empty()) return yamlText(recordingText(session.recording, folder));
  std::string text = "[" + yamlText(recordingText(session.recording, folder));
  for (const std::filesystem::path& file : session.more_recordings)
    text += ", " + yamlText(recordingText(file, folder));
  return text + "]";
}

// File, stream and clock of a sensor.
template <class Sensor>
std::string sourceYaml(const Sensor& sensor, const std::filesystem::path& folder) {
  std::string text = fmt::format("  {}:\n", yamlText(sensor.name));
  const std::filesystem::path second = accelerometerRecording(sensor);
  if (!second.empty())
    text += fmt::format("    recording: [{}, {}]\n", yamlText(recordingText(sensor.recording, folder)),
                        yamlText(recordingText(second, folder)));
  else if (!sensor.recording.empty())
    text += fmt::format("    recording: {}\n", yamlText(recordingText(sensor.recording, folder)));
  if (const std::string accelerometer = separateAccelerometer(sensor); accelerometer.empty())
    text += fmt::format("    stream: {}\n", yamlText(sensor.stream));
  else
    text += fmt::format("    gyroscope: {}\n    accelerometer: {}\n", yamlText(sensor.stream),
                        yamlText(accelerometer));
  if (sensor.clock_offset_s != 0.0) text += fmt::format("    clock_offset_s: {}\n", sensor.clock_offset_s);
  if (sensor.clock_scale != 1.0) text += fmt::format("    clock_scale: {}\n", sensor.clock_scale);
  if (const std::string columns = accelerometerColumns(sensor); !columns.empty())
    text += fmt::format("    columns: {{gyroscope: {}, accelerometer: {}}}\n", yamlText(sensor.columns),
                        yamlText(columns));
  else if (!sensor.columns.empty())
    text += fmt::format("    columns: {}\n", yamlText(sensor.columns));
  return text;
}

std::string cameraYaml(const SessionCamera& camera, const std::filesystem::path& folder) {
  std::string text = sourceYaml(camera, folder);
  if (camera.resolution_px.known())
    text += fmt::format("    resolution_px: [{}, {}]\n", camera.resolution_px.width_px,
                        camera.resolution_px.height_px);
  if (camera.shutter == Shutter::Rolling) text += "    shutter: rolling\n";
  if (!camera.same_sensor_as.empty())
    text += fmt::format("    same_sensor_as: {}\n", yamlText(camera.same_sensor_as));
  if (!camera.board.empty()) text += fmt::format("    board: {}\n", yamlText(camera.board));
  if (camera.mirrored)
    text += fmt::format("    mirrored: {}\n", kMirroringNames.at(static_cast<std::size_t>(*camera.mirrored)));
  if (!camera.rejected_windows_s.empty())
    text += fmt::format("    rejected_windows_s: [{}]\n", fmt::join(camera.rejected_windows_s, ", "));
  if (camera.intrinsics) text += "    intrinsics:\n" + intrinsicsYaml(*camera.intrinsics, 6);
  if (camera.intrinsics && camera.intrinsics_uncertainty)
    text += lensUncertaintyYaml(*camera.intrinsics_uncertainty, *camera.intrinsics, 4);
  return text;
}

std::string imuYaml(const SessionImu& imu, const std::filesystem::path& folder) {
  std::string text = sourceYaml(imu, folder);
  text += fmt::format("    accelerometer_noise_density: {}\n    gyroscope_noise_density: {}\n",
                      imu.noise.accelerometer_density, imu.noise.gyroscope_density);
  if (imu.noise.accelerometer_random_walk > 0.0)
    text += fmt::format("    accelerometer_random_walk: {}\n", imu.noise.accelerometer_random_walk);
  if (imu.noise.gyroscope_random_walk > 0.0)
    text += fmt::format("    gyroscope_random_walk: {}\n", imu.noise.gyroscope_random_walk);
  const auto addUnit = [&](const char* key, const char* unit, double factor) {
    text += fmt::format("    {}: {}{}\n", key, factor == 1.0 ? "" : fmt::format("{} ", factor), unit);
  };
  if (imu.acceleration_unit)
    addUnit("acceleration_unit", kAccelerationUnits.at(static_cast<std::size_t>(*imu.acceleration_unit)),
            imu.acceleration_factor);
  if (imu.angular_rate_unit)
    addUnit("angular_rate_unit", kAngularRateUnits.at(static_cast<std::size_t>(*imu.angular_rate_unit)),
            imu.angular_rate_factor);
  const auto addAxes = [&](const char* key, const AxesReading& axes) {
    if (axes != kIdentityAxes) text += fmt::format("    {}: {}\n", key, axesText(axes));
  };
  addAxes("gyroscope_axes", imu.gyroscope_axes);
  addAxes("accelerometer_axes", imu.accelerometer_axes);
  return text;
}

std::string commented(const std::string& lines) {
  std::string text;
  for (std::size_t begin = 0; begin < lines.size();) {
    const std::size_t end = lines.find('\n', begin);
    text += "# " + visible(lines.substr(begin, end - begin)) + "\n";
    begin = end == std::string::npos ? lines.size() : end + 1;
  }
  return text;
}

std::string remarksYaml(const SessionRemarks& remarks, const std::string& sensor) {
  std::string text;
  const auto found = remarks.sensors.find(sensor);
  if (found == remarks.sensors.end()) return text;
  for (const std::string& remark : found->second) text += fmt::format("    # {}\n", visible(remark));
  return text;
}

}  // namespace

std::vector<CameraLens> givenLenses(const Session& session) {
  std::vector<CameraLens> lenses;
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    const SessionCamera& sensor = session.sensor(k);
    lenses.push_back(givenLens(sensor.intrinsics, sensor.intrinsics_uncertainty));
  }
  return lenses;
}

Session withoutRejectedWindows(Session session) {
  for (SessionCamera& camera : session.cameras) camera.rejected_windows_s.clear();
  return session;
}

std::string accelerometerTable(const std::filesystem::path& gyroscope,
                               const std::filesystem::path& accelerometer) {
  const std::filesystem::path name = accelerometer.filename();
  return visible(
      (name == gyroscope.filename() ? accelerometer.parent_path().filename() / name : name).string());
}

std::string SessionImu::joinedStream() const {
  return accelerometer_stream.empty() ? stream : nameOf(SeparateImu{stream, accelerometer_stream});
}

std::size_t Session::sensorOf(std::size_t camera) const {
  const std::string& name = cameras[camera].same_sensor_as;
  const auto found = std::find_if(cameras.begin(), cameras.end(),
                                  [&](const SessionCamera& each) { return each.name == name; });
  return name.empty() || found == cameras.end() ? camera : static_cast<std::size_t>(found - cameras.begin());
}

std::size_t Session::referenceImu() const {
  const auto found =
      std::find_if(imus.begin(), imus.end(), [&](const SessionImu& i) { return i.name == reference; });
  return found == imus.end() ? 0 : static_cast<std::size_t>(found - imus.begin());
}

std::size_t Session::referenceCamera() const {
  const auto found = std::find_if(cameras.begin(), cameras.end(),
                                  [&](const SessionCamera& c) { return c.name == reference; });
  return found == cameras.end() || !imus.empty() ? 0 : static_cast<std::size_t>(found - cameras.begin());
}

void validate(const Session& session, const std::string& place) {
  if (session.cameras.empty())
    throw badInput(place + ": cameras", "is empty",
                   session.imus.size() > 1 ? "Describe at least one camera: IMUs alone cannot be calibrated"
                                           : "Describe at least one camera");
  checkDifferent(session, place);
  checkReference(session, place);
  validateBoards(session, place);
  checkRecordings(session, place);
  checkPriors(session, place);
  for (const SessionCamera& camera : session.cameras)
    if (!camera.same_sensor_as.empty()) checkSharedSensor(session, camera, place);
  validate(session.options);
}

std::string sessionYaml(const Session& session, const std::filesystem::path& folder,
                        const SessionRemarks& remarks) {
  std::string text = fmt::format("evical_session: 1\nrecording: {}\n", recordingsText(session, folder));
  if (session.time_range_s)
    text += fmt::format("time_range_s: [{}, {}]\n", (*session.time_range_s)[0], (*session.time_range_s)[1]);
  const std::string board = boardsYaml(session);
  text += remarks.board.empty() ? board : commented(remarks.board) + commented(board);
  text += "cameras:\n";
  for (const SessionCamera& camera : session.cameras)
    text += cameraYaml(camera, folder) + remarksYaml(remarks, camera.name);
  if (!session.imus.empty()) text += "imus:\n";
  for (const SessionImu& imu : session.imus) text += imuYaml(imu, folder) + remarksYaml(remarks, imu.name);
  text += fmt::format("reference: {}\n", yamlText(session.reference));
  if (const std::string priors = sensorPriorsYaml(session); !priors.empty()) text += "prior:\n" + priors;
  if (!session.exports.empty()) text += fmt::format("export: [{}]\n", joined(session.exports));
  const std::vector<OptionRow> rows = differingOptions(optionsBesideBoards(session));
  text += rows.empty() ? "options: {}\n" : "options:\n";
  for (const OptionRow& row : rows) text += fmt::format("  {}: {}\n", row.name, row.value);
  return text;
}

void writeSession(const Session& session, const std::filesystem::path& file) {
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  writeFileWhole(file, sessionYaml(session, folder));
}

bool isSensorName(const Session& session, const std::string& name) {
  const auto named = [&](const auto& sensor) { return sensor.name == name; };
  return std::any_of(session.cameras.begin(), session.cameras.end(), named) ||
         std::any_of(session.imus.begin(), session.imus.end(), named);
}

}  // namespace evical
