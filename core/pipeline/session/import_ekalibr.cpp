#include "core/base/file_places.h"
#include "core/format/intrinsics_yaml.h"
#include "core/pipeline/session/import_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace evical {
namespace {

struct ImuType {
  const char* name;
  AccelerationUnit acceleration;
  AngularRateUnit rate;
};

constexpr std::array kImuTypes{
    ImuType{"SENSOR_IMU", AccelerationUnit::MetresPerSecond2, AngularRateUnit::RadiansPerSecond},
    ImuType{"SENSOR_IMU_G", AccelerationUnit::Gravity, AngularRateUnit::RadiansPerSecond},
    ImuType{"SENSOR_IMU_G_NEG", AccelerationUnit::MinusGravity, AngularRateUnit::RadiansPerSecond},
    ImuType{"SENSOR_IMU_DEG", AccelerationUnit::MetresPerSecond2, AngularRateUnit::DegreesPerSecond},
    ImuType{"SENSOR_IMU_DEG_G", AccelerationUnit::Gravity, AngularRateUnit::DegreesPerSecond},
    ImuType{"SENSOR_IMU_DEG_G_NEG", AccelerationUnit::MinusGravity, AngularRateUnit::DegreesPerSecond}};

// Path relative to the configuration; eKalibr itself uses its working directory.
std::filesystem::path besideSource(const ImportSource& source, const std::string& text) {
  return source.path.parent_path() / text;
}

void readCamera(const ImportSource& source, const YamlNode& entry, ImportedSession& imported) {
  SessionCamera camera;
  const YamlNode value = entry["value"];
  camera.stream = entry["key"].text();
  camera.name = sensorName(camera.stream, false, imported.session);
  camera.resolution_px = {value["Width"].integer(1, 30000), value["Height"].integer(1, 30000)};
  const auto intrinsics = value.find("Intrinsics");
  if (intrinsics && !intrinsics->isNull() && !intrinsics->text().empty()) {
    const std::filesystem::path file = besideSource(source, intrinsics->text());
    if (pathExists(file)) {
      camera.intrinsics = readIntrinsicsFile(file, camera.name, camera.stream);
    } else {
      imported.notes.push_back(fmt::format("{}: intrinsics file {} does not exist: they will be calibrated",
                                           camera.name, file.string()));
    }
  }
  imported.session.cameras.push_back(std::move(camera));
}

void readImu(const YamlNode& entry, ImportedSession& imported) {
  Session& session = imported.session;
  SessionImu imu;
  const YamlNode value = entry["value"];
  imu.stream = entry["key"].text();
  if (value["Type"].text() == "SBG_IMU") {
    imported.notes.push_back(
        fmt::format("{} is ignored: messages of SBG's IMUs are not supported", imu.stream));
    return;
  }
  imu.name = sensorName(imu.stream, true, session);
  imu.noise.accelerometer_density = value["AcceWhiteNoise"].real(1e-7, 10.0, "m/s^2/sqrt(Hz)");
  imu.noise.gyroscope_density = value["GyroWhiteNoise"].real(1e-8, 10.0, "rad/s/sqrt(Hz)");
  const std::size_t type = value["Type"].choice({kImuTypes[0].name, kImuTypes[1].name, kImuTypes[2].name,
                                                 kImuTypes[3].name, kImuTypes[4].name, kImuTypes[5].name});
  imu.acceleration_unit = kImuTypes[type].acceleration;
  imu.angular_rate_unit = kImuTypes[type].rate;
  session.imus.push_back(std::move(imu));
}

void readBoard(const YamlNode& prior, const ImportRequest& request, ImportedSession& imported) {
  const YamlNode pattern = prior["CirclePattern"];
  Board& board = imported.session.board;
  board.type = static_cast<BoardType>(pattern["Type"].choice({"ASYMMETRIC_GRID", "SYMMETRIC_GRID"}));
  board.rows = pattern["Rows"].integer(2, 100);
  board.cols = pattern["Cols"].integer(2, 100);
  board.spacing_m = pattern["SpacingMeters"].real(1e-4, 10.0, "m");
  board.radius_m = board.spacing_m / pattern["RadiusRate"].real(0.1, 100.0, "");
  if (!request.radius_m)
    imported.notes.push_back(fmt::format(
        "board: circles of radius {:.4g} mm, from RadiusRate; dark circles are assumed, as in eKalibr",
        1e3 * board.radius_m));
}

// Negative values mean the start or the end of the recording.
void readTimes(const YamlNode& data, Session& session) {
  const auto number = [&](const char* key) {
    const auto node = data.find(key);
    return node ? node->real() : -1.0;
  };
  const double begin_s = std::max(0.0, number("BeginTime")), duration_s = number("Duration");
  constexpr double kToTheEnd_s = 1e6;
  if (duration_s > 0.0 || begin_s > 0.0)
    session.time_range_s = {begin_s, begin_s + (duration_s > 0.0 ? duration_s : kToTheEnd_s)};
}

void readPriors(const YamlNode& prior, ImportedSession& imported) {
  CalibrationOptions& options = imported.session.options;
  if (const auto padding = prior.find("TimeOffsetPadding"))
    setOption(options, "initialisation.time_offset_search_s", padding->text());
  if (const auto gravity = prior.find("GravityNorm"))
    setOption(options, "initialisation.gravity_m_s2", gravity->text());
  const auto spatial = prior.find("SpatTempPrioriPath");
  if (spatial && !spatial->isNull() && !spatial->text().empty())
    imported.notes.push_back(
        fmt::format("{} is ignored: give known poses and time offsets under prior", spatial->text()));
  imported.notes.emplace_back("eKalibr's front-end settings are ignored: Evical has its own");
}

}  // namespace

void importEkalibr(const ImportSource& source, const ImportRequest& request, ImportedSession& imported) {
  const YamlNode root = source.root["Configor"], data = root["DataStream"], prior = root["Prior"];
  for (const YamlNode& entry : data["EventTopics"].items()) readCamera(source, entry, imported);
  if (const auto imus = data.find("IMUTopics"); imus && !imus->isNull())
    for (const YamlNode& entry : imus->items()) readImu(entry, imported);
  if (const auto reference = data.find("RefIMUTopic"))
    for (const SessionImu& imu : imported.session.imus)
      if (imu.stream == reference->text()) imported.session.reference = imu.name;
  readBoard(prior, request, imported);
  readTimes(data, imported.session);
  readPriors(prior, imported);
  if (const auto bag = data.find("BagPath"); bag && !bag->isNull() && !bag->text().empty())
    imported.session.recording = besideSource(source, bag->text());
}

}  // namespace evical
