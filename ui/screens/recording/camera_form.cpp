// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/camera_form.h"

#include "core/base/error.h"
#include "core/format/intrinsics_yaml.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/lens_fit.h"
#include "ui/forms/form_words.h"
#include "ui/screens/recording/clock_offset_field.h"
#include "ui/theme/theme.h"

#include <QComboBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QToolButton>

#include <algorithm>

namespace evical::ui {
namespace {

constexpr int kNotKnown = static_cast<int>(kCameraModelNames.size());  // last entry in the list of models
constexpr double kMaxPixels = 30'000.0, kMaxDistortion = 100.0;

void showText(QLabel* label, const QString& text) {
  label->setText(text);
  label->setVisible(!text.isEmpty());
}

}  // namespace

CameraForm::CameraForm(QWidget* parent)
    : QWidget(parent),
      form_(new QFormLayout(this)),
      name_(new QLineEdit(this)),
      width_px_(new NumberField(0.0, kMaxPixels, this)),
      height_px_(new NumberField(0.0, kMaxPixels, this)),
      clock_offset_s_(clockOffsetField(this)),
      model_(new QComboBox(this)),
      shutter_(new QComboBox(this)),
      sensor_(new QComboBox(this)),
      board_(new QComboBox(this)),
      focal_x_px_(new NumberField(0.0, 10 * kMaxPixels, this)),
      focal_y_px_(new NumberField(0.0, 10 * kMaxPixels, this)),
      centre_x_px_(new NumberField(-kMaxPixels, kMaxPixels, this)),
      centre_y_px_(new NumberField(-kMaxPixels, kMaxPixels, this)),
      coefficient_names_(new QLabel(this)),
      take_over_(new QPushButton(tr("Use the last run's estimate"), this)),
      file_problem_(new FormLabel({}, "problem", this)) {
  for (int model = 0; model < kNotKnown; ++model)
    model_->addItem(QString::fromUtf8(cameraModelTitle(static_cast<CameraModel>(model))));
  model_->addItem(tr("Unknown: calibrated first"));
  shutter_->setObjectName("shutter");
  shutter_->addItems({tr("Global"), tr("Rolling")});  // in Shutter's order
  shutter_->setToolTip(tr("For frame cameras only. The line delay of a rolling shutter is estimated."));
  sensor_->setObjectName("same_sensor_as");
  sensor_->setToolTip(
      tr("A DAVIS records events and frames with one sensor: they share lens and pose, and the result "
         "contains the delay between them."));
  board_->setObjectName("board");
  board_->setToolTip(tr("The session's board in front of this camera"));
  name_->setToolTip(tr("Name of the camera in the session, the result and the exports"));
  width_px_->setToolTip(tr("Width of the sensor; 0: from the recording"));
  height_px_->setToolTip(tr("Height of the sensor; 0: from the recording"));
  model_->setToolTip(
      tr("Projection of the lens: equidistant for wide angles; double sphere, EUCM and omni beyond about "
         "150 degrees. If unknown, the "
         "intrinsics are calibrated first, from the same events."));
  focal_x_px_->setToolTip(tr("fx"));
  focal_y_px_->setToolTip(tr("fy"));
  centre_x_px_->setToolTip(tr("cx"));
  centre_y_px_->setToolTip(tr("cy"));
  auto* const file = new QToolButton(this);  // without text, which would cut the model's name at 1024 px
  file->setIcon(icon("open"));
  file->setAccessibleName(tr("Intrinsics from a file"));
  file->setToolTip(
      tr("Intrinsics from a file: map or result of Evical, camchain of Kalibr, or camera_info of ROS"));
  connect(file, &QToolButton::clicked, this, &CameraForm::chooseFile);
  coefficient_names_->setObjectName("coefficient_names");
  take_over_->setObjectName("take_over");
  take_over_->setToolTip(tr("Saves these intrinsics with the session, for use in the next runs"));
  take_over_->hide();
  file_problem_->hide();
  connect(take_over_, &QPushButton::clicked, this, &CameraForm::takeOver);
  auto* const coefficients = new QWidget(this);
  auto* const row = new QHBoxLayout(coefficients);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(4);
  const std::pair<NumberField*, QString> named[] = {{width_px_, tr("Width in pixels")},
                                                    {height_px_, tr("Height in pixels")},
                                                    {focal_x_px_, tr("Focal length, horizontal")},
                                                    {focal_y_px_, tr("Focal length, vertical")},
                                                    {centre_x_px_, tr("Principal point, horizontal")},
                                                    {centre_y_px_, tr("Principal point, vertical")}};
  for (const auto& [field, name] : named) field->setAccessibleName(name);
  int coefficient = 0;
  for (NumberField*& field : distortion_) {
    field = new NumberField(-kMaxDistortion, kMaxDistortion, this);
    field->setAccessibleName(tr("Distortion coefficient %1").arg(++coefficient));
    field->setMinimumWidth(40);
    row->addWidget(field);
  }
  form_->setContentsMargins(4, 8, 4, 8);
  form_->setRowWrapPolicy(QFormLayout::DontWrapRows);  // wrapped fields vanish before rows that are hidden
  for (QComboBox* const box : {model_, shutter_, sensor_, board_}) {
    constexpr int kMinCharacters = 8;  // longer names are readable in the open list
    box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    box->setMinimumContentsLength(kMinCharacters);
  }
  form_->addRow(tr("Name"), name_);
  // Names of models are too long for the column of fields in a narrow page.
  auto* const line = new QHBoxLayout;
  auto* const label = new QLabel(tr("Model"), this);
  label->setBuddy(model_);
  line->addWidget(label);
  line->addWidget(model_, 1);
  line->addWidget(file);
  // The rows that most people need are visible in a small window.
  form_->addRow(tr("Resolution [px]"), pairOf(width_px_, height_px_));
  form_->addRow(tr("Board"), board_);
  form_->addRow(line);
  form_->addRow(file_problem_);
  form_->addRow(tr("Focal length [px]"), pairOf(focal_x_px_, focal_y_px_));
  form_->addRow(tr("Principal point [px]"), pairOf(centre_x_px_, centre_y_px_));
  form_->addRow(tr("Distortion"), coefficient_names_);
  form_->addRow(coefficients);
  form_->addRow(take_over_);
  form_->addRow(tr("Shutter"), shutter_);
  form_->addRow(tr("Sensor"), sensor_);
  form_->addRow(tr("Clock offset [s]"), clock_offset_s_);

  connect(name_, &QLineEdit::editingFinished, this, [this] { say("name"); });
  connect(model_, &QComboBox::activated, this, [this] { say("intrinsics"); });
  connect(shutter_, &QComboBox::activated, this, [this] { say("shutter"); });
  connect(sensor_, &QComboBox::activated, this, [this] { say("same_sensor_as"); });
  connect(board_, &QComboBox::activated, this, [this] { say("board"); });
  for (NumberField* const field : {width_px_, height_px_})
    connect(field, &NumberField::valueEdited, this, [this] { say("resolution_px"); });
  connect(clock_offset_s_, &NumberField::valueEdited, this, [this] { say("clock_offset_s"); });
  for (NumberField* const field : intrinsicsFields())
    connect(field, &NumberField::valueEdited, this, [this] { say("intrinsics"); });
}

std::vector<NumberField*> CameraForm::intrinsicsFields() const {
  std::vector<NumberField*> fields = {focal_x_px_, focal_y_px_, centre_x_px_, centre_y_px_};
  fields.insert(fields.end(), distortion_.begin(), distortion_.end());
  return fields;
}

QWidget* CameraForm::pairOf(NumberField* first, NumberField* second) {
  auto* const pair = new QWidget(this);
  auto* const layout = new QHBoxLayout(pair);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(6);
  constexpr int kMin_px = 48;  // "1234.5"
  for (NumberField* const field : {first, second}) {
    field->setMinimumWidth(kMin_px);
    layout->addWidget(field);
  }
  return pair;
}

void CameraForm::setCamera(const SessionCamera& camera, const std::vector<std::string>& others,
                           const std::vector<std::string>& boards) {
  camera_ = camera;
  others_ = others;
  boards_ = boards;
  showSensor();
  showBoard();
  showShutter();
  name_->setText(QString::fromStdString(camera.name));
  width_px_->setValue(camera.resolution_px.width_px);
  height_px_->setValue(camera.resolution_px.height_px);
  shutter_->setCurrentIndex(static_cast<int>(camera.shutter));
  const CameraIntrinsics shown = camera.intrinsics.value_or(CameraIntrinsics{});
  model_->setCurrentIndex(camera.intrinsics ? static_cast<int>(shown.model) : kNotKnown);
  focal_x_px_->setValue(shown.focal_length_px.x());
  focal_y_px_->setValue(shown.focal_length_px.y());
  centre_x_px_->setValue(shown.principal_point_px.x());
  centre_y_px_->setValue(shown.principal_point_px.y());
  showCoefficients(shown);
  showTakeOver();
  for (NumberField* const field : intrinsicsFields()) field->setEnabled(camera.intrinsics.has_value());
  clock_offset_s_->setValue(camera.clock_offset_s);
  form_->setRowVisible(clock_offset_s_, !camera.recording.empty());
}

// A camera on another camera's sensor shares its lens.
void CameraForm::showSensor() {
  sensor_->clear();
  sensor_->addItem(tr("Its own"));
  for (const std::string& other : others_)
    sensor_->addItem(tr("The same as %1's").arg(QString::fromStdString(other)));
  const auto found = std::find(others_.begin(), others_.end(), camera_.same_sensor_as);
  const bool shared = !camera_.same_sensor_as.empty() && found != others_.end();
  sensor_->setCurrentIndex(shared ? static_cast<int>(found - others_.begin()) + 1 : 0);
  form_->setRowVisible(sensor_, !others_.empty() || !camera_.same_sensor_as.empty());
  model_->setEnabled(!shared);
}

void CameraForm::showBoard() {
  board_->clear();
  for (const std::string& board : boards_) board_->addItem(QString::fromStdString(board));
  const auto found = std::find(boards_.begin(), boards_.end(), camera_.board);
  board_->setCurrentIndex(found == boards_.end() ? -1 : static_cast<int>(found - boards_.begin()));
  form_->setRowVisible(board_, !boards_.empty());
}

void CameraForm::offerShutter(bool offered) {
  shutter_offered_ = offered;
  showShutter();
}

void CameraForm::showShutter() {
  form_->setRowVisible(shutter_, shutter_offered_ || camera_.shutter != Shutter::Global);
}

void CameraForm::showCoefficients(const CameraIntrinsics& shown) {
  const auto names = distortionNames(shown.model);
  const auto count = static_cast<std::size_t>(coefficientCount(shown.model));
  QStringList legend;
  for (std::size_t i = 0; i < distortion_.size(); ++i) {
    distortion_[i]->setValue(shown.distortion[i]);
    distortion_[i]->setToolTip(names[i]);
    distortion_[i]->setVisible(i < count);
    if (i < count) legend << names[i];
  }
  coefficient_names_->setText(legend.join(", "));
}

std::optional<CameraIntrinsics> CameraForm::typedIntrinsics() const {
  if (model_->currentIndex() == kNotKnown) return std::nullopt;
  CameraIntrinsics typed;
  typed.model = static_cast<CameraModel>(model_->currentIndex());
  typed.resolution_px = camera_.resolution_px;
  typed.focal_length_px = {focal_x_px_->value(), focal_y_px_->value()};
  typed.principal_point_px = {centre_x_px_->value(), centre_y_px_->value()};
  // Coefficients of one model are meaningless in another.
  const CameraIntrinsics before = camera_.intrinsics.value_or(typed);
  if (!camera_.intrinsics || before.model != typed.model) {
    const CameraIntrinsics other = plainLens(before, typed.model);
    typed.distortion = other.distortion;
    typed.focal_length_px = other.focal_length_px;
    return typed;
  }
  const auto count = static_cast<std::size_t>(coefficientCount(typed.model));
  for (std::size_t i = 0; i < count; ++i) typed.distortion[i] = distortion_[i]->value();
  return typed;
}

void CameraForm::say(const QString& field) {
  SessionCamera changed = camera_;
  changed.name = name_->text().trimmed().toStdString();
  changed.resolution_px = {static_cast<int>(width_px_->value()), static_cast<int>(height_px_->value())};
  changed.clock_offset_s = clock_offset_s_->value();
  changed.shutter = static_cast<Shutter>(shutter_->currentIndex());
  if (field == "same_sensor_as") {
    const int chosen = sensor_->currentIndex();
    changed.same_sensor_as = chosen > 0 ? others_[static_cast<std::size_t>(chosen) - 1] : std::string();
    if (chosen > 0) changed.intrinsics.reset();
    if (chosen > 0) changed.intrinsics_uncertainty.reset();
  }
  if (field == "board") changed.board = board_->currentText().toStdString();
  if (field == "resolution_px" && changed.intrinsics)
    changed.intrinsics->resolution_px = changed.resolution_px;
  if (field == "intrinsics") {
    changed.intrinsics = typedIntrinsics();
    changed.intrinsics_uncertainty.reset();  // belongs to the previous numbers
  }
  const bool same = changed.name == camera_.name && changed.resolution_px == camera_.resolution_px &&
                    changed.intrinsics == camera_.intrinsics && changed.shutter == camera_.shutter &&
                    changed.same_sensor_as == camera_.same_sensor_as && changed.board == camera_.board &&
                    changed.clock_offset_s == camera_.clock_offset_s;
  if (same || changed.name.empty()) return setCamera(camera_, others_, boards_);
  emit edited(changed, field);
}

void CameraForm::setFound(const std::optional<CameraIntrinsics>& found) {
  found_ = found;
  showTakeOver();
}

// A lens shared with another camera is set in that camera's form.
void CameraForm::showTakeOver() {
  take_over_->setVisible(found_ && !camera_.intrinsics && camera_.same_sensor_as.empty());
}

void CameraForm::takeOver() {
  if (!found_) return;
  SessionCamera changed = camera_;
  changed.intrinsics = found_;  // without sigmas: the recording would count twice
  changed.intrinsics_uncertainty.reset();
  changed.resolution_px = found_->resolution_px;
  emit edited(changed, "found_intrinsics");
}

void CameraForm::chooseFile() {
  const QString file = QFileDialog::getOpenFileName(this, tr("Intrinsics of %1").arg(name_->text()), {},
                                                    tr("YAML (*.yaml *.yml);;All files (*)"));
  if (!file.isEmpty()) loadIntrinsics(file);
}

void CameraForm::loadIntrinsics(const QString& file) {
  SessionCamera changed = camera_;
  try {
    const KnownIntrinsics known = readKnownIntrinsics(file.toStdString(), camera_.name, camera_.stream);
    changed.intrinsics = known.camera;
    changed.intrinsics_uncertainty = known.uncertainty;
  } catch (const CalibrationError& error) {
    showText(file_problem_, QFileInfo(file).fileName() + ": " + QString::fromStdString(error.problem()) +
                                ". " + QString::fromStdString(error.advice()));
    return;
  }
  Resolution& own = changed.intrinsics->resolution_px;
  if (!own.known()) own = changed.resolution_px;
  if (changed.resolution_px.known() && own != changed.resolution_px) {
    showText(file_problem_, tr("%1 is for %2 x %3 px, the camera has %4 x %5")
                                .arg(QFileInfo(file).fileName())
                                .arg(own.width_px)
                                .arg(own.height_px)
                                .arg(changed.resolution_px.width_px)
                                .arg(changed.resolution_px.height_px));
    return;
  }
  changed.resolution_px = own;
  showText(file_problem_, {});
  emit edited(changed, "intrinsics_file");
}

}  // namespace evical::ui
