#include "core/pipeline/session/session_of_recording.h"

#include "core/base/error.h"

#include <algorithm>
#include <set>
#include <system_error>

namespace evical {
namespace {

std::set<std::filesystem::path> filesOf(const Session& session) {
  std::set<std::filesystem::path> files;
  const auto add = [&](const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::weakly_canonical(path, error);
    if (!path.empty()) files.insert(error ? path : whole);
  };
  add(session.recording);
  for (const SessionCamera& camera : session.cameras) add(camera.recording);
  for (const SessionImu& imu : session.imus)
    for (const std::filesystem::path& file : {imu.recording, imu.accelerometer_recording}) add(file);
  return files;
}

// Parts of one recording count as separate recordings if they do not overlap.
bool overlap(const Session& a, const Session& b) {
  if (!a.time_range_s || !b.time_range_s) return true;
  return (*a.time_range_s)[0] < (*b.time_range_s)[1] && (*b.time_range_s)[0] < (*a.time_range_s)[1];
}

}  // namespace

bool isSessionFile(const std::filesystem::path& path) {
  std::error_code ignored;
  const bool folder = std::filesystem::is_directory(path, ignored);
  return !folder && (path.extension() == ".yaml" || path.extension() == ".yml");
}

void setRecording(const std::filesystem::path& recording, Session& session) {
  const auto hasOwn = [](const auto& sensor) { return !sensor.recording.empty(); };
  if (std::any_of(session.cameras.begin(), session.cameras.end(), hasOwn) ||
      std::any_of(session.imus.begin(), session.imus.end(), hasOwn) || !session.more_recordings.empty())
    throw badInput(session.source.string(), "its sensors have separate recordings",
                   "Write a session for the new recordings, and give it instead of the recording");
  session = withoutRejectedWindows(std::move(session));
  session.recording = recording;
  session.time_range_s.reset();
}

std::optional<std::filesystem::path> sharedRecording(const Session& a, const Session& b) {
  if (!overlap(a, b)) return std::nullopt;
  const std::set<std::filesystem::path> others = filesOf(b);
  for (const std::filesystem::path& file : filesOf(a))
    if (others.contains(file)) return file;
  return std::nullopt;
}

}  // namespace evical
