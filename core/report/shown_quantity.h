// Calibrated quantities in displayed units, number by number. Tables, the report and the window display them.
#pragma once

#include "core/report/result_yaml.h"

#include "core/data/quantity.h"
#include "core/data/quantity_address.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace evical {

struct ShownNumber {
  std::string key;   // as in a comparison of results (quantity_difference.h): "left.rotation.x"
  std::string part;  // "x", "yz", "focal length y"; empty of a scalar
  std::string unit;
  double value = 0.0, sigma = 0.0;  // sigma 0: not estimated
};

struct ShownQuantity {
  const QuantityInfo* info = nullptr;
  std::vector<ShownNumber> numbers;
};

// All present quantities, in the order of quantity.h; the pose can be omitted, which a reference does not
// have.
std::vector<ShownQuantity> shownCamera(const NamedResult& named, std::size_t camera, bool with_place = true);
std::vector<ShownQuantity> shownImu(const NamedResult& named, std::size_t imu, bool with_place = true);
// Empty if the board's size is fixed; for a further board also its pose in the world.
std::vector<ShownQuantity> shownBoard(const NamedResult& named, std::size_t board);
BoardUncertainty boardUncertainty(const UncertaintyReport& report,
                                  std::size_t board);                 // all 0 if absent
std::string boardTitle(const NamedResult& named, std::size_t board);  // "Board", or "Board tags" of several

// "ms against the gyroscope"
std::string unitAndRemark(const ShownQuantity& quantity);

// Elements of a 3 x 3 matrix: scales on the diagonal, misalignments off it.
bool isScale(const ShownNumber& number);

// Names of estimated numbers, for people and for tables.

// "camera: left, quantity: gyroscope_bias, component: x", as result.yaml has it.
std::string columnKeys(const QuantityAddress& number, const NamedResult& named);

// "left.gyroscope_bias.x [rad/s]", for all columns of the result's covariance.
std::vector<std::string> columnNames(const NamedResult& named);

struct QuantityWords {
  std::string sensor;    // "left"
  std::string quantity;  // "gyroscope bias"
  std::string part;      // "x", "xy"; empty if the quantity is one number
};

QuantityWords quantityWords(const QuantityAddress& number, const NamedResult& named);

// "left: gyroscope bias x"
std::string quantitySentence(const QuantityWords& words);

// Pose of each sensor of a result relative to the reference, and its description.

// Transforms points of the sensor to the reference: p_reference = R p_sensor + t.
struct SensorPose {
  enum class Kind { Camera, Imu };

  std::string sensor, reference;
  Kind kind = Kind::Camera, reference_kind = Kind::Imu;
  RigidTransform reference_from_sensor;
  double time_offset_s = 0.0;  // t_reference = t_sensor + that
  std::size_t number = 0;      // among the cameras, or the IMUs
  // Rigs without an IMU: other programs chain the cameras, each to the previous one.
  std::optional<RigidTransform> camera_from_camera_before = {};
};

// Cameras, then IMUs, without the reference.
std::vector<SensorPose> sensorPoses(const NamedResult& named);

// "transforms points of left to left_imu: p_left_imu = R p_left + t"
std::string directionWords(const SensorPose& pose);

// Warning if roll and yaw rotate about almost the same axis (gimbal lock): they are not separable, and change
// by a large amount with the last digit. Otherwise empty.
std::string anglesWarning(const Eigen::Vector3d& roll_pitch_yaw_deg);

}  // namespace evical
