// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/document/session_guess.h"

#include <algorithm>
#include <string>

namespace evical::ui {
namespace {

bool isTaken(const std::string& name, const Session& session) {
  const auto same = [&](const auto& sensor) { return sensor.name == name; };
  return std::any_of(session.cameras.begin(), session.cameras.end(), same) ||
         std::any_of(session.imus.begin(), session.imus.end(), same);
}

// "/davis/left/events" gives "davis_left": all parts but the last, which says the kind.
std::string nameFromStream(const std::string& stream, const std::string& kind) {
  const std::size_t end = stream.rfind('/');
  std::string name = end == std::string::npos ? "" : stream.substr(0, end);
  std::replace(name.begin(), name.end(), '/', '_');
  name.erase(0, name.find_first_not_of('_'));
  if (name.empty()) return kind;
  return kind == "imu" ? name + "_imu" : name;
}

std::string freeName(const std::string& stream, const std::string& kind, const Session& session) {
  const std::string base = nameFromStream(stream, kind);
  std::string name = base;
  for (int i = 2; isTaken(name, session); ++i) name = base + "_" + std::to_string(i);
  return name;
}

}  // namespace

SessionCamera guessedCamera(const StreamSummary& stream, const Session& session,
                            const std::filesystem::path& own_recording) {
  SessionCamera camera;
  camera.recording = own_recording;
  camera.name = freeName(stream.info.name, "camera", session);
  camera.stream = stream.info.name;
  camera.resolution_px = stream.info.resolution_px;
  return camera;
}

SessionImu guessedImu(const StreamSummary& stream, const Session& session,
                      const std::filesystem::path& own_recording) {
  SessionImu imu;
  imu.recording = own_recording;
  imu.name = freeName(stream.info.name, "imu", session);
  imu.stream = stream.info.name;
  if (stream.acceleration_unit == "g" && stream.info.acceleration_unit != AccelerationUnit::Gravity)
    imu.acceleration_unit = AccelerationUnit::Gravity;
  return imu;
}

void keepReference(Session& session) {
  const auto choose = [&](const auto& sensors) {
    const auto is_reference = [&](const auto& sensor) { return sensor.name == session.reference; };
    if (std::none_of(sensors.begin(), sensors.end(), is_reference)) session.reference = sensors.front().name;
  };
  if (!session.imus.empty())
    choose(session.imus);
  else if (!session.cameras.empty())
    choose(session.cameras);
}

Session withMissingSensors(const Session& session, const std::filesystem::path& recording,
                           const Inspection& inspection) {
  Session found = session;
  for (const StreamSummary& stream : inspection.streams) {
    if (stream.count == 0) continue;
    if (stream.info.type == StreamType::Events && session.cameras.empty())
      found.cameras.push_back(guessedCamera(stream, found, recording));
    if (stream.info.type == StreamType::Imu && session.imus.empty())
      found.imus.push_back(guessedImu(stream, found, recording));
  }
  keepReference(found);
  return found;
}

Session guessedSession(const std::filesystem::path& recording, const Inspection& inspection) {
  Session session;
  session.recording = recording;
  return withMissingSensors(session, {}, inspection);
}

}  // namespace evical::ui
