// A session: which recording, which board, which sensors, and what is known of them. One YAML file.
#pragma once

#include "core/data/calibration_priors.h"
#include "core/data/calibration_setup.h"
#include "core/data/imu_units.h"
#include "core/geometry/measured_length.h"
#include "core/pipeline/session/calibration_options.h"

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace evical {

struct SessionCamera {
  std::string name, stream;
  Resolution resolution_px;                    // unknown: the recording says it
  std::optional<CameraIntrinsics> intrinsics;  // absent: calibrated first, from the same events
  std::filesystem::path recording = {};        // its own; empty: the session's
  double clock_offset_s = 0.0;                 // known: to be added to the stream's times
  double clock_scale = 1.0;  // seconds per second of its clock, counted from its first stamp
  std::string columns = {};  // of a text table: a header line that counts instead of the file's
  SensorPrior prior = {};    // the file's prior.cameras.<name>
  std::optional<LensUncertainty> intrinsics_uncertainty = {};  // from another recording; absent: not said
  Shutter shutter = Shutter::Global;                           // of frames
  // The camera whose chip this one's stream comes from, too: pose and lens are that one's. Empty: its own.
  std::string same_sensor_as = {};
  std::string board = {};  // which of several it sees; empty: the first
};

struct SessionImu {
  std::string name, stream;  // the gyroscope's stream, if the accelerometer has its own
  // The accelerometer's own stream. Equal to `stream` if the two alternate on one stream, empty if samples are complete.
  std::string accelerometer_stream = {};
  ImuNoise noise;
  std::optional<AccelerationUnit> acceleration_unit;  // absent: as the recording's format says
  std::optional<AngularRateUnit> angular_rate_unit;
  AxesReading gyroscope_axes = kIdentityAxes, accelerometer_axes = kIdentityAxes;
  std::filesystem::path recording;  // its own; empty: the session's
  double clock_offset_s = 0.0;      // known: to be added to the stream's times
  double clock_scale = 1.0;         // seconds per second of its clock, counted from its first stamp
  std::string columns = {};         // of a text table: a header line that counts instead of the file's
  ImuPrior prior = {};              // the file's prior.imus.<name>

  // The name of the joined stream in the opened recording.
  std::string joinedStream() const;
};

// With what tells its spacing and spacing_std, where it was measured so.
struct SessionBoard : AdditionalBoard {
  std::optional<MeasuredLength> measured = {};
};

struct Session {
  std::filesystem::path source;                             // the file it was read from
  std::filesystem::path recording;                          // absolute, or relative to the working directory
  std::vector<std::filesystem::path> more_recordings = {};  // of a blinking board: one for each of its places
  std::optional<std::array<double, 2>> time_range_s;        // since the recording's start
  std::string board_name = "board";
  Board board;  // of several the one whose frame is the world: that of the camera worldCamera()
  std::vector<SessionBoard> further_boards = {};
  // It is on a screen, or of lamps, that flash: for intrinsics alone, from events of a camera that stands still.
  bool board_blinks = false;
  std::optional<MeasuredLength> measured;  // what tells the board's spacing and, as an option, its sigma
  std::vector<SessionCamera> cameras;
  std::vector<SessionImu> imus;
  std::string reference;  // an IMU; a camera where there is no IMU
  // The file's prior.time_offset_search_s, gravity_norm_m_s2 and gravity_norm_std_m_s2 are options here.
  CalibrationOptions options;
  std::vector<std::string> exports;  // targets besides kalibr, as `evical export --to` names them

  // Of what same_sensor_as names; the camera itself, where it names none.
  std::size_t sensorOf(std::size_t camera) const;
  const SessionCamera& sensor(std::size_t camera) const { return cameras[sensorOf(camera)]; }
  std::size_t boardIndexOf(std::size_t camera) const;  // 0: the first
  const Board& boardOf(std::size_t camera) const;
  SeenBoard seenBoard(std::size_t camera) const { return {boardOf(camera), boardIndexOf(camera)}; }
  std::size_t worldCamera() const {
    return referenceCamera();
  }                                     // the first one, where the reference is an IMU
  std::size_t referenceImu() const;     // index into imus; 0 where there is none
  std::size_t referenceCamera() const;  // index into cameras; 0 where the reference is an IMU
};

// The board's spacing, and how well it is known, follow; without a length the spacing stays, and is as well known as any.
void setMeasuredLength(const std::optional<MeasuredLength>& measured, Session& session);

// One key, as `--set` and repairs have it: an option, cameras.<name>.clock_scale, or imus.<name>. and acceleration_unit,
// angular_rate_unit, gyroscope_axes, accelerometer_axes or clock_scale. Throws CalibrationError (BadInput).
void setInSession(Session& session, const std::string& key, const std::string& value);

// As the session gives them: those that it leaves out are not known yet.
std::vector<CameraLens> givenLenses(const Session& session);

// Throws CalibrationError (BadInput) with the place "file: key (line n)"; unknown keys
// with the nearest known one.
Session readSession(const std::filesystem::path& file);

// What a session must fulfil whoever made it (reader, importer, forms); `place` precedes the key in messages.
void validate(const Session& session, const std::string& place);

// The same with each member's range, as a file is checked: for sessions whose members people set one by one. Lines are
// those of sessionYaml. Recordings may be missing. Throws CalibrationError (BadInput).
void validateMembers(const Session& session);

// What the file says beside its keys, for who fills it in.
struct SessionRemarks {
  std::string board;  // the board's keys become comments below this one; empty: they are keys
  std::map<std::string, std::vector<std::string>> sensors;  // by name: comments below the sensor's keys
};

// The file's content, paths relative to `folder` where that makes them simpler; and the
// file itself, whole or not.
std::string sessionYaml(const Session& session, const std::filesystem::path& folder,
                        const SessionRemarks& remarks = {});
void writeSession(const Session& session, const std::filesystem::path& file);

// True if a camera or an IMU of the session has this name.
bool isSensorName(const Session& session, const std::string& name);

}  // namespace evical
