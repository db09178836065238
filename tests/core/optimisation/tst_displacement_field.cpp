// The displacement field over boards, and its size from errors that contain one.
#include "core/optimisation/displacement_field.h"
#include "core/optimisation/optimisation_options.h"
#include "tests/support/test_program.h"

#include <Eigen/Cholesky>

#include <random>

namespace {

using namespace evical;

Board boardOf(int rows, int cols) {
  Board board;
  board.rows = rows;
  board.cols = cols;
  return board;
}

Eigen::MatrixXd kernelOf(const Board& board, const ModelOptions& options) {
  const std::vector<Eigen::Vector2d> points_m = boardPoints_m(board);
  const auto n = static_cast<Eigen::Index>(points_m.size());
  Eigen::MatrixXd kernel(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k)
      kernel(i, k) = fieldCovariance(
          (points_m[static_cast<std::size_t>(i)] - points_m[static_cast<std::size_t>(k)]).norm() /
              board.spacing_m,
          options);
  return kernel;
}

// Errors of views: white ones of one sigma, a field, and a motion of the camera, which nobody knows.
class SimulatedViews {
 public:
  explicit SimulatedViews(const Board& board) : board_(board), points_m_(boardPoints_m(board)) {
    root_ = (kernelOf(board, options_) + 1e-9 * Eigen::MatrixXd::Identity(count(), count())).llt().matrixL();
  }

  double foundSize(double size, double sigma_px, int views) {
    constexpr double kPxPerSpacing = 25.0;
    const FieldModes root = fieldRoot(board_, options_);
    FieldSize found(root, options_.displacement_size_sigma);
    for (int view = 0; view < views; ++view) {
      std::vector<FieldSize::Circle> circles;
      const Eigen::MatrixXd field = size * root_ * normals();
      const Eigen::MatrixXd noise = normals();
      const Eigen::Vector2d shift_px(3.0 * normal_(random_), 3.0 * normal_(random_));
      const double turn = 0.02 * normal_(random_);
      for (int i = 0; i < count(); ++i) {
        const Eigen::Vector2d at_px =
            kPxPerSpacing / board_.spacing_m * points_m_[static_cast<std::size_t>(i)];
        const Eigen::Vector2d motion_px = shift_px + turn * Eigen::Vector2d(-at_px.y(), at_px.x());
        const Eigen::Vector2d in_sigmas = (field.row(i) + noise.row(i)).transpose();
        circles.push_back(
            {{i, 1.0}, at_px, in_sigmas + motion_px / sigma_px, Eigen::Matrix2d::Identity() / sigma_px});
      }
      found.add(circles);
    }
    return found.mostProbable();
  }

 private:
  int count() const { return static_cast<int>(points_m_.size()); }
  Eigen::MatrixXd normals() {
    Eigen::MatrixXd all(count(), 2);
    for (double& each : all.reshaped()) each = normal_(random_);
    return all;
  }

  Board board_;
  ModelOptions options_;
  std::vector<Eigen::Vector2d> points_m_;
  Eigen::MatrixXd root_;
  std::mt19937_64 random_{5};
  std::normal_distribution<double> normal_;
};

class TestDisplacementField : public QObject {
  Q_OBJECT

 private slots:
  // The modes leave a tenth of the variance, which counts as no displacement.
  void modes_areFew_andHaveTheKernel() {
    const ModelOptions options;
    for (const Board& board : {boardOf(7, 3), boardOf(11, 4), boardOf(13, 4)}) {
      const FieldModes modes = fieldModes(board, options);
      QVERIFY(modes.cols() < 17 && modes.cols() < modes.rows());
      const double worst = (modes * modes.transpose() - kernelOf(board, options)).cwiseAbs().maxCoeff();
      QVERIFY2(worst < 0.12, qPrintable(QString::number(worst)));
    }
  }

  void modes_ofHugeBoards_areLimited() { QCOMPARE(fieldModes(boardOf(60, 40), {}).cols(), 32); }

  void cameraWithoutEvents_hasNoDisplacement() {
    CircleObservation circle;
    QCOMPARE(displacementSigma_px(CameraKind::Frames, circle, {}), 0.0);
    const double still_px = displacementSigma_px(CameraKind::Events, circle, {});
    circle.velocity_px_s = {200.0, 0.0};
    QVERIFY(displacementSigma_px(CameraKind::Events, circle, {}) < still_px);
  }

  void size_isFound_whateverTheMotion() {
    for (const double size : {0.3, 1.0, 3.0}) {
      const double found = SimulatedViews(boardOf(11, 4)).foundSize(size, 0.03, 60);
      QVERIFY2(found > 0.85 * size && found < 1.18 * size,
               qPrintable(QString("%1: %2").arg(size).arg(found)));
    }
    const double none = SimulatedViews(boardOf(7, 3)).foundSize(0.0, 0.03, 200);
    QVERIFY2(none < 0.25, qPrintable(QString::number(none)));
  }

  void size_withoutViews_isTheExpectedOne() {
    const FieldModes root = fieldRoot(boardOf(7, 3), {});
    QCOMPARE(FieldSize(root, 0.7).mostProbable(), 1.0);
  }
};

}  // namespace

EVICAL_TEST(TestDisplacementField)
#include "tst_displacement_field.moc"
