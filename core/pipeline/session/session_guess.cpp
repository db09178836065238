#include "core/pipeline/session/session_guess.h"

#include "core/base/how_to.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>

namespace evical {
namespace {

// "/davis/left/events" gives "davis_left": all parts except the last, which is the type.
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
  for (int i = 2; isSensorName(session, name); ++i) name = base + "_" + std::to_string(i);
  return name;
}

bool isSensor(const StreamSummary& stream, StreamType type) {
  return stream.info.type == type && stream.count > 0;
}

// For an IMU with separate streams: the stream of the other sensor with the longest common prefix.
const StreamSummary* mostAlike(const StreamSummary& stream, const Inspection& inspection) {
  const ImuStreamKind kind = imuStreamKind(stream);
  if (kind != ImuStreamKind::Gyroscope && kind != ImuStreamKind::Accelerometer) return nullptr;
  const ImuStreamKind wanted =
      kind == ImuStreamKind::Gyroscope ? ImuStreamKind::Accelerometer : ImuStreamKind::Gyroscope;
  const StreamSummary* best = nullptr;
  std::ptrdiff_t most_alike = -1;
  for (const StreamSummary& other : inspection.streams) {
    if (!isSensor(other, StreamType::Imu) || imuStreamKind(other) != wanted) continue;
    const auto alike =
        std::ranges::mismatch(stream.info.name, other.info.name).in1 - stream.info.name.begin();
    if (alike <= most_alike) continue;
    best = &other;
    most_alike = alike;
  }
  return best;
}

// Null if there is none, or if it belongs to another stream: two gyroscopes do not share an accelerometer.
const StreamSummary* otherSensor(const StreamSummary& stream, const Inspection& inspection) {
  const StreamSummary* const other = mostAlike(stream, inspection);
  const StreamSummary* const back = other != nullptr ? mostAlike(*other, inspection) : nullptr;
  return back != nullptr && back->info.name == stream.info.name ? other : nullptr;
}

// "/camera/imu" of "/camera/gyro/sample" and "/camera/accel/sample".
std::string commonPart(const std::string& a, const std::string& b) {
  const std::string alike(a.begin(), std::ranges::mismatch(a, b).in1);
  return alike.substr(0, alike.rfind('/') + 1) + "imu";
}

void addSensors(const std::filesystem::path& own_recording, const Inspection& inspection, StreamType type,
                Session& session) {
  for (const StreamSummary& stream : inspection.streams) {
    if (!isSensor(stream, type)) continue;
    if (type == StreamType::Events) session.cameras.push_back(guessedCamera(stream, session, own_recording));
    const bool frames = type == StreamType::Frames && stream.info.readable && stream.info.timed;
    if (frames || type == StreamType::Points)
      session.cameras.push_back(guessedCamera(stream, session, own_recording));
    const bool is_with_gyroscope =
        imuStreamKind(stream) == ImuStreamKind::Accelerometer && otherSensor(stream, inspection) != nullptr;
    if (type == StreamType::Imu && !is_with_gyroscope)
      session.imus.push_back(guessedImu(stream, inspection, session, own_recording));
  }
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

SessionImu guessedImu(const StreamSummary& given, const Inspection& inspection, const Session& session,
                      const std::filesystem::path& own_recording) {
  const ImuStreamKind kind = imuStreamKind(given);
  const StreamSummary* const other = otherSensor(given, inspection);
  const bool other_is_gyroscope = other != nullptr && kind == ImuStreamKind::Accelerometer;
  const StreamSummary& gyroscope = other_is_gyroscope ? *other : given;
  const StreamSummary& stream = other != nullptr && !other_is_gyroscope ? *other : given;
  SessionImu imu;
  imu.recording = own_recording;
  imu.name = freeName(other != nullptr ? commonPart(given.info.name, other->info.name) : given.info.name,
                      "imu", session);
  imu.stream = gyroscope.info.name;
  if (other != nullptr || kind == ImuStreamKind::Alternating) imu.accelerometer_stream = stream.info.name;
  if (stream.acceleration_unit == "g" && stream.info.acceleration_unit != AccelerationUnit::Gravity)
    imu.acceleration_unit = AccelerationUnit::Gravity;
  return imu;
}

SessionCamera withSeenResolution(SessionCamera camera, const StreamSummary& stream) {
  const bool known = camera.resolution_px.known() || stream.info.resolution_px.known() ||
                     (camera.intrinsics && camera.intrinsics->resolution_px.known());
  if (known || stream.info.type != StreamType::Events) return camera;
  static constexpr std::array<Resolution, 8> kUsual = {
      {{128, 128}, {240, 180}, {304, 240}, {320, 240}, {346, 260}, {640, 480}, {1280, 720}, {320, 320}}};
  constexpr int kUnlit_px = 3;  // margin at the border without events
  camera.resolution_px = stream.seen_px;
  for (const Resolution& usual : kUsual) {
    const int right_px = usual.width_px - stream.seen_px.width_px,
              below_px = usual.height_px - stream.seen_px.height_px;
    if (right_px >= 0 && right_px <= kUnlit_px && below_px >= 0 && below_px <= kUnlit_px)
      camera.resolution_px = usual;
  }
  return camera;
}

Session withSeenResolutions(Session session, const std::filesystem::path& recording,
                            const Inspection& inspection) {
  for (SessionCamera& camera : session.cameras) {
    if ((camera.recording.empty() ? session.recording : camera.recording) != recording) continue;
    for (const StreamSummary& stream : inspection.streams)
      if (stream.info.name == camera.stream) camera = withSeenResolution(std::move(camera), stream);
  }
  return session;
}

void keepReference(Session& session) {
  const auto choose = [&](const auto& sensors) {
    const auto is_reference = [&](const auto& sensor) { return sensor.name == session.reference; };
    if (std::none_of(sensors.begin(), sensors.end(), is_reference)) session.reference = sensors.front().name;
  };
  const auto isSensorOf = [&](const SessionCamera& camera) {
    return [&camera](const SessionCamera& other) { return other.name == camera.same_sensor_as; };
  };
  for (SessionCamera& camera : session.cameras)
    if (std::none_of(session.cameras.begin(), session.cameras.end(), isSensorOf(camera)))
      camera.same_sensor_as.clear();
  if (!session.imus.empty())
    choose(session.imus);
  else if (!session.cameras.empty())
    choose(session.cameras);
}

Session withMissingSensors(const Session& session, const std::filesystem::path& recording,
                           const Inspection& inspection) {
  Session found = session;
  // If there are events, frames are not added automatically.
  for (const StreamType type : {StreamType::Events, StreamType::Frames, StreamType::Points})
    if (found.cameras.empty()) addSensors(recording, inspection, type, found);
  if (session.imus.empty()) addSensors(recording, inspection, StreamType::Imu, found);
  keepReference(found);
  return found;
}

Session guessedSession(const std::filesystem::path& recording, const Inspection& inspection) {
  Session session;
  session.recording = recording;
  return withMissingSensors(session, {}, inspection);
}

std::optional<CalibrationError> whyUseless(const std::filesystem::path& recording,
                                           const Inspection& inspection) {
  const auto useful = [](const StreamSummary& stream) {
    const StreamType type = stream.info.type;
    const bool frames = type == StreamType::Frames && stream.info.readable;
    return frames || type == StreamType::Events || type == StreamType::Imu || type == StreamType::Points;
  };
  if (std::any_of(inspection.streams.begin(), inspection.streams.end(), useful)) return std::nullopt;
  std::string problem = "it has neither events, frames, points nor IMU samples";
  for (const RecordingFault& fault : inspection.faults) problem += ". " + fault.text;
  return badInput(recording.string(), problem,
                  "Check that the whole file was copied and that the camera's driver was recorded");
}

namespace {

const StreamSummary* streamOf(const std::string& name, const std::filesystem::path& own_recording,
                              const std::vector<InspectedRecording>& recordings) {
  for (const InspectedRecording& recording : recordings) {
    if (recording.file != (own_recording.empty() ? recordings.front().file : own_recording)) continue;
    for (const StreamSummary& stream : recording.inspection.streams)
      if (stream.info.name == name) return &stream;
  }
  return nullptr;
}

bool isFrameCamera(const StreamSummary& stream) {
  return isSensor(stream, StreamType::Frames) && stream.info.readable && stream.info.timed;
}

// Streams of frames that no camera of the session has, each with the advice on its use.
std::vector<std::string> unusedFrames(const Session& session,
                                      const std::vector<InspectedRecording>& recordings) {
  std::vector<std::string> notes;
  for (const InspectedRecording& recording : recordings) {
    const bool is_own = &recording == &recordings.front();
    for (const StreamSummary& stream : recording.inspection.streams) {
      const auto uses = [&](const SessionCamera& camera) {
        return camera.stream == stream.info.name &&
               (camera.recording.empty() ? is_own : camera.recording == recording.file);
      };
      if (!isSensor(stream, StreamType::Frames) ||
          std::any_of(session.cameras.begin(), session.cameras.end(), uses))
        continue;
      notes.push_back(
          fmt::format("the frames of {} in {} are not used{}", stream.info.name, recording.file.string(),
                      !stream.info.readable ? ": they cannot be read"
                      : !stream.info.timed
                          ? ": they have no times, and are suitable for intrinsics only"
                          : fmt::format("; to use them, add a camera with stream: {}{}", stream.info.name,
                                        is_own ? "" : " and recording: " + recording.file.string())));
    }
  }
  return notes;
}

// Remarks on frame streams in the event cameras' recordings: possible additional cameras.
std::vector<std::string> framesBeside(const SessionCamera& camera,
                                      const std::vector<InspectedRecording>& recordings) {
  std::vector<std::string> lines;
  const StreamSummary* const own = streamOf(camera.stream, camera.recording, recordings);
  if (own == nullptr || own->info.type != StreamType::Events) return lines;
  for (const InspectedRecording& recording : recordings) {
    if (recording.file != (camera.recording.empty() ? recordings.front().file : camera.recording)) continue;
    for (const StreamSummary& stream : recording.inspection.streams) {
      if (!isFrameCamera(stream)) continue;
      const bool same = stream.info.resolution_px == camera.resolution_px;
      lines.push_back(
          fmt::format("The recording also has frames, {} as a separate camera: frames: {{stream: {}{}}}",
                      same ? "possibly of this sensor, usable" : "usable", stream.info.name,
                      same ? ", same_sensor_as: " + camera.name : ""));
    }
  }
  return lines;
}

// The event camera whose sensor may also have taken these frames; empty if there is none.
std::string possibleSensor(const SessionCamera& frames, const Session& session,
                           const std::vector<InspectedRecording>& recordings) {
  const StreamSummary* const own = streamOf(frames.stream, frames.recording, recordings);
  if (own == nullptr || own->info.type != StreamType::Frames || !frames.resolution_px.known()) return {};
  for (const SessionCamera& camera : session.cameras) {
    const StreamSummary* const stream = streamOf(camera.stream, camera.recording, recordings);
    if (stream != nullptr && stream->info.type == StreamType::Events &&
        camera.resolution_px == frames.resolution_px)
      return camera.name;
  }
  return {};
}

// Joins a gyroscope and an accelerometer that have their own files. The most similar names belong together.
void joinFiles(const std::vector<InspectedRecording>& recordings, Session& session) {
  const auto kindOf = [&](const SessionImu& imu) {
    const StreamSummary* const stream = streamOf(imu.stream, imu.recording, recordings);
    return stream != nullptr && imu.accelerometer_stream.empty() ? imuStreamKind(*stream)
                                                                 : ImuStreamKind::Whole;
  };
  const auto fileOf = [&](const SessionImu& imu) {
    return imu.recording.empty() ? recordings.front().file : imu.recording;
  };
  const auto mostAlike = [&](const SessionImu& imu, ImuStreamKind kind) {
    std::optional<std::size_t> best;
    std::ptrdiff_t most = -1;
    for (std::size_t i = 0; i < session.imus.size(); ++i) {
      if (kindOf(session.imus[i]) != kind) continue;
      const std::string own = fileOf(imu).string(), other = fileOf(session.imus[i]).string();
      const std::ptrdiff_t alike = std::ranges::mismatch(own, other).in1 - own.begin();
      if (alike <= most) continue;
      best = i;
      most = alike;
    }
    return best;
  };
  for (std::size_t k = 0; k < session.imus.size(); ++k) {
    if (kindOf(session.imus[k]) != ImuStreamKind::Gyroscope) continue;
    const auto other = mostAlike(session.imus[k], ImuStreamKind::Accelerometer);
    if (!other || mostAlike(session.imus[*other], ImuStreamKind::Gyroscope) != k) continue;
    const SessionImu accelerometer = session.imus[*other];
    SessionImu& imu = session.imus[k];
    imu.recording = fileOf(imu);
    imu.accelerometer_recording = fileOf(accelerometer);
    imu.accelerometer_stream = accelerometer.stream == imu.stream
                                   ? accelerometerTable(imu.recording, imu.accelerometer_recording)
                                   : accelerometer.stream;
    imu.acceleration_unit = accelerometer.acceleration_unit;
    session.imus.erase(session.imus.begin() + static_cast<std::ptrdiff_t>(*other));
    if (*other < k) --k;
  }
  // One number for each IMU, not for each file.
  for (SessionImu& imu : session.imus)
    if (!imu.accelerometer_recording.empty()) imu.name.clear();
  for (SessionImu& imu : session.imus)
    if (imu.name.empty()) imu.name = freeName(imu.stream, "imu", session);
}

SessionRemarks remarksOn(const Session& session, const std::vector<InspectedRecording>& recordings) {
  SessionRemarks remarks;
  remarks.board =
      "The board: remove the '#' of its lines, and give type and dimensions.\n"
      "With an IMU, asymmetric circles need an odd number of rows.\n"
      "Measure over as many circles as possible: measured: {spacings: 10, length_m: 0.5, std_m: 0.0005}\n"
      "replaces spacing_m and has the length over ten spacings and the ruler's sigma.";
  for (const SessionCamera& camera : session.cameras) {
    std::vector<std::string>& own = remarks.sensors[camera.name];
    const StreamSummary* const stream = streamOf(camera.stream, camera.recording, recordings);
    if (!camera.resolution_px.known() && stream != nullptr)
      own.push_back(fmt::format(
          "resolution_px: [{}, {}]  # not in the recording; derived from the extent of its events",
          stream->seen_px.width_px, stream->seen_px.height_px));
    own.emplace_back("intrinsics: camera.yaml  # if absent: calibrated first, from the same recording");
    for (std::string& line : framesBeside(camera, recordings)) own.push_back(std::move(line));
    if (const std::string sensor = possibleSensor(camera, session, recordings); !sensor.empty())
      own.push_back(fmt::format("same_sensor_as: {}  # if both streams are of the same sensor", sensor));
    if (!camera.recording.empty())
      own.emplace_back("clock_offset_s: 0.0  # seconds, added to the times of this file");
  }
  for (const SessionImu& imu : session.imus) {
    std::vector<std::string>& own = remarks.sensors[imu.name];
    own.emplace_back("These noise densities are typical values: take those of your IMU from its data sheet.");
    if (!imu.recording.empty())
      own.emplace_back("clock_offset_s: 0.0  # seconds, added to the times of this file");
  }
  return remarks;
}

// Why a stream that is probably of an IMU is not read.
std::string unreadImu(const std::vector<InspectedRecording>& recordings) {
  for (const InspectedRecording& each : recordings)
    for (const RecordingFault& fault : each.inspection.faults)
      if (fault.kind == FaultKind::Unreadable && fault.text.find("of an IMU") != std::string::npos)
        return fault.text;
  return {};
}

std::vector<std::string> notesOn(const Session& session, const std::vector<InspectedRecording>& recordings) {
  std::vector<std::string> notes = {"board: complete its entry"};
  for (const SessionCamera& camera : session.cameras)
    if (!camera.resolution_px.known())
      notes.push_back(
          fmt::format("cameras.{}: give resolution_px, which is not in the recording", camera.name));
  if (session.imus.empty() && session.cameras.size() == 1) {
    const std::string unread = unreadImu(recordings);
    notes.push_back((unread.empty()
                         ? "there is no IMU: add its recording, or calibrate only the camera "
                         : "there is no IMU that can be read. " + unread + " Or calibrate only the camera ") +
                    howTo(HowTo::CalibrateLens));
  }
  return notes;
}

}  // namespace

SessionDraft draftSession(const std::vector<InspectedRecording>& recordings,
                          const std::filesystem::path& folder) {
  SessionDraft draft;
  Session& session = draft.session;
  session.recording = recordings.at(0).file;
  for (const InspectedRecording& each : recordings)
    if (const auto useless = whyUseless(each.file, each.inspection)) throw CalibrationError(*useless);
  const auto addFrom = [&](const InspectedRecording& each, StreamType type) {
    const bool is_own = &each == &recordings.front();
    addSensors(is_own ? std::filesystem::path() : each.file, each.inspection, type, session);
  };
  // If a recording has events or IMU samples besides frames, the frames are only mentioned. A recording that
  // has only frames was given for them.
  const auto hasFramesOnly = [](const InspectedRecording& each) {
    return std::none_of(each.inspection.streams.begin(), each.inspection.streams.end(),
                        [](const StreamSummary& stream) {
                          return isSensor(stream, StreamType::Events) || isSensor(stream, StreamType::Imu);
                        });
  };
  for (const StreamType type : {StreamType::Events, StreamType::Frames, StreamType::Points}) {
    const bool first = session.cameras.empty();
    for (const InspectedRecording& each : recordings)
      if (first || (type == StreamType::Frames && hasFramesOnly(each))) addFrom(each, type);
  }
  for (const InspectedRecording& each : recordings) addFrom(each, StreamType::Imu);
  joinFiles(recordings, session);
  if (session.cameras.empty())
    throw badInput(session.recording.string(),
                   "there are no events, frames or points to calibrate a camera from",
                   "Give the camera's recording, too");
  keepReference(session);
  validate(session, session.recording.string());
  draft.yaml = sessionYaml(session, folder, remarksOn(session, recordings));
  draft.notes = notesOn(session, recordings);
  for (std::string& note : unusedFrames(session, recordings)) draft.notes.push_back(std::move(note));
  return draft;
}

}  // namespace evical
