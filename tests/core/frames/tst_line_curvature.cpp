// A wide lens bends the board's lines, so that gradients around a corner alone would give a biased position.
#include "core/frames/board_finder.h"
#include "core/frames/corner_measurement.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/circle_conic.h"
#include "tests/support/rendered_board.h"
#include "tests/support/test_program.h"

#include <cmath>

namespace {

using namespace evical;

CameraIntrinsics wideLens() {
  CameraIntrinsics camera;
  camera.model = CameraModel::DoubleSphere;
  camera.resolution_px = {512, 512};
  camera.focal_length_px = {125.3, 125.1};
  camera.principal_point_px = {254.2, 257.1};
  camera.distortion = {-0.18, 0.59};
  return camera;
}

Board tagGrid() {
  Board board;
  board.type = BoardType::AprilGrid;
  board.radius_m = 0.0;
  board.rows = 4;
  board.cols = 5;
  board.tag_size_m = 0.06;
  board.spacing_m = 0.085;
  return board;
}

// At the image's border, where lines bend most.
RigidTransform beside(const Board& board) {
  return lookAt(board, 0.24, {0.1, -0.35, 0.15}, {0.18, 0.08});
}

FoundPoints trueCorners(const Board& board, const RigidTransform& pose) {
  FoundPoints points;
  for (int k = 0; k < board.pointCount(); ++k)
    if (const auto at = truePoint(board, k, wideLens(), pose))
      points.push_back({k, *at, Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Zero()});
  return points;
}

// Curvature from three positions very close to each other.
double curvatureOf(const RigidTransform& pose, const Eigen::Vector2d& at_m, const Eigen::Vector2d& along_m) {
  const auto place = [&](double part) {
    const Eigen::Vector2d on_board_m = at_m + part * along_m;
    return pixelFromIdeal(wideLens(), *projectedCircleCentre(wideLens(), pose, on_board_m, 0.0));
  };
  constexpr double kStep = 0.02;
  const Eigen::Vector2d slope = (place(kStep) - place(-kStep)) / (2.0 * kStep);
  const Eigen::Vector2d bend = (place(kStep) - 2.0 * place(0.0) + place(-kStep)) / (kStep * kStep);
  return Eigen::Vector2d(-slope.y(), slope.x()).normalized().dot(bend) / slope.squaredNorm();
}

class TestLineCurvature : public QObject {
  Q_OBJECT
 private slots:
  void curvature_isThatOfTheLens();
  void fewPoints_tellNothing();
  void bentCorner_isMeasuredWhereItIs();
};

void TestLineCurvature::curvature_isThatOfTheLens() {
  const Board board = tagGrid();
  const RigidTransform pose = beside(board);
  const FoundPoints points = trueCorners(board, pose);
  const BentLines bent(points, board);
  double squares = 0.0, errors = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const FoundPoint& point = points[k];
    const auto lines = bent.through(k);
    QVERIFY(lines.has_value());
    const Eigen::Vector2d at_m = board.point_m(point.point);
    const std::array truth = {curvatureOf(pose, at_m, {board.spacing_m, 0.0}),
                              curvatureOf(pose, at_m, {0.0, board.spacing_m})};
    for (std::size_t line = 0; line < 2; ++line) {
      squares += std::pow(truth[line], 2);
      errors += std::pow(lines->at(line).curvature_1_px - truth[line], 2);
    }
  }
  const double rms_1_px = std::sqrt(squares / (2.0 * static_cast<double>(points.size())));
  qInfo("curvatures %.5f 1/px RMS, errors of %.1f %%", rms_1_px, 100.0 * std::sqrt(errors / squares));
  QVERIFY(rms_1_px > 1e-3);
  QVERIFY(errors < 0.15 * 0.15 * squares);
}

void TestLineCurvature::fewPoints_tellNothing() {
  const Board board = tagGrid();
  FoundPoints points = trueCorners(board, beside(board));
  // Two rows of corners: no second derivative down the columns.
  std::erase_if(points, [&](const FoundPoint& point) {
    return board.point_m(point.point).y() > 1.01 * board.tag_size_m;
  });
  QCOMPARE(points.size(), static_cast<std::size_t>(4 * board.cols));
  QVERIFY(!BentLines(points, board).through(3));
  std::erase_if(points, [&](const FoundPoint& point) {
    return board.point_m(point.point).y() > 0.5 * board.tag_size_m;
  });
  QVERIFY(!BentLines(points, board).through(3));
}

// In images without noise, with windows so large that curvature matters.
void TestLineCurvature::bentCorner_isMeasuredWhereItIs() {
  Board board = tagGrid();
  board.type = BoardType::Checkerboard;
  board.tag_size_m = 0.0;
  board.rows = 5;
  board.cols = 7;
  board.spacing_m = 0.09;
  FrameOptions options;
  options.subpixel_window_px = 9;
  double alone = 0.0, unbent = 0.0, common = 0.0, by_bending = 0.0, difference = 0.0;
  int count = 0;
  for (const Eigen::Vector2d& beside_m : {Eigen::Vector2d(0.1, 0.0), Eigen::Vector2d(-0.1, 0.05),
                                          Eigen::Vector2d(0.0, -0.1), Eigen::Vector2d(-0.05, 0.15)}) {
    const RigidTransform pose = lookAt(board, 0.28, {0.1, -0.2, 0.1}, beside_m);
    const GrayImage image = renderBoard({board, 2, 0, false}, wideLens(), pose, {40.0, 210.0, 0.8, 0.0, 1});
    const FoundPoints truth = trueCorners(board, pose);
    const BentLines bent(truth, board);
    BoardFinder finder(board, options);
    const FoundPoints found = finder.find(image);
    for (const FoundPoint& point : asTrue(found, board, wideLens(), pose)) {
      const auto index = static_cast<std::size_t>(point.point);
      const Eigen::Vector2d at_px = truth[index].at_px;
      const auto corner = measureCorner(image, at_px, options.subpixel_window_px, 1.0);
      const auto lines = bent.through(index);
      if (!corner || !lines) continue;
      const Eigen::Vector2d shift = shiftByBending(image, corner->at_px, options.subpixel_window_px, *lines);
      alone += (corner->at_px - at_px).squaredNorm();
      unbent += (corner->at_px - shift - at_px).squaredNorm();
      by_bending += shift.squaredNorm();
      common += shift.dot(corner->at_px - at_px);
      difference += (point.at_px - (corner->at_px - shift)).squaredNorm();
      ++count;
    }
  }
  QVERIFY2(count > 80, qPrintable(QString::number(count)));
  const auto rms = [&](double sum) { return std::sqrt(sum / count); };
  qInfo(
      "%d corners: %.4f px RMS from gradients, %.4f px after subtracting the effect of bending, which is "
      "%.4f px",
      count, rms(alone), rms(unbent), rms(by_bending));
  qInfo("errors are proportional to it, with a factor of %.2f", common / by_bending);
  QVERIFY(unbent < 0.6 * alone);
  QVERIFY(std::abs(common / by_bending - 1.0) < 0.3);
  QVERIFY(difference < 0.1 * by_bending);  // the finder does the same
}

}  // namespace

EVICAL_TEST(TestLineCurvature)
#include "tst_line_curvature.moc"
