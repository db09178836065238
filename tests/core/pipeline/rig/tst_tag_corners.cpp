// Displacements of tag corners that are the same in all views.
#include "core/pipeline/rig/tag_corners.h"
#include "tests/support/random_vector.h"
#include "tests/support/test_program.h"

#include <cmath>
#include <random>

using namespace evical;

namespace {

constexpr double kInwards_px = 0.3, kNoise_px = 0.1;
constexpr int kViews = 30, kTags = 9;

Eigen::Vector2d trueCorner_px(int view, int corner) {
  const int tag = corner / 4, of_tag = corner % 4;
  const Eigen::Vector2d middle_px(60.0 * (tag % 3) + view, 60.0 * (tag / 3));
  const double angle_rad = 0.5 * M_PI * of_tag + 0.1 * view;
  return middle_px + 20.0 * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
}

}  // namespace

class TestTagCorners : public QObject {
  Q_OBJECT

 private slots:
  void displacement_isEstimatedWithItsSigma() {
    const TagCornerShift shift = tagCornerShift(1, residuals(1));
    QVERIFY2(std::abs(shift.outwards_px - kInwards_px) < 4.0 * shift.sigma_px, qPrintable(text(shift)));
    const double expected_px = kNoise_px / std::sqrt(kViews * kTags * 4.0);
    QVERIFY2(shift.sigma_px > 0.6 * expected_px && shift.sigma_px < 1.5 * expected_px,
             qPrintable(text(shift)));
  }

  void residualsOfOtherCameras_doNotCount() { QCOMPARE(tagCornerShift(0, residuals(1)).outwards_px, 0.0); }

  void unusedCorners_doNotCount() {
    std::vector<CircleResidual> all = residuals(0);
    for (std::size_t i = 0; i < all.size(); i += 7) {
      all[i].residual_px *= 100.0;
      all[i].used = false;
    }
    const TagCornerShift shift = tagCornerShift(0, all);
    QVERIFY2(std::abs(shift.outwards_px - kInwards_px) < 4.0 * shift.sigma_px, qPrintable(text(shift)));
  }

  // A tag with three corners has no known middle.
  void wholeTags_areMoved() {
    BoardView view;
    for (const int corner : {4, 5, 6, 7, 8, 9, 11}) {
      view.circles.emplace_back().circle = corner;
      view.circles.back().centre_px = trueCorner_px(0, corner);
    }
    std::vector<BoardView> views{view};
    moveTagCorners(0.5, views);
    for (std::size_t i = 0; i < view.circles.size(); ++i) {
      const double moved_px = (views[0].circles[i].centre_px - view.circles[i].centre_px).norm();
      QVERIFY2(std::abs(moved_px - (i < 4 ? 0.5 : 0.0)) < 1e-9, qPrintable(QString::number(moved_px)));
    }
    const double radius_px = (views[0].circles[0].centre_px - views[0].circles[2].centre_px).norm() / 2.0;
    QVERIFY(std::abs(radius_px - 20.5) < 1e-9);
  }

 private:
  static QString text(const TagCornerShift& shift) {
    return QString("%1 +- %2").arg(shift.outwards_px).arg(shift.sigma_px);
  }
  // Corners that are measured inwards by kInwards_px: predicted - measured.
  static std::vector<CircleResidual> residuals(int camera) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> noise(0.0, kNoise_px);
    std::vector<CircleResidual> all;
    for (int view = 0; view < kViews; ++view) {
      for (int corner = 0; corner < 4 * kTags; ++corner) {
        const Eigen::Vector2d true_px = trueCorner_px(view, corner);
        const Eigen::Vector2d middle_px =
            0.5 * (true_px + trueCorner_px(view, corner / 4 * 4 + (corner + 2) % 4));
        CircleResidual& residual = all.emplace_back();
        residual.camera = camera;
        residual.view = view;
        residual.circle = corner;
        residual.centre_px = true_px - kInwards_px * (true_px - middle_px).normalized() +
                             test::randomVector<2>([&] { return noise(random); });
        residual.residual_px = true_px - residual.centre_px;
      }
    }
    return all;
  }
};

EVICAL_TEST(TestTagCorners)
#include "tst_tag_corners.moc"
