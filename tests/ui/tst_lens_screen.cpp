// SPDX-License-Identifier: GPL-3.0-or-later
// A camera's result page: the lens's numbers with their sigmas, the comparison with another lens, the maps
// and the views.
#include "ui/screens/lens/lens_screen.h"

#include "core/base/error.h"
#include "core/geometry/projection_difference.h"
#include "core/intrinsics/intrinsics_uncertainty.h"
#include "tests/support/test_program.h"
#include "tests/ui/screenshots.h"
#include "ui/screens/lens/image_map_view.h"
#include "ui/screens/lens/lens_parameters.h"
#include "ui/screens/lens/views_chart.h"
#include "ui/theme/theme.h"

#include <QComboBox>
#include <QLabel>
#include <QListWidget>
#include <QMenu>
#include <QPushButton>
#include <QSignalSpy>
#include <QTabWidget>
#include <QTreeWidget>

#include <cmath>
#include <limits>

using namespace evical;
using namespace evical::ui;

namespace {

constexpr double kFocalSigma_px = 0.25;

// The lens of a DAVIS346 with uncorrelated parameters; circles in the left half of the image.
NamedIntrinsics lens() {
  NamedIntrinsics named{"left", "/left/events", "test", {}, {}};
  IntrinsicsResult& result = named.result;
  CameraIntrinsics& camera = result.intrinsics;
  camera.resolution_px = {346, 260};
  camera.focal_length_px = {262.5, 262.25};
  camera.principal_point_px = {172.0, 131.5};
  camera.distortion = {-0.3, 0.09, 0.0005, -0.0004, 0.0};
  const double sigmas[] = {kFocalSigma_px, kFocalSigma_px, 0.5, 0.5, 0.002, 0.004, 1e-4, 1e-4};
  for (int k = 0; k < 8; ++k) result.covariance(k, k) = sigmas[k] * sigmas[k];
  result.image.columns = 16;
  result.image.rows = 12;
  result.image.cells.resize(192);
  for (std::size_t k = 0; k < 192; ++k) result.image.cells[k].circles = k % 16 < 8 ? 12 : 0;
  setSigmas(camera, result.covariance, result.image);
  result.reprojection_rms_px = 0.123;
  result.normalised_rms = 1.05;
  result.views_found = 140;
  result.views_used = 2;
  result.circles_used = 80;
  result.circles_rejected = 3;
  result.largest_tilt_deg = 31.0;
  result.advice = {"No views in the right edge: move the board there"};
  named.story.tried = {{CameraModel::PinholeRadtan, 1.02, 80, 83},
                       {CameraModel::PinholeEquidistant, 2.5, 70, 83}};
  named.story.views = {{0.5, 0.6, 12.0, 44, 0.11}, {1.5, 1.2, 31.0, 36, 0.14}};
  return named;
}

// Focal lengths with an error of four sigmas.
KnownIntrinsics otherLens() {
  KnownIntrinsics other{lens().result.intrinsics, {}};
  other.camera.focal_length_px.array() -= 4.0 * kFocalSigma_px;
  return other;
}

const QTreeWidgetItem* rowOf(const LensScreen& screen, const QString& name) {
  auto* const tree = screen.findChild<QTreeWidget*>("lens_numbers");
  const QList<QTreeWidgetItem*> found = tree->findItems(name, Qt::MatchStartsWith | Qt::MatchRecursive, 0);
  return found.isEmpty() ? nullptr : found.front();
}

QString allTextForLensScreen(const QWidget& widget) {
  QString all;
  for (const QLabel* const label : widget.findChildren<QLabel*>())
    if (!label->isHidden()) all += label->text() + "\n";
  return all;
}

void setAgainst(LensScreen& screen, const QString& title) {
  auto* const box = screen.findChild<QComboBox*>("lens_against");
  box->setCurrentIndex(box->findText(title));
  emit box->activated(box->currentIndex());
}

}  // namespace

class TestLensScreen : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() { applyTheme(*qApp, Appearance::Light); }

  void numbers_areTheLenss_withTheirSigmas() {
    LensScreen screen;
    screen.setLens(lens());
    const QTreeWidgetItem* const focal = rowOf(screen, "Focal length x");
    QVERIFY(focal);
    QCOMPARE(focal->text(1), QString("262.50"));
    QCOMPARE(focal->text(2), QString("0.25"));
    QCOMPARE(focal->text(3), QString("px"));
    QCOMPARE(rowOf(screen, "Principal point y")->text(1), QString("131.50"));
    QCOMPARE(rowOf(screen, "Distortion k1")->text(1), QString("-0.3000"));
    QCOMPARE(rowOf(screen, "Distortion k1")->text(2), QString("0.0020"));
    QVERIFY(!rowOf(screen, "Distortion k3"));  // which this lens does not have
    QCOMPARE(rowOf(screen, "Reprojection error, RMS")->text(1), QString("0.123"));
    QCOMPARE(rowOf(screen, "Views used")->text(1), QString("2 of 140"));
    QCOMPARE(rowOf(screen, "Board's distance")->text(1), QString("0.60 to 1.20"));
    QVERIFY(rowOf(screen, "Pinhole, radial-tangential (selected)"));
    QVERIFY(!rowOf(screen, "Pinhole, equidistant")->text(0).contains("selected"));
    QVERIFY(!rowOf(screen, "Edge localisation bias"));  // frames have none
  }

  void verdict_isInWords_withReasonAndAdvice() {
    LensScreen screen;
    QVERIFY(allTextForLensScreen(screen).contains("not calibrated yet"));
    NamedIntrinsics doubtful = lens();
    doubtful.result.status = CalibrationStatus::Doubtful;
    doubtful.result.reason = "the focal length is known to 2 % only";
    screen.setLens(doubtful);
    QVERIFY(allTextForLensScreen(screen).contains("Camera calibrated, but doubtful"));
    QVERIFY(allTextForLensScreen(screen).contains("The focal length is known to 2 % only."));
    QVERIFY(screen.findChild<QListWidget*>()->item(0)->text().contains("right edge"));
  }

  void otherLens_isComparedInNumbersAndOverTheImage() {
    LensScreen screen;
    screen.setLens(lens());
    auto* const tree = screen.findChild<QTreeWidget*>("lens_numbers");
    QVERIFY(tree->isColumnHidden(4));
    screen.setOthers({{"factory.yaml", otherLens()}});  // a new one is compared immediately
    QVERIFY(!tree->isColumnHidden(4));
    QCOMPARE(rowOf(screen, "Focal length x")->text(4), QString("+1.00"));
    QCOMPARE(rowOf(screen, "Focal length x")->text(5), QString("4.0"));
    QCOMPARE(rowOf(screen, "Principal point x")->text(5), QString("0.0"));
    const auto expected_px = projectionDifference(lens().result.intrinsics, otherLens().camera);
    const LensComparison comparison = compareLenses(lens().result, otherLens());
    QVERIFY(std::abs(comparison.rms_px - expected_px.rms_px) < 0.05 * expected_px.rms_px);
    QVERIFY(allTextForLensScreen(screen).contains(QString::number(comparison.rms_px, 'g', 2) + " px RMS"));
    setAgainst(screen, "nothing");
    QVERIFY(tree->isColumnHidden(4));
  }

  void sigmasOfBoth_count() {
    KnownIntrinsics other = otherLens();
    LensUncertainty known;
    known.std[0] = known.std[1] = kFocalSigma_px;
    known.correlation = IntrinsicsMatrix::Identity();
    other.uncertainty = known;
    const LensComparison alone = compareLenses(lens().result, otherLens());
    const LensComparison both = compareLenses(lens().result, other);
    QVERIFY(std::abs((*both.numbers)[0].sigma - std::sqrt(2.0) * kFocalSigma_px) < 1e-9);
    QVERIFY(both.rms_sigmas < alone.rms_sigmas);
    QCOMPARE(both.rms_px, alone.rms_px);
  }

  void otherModel_isComparedOverTheImageOnly_anotherSizeNotAtAll() {
    LensScreen screen;
    screen.setLens(lens());
    KnownIntrinsics equidistant = otherLens();
    equidistant.camera.model = CameraModel::PinholeEquidistant;
    equidistant.camera.distortion = {};
    screen.setOthers({{"equidistant.yaml", equidistant}});
    QVERIFY(screen.findChild<QTreeWidget*>("lens_numbers")->isColumnHidden(4));
    QVERIFY(allTextForLensScreen(screen).contains("The models differ"));
    KnownIntrinsics larger = otherLens();
    larger.camera.resolution_px = {640, 480};
    screen.setOthers({{"vga.yaml", larger}});
    QVERIFY2(
        allTextForLensScreen(screen).contains("is for images of 640 x 480 px, but this one for 346 x 260 px"),
        qPrintable(allTextForLensScreen(screen)));
  }

  void maps_sayWhatTheyShowWhereThePointerIs() {
    LensScreen screen;
    screen.resize(1100, 700);
    screen.setLens(lens());
    screen.show();
    QVERIFY(QTest::qWaitForWindowExposed(&screen));
    auto* const tabs = screen.findChild<QTabWidget*>();
    const QList<ImageMapView*> maps = tabs->findChildren<ImageMapView*>();
    tabs->setCurrentIndex(1);
    const auto coverage = std::find_if(maps.begin(), maps.end(), [](const ImageMapView* map) {
      return map->accessibleName() == "Coverage";
    });
    QVERIFY(coverage != maps.end());
    const QRectF image = (*coverage)->imageRect();
    QVERIFY(std::abs(image.width() / image.height() - 346.0 / 260.0) < 0.01);
    const auto at = [&](double x, double y) {
      return (*coverage)->textAt(
          (image.topLeft() + QPointF(x * image.width(), y * image.height())).toPoint());
    };
    QVERIFY2(at(0.25, 0.5).endsWith(": 12"), qPrintable(at(0.25, 0.5)));
    QVERIFY2(at(0.75, 0.5).endsWith(": 0"), qPrintable(at(0.75, 0.5)));
    QVERIFY((*coverage)->textAt({1, (*coverage)->height() - 1}).isEmpty());
    QVERIFY(allTextForLensScreen(screen).contains("50 % of the image"));
    auto* const views = screen.findChild<ViewsChart*>();
    tabs->setCurrentIndex(2);
    QVERIFY(views->textAt(views->placeOf(1).toPoint()).contains("1.20 m away, tilted by 31 deg"));
    screen.setOthers({{"factory.yaml", otherLens()}});
    for (int tab = 0; tab < tabs->count(); ++tab) {
      tabs->setCurrentIndex(tab);
      QVERIFY(screen.grab().save(evical::ui::test::screenshotPath("lens_%1.png").arg(tab)));
    }
  }

  void whatIsAskedFor_isSaid() {
    LensScreen screen;
    screen.setPrograms({{"opencv", "OpenCV"}});
    screen.setLens(lens());
    QSignalSpy used(&screen, &LensScreen::useRequested), file(&screen, &LensScreen::saveRequested);
    QSignalSpy exported(&screen, &LensScreen::exportRequested);
    QTest::mouseClick(screen.findChild<QPushButton*>("use_lens"), Qt::LeftButton);
    QCOMPARE(used.size(), 1);
    QMenu* const menu = screen.findChild<QPushButton*>("save_lens")->menu();
    menu->actions().at(2)->trigger();
    QCOMPARE(file.takeFirst().at(0).toInt(), 2);
    menu->actions().back()->menu()->actions().front()->trigger();
    QCOMPARE(exported.takeFirst().at(0).toString(), QString("opencv"));
    for (const QPushButton* const button : screen.findChildren<QPushButton*>())
      QVERIFY2(!button->toolTip().isEmpty(), qPrintable(button->text()));
  }
};

EVICAL_TEST(TestLensScreen)

#include "tst_lens_screen.moc"
