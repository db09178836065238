#include "core/pipeline/session.h"

#include "core/base/atomic_file.h"
#include "core/base/nearest_name.h"
#include "core/data/intrinsics_yaml.h"
#include "core/pipeline/session_priors.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <set>
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

void checkDifferent(const Session& session, const std::string& place) {
  std::set<std::string> names;
  std::set<std::pair<std::filesystem::path, std::string>> streams;
  const auto check = [&](const std::string& kind, const auto& sensor) {
    const std::string key = fmt::format("{}: {}.{}", place, kind, sensor.name);
    if (!names.insert(sensor.name).second)
      throw badInput(key, "this name is taken", "Give every sensor its own name");
    const auto recording =
        std::filesystem::weakly_canonical(sensor.recording.empty() ? session.recording : sensor.recording);
    if (!streams.insert({recording, sensor.stream}).second)
      throw badInput(key + ".stream", fmt::format("'{}' is already another sensor's stream", sensor.stream),
                     "Give every sensor its own stream");
  };
  for (const SessionCamera& camera : session.cameras) check("cameras", camera);
  for (const SessionImu& imu : session.imus) check("imus", imu);
}

// Its pose, its lens and its clock are that other camera's.
void checkSharedSensor(const Session& session, const SessionCamera& camera, const std::string& place) {
  const std::string key = fmt::format("{}: cameras.{}.same_sensor_as", place, camera.name);
  std::vector<std::string> others;
  for (const SessionCamera& other : session.cameras)
    if (other.name != camera.name && other.same_sensor_as.empty()) others.push_back(other.name);
  if (std::find(others.begin(), others.end(), camera.same_sensor_as) == others.end())
    throw badInput(
        key, fmt::format("'{}' is no other camera with a sensor of its own", camera.same_sensor_as),
        others.empty() ? "Remove it: there is no such camera" : nameAdvice(camera.same_sensor_as, others));
  const std::string whose =
      fmt::format("'{}' has that already: it is the same sensor", camera.same_sensor_as);
  if (camera.intrinsics)
    throw badInput(fmt::format("{}: cameras.{}.intrinsics", place, camera.name), whose,
                   fmt::format("Give intrinsics of '{}' only", camera.same_sensor_as));
  const SensorPrior& prior = camera.prior;
  if (prior.rotation || prior.translation || prior.time_offset_drift)
    throw badInput(fmt::format("{}: prior.cameras.{}", place, camera.name), whose,
                   fmt::format("Give what is known of '{}' only; a time offset each has of its own",
                               camera.same_sensor_as));
  if (session.imus.empty() && session.reference == camera.name)
    throw badInput(place + ": reference",
                   fmt::format("'{}' has its pose from '{}'", camera.name, camera.same_sensor_as),
                   fmt::format("Make '{}' the reference", camera.same_sensor_as));
}

bool hasNamedBoards(const Session& session) {
  return !session.further_boards.empty() || session.board_name != Session().board_name;
}

bool isSensor(const Session& session, const std::string& name) {
  const auto named = [&](const auto& sensor) { return sensor.name == name; };
  return std::any_of(session.cameras.begin(), session.cameras.end(), named) ||
         std::any_of(session.imus.begin(), session.imus.end(), named);
}

// Of several, each camera sees one, each is seen, and the first is the world.
void checkBoards(const Session& session, const std::string& place) {
  std::vector<std::string> names = {session.board_name};
  for (const FurtherBoard& further : session.further_boards) names.push_back(further.name);
  std::vector<bool> seen(names.size());
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    const std::string& name = session.cameras[k].board;
    const std::string key = fmt::format("{}: cameras.{}.board", place, session.cameras[k].name);
    if (name.empty() && names.size() > 1)
      throw badInput(key, "is missing: there are several boards", "Say which one this camera sees");
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end())
      throw badInput(key, fmt::format("there is no board '{}'", name), nameAdvice(name, names));
    seen[session.boardIndexOf(k)] = true;
  }
  // Both are the beginnings of quantities' names.
  for (const std::string& name : hasNamedBoards(session) ? names : std::vector<std::string>())
    if (isSensor(session, name))
      throw badInput(fmt::format("{}: boards.{}", place, name), "is also a sensor's name",
                     "Call one of them otherwise");
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!seen[i])
      throw badInput(fmt::format("{}: boards.{}", place, names[i]), "no camera sees it",
                     "Remove it, or say so at the camera that does: board: " + names[i]);
  if (session.boardIndexOf(session.worldCamera()) != 0)
    throw badInput(place + ": boards",
                   fmt::format("the first one's frame is the world, so '{}' must see it",
                               session.cameras[session.worldCamera()].name),
                   "Put the board first that it sees");
  if (names.size() > 1 && session.board_blinks)
    throw badInput(place + ": boards", "a board that blinks stands alone",
                   "Calibrate each camera's intrinsics with a session of its own");
}

void checkBoard(const Session& session, const Board& board, const std::string& key) {
  if (session.imus.empty() || session.board_blinks || !board.hasHalfTurnAmbiguity()) return;
  const BoardType type = board.type;
  throw badInput(
      key + (type == BoardType::SymmetricCircles ? ".type" : ".rows"),
      fmt::format(
          "{} looks the same when turned by 180 degrees, so the camera's pose would jump and no IMU can "
          "be calibrated with it",
          type == BoardType::SymmetricCircles ? "a symmetric board"
          : type == BoardType::Checkerboard
              ? "a checkerboard whose rows and columns of inner corners are both even or both odd"
              : "an asymmetric board with an even number of rows"),
      type == BoardType::Checkerboard
          ? "Use one with an even and an odd number, or leave out the IMUs to calibrate intrinsics"
          : "Use an asymmetric board with an odd number of rows, or leave out the IMUs to calibrate "
            "intrinsics");
}

void checkRecordings(const Session& session, const std::string& place) {
  if (session.more_recordings.empty()) return;
  if (!session.board_blinks)
    throw badInput(place + ": recording", "is a list, which only a board that blinks can have",
                   "Name one recording, or say blinking: true in the board if it does");
  if (session.time_range_s)
    throw badInput(place + ": time_range_s", "says not which of several recordings it is of",
                   "Remove it, or name one recording");
  for (const SessionCamera& camera : session.cameras)
    if (!camera.recording.empty())
      throw badInput(fmt::format("{}: cameras.{}.recording", place, camera.name),
                     "is another recording beside a list of them", "Remove it, or name one recording");
}

// The rest is checked where it is read; but the reference may change later.
void checkPriors(const Session& session, const std::string& place) {
  const auto check = [&](const char* kind, const std::string& name, const SensorPrior& prior) {
    if (name != session.reference || (!prior.rotation && !prior.translation && !prior.time_offset)) return;
    throw badInput(fmt::format("{}: prior.{}.{}", place, kind, name),
                   "gives a transform or time offset of the reference itself",
                   "Remove it, or take another reference: they are relative to it");
  };
  for (const SessionImu& imu : session.imus) check("imus", imu.name, imu.prior);
  if (!session.imus.empty()) return;
  for (const SessionCamera& camera : session.cameras) check("cameras", camera.name, camera.prior);
}

// Whether it still tells what it once did: either may have been changed since.
bool tellsSpacing(const std::optional<MeasuredLength>& measured, const Board& board) {
  return measured && measured->spacing_m() == board.spacing_m;
}
bool tellsSigma(const std::optional<MeasuredLength>& measured, const OptimisationOptions& options) {
  if (!measured) return false;
  return measured->std_m > 0.0
             ? options.board_spacing_sigma == measured->relativeStd() && options.free_board_size
             : !options.free_board_size;
}

void forgetSigma(OptimisationOptions& options) {
  const OptimisationOptions defaults;
  options.board_spacing_sigma = defaults.board_spacing_sigma;
  options.free_board_size = defaults.free_board_size;
}

// The keys of one, on lines of their own.
std::vector<std::string> boardLines(const Board& board, const std::optional<MeasuredLength>& measured) {
  std::vector<std::string> lines = {fmt::format("type: {}", boardTypeName(board.type)),
                                    fmt::format("rows: {}", board.rows), fmt::format("cols: {}", board.cols),
                                    tellsSpacing(measured, board)
                                        ? fmt::format("measured: {{spacings: {}, length_m: {}, std_m: {}}}",
                                                      measured->spacings, measured->length_m, measured->std_m)
                                        : fmt::format("spacing_m: {}", board.spacing_m)};
  if (board.hasCircles()) {
    lines.push_back(fmt::format("radius_m: {}", board.radius_m));
    lines.push_back(fmt::format("circles: {}", board.circles == CircleShade::Dark ? "dark" : "bright"));
  }
  if (board.tag_size_m > 0.0) lines.push_back(fmt::format("tag_size_m: {}", board.tag_size_m));
  return lines;
}

std::string indented(const std::vector<std::string>& lines, std::size_t indent) {
  std::string text;
  for (const std::string& line : lines) text += std::string(indent, ' ') + line + "\n";
  return text;
}

std::string boardYaml(const Session& session) {
  std::vector<std::string> first = boardLines(session.board, session.measured);
  if (session.board_blinks) first.emplace_back("blinking: true");
  if (!hasNamedBoards(session)) return "board:\n" + indented(first, 2);
  std::string text = fmt::format("boards:\n  {}:\n", yamlText(session.board_name)) + indented(first, 4);
  for (const FurtherBoard& further : session.further_boards) {
    std::vector<std::string> lines = boardLines(further.board, {});
    if (further.spacing_std) lines.push_back(fmt::format("spacing_std: {}", *further.spacing_std));
    text += fmt::format("  {}:\n", yamlText(further.name)) + indented(lines, 4);
  }
  return text;
}

// What the board's measure says of it is no option in a file.
CalibrationOptions writtenOptions(const Session& session) {
  CalibrationOptions options = session.options;
  if (tellsSpacing(session.measured, session.board) && tellsSigma(session.measured, options.optimisation))
    forgetSigma(options.optimisation);
  return options;
}

std::string recordingText(const std::filesystem::path& file, const std::filesystem::path& folder) {
  const auto recording = std::filesystem::weakly_canonical(file);
  const auto relative = recording.lexically_relative(std::filesystem::weakly_canonical(folder));
  return relative.empty() || *relative.begin() == ".." ? recording.string() : relative.string();
}

std::string recordingsText(const Session& session, const std::filesystem::path& folder) {
  if (session.more_recordings.empty()) return yamlText(recordingText(session.recording, folder));
  std::string text = "[" + yamlText(recordingText(session.recording, folder));
  for (const std::filesystem::path& file : session.more_recordings)
    text += ", " + yamlText(recordingText(file, folder));
  return text + "]";
}

// Which stream of which file, in which clock.
template <class Sensor>
std::string sourceYaml(const Sensor& sensor, const std::filesystem::path& folder) {
  std::string text = fmt::format("  {}:\n", yamlText(sensor.name));
  if (!sensor.recording.empty())
    text += fmt::format("    recording: {}\n", yamlText(recordingText(sensor.recording, folder)));
  text += fmt::format("    stream: {}\n", yamlText(sensor.stream));
  if (sensor.clock_offset_s != 0.0) text += fmt::format("    clock_offset_s: {}\n", sensor.clock_offset_s);
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
  if (imu.acceleration_unit) {
    text += fmt::format("    acceleration_unit: {}\n",
                        kAccelerationUnits.at(static_cast<std::size_t>(*imu.acceleration_unit)));
  }
  if (imu.angular_rate_unit) {
    text += fmt::format("    angular_rate_unit: {}\n",
                        kAngularRateUnits.at(static_cast<std::size_t>(*imu.angular_rate_unit)));
  }
  const auto addAxes = [&](const char* key, const AxesReading& axes) {
    if (axes != kAxesAsTheyAre) text += fmt::format("    {}: {}\n", key, axesText(axes));
  };
  addAxes("gyroscope_axes", imu.gyroscope_axes);
  addAxes("accelerometer_axes", imu.accelerometer_axes);
  return text;
}

std::string commented(const std::string& lines) {
  std::string text;
  for (std::size_t begin = 0; begin < lines.size();) {
    const std::size_t end = lines.find('\n', begin);
    text += "# " + lines.substr(begin, end - begin) + "\n";
    begin = end == std::string::npos ? lines.size() : end + 1;
  }
  return text;
}

std::string remarksYaml(const SessionRemarks& remarks, const std::string& sensor) {
  std::string text;
  const auto found = remarks.sensors.find(sensor);
  if (found == remarks.sensors.end()) return text;
  for (const std::string& remark : found->second) text += fmt::format("    # {}\n", remark);
  return text;
}

}  // namespace

void setMeasuredLength(const std::optional<MeasuredLength>& measured, Session& session) {
  OptimisationOptions& options = session.options.optimisation;
  if (tellsSigma(session.measured, options)) forgetSigma(options);
  session.measured = measured;
  if (!measured) return;
  session.board.spacing_m = measured->spacing_m();
  options.free_board_size = measured->std_m > 0.0;
  if (options.free_board_size) options.board_spacing_sigma = measured->relativeStd();
}

std::vector<CameraLens> givenLenses(const Session& session) {
  std::vector<CameraLens> lenses;
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    const SessionCamera& sensor = session.sensor(k);
    lenses.push_back(givenLens(sensor.intrinsics, sensor.intrinsics_uncertainty));
  }
  return lenses;
}

std::size_t Session::sensorOf(std::size_t camera) const {
  const std::string& name = cameras[camera].same_sensor_as;
  const auto found = std::find_if(cameras.begin(), cameras.end(),
                                  [&](const SessionCamera& each) { return each.name == name; });
  return name.empty() || found == cameras.end() ? camera : static_cast<std::size_t>(found - cameras.begin());
}

std::size_t Session::boardIndexOf(std::size_t camera) const {
  const std::string& name = cameras[camera].board;
  const auto found = std::find_if(further_boards.begin(), further_boards.end(),
                                  [&](const FurtherBoard& each) { return each.name == name; });
  return found == further_boards.end() ? 0 : static_cast<std::size_t>(found - further_boards.begin()) + 1;
}

const Board& Session::boardOf(std::size_t camera) const {
  const std::size_t index = boardIndexOf(camera);
  return index == 0 ? board : further_boards[index - 1].board;
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
                   session.imus.size() > 1 ? "Describe at least one camera: IMUs alone are not calibrated"
                                           : "Describe at least one camera");
  checkDifferent(session, place);
  checkReference(session, place);
  checkBoards(session, place);
  checkBoard(session, session.board,
             place + (hasNamedBoards(session) ? ": boards." + session.board_name : ": board"));
  for (const FurtherBoard& further : session.further_boards)
    checkBoard(session, further.board, place + ": boards." + further.name);
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
  const std::string board = boardYaml(session);
  text += remarks.board.empty() ? board : commented(remarks.board) + commented(board);
  text += "cameras:\n";
  for (const SessionCamera& camera : session.cameras)
    text += cameraYaml(camera, folder) + remarksYaml(remarks, camera.name);
  if (!session.imus.empty()) text += "imus:\n";
  for (const SessionImu& imu : session.imus) text += imuYaml(imu, folder) + remarksYaml(remarks, imu.name);
  text += fmt::format("reference: {}\n", yamlText(session.reference));
  if (const std::string priors = sensorPriorsYaml(session); !priors.empty()) text += "prior:\n" + priors;
  if (!session.exports.empty()) text += fmt::format("export: [{}]\n", joined(session.exports));
  const std::vector<OptionRow> rows = differingOptions(writtenOptions(session));
  text += rows.empty() ? "options: {}\n" : "options:\n";
  for (const OptionRow& row : rows) text += fmt::format("  {}: {}\n", row.name, row.value);
  return text;
}

void writeSession(const Session& session, const std::filesystem::path& file) {
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  writeFileWhole(file, sessionYaml(session, folder));
}

}  // namespace evical
