// One row per calibrated quantity, as option_field.h has one per option: the structs contain value, sigma and
// prior; the row has their places and the quantity's properties: name, shape, units, required accuracy, keys
// in files. The comparison of results, split halves, result.yaml, priors, tables, the report and the window
// iterate over these rows. A new quantity needs a row here, members in the structs, and a parameter block in
// the batch.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/numerics/angles.h"

#include <Eigen/Core>

#include <functional>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

namespace evical {

enum class QuantityShape {
  Scalar,
  Vector3,
  Rotation,       // differences and sigmas are about the axes of the target frame
  LocalRotation,  // about the axes of the source frame
  UpperTriangle,  // of a 3 x 3 matrix, row by row
  Intrinsics,     // in the order of camera_intrinsics.h
  Gravity,        // two tilts, and the norm if it is estimated
};

// The applicable accuracy requirement (OptimisationOptions::needed_...).
enum class QuantityNeed { None, Rotation, Translation, TimeOffset };

// The option that enables its estimation, if it is not always estimated.
enum class QuantityRelease {
  Always,
  TimeOffsets,
  ImuIntrinsics,
  GyroscopeRotation,
  TimeOffsetDrift,
  BoardSize,
  BoardBow,
  LineDelay,
  ExposureShare
};

// When it is compared and shown.
enum class QuantityPresence {
  Always,
  WhereNotZero,        // zero means: not estimated
  WhereEstimated,      // in the first of the two compared
  WhereBothEstimated,  // exists in estimates, but not in the truth of a simulation
};

enum class QuantityWriting { Always, WherePresent };  // in result.yaml

struct QuantityInfo {
  QuantityId id;
  const char* name;   // "time_offset"
  const char* title;  // for display
  QuantityOwner owner;
  QuantityShape shape;
  const char* unit;  // SI
  const char* shown_unit = "";
  double shown_factor = 1.0;  // from SI
  int decimals = 5;           // in shown units
  const char* remark = "";    // printed after the unit
  QuantityNeed need = QuantityNeed::None;
  // A size in SI units that makes all quantities comparable, so that "no information" has the same meaning
  // for each.
  double comparable_unit = 1e-3;
  QuantityRelease release = QuantityRelease::Always;
  QuantityPresence presence = QuantityPresence::Always;
  QuantityWriting written = QuantityWriting::Always;
  bool relative = false;   // to the reference, which does not have this quantity
  bool of_sensor = false;  // shared by cameras that are one sensor

  // Keys in result.yaml and in a session's prior; without a section they are keys of the sensor.
  const char* section = "";
  const char* key = "";
  const char* std_key = "";
  double largest = 1e6;  // a larger prior is rejected as a mistake

  constexpr bool is(QuantityOwner of, QuantityId which) const { return owner == of && id == which; }
};

// A member of a member: the rotation of a pose.
template <class Outer, class Inner, class Value>
struct MemberOf {
  Inner Outer::*outer;
  Value Inner::*inner;

  constexpr Value& operator()(Outer& object) const { return object.*outer.*inner; }
  constexpr const Value& operator()(const Outer& object) const { return object.*outer.*inner; }
};
template <class Outer, class Inner, class Value>
MemberOf(Inner Outer::*, Value Inner::*) -> MemberOf<Outer, Inner, Value>;

// A lens: reads the one in use, writes the estimated one.
struct LensIntrinsics {
  const std::optional<CameraIntrinsics>& operator()(const CameraState& camera) const {
    return camera.lens.inUse();
  }
  std::optional<CameraIntrinsics>& operator()(CameraState& camera) const { return camera.lens.solved; }
  bool operator==(const LensIntrinsics&) const = default;
};

// Marks quantities without a place in a session's prior.
struct NoPrior {};

template <class ValueAt, class SigmaAt, class PriorAt>
struct QuantityRow {
  QuantityInfo info;
  ValueAt value_at;
  SigmaAt sigma_at;
  PriorAt prior_at;

  static constexpr bool kHasPrior = !std::is_same_v<PriorAt, NoPrior>;

  template <class State>
  constexpr auto& value(State& state) const {
    return std::invoke(value_at, state);
  }
  template <class Uncertainty>
  constexpr auto& sigma(Uncertainty& uncertainty) const {
    return std::invoke(sigma_at, uncertainty);
  }
  template <class Prior>
  constexpr auto& prior(Prior& prior) const {
    return std::invoke(prior_at, prior);
  }
};
template <class ValueAt, class SigmaAt, class PriorAt>
QuantityRow(QuantityInfo, ValueAt, SigmaAt, PriorAt) -> QuantityRow<ValueAt, SigmaAt, PriorAt>;

namespace detail {

inline constexpr double kLargestPlace_m = 100.0;  // detects millimetres that were given as metres

constexpr QuantityInfo rotationInfo(QuantityOwner owner, const char* section) {
  return {.id = QuantityId::Rotation,
          .name = "rotation",
          .title = "rotation vector",
          .owner = owner,
          .shape = QuantityShape::Rotation,
          .unit = "rad",
          .shown_unit = "deg",
          .shown_factor = kDegPerRad,
          .need = QuantityNeed::Rotation,
          .relative = true,
          .of_sensor = true,
          .section = section,
          .key = "rotation_xyzw",
          .std_key = "rotation_std_deg"};
}

constexpr QuantityInfo translationInfo(QuantityOwner owner, const char* section) {
  return {.id = QuantityId::Translation,
          .name = "translation",
          .title = "translation",
          .owner = owner,
          .shape = QuantityShape::Vector3,
          .unit = "m",
          .shown_unit = "mm",
          .shown_factor = 1e3,
          .decimals = 4,
          .need = QuantityNeed::Translation,
          .relative = true,
          .of_sensor = true,
          .section = section,
          .key = "translation_m",
          .std_key = "translation_std_m",
          .largest = kLargestPlace_m};
}

constexpr QuantityInfo timeOffsetInfo(QuantityOwner owner) {
  return {.id = QuantityId::TimeOffset,
          .name = "time_offset",
          .title = "time offset",
          .owner = owner,
          .shape = QuantityShape::Scalar,
          .unit = "s",
          .shown_unit = "ms",
          .shown_factor = 1e3,
          .need = QuantityNeed::TimeOffset,
          .comparable_unit = 1e-4,
          .release = QuantityRelease::TimeOffsets,
          .relative = true,
          .key = "time_offset_s",
          .std_key = "time_offset_std_s"};
}

constexpr QuantityInfo timeOffsetDriftInfo(QuantityOwner owner) {
  return {.id = QuantityId::TimeOffsetDrift,
          .name = "time_offset_drift",
          .title = "time offset drift",
          .owner = owner,
          .shape = QuantityShape::Scalar,
          .unit = "ppm",
          .shown_unit = "ppm",
          .decimals = 3,
          .comparable_unit = 1.0,
          .release = QuantityRelease::TimeOffsetDrift,
          .presence = QuantityPresence::WhereNotZero,
          .written = QuantityWriting::WherePresent,
          .relative = true,
          .of_sensor = true,
          .key = "clock_drift_ppm",
          .std_key = "clock_drift_std_ppm"};
}

constexpr QuantityInfo mappingInfo(QuantityId id, const char* name, const char* sensor) {
  return {.id = id,
          .name = name,
          .title = sensor,
          .owner = QuantityOwner::Imu,
          .shape = QuantityShape::UpperTriangle,
          .unit = "1",
          .decimals = 6,
          .release = QuantityRelease::ImuIntrinsics,
          .section = sensor,
          .key = "mapping",
          .std_key = "mapping_std"};
}

constexpr QuantityInfo curvatureInfo(QuantityId id, const char* name, const char* title, const char* key,
                                     const char* std_key) {
  return {.id = id,
          .name = name,
          .title = title,
          .owner = QuantityOwner::Board,
          .shape = QuantityShape::Scalar,
          .unit = "1/m",
          .shown_unit = "1/m",
          .comparable_unit = 1e-2,
          .release = QuantityRelease::BoardBow,
          .presence = QuantityPresence::WhereEstimated,
          .written = QuantityWriting::WherePresent,
          .key = key,
          .std_key = std_key};
}

// The pose of a further board in the world: estimated, without an accuracy requirement.
constexpr QuantityInfo ofFurtherBoard(QuantityInfo info) {
  info.need = QuantityNeed::None;
  info.of_sensor = false;
  info.presence = QuantityPresence::WhereNotZero;
  info.written = QuantityWriting::WherePresent;
  return info;
}

}  // namespace detail

inline constexpr auto kCameraQuantities = std::tuple{
    QuantityRow{detail::rotationInfo(QuantityOwner::Camera, "reference_from_camera"),
                MemberOf{&CameraState::reference_from_camera, &RigidTransform::rotation},
                &CameraUncertainty::rotation_std_rad, &SensorPrior::rotation},
    QuantityRow{detail::translationInfo(QuantityOwner::Camera, "reference_from_camera"),
                MemberOf{&CameraState::reference_from_camera, &RigidTransform::translation_m},
                &CameraUncertainty::translation_std_m, &SensorPrior::translation},
    QuantityRow{detail::timeOffsetInfo(QuantityOwner::Camera), &CameraState::time_offset_s,
                &CameraUncertainty::time_offset_std_s, &SensorPrior::time_offset},
    QuantityRow{detail::timeOffsetDriftInfo(QuantityOwner::Camera), &CameraState::time_offset_drift_ppm,
                &CameraUncertainty::time_offset_drift_std_ppm, &SensorPrior::time_offset_drift},
    QuantityRow{QuantityInfo{.id = QuantityId::LineDelay,
                             .name = "line_delay",
                             .title = "line delay",
                             .owner = QuantityOwner::Camera,
                             .shape = QuantityShape::Scalar,
                             .unit = "us",
                             .shown_unit = "us",
                             .decimals = 3,
                             .remark = "from row to row",
                             .comparable_unit = 0.1,
                             .release = QuantityRelease::LineDelay,
                             .presence = QuantityPresence::WhereNotZero,
                             .written = QuantityWriting::WherePresent,
                             .key = "line_delay_us",
                             .std_key = "line_delay_std_us"},
                &CameraState::line_delay_us, &CameraUncertainty::line_delay_std_us, NoPrior{}},
    QuantityRow{QuantityInfo{.id = QuantityId::ExposureShare,
                             .name = "exposure_share",
                             .title = "exposure's share",
                             .owner = QuantityOwner::Camera,
                             .shape = QuantityShape::Scalar,
                             .unit = "1",
                             .decimals = 4,
                             .remark = "from a frame's stamp to its middle: 0.5 if exposures begin at stamps",
                             .comparable_unit = 0.01,
                             .release = QuantityRelease::ExposureShare,
                             .presence = QuantityPresence::WhereNotZero,
                             .written = QuantityWriting::WherePresent,
                             .key = "exposure_share",
                             .std_key = "exposure_share_std"},
                &CameraState::exposure_share, &CameraUncertainty::exposure_share_std, NoPrior{}},
    QuantityRow{QuantityInfo{.id = QuantityId::EdgeLocalisationBias,
                             .name = "edge_localisation_bias",
                             .title = "edge localisation bias",
                             .owner = QuantityOwner::Camera,
                             .shape = QuantityShape::Scalar,
                             .unit = "px",
                             .shown_unit = "px",
                             .decimals = 4,
                             .comparable_unit = 0.1,
                             .presence = QuantityPresence::WhereBothEstimated,
                             .key = "edge_localisation_bias_px",
                             .std_key = "edge_localisation_bias_std_px"},
                &CameraState::edge_localisation_bias_px, &CameraUncertainty::edge_localisation_bias_std_px,
                NoPrior{}},
    QuantityRow{QuantityInfo{.id = QuantityId::SlowEdgeLocalisationBias,
                             .name = "slow_edge_localisation_bias",
                             .title = "edge localisation bias at low speed",
                             .owner = QuantityOwner::Camera,
                             .shape = QuantityShape::Scalar,
                             .unit = "px",
                             .shown_unit = "px",
                             .decimals = 4,
                             .comparable_unit = 1e-2,
                             .presence = QuantityPresence::WhereBothEstimated,
                             .key = "slow_edge_localisation_bias_px",
                             .std_key = "slow_edge_localisation_bias_std_px"},
                &CameraState::slow_edge_localisation_bias_px,
                &CameraUncertainty::slow_edge_localisation_bias_std_px, NoPrior{}},
    QuantityRow{QuantityInfo{.id = QuantityId::Intrinsics,
                             .name = "intrinsics",
                             .title = "intrinsics",
                             .owner = QuantityOwner::Camera,
                             .shape = QuantityShape::Intrinsics,
                             .unit = "px",
                             .shown_unit = "px",
                             .presence = QuantityPresence::WhereEstimated,
                             .of_sensor = true,
                             .key = "intrinsics",
                             .std_key = "intrinsics_std"},
                LensIntrinsics{}, &CameraUncertainty::intrinsics_std, NoPrior{}}};

inline constexpr auto kImuQuantities = std::tuple{
    QuantityRow{detail::rotationInfo(QuantityOwner::Imu, "reference_from_imu"),
                MemberOf{&ImuState::reference_from_imu, &RigidTransform::rotation},
                &ImuUncertainty::rotation_std_rad, &ImuPrior::rotation},
    QuantityRow{detail::translationInfo(QuantityOwner::Imu, "reference_from_imu"),
                MemberOf{&ImuState::reference_from_imu, &RigidTransform::translation_m},
                &ImuUncertainty::translation_std_m, &ImuPrior::translation},
    QuantityRow{detail::timeOffsetInfo(QuantityOwner::Imu), &ImuState::time_offset_s,
                &ImuUncertainty::time_offset_std_s, &ImuPrior::time_offset},
    QuantityRow{detail::timeOffsetDriftInfo(QuantityOwner::Imu), &ImuState::time_offset_drift_ppm,
                &ImuUncertainty::time_offset_drift_std_ppm, &ImuPrior::time_offset_drift},
    QuantityRow{QuantityInfo{.id = QuantityId::GyroscopeBias,
                             .name = "gyroscope_bias",
                             .title = "gyroscope bias",
                             .owner = QuantityOwner::Imu,
                             .shape = QuantityShape::Vector3,
                             .unit = "rad/s",
                             .shown_unit = "rad/s",
                             .decimals = 6,
                             .section = "gyroscope",
                             .key = "bias_rad_s",
                             .std_key = "bias_std_rad_s"},
                &ImuState::gyroscope_bias_rad_s, &ImuUncertainty::gyroscope_bias_std_rad_s,
                &ImuPrior::gyroscope_bias},
    QuantityRow{QuantityInfo{.id = QuantityId::AccelerometerBias,
                             .name = "accelerometer_bias",
                             .title = "accelerometer bias",
                             .owner = QuantityOwner::Imu,
                             .shape = QuantityShape::Vector3,
                             .unit = "m/s^2",
                             .shown_unit = "m/s^2",
                             .comparable_unit = 1e-2,
                             .section = "accelerometer",
                             .key = "bias_m_s2",
                             .std_key = "bias_std_m_s2"},
                &ImuState::accelerometer_bias_m_s2, &ImuUncertainty::accelerometer_bias_std_m_s2,
                &ImuPrior::accelerometer_bias},
    QuantityRow{detail::mappingInfo(QuantityId::GyroscopeScaleMisalignment, "gyroscope_scale_misalignment",
                                    "gyroscope"),
                &ImuState::gyroscope_scale_misalignment, &ImuUncertainty::gyroscope_scale_misalignment_std,
                &ImuPrior::gyroscope_scale_misalignment},
    QuantityRow{detail::mappingInfo(QuantityId::AccelerometerScaleMisalignment,
                                    "accelerometer_scale_misalignment", "accelerometer"),
                &ImuState::accelerometer_scale_misalignment,
                &ImuUncertainty::accelerometer_scale_misalignment_std,
                &ImuPrior::accelerometer_scale_misalignment},
    QuantityRow{QuantityInfo{.id = QuantityId::AccelerometerDelay,
                             .name = "accelerometer_delay",
                             .title = "accelerometer delay",
                             .owner = QuantityOwner::Imu,
                             .shape = QuantityShape::Scalar,
                             .unit = "s",
                             .shown_unit = "ms",
                             .shown_factor = 1e3,
                             .decimals = 4,
                             .remark = "relative to the gyroscope",
                             .release = QuantityRelease::ImuIntrinsics,
                             .key = "accelerometer_delay_s",
                             .std_key = "accelerometer_delay_std_s",
                             .largest = 0.1},
                &ImuState::accelerometer_delay_s, &ImuUncertainty::accelerometer_delay_std_s,
                &ImuPrior::accelerometer_delay},
    QuantityRow{QuantityInfo{.id = QuantityId::GyroscopeRotation,
                             .name = "gyroscope_rotation",
                             .title = "gyroscope rotation",
                             .owner = QuantityOwner::Imu,
                             .shape = QuantityShape::LocalRotation,
                             .unit = "rad",
                             .shown_unit = "deg",
                             .shown_factor = kDegPerRad,
                             .remark = "relative to the accelerometer",
                             .release = QuantityRelease::GyroscopeRotation,
                             .presence = QuantityPresence::WhereNotZero,
                             .section = "gyroscope",
                             .key = "gyroscope_from_accelerometer_xyzw",
                             .std_key = "rotation_std_deg"},
                &ImuState::gyroscope_from_accelerometer, &ImuUncertainty::gyroscope_rotation_std_rad,
                &ImuPrior::gyroscope_rotation}};

inline constexpr auto kBoardQuantities = std::tuple{
    QuantityRow{detail::ofFurtherBoard(detail::rotationInfo(QuantityOwner::Board, "world_from_board")),
                MemberOf{&BoardState::world_from_board, &RigidTransform::rotation},
                &BoardUncertainty::rotation_std_rad, NoPrior{}},
    QuantityRow{detail::ofFurtherBoard(detail::translationInfo(QuantityOwner::Board, "world_from_board")),
                MemberOf{&BoardState::world_from_board, &RigidTransform::translation_m},
                &BoardUncertainty::translation_std_m, NoPrior{}},
    QuantityRow{QuantityInfo{.id = QuantityId::Scale,
                             .name = "scale",
                             .title = "size",
                             .owner = QuantityOwner::Board,
                             .shape = QuantityShape::Scalar,
                             .unit = "1",
                             .remark = "times the session's value",
                             .release = QuantityRelease::BoardSize,
                             .presence = QuantityPresence::WhereEstimated,
                             .written = QuantityWriting::WherePresent,
                             .key = "scale",
                             .std_key = "scale_std"},
                &BoardState::scale, &BoardUncertainty::scale_std, NoPrior{}},
    QuantityRow{QuantityInfo{.id = QuantityId::Stretch,
                             .name = "stretch",
                             .title = "stretch",
                             .owner = QuantityOwner::Board,
                             .shape = QuantityShape::Scalar,
                             .unit = "1",
                             .remark = "of its rows relative to its columns",
                             .release = QuantityRelease::BoardSize,
                             .presence = QuantityPresence::WhereEstimated,
                             .written = QuantityWriting::WherePresent,
                             .key = "stretch",
                             .std_key = "stretch_std"},
                &BoardState::stretch, &BoardUncertainty::stretch_std, NoPrior{}},
    QuantityRow{detail::curvatureInfo(QuantityId::RowCurvature, "row_curvature", "curvature along its rows",
                                      "row_curvature_1_m", "row_curvature_std_1_m"),
                &BoardState::row_curvature_1_m, &BoardUncertainty::row_curvature_std_1_m, NoPrior{}},
    QuantityRow{
        detail::curvatureInfo(QuantityId::ColumnCurvature, "column_curvature", "curvature along its columns",
                              "column_curvature_1_m", "column_curvature_std_1_m"),
        &BoardState::column_curvature_1_m, &BoardUncertainty::column_curvature_std_1_m, NoPrior{}},
    QuantityRow{detail::curvatureInfo(QuantityId::Twist, "twist", "twist", "twist_1_m", "twist_std_1_m"),
                &BoardState::twist_1_m, &BoardUncertainty::twist_std_1_m, NoPrior{}}};

// The only quantity of the rig as a whole. Its sigmas are of a different kind (UncertaintyReport), so it is
// not a row.
inline constexpr QuantityInfo kGravityQuantity = {.id = QuantityId::Gravity,
                                                  .name = "gravity",
                                                  .title = "gravity",
                                                  .owner = QuantityOwner::Rig,
                                                  .shape = QuantityShape::Gravity,
                                                  .unit = "m/s^2",
                                                  .shown_unit = "m/s^2",
                                                  .key = "gravity_m_s2"};

template <class Rows, class Visitor>
constexpr void forEachQuantity(const Rows& rows, Visitor&& visit) {
  std::apply([&](const auto&... row) { (visit(row), ...); }, rows);
}

// The kinds of sensors: their key in files, their rows, and where a rig, its state or its uncertainty has
// them.
struct CameraSensors {
  static constexpr const char* kKey = "cameras";
  static constexpr QuantityOwner kOwner = QuantityOwner::Camera;
  static constexpr const auto& rows() { return kCameraQuantities; }
  template <class Rig>
  static constexpr auto& of(Rig& rig) {
    return rig.cameras;
  }
  template <class Rig>
  static constexpr auto& namesOf(Rig& rig) {
    return rig.camera_names;
  }
  template <class Input>
  static bool isReference(const Input& input, std::size_t camera) {
    return input.isReferenceCamera(camera);
  }
};
struct ImuSensors {
  static constexpr const char* kKey = "imus";
  static constexpr QuantityOwner kOwner = QuantityOwner::Imu;
  static constexpr const auto& rows() { return kImuQuantities; }
  template <class Rig>
  static constexpr auto& of(Rig& rig) {
    return rig.imus;
  }
  template <class Rig>
  static constexpr auto& namesOf(Rig& rig) {
    return rig.imu_names;
  }
  template <class Input>
  static bool isReference(const Input& input, std::size_t imu) {
    return input.isReferenceImu(imu);
  }
};

// Calls visit(kind) with an object of each. Code that treats all sensors alike uses it, so that another kind
// needs only its rows, its members in the structs, its cost and its reader.
template <class Visitor>
constexpr void forEachSensorKind(Visitor&& visit) {
  visit(CameraSensors{});
  visit(ImuSensors{});
}

// The shape of a board's sheet: all its quantities except its pose.
template <class Visitor>
constexpr void forEachSheetQuantity(Visitor&& visit) {
  forEachQuantity(kBoardQuantities, [&](const auto& row) {
    if constexpr (std::is_same_v<decltype(row.value(std::declval<BoardState&>())), double&>) visit(row);
  });
}

// Calls visit(row, sensor...) for the number's quantity, with its owner in each of `in`, which std::tie makes
// of states or uncertainty reports. Gravity has no row.
template <class In, class Visitor>
void visitQuantity(const QuantityAddress& number, const In& in, Visitor&& visit) {
  const auto among = [&](const auto& rows, auto&... sensors) {
    forEachQuantity(rows, [&](const auto& row) {
      if (row.info.id == number.id) visit(row, sensors...);
    });
  };
  const auto of = [&](auto&... each) {
    forEachSensorKind([&](auto kind) {
      if (number.owner == kind.kOwner) among(kind.rows(), kind.of(each).at(number.sensor)...);
    });
    if (number.owner == QuantityOwner::Board) among(kBoardQuantities, each.boardAt(number.sensor)...);
  };
  std::apply(of, in);
}

// Properties of a row, or of gravity. Throws std::out_of_range if the owner has no such quantity.
const QuantityInfo& quantityInfo(QuantityOwner owner, QuantityId id);

// Iterates over the quantities with a place in a session's prior.
template <class Rows, class Visitor>
constexpr void forEachPriorQuantity(const Rows& rows, Visitor&& visit) {
  forEachQuantity(rows, [&](const auto& row) {
    if constexpr (std::remove_cvref_t<decltype(row)>::kHasPrior) visit(row);
  });
}

// One number of a quantity.
struct QuantityPart {
  std::string
      name;  // "rotation.x", "focal_length.y"; with the sensor's name and a dot in front, unique in a rig
  std::string component;  // "x", "focal_length.y"; empty for scalars
  std::string unit, shown_unit;
};
std::vector<QuantityPart> quantityParts(const QuantityInfo& info);  // for all shapes except intrinsics
// The parts of the quantity, for `value` as in a state; for intrinsics, the parts of their model.
template <class Value>
std::vector<QuantityPart> quantityParts(const QuantityInfo& info, const Value&) {
  return quantityParts(info);
}
std::vector<QuantityPart> quantityParts(const QuantityInfo& info,
                                        const std::optional<CameraIntrinsics>& value);
// Throws std::out_of_range if it does not exist.
QuantityPart quantityPart(const QuantityAddress& number);

// Address of the quantity's first number, `value` as in a state.
template <class Value>
QuantityAddress quantityAddress(const QuantityInfo& info, std::size_t sensor, const Value& value) {
  QuantityAddress first{info.owner, sensor, info.id};
  if constexpr (std::is_same_v<Value, std::optional<CameraIntrinsics>>)
    if (value) first.model = value->model;
  return first;
}

// Addresses of all numbers of the state.
std::vector<QuantityAddress> quantityAddresses(const CalibrationState& state);

// Sets each quantity's sigmas from the standard deviations of its columns.
void setSigmas(UncertaintyReport& report);

// Covariance of the estimated numbers of a lens; empty if none is estimated.
Eigen::MatrixXd intrinsicsCovariance(const UncertaintyReport& report, std::size_t camera);

// The numbers of a value, in SI units: rotations as vectors, upper triangles row by row; all nine of
// intrinsics.
Eigen::VectorXd quantityNumbers(double value);
Eigen::VectorXd quantityNumbers(const Eigen::Vector3d& value);
Eigen::VectorXd quantityNumbers(const Eigen::Quaterniond& value);
Eigen::VectorXd quantityNumbers(const Eigen::Matrix3d& value);
Eigen::VectorXd quantityNumbers(const std::optional<CameraIntrinsics>& value);
Eigen::VectorXd quantityNumbers(const std::optional<std::array<double, 9>>& sigmas);

// The inverse, for sigmas; fixed numbers of intrinsics stay 0.
void setQuantityNumbers(const Eigen::VectorXd& numbers, double& value);
void setQuantityNumbers(const Eigen::VectorXd& numbers, Eigen::Vector3d& value);
void setQuantityNumbers(const Eigen::VectorXd& numbers, Eigen::Matrix3d& value);
void setQuantityNumbers(const Eigen::VectorXd& numbers, std::optional<std::array<double, 9>>& sigmas);

// a - b; of rotations a rotation vector about the axes that their shape states.
template <class Value>
Eigen::VectorXd quantityDifference(const QuantityInfo&, const Value& a, const Value& b) {
  return quantityNumbers(a) - quantityNumbers(b);
}
Eigen::VectorXd quantityDifference(const QuantityInfo& info, const Eigen::Quaterniond& a,
                                   const Eigen::Quaterniond& b);

// True if the quantity is compared and shown.
template <class Row, class State, class Uncertainty>
bool isPresent(const Row& row, const State& state, const Uncertainty& uncertainty) {
  switch (row.info.presence) {
    case QuantityPresence::Always:
      return true;
    case QuantityPresence::WhereNotZero:
    case QuantityPresence::WhereBothEstimated:
      if (!quantityNumbers(row.value(state)).isZero(0.0)) return true;
      [[fallthrough]];
    case QuantityPresence::WhereEstimated:
      break;
  }
  return !quantityNumbers(row.sigma(uncertainty)).isZero(0.0);
}

}  // namespace evical
