// Parameters of a simulated recording: board, sensors, motion, noise, seed. They determine the simulation
// completely.
#pragma once

#include "core/data/calibration_state.h"
#include "core/geometry/board.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/printed_pattern.h"
#include "core/geometry/so3.h"

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// An event pixel: log intensity, low-pass filtered, compared with the level at its last event.
struct EventPixelModel {
  double threshold_on = 0.3, threshold_off = 0.3;  // log intensity
  double threshold_mismatch = 0.03;                // sigma over pixels, relative
  double refractory_s = 1e-4;
  double background_rate_hz = 0.1;  // per pixel, either polarity
  int hot_pixels = 5;
  double hot_pixel_rate_hz = 500.0;
  double blur_px = 0.6;         // sigma of the optics' point spread; plus the pixel's area
  double latency_s = 2e-4;      // pure delay
  double low_pass_s = 3e-4;     // time constant of the photoreceptor
  double stamp_jitter_s = 0.0;  // stamps are late by the absolute value of a normal variable with this sigma

  // Further effects of real pixels; all disabled by default. low_pass_s applies to the light halfway between
  // ink and paper: it is proportional to a power of the light. Brightening is faster than that by this share,
  // darkening slower.
  double low_pass_light_power = 0.0;  // 1: twice the light, half the time
  double low_pass_polarity = 0.0;
  double vignetting = 0.0;       // loss of light in the image's corners, which are slower
  double threshold_noise = 0.0;  // sigma from event to event, relative
  double leak_rate_hz = 0.0;     // of ON events without changes of light
  // Time after an event during which the pixel is in reset. The level at its end is the new reference, which
  // therefore depends on the edge's speed. Real pixels: the refractory period. 0: reset only if a threshold
  // is crossed again within it.
  double reset_s = 0.0;
  // Rate of the arbiter: events wait for their readout, and are stamped at it; those that would wait longer
  // are lost.
  double readout_rate_hz = 0.0;  // 0: without limit
  double longest_wait_s = 1e-3;

  // Sigma of the image's blur: the optics' point spread with the pixel's area.
  double effectiveBlur_px() const { return std::sqrt(blur_px * blur_px + 1.0 / 12.0); }

  // Delay of an event's stamp for a slow edge: latency, the low-pass filter's group
  // delay, and the jitter's mean.
  double delay_s() const {
    constexpr double kMeanOfHalfNormal = 0.7978845608028654;  // sqrt(2 / pi)
    return latency_s + low_pass_s + kMeanOfHalfNormal * stamp_jitter_s;
  }
};

// Frames of the same scene by a frame camera.
struct FrameModel {
  double rate_hz = 20.0;
  double exposure_s = 4e-3;
  double line_delay_us = 0.0;  // of a rolling shutter, from row to row
  double noise = 1.5;          // sigma, of 255
  double blur_px = 0.6;        // sigma of the optics' point spread; plus the pixel's area
  int jpeg_quality = 0;        // 1 to 100; 0: pictures are PNG, without loss

  bool operator==(const FrameModel&) const = default;
};

struct SimulatedCamera {
  std::string name = "camera";
  std::string stream = "/camera/events";
  CameraIntrinsics intrinsics;
  RigidTransform imu_from_camera;
  double time_offset_s = 0.0;  // imu_time = camera_time + offset, without the pixels' delay
  EventPixelModel pixel;
  std::optional<FrameModel> frames = {};  // instead of events
  std::string board = "board";            // name of the board in its view
  std::string same_sensor_as = {};        // a camera with the same lens and place, also in the session

  // Delay of stamps.
  double delay_s() const { return frames ? 0.0 : pixel.delay_s(); }
};

// Further faults of an IMU, its clock and its messages; all disabled by default.
struct ImuFaults {
  double low_pass_hz = 0.0;  // of a first-order filter in gyroscope and accelerometer; without its delay
  double gyroscope_range_rad_s = 0.0, accelerometer_range_m_s2 = 0.0;  // limits of each axis
  double gyroscope_step_rad_s = 0.0, accelerometer_step_m_s2 = 0.0;    // resolution of samples
  double g_sensitivity_rad_s_per_m_s2 = 0.0;  // g-sensitivity of each axis to its own specific force
  // Correlated noise: its sigma, and its correlation time.
  double gyroscope_wander_rad_s = 0.0, accelerometer_wander_m_s2 = 0.0, wander_time_s = 0.01;
  int spikes = 0;  // samples with errors of 150 m/s^2 and 30 rad/s

  double clock_drift_ppm = 0.0;  // drift of the stamps, about the recording's middle
  double clock_step_s = 0.0;     // step of the stamps after 60 % of the recording
  double stamp_jitter_s = 0.0;   // sigma
  int batch = 1;                 // number of samples that are stamped with the last one's time
  double lost_share = 0.0;       // of single samples
  int lost_packets = 0;          // of 50 ms

  bool operator==(const ImuFaults&) const = default;
};

// Truth of an IMU, and its measurement model. If biases are random walks, these are the values at the start.
// Motion of a compliant mount: measured by an IMU in addition to the body's motion, separately on each axis;
// noise through a first-order low pass. Sigmas.
struct MountShake {
  double rate_rad_s = 0.0, force_m_s2 = 0.0, correlation_s = 0.3;
};

struct SimulatedImu : ImuState {
  std::string name = "imu";
  std::string stream = "/imu";
  double rate_hz = 1000.0;
  double gyroscope_density = 1.87e-4;      // rad/s/sqrt(Hz)
  double accelerometer_density = 1.86e-3;  // m/s^2/sqrt(Hz)
  double gyroscope_walk = 0.0;             // rad/s^2/sqrt(Hz)
  double accelerometer_walk = 0.0;         // m/s^3/sqrt(Hz)
  MountShake shake;                        // in drives
  ImuFaults faults;
};

// Additions of hand-held motion; all disabled by default. Stops have a period and a duration, and ramp down
// and up within a quarter of a second; tremor continues during them.
struct HandModel {
  double tremor_rad = 0.0, tremor_m = 0.0;  // sigmas of all quantities, at 8 to 12 Hz
  double jerks_per_s = 0.0;                 // bumps of about 0.1 s at random times
  double jerk_rad = 0.0;                    // rotation by a bump
  double stop_every_s = 0.0, stop_s = 1.0;
  double walking_m = 0.0;  // up and down at 1.9 Hz, and half as much to the sides at half of that
};

// The first camera looks at a point that moves around the board's middle, from a varying distance and
// direction. Each of these quantities is a sum of sinusoids drawn from the seed. In addition, the camera may
// rotate back and forth about its y axis, at constant amplitude and in place: other cameras of a rig then see
// the board in turn.
struct MotionModel {
  double distance_m = 0.55;
  double distance_amplitude_m = 0.08;
  Eigen::Vector3d angle_amplitude_rad = {0.35, 0.35, 0.3};  // about the camera's x, y, z
  Eigen::Vector2d target_amplitude_m = {0.04, 0.04};
  double roll_rad = 0.0;  // of the camera, on average
  double turn_rad = 0.0;  // about its y axis, on average
  double turn_amplitude_rad = 0.0;
  double turn_period_s = 4.0;
  double tilt_amplitude_rad = 0.0;  // about its x axis
  double tilt_period_s = 7.0;
  // Additional translation back and forth, along the world's axes; at a third to three times the period.
  Eigen::Vector3d walk_amplitude_m = Eigen::Vector3d::Zero();
  double walk_period_s = 8.0;
  double lowest_frequency_hz = 0.3;  // before scaling to the speed
  double highest_frequency_hz = 1.2;
  int sinusoids = 3;
  double image_speed_px_s =
      70.0;  // RMS over circles and time: frequencies are scaled to reach it; 0 keeps them
  HandModel hand = {};
};

// Bow of the board: height of the middle of its rows and of its columns, and of its corners by a twist
// (core/data/board_bow.h).
struct SimulatedBow {
  double rows_m = 0.0, columns_m = 0.0, twist_m = 0.0;

  bool operator==(const SimulatedBow&) const = default;
};

// A lamp that is reflected by the board's varnish: a spot that moves over the board with the view.
struct GlossModel {
  double strength = 0.0;      // of the spot's middle, added to the board's reflectance; 0: a matt board
  double spread_rad = 0.035;  // sigma of the directions of the reflection
};

// A hand that periodically appears in front of the board, stays for a given time and leaves; disabled by
// default. It casts a shadow of the scene's lamp onto the board.
struct HandOverBoard {
  double every_s = 0.0, stay_s = 1.0;
  double height_m = 0.08;        // in front of the board
  double shadow = 0.6;           // share of the lamp's light that it blocks
  double shadow_edge_m = 0.004;  // sigma of the shadow's edge
};

// People who walk between the board and its background; disabled by default.
struct PeopleModel {
  double every_s = 0.0;
  double speed_m_s = 1.2;
  double distance_m = 0.25;  // behind the board
};

struct SceneModel {
  double bright_reflectance = 0.85, dark_reflectance = 0.06;
  double margin_m = 0.06;             // of the board around its outer circles' centres
  double clutter_contrast = 0.5;      // sigma of the background's log reflectance; 0: bare
  double clutter_round_share = 0.0;   // of the objects: discs like the board's circles
  double clutter_squares_px = 0.0;    // side of the squares of checkerboards in it; 0: none
  double clutter_distance_m = 0.3;    // behind the board
  double clutter_object_share = 0.5;  // of the variance: flat objects with outlines; the rest is clouds
  double clutter_detail_px = 2.0;     // smallest structure, at the mean distance
  double lamp_flicker = 0.0;          // amplitude of the light's, relative
  double lamp_flicker_hz = 100.0;
  double blink_hz = 0.0;  // flash rate of a board on a screen, between pattern and white; 0: printed board
  Eigen::Vector3d lamp_m = {0.1, -0.3,
                            -1.5};  // relative to the board's middle; the camera is also at negative z
  GlossModel gloss = {};
  HandOverBoard hand = {};
  PeopleModel people = {};
};

// A room instead of the board: a box that is seen from inside, and boxes in it, all covered with the
// clutter's picture. With a size of 0 there is no room, but a board.
struct RoomModel {
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();    // along the world's axes, of which y points down
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();  // relative to the board's middle
  int boxes = 10;
  double smallest_box_m = 0.15, largest_box_m = 0.6;  // half sides
  double free_radius_m = 1.0;                         // no box within it around the room's middle
  double texel_m = 0.003;                             // of the picture, whose finest structure is twice that
  double tone = 0.4;                                  // sigma of the sides' own log reflectance
  bool exists() const { return size_m.minCoeff() > 0.0; }
};

// Errors of the session, relative to the truth.
struct SessionErrors {
  double spacing = 0.0, focal_length = 0.0;  // 0.01: 1 % too large
  double principal_point_px = 0.0;           // along x
  double imu_noise_factor = 1.0;             // of both densities

  bool operator==(const SessionErrors&) const = default;
};

// Board in addition to the scenario's first, for the cameras that name it.
struct SimulatedBoard {
  std::string name = "board";
  Board board;
  RigidTransform world_from_board;
};

enum class SimulatedFormat { Bag, Text };

struct Scenario {
  std::string name = "scenario";
  std::uint64_t seed = 1;
  double duration_s = 30.0;
  std::int64_t start_ns = 1'700'000'000'000'000'000;
  Board board;
  double board_stretch = 0.0;  // of the real board: 0.01 makes its columns 1 % longer than those of `board`
  SimulatedBow board_bow = {};
  TagPrint tag_print;  // of the board, if it has tags
  std::vector<SimulatedBoard> further_boards = {};
  SceneModel scene;
  RoomModel room = {};
  MotionModel motion;
  Eigen::Vector3d gravity_in_world_m_s2 = {0.0, 9.81, 0.0};  // the board hangs upright: y points down
  std::vector<SimulatedCamera> cameras;
  std::vector<SimulatedImu> imus;  // the first is the reference
  SimulatedFormat format = SimulatedFormat::Bag;
  bool intrinsics_in_session = true;
  SessionErrors session_errors;
};

}  // namespace evical
