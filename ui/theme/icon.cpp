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

// Outside of namespaces: the macro declares a global function.
static void initResources() {
  Q_INIT_RESOURCE(resources);
}

namespace evical::ui {
namespace {

// A fixed colour, or a role of the current palette.
struct Tint {
  QColor colour;
  QPalette::ColorRole role = QPalette::ButtonText;

  QColor now(QIcon::Mode mode) const {
    const QPalette palette = QApplication::palette();
    if (mode == QIcon::Disabled) return palette.color(QPalette::Disabled, QPalette::ButtonText);
    return colour.isValid() ? colour : palette.color(role);
  }
};

// Draws an SVG in the current palette's colour, so that icons follow the theme.
class TintedIconEngine final : public QIconEngine {
 public:
  TintedIconEngine(const QByteArray& svg, const Tint& tint)
      : svg_(svg), tint_(tint), renderer_(std::make_unique<QSvgRenderer>(svg)) {}

  void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State) override {
    const double ratio = painter->device()->devicePixelRatioF();
    painter->drawPixmap(rect, drawn((QSizeF(rect.size()) * ratio).toSize(), mode));
  }
  QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State) override { return drawn(size, mode); }
  // Until Qt 6.8 `size` is in device pixels.
  QPixmap scaledPixmap(const QSize& size, QIcon::Mode mode, QIcon::State, qreal scale) override {
    constexpr bool kInDevicePixels = QT_VERSION < QT_VERSION_CHECK(6, 8, 0);
    return drawn(kInDevicePixels ? size : (QSizeF(size) * scale).toSize(), mode);
  }
  QIconEngine* clone() const override { return new TintedIconEngine(svg_, tint_); }

 private:
  // `size` is in device pixels.
  QPixmap drawn(const QSize& size, QIcon::Mode mode) {
    QPixmap pixmap(size);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    renderer_->setAspectRatioMode(Qt::KeepAspectRatio);
    renderer_->render(&painter, QRectF(QPointF(), QSizeF(size)));
    painter.setCompositionMode(QPainter::CompositionMode_SourceIn);
    painter.fillRect(pixmap.rect(), tint_.now(mode));
    return pixmap;
  }

  QByteArray svg_;
  Tint tint_;
  std::unique_ptr<QSvgRenderer> renderer_;
};

QIcon loaded(const QString& name, const Tint& tint) {
  initResources();
  QFile file(":/icons/" + name + ".svg");
  if (!file.open(QIODevice::ReadOnly)) return {};
  return QIcon(new TintedIconEngine(file.readAll(), tint));
}

}  // namespace

QIcon icon(const QString& name) {
  return loaded(name, {});
}

QIcon icon(const QString& name, const QColor& colour) {
  return loaded(name, {colour, QPalette::ButtonText});
}

QIcon icon(const QString& name, QPalette::ColorRole role) {
  return loaded(name, {{}, role});
}

}  // namespace evical::ui
