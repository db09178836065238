// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/rig_page.h"

#include "ui/theme/theme.h"

#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

namespace evical::ui {

RigPage::RigPage(QWidget* page, const QString& what, QWidget* parent) : QStackedWidget(parent) {
  auto* const note = new QWidget(this);
  auto* const layout = new QVBoxLayout(note);
  auto* const text = new QLabel(tr("%1 to the calibration of a rig: a camera and an IMU, or several cameras. "
                                   "The result of a camera alone is on the page Result.")
                                    .arg(what),
                                note);
  text->setProperty("role", "heading");
  text->setWordWrap(true);
  text->setAlignment(Qt::AlignCenter);
  auto* const rig = new QPushButton(icon("axes"), tr("Calibrate the rig instead"), note);
  rig->setToolTip(tr("Choose the calibration of the rig; it is not started yet"));
  connect(rig, &QPushButton::clicked, this, &RigPage::rigRequested);
  layout->addStretch();
  layout->addWidget(text);
  layout->addWidget(rig, 0, Qt::AlignHCenter);
  layout->addStretch();
  addWidget(page);
  addWidget(note);
}

void RigPage::setAim(CalibrationAim aim) {
  setCurrentIndex(aim == CalibrationAim::Rig ? 0 : 1);
}

}  // namespace evical::ui
