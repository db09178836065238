// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/result/pose_panel.h"

#include "core/export/pose_text.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/report/result_table.h"
#include "ui/forms/fold_button.h"
#include "ui/screens/result/rig_drawing.h"
#include "ui/theme/theme.h"

#include <QClipboard>
#include <QComboBox>
#include <QContextMenuEvent>
#include <QFontDatabase>
#include <QFormLayout>
#include <QGuiApplication>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QToolButton>

#include <algorithm>
#include <string_view>

namespace evical::ui {
namespace {

constexpr double kPoseMmPerM = 1e3, kMillisecondsPerSecond = 1e3;

QLabel* words(const char* role, QWidget* parent) {
  auto* const label = new QLabel(parent);
  label->setProperty("role", role);
  label->setWordWrap(true);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  return label;
}

QLabel* numbers(const QString& object_name, QWidget* parent) {
  auto* const label = words("", parent);
  label->setObjectName(object_name);
  label->setWordWrap(false);
  QFont font = QFontDatabase::systemFont(QFontDatabase::FixedFont);
  font.setPointSizeF(parent->font().pointSizeF() - 0.5);
  label->setFont(font);
  return label;
}

template <class Values>
QString row(const Values& values, int decimals, int width) {
  QString text;
  for (Eigen::Index k = 0; k < values.size(); ++k)
    text += QString::number(values[k], 'f', decimals).rightJustified(width);
  return text;
}

QString matrixText(const RigidTransform& place) {
  constexpr int kDecimals = 6, kWidth = 10;
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = place.rotation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = place.translation_m;
  QStringList rows;
  for (Eigen::Index k = 0; k < 4; ++k) rows << row(Eigen::Vector4d(matrix.row(k)), kDecimals, kWidth);
  return rows.join('\n');
}

// Rows whose titles are above their values.
QFormLayout& poseRows(QWidget& page) {
  auto* const form = new QFormLayout(&page);
  form->setContentsMargins(0, 0, 0, 0);
  form->setRowWrapPolicy(QFormLayout::WrapAllRows);
  form->setVerticalSpacing(3);
  return *form;
}

}  // namespace

PosePanel::PosePanel(QWidget* parent)
    : QScrollArea(parent),
      sensor_(new QComboBox(this)),
      copy_(new QToolButton(this)),
      copy_menu_(new QMenu(tr("Copy pose &as"), this)),
      drawing_(new RigDrawing(this)),
      direction_(words("", this)),
      said_(words("hint", this)),
      translation_(numbers("translation", this)),
      vector_(numbers("rotation_vector", this)),
      angles_(numbers("angles", this)),
      warning_(words("problem", this)),
      quaternion_(numbers("quaternion", this)),
      matrix_(numbers("matrix", this)),
      time_(words("", this)) {
  setAccessibleName(tr("Pose"));
  drawing_->setAccessibleName(tr("Drawing of the rig"));
  direction_->setObjectName("direction");
  warning_->setObjectName("angles_warning");
  said_->setObjectName("copied");
  auto* const content = new QWidget(this);
  auto* const column = new QVBoxLayout(content);
  column->setContentsMargins(4, 8, 4, 4);
  column->setSpacing(6);
  column->addWidget(makeBar());
  column->addWidget(said_);
  column->addWidget(direction_);
  column->addWidget(drawing_, 1);
  column->addWidget(makeNumbers());
  setWidget(content);
  setWidgetResizable(true);
  setFrameShape(QFrame::NoFrame);
  said_->hide();
  fillCopyMenu();
  connect(sensor_, &QComboBox::activated, this, &PosePanel::showPose);
}

QWidget* PosePanel::makeBar() {
  auto* const bar = new QWidget(this);
  auto* const layout = new QHBoxLayout(bar);
  layout->setContentsMargins(0, 0, 0, 0);
  sensor_->setObjectName("posed_sensor");
  sensor_->setAccessibleName(tr("Sensor whose pose is shown"));
  sensor_->setToolTip(tr("Sensor whose pose is shown and copied"));
  copy_->setObjectName("copy_as");
  copy_->setText(tr("Copy as"));
  copy_->setIcon(icon("copy"));
  copy_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  copy_->setPopupMode(QToolButton::InstantPopup);
  copy_->setFocusPolicy(Qt::StrongFocus);
  copy_->setAccessibleName(tr("Copy the pose as"));
  copy_->setToolTip(tr("Copy the pose with all digits, for a document or another program"));
  copy_->setMenu(copy_menu_);
  auto* const save = new QToolButton(bar);
  save->setObjectName("save_rig");
  save->setText(tr("Drawing"));
  save->setIcon(icon("save"));
  save->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  save->setFocusPolicy(Qt::StrongFocus);
  save->setAccessibleName(tr("Save the drawing of the rig"));
  save->setToolTip(tr("Save the drawing of the rig as PNG, SVG or PDF"));
  connect(save, &QToolButton::clicked, drawing_, &RigDrawing::save);
  layout->addWidget(sensor_, 1);
  layout->addStretch();
  layout->addWidget(copy_);
  layout->addWidget(save);
  return bar;
}

QWidget* PosePanel::makeNumbers() {
  auto* const page = new QWidget(this);
  QFormLayout& form = poseRows(*page);
  form.addRow(tr("Translation t (mm)"), translation_);
  form.addRow(tr("Quaternion (x, y, z, w)"), quaternion_);
  form.addRow(tr("Time"), time_);
  auto* const open =
      foldButton("more_rotations", tr("More"), tr("Rotation vector, angles and 4x4 matrix"), page);
  QWidget* const more = makeMore();
  connect(open, &QToolButton::toggled, more, &QWidget::setVisible);
  form.addRow(open);
  form.addRow(more);
  return page;
}

// The same rotation in other ways, folded at first.
QWidget* PosePanel::makeMore() {
  auto* const more = new QWidget(this);
  QFormLayout& form = poseRows(*more);
  form.addRow(tr("Rotation vector (deg)"), vector_);
  form.addRow(tr("Roll, pitch, yaw (deg)"), angles_);
  form.addRow(warning_);
  form.addRow(tr("4x4 matrix (m)"), matrix_);
  more->hide();
  return more;
}

void PosePanel::fillCopyMenu() {
  copy_menu_->setIcon(icon("copy"));
  copy_menu_->setToolTipsVisible(true);
  QMenu* const all = new QMenu(tr("A&ll sensors"), copy_menu_);
  all->setToolTipsVisible(true);
  for (const PoseForm& form : poseForms()) {
    for (QMenu* const menu : {copy_menu_, all}) {
      QAction* const action = menu->addAction(
          tr(form.title), this, [this, name = form.name, all, menu] { copy(name, menu == all); });
      action->setToolTip(tr(form.use));
      action->setObjectName(form.name);
    }
  }
  copy_menu_->addSeparator();
  copy_menu_->addMenu(all);
  connect(copy_menu_, &QMenu::aboutToShow, this,
          [this, all] { all->menuAction()->setVisible(poses_.size() > 1); });
  copy_menu_->menuAction()->setEnabled(false);
}

void PosePanel::copy(const char* form, bool all) {
  const auto forms = poseForms();
  const auto found = std::find_if(forms.begin(), forms.end(), [form](const PoseForm& each) {
    return std::string_view(each.name) == form;
  });
  if (found == forms.end() || poses_.empty()) return;
  const auto shown = static_cast<std::size_t>(std::max(0, sensor_->currentIndex()));
  const std::span<const SensorPose> poses =
      all ? std::span<const SensorPose>(poses_) : std::span<const SensorPose>(poses_).subspan(shown, 1);
  QGuiApplication::clipboard()->setText(QString::fromStdString(poseText(*found, poses)));
  said_->setText(tr("Copied as %1.").arg(tr(found->title)));
  said_->show();
}

void PosePanel::setResult(const NamedResult& named) {
  const QString before = sensor_->currentText();
  poses_ = sensorPoses(named);
  sensor_->clear();
  for (const SensorPose& pose : poses_)
    sensor_->addItem(
        tr("%1 in %2").arg(QString::fromStdString(pose.sensor), QString::fromStdString(pose.reference)));
  sensor_->setCurrentIndex(std::max(0, sensor_->findText(before)));
  copy_menu_->menuAction()->setEnabled(!poses_.empty());
  copy_->setEnabled(!poses_.empty());
  drawing_->setResult(named);
  said_->hide();
  showPose();
}

void PosePanel::showPose() {
  if (poses_.empty()) {
    direction_->setText(tr("The only sensor is the reference: there is no pose to show."));
    for (QLabel* const label : {translation_, vector_, angles_, warning_, quaternion_, matrix_, time_})
      label->clear();
    warning_->hide();
    return;
  }
  const SensorPose& pose = poses_[static_cast<std::size_t>(std::max(0, sensor_->currentIndex()))];
  const RigidTransform& place = pose.reference_from_sensor;
  QString direction = QString::fromStdString(directionWords(pose));
  direction[0] = direction[0].toUpper();
  direction_->setText(direction);
  translation_->setText(row(Eigen::Vector3d(kPoseMmPerM * place.translation_m), 4, 11));
  vector_->setText(row(Eigen::Vector3d(kDegPerRad * quaternionLog(place.rotation)), 4, 11));
  const Eigen::Vector3d angles_deg = rollPitchYaw_deg(place.rotation);
  angles_->setText(row(angles_deg, 4, 11));
  QString warning = QString::fromStdString(anglesWarning(angles_deg));
  if (!warning.isEmpty()) warning[0] = warning[0].toUpper();
  warning_->setText(warning);
  warning_->setVisible(!warning.isEmpty());
  quaternion_->setText(row(Eigen::Vector4d(place.rotation.coeffs()), 6, 10));
  matrix_->setText(matrixText(place));
  time_->setText(tr("t_%1 = t_%2 %3 %4 ms")
                     .arg(QString::fromStdString(pose.reference), QString::fromStdString(pose.sensor),
                          QString(pose.time_offset_s < 0.0 ? "-" : "+"))
                     .arg(std::abs(kMillisecondsPerSecond * pose.time_offset_s), 0, 'f', 4));
}

void PosePanel::contextMenuEvent(QContextMenuEvent* event) {
  copy_menu_->popup(event->globalPos());
}

}  // namespace evical::ui
