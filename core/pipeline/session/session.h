// Session: recording, board, sensors, and prior knowledge about them. One YAML file.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/data/imu_units.h"
#include "core/data/mirroring.h"
#include "core/geometry/board.h"
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
  Resolution resolution_px;                    // unknown: given by the recording
  std::optional<CameraIntrinsics> intrinsics;  // absent: calibrated first, from the same events
  std::filesystem::path recording = {};        // its own; empty: the session's
  double clock_offset_s = 0.0;                 // known: to be added to the stream's times
  double clock_scale = 1.0;  // seconds per second of its clock, counted from its first stamp
  std::string columns = {};  // of a text table: a header line that counts instead of the file's
  SensorPrior prior = {};    // the file's prior.cameras.<name>
  std::optional<LensUncertainty> intrinsics_uncertainty = {};  // from another recording; absent: not given
  Shutter shutter = Shutter::Global;                           // of frames
  // Camera with the same sensor chip: this camera has its pose and lens. Empty: none.
  std::string same_sensor_as = {};
  std::string board = {};  // the one that it sees, if there are several; empty: the first
  // Mirroring by the driver, which is reversed on reading; resolution and intrinsics are those of the image
  // without it. Absent: unknown, read as not mirrored.
  std::optional<Mirroring> mirrored = {};
  // Calibrations of the rig exclude the event windows and frames at these times since the recording's start.
  std::vector<double> rejected_windows_s = {};
};

struct SessionImu {
  std::string name, stream;  // the gyroscope's stream, if the accelerometer has its own
  // The accelerometer's own stream. Equal to `stream` if the two alternate on one stream, empty if samples
  // are complete.
  std::string accelerometer_stream = {};
  ImuNoise noise;
  std::optional<AccelerationUnit> acceleration_unit;  // absent: as the recording's format defines
  std::optional<AngularRateUnit> angular_rate_unit;
  AxesReading gyroscope_axes = kIdentityAxes, accelerometer_axes = kIdentityAxes;
  std::filesystem::path recording;  // its own; empty: the session's
  double clock_offset_s = 0.0;      // known: to be added to the stream's times
  double clock_scale = 1.0;         // seconds per second of its clock, counted from its first stamp
  std::string columns = {};         // of a text table: a header line that counts instead of the file's
  ImuPrior prior = {};              // the file's prior.imus.<name>
  // The accelerometer's own file and columns; empty: those of `recording` and `columns`.
  std::filesystem::path accelerometer_recording = {};
  std::string accelerometer_columns = {};
  double acceleration_factor = 1.0, angular_rate_factor = 1.0;  // of the units, for raw counts

  // The name of the joined stream in the opened recording.
  std::string joinedStream() const;
};

// With the measured length that defines spacing and spacing_std, if there is one.
struct SessionBoard : AdditionalBoard {
  std::optional<MeasuredLength> measured = {};
};

struct [[nodiscard]] Session {
  std::filesystem::path source;                             // the file it was read from
  std::filesystem::path recording;                          // absolute, or relative to the working directory
  std::vector<std::filesystem::path> more_recordings = {};  // of a blinking board: one for each of its poses
  std::optional<std::array<double, 2>> time_range_s;        // since the recording's start
  std::string board_name = "board";
  Board board;  // if several: the one that defines the world frame, seen by worldCamera()
  std::vector<SessionBoard> further_boards = {};
  // The board flashes (screen or lamps): for intrinsics only, from events of a camera at rest.
  bool board_blinks = false;
  std::optional<MeasuredLength> measured;  // defines the board's spacing and, as an option, its sigma
  std::vector<SessionCamera> cameras;
  std::vector<SessionImu> imus;
  std::string reference;  // an IMU; a camera if there is no IMU
  // The file's prior.time_offset_search_s, gravity_norm_m_s2 and gravity_norm_std_m_s2 are options here.
  CalibrationOptions options;
  std::vector<std::string> exports;  // targets in addition to kalibr, with the names of `evical export --to`

  // Index of the camera in same_sensor_as; the camera itself if that is empty.
  std::size_t sensorOf(std::size_t camera) const;
  const SessionCamera& sensor(std::size_t camera) const { return cameras[sensorOf(camera)]; }
  std::size_t boardIndexOf(std::size_t camera) const;  // 0: the first
  const Board& boardOf(std::size_t camera) const;
  SeenBoard seenBoard(std::size_t camera) const { return {boardOf(camera), boardIndexOf(camera)}; }
  std::size_t worldCamera() const { return referenceCamera(); }  // the first one if the reference is an IMU
  std::size_t referenceImu() const;                              // index into imus; 0 if there is none
  std::size_t referenceCamera() const;  // index into cameras; 0 if the reference is an IMU
};

// For another recording, or for results that do not depend on them.
Session withoutRejectedWindows(Session session);

// Stream of an accelerometer's own table: the file's name, with its folder if the gyroscope's is the same.
std::string accelerometerTable(const std::filesystem::path& gyroscope,
                               const std::filesystem::path& accelerometer);

// Sets the length and the spacing with its sigma. Without a length the spacing stays, with the default sigma.
void setMeasuredLength(const std::optional<MeasuredLength>& measured, Session& session);

// Sets one key, as for `--set` and repairs: an option, cameras.<name>. with clock_scale or mirrored, or
// imus.<name>. with acceleration_unit, angular_rate_unit, gyroscope_axes, accelerometer_axes or clock_scale.
// Throws CalibrationError (BadInput).
void setInSession(Session& session, const std::string& key, const std::string& value);

// Lenses that the session gives; others are unknown.
std::vector<CameraLens> givenLenses(const Session& session);

// Throws CalibrationError (BadInput) with the place "file: key (line n)", and for unknown keys the nearest
// known one.
Session readSession(const std::filesystem::path& file);

// Checks a session from any source (reader, importer, forms); `place` precedes the key in messages.
void validate(const Session& session, const std::string& place);

// The same with each member's range, as for a file: for sessions whose members are set one by one. Line
// numbers are those of sessionYaml. Recordings may be missing. Throws CalibrationError (BadInput).
void validateMembers(const Session& session);

// Comments in a session file that must be completed.
struct SessionRemarks {
  std::string board;  // if not empty, the board's keys are written as comments below it
  std::map<std::string, std::vector<std::string>> sensors;  // by name: comments below the sensor's keys
};

// The file's content, with paths relative to `folder` if these are simpler; and the file itself, written
// completely or not at all.
std::string sessionYaml(const Session& session, const std::filesystem::path& folder,
                        const SessionRemarks& remarks = {});
void writeSession(const Session& session, const std::filesystem::path& file);

// True if a camera or an IMU of the session has this name.
bool isSensorName(const Session& session, const std::string& name);

}  // namespace evical
