// Options of what the batch optimisation estimates, and of how it weights measurements.
#pragma once

#include "core/base/option_struct.h"

namespace evical {

enum class CameraIntrinsicsChoice { Fixed, Free };
// Auto: estimated once a test shows for certain that it is needed.
enum class Estimated { Auto, No, Yes };
enum class BiasModel { Auto, Constant, Linear };

struct ModelOptions {
  bool free_time_offsets;
  bool time_offset_drift;
  bool free_imu_intrinsics;
  bool free_gravity_norm;
  bool free_board_size;
  bool board_bow;
  Estimated line_delay;
  bool share_sensors;
  CameraIntrinsicsChoice camera_intrinsics;
  Estimated gyroscope_rotation;
  double delay_misfit;
  BiasModel bias_model;
  double bias_knot_spacing_s;
  int most_bias_knots;
  double gyroscope_random_walk;
  double accelerometer_random_walk;
  double slow_edge_speed_px_s;
  double least_centre_sigma_px;
  double common_displacement_px, common_displacement_px2_s, common_displacement_px_s;
  double huber_sigma;
  double outlier_sigma;
  double outlier_window_fraction;

  ModelOptions();  // the defaults
  constexpr explicit ModelOptions(NoDefaults) {}
  bool estimatesLineDelays() const { return line_delay == Estimated::Yes; }
  bool estimatesGyroscopeRotations() const { return gyroscope_rotation == Estimated::Yes; }
  bool hasLinearBiases() const { return bias_model == BiasModel::Linear; }
  bool freesIntrinsics() const { return camera_intrinsics == CameraIntrinsicsChoice::Free; }
  bool operator==(const ModelOptions&) const = default;
  static const OptionTable<ModelOptions>& table();
};

}  // namespace evical
