// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"
#include "tests/ui/plot_pictures.h"
#include "ui/plots/convergence_screen.h"
#include "ui/plots/plot_panel.h"

#include <QComboBox>
#include <QLabel>

#include <algorithm>
#include <cmath>

using namespace evical;
using namespace evical::ui;

namespace {

struct Row {
  QString series;
  double x, y;
};

std::vector<Row> rowsOf(const PlotPanel& panel) {
  std::vector<Row> rows;
  for (const QString& line : panel.csv().split('\n', Qt::SkipEmptyParts).mid(1)) {
    const QStringList fields = line.split(',');
    rows.push_back({fields[0], fields[1].toDouble(), fields[2].toDouble()});
  }
  return rows;
}

}  // namespace

class TestConvergenceScreen : public QObject {
  Q_OBJECT

  std::shared_ptr<const CalibrationRun> run_;

  static PlotPanel& panel(ConvergenceScreen& screen, int index) {
    return *screen.findChildren<PlotPanel*>()[index];
  }
  static void settle() {
    for (int k = 0; k < 3; ++k) QCoreApplication::processEvents();
  }
  enum { kCost, kGradient, kStep, kRotation, kTranslation, kTimeOffset };

 private slots:
  void initTestCase() {
    evical::test::setPalette(false);
    const evical::test::SimulatedPass simulated = evical::test::simulatePass(4.0);
    run_ = std::make_shared<CalibrationRun>(calibrate(simulated.session, simulated.detections, {}));
    QVERIFY(run_->result.iterations.size() > 5);
  }

  void withoutARun_itSaysWhatToDo() {
    ConvergenceScreen screen;
    screen.show();
    QVERIFY(screen.findChild<QLabel*>()->isVisible());
    QVERIFY(screen.findChild<QLabel*>()->text().contains("Calibrate"));
    QVERIFY(!panel(screen, kCost).isVisible());
  }

  void run_isShownIterationByIteration() {
    ConvergenceScreen screen;
    screen.show();
    screen.setRun(run_);
    settle();
    QVERIFY(panel(screen, kCost).isVisible());
    const auto rows = rowsOf(panel(screen, kTranslation));
    QCOMPARE(rows.size(), 3 * run_->result.iterations.size());
    const auto& iterations = run_->result.iterations;
    const double expected_mm = 1e3 * (iterations[2].cameras[0].reference_from_camera.translation_m.x() -
                                      iterations.back().cameras[0].reference_from_camera.translation_m.x());
    QCOMPARE(rows[2].series, "x");
    QVERIFY(std::abs(rows[2].y - expected_mm) < 1e-6);
    QCOMPARE(rows[iterations.size() - 1].y, 0.0);  // the last one, relative to itself
  }

  void parameters_canBeRelativeToTheFirst() {
    ConvergenceScreen screen;
    screen.setRun(run_);
    QComboBox& relative = *screen.findChildren<QComboBox*>()[1];
    relative.setCurrentIndex(1);
    emit relative.activated(1);
    settle();
    const auto rows = rowsOf(panel(screen, kRotation));
    QCOMPARE(rows[0].y, 0.0);
    QVERIFY(std::abs(rows[run_->result.iterations.size() - 1].y) > 1e-6);
  }

  void lastStage_fillsTheCharts() {
    ConvergenceScreen screen;
    screen.setRun(run_);
    settle();
    const auto all = panel(screen, kTranslation).yRange();
    QComboBox& shown = *screen.findChildren<QComboBox*>()[2];
    shown.setCurrentIndex(1);
    emit shown.activated(1);
    settle();
    const auto last = panel(screen, kTranslation).yRange();
    QVERIFY(last.second - last.first < 0.8 * (all.second - all.first));
    QVERIFY(panel(screen, kTranslation).xRange().first > 0.0);
    QVERIFY(last.second >=
            1e3 * run_->result.uncertainty.cameras[0].translation_std_m.maxCoeff());  // the band
  }

  void stages_sayWhatTheyFree() {
    ConvergenceScreen screen;
    screen.resize(1100, 650);
    screen.show();
    screen.setRun(run_);
    settle();
    const auto* const stages = screen.findChild<QLabel*>("stages");
    QCOMPARE(stages->text().count("Stage "), run_->result.iterations.back().stage);
    QVERIFY2(stages->text().startsWith("Stage 1: trajectory, ") && stages->text().endsWith(": new weights") &&
                 stages->text().size() < 150,
             qPrintable(stages->text()));
    QVERIFY(stages->height() < 2 * stages->fontMetrics().height());
    const QStringList lines = stages->toolTip().split("</p><p>").mid(0, run_->result.iterations.back().stage);
    QVERIFY2(lines[0].contains("trajectory") && lines[0].contains("time offset") &&
                 lines[0].contains("gravity") && lines[0].contains("gyroscope bias"),
             qPrintable(lines[0]));
    QVERIFY2(lines[1].contains("+ ") && lines[1].contains("gyroscope scale and misalignment"),
             qPrintable(lines[1]));
    QVERIFY2(!lines[1].contains("bias"), qPrintable(lines[1]));
    QVERIFY2(lines.back().contains("estimated noise"), qPrintable(lines.back()));
    QVERIFY(panel(screen, kCost).toolTip().contains("jumps"));
  }

  // A stage's first step has no length.
  void valuesWithoutALogarithm_areNoHoles() {
    auto run = std::make_shared<CalibrationRun>(*run_);
    auto& iterations = run->result.iterations;
    iterations[1].step = 0.0;
    ConvergenceScreen screen;
    screen.setRun(run);
    settle();
    const auto rows = rowsOf(panel(screen, kStep));
    const auto holes =
        std::count_if(rows.begin(), rows.end(), [](const Row& row) { return std::isnan(row.y); });
    QCOMPARE(static_cast<int>(holes), iterations.back().stage - 1);  // between stages
    const auto positive = std::count_if(iterations.begin(), iterations.end(),
                                        [](const IterationRecord& record) { return record.step > 0.0; });
    QCOMPARE(static_cast<std::ptrdiff_t>(rows.size()), positive + holes);
  }

  void need_isDrawnAboutTheFinalValue() {
    ConvergenceScreen screen;
    screen.setRun(run_);
    settle();
    QVERIFY(panel(screen, kRotation).levels().empty());
    screen.setNeeded(NeededAccuracy{0.1, 1.5, 0.2});
    settle();
    QCOMPARE(panel(screen, kRotation).levels(), (std::vector<double>{-0.1, 0.1}));
    QCOMPARE(panel(screen, kTranslation).levels(), (std::vector<double>{-1.5, 1.5}));
    QCOMPARE(panel(screen, kTimeOffset).levels(), (std::vector<double>{-0.2, 0.2}));
    QVERIFY(panel(screen, kCost).levels().empty());
    QComboBox& relative = *screen.findChildren<QComboBox*>()[1];
    relative.setCurrentIndex(1);
    emit relative.activated(1);
    settle();
    QVERIFY(panel(screen, kRotation).levels().empty());
  }

  void liveIterations_appearAsTheyCome() {
    ConvergenceScreen screen;
    screen.setRun(run_);
    settle();
    screen.appendIteration(run_->result.iterations[0]);  // of the next run
    settle();
    QCOMPARE(rowsOf(panel(screen, kCost)).size(), std::size_t{1});
    QCOMPARE(rowsOf(panel(screen, kTimeOffset)).size(), std::size_t{1});
    QCOMPARE(rowsOf(panel(screen, kRotation)).size(), std::size_t{3});
    screen.appendIteration(run_->result.iterations[1]);
    settle();
    QCOMPARE(rowsOf(panel(screen, kRotation)).size(), std::size_t{6});
    screen.clear();
    settle();
    QCOMPARE(rowsOf(panel(screen, kRotation)).size(), std::size_t{0});
  }

  void pictures() {
    ConvergenceScreen screen;
    screen.setRun(run_);
    screen.setNeeded(NeededAccuracy{0.1, 1.0, 0.1});
    screen.show();
    evical::test::takePictures(screen, "convergence", settle);
  }
};

EVICAL_TEST(TestConvergenceScreen)
#include "tst_convergence_screen.moc"
