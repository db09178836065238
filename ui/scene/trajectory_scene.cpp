// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/trajectory_scene.h"

#include "ui/scene/scene_shapes.h"
#include "ui/scene/trajectory_track.h"
#include "ui/theme/theme.h"

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <Eigen/Geometry>
#include <QPainter>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace evical::ui {

namespace {

// Lightness is monotonic, away from the background's.
constexpr std::array<std::array<double, 3>, 5> kOnDark = {
    {{0.33, 0.36, 0.85}, {0.16, 0.60, 0.80}, {0.20, 0.76, 0.55}, {0.72, 0.85, 0.25}, {1.00, 0.93, 0.35}}};
constexpr std::array<std::array<double, 3>, 5> kOnLight = {
    {{0.98, 0.66, 0.18}, {0.93, 0.40, 0.29}, {0.78, 0.18, 0.46}, {0.47, 0.08, 0.60}, {0.13, 0.06, 0.45}}};

constexpr double kOutliers = 0.02;
constexpr double kMaxTicks = 6.0;

}  // namespace

QColor ColourScale::colourOf(double value) const {
  if (!std::isfinite(value)) return dark ? QColor(0x55, 0x5b, 0x64) : QColor(0xb4, 0xb9, 0xc0);
  const auto& stops = dark ? kOnDark : kOnLight;
  const double place = std::clamp(value / high, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  const double share = place - static_cast<double>(below);
  const auto mixed = [&](std::size_t channel) {
    return static_cast<float>((1.0 - share) * stops[below][channel] + share * stops[below + 1][channel]);
  };
  return QColor::fromRgbF(mixed(0), mixed(1), mixed(2));
}

double scaleEnd(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return 1.0;
  const auto index = static_cast<std::ptrdiff_t>((1.0 - kOutliers) * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  const double value = values[static_cast<std::size_t>(index)], step = roundedUp(value / kMaxTicks);
  return step * std::max(1.0, std::ceil(value / step - 1e-9));
}

void paintColourBar(QPainter& painter, const QRectF& area, const ColourScale& scale) {
  const QFontMetricsF metrics(painter.font());
  const double line = metrics.height();
  const QRectF bar(area.left(), area.top() + 1.6 * line, 12.0, area.height() - 2.1 * line);
  painter.setPen(theme().text);
  painter.drawText(QRectF(area.left(), area.top(), area.width(), line), Qt::AlignLeft | Qt::AlignVCenter,
                   scale.title);
  QLinearGradient gradient(bar.bottomLeft(), bar.topLeft());
  constexpr int kStops = 16;
  for (int k = 0; k <= kStops; ++k) {
    const double share = static_cast<double>(k) / kStops;
    gradient.setColorAt(share, scale.colourOf(share * scale.high));
  }
  painter.setPen(Qt::NoPen);
  painter.setBrush(gradient);
  painter.drawRoundedRect(bar, 3.0, 3.0);
  painter.setPen(theme().faint_text);
  const double step = roundedUp(scale.high / kMaxTicks);
  for (int k = 0; k * step <= scale.high * (1.0 + 1e-9); ++k) {
    const double share = k * step / scale.high;
    const QPointF at(bar.right(), bar.bottom() - share * bar.height());
    painter.drawLine(at, at + QPointF(4.0, 0.0));
    painter.drawText(QRectF(at.x() + 8.0, at.y() - 0.5 * line, area.width() - 20.0, line),
                     Qt::AlignLeft | Qt::AlignVCenter, QString::number(k * step, 'g', 3));
  }
}

namespace {

using Eigen::Vector3d;

// Relative to the board's diagonal.
constexpr double kStationDepth = 0.07, kCurrentDepth = 0.13, kImuAxes = 0.16, kWorldAxes = 0.2, kArrow = 0.28;
constexpr double kImagePlaneOpacity = 0.25;
constexpr double kSnug = 0.85;  // a trajectory fills little of the sphere around it
constexpr double kGridCells = 14.0;

class Part {
 public:
  Part(vtkRenderer* renderer, double width_px) : width_px_(width_px) {
    mapper_->SetInputData(data_);
    actor_->SetMapper(mapper_);
    actor_->GetProperty()->LightingOff();
    actor_->PickableOff();
    renderer->AddActor(actor_);
    setPixelRatio(1.0);
  }
  void show(const ShapeBuilder& shapes) { shapes.writeTo(data_); }
  void setVisible(bool visible) { actor_->SetVisibility(visible); }
  // Drawn like an opaque part, on top of earlier ones: VTK's own pass for translucent parts takes longer than
  // the rest of the frame.
  void setOpacity(double opacity) {
    actor_->GetProperty()->SetOpacity(opacity);
    actor_->ForceOpaqueOn();
  }
  void setPixelRatio(double ratio) {
    actor_->GetProperty()->SetLineWidth(static_cast<float>(ratio * width_px_));
    actor_->GetProperty()->SetPointSize(static_cast<float>(ratio * 2.0 * width_px_));
  }

 private:
  double width_px_;
  vtkNew<vtkPolyData> data_;
  vtkNew<vtkPolyDataMapper> mapper_;
  vtkNew<vtkActor> actor_;
};

BoardColours boardColours() {
  if (theme().dark) return {QColor(0xd8, 0xdb, 0xe0), QColor(0x2a, 0x2d, 0x33), QColor(0x6b, 0x72, 0x7d), {}};
  return {QColor(0xff, 0xff, 0xff), QColor(0x2a, 0x2d, 0x33), QColor(0xc3, 0xc8, 0xd0), {}};
}

// A colour that is not among the trajectory's.
QColor rawPoseColour() {
  return theme().dark ? theme().bad : theme().good;
}

class Box {
 public:
  void add(const Vector3d& point) {
    min_ = empty_ ? point : min_.cwiseMin(point).eval();
    max_ = empty_ ? point : max_.cwiseMax(point).eval();
    empty_ = false;
  }
  Vector3d centre() const { return empty_ ? Vector3d::Zero().eval() : (0.5 * (min_ + max_)).eval(); }
  double radius() const { return empty_ ? 0.5 : 0.5 * (max_ - min_).norm(); }

 private:
  bool empty_ = true;
  Vector3d min_ = Vector3d::Zero(), max_ = Vector3d::Zero();
};

// Relative to that of events.
double lengthOf(CameraKind kind) {
  constexpr double kShorter = 0.75;
  return kind == CameraKind::Events ? 1.0 : kind == CameraKind::Frames ? kShorter : kShorter * kShorter;
}

QColor faint(const QColor& colour) {
  const QColor behind = theme().panel;
  return {(colour.red() + behind.red()) / 2, (colour.green() + behind.green()) / 2,
          (colour.blue() + behind.blue()) / 2};
}

}  // namespace

struct TrajectoryScene::Private {
  explicit Private(vtkRenderer* r)
      : ground(r, 1.0),
        board(r, 1.0),
        board_edge(r, 1.2),
        track(r, 2.5),
        stations(r, 1.0),
        current(r, 2.0),
        imu_axes(r, 3.0),
        raw_poses(r, 1.3),
        gravity(r, 3.0),
        axes(r, 3.0),
        image_plane(r, 1.0),
        events(r, 1.0) {
    image_plane.setOpacity(kImagePlaneOpacity);
    visible.fill(true);
  }

  std::optional<Board> board_data;
  std::vector<PlacedBoard> further_boards;
  std::vector<CameraShape> cameras;
  std::vector<CameraKind> kinds;
  std::vector<QString> camera_names, imu_names;
  std::shared_ptr<const TrajectoryTrack> track_data = std::make_shared<TrajectoryTrack>();
  std::optional<Vector3d> gravity_m_s2;
  std::vector<RigidTransform> raw, current_cameras, current_imus;
  FrustumEvents events_data;
  TrajectoryColour colour = TrajectoryColour::Speed;
  std::array<bool, kSceneLayerCount> visible;

  // In the order of drawing.
  Part ground, board, board_edge, track, stations, current, imu_axes, raw_poses, gravity, axes, image_plane,
      events;

  double currentDepth_m(std::size_t camera) const {
    return lengthOf(kind(camera)) * kCurrentDepth * unit_m();
  }
  void addSensorNames(std::vector<SceneLabel>& labels) const;
  std::array<Part*, 12> parts() {
    return {&ground,      &board,    &board_edge, &track,   &stations, &current,
            &image_plane, &imu_axes, &raw_poses,  &gravity, &axes,     &events};
  }
  std::vector<Part*> partsOf(SceneLayer layer) {
    switch (layer) {
      case SceneLayer::Board:
        return {&board, &board_edge};
      case SceneLayer::Trajectory:
        return {&track};
      case SceneLayer::Cameras:
        return {&stations};
      case SceneLayer::CurrentCamera:
        return {&current, &image_plane};
      case SceneLayer::ImuAxes:
        return {&imu_axes};
      case SceneLayer::RawPoses:
        return {&raw_poses};
      case SceneLayer::Gravity:
        return {&gravity};
      case SceneLayer::Ground:
        return {&ground};
      case SceneLayer::Axes:
        return {&axes};
      case SceneLayer::Events:
        return {&events};
    }
    return {};
  }

  const CameraShape& camera(std::size_t index) {
    while (cameras.size() <= index) cameras.push_back(cameraShape(std::nullopt));
    return cameras[index];
  }
  CameraKind kind(std::size_t camera) const {
    return camera < kinds.size() ? kinds[camera] : CameraKind::Events;
  }
  bool hasSeveralKinds() const {
    return std::any_of(kinds.begin(), kinds.end(), [&](CameraKind k) { return k != kinds.front(); });
  }
  double unit_m() const {
    if (!board_data) return 0.6;
    const auto [first, last] = paperCorners_m(*board_data);
    return (last - first).norm();
  }
  const std::vector<double>& colouredValues() const {
    return colour == TrajectoryColour::Speed ? track_data->speeds_m_s : track_data->residuals_px;
  }
  std::vector<Vector3d> allPoints() const {
    std::vector<Vector3d> points = track_data->positions_m;
    if (board_data) {
      for (const Eigen::Vector2d& c : paperCorners_m(*board_data)) points.emplace_back(c.x(), c.y(), 0.0);
    }
    for (const PlacedBoard& placed : further_boards)
      for (const Eigen::Vector2d& c : paperCorners_m(placed.board))
        points.push_back(placed.world_from_board * Vector3d(c.x(), c.y(), 0.0));
    for (const RigidTransform& pose : raw) points.push_back(pose.translation_m);
    return points;
  }
  Box box() const {
    Box box;
    for (const Vector3d& point : allPoints()) box.add(point);
    return box;
  }
  Vector3d up() const { return -gravity_m_s2.value_or(Vector3d::UnitY()).normalized(); }

  Vector3d arrowStart() const {
    if (!board_data) return {-0.3 * unit_m(), 0.0, 0.0};
    const auto [first, last] = paperCorners_m(*board_data);
    return {first.x() - 0.25 * unit_m(), 0.5 * (first.y() + last.y()), 0.0};
  }
  Vector3d arrowEnd() const { return arrowStart() - kArrow * unit_m() * up(); }
};

// Names above the images of cameras, and behind the axes of IMUs.
void TrajectoryScene::Private::addSensorNames(std::vector<SceneLabel>& labels) const {
  const auto shows = [&](SceneLayer layer) { return visible[static_cast<std::size_t>(layer)]; };
  if (shows(SceneLayer::CurrentCamera)) {
    for (std::size_t k = 0; k < std::min({camera_names.size(), current_cameras.size(), cameras.size()});
         ++k) {
      const auto& corners = cameras[k].corners;
      const Vector3d top = 0.5 * (corners[0] + corners[1]), above(top.x(), 1.3 * top.y(), top.z());
      labels.push_back(
          {current_cameras[k] * (currentDepth_m(k) * above), camera_names[k], cameraColour(kind(k))});
    }
  }
  if (!shows(SceneLayer::ImuAxes)) return;
  const Vector3d behind = -0.3 * kImuAxes * unit_m() * Vector3d::Ones();
  for (std::size_t k = 0; k < std::min(imu_names.size(), current_imus.size()); ++k)
    labels.push_back({current_imus[k] * behind, imu_names[k], theme().text});
}

QColor cameraColour(CameraKind kind) {
  switch (kind) {
    case CameraKind::Events:
      break;
    case CameraKind::Frames:
      return theme().good;
    case CameraKind::Points:
      return theme().dark ? QColor(0xc7, 0x92, 0xea) : QColor(0x8e, 0x3f, 0xb5);
  }
  return theme().accent;
}

TrajectoryScene::TrajectoryScene(vtkRenderer* renderer) : d_(std::make_unique<Private>(renderer)) {
  buildSurroundings();
}

TrajectoryScene::~TrajectoryScene() = default;

void TrajectoryScene::setBoard(const std::optional<Board>& board) {
  d_->board_data = board;
  applyTheme();
}

void TrajectoryScene::setFurtherBoards(std::vector<PlacedBoard> boards) {
  if (boards.empty() && d_->further_boards.empty()) return;
  d_->further_boards = std::move(boards);
  buildBoard();
}

void TrajectoryScene::setIntrinsics(const std::vector<std::optional<CameraIntrinsics>>& cameras) {
  d_->cameras.clear();
  for (const auto& intrinsics : cameras) d_->cameras.push_back(cameraShape(intrinsics));
  buildStations();
  buildInstant();
}

void TrajectoryScene::setCameraKinds(const std::vector<CameraKind>& kinds) {
  d_->kinds = kinds;
  buildStations();
  buildInstant();
}

void TrajectoryScene::setSensorNames(std::vector<QString> cameras, std::vector<QString> imus) {
  d_->camera_names = std::move(cameras);
  d_->imu_names = std::move(imus);
}

void TrajectoryScene::setTrack(std::shared_ptr<const TrajectoryTrack> track) {
  d_->track_data = track ? std::move(track) : std::make_shared<TrajectoryTrack>();
  buildTrack();
  buildStations();
  buildSurroundings();
}

void TrajectoryScene::setGravity(const std::optional<Vector3d>& gravity_in_world_m_s2) {
  d_->gravity_m_s2 = gravity_in_world_m_s2;
  buildSurroundings();
}

void TrajectoryScene::setRawPoses(const std::vector<RigidTransform>& world_from_bodies) {
  d_->raw = world_from_bodies;
  buildRawPoses();
  buildSurroundings();
}

void TrajectoryScene::setInstant(const std::vector<RigidTransform>& world_from_cameras,
                                 const std::vector<RigidTransform>& world_from_imus) {
  d_->current_cameras = world_from_cameras;
  d_->current_imus = world_from_imus;
  buildInstant();
}

void TrajectoryScene::setEvents(FrustumEvents events) {
  d_->events_data = std::move(events);
  buildEvents();
}

void TrajectoryScene::setTrajectoryColour(TrajectoryColour colour) {
  d_->colour = colour;
  buildTrack();
}

void TrajectoryScene::setVisible(SceneLayer layer, bool visible) {
  d_->visible[static_cast<std::size_t>(layer)] = visible;
  for (Part* part : d_->partsOf(layer)) part->setVisible(visible);
}

bool TrajectoryScene::isVisible(SceneLayer layer) const {
  return d_->visible[static_cast<std::size_t>(layer)];
}

void TrajectoryScene::setPixelRatio(double ratio) {
  for (Part* part : d_->parts()) part->setPixelRatio(ratio);
}

void TrajectoryScene::applyTheme() {
  buildBoard();
  buildTrack();
  buildStations();
  buildRawPoses();
  buildInstant();
  buildSurroundings();
}

std::optional<ColourScale> TrajectoryScene::colourScale() const {
  if (d_->track_data->empty()) return std::nullopt;
  const bool speed = d_->colour == TrajectoryColour::Speed;
  return ColourScale{speed ? QStringLiteral("speed [m/s]") : QStringLiteral("residual [px]"),
                     scaleEnd(d_->colouredValues()), theme().dark};
}

std::vector<LegendEntry> TrajectoryScene::legend() const {
  std::vector<LegendEntry> entries;
  if (!d_->hasSeveralKinds() || empty()) return entries;
  constexpr std::array kWords = {std::pair(CameraKind::Events, "event camera"),
                                 std::pair(CameraKind::Frames, "frame camera"),
                                 std::pair(CameraKind::Points, "camera of given points")};
  for (const auto& [kind, words] : kWords) {
    if (std::find(d_->kinds.begin(), d_->kinds.end(), kind) != d_->kinds.end())
      entries.push_back({QString::fromUtf8(words), cameraColour(kind)});
  }
  return entries;
}

std::vector<SceneLabel> TrajectoryScene::labels() const {
  std::vector<SceneLabel> labels;
  if (empty()) return labels;
  const double reach_m = 1.15 * kWorldAxes * d_->unit_m();
  const std::array<const char*, 3> names = {"x", "y", "z"};
  if (isVisible(SceneLayer::Axes)) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      labels.push_back({reach_m * Vector3d::Unit(axis), names[k], theme().axes[k]});
    }
  }
  if (isVisible(SceneLayer::ImuAxes) && !d_->current_imus.empty()) {
    const RigidTransform& imu = d_->current_imus.front();
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      const Vector3d tip = imu * (1.15 * kImuAxes * d_->unit_m() * Vector3d::Unit(axis));
      labels.push_back({tip, names[k], theme().axes[k]});
    }
  }
  d_->addSensorNames(labels);
  if (isVisible(SceneLayer::Gravity) && d_->gravity_m_s2) {
    const Vector3d below = d_->arrowEnd() - 0.03 * d_->unit_m() * d_->up();
    labels.push_back({below, QStringLiteral("gravity"), theme().text});
  }
  return labels;
}

bool TrajectoryScene::empty() const {
  return !d_->board_data && d_->track_data->empty() && d_->raw.empty();
}

SceneExtent TrajectoryScene::extent() const {
  const Box box = d_->box();
  return {d_->up(), Vector3d::UnitZ(), box.centre(),
          d_->track_data->empty() ? box.radius() : kSnug * box.radius()};
}

double TrajectoryScene::gridSpacing_m() const {
  return roundedUp(2.0 * d_->box().radius() / kGridCells);
}

void TrajectoryScene::buildBoard() {
  ShapeBuilder sheet, edge;
  if (d_->board_data) {
    std::vector<PlacedBoard> boards = d_->further_boards;
    boards.push_back({*d_->board_data});
    edge.setColour(theme().faint_text);
    for (const PlacedBoard& board : boards) {
      addBoard(sheet, board, boardColours());
      addBoardEdge(edge, board);
    }
  }
  d_->board.show(sheet);
  d_->board_edge.show(edge);
}

void TrajectoryScene::buildTrack() {
  ShapeBuilder shapes;
  if (const auto scale = colourScale()) {
    std::vector<QColor> colours;
    for (const double value : d_->colouredValues()) colours.push_back(scale->colourOf(value));
    shapes.polyline(d_->track_data->positions_m, colours);
  }
  d_->track.show(shapes);
}

void TrajectoryScene::buildStations() {
  ShapeBuilder shapes;
  for (const CameraStation& station : d_->track_data->stations) {
    for (std::size_t k = 0; k < station.world_from_cameras.size(); ++k) {
      const CameraKind kind = d_->kind(k);
      shapes.setColour(d_->hasSeveralKinds() ? faint(cameraColour(kind)) : theme().faint_text);
      addFrustum(shapes, d_->camera(k), station.world_from_cameras[k],
                 lengthOf(kind) * kStationDepth * d_->unit_m());
    }
  }
  d_->stations.show(shapes);
}

void TrajectoryScene::buildRawPoses() {
  ShapeBuilder shapes;
  shapes.setColour(rawPoseColour());
  for (const RigidTransform& pose : d_->raw) shapes.point(pose.translation_m);
  d_->raw_poses.show(shapes);
}

void TrajectoryScene::buildInstant() {
  ShapeBuilder frusta, planes, axes;
  for (std::size_t k = 0; k < d_->current_cameras.size(); ++k) {
    const CameraKind kind = d_->kind(k);
    const double depth_m = d_->currentDepth_m(k);
    frusta.setColour(cameraColour(kind));
    planes.setColour(cameraColour(kind));
    addFrustum(frusta, d_->camera(k), d_->current_cameras[k], depth_m);
    addImagePlane(planes, d_->camera(k), d_->current_cameras[k], depth_m);
  }
  for (const RigidTransform& imu : d_->current_imus) {
    addAxes(axes, imu, kImuAxes * d_->unit_m(), theme().axes);
  }
  d_->current.show(frusta);
  d_->image_plane.show(planes);
  d_->imu_axes.show(axes);
  buildEvents();
}

void TrajectoryScene::buildEvents() {
  ShapeBuilder shapes;
  const std::size_t camera = d_->events_data.camera;
  if (camera < d_->current_cameras.size()) {
    const double depth_m = d_->currentDepth_m(camera);
    for (const FrustumEvent& event : d_->events_data.events) {
      shapes.setColour(event.brighter ? theme().brighter : theme().darker);
      shapes.point(d_->current_cameras[camera] * (depth_m * event.at));
    }
  }
  d_->events.show(shapes);
}

void TrajectoryScene::buildSurroundings() {
  ShapeBuilder ground, gravity, axes;
  if (empty()) {
    for (Part* part : {&d_->ground, &d_->gravity, &d_->axes}) part->show(ground);
    return;
  }
  const Box box = d_->box();
  const Vector3d up = d_->up();
  double lowest_m = 0.0;
  for (const Vector3d& point : d_->allPoints()) lowest_m = std::min(lowest_m, up.dot(point));
  const Vector3d centre = box.centre() + (lowest_m - 0.02 * d_->unit_m() - up.dot(box.centre())) * up;
  ground.setColour(theme().grid_line);
  addGrid(ground, centre, up, Vector3d::UnitX(), gridSpacing_m(),
          static_cast<int>(std::ceil(box.radius() / gridSpacing_m())));
  if (d_->gravity_m_s2) {
    gravity.setColour(theme().text);
    addArrow(gravity, d_->arrowStart(), d_->arrowEnd());
  }
  const Vector3d in_front(0.0, 0.0, -0.005 * d_->unit_m());  // of the board's circles
  addAxes(axes, {Eigen::Quaterniond::Identity(), in_front}, kWorldAxes * d_->unit_m(), theme().axes);
  d_->ground.show(ground);
  d_->gravity.show(gravity);
  d_->axes.show(axes);
}

}  // namespace evical::ui
