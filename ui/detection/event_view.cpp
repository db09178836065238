// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/event_view.h"

#include "ui/detection/surface_frame.h"

#include "ui/theme/theme.h"

#include <QConicalGradient>
#include <QCoreApplication>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace evical::ui {
namespace {

constexpr int kInside_px = 6, kPadding_px = 8;

QString words(const char* text) {
  return QCoreApplication::translate("ColourLegend", text);
}

QRect paintBox(QPainter& painter, const QRect& room, QSize size) {
  const QRect box(room.bottomRight() - QPoint(size.width() + kInside_px, size.height() + kInside_px), size);
  QColor background = theme().window;
  background.setAlphaF(0.85f);
  painter.setPen(Qt::NoPen);
  painter.setBrush(background);
  painter.drawRoundedRect(box, 4, 4);
  return box.adjusted(kPadding_px, 0, -kPadding_px, 0);
}

void paintPolarity(QPainter& painter, const QRect& room) {
  constexpr int kSquare_px = 10, kGap_px = 6;
  const QFontMetrics metrics = painter.fontMetrics();
  const std::array entries = {std::pair(words("brighter"), theme().brighter),
                              std::pair(words("darker"), theme().darker)};
  int width = 2 * kPadding_px;
  for (const auto& [text, colour] : entries)
    width += kSquare_px + kGap_px + metrics.horizontalAdvance(text) + kPadding_px;
  const QRect box = paintBox(painter, room, {width - kPadding_px, metrics.height() + 8});
  int x = box.left();
  for (const auto& [text, colour] : entries) {
    painter.setPen(Qt::NoPen);
    painter.setBrush(colour);
    painter.drawRoundedRect(QRect(x, box.center().y() - kSquare_px / 2, kSquare_px, kSquare_px), 2, 2);
    x += kSquare_px + kGap_px;
    painter.setPen(theme().text);
    const int text_px = metrics.horizontalAdvance(text);
    painter.drawText(QRect(x, box.top(), text_px + 2, box.height()), Qt::AlignVCenter | Qt::AlignLeft, text);
    x += text_px + kPadding_px;
  }
}

void paintDirections(QPainter& painter, const QRect& room) {
  constexpr int kWheel_px = 40;
  const QString text = words("edges move");
  const int text_px = painter.fontMetrics().horizontalAdvance(text);
  const QRect box =
      paintBox(painter, room, {2 * kPadding_px + text_px + kPadding_px + kWheel_px, kWheel_px + 10});
  const QRectF wheel(box.right() - kWheel_px + 1, box.center().y() - kWheel_px / 2 + 1, kWheel_px, kWheel_px);
  QConicalGradient colours(wheel.center(), 0.0);
  constexpr int kStops = 24;
  for (int k = 0; k <= kStops; ++k) {
    const double turn = static_cast<double>(k) / kStops, angle_rad = 2.0 * std::numbers::pi * turn;
    colours.setColorAt(turn, QColor(flowColour(std::cos(angle_rad), -std::sin(angle_rad))));  // y points down
  }
  painter.setPen(Qt::NoPen);
  painter.setBrush(colours);
  painter.drawEllipse(wheel);
  painter.setBrush(theme().window);
  painter.drawEllipse(wheel.adjusted(11, 11, -11, -11));
  painter.setPen(QPen(theme().text, 1.5));
  for (int k = 0; k < 4; ++k) {  // outwards, in the direction of motion
    painter.save();
    painter.translate(wheel.center());
    painter.rotate(90.0 * k);
    painter.drawLine(QPointF(0.0, 0.0), QPointF(7.0, 0.0));
    painter.drawLine(QPointF(7.0, 0.0), QPointF(4.5, -2.0));
    painter.drawLine(QPointF(7.0, 0.0), QPointF(4.5, 2.0));
    painter.restore();
  }
  painter.drawText(QRect(box.left(), box.top(), text_px + 2, box.height()), Qt::AlignVCenter, text);
}

}  // namespace

void paintLegend(QPainter& painter, const QRect& room, ColourLegend legend) {
  constexpr int kMinWidth_px = 280, kMinHeight_px = 160;
  if (legend == ColourLegend::None || room.width() < kMinWidth_px || room.height() < kMinHeight_px) return;
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  if (legend == ColourLegend::Polarity)
    paintPolarity(painter, room);
  else
    paintDirections(painter, room);
  painter.restore();
}

}  // namespace evical::ui

namespace evical::ui {
namespace {

constexpr double kLargestScale = 64.0;
constexpr double kZoomStep = 1.25;
constexpr double kGridScale = 14.0;  // pixels are outlined from this scale on
constexpr int kMargin_px = 6;
constexpr int kWrapped = Qt::AlignLeft | Qt::AlignVCenter | Qt::TextWordWrap;

}  // namespace

EventView::EventView(QWidget* parent) : QWidget(parent) {
  setMouseTracking(true);
  setFocusPolicy(Qt::StrongFocus);
  setCursor(Qt::CrossCursor);
  setAccessibleName(tr("Events"));
}

void EventView::setFrame(std::shared_ptr<const SurfaceFrame> frame) {
  const bool other_sensor = frame && (!frame_ || frame_->resolution_px() != frame->resolution_px());
  frame_ = std::move(frame);
  if (other_sensor) fit();
  update();
}

void EventView::setOverlay(Overlay overlay) {
  overlay_ = std::move(overlay);
  update();
}

void EventView::setCaption(const QString& caption) {
  if (caption == caption_) return;
  caption_ = caption;
  update();
}

void EventView::setLegend(ColourLegend legend) {
  if (legend == legend_) return;
  legend_ = legend;
  update();
}

void EventView::setMessage(const QString& message) {
  if (message == message_) return;
  message_ = message;
  update();
}

double EventView::fitScale() const {
  const Resolution size_px = frame_->resolution_px();
  return std::max(1e-3, std::min((width() - 2.0 * kMargin_px) / size_px.width_px,
                                 (height() - 2.0 * kMargin_px) / size_px.height_px));
}

void EventView::fit() {
  fitted_ = true;
  if (!frame_) return;
  const Resolution size_px = frame_->resolution_px();
  scale_ = fitScale();
  origin_ = {0.5 * (width() - scale_ * size_px.width_px), 0.5 * (height() - scale_ * size_px.height_px)};
  update();
}

void EventView::zoomBy(double factor, const QPointF& about) {
  if (!frame_) return;
  const double wanted = std::clamp(scale_ * factor, fitScale(), std::max(kLargestScale, fitScale()));
  if (wanted <= fitScale()) {
    fit();
    return;
  }
  origin_ = about - (about - origin_) * (wanted / scale_);
  scale_ = wanted;
  fitted_ = false;
  keepInSight();
  update();
}

// Panning never reduces the visible part of the picture below the largest possible one.
void EventView::keepInSight() {
  const Resolution size_px = frame_->resolution_px();
  const auto kept = [](double origin, double picture, double widget) {
    if (picture <= widget) return 0.5 * (widget - picture);
    return std::clamp(origin, widget - picture - kMargin_px, static_cast<double>(kMargin_px));
  };
  origin_ = {kept(origin_.x(), scale_ * size_px.width_px, width()),
             kept(origin_.y(), scale_ * size_px.height_px, height())};
}

QPointF EventView::sensorFromWidget(const QPointF& point) const {
  return (point - origin_) / scale_ - QPointF(0.5, 0.5);
}

QPointF EventView::widgetFromSensor(const QPointF& pixel) const {
  return origin_ + scale_ * (pixel + QPointF(0.5, 0.5));
}

QString EventView::readout() const {
  if (!frame_ || !mouse_) return {};
  const QPointF pixel = sensorFromWidget(*mouse_);
  const int x = static_cast<int>(std::lround(pixel.x())), y = static_cast<int>(std::lround(pixel.y()));
  const Resolution size_px = frame_->resolution_px();
  if (x < 0 || y < 0 || x >= size_px.width_px || y >= size_px.height_px) return {};
  const QString place = QStringLiteral("x %1  y %2").arg(x).arg(y);
  if (frame_->photograph) return place + tr("    brightness %1").arg(qGray(frame_->image.pixel(x, y)));
  const auto hit = frame_->newestAt(x, y);
  if (!hit) return place + tr("    no event");
  return place +
         QStringLiteral("    %1 s  (%2 ms)    ")
             .arg(frame_->time_s + hit->time_s, 0, 'f', 6)
             .arg(1e3 * hit->time_s, 0, 'f', 2) +
         (hit->brighter ? tr("brighter") : tr("darker"));
}

void EventView::paintPicture(QPainter& painter) {
  const QRectF visible(sensorFromWidget({0.0, 0.0}), sensorFromWidget(QPointF(width(), height())));
  const Resolution size_px = frame_->resolution_px();
  const QRect source = visible.adjusted(-1, -1, 2, 2)
                           .toAlignedRect()
                           .intersected(QRect(0, 0, size_px.width_px, size_px.height_px));
  const QRectF target(origin_ + scale_ * QPointF(source.topLeft()), scale_ * QSizeF(source.size()));
  painter.setRenderHint(QPainter::SmoothPixmapTransform, scale_ < 1.0);
  painter.drawImage(target, frame_->image, source);
  if (scale_ >= kGridScale) {
    painter.setPen(QPen(theme().grid_line, 0));
    for (int x = source.left(); x <= source.right() + 1; ++x) {
      const double at = origin_.x() + scale_ * x;
      painter.drawLine(QPointF(at, target.top()), QPointF(at, target.bottom()));
    }
    for (int y = source.top(); y <= source.bottom() + 1; ++y) {
      const double at = origin_.y() + scale_ * y;
      painter.drawLine(QPointF(target.left(), at), QPointF(target.right(), at));
    }
  }
  painter.setPen(QPen(theme().grid_line, 1));
  painter.setBrush(Qt::NoBrush);
  painter.drawRect(QRectF(origin_, scale_ * QSizeF(size_px.width_px, size_px.height_px)));
}

QRect EventView::pictureInSight() const {
  const Resolution size_px = frame_->resolution_px();
  const QRectF picture(origin_, scale_ * QSizeF(size_px.width_px, size_px.height_px));
  return picture.intersected(rect()).toAlignedRect();
}

// In a corner of the visible part of the picture.
QRect EventView::noteBox(const QSize& size, bool below) const {
  constexpr int kInside_px = 6;
  const QRect seen = pictureInSight().adjusted(kInside_px, kInside_px, -kInside_px, -kInside_px);
  const int left = std::max(0, std::min(seen.left(), width() - size.width() - kInside_px));
  return {QPoint(left, below ? seen.bottom() - size.height() : seen.top()), size};
}

void EventView::paintNote(QPainter& painter, const QString& text, bool below) const {
  if (text.isEmpty()) return;
  constexpr QSize kPadding_px(16, 8);
  constexpr int kOutside_px = 12;
  const QSize room = size() - kPadding_px - QSize(kOutside_px, 0);
  const QRect lines = painter.fontMetrics().boundingRect({QPoint(), room}, kWrapped, text);
  const QRect box = noteBox(lines.size() + kPadding_px, below);
  QColor background = theme().window;
  background.setAlphaF(0.85f);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  painter.setBrush(background);
  painter.drawRoundedRect(box, 4, 4);
  painter.setPen(theme().text);
  painter.drawText(box.marginsRemoved({8, 4, 8, 4}), kWrapped, text);
}

void EventView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), theme().window);
  if (!frame_) {
    painter.setPen(theme().faint_text);
    painter.drawText(rect().adjusted(24, 24, -24, -24), Qt::AlignCenter | Qt::TextWordWrap, message_);
    return;
  }
  paintPicture(painter);
  if (overlay_) {
    painter.save();
    painter.setRenderHint(QPainter::Antialiasing);
    painter.translate(origin_);
    painter.scale(scale_, scale_);
    painter.translate(0.5, 0.5);
    overlay_(painter, scale_);
    painter.restore();
  }
  paintLegend(painter, pictureInSight(), legend_);
  paintNote(painter, caption_, false);
  paintNote(painter, readout(), true);
}

void EventView::resizeEvent(QResizeEvent*) {
  if (!frame_) return;
  if (fitted_) {
    fit();
  } else {
    keepInSight();
  }
}

void EventView::wheelEvent(QWheelEvent* event) {
  if (event->angleDelta().y() == 0) return;
  zoomBy(std::pow(kZoomStep, event->angleDelta().y() / 120.0), event->position());
  event->accept();
}

void EventView::mousePressEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton || event->button() == Qt::MiddleButton)
    drag_from_ = event->position();
}

void EventView::mouseMoveEvent(QMouseEvent* event) {
  mouse_ = event->position();
  if (drag_from_ && frame_ && !fitted_) {
    setCursor(Qt::ClosedHandCursor);
    origin_ += event->position() - *drag_from_;
    drag_from_ = event->position();
    keepInSight();
  }
  update();
}

void EventView::mouseReleaseEvent(QMouseEvent*) {
  drag_from_.reset();
  setCursor(Qt::CrossCursor);
}

void EventView::mouseDoubleClickEvent(QMouseEvent* event) {
  if (fitted_) {
    zoomBy(4.0, event->position());
  } else {
    fit();
  }
}

void EventView::keyPressEvent(QKeyEvent* event) {
  const QPointF middle = mouse_.value_or(QPointF(0.5 * width(), 0.5 * height()));
  switch (event->key()) {
    case Qt::Key_F:
      fit();
      return;
    case Qt::Key_Plus:
    case Qt::Key_Equal:
      zoomBy(kZoomStep, middle);
      return;
    case Qt::Key_Minus:
      zoomBy(1.0 / kZoomStep, middle);
      return;
    default:
      QWidget::keyPressEvent(event);
  }
}

void EventView::leaveEvent(QEvent*) {
  mouse_.reset();
  update();
}

}  // namespace evical::ui
