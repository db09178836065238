// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/result/result_parameters.h"

#include "core/base/element.h"
#include "core/base/number.h"
#include "core/numerics/angles.h"
#include "core/report/result_table.h"
#include "core/report/shown_quantity.h"
#include "core/report/truth_comparison.h"
#include "ui/screens/format_number.h"

#include <QObject>

#include <cmath>
#include <map>

namespace evical::ui {
namespace {

// A direction has no value, only a difference to another direction.
const char* const kGravityKey = "gravity";
constexpr int kMaxDecimals = 8;
const QString kAcceleration = QString("m/s") + QChar(0xb2);

// "Accelerometer delay", "Gyroscope scale xx", "Focal length x".
QString nameOf(const ShownQuantity& quantity, const ShownNumber& number) {
  QString name = QObject::tr(quantity.info->title);
  if (quantity.info->shape == QuantityShape::UpperTriangle)
    name += " " + (isScale(number) ? QObject::tr("scale") : QObject::tr("misalignment"));
  const QString part = QString::fromStdString(number.part);
  if (quantity.info->shape == QuantityShape::Intrinsics)
    name = part;
  else if (!part.isEmpty())
    name += " " + part;
  name[0] = name[0].toUpper();
  return name;
}

void addQuantity(const ShownQuantity& quantity, const Eigen::Quaterniond& rotation, ParameterGroup& group) {
  const bool intrinsics = quantity.info->shape == QuantityShape::Intrinsics;
  for (const ShownNumber& number : quantity.numbers) {
    if (intrinsics && number.sigma == 0.0) continue;  // fixed
    group.rows.push_back({QString::fromStdString(number.key),
                          nameOf(quantity, number),
                          unitText(number.unit),
                          number.value,
                          number.sigma,
                          {},
                          {},
                          QObject::tr(quantity.info->remark)});
  }
  if (quantity.info->shape != QuantityShape::Rotation) return;
  const Eigen::Vector3d angles_deg = rollPitchYaw_deg(rotation);
  if (!anglesWarning(angles_deg).empty())
    return;  // roll, pitch and yaw are meaningless if they are not unique
  const QString names[] = {QObject::tr("Roll"), QObject::tr("Pitch"), QObject::tr("Yaw")};
  for (int axis = 0; axis < 3; ++axis)
    group.rows.push_back({{}, names[axis], "deg", angles_deg[axis], 0.0, {}});
}

// True for the quantities that people calibrate for; all others are details.
bool isPoseOrOffset(const ShownQuantity& quantity) {
  const QuantityId id = quantity.info->id;
  return id == QuantityId::Rotation || id == QuantityId::Translation || id == QuantityId::TimeOffset;
}

// "Camera left" or "IMU imu (reference)".
QString sensorTitle(const QString& kind, const std::string& name, const std::string& reference) {
  const QString sensor = kind.arg(QString::fromStdString(name));
  return name == reference ? QObject::tr("%1 (reference)").arg(sensor) : sensor;
}

void addCamera(const NamedResult& named, std::size_t i, std::vector<ParameterGroup>& groups) {
  const std::string& name = named.cameras.at(i).name;
  const QString sensor = sensorTitle(QObject::tr("Camera %1"), name, named.reference);
  ParameterGroup pose{QObject::tr("%1 in %2").arg(sensor, QString::fromStdString(named.reference)), {}};
  ParameterGroup details{QObject::tr("%1: details").arg(sensor), {}, true};
  ParameterGroup lens{QObject::tr("%1: lens").arg(sensor), {}, true};
  for (const ShownQuantity& quantity : shownCamera(named, i, name != named.reference)) {
    const bool of_lens = quantity.info->shape == QuantityShape::Intrinsics;
    addQuantity(quantity, named.result->state.cameras[i].reference_from_camera.rotation,
                of_lens                    ? lens
                : isPoseOrOffset(quantity) ? pose
                                           : details);
  }
  const CameraFit fit = elementOrNone(named.result->cameras, i);
  details.rows.push_back({{}, QObject::tr("Reprojection RMS"), "px", fit.reprojection_rms_px, 0.0, {}});
  for (ParameterGroup* const group : {&pose, &lens, &details})
    if (!group->rows.empty()) groups.push_back(std::move(*group));
}

void addImu(const NamedResult& named, std::size_t i, std::vector<ParameterGroup>& groups) {
  const std::string& name = named.imus.at(i).name;
  const QString sensor = sensorTitle(QObject::tr("IMU %1"), name, named.reference);
  ParameterGroup pose{QObject::tr("%1 in %2").arg(sensor, QString::fromStdString(named.reference)), {}};
  ParameterGroup details{name == named.reference ? sensor : QObject::tr("%1: details").arg(sensor), {}, true};
  for (const ShownQuantity& quantity : shownImu(named, i, name != named.reference))
    addQuantity(quantity, named.result->state.imus[i].reference_from_imu.rotation,
                isPoseOrOffset(quantity) ? pose : details);
  for (ParameterGroup* const group : {&pose, &details})
    if (!group->rows.empty()) groups.push_back(std::move(*group));
}

ParameterGroup boardGroup(const NamedResult& named, std::size_t board) {
  ParameterGroup group{QString::fromStdString(boardTitle(named, board)), {}, true};
  for (const ShownQuantity& quantity : shownBoard(named, board))
    addQuantity(quantity, named.result->state.boardAt(board).world_from_board.rotation, group);
  return group;
}

ParameterGroup gravityGroup(const NamedResult& named) {
  ParameterGroup group{QObject::tr("Gravity in the board's frame"), {}, true};
  const Eigen::Vector3d& gravity = named.result->state.gravity_in_world_m_s2;
  for (int axis = 0; axis < 3; ++axis)
    group.rows.push_back(
        {{}, QObject::tr("Gravity %1").arg(QChar("xyz"[axis])), kAcceleration, gravity[axis], 0.0, {}});
  group.rows.push_back({kGravityKey,
                        QObject::tr("Direction, deviation"),
                        "deg",
                        0.0,
                        kDegPerRad * named.result->uncertainty.gravity_direction_std_rad,
                        {}});
  if (const double sigma = named.result->uncertainty.gravity_norm_std_m_s2; sigma > 0.0)
    group.rows.push_back({"gravity.norm", QObject::tr("Norm"), kAcceleration, gravity.norm(), sigma, {}});
  return group;
}

}  // namespace

QString ParameterRow::valueText() const {
  return key == kGravityKey ? QString() : QString::number(value, 'f', decimalsFor(sigma, kMaxDecimals));
}
QString ParameterRow::sigmaText() const {
  return sigma > 0.0 ? QString::number(sigma, 'f', decimalsFor(sigma, kMaxDecimals)) : QString();
}
QString ParameterRow::differenceText() const {
  if (!difference) return {};
  return (*difference < 0.0 ? "" : "+") + QString::number(*difference, 'f', decimalsFor(sigma, kMaxDecimals));
}
QString ParameterRow::sigmasText() const {
  return difference && sigma > 0.0 ? QString::number(std::abs(*difference) / sigma, 'f', 1) : QString();
}

std::vector<ParameterGroup> parameterGroups(const NamedResult& named) {
  std::vector<ParameterGroup> groups;
  for (std::size_t i = 0; i < named.result->state.cameras.size(); ++i) addCamera(named, i, groups);
  for (std::size_t i = 0; i < named.result->state.imus.size(); ++i) addImu(named, i, groups);
  for (std::size_t i = 0; i < named.boards.size(); ++i)
    if (ParameterGroup board = boardGroup(named, i); !board.rows.empty()) groups.push_back(std::move(board));
  if (!named.result->state.imus.empty()) groups.push_back(gravityGroup(named));
  return groups;
}

QString tabbedText(const std::vector<ParameterGroup>& groups) {
  bool compared = false;
  for (const ParameterGroup& group : groups)
    for (const ParameterRow& row : group.rows) compared = compared || row.difference;
  QStringList header = {QObject::tr("name"), QObject::tr("value"), QObject::tr("sigma"), QObject::tr("unit")};
  if (compared) header << QObject::tr("difference") << QObject::tr("difference in sigmas");
  QString text = header.join('\t') + '\n';
  for (const ParameterGroup& group : groups) {
    for (const ParameterRow& row : group.rows) {
      const QString detail = row.detail.isEmpty() ? QString() : " " + row.detail;
      QStringList cells = {group.title + ": " + row.name + detail, row.valueText(), row.sigmaText(),
                           row.unit};
      if (compared) cells << row.differenceText() << row.sigmasText();
      text += cells.join('\t') + '\n';
    }
  }
  return text;
}

QStringList compare(std::vector<ParameterGroup>& groups, const NamedResult& named, const NamedResult& other) {
  const TruthComparison comparison = compareWithTruth(named, other);
  std::map<QString, double> differences = {{kGravityKey, comparison.gravity_direction_deg}};
  for (const QuantityDifference& quantity : comparison.quantities)
    differences[QString::fromStdString(quantity.name)] = quantity.difference;
  for (ParameterGroup& group : groups) {
    for (ParameterRow& row : group.rows) {
      const auto found = differences.find(row.key);
      if (!row.key.isEmpty() && found != differences.end()) row.difference = found->second;
    }
  }
  QStringList notes;
  for (const std::string& note : comparison.notes) notes << QString::fromStdString(note);
  return notes;
}

}  // namespace evical::ui
