// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/theme/theme.h"

#include <QApplication>
#include <QFile>
#include <QIconEngine>
#include <QPainter>
#include <QPalette>
#include <QPixmap>
#include <QSvgRenderer>

#include <memory>

// Not in a namespace: the macro declares a function of the global one.
static void initResources() {
  Q_INIT_RESOURCE(resources);
}

namespace evical::ui {
namespace {

QColor tintOf(QIcon::Mode mode) {
  const QPalette palette = QApplication::palette();
  if (mode == QIcon::Disabled) return palette.color(QPalette::Disabled, QPalette::ButtonText);
  return palette.color(QPalette::ButtonText);
}

// Draws the SVG's shape in the palette's colour of the moment, so that icons follow the theme by themselves.
class TintedIconEngine final : public QIconEngine {
 public:
  explicit TintedIconEngine(const QByteArray& svg, const QColor& colour = {})
      : svg_(svg), colour_(colour), renderer_(std::make_unique<QSvgRenderer>(svg)) {}

  void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State state) override {
    const double ratio = painter->device()->devicePixelRatioF();
    painter->drawPixmap(rect, scaledPixmap((QSizeF(rect.size()) * ratio).toSize(), mode, state, ratio));
  }
  QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
    return scaledPixmap(size, mode, state, 1.0);
  }
  // `size` is in device pixels.
  QPixmap scaledPixmap(const QSize& size, QIcon::Mode mode, QIcon::State, qreal) override {
    QPixmap pixmap(size);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    renderer_->setAspectRatioMode(Qt::KeepAspectRatio);
    renderer_->render(&painter, QRectF(QPointF(), QSizeF(size)));
    painter.setCompositionMode(QPainter::CompositionMode_SourceIn);
    painter.fillRect(pixmap.rect(), colour_.isValid() && mode != QIcon::Disabled ? colour_ : tintOf(mode));
    return pixmap;
  }
  QIconEngine* clone() const override { return new TintedIconEngine(svg_, colour_); }

 private:
  QByteArray svg_;
  QColor colour_;
  std::unique_ptr<QSvgRenderer> renderer_;
};

QIcon loaded(const QString& name, const QColor& colour) {
  initResources();
  QFile file(":/icons/" + name + ".svg");
  if (!file.open(QIODevice::ReadOnly)) return {};
  return QIcon(new TintedIconEngine(file.readAll(), colour));
}

}  // namespace

QIcon icon(const QString& name) {
  return loaded(name, {});
}

QIcon icon(const QString& name, const QColor& colour) {
  return loaded(name, colour);
}

}  // namespace evical::ui
