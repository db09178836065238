// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/trajectory_screen.h"

#include "core/base/in_parallel.h"
#include "ui/forms/page_keys.h"
#include "ui/jobs/file_saver.h"
#include "ui/jobs/latest_job.h"
#include "ui/scene/scene_shapes.h"
#include "ui/scene/time_bar.h"
#include "ui/scene/trajectory_overlay.h"
#include "ui/scene/trajectory_tools.h"
#include "ui/scene/view3d.h"
#include "ui/scene/view_poses.h"
#include "ui/theme/theme.h"

#include <QEvent>
#include <QMenu>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>
#include <limits>

namespace evical::ui {
namespace {

using Eigen::Vector3d;

constexpr double kPick_px = 12.0;
constexpr double kSameDistance_px = 2.0;  // then the one nearer to the eye is chosen
constexpr double kNearestRawPose_s = 0.1;
constexpr double kEventsAround_s = 0.005;
constexpr double kCameraViewMargin = 1.2;  // around its image, so that the frustum frames it

struct Track {
  std::shared_ptr<const CalibrationState> state;
  std::shared_ptr<const TrajectoryTrack> samples;
};

struct TimedPoint {
  double time_s;
  Vector3d at_m;
};

// Trajectory point under the mouse; often there are several.
std::optional<double> timeUnder(const QPointF& position, const std::vector<TimedPoint>& points,
                                const ViewPose& pose, const QSizeF& screen) {
  std::vector<double> distances_px;
  for (const TimedPoint& point : points) {
    const auto at = pose.project(point.at_m, screen);
    distances_px.push_back(at ? std::hypot(at->x() - position.x(), at->y() - position.y())
                              : std::numeric_limits<double>::infinity());
  }
  const auto nearest = std::min_element(distances_px.begin(), distances_px.end());
  if (nearest == distances_px.end() || *nearest > kPick_px) return std::nullopt;
  std::optional<double> time_s;
  double min_depth_m = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double depth_m = pose.depth_m(points[k].at_m);
    if (distances_px[k] > *nearest + kSameDistance_px || depth_m >= min_depth_m) continue;
    min_depth_m = depth_m;
    time_s = points[k].time_s;
  }
  return time_s;
}

template <class Sensor>
std::vector<QString> namesOf(const std::vector<Sensor>& sensors) {
  std::vector<QString> names;
  for (const Sensor& sensor : sensors) names.push_back(QString::fromStdString(sensor.name));
  return names;
}

ViewPose throughCamera(const RigidTransform& world_from_camera, const CameraShape& shape) {
  const double half_view = std::atan(kCameraViewMargin * std::tan(0.5 * shape.vertical_view_rad));
  return {world_from_camera.translation_m, world_from_camera * Vector3d::UnitZ(),
          world_from_camera.rotation * -Vector3d::UnitY(), 2.0 * half_view};
}

}  // namespace

struct TrajectoryScreen::Private {
  Private(TrajectoryScreen* screen, View3D* view_3d)
      : q(screen),
        view(view_3d),
        tools(new TrajectoryTools(screen)),
        time_bar(new TimeBar(screen)),
        readout(new PoseReadout(screen)),
        saver(new FileSaver(screen)),
        scene(view_3d->renderer()) {}

  TrajectoryScreen* q;
  View3D* view;
  TrajectoryTools* tools;
  TimeBar* time_bar;
  PoseReadout* readout;
  FileSaver* saver;
  TrajectoryScene scene;

  std::optional<Board> board;          // its frame is the world frame
  std::vector<Board> further_boards;   // their poses are in the state
  std::vector<SeenBoard> seen_boards;  // by camera
  std::vector<CameraShape> cameras;
  std::vector<std::optional<CameraIntrinsics>> lenses;  // by camera
  std::function<EventLookup()> event_source;
  std::shared_ptr<const CalibrationState> state;  // drawn state
  std::shared_ptr<const TrajectoryTrack> track = std::make_shared<TrajectoryTrack>();
  std::vector<ViewPoseInput> pose_inputs;  // by camera
  std::vector<ViewPoses> view_poses;
  std::optional<RigInstant> instant;
  std::vector<RigidTransform> current_cameras;
  double time_s = 0.0;
  bool placed = false;  // the view has been fitted to the content

  LatestJob track_job{OutdatedWork::Delivered};
  LatestJob poses_job{OutdatedWork::Delivered};
  LatestJob events_job{OutdatedWork::Delivered};

  void buildLayout();
  void addKeys();
  void offerTimes();
  void lookUpEvents();
  void select(double new_time_s);
  void connectTools();
  void setBoards(const Session& session);
  void placeFurtherBoards();
  std::optional<RigidTransform> worldFromBoardOf(std::size_t camera) const;
  void sample(std::shared_ptr<const CalibrationState> new_state, std::shared_ptr<const CalibrationRun> run);
  void estimatePoses();
  void showTrack(Track new_track);
  void showViewPoses(std::vector<ViewPoses> poses);
  void showRawPoses();
  void showInstant();
  void showNumbers();
  void moveView();
  void placeWorld();
  std::vector<RigidTransform> rawCamerasNow() const;
  std::vector<TimedPoint> pickable() const;
  std::optional<double> timeUnderMouse(const QPointF& position) const;
  void paint(QPainter& painter) const;
  QString message() const;
  void savePicture(double scale);
  void saveTable();
};

TrajectoryScreen::TrajectoryScreen(QWidget* parent)
    : QWidget(parent), d_(std::make_unique<Private>(this, new View3D(this))) {
  d_->buildLayout();
  d_->connectTools();
}

TrajectoryScreen::~TrajectoryScreen() {
  d_->view->setOverlay({});
}

void TrajectoryScreen::Private::buildLayout() {
  auto* const column = new QVBoxLayout(q);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addWidget(tools);
  column->addWidget(view, 1);
  column->addWidget(time_bar);
  column->addWidget(readout);
  q->setFocusProxy(view);
  addKeys();
  view->setOverlay([this](QPainter& painter) { paint(painter); });
}

void TrajectoryScreen::Private::addKeys() {
  addPageKey(q, Qt::Key_Space, [this] { time_bar->togglePlaying(); });
  addPageKey(q, Qt::Key_Left, [this] { time_bar->step(-1); });
  addPageKey(q, Qt::Key_Right, [this] { time_bar->step(+1); });
  addPageKey(q, Qt::Key_Home, [this] { time_bar->toStart(); });
  addPageKey(q, Qt::Key_End, [this] { time_bar->toEnd(); });
  leaveFocusToKeys(q);
}

void TrajectoryScreen::Private::connectTools() {
  connect(time_bar, &TimeBar::timeSelected, q, [this](double picked_s) { select(picked_s); });
  // The other pages are hidden and need not follow every frame.
  connect(time_bar, &TimeBar::playingChanged, q, [this](bool playing) {
    if (!playing) emit q->timeSelected(time_s);
  });
  connect(tools, &TrajectoryTools::colourChosen, q, &TrajectoryScreen::setTrajectoryColour);
  connect(tools, &TrajectoryTools::layerToggled, q, &TrajectoryScreen::setLayerVisible);
  connect(tools, &TrajectoryTools::viewChosen, view, &View3D::look);
  connect(tools, &TrajectoryTools::followingChanged, q, [this] {
    if (!tools->throughCamera()) view->lookThrough(std::nullopt);
    moveView();
  });
  connect(tools, &TrajectoryTools::pictureWanted, q, [this](double scale) { savePicture(scale); });
  connect(tools, &TrajectoryTools::tableWanted, q, [this] { saveTable(); });
  connect(view, &View3D::menuRequested, tools->saveMenu(),
          [this](const QPoint& position) { tools->saveMenu()->popup(position); });
  connect(view, &View3D::turned, q, [this] { tools->leaveCamera(); });
  connect(view, &View3D::pixelRatioChanged, q, [this](double ratio) { scene.setPixelRatio(ratio); });
  connect(view, &View3D::hovered, q, [this](const QPointF& position) {
    view->setCursor(timeUnderMouse(position) ? Qt::PointingHandCursor : Qt::ArrowCursor);
  });
  connect(view, &View3D::clicked, q, [this](const QPointF& position) {
    const auto picked_s = timeUnderMouse(position);
    if (picked_s) select(*picked_s);
  });
}

void TrajectoryScreen::startInBackground() {
  d_->view->startInBackground(addSampleScene);
}

void TrajectoryScreen::clear() {
  d_->track_job.discard();
  d_->poses_job.discard();
  d_->events_job.discard();
  d_->scene.setEvents({});
  d_->board.reset();
  d_->further_boards.clear();
  d_->seen_boards.clear();
  d_->scene.setBoard(std::nullopt);
  setIntrinsics({});
  d_->scene.setCameraKinds({});
  d_->pose_inputs.clear();
  d_->placed = false;
  d_->showTrack({nullptr, std::make_shared<TrajectoryTrack>()});
  d_->showViewPoses({});
}

void TrajectoryScreen::setBoards(const Session& session) {
  d_->setBoards(session);
}

void TrajectoryScreen::Private::setBoards(const Session& session) {
  further_boards.clear();
  for (const AdditionalBoard& further : session.further_boards) further_boards.push_back(further.board);
  seen_boards.clear();
  for (std::size_t k = 0; k < session.cameras.size(); ++k) seen_boards.push_back(session.seenBoard(k));
  scene.setSensorNames(namesOf(session.cameras), namesOf(session.imus));
  placeFurtherBoards();
  if (board == session.board) return;
  board = session.board;
  placed = false;
  scene.setBoard(board);
  placeWorld();
}

void TrajectoryScreen::Private::placeFurtherBoards() {
  std::vector<PlacedBoard> boards;
  for (std::size_t i = 0; state && i < std::min(further_boards.size(), state->further_boards.size()); ++i)
    boards.push_back({further_boards[i], state->further_boards[i].world_from_board});
  scene.setFurtherBoards(std::move(boards));
}

// Pose of the board that a camera sees; none if it is not yet known.
std::optional<RigidTransform> TrajectoryScreen::Private::worldFromBoardOf(std::size_t camera) const {
  const std::size_t index = camera < seen_boards.size() ? seen_boards[camera].index : 0;
  if (index == 0) return RigidTransform{};
  if (!state || index > state->further_boards.size()) return std::nullopt;
  return state->boardAt(index).world_from_board;
}

void TrajectoryScreen::setIntrinsics(const std::vector<std::optional<CameraIntrinsics>>& cameras) {
  d_->cameras.clear();
  for (const auto& intrinsics : cameras) d_->cameras.push_back(cameraShape(intrinsics));
  d_->lenses = cameras;
  d_->scene.setIntrinsics(cameras);
  d_->lookUpEvents();
  d_->view->redraw();
}

void TrajectoryScreen::setRun(std::shared_ptr<const CalibrationRun> run, const Session& session) {
  if (!run) {
    clear();
    setBoards(session);
    return;
  }
  d_->setBoards(session);
  const std::vector<CameraLens>& lenses = run->detections.lenses;
  std::vector<std::optional<CameraIntrinsics>> intrinsics;
  for (const CameraState& camera : run->result.state.cameras) intrinsics.push_back(camera.lens.inUse());
  setIntrinsics(intrinsics);
  std::vector<CameraKind> kinds;
  for (const BoardObservations& camera : run->detections.cameras) kinds.push_back(camera.kind);
  d_->scene.setCameraKinds(kinds);
  d_->placed = false;
  d_->pose_inputs.clear();
  d_->sample(std::shared_ptr<const CalibrationState>(run, &run->result.state), run);
  for (std::size_t k = 0; k < lenses.size(); ++k) {
    if (!lenses[k].detection_intrinsics) continue;
    setDetections(sharedViews({run, &run->detections.cameras[k]}), *lenses[k].detection_intrinsics, k);
  }
}

void TrajectoryScreen::setState(std::shared_ptr<const CalibrationState> state) {
  d_->sample(std::move(state), nullptr);
}

void TrajectoryScreen::Private::sample(std::shared_ptr<const CalibrationState> new_state,
                                       std::shared_ptr<const CalibrationRun> run) {
  if (!new_state) return;
  track_job.start([this, new_state, run](const std::stop_token&) {
    const std::vector<CircleResidual> none;
    const auto& residuals = run ? run->result.circle_residuals : none;
    const Track sampled{new_state,
                        std::make_shared<TrajectoryTrack>(sampleTrajectory(*new_state, residuals))};
    return [this, sampled] { showTrack(sampled); };
  });
}

void TrajectoryScreen::setDetections(SharedViews views, const CameraIntrinsics& intrinsics,
                                     std::size_t camera) {
  if (!d_->board) return;
  if (d_->pose_inputs.size() <= camera) d_->pose_inputs.resize(camera + 1);
  const Board& board = camera < d_->seen_boards.size() ? d_->seen_boards[camera].board : *d_->board;
  d_->pose_inputs[camera] = {std::move(views), intrinsics, board};
  d_->estimatePoses();
}

void TrajectoryScreen::Private::estimatePoses() {
  poses_job.start([this, inputs = pose_inputs, before = view_poses](const std::stop_token& stop) {
    std::vector<ViewPoses> poses(inputs.size());
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      if (inputs[k].views.empty()) continue;
      poses[k] = estimateViewPoses(inputs[k], k < before.size() ? before[k] : ViewPoses{}, stop);
    }
    return [this, poses] { showViewPoses(poses); };
  });
}

void TrajectoryScreen::Private::showTrack(Track new_track) {
  state = std::move(new_track.state);
  track = std::move(new_track.samples);
  const bool known = state && hasTrajectory(*state) && !state->imus.empty();  // cameras do not measure it
  scene.setGravity(known ? std::optional(state->gravity_in_world_m_s2) : std::nullopt);
  placeFurtherBoards();
  scene.setTrack(track);
  tools->offerResiduals(track->hasResiduals());
  tools->offerTable(!track->empty());
  offerTimes();
  if (!track->hasResiduals()) q->setTrajectoryColour(TrajectoryColour::Speed);
  showRawPoses();
  showInstant();
  placeWorld();
}

void TrajectoryScreen::Private::showViewPoses(std::vector<ViewPoses> poses) {
  view_poses = std::move(poses);
  offerTimes();
  showRawPoses();
  showInstant();
  placeWorld();
}

// From the trajectory's start to its end, with a stop at each view of the first camera; before there is a
// trajectory, the span of the views.
void TrajectoryScreen::Private::offerTimes() {
  std::vector<double> stops_s;
  if (!view_poses.empty())
    for (const CameraPose& pose : view_poses.front().poses) stops_s.push_back(pose.time_s);
  std::sort(stops_s.begin(), stops_s.end());
  if (!track->empty()) return time_bar->setTimes(track->times_s.front(), track->times_s.back(), stops_s);
  if (stops_s.empty()) return time_bar->setNoTimes();
  time_bar->setTimes(stops_s.front(), stops_s.back(), stops_s);
}

void TrajectoryScreen::Private::select(double new_time_s) {
  q->setTime(new_time_s);
  if (!time_bar->isPlaying()) emit q->timeSelected(new_time_s);
}

void TrajectoryScreen::Private::lookUpEvents() {
  if (!q->isVisible() || !event_source || !scene.isVisible(SceneLayer::Events)) return;
  const EventLookup lookup = event_source();
  if (!lookup.between || lookup.camera >= lenses.size() || !lenses[lookup.camera]) {
    events_job.discard();
    scene.setEvents({});
    return;
  }
  events_job.start([this, lookup, lens = lenses[lookup.camera], at_s = time_s](const std::stop_token&) {
    makeThreadModest();
    const FrustumEvents found{
        lookup.camera, onImagePlane(lookup.between(at_s - kEventsAround_s, at_s + kEventsAround_s), lens)};
    return [this, found] {
      scene.setEvents(found);
      view->redraw();
    };
  });
}

// Poses of the IMU, which should be on the trajectory; poses of the cameras until the extrinsics are known.
void TrajectoryScreen::Private::showRawPoses() {
  std::vector<RigidTransform> bodies;
  for (std::size_t k = 0; k < view_poses.size(); ++k) {
    const bool known = state && hasTrajectory(*state) && k < state->cameras.size();
    const RigidTransform camera_from_body =
        known ? inverse(state->cameras[k].reference_from_camera) : RigidTransform{};
    const std::optional<RigidTransform> world_from_board = worldFromBoardOf(k);
    if (!world_from_board) continue;
    for (const CameraPose& pose : view_poses[k].poses)
      bodies.push_back(*world_from_board * pose.world_from_camera * camera_from_body);
  }
  scene.setRawPoses(bodies);
}

std::vector<RigidTransform> TrajectoryScreen::Private::rawCamerasNow() const {
  std::vector<RigidTransform> cameras_now;
  for (std::size_t k = 0; k < view_poses.size(); ++k) {
    const ViewPoses& of_camera = view_poses[k];
    const std::optional<RigidTransform> world_from_board = worldFromBoardOf(k);
    if (!world_from_board) continue;
    const auto nearest = std::min_element(of_camera.poses.begin(), of_camera.poses.end(),
                                          [this](const CameraPose& a, const CameraPose& b) {
                                            return std::abs(a.time_s - time_s) < std::abs(b.time_s - time_s);
                                          });
    if (nearest != of_camera.poses.end() && std::abs(nearest->time_s - time_s) < kNearestRawPose_s) {
      cameras_now.push_back(*world_from_board * nearest->world_from_camera);
    }
  }
  return cameras_now;
}

void TrajectoryScreen::Private::showInstant() {
  instant = state ? rigAt(*state, time_s) : std::nullopt;
  current_cameras = instant ? instant->world_from_cameras : rawCamerasNow();
  scene.setInstant(current_cameras, instant ? instant->world_from_imus : std::vector<RigidTransform>{});
  showNumbers();
  moveView();
}

void TrajectoryScreen::Private::showNumbers() {
  PoseNumbers numbers;
  if (instant) {
    numbers.of_camera = state->imus.empty();  // the body is then the reference camera
    numbers.position_m = instant->imu.world_from_imu.translation_m;
    numbers.speed_m_s = instant->imu.velocity_m_s.norm();
    numbers.rotation_rate_rad_s = instant->imu.angular_velocity_rad_s.norm();
    if (!track->empty()) numbers.residual_px = track->residuals_px[track->nearest(time_s)];
  } else if (!current_cameras.empty()) {
    numbers.of_camera = true;
    numbers.position_m = current_cameras.front().translation_m;
  }
  readout->setNumbers(numbers);
}

void TrajectoryScreen::Private::moveView() {
  if (!current_cameras.empty()) {
    const CameraShape shape = cameras.empty() ? cameraShape(std::nullopt) : cameras.front();
    if (tools->throughCamera()) view->lookThrough(throughCamera(current_cameras.front(), shape));
    if (tools->following()) view->setFocus(current_cameras.front().translation_m);
  }
  view->redraw();
}

// The view is fitted to the content once; afterwards the user controls it.
void TrajectoryScreen::Private::placeWorld() {
  const SceneExtent extent = scene.extent();
  view->setWorld(extent.up, extent.front, extent.centre_m, extent.radius_m);
  if (!placed && !scene.empty()) view->look(StandardView::Home);
  placed = placed || !track->empty();
}

std::vector<TimedPoint> TrajectoryScreen::Private::pickable() const {
  std::vector<TimedPoint> points;
  for (std::size_t k = 0; k < track->times_s.size(); ++k) {
    points.push_back({track->times_s[k], track->positions_m[k]});
  }
  if (!points.empty() || view_poses.empty()) return points;
  for (const CameraPose& pose : view_poses.front().poses) {
    points.push_back({pose.time_s, pose.world_from_camera.translation_m});
  }
  return points;
}

std::optional<double> TrajectoryScreen::Private::timeUnderMouse(const QPointF& position) const {
  return timeUnder(position, pickable(), view->viewPose(), view->size());
}

void TrajectoryScreen::Private::savePicture(double scale) {
  const double ratio = scale * view->devicePixelRatioF();
  const auto prepare = [this, ratio]() -> SavedForm::Content {
    return [image = view->picture(ratio)] { return pngOf(image); };
  };
  saver->askAndSave(tr("Save the view"), "trajectory", {{tr("Picture"), "png", prepare}});
}

void TrajectoryScreen::Private::saveTable() {
  const auto prepare = [this]() -> SavedForm::Content {
    return [shown = track] { return QByteArray::fromStdString(trackCsv(*shown)); };
  };
  saver->askAndSave(tr("Save the trajectory"), "trajectory", {{tr("Table"), "csv", prepare}});
}

QString TrajectoryScreen::Private::message() const {
  if (!track->empty()) return {};
  if (!view_poses.empty()) return tr("Poses of single views. The trajectory is shown after the calibration.");
  return tr("No calibration yet: press Calibrate");
}

void TrajectoryScreen::Private::paint(QPainter& painter) const {
  TrajectoryOverlay overlay;
  overlay.pose = view->viewPose();
  overlay.screen = view->size();
  overlay.labels = scene.labels();
  overlay.legend = scene.legend();
  if (instant) overlay.cursor_m = instant->imu.world_from_imu.translation_m;
  if (scene.isVisible(SceneLayer::Trajectory)) overlay.scale = scene.colourScale();
  overlay.message = message();
  overlay.in_middle = scene.empty();
  if (!scene.empty()) {
    overlay.hint =
        tr("Grid %1 m. Drag: orbit, right drag: pan, wheel: zoom, click on the trajectory: go to that time")
            .arg(scene.gridSpacing_m());
  }
  paintOverlay(painter, overlay);
}

double TrajectoryScreen::time_s() const {
  return d_->time_s;
}

bool TrajectoryScreen::busy() const {
  return d_->track_job.busy() || d_->poses_job.busy() || d_->events_job.busy();
}

View3D* TrajectoryScreen::view() const {
  return d_->view;
}

void TrajectoryScreen::setTrajectoryColour(TrajectoryColour colour) {
  d_->scene.setTrajectoryColour(colour);
  d_->tools->showColour(colour);
  d_->view->redraw();
}

void TrajectoryScreen::setLayerVisible(SceneLayer layer, bool visible) {
  d_->scene.setVisible(layer, visible);
  d_->tools->showLayer(layer, visible);
  d_->lookUpEvents();
  d_->view->redraw();
}

void TrajectoryScreen::setTime(double time_s) {
  if (time_s == d_->time_s) return;
  d_->time_s = time_s;
  d_->time_bar->setTime(time_s);
  d_->showInstant();
  d_->lookUpEvents();
}

void TrajectoryScreen::setPlaying(bool playing) {
  d_->time_bar->setPlaying(playing);
}

bool TrajectoryScreen::isPlaying() const {
  return d_->time_bar->isPlaying();
}

void TrajectoryScreen::setEventSource(std::function<EventLookup()> source) {
  d_->event_source = std::move(source);
  d_->lookUpEvents();
}

void TrajectoryScreen::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  d_->lookUpEvents();
}

void TrajectoryScreen::hideEvent(QHideEvent* event) {
  setPlaying(false);
  QWidget::hideEvent(event);
}

void TrajectoryScreen::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) {
    d_->scene.applyTheme();
    d_->view->setBackground(theme().panel);
  }
  QWidget::changeEvent(event);
}

}  // namespace evical::ui
