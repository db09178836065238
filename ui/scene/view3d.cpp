// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/view3d.h"

#include "core/numerics/angles.h"

#include "ui/scene/offscreen_render_window.h"
#include "ui/theme/theme.h"

#include <QApplication>
#include <QContextMenuEvent>
#include <QMouseEvent>
#include <QPainter>

#include <vtkCamera.h>
#include <vtkNew.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <cmath>
#include <future>

namespace evical::ui {
namespace {

constexpr double kOrbit_rad_per_px = 0.008;
constexpr double kKeyOrbit_rad = 0.1, kKeyPan = 0.05, kKeyZoom = 1.15;
constexpr double kWheelZoom = 1.15;  // per notch
constexpr double kNotch = 120.0;     // in Qt's units
constexpr int kSample_px = 64;

}  // namespace

struct View3D::Private {
  vtkNew<vtkRenderer> renderer;
  vtkNew<OffscreenRenderWindow> window;
  bool started = false, dirty = true;
  std::string problem;
  QImage frame;
  double pixel_ratio = 0.0;

  TurntableCamera turntable;
  std::optional<ViewPose> fixed_pose;
  Eigen::Vector3d world_centre_m = Eigen::Vector3d::Zero();
  double world_radius_m = 1.0;
  bool fitted = false;

  std::function<void(QPainter&)> overlay;
  QPointF pressed_at, last_at;
  bool dragging = false;

  std::future<std::string> starting;  // its problem; last member: its thread uses the window

  // Deferred to the first painting: the driver takes a fifth of a second to load.
  void start() {
    started = true;
    if (const auto context = EglContext::create(problem)) {
      window->setContext(context);
      window->AddRenderer(renderer);
    }
  }
};

View3D::View3D(QWidget* parent) : QWidget(parent), d_(std::make_unique<Private>()) {
  setFocusPolicy(Qt::StrongFocus);
  setAccessibleName(tr("View of the trajectory and the board"));
  setMouseTracking(true);
  setMinimumSize(160, 120);
  setAttribute(Qt::WA_OpaquePaintEvent);
  setBackground(theme().panel);
}

View3D::~View3D() = default;

void View3D::startInBackground(const std::function<void(vtkRenderer*)>& fill) {
  if (d_->started) return;
  d_->started = true;
  const vtkNew<vtkRenderer> sample;
  fill(sample);
  sample->ResetCamera();
  // Nothing else uses the window until the thread has ended.
  const auto load = [this, window = d_->window.Get(), sample = vtkSmartPointer<vtkRenderer>(sample)] {
    std::string problem;
    if (const auto context = EglContext::create(problem)) {
      const EglContext::Scope scope(*context);
      window->setContext(context);
      window->AddRenderer(sample);
      window->drawImage(QSize(kSample_px, kSample_px));
      window->RemoveRenderer(sample);
    }
    QMetaObject::invokeMethod(this, &View3D::finishStart, Qt::QueuedConnection);
    return problem;
  };
  d_->starting = std::async(std::launch::async, load);
}

bool View3D::starting() const {
  return d_->starting.valid();
}

void View3D::finishStart() {
  d_->problem = d_->starting.get();
  if (d_->problem.empty()) d_->window->AddRenderer(d_->renderer);
  redraw();
}

vtkRenderer* View3D::renderer() const {
  return d_->renderer;
}

void View3D::redraw() {
  d_->dirty = true;
  update();
}

void View3D::setBackground(const QColor& colour) {
  d_->renderer->SetBackground(colour.redF(), colour.greenF(), colour.blueF());
  redraw();
}

void View3D::setOverlay(std::function<void(QPainter&)> paint) {
  d_->overlay = std::move(paint);
  update();
}

void View3D::setWorld(const Eigen::Vector3d& up, const Eigen::Vector3d& front,
                      const Eigen::Vector3d& centre_m, double radius_m) {
  d_->turntable.setAxes(up, front);
  d_->world_centre_m = centre_m;
  d_->world_radius_m = radius_m;
}

void View3D::setFocus(const Eigen::Vector3d& focus_m) {
  d_->turntable.setFocus(focus_m);
  redraw();
}

void View3D::lookThrough(const std::optional<ViewPose>& pose) {
  d_->fixed_pose = pose;
  redraw();
}

ViewPose View3D::viewPose() const {
  return d_->fixed_pose ? *d_->fixed_pose : d_->turntable.pose();
}

std::optional<QPointF> View3D::project(const Eigen::Vector3d& point_m) const {
  return viewPose().project(point_m, size());
}

QString View3D::problem() const {
  return QString::fromStdString(d_->problem);
}

void View3D::look(StandardView view) {
  d_->fixed_pose.reset();
  d_->turntable.look(view);
  d_->fitted = false;
  redraw();
}

// Deferred to the first frame, when the widget has its size.
void View3D::fitWorld() {
  if (d_->fitted) return;
  d_->turntable.fit(d_->world_centre_m, d_->world_radius_m, static_cast<double>(width()) / height());
  d_->fitted = true;
}

QImage View3D::drawFrame(double ratio) {
  const QSize size_px = (QSizeF(size()) * ratio).toSize();
  if (ratio != d_->pixel_ratio) {
    d_->pixel_ratio = ratio;
    emit pixelRatioChanged(ratio);
  }
  fitWorld();
  const ViewPose pose = viewPose();
  vtkCamera* const camera = d_->renderer->GetActiveCamera();
  camera->SetPosition(pose.eye_m.data());
  camera->SetFocalPoint(pose.focus_m.data());
  camera->SetViewUp(pose.up.data());
  camera->SetViewAngle(kDegPerRad * pose.vertical_view_rad);
  d_->renderer->ResetCameraClippingRange();
  QImage frame = d_->window->drawImage(size_px);
  frame.setDevicePixelRatio(ratio);
  return frame;
}

void View3D::refreshFrame() {
  const double ratio = devicePixelRatioF();
  if (!d_->dirty && d_->frame.size() == (QSizeF(size()) * ratio).toSize()) return;
  d_->frame = drawFrame(ratio);
  d_->dirty = false;
  if (d_->frame.isNull()) d_->problem = "the graphics driver lost its OpenGL context";
}

QImage View3D::picture(double scale) {
  if (starting() || !d_->started || !d_->problem.empty()) return {};
  QImage image = drawFrame(scale);
  d_->dirty = true;  // lines now have the picture's widths
  update();
  if (image.isNull()) return image;
  QPainter painter(&image);
  painter.setFont(font());
  painter.setRenderHint(QPainter::Antialiasing);
  if (d_->overlay) d_->overlay(painter);
  return image;
}

void View3D::drawText(QPainter& painter, const QString& text) const {
  painter.fillRect(rect(), theme().panel);
  painter.setPen(theme().faint_text);
  painter.drawText(rect().adjusted(24, 24, -24, -24), Qt::AlignCenter | Qt::TextWordWrap, text);
}

void View3D::paintEvent(QPaintEvent*) {
  if (!d_->started) d_->start();
  QPainter painter;
  if (starting()) {
    painter.begin(this);
    drawText(painter, tr("The 3D view is starting ..."));
    return;
  }
  if (d_->problem.empty()) refreshFrame();
  painter.begin(this);
  if (!d_->problem.empty()) {
    drawText(painter, tr("The 3D view needs OpenGL 3.2, but %1.\nEverything else works without it.\n"
                         "Install Mesa's EGL driver for a software renderer.")
                          .arg(problem()));
    return;
  }
  painter.drawImage(QPointF(0.0, 0.0), d_->frame);
  painter.setRenderHint(QPainter::Antialiasing);
  if (d_->overlay) d_->overlay(painter);
}

void View3D::mousePressEvent(QMouseEvent* event) {
  d_->pressed_at = d_->last_at = event->position();
  d_->dragging = false;
}

void View3D::mouseMoveEvent(QMouseEvent* event) {
  if (event->buttons() == Qt::NoButton) {
    emit hovered(event->position());
    return;
  }
  const QPointF from_press = event->position() - d_->pressed_at;
  d_->dragging = d_->dragging || from_press.manhattanLength() >= QApplication::startDragDistance();
  if (!d_->dragging) return;
  const QPointF step = event->position() - d_->last_at;
  d_->last_at = event->position();
  const bool orbits = event->buttons().testFlag(Qt::LeftButton) && event->modifiers() == Qt::NoModifier;
  if (orbits) {
    d_->turntable.orbit(kOrbit_rad_per_px * step.x(), kOrbit_rad_per_px * step.y());
  } else {
    d_->turntable.pan(-step.x() / height(), step.y() / height());
  }
  userTurned();
}

void View3D::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton && !d_->dragging) emit clicked(event->position());
  if (event->button() == Qt::RightButton && !d_->dragging)
    emit menuRequested(event->globalPosition().toPoint());
  d_->dragging = false;
}

void View3D::wheelEvent(QWheelEvent* event) {
  d_->turntable.zoom(std::pow(kWheelZoom, event->angleDelta().y() / kNotch));
  userTurned();
  event->accept();
}

void View3D::keyPressEvent(QKeyEvent* event) {
  if (!turnByKey(event->key(), event->modifiers())) QWidget::keyPressEvent(event);
}

// With the mouse, the menu event comes at the press, before it is known whether a drag follows.
void View3D::contextMenuEvent(QContextMenuEvent* event) {
  if (event->reason() == QContextMenuEvent::Keyboard) emit menuRequested(mapToGlobal(rect().center()));
}

bool View3D::turnByKey(int key, Qt::KeyboardModifiers modifiers) {
  switch (key) {
    case Qt::Key_1:
      look(StandardView::Front);
      break;
    case Qt::Key_2:
      look(StandardView::Side);
      break;
    case Qt::Key_3:
      look(StandardView::Top);
      break;
    case Qt::Key_0:
      look(StandardView::Home);
      break;
    case Qt::Key_Plus:
    case Qt::Key_Equal:
      d_->turntable.zoom(kKeyZoom);
      break;
    case Qt::Key_Minus:
      d_->turntable.zoom(1.0 / kKeyZoom);
      break;
    case Qt::Key_Left:
    case Qt::Key_Right:
    case Qt::Key_Up:
    case Qt::Key_Down: {
      const double right = key == Qt::Key_Right ? 1.0 : key == Qt::Key_Left ? -1.0 : 0.0;
      const double up = key == Qt::Key_Up ? 1.0 : key == Qt::Key_Down ? -1.0 : 0.0;
      if (modifiers.testFlag(Qt::ShiftModifier)) {
        d_->turntable.pan(kKeyPan * right, kKeyPan * up);
      } else {
        d_->turntable.orbit(-kKeyOrbit_rad * right, kKeyOrbit_rad * up);
      }
      break;
    }
    default:
      return false;
  }
  userTurned();
  return true;
}

void View3D::userTurned() {
  d_->fixed_pose.reset();
  redraw();
  emit turned();
}

}  // namespace evical::ui
