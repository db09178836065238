#include "core/frontend/stage_drawing.h"

#include "core/base/time.h"
#include "core/frontend/drawing_canvas.h"
#include "core/geometry/camera_model.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace evical {
namespace {

constexpr Colour kBrighter = {255, 150, 60}, kDarker = {70, 150, 255};
constexpr Colour kCandidate = {120, 124, 134}, kMoving = {90, 230, 120}, kArrow = {255, 232, 110};
constexpr Colour kLattice = {245, 245, 245}, kBoard = {255, 90, 200}, kCentre = {255, 255, 255};
constexpr Colour kRun = {90, 230, 120}, kChase = {255, 232, 110}, kOther = {170, 170, 180};
constexpr Colour kLost = {255, 80, 80};
constexpr int kOutlinePoints = 48;

template <class... Values>
std::string print(const char* format, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

Eigen::Vector2d toSensor(const Eigen::Vector2d& ideal_pixel, const BoardScene& scene) {
  return scene.camera ? pixelFromIdeal(*scene.camera, ideal_pixel) : ideal_pixel;
}

void paintBursts(DrawingCanvas& canvas, const BurstWindow& window, const BoardScene& scene,
                 double brightness) {
  float oldest_s = 0.0f, newest_s = 0.0f;
  for (const WindowBurst& burst : window.bursts()) {
    oldest_s = std::min(oldest_s, burst.time_s);
    newest_s = std::max(newest_s, burst.time_s);
  }
  const float span_s = std::max(newest_s - oldest_s, 1e-6f);
  constexpr double kFaintest = 0.2;
  for (const WindowBurst& burst : window.bursts()) {
    const bool brighter = (burst.lead < 0.0f) == (scene.board.circles == CircleShade::Dark);
    const double age = (newest_s - burst.time_s) / span_s;
    canvas.pixel(static_cast<int>(burst.x_px), static_cast<int>(burst.y_px), brighter ? kBrighter : kDarker,
                 brightness * (1.0 - (1.0 - kFaintest) * age));
  }
}

// {q : (q - c)^T covariance^-1 (q - c) = sigmas^2}
std::vector<Eigen::Vector2d> ellipse(const Eigen::Vector2d& centre, const Eigen::Matrix2d& covariance,
                                     double sigmas, const BoardScene& scene) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance);
  const Eigen::Matrix2d axes =
      sigmas * eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k < kOutlinePoints; ++k) {
    const double angle = 2.0 * M_PI * k / kOutlinePoints;
    points.push_back(toSensor(centre + axes * Eigen::Vector2d(std::cos(angle), std::sin(angle)), scene));
  }
  return points;
}

void paintBoard(DrawingCanvas& canvas, const BoardMotion& motion, const BoardScene& scene, Colour colour,
                int thickness, const DrawingStyle& style) {
  for (const OutlineImage& outline : projectBoard(motion.ideal_from_board, scene)) {
    std::vector<Eigen::Vector2d> points = outlinePoints(outline);
    for (Eigen::Vector2d& point : points) point = toSensor(point, scene);
    if (outline.isStraight())
      canvas.line(points[0], points[1], colour, thickness);
    else
      canvas.outline(points, colour, thickness);
  }
  for (int index = 0; index < scene.board.pointCount(); ++index) {
    const std::optional<PointImage> point = imageOfPoint(motion.ideal_from_board, scene, index);
    if (!point) continue;
    const Eigen::Vector2d moved = point->centre_px + style.arrow_s * motion.velocityAt(point->centre_px);
    canvas.arrow(toSensor(point->centre_px, scene), toSensor(moved, scene), kArrow);
  }
}

void paintBoardNumbers(DrawingCanvas& canvas, const BoardMotion& motion, const BoardScene& scene) {
  for (int index = 0; index < scene.board.pointCount(); ++index) {
    const std::optional<PointImage> point = imageOfPoint(motion.ideal_from_board, scene, index);
    if (point) canvas.label(toSensor(point->centre_px, scene), std::to_string(index), kCentre);
  }
}

void paintArcs(DrawingCanvas& canvas, const NormalFlowStages& arcs, const BoardSearch& search) {
  for (const NormalFlow& flow : arcs.flow) {
    const Eigen::Vector2d from(flow.x_px, flow.y_px);
    canvas.line(from, from + search.half_window_s * flow.velocity_px_s.cast<double>(), kCandidate);
  }
  for (const EventCluster& cluster : arcs.clusters) {
    const Colour colour = cluster.kind == ClusterKind::Run     ? kRun
                          : cluster.kind == ClusterKind::Chase ? kChase
                                                               : kOther;
    for (const std::uint32_t i : cluster.flows) {
      const NormalFlow& flow = arcs.flow[i];
      const Eigen::Vector2d from(flow.x_px, flow.y_px);
      canvas.line(from, from + search.half_window_s * flow.velocity_px_s.cast<double>(), colour);
    }
  }
  for (const ArcPair& pair : arcs.pairs) {
    canvas.line(arcs.clusters[pair.trailing].centroid_px, arcs.clusters[pair.leading].centroid_px, kLattice,
                2);
    canvas.circle(pair.circle.centre_px, pair.circle.radius_px, kLattice);
  }
}

void paintMoving(DrawingCanvas& canvas, const BoardSearch& search, const DrawingStyle& style) {
  constexpr double kSaddleRadius_px = 1.5;
  for (const SaddleCandidate& saddle : search.saddles) canvas.circle(saddle.at_px, kSaddleRadius_px, kMoving);
  for (const MovingCircle& circle : search.circles) {
    canvas.circle(circle.centre_px, circle.radius_px, kMoving);
    canvas.arrow(circle.centre_px, circle.centre_px + style.arrow_s * circle.velocity_px_s, kArrow);
  }
}

void paintLattice(DrawingCanvas& canvas, const BoardSearch& search) {
  for (const CornerNode& a : search.corners.nodes) {
    for (const CornerNode& b : search.corners.nodes) {
      const bool next = (b.i == a.i + 1 && b.j == a.j) || (b.i == a.i && b.j == a.j + 1);
      if (next) canvas.line(search.saddles[a.saddle].at_px, search.saddles[b.saddle].at_px, kLattice);
    }
  }
  for (const LatticeNode& a : search.lattice) {
    for (const LatticeNode& b : search.lattice) {
      const bool next = (b.i == a.i + 1 && b.j == a.j) || (b.i == a.i && b.j == a.j + 1);
      if (!next) continue;
      canvas.line(search.circles[a.circle].centre_px, search.circles[b.circle].centre_px, kLattice);
    }
  }
}

// The covariance ellipse; of a corner that is known in one direction only, a line along the other one.
void paintSigmas(DrawingCanvas& canvas, const CircleObservation& point, const BoardScene& scene,
                 const DrawingStyle& style) {
  constexpr double kUnknown_px = 3.0;
  const auto known = onlyKnownDirection(point.covariance_px2);
  if (!known)
    return canvas.outline(ellipse(point.centre_px, point.covariance_px2, style.covariance_sigmas, scene),
                          kBoard);
  const Eigen::Vector2d along = kUnknown_px * known->unitOrthogonal();
  canvas.line(toSensor(point.centre_px - along, scene), toSensor(point.centre_px + along, scene), kBoard);
}

}  // namespace

RgbImage drawBursts(const BurstWindow& window, const BoardScene& scene, const std::string& title,
                    const DrawingStyle& style) {
  DrawingCanvas canvas(window.resolution_px(), style.width_px);
  paintBursts(canvas, window, scene, 1.0);
  canvas.title(title);
  canvas.legend({{"brighter", kBrighter}, {"darker", kDarker}});
  return canvas.image();
}

RgbImage drawSearch(const BurstWindow& window, const BoardSearch& search, const BoardScene& scene,
                    const NormalFlowStages* arcs, const DrawingStyle& style) {
  DrawingCanvas canvas(window.resolution_px(), style.width_px);
  paintBursts(canvas, window, scene, 0.6);
  if (arcs) {
    paintArcs(canvas, *arcs, search);
  } else {
    for (const CircleCandidate& candidate : search.candidates)
      canvas.circle(candidate.centre_px, candidate.radius_px, kCandidate);
  }
  paintMoving(canvas, search, style);
  paintLattice(canvas, search);
  if (search.motion) {
    paintBoard(canvas, *search.motion, scene, kBoard, 2, style);
    paintBoardNumbers(canvas, *search.motion, scene);
  }
  canvas.title(print(
      "search: %s   +-%.1f ms, %d bursts, %zu candidates, %zu moving circles, %zu corners, %zu in lattice",
      windowOutcomeName(search.outcome), 1e3 * search.half_window_s, search.bursts, search.candidates.size(),
      search.circles.size(), search.saddles.size(), search.lattice.size() + search.corners.nodes.size()));
  std::vector<std::pair<std::string, Colour>> words = {{"brighter", kBrighter}, {"darker", kDarker}};
  if (arcs) {
    words.insert(words.end(), {{"run", kRun}, {"chase", kChase}, {"other", kOther}, {"pairs", kLattice}});
  } else {
    words.emplace_back("candidates", kCandidate);
  }
  words.insert(words.end(),
               {{"moving circles", kMoving}, {"velocity", kArrow}, {"lattice", kLattice}, {"board", kBoard}});
  canvas.legend(words);
  return canvas.image();
}

RgbImage drawTrackedWindow(const BurstWindow& window, const WindowTrace& trace, const BoardScene& scene,
                           const DrawingStyle& style) {
  DrawingCanvas canvas(window.resolution_px(), style.width_px);
  paintBursts(canvas, window, scene, 0.75);
  const Colour colour = trace.held() ? kMoving : kLost;
  const BoardMotion& motion = trace.motion ? *trace.motion : trace.prediction;
  paintBoard(canvas, motion, scene, colour, 1, style);
  for (const CircleObservation& circle : trace.circles) {
    const Eigen::Vector2d centre = toSensor(circle.centre_px, scene);
    canvas.cross(centre, kCentre);
    paintSigmas(canvas, circle, scene, style);
    canvas.label(centre, std::to_string(circle.circle), kCentre);
  }
  canvas.title(
      print("%.3f s: %s   %d bursts, %zu of %d points, fit %.2f px RMS over %d, radius offset %+.2f px",
            trace.report.time_s, trace.held() ? "tracked" : "lost", trace.report.events, trace.circles.size(),
            scene.board.pointCount(), motion.residual_rms_px, motion.bursts, motion.radius_offset_px));
  canvas.legend({{"brighter", kBrighter},
                 {"darker", kDarker},
                 {"fitted board", colour},
                 {print("velocity x %.0f ms", 1e3 * style.arrow_s), kArrow},
                 {print("centre, %.0f sigma", style.covariance_sigmas), kBoard}});
  return canvas.image();
}

}  // namespace evical
