// SPDX-License-Identifier: GPL-3.0-or-later
// Light that differs by shape as well as by colour: a disc, a triangle, a square.
#pragma once

#include "core/pipeline/rig/recording_assessment.h"

#include <QString>
#include <QWidget>

namespace evical::ui {

QString lightWord(Light light);  // "good", "fair", "poor"

class LightMark : public QWidget {
  Q_OBJECT

 public:
  explicit LightMark(QWidget* parent = nullptr);

  void setLight(Light light);
  Light light() const { return light_; }
  QSize sizeHint() const override { return {14, 14}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  Light light_ = Light::Fair;
};

}  // namespace evical::ui
