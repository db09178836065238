// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/layers.h"

#include "core/numerics/robust.h"
#include "core/optimisation/edge_localisation_bias.h"
#include "ui/detection/timeline.h"
#include "ui/detection/trajectory_pose.h"
#include "ui/detection/window_analysis.h"
#include "ui/theme/theme.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <QCoreApplication>
#include <QPainter>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

namespace evical::ui {
namespace {

constexpr int kOutlinePoints = 40;
constexpr double kUnknownLine_px = 8.0;

QString tr(const char* text) {
  return QCoreApplication::translate("Layers", text);
}

QPointF toPoint(const Eigen::Vector2d& pixel) {
  return {pixel.x(), pixel.y()};
}

QPointF toSensor(const Eigen::Vector2d& ideal_pixel, const BoardScene& scene) {
  return toPoint(scene.camera ? pixelFromIdeal(*scene.camera, ideal_pixel) : ideal_pixel);
}

// Same width at every zoom and display density.
void usePen(QPainter& painter, const QColor& colour, double width_px = 1.5,
            Qt::PenStyle style = Qt::SolidLine) {
  QPen pen(colour, width_px * painter.device()->devicePixelRatioF(), style);
  pen.setCosmetic(true);  // the width is in device pixels
  painter.setPen(pen);
}

Eigen::Vector2d onCircle(int k) {
  const double angle = 2.0 * std::numbers::pi * k / kOutlinePoints;
  return {std::cos(angle), std::sin(angle)};
}

// {q : (q - c)^T covariance^-1 (q - c) = sigmas^2}
QPolygonF ellipse(const Eigen::Vector2d& centre, const Eigen::Matrix2d& covariance, double sigmas,
                  const BoardScene& scene) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance);
  const Eigen::Matrix2d axes =
      sigmas * eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  QPolygonF outline;
  for (int k = 0; k < kOutlinePoints; ++k) outline << toSensor(centre + axes * onCircle(k), scene);
  return outline;
}

void paintBoard(QPainter& painter, const BoardMotion& motion, const BoardScene& scene) {
  for (const OutlineImage& outline : projectBoard(motion.ideal_from_board, scene)) {
    QPolygonF polygon;
    for (const Eigen::Vector2d& point : outlinePoints(outline)) polygon << toSensor(point, scene);
    painter.drawPolygon(polygon);
  }
}

// Measured ellipses of the circles, in the picture; corners have none.
void paintImages(QPainter& painter, const std::vector<CircleObservation>& points) {
  usePen(painter, layerColour(Layer::Ellipses), 2.0);
  painter.setBrush(Qt::NoBrush);
  for (const CircleObservation& point : points) {
    if (!(point.semi_axes_px.minCoeff() > 0.0)) continue;
    painter.save();
    painter.translate(toPoint(point.centre_px));
    painter.rotate(point.angle_rad * 180.0 / std::numbers::pi);
    painter.drawEllipse(QPointF(), point.semi_axes_px.x(), point.semi_axes_px.y());
    painter.restore();
  }
}

// Motion of the edge over the window.
QLineF flowLine(const NormalFlow& flow, double half_width_s) {
  const QPointF from(flow.x_px, flow.y_px);
  const Eigen::Vector2d step = half_width_s * flow.velocity_px_s.cast<double>();
  return {from, from + toPoint(step)};
}

void paintFlow(QPainter& painter, const WindowAnalysis& analysis) {
  QVector<QLineF> lines;
  for (const NormalFlow& flow : analysis.flow.arcs.flow) lines << flowLine(flow, analysis.flow.half_window_s);
  usePen(painter, layerColour(Layer::Flow), 1.0);
  painter.drawLines(lines);
}

// By kind: leading, trailing, others.
std::array<QColor, 3> clusterColours() {
  return {theme().good, theme().warning, theme().faint_text};
}

QColor gridColour(double share_of_board) {
  return QColor::fromHsvF(static_cast<float>(0.85 * share_of_board), 0.55f, theme().dark ? 0.95f : 0.7f);
}

void paintClusters(QPainter& painter, const WindowAnalysis& analysis) {
  const std::array<QColor, 3> colours = clusterColours();
  for (const EventCluster& cluster : analysis.flow.arcs.clusters) {
    painter.setPen(Qt::NoPen);
    QColor colour = colours[static_cast<std::size_t>(cluster.kind)];
    colour.setAlphaF(0.75f);
    painter.setBrush(colour);
    for (const std::uint32_t i : cluster.flows) {
      const NormalFlow& flow = analysis.flow.arcs.flow[i];
      painter.drawRect(QRectF(flow.x_px - 0.5, flow.y_px - 0.5, 1.0, 1.0));
    }
  }
}

void paintPairs(QPainter& painter, const NormalFlowStages& arcs) {
  usePen(painter, layerColour(Layer::Pairs));
  painter.setBrush(Qt::NoBrush);
  for (const ArcPair& pair : arcs.pairs) {
    painter.drawLine(toPoint(arcs.clusters[pair.trailing].centroid_px),
                     toPoint(arcs.clusters[pair.leading].centroid_px));
    painter.drawEllipse(toPoint(pair.circle.centre_px), pair.circle.radius_px, pair.circle.radius_px);
  }
}

void paintSearch(QPainter& painter, const BoardSearch& search) {
  painter.setBrush(Qt::NoBrush);
  usePen(painter, theme().faint_text, 1.0, Qt::DotLine);
  for (const CircleCandidate& candidate : search.candidates)
    painter.drawEllipse(toPoint(candidate.centre_px), candidate.radius_px, candidate.radius_px);
  usePen(painter, layerColour(Layer::Circles));
  for (const MovingCircle& circle : search.circles)
    painter.drawEllipse(toPoint(circle.centre_px), circle.radius_px, circle.radius_px);
  constexpr double kSaddleRadius_px = 1.5;
  for (const SaddleCandidate& saddle : search.saddles)
    painter.drawEllipse(toPoint(saddle.at_px), kSaddleRadius_px, kSaddleRadius_px);
  for (const CornerNode& a : search.corners.nodes) {
    for (const CornerNode& b : search.corners.nodes) {
      const bool next = (b.i == a.i + 1 && b.j == a.j) || (b.i == a.i && b.j == a.j + 1);
      if (next)
        painter.drawLine(toPoint(search.saddles[a.saddle].at_px), toPoint(search.saddles[b.saddle].at_px));
    }
  }
  for (const LatticeNode& a : search.lattice) {
    for (const LatticeNode& b : search.lattice) {
      const bool next = (b.i == a.i + 1 && b.j == a.j) || (b.i == a.i && b.j == a.j + 1);
      if (next)
        painter.drawLine(toPoint(search.circles[a.circle].centre_px),
                         toPoint(search.circles[b.circle].centre_px));
    }
  }
}

// A failed fit differs by colour and by a dashed line.
void paintEllipses(QPainter& painter, const WindowAnalysis& analysis) {
  const bool missed = windowClass(analysis.outcome) == WindowClass::Missed;
  QColor colour = missed ? theme().bad : layerColour(Layer::Ellipses);
  usePen(painter, colour, 2.0, missed ? Qt::DashLine : Qt::SolidLine);
  painter.setBrush(Qt::NoBrush);
  paintBoard(painter, *analysis.trace().motion, *analysis.scene);
  colour.setAlphaF(0.55f);
  painter.setPen(Qt::NoPen);
  painter.setBrush(colour);
  for (const EdgeInlier& inlier : analysis.trace().measurement.inliers) {
    const QPointF at(static_cast<double>(inlier.pixel.x()), static_cast<double>(inlier.pixel.y()));
    painter.drawRect(QRectF(at - QPointF(0.25, 0.25), QSizeF(0.5, 0.5)));
  }
}

void paintCentres(QPainter& painter, double scale, const WindowAnalysis& analysis) {
  const double arm = 4.0 / scale;
  usePen(painter, layerColour(Layer::Centres));
  painter.setBrush(Qt::NoBrush);
  for (const CircleObservation& circle : analysis.points()) {
    const QPointF at = toSensor(circle.centre_px, *analysis.scene);
    painter.drawLine(at - QPointF(arm, 0.0), at + QPointF(arm, 0.0));
    painter.drawLine(at - QPointF(0.0, arm), at + QPointF(0.0, arm));
    if (const auto known = onlyKnownDirection(circle.covariance_px2)) {
      // A line along the direction in which the corner is unknown.
      const Eigen::Vector2d half = kUnknownLine_px * known->unitOrthogonal();
      painter.drawLine(toSensor(circle.centre_px - half, *analysis.scene),
                       toSensor(circle.centre_px + half, *analysis.scene));
      continue;
    }
    painter.drawPolygon(ellipse(circle.centre_px, circle.covariance_px2, kShownSigmas, *analysis.scene));
  }
}

// Distance to the nearest other point: the median of about fifty.
double usualGap(const QPolygonF& points) {
  std::vector<double> gaps;
  const qsizetype step = std::max<qsizetype>(1, points.size() / 50);
  for (qsizetype k = 0; k < points.size(); k += step) {
    double nearest = std::numeric_limits<double>::infinity();
    for (qsizetype other = 0; other < points.size(); ++other)
      if (other != k) nearest = std::min(nearest, QLineF(points[k], points[other]).length());
    gaps.push_back(nearest);
  }
  return medianOf(std::move(gaps));
}

// Points connected along the rows, as usual in calibration tools, with their numbers if there is space. Only
// consecutive points are connected, and none if the board was not found.
void paintGrid(QPainter& painter, double scale, const WindowAnalysis& analysis) {
  const Board& board = analysis.scene->board;
  const bool missed = windowClass(analysis.outcome) == WindowClass::Missed;
  QPolygonF chain;
  int before = -2;
  for (const CircleObservation& circle : analysis.points()) {
    const bool follows = !missed && circle.circle == std::exchange(before, circle.circle) + 1;
    const QPointF at = toSensor(circle.centre_px, *analysis.scene);
    const int last = std::max(1, board.pointCount() - 1);
    usePen(painter, gridColour(static_cast<double>(circle.circle) / last), 1.2);
    if (follows) painter.drawLine(chain.last(), at);
    chain << at;
  }
  constexpr double kRoomForNumber_px = 24.0;  // of the widget
  if (scale * usualGap(chain) < kRoomForNumber_px) return;
  painter.save();
  const QTransform to_widget = painter.transform();
  painter.resetTransform();
  QFont font = painter.font();
  font.setPixelSize(std::clamp(static_cast<int>(4.5 * scale), 10, 14));
  font.setBold(true);
  painter.setFont(font);
  for (qsizetype k = 0; k < chain.size(); ++k) {
    const QPointF at = to_widget.map(chain[k]) + QPointF(5.0, -4.0);
    const QString number = QString::number(analysis.points()[static_cast<std::size_t>(k)].circle);
    painter.setPen(theme().panel);
    for (const QPointF& beside : {QPointF(1, 1), QPointF(-1, 1), QPointF(1, -1), QPointF(-1, -1)})
      painter.drawText(at + beside, number);
    painter.setPen(layerColour(Layer::Grid));
    painter.drawText(at, number);
  }
  painter.restore();
}

// Image of a circle's outline through the camera with distortion; none if part of it is not visible.
std::optional<QPolygonF> imageOf(int circle, const RigidTransform& camera_from_world,
                                 const CameraIntrinsics& intrinsics, const Board& board) {
  QPolygonF outline;
  for (int k = 0; k < kOutlinePoints; ++k) {
    const Eigen::Vector2d on_board = board.point_m(circle) + board.radius_m * onCircle(k);
    const auto pixel =
        project(intrinsics, camera_from_world * Eigen::Vector3d(on_board.x(), on_board.y(), 0.0));
    if (!pixel) return std::nullopt;
    outline << toPoint(*pixel);
  }
  return outline;
}

// Image at the exposure time of its rows, for a sensor whose middle row was exposed at this time.
std::optional<QPolygonF> imageInRows(int circle, const CalibrationState& state, const CameraState& camera,
                                     const SeenBoard& seen, double time_s) {
  const CameraIntrinsics& lens = *camera.lens.inUse();
  const auto imageAt = [&](double at_s) -> std::optional<QPolygonF> {
    const auto camera_from_world = cameraFromWorldAt(state, camera, at_s);
    if (!camera_from_world) return std::nullopt;
    return imageOf(circle, *camera_from_world * state.boardAt(seen.index).world_from_board, lens, seen.board);
  };
  const auto outline = imageAt(time_s);
  if (!outline || camera.line_delay_us == 0.0) return outline;
  return imageAt(rowTime_s(camera, time_s, outline->boundingRect().center().y()));
}

// By circle, in ideal pixels; only for measured circles.
std::map<int, Eigen::Vector2d> idealLeads(const CameraState& camera, const CameraIntrinsics& intrinsics,
                                          const BoardView& view, double slow_edge_speed_px_s) {
  std::map<int, Eigen::Vector2d> leads;
  for (const CircleObservation& circle : view.circles) {
    const EdgeLocalisationBiasEffect effect = edgeBiasEffect(intrinsics, circle, slow_edge_speed_px_s);
    leads[circle.circle] = edgeBiasOf(camera).times(effect);
  }
  return leads;
}

QPolygonF moved(const QPolygonF& outline, const Eigen::Vector2d& by_ideal_px,
                const CameraIntrinsics& intrinsics) {
  QPolygonF there;
  for (const QPointF& point : outline) {
    const auto ideal = idealPixel(intrinsics, {point.x(), point.y()});
    there << (ideal ? toPoint(pixelFromIdeal(intrinsics, *ideal + by_ideal_px)) : point);
  }
  return there;
}

}  // namespace

LayerWords layerWords(Layer layer) {
  switch (layer) {
    case Layer::Flow:
      return {tr("Flow vectors"), tr("Normal flow of edges: their motion over the event window")};
    case Layer::Clusters:
      return {tr("Clusters"),
              tr("Connected flow: leading arcs (green), trailing arcs (yellow), others (grey)")};
    case Layer::Pairs:
      return {tr("Pairs"), tr("A leading and a trailing arc of the same circle")};
    case Layer::Circles:
      return {tr("Search"),
              tr("Candidates (dotted), moving circles or corners, and the lattice formed by them")};
    case Layer::Ellipses:
      return {tr("Outlines"), tr("The fitted board, and the edge bursts on it")};
    case Layer::Centres:
      return {tr("Points"),
              tr("Measured centres or corners, with covariance ellipses of %1 sigma").arg(kShownSigmas)};
    case Layer::Grid:
      return {tr("Grid"), tr("Measured points in the board's order, with their numbers")};
    case Layer::Prediction:
      return {tr("Prediction"), tr("Board predicted by the tracker from the previous view")};
    case Layer::Reprojection:
      break;
  }
  return {
      tr("Reprojection"),
      tr("Board projected with the calibration's trajectory, and its edges with the edge localisation bias")};
}

QColor layerColour(Layer layer) {
  const Theme& colours = theme();
  switch (layer) {
    case Layer::Flow:
      return colours.faint_text;
    case Layer::Clusters:
      return colours.good;
    case Layer::Pairs:
      return colours.dark ? QColor(0xc7, 0x92, 0xea) : QColor(0x8e, 0x3f, 0xb5);
    case Layer::Circles:
      return colours.axes[2];
    case Layer::Ellipses:
      return colours.good;
    case Layer::Centres:
      return colours.bad;
    case Layer::Grid:
      return colours.text;
    case Layer::Prediction:
      return colours.warning;
    case Layer::Reprojection:
      break;
  }
  return colours.accent;
}

std::vector<QColor> layerColours(Layer layer) {
  const std::array<QColor, 3> kinds = clusterColours();
  if (layer == Layer::Clusters) return {kinds.begin(), kinds.end()};
  if (layer != Layer::Grid) return {layerColour(layer)};
  constexpr int kSteps = 4;
  std::vector<QColor> along_the_board;
  for (int k = 0; k <= kSteps; ++k) along_the_board.push_back(gridColour(static_cast<double>(k) / kSteps));
  return along_the_board;
}

LayerSet defaultLayers() {
  LayerSet layers;
  for (const Layer layer : {Layer::Ellipses, Layer::Centres, Layer::Grid})
    layers.set(static_cast<std::size_t>(layer));
  return layers;
}

bool isOfFrames(Layer layer) {
  return layer == Layer::Ellipses || layer == Layer::Centres || layer == Layer::Grid ||
         layer == Layer::Reprojection;
}

std::vector<QPolygonF> reprojectBoard(const CalibrationState& state, std::size_t camera,
                                      const SeenBoard& seen, double time_s) {
  return reprojectBoard(state, camera, seen, time_s, BoardView{}, 0.0);
}

std::vector<QPolygonF> reprojectBoard(const CalibrationState& state, std::size_t camera,
                                      const SeenBoard& seen, double time_s, const BoardView& view,
                                      double slow_edge_speed_px_s) {
  std::vector<QPolygonF> outlines;
  if (camera >= state.cameras.size() || seen.index > state.further_boards.size()) return outlines;
  const CameraState& own = state.cameras[camera];
  if (!own.lens.detection_intrinsics) return outlines;
  const double late_s =
      view.circles.empty() ? 0.0 : own.exposure_share * view.circles.front().longer_exposed_s;
  const std::map<int, Eigen::Vector2d> leads =
      idealLeads(own, *own.lens.detection_intrinsics, view, slow_edge_speed_px_s);
  for (int circle = 0; circle < seen.board.pointCount(); ++circle) {
    const auto outline = imageInRows(circle, state, own, seen, time_s + late_s);
    const auto lead = leads.find(circle);
    if (outline)
      outlines.push_back(lead == leads.end() ? *outline
                                             : moved(*outline, lead->second, *own.lens.detection_intrinsics));
  }
  return outlines;
}

void paintLayers(QPainter& painter, double scale, const LayerSet& visible, const WindowAnalysis* analysis,
                 const std::vector<QPolygonF>& reprojection) {
  const auto shown = [&](Layer layer) { return visible.test(static_cast<std::size_t>(layer)); };
  if (analysis) {
    if (shown(Layer::Flow)) paintFlow(painter, *analysis);
    if (shown(Layer::Clusters)) paintClusters(painter, *analysis);
    if (shown(Layer::Pairs)) paintPairs(painter, analysis->flow.arcs);
    if (shown(Layer::Circles) && analysis->bestSearch()) paintSearch(painter, *analysis->bestSearch());
    if (shown(Layer::Prediction) && analysis->tracked) {
      usePen(painter, layerColour(Layer::Prediction), 1.5, Qt::DashLine);
      painter.setBrush(Qt::NoBrush);
      paintBoard(painter, analysis->tracked->prediction, *analysis->scene);
    }
    if (shown(Layer::Ellipses) && analysis->trace().motion) paintEllipses(painter, *analysis);
    if (shown(Layer::Ellipses) && analysis->frame) paintImages(painter, analysis->frame->points);
  }
  if (shown(Layer::Reprojection)) {
    usePen(painter, layerColour(Layer::Reprojection), 1.5);
    painter.setBrush(Qt::NoBrush);
    constexpr double kCorner_px = 5.0;
    for (const QPolygonF& outline : reprojection) {
      if (outline.boundingRect().isEmpty()) {
        painter.drawEllipse(outline.first(), kCorner_px / scale, kCorner_px / scale);
      } else {
        painter.drawPolygon(outline);
      }
    }
  }
  if (!analysis) return;
  if (shown(Layer::Centres)) paintCentres(painter, scale, *analysis);
  if (shown(Layer::Grid)) paintGrid(painter, scale, *analysis);
}

}  // namespace evical::ui
