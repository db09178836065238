// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/aim_chooser.h"

#include "ui/theme/theme.h"

#include <QButtonGroup>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>

namespace evical::ui {

AimChooser::AimChooser(QWidget* parent)
    : QWidget(parent),
      camera_(new QPushButton(icon("camera"), tr("the camera"), this)),
      rig_(new QPushButton(icon("axes"), tr("the rig"), this)),
      cameras_(new QComboBox(this)) {
  camera_->setObjectName("aim_camera");
  camera_->setToolTip(tr(
      "The lens only: focal length, principal point, distortion. A recording of one camera is sufficient."));
  rig_->setObjectName("aim_rig");
  rig_->setToolTip(
      tr("Rotation, translation and time offset between camera and IMU, or between cameras; unknown lenses "
         "are calibrated first"));
  cameras_->setObjectName("aim_which");
  cameras_->setAccessibleName(tr("Camera to calibrate"));
  cameras_->setToolTip(tr("Camera that is calibrated"));
  auto* const group = new QButtonGroup(this);
  auto* const layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(6);
  layout->addWidget(new QLabel(tr("Calibrate"), this));
  for (QPushButton* const button : {camera_, rig_}) {
    button->setCheckable(true);
    button->setAccessibleName(tr("Calibrate %1").arg(button->text()));
    group->addButton(button);
    layout->addWidget(button);
  }
  layout->addWidget(cameras_);
  cameras_->hide();
  setAim(aim_);
  connect(camera_, &QPushButton::clicked, this, [this] { emit aimChosen(CalibrationAim::Camera); });
  connect(rig_, &QPushButton::clicked, this, [this] { emit aimChosen(CalibrationAim::Rig); });
  connect(cameras_, &QComboBox::textActivated, this, &AimChooser::cameraChosen);
}

void AimChooser::setAim(CalibrationAim aim) {
  aim_ = aim;
  (aim == CalibrationAim::Camera ? camera_ : rig_)->setChecked(true);
  cameras_->setVisible(aim == CalibrationAim::Camera && cameras_->count() > 1);
}

void AimChooser::setCameras(const QStringList& names, int chosen) {
  cameras_->clear();
  cameras_->addItems(names);
  cameras_->setCurrentIndex(chosen);
  setAim(aim_);
}

}  // namespace evical::ui
