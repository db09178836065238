// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/imu_form.h"

#include "core/numerics/angles.h"

#include "ui/forms/form_words.h"
#include "ui/screens/recording/clock_offset_field.h"

#include <QComboBox>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>

#include <numbers>
#include <optional>

namespace evical::ui {
namespace {

struct NoisePreset {
  const char* name;
  ImuNoise noise;
};

constexpr double perDeg(double deg_s) {
  return kRadPerDeg * deg_s;
}
constexpr double microG(double micro_g) {
  return micro_g * 1e-6 * 9.80665;
}

// Typical values of data sheets, in their units: deg/s and micro g, each per root hertz.
const NoisePreset kPresets[] = {
    {"Evical's default", ImuNoise{}},
    {"Bosch BMI088, typical", {perDeg(0.014), microG(175)}},
    {"Bosch BMI160, typical", {perDeg(0.007), microG(180)}},
    {"Bosch BMI270, typical", {perDeg(0.007), microG(160)}},
    {"InvenSense MPU-6050, MPU-6150 (DAVIS346), typical", {perDeg(0.005), microG(400)}},
    {"InvenSense MPU-6500, typical", {perDeg(0.010), microG(300)}},
    {"TDK ICM-20948, typical", {perDeg(0.015), microG(230)}},
};

// Boxes for units; the first entry means "not given".
template <class Unit>
int indexOf(const std::optional<Unit>& unit) {
  return unit ? static_cast<int>(*unit) + 1 : 0;
}

template <class Unit>
std::optional<Unit> unitAt(int index) {
  return index > 0 ? std::optional(static_cast<Unit>(index - 1)) : std::nullopt;
}

// Random walks are unchanged.
void setDensities(const ImuNoise& noise, SessionImu& imu) {
  imu.noise.gyroscope_density = noise.gyroscope_density;
  imu.noise.accelerometer_density = noise.accelerometer_density;
}

QLabel* explanation(QWidget* parent) {
  return new FormLabel(
      QObject::tr(
          "Noise density of the IMU: a sample's standard deviation is the density times the square root of "
          "the rate. Data sheets give it at rest; vibration adds to it. The calibration estimates the actual "
          "size of the residuals, weights them accordingly, and notes large differences."),
      "hint", parent);
}

}  // namespace

ImuForm::ImuForm(QWidget* parent)
    : QWidget(parent),
      form_(new QFormLayout(this)),
      name_(new QLineEdit(this)),
      preset_(new QComboBox(this)),
      gyroscope_(new NumberField(1e-8, 10.0, this)),
      accelerometer_(new NumberField(1e-7, 10.0, this)),
      clock_offset_s_(clockOffsetField(this)),
      angular_rate_unit_(new QComboBox(this)),
      acceleration_unit_(new QComboBox(this)) {
  for (const NoisePreset& preset : kPresets) preset_->addItem(preset.name);
  preset_->addItem(tr("Custom"));
  const QString unstated = tr("from the file");
  angular_rate_unit_->addItems({unstated, "rad/s", "deg/s"});
  acceleration_unit_->addItems({unstated, QString("m/s") + QChar(0xb2), "g", "-g"});
  name_->setToolTip(tr("Name of the IMU in the session, the result and the exports"));
  preset_->setToolTip(tr("Typical noise densities of data sheets"));
  angular_rate_unit_->setToolTip(
      tr("Unit of the recorded angular rates, if the file does not state it or states it "
         "wrongly"));
  acceleration_unit_->setToolTip(
      tr("Unit of the recorded accelerations, if the file does not state it or states it wrongly; "
         "-g for drivers that report gravity instead of specific force"));
  form_->setContentsMargins(8, 8, 8, 8);
  constexpr int kMin_px = 70;  // "0.00187"
  for (NumberField* const field : {gyroscope_, accelerometer_}) field->setMinimumWidth(kMin_px);
  for (QComboBox* const box : {preset_, angular_rate_unit_, acceleration_unit_}) {
    constexpr int kMinCharacters = 12;  // longer names are readable in the open list
    box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    box->setMinimumContentsLength(kMinCharacters);
  }
  form_->setRowWrapPolicy(QFormLayout::WrapLongRows);
  form_->addRow(tr("Name"), name_);
  form_->addRow(tr("Noise preset"), preset_);
  form_->addRow(QString("Gyroscope [rad/s/%1Hz]").arg(QChar(0x221a)), gyroscope_);
  form_->addRow(QString("Accelerometer [m/s%1/%2Hz]").arg(QChar(0xb2)).arg(QChar(0x221a)), accelerometer_);
  form_->addRow(explanation(this));
  form_->addRow(tr("Unit of angular rates"), angular_rate_unit_);
  form_->addRow(tr("Unit of accelerations"), acceleration_unit_);
  form_->addRow(tr("Clock offset [s]"), clock_offset_s_);

  connect(name_, &QLineEdit::editingFinished, this, [this] { say("name"); });
  connect(preset_, &QComboBox::activated, this, &ImuForm::usePreset);
  connect(gyroscope_, &NumberField::valueEdited, this, [this] { say("gyroscope_noise_density"); });
  connect(accelerometer_, &NumberField::valueEdited, this, [this] { say("accelerometer_noise_density"); });
  connect(clock_offset_s_, &NumberField::valueEdited, this, [this] { say("clock_offset_s"); });
  connect(angular_rate_unit_, &QComboBox::activated, this, [this] { say("angular_rate_unit"); });
  connect(acceleration_unit_, &QComboBox::activated, this, [this] { say("acceleration_unit"); });
}

void ImuForm::setImu(const SessionImu& imu) {
  imu_ = imu;
  name_->setText(QString::fromStdString(imu.name));
  gyroscope_->setValue(imu.noise.gyroscope_density);
  accelerometer_->setValue(imu.noise.accelerometer_density);
  clock_offset_s_->setValue(imu.clock_offset_s);
  form_->setRowVisible(clock_offset_s_, !imu.recording.empty());
  angular_rate_unit_->setCurrentIndex(indexOf(imu.angular_rate_unit));
  acceleration_unit_->setCurrentIndex(indexOf(imu.acceleration_unit));
  int match = static_cast<int>(std::size(kPresets));  // custom
  for (std::size_t i = 0; i < std::size(kPresets); ++i) {
    if (kPresets[i].noise.gyroscope_density == imu.noise.gyroscope_density &&
        kPresets[i].noise.accelerometer_density == imu.noise.accelerometer_density)
      match = static_cast<int>(i);
  }
  preset_->setCurrentIndex(match);
}

void ImuForm::usePreset(int index) {
  if (index >= static_cast<int>(std::size(kPresets))) return;
  SessionImu changed = imu_;
  setDensities(kPresets[index].noise, changed);
  emit edited(changed, "noise");
}

void ImuForm::say(const QString& field) {
  SessionImu changed = imu_;
  changed.name = name_->text().trimmed().toStdString();
  setDensities({gyroscope_->value(), accelerometer_->value()}, changed);
  changed.clock_offset_s = clock_offset_s_->value();
  changed.angular_rate_unit = unitAt<AngularRateUnit>(angular_rate_unit_->currentIndex());
  changed.acceleration_unit = unitAt<AccelerationUnit>(acceleration_unit_->currentIndex());
  const bool same = changed.name == imu_.name && changed.clock_offset_s == imu_.clock_offset_s &&
                    changed.noise.gyroscope_density == imu_.noise.gyroscope_density &&
                    changed.noise.accelerometer_density == imu_.noise.accelerometer_density &&
                    changed.angular_rate_unit == imu_.angular_rate_unit &&
                    changed.acceleration_unit == imu_.acceleration_unit;
  if (same || changed.name.empty()) return setImu(imu_);
  emit edited(changed, field);
}

}  // namespace evical::ui
