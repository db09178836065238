// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/result_parameters.h"

#include "core/base/element.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/report/result_table.h"
#include "core/report/truth_comparison.h"

#include <QObject>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace evical::ui {
namespace {

// A direction has no number of its own, only how far it is from another.
const char* const kGravityKey = "gravity";
const QString kAcceleration = QString("m/s") + QChar(0xb2);
constexpr double kMmPerM = 1e3, kMsPerS = 1e3;

int decimalsFor(double sigma) {
  constexpr int kWithout = 4, kMost = 8;
  if (!(sigma > 0.0) || !std::isfinite(sigma)) return kWithout;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, kMost);
}

// Collects one sensor's rows.
class Rows {
 public:
  Rows(const std::string& sensor, ParameterGroup& group)
      : prefix_(QString::fromStdString(sensor) + "."), group_(group) {}

  void add(const QString& key, const QString& name, const QString& unit, double value, double sigma) {
    group_.rows.push_back({key.isEmpty() ? key : prefix_ + key, name, unit, value, sigma, {}});
  }
  void addVector(const QString& key, const QString& name, const QString& unit, const Eigen::Vector3d& value,
                 const Eigen::Vector3d& sigma, double factor = 1.0) {
    for (int axis = 0; axis < 3; ++axis) {
      const QChar letter = "xyz"[axis];
      add(key + "." + letter, name + " " + letter, unit, factor * value[axis], factor * sigma[axis]);
    }
  }
  // Upper triangle: what is estimated.
  void addMapping(const QString& key, const QString& name, const Eigen::Matrix3d& value,
                  const Eigen::Matrix3d& sigma) {
    for (int row = 0; row < 3; ++row) {
      for (int col = row; col < 3; ++col) {
        const QString letters = QString("xyz"[row]) + "xyz"[col];
        add(key + "." + letters, name + (row == col ? " scale " : " misalignment ") + letters, {},
            value(row, col), sigma(row, col));
      }
    }
  }
  void addPose(const RigidTransform& pose, const Eigen::Vector3d& rotation_std_rad,
               const Eigen::Vector3d& translation_std_m) {
    addVector("rotation", QObject::tr("Rotation vector"), "deg", quaternionLog(pose.rotation),
              rotation_std_rad, kDegPerRad);
    const Eigen::Vector3d angles_deg = rollPitchYaw_deg(pose.rotation);
    const QString names[] = {QObject::tr("Roll"), QObject::tr("Pitch"), QObject::tr("Yaw")};
    for (int axis = 0; axis < 3; ++axis) add({}, names[axis], "deg", angles_deg[axis], 0.0);
    addVector("translation", QObject::tr("Translation"), "mm", pose.translation_m, translation_std_m,
              kMmPerM);
  }
  // fx fy cx cy and distortion, as calibrated first.
  void addIntrinsics(const CameraIntrinsics& camera, const std::array<double, 9>& sigma) {
    const bool equidistant = camera.model == CameraModel::PinholeEquidistant;
    const std::array names =
        equidistant ? std::array{"k1", "k2", "k3", "k4", ""} : std::array{"k1", "k2", "p1", "p2", "k3"};
    add({}, QObject::tr("Focal length x"), "px", camera.focal_length_px.x(), sigma[0]);
    add({}, QObject::tr("Focal length y"), "px", camera.focal_length_px.y(), sigma[1]);
    add({}, QObject::tr("Principal point x"), "px", camera.principal_point_px.x(), sigma[2]);
    add({}, QObject::tr("Principal point y"), "px", camera.principal_point_px.y(), sigma[3]);
    for (std::size_t k = 0; k < names.size(); ++k)
      if (sigma[4 + k] > 0.0)
        add({}, QObject::tr("Distortion %1").arg(names[k]), {}, camera.distortion[k], sigma[4 + k]);
  }

 private:
  QString prefix_;
  ParameterGroup& group_;
};

ParameterGroup cameraGroup(const NamedResult& named, std::size_t i) {
  const std::string& name = named.names.cameras.at(i);
  const CameraState& state = named.result.state.cameras.at(i);
  const CameraUncertainty sigma = elementOrNone(named.result.uncertainty.cameras, i);
  const CameraFit fit = elementOrNone(named.result.cameras, i);
  ParameterGroup group{QObject::tr("Camera %1 in %2")
                           .arg(QString::fromStdString(name), QString::fromStdString(named.names.reference)),
                       {}};
  Rows rows(name, group);
  if (name == named.names.reference) {
    group.title = QObject::tr("Camera %1 (reference)").arg(QString::fromStdString(name));
  } else {
    rows.addPose(state.reference_from_camera, sigma.rotation_std_rad, sigma.translation_std_m);
    rows.add("time_offset", QObject::tr("Time offset"), "ms", kMsPerS * state.time_offset_s,
             kMsPerS * sigma.time_offset_std_s);
  }
  rows.add({}, QObject::tr("Edge lead at 100 px/s"), "px", state.edge_lead_px, sigma.edge_lead_std_px);
  rows.add({}, QObject::tr("Edge lead growth"), QObject::tr("px / e-fold"), state.edge_lead_growth_px,
           sigma.edge_lead_growth_std_px);
  rows.add({}, QObject::tr("Reprojection RMS"), "px", fit.reprojection_rms_px, 0.0);
  const auto intrinsics = elementOrNone(named.names.intrinsics, i);
  const auto intrinsics_std = elementOrNone(named.names.intrinsics_std, i);
  if (intrinsics && intrinsics_std) rows.addIntrinsics(*intrinsics, *intrinsics_std);
  return group;
}

ParameterGroup imuGroup(const NamedResult& named, std::size_t i) {
  const std::string& name = named.names.imus.at(i);
  const ImuState& state = named.result.state.imus.at(i);
  const ImuUncertainty sigma = elementOrNone(named.result.uncertainty.imus, i);
  const bool reference = name == named.names.reference;
  ParameterGroup group{reference ? QObject::tr("IMU %1 (reference)").arg(QString::fromStdString(name))
                                 : QObject::tr("IMU %1").arg(QString::fromStdString(name)),
                       {}};
  Rows rows(name, group);
  if (!reference) {
    rows.addPose(state.reference_from_imu, sigma.rotation_std_rad, sigma.translation_std_m);
    rows.add("time_offset", QObject::tr("Time offset"), "ms", kMsPerS * state.time_offset_s,
             kMsPerS * sigma.time_offset_std_s);
  }
  rows.addVector("gyroscope_bias", QObject::tr("Gyroscope bias"), "rad/s", state.gyroscope_bias_rad_s,
                 sigma.gyroscope_bias_std_rad_s);
  rows.addVector("accelerometer_bias", QObject::tr("Accelerometer bias"), kAcceleration,
                 state.accelerometer_bias_m_s2, sigma.accelerometer_bias_std_m_s2);
  rows.addMapping("gyroscope_mapping", QObject::tr("Gyroscope"), state.gyroscope_mapping,
                  sigma.gyroscope_mapping_std);
  if (sigma.gyroscope_rotation_std_rad.norm() > 0.0)
    rows.addVector("gyroscope_rotation", QObject::tr("Gyroscope from accelerometer"), "deg",
                   kDegPerRad * quaternionLog(state.gyroscope_from_accelerometer),
                   kDegPerRad * sigma.gyroscope_rotation_std_rad);
  rows.addMapping("accelerometer_mapping", QObject::tr("Accelerometer"), state.accelerometer_mapping,
                  sigma.accelerometer_mapping_std);
  return group;
}

ParameterGroup gravityGroup(const NamedResult& named) {
  ParameterGroup group{QObject::tr("Gravity in the board's frame"), {}};
  const Eigen::Vector3d& gravity = named.result.state.gravity_in_world_m_s2;
  for (int axis = 0; axis < 3; ++axis)
    group.rows.push_back(
        {{}, QObject::tr("Gravity %1").arg(QChar("xyz"[axis])), kAcceleration, gravity[axis], 0.0, {}});
  group.rows.push_back({kGravityKey,
                        QObject::tr("Direction, off by"),
                        "deg",
                        0.0,
                        kDegPerRad * named.result.uncertainty.gravity_direction_std_rad,
                        {}});
  if (const double sigma = named.result.uncertainty.gravity_norm_std_m_s2; sigma > 0.0)
    group.rows.push_back({"gravity.norm", QObject::tr("Norm"), kAcceleration, gravity.norm(), sigma, {}});
  return group;
}

}  // namespace

QString ParameterRow::valueText() const {
  return key == kGravityKey ? QString() : QString::number(value, 'f', decimalsFor(sigma));
}
QString ParameterRow::sigmaText() const {
  return sigma > 0.0 ? QString::number(sigma, 'f', decimalsFor(sigma)) : QString();
}
QString ParameterRow::differenceText() const {
  if (!difference) return {};
  return (*difference < 0.0 ? "" : "+") + QString::number(*difference, 'f', decimalsFor(sigma));
}
QString ParameterRow::sigmasText() const {
  return difference && sigma > 0.0 ? QString::number(std::abs(*difference) / sigma, 'f', 1) : QString();
}

std::vector<ParameterGroup> parameterGroups(const NamedResult& named) {
  std::vector<ParameterGroup> groups;
  for (std::size_t i = 0; i < named.result.state.cameras.size(); ++i) groups.push_back(cameraGroup(named, i));
  for (std::size_t i = 0; i < named.result.state.imus.size(); ++i) groups.push_back(imuGroup(named, i));
  if (!named.result.state.imus.empty()) groups.push_back(gravityGroup(named));
  return groups;
}

void compare(std::vector<ParameterGroup>& groups, const NamedResult& named, const NamedResult& other) {
  const TruthComparison comparison = compareWithTruth(named, other);
  std::map<QString, double> differences = {{kGravityKey, comparison.gravity_direction_deg}};
  for (const QuantityError& quantity : comparison.quantities)
    differences[QString::fromStdString(quantity.name)] = quantity.error;
  for (ParameterGroup& group : groups) {
    for (ParameterRow& row : group.rows) {
      const auto found = differences.find(row.key);
      if (!row.key.isEmpty() && found != differences.end()) row.difference = found->second;
    }
  }
}

}  // namespace evical::ui
