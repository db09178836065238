#include "core/pipeline/session/session_of_recording.h"

#include "core/base/error.h"

#include <algorithm>
#include <system_error>

namespace evical {

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
  session.recording = recording;
  session.time_range_s.reset();
}

}  // namespace evical
