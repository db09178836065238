// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/light_mark.h"

#include "ui/theme/theme.h"

#include <QPainter>
#include <QPolygonF>

namespace evical::ui {

QString lightWord(Light light) {
  return light == Light::Good   ? QObject::tr("good")
         : light == Light::Fair ? QObject::tr("fair")
                                : QObject::tr("poor");
}

LightMark::LightMark(QWidget* parent) : QWidget(parent) {
  setFixedSize(sizeHint());
  setLight(light_);
}

void LightMark::setLight(Light light) {
  light_ = light;
  setAccessibleName(lightWord(light));
  setToolTip(lightWord(light));
  update();
}

void LightMark::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  const QRectF box = QRectF(rect()).adjusted(1.0, 1.0, -1.0, -1.0);
  switch (light_) {
    case Light::Good:
      painter.setBrush(theme().good);
      painter.drawEllipse(box);
      return;
    case Light::Fair:
      painter.setBrush(theme().warning);
      painter.drawPolygon(QPolygonF{{box.center().x(), box.top()}, box.bottomRight(), box.bottomLeft()});
      return;
    case Light::Poor:
      painter.setBrush(theme().bad);
      painter.drawRect(box.adjusted(1.0, 1.0, -1.0, -1.0));
      return;
  }
}

}  // namespace evical::ui
