// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/result/result_screen.h"

#include "core/base/error.h"
#include "core/pipeline/runs/result_files.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"
#include "tests/ui/other_load.h"
#include "tests/ui/simulated_session.h"
#include "ui/forms/repair_button.h"
#include "ui/screens/result/correlation_view.h"
#include "ui/screens/result/observability_view.h"
#include "ui/screens/result/result_parameters.h"
#include "ui/theme/theme.h"

#include <QComboBox>
#include <QLabel>
#include <QScrollBar>
#include <QTreeWidget>

#include <algorithm>

using namespace evical;
using namespace evical::ui;

namespace {

const ParameterRow* find(const std::vector<ParameterGroup>& groups, const QString& key) {
  for (const ParameterGroup& group : groups)
    for (const ParameterRow& row : group.rows)
      if (row.key == key) return &row;
  return nullptr;
}

QString allTextForResultScreen(const QWidget& widget) {
  QString all;
  for (const QLabel* const label : widget.findChildren<QLabel*>())
    if (!label->isHidden()) all += label->text() + "\n";
  return all;
}

}  // namespace

class TestResultScreen : public QObject {
  Q_OBJECT

  NamedResult result_, truth_;

 private slots:
  void initTestCase() {
    applyTheme(*qApp, Appearance::Light);
    const Session session = readSession(evical::ui::test::simulatedSession().toStdString());
    result_ = namedResult(
        session, std::make_shared<const CalibrationResult>(calibrate(session, RunContext{}).result), "test");
    truth_ = readResultYaml(session.source.parent_path() / "truth.yaml");
  }

  void parameters_haveUnitsThatPeopleUse() {
    const std::vector<ParameterGroup> groups = parameterGroups(result_);
    QCOMPARE(groups.size(), std::size_t{6});  // pose, lens and details of the camera, IMU, board, gravity
    QCOMPARE(find(groups, "board.scale")->value, result_.result->state.board.scale);
    const ParameterRow* const offset = find(groups, "left.time_offset");
    QVERIFY(offset);
    QCOMPARE(offset->unit, QString("ms"));
    QCOMPARE(offset->value, 1e3 * result_.result->state.cameras[0].time_offset_s);
    QCOMPARE(find(groups, "left.translation.x")->value,
             1e3 * result_.result->state.cameras[0].reference_from_camera.translation_m.x());
    QVERIFY(!find(groups, "left.translation.x")->difference);
  }

  void poseAndTimeOffset_areShownFirst_andTheRestIsFolded() {
    const std::vector<ParameterGroup> groups = parameterGroups(result_);
    for (const ParameterGroup& group : groups) QCOMPARE(group.folded, &group != &groups.front());
    for (const ParameterRow& row : groups.front().rows)
      QVERIFY2(!row.name.contains("Focal") && !row.name.contains("drift"), qPrintable(row.name));
    ResultScreen screen;
    screen.setResult(result_);
    auto* const table = screen.findChild<QTreeWidget*>();
    QVERIFY(table->topLevelItem(0)->isExpanded());
    QVERIFY(!table->topLevelItem(1)->isExpanded());
    table->topLevelItem(1)->setExpanded(true);
    screen.setReference(truth_, "truth.yaml");
    QVERIFY(table->topLevelItem(1)->isExpanded());  // as the user chose
    QVERIFY(table->topLevelItem(2)->text(0).contains("differences up to"));
  }

  void repairOfTheFirstReason_isOffered() {
    ResultScreen screen;
    auto* const button = screen.findChild<RepairButton*>();
    const auto show = [&](const std::optional<Repair>& repair) {
      auto doubtful = std::make_shared<CalibrationResult>(*result_.result);
      doubtful->status = CalibrationStatus::Doubtful;
      doubtful->reason = "left_imu: the gyroscope seems to be turned";
      doubtful->repair = repair;
      NamedResult named = result_;
      named.result = doubtful;
      screen.setResult(named);
    };
    show({});
    QVERIFY(button->isHidden());
    const Repair repair{"optimisation.model.gyroscope_rotation", "true"};
    show(repair);
    QVERIFY(!button->isHidden());
    QCOMPARE(button->text(), QString("Set gyroscope_rotation to true and calibrate again"));
    std::optional<Repair> wanted;
    connect(&screen, &ResultScreen::repairRequested, this, [&](const Repair& asked) { wanted = asked; });
    button->click();
    QVERIFY(wanted == repair);
    screen.setResult(result_);
    QVERIFY(button->isHidden());
  }

  void texts_haveTwoDigitsOfTheSigma() {
    ParameterRow row{"a", "A", "mm", 12.34567, 0.0234, {}};
    QCOMPARE(row.valueText(), QString("12.346"));
    QCOMPARE(row.sigmaText(), QString("0.023"));
    QVERIFY(row.differenceText().isEmpty());
    row.difference = 0.0702;
    QCOMPARE(row.differenceText(), QString("+0.070"));
    QCOMPARE(row.sigmasText(), QString("3.0"));
  }

  void comparisonWithTheTruth_isSmall() {
    std::vector<ParameterGroup> groups = parameterGroups(result_);
    compare(groups, result_, truth_);
    for (const char* const key : {"left.rotation.x", "left.rotation.y", "left.rotation.z"})
      QVERIFY(std::abs(find(groups, key)->difference.value()) < 0.3);  // deg, from 4 s
    QVERIFY(std::abs(find(groups, "left.time_offset")->difference.value()) < 0.5);
    QVERIFY(find(groups, "gravity")->difference.has_value());
  }

  void gravityNorm_hasARowWhereItIsFree() {
    std::vector<ParameterGroup> groups = parameterGroups(result_);
    const auto has = [&] {
      return std::any_of(groups.back().rows.begin(), groups.back().rows.end(),
                         [](const ParameterRow& row) { return row.key == "gravity.norm"; });
    };
    NamedResult free = result_;
    CalibrationResult& numbers = evical::test::ownResult(free);
    numbers.uncertainty.gravity_norm_std_m_s2 = 0.0;
    groups = parameterGroups(free);
    QVERIFY(!has());
    numbers.uncertainty.gravity_norm_std_m_s2 = 0.002;
    numbers.state.gravity_in_world_m_s2 *= 9.83 / numbers.state.gravity_in_world_m_s2.norm();
    groups = parameterGroups(free);
    QVERIFY(has());
    compare(groups, free, truth_);
    QVERIFY(std::abs(find(groups, "gravity.norm")->difference.value() - 0.02) < 0.01);
  }

  void comparisonWithItself_isZero_andWithOtherSensorsRefused() {
    std::vector<ParameterGroup> groups = parameterGroups(result_);
    compare(groups, result_, result_);
    QVERIFY(std::abs(find(groups, "left.rotation.x")->difference.value()) < 1e-9);
    NamedResult other = result_;
    other.reference = other.imus.at(0).name = "other_imu";
    other.imus.push_back({"second"});
    evical::test::ownResult(other).state.imus.emplace_back();
    QVERIFY_THROWS_EXCEPTION(CalibrationError, compare(groups, result_, other));
  }

  void screen_isEmptyFirst_thenShowsTheVerdict() {
    ResultScreen screen;
    screen.resize(1040, 660);
    screen.show();
    QVERIFY(allTextForResultScreen(screen).contains("No calibration yet"));
    screen.setResult(result_);
    QVERIFY(allTextForResultScreen(screen).contains("Calibrated"));
    QVERIFY(allTextForResultScreen(screen).contains("px RMS"));
    screen.setOutdated(true);
    QVERIFY(allTextForResultScreen(screen).contains("has changed"));
  }

  void reference_addsItsColumns_andOtherSensorsAreExplained() {
    ResultScreen screen;
    screen.setResult(result_);
    auto* const table = screen.findChild<QTreeWidget*>();
    QVERIFY(table->isColumnHidden(4));
    screen.resize(1040, 660);
    screen.show();
    QApplication::processEvents();
    for (int group = 0; group < table->topLevelItemCount(); ++group)
      table->topLevelItem(group)->setExpanded(true);
    for (int group = 1; group < table->topLevelItemCount(); ++group)
      table->topLevelItem(group)->setExpanded(false);
    QCOMPARE(static_cast<QTreeView*>(table)->horizontalScrollBar()->maximum(),
             0);  // folded rows need no space
    screen.setReference(truth_, "truth.yaml");
    QCOMPARE(screen.findChild<QComboBox*>("against")->currentText(), QString("truth.yaml"));
    QVERIFY(!table->isColumnHidden(4));
    // The only camera and the only IMU are compared, with any names.
    NamedResult other = truth_;
    other.cameras.at(0).name = "right";
    other.reference = other.imus.at(0).name = "other_imu";
    screen.setReference(other, "other.yaml");
    QVERIFY(!table->isColumnHidden(4));
    const QString text = allTextForResultScreen(screen);
    QVERIFY2(text.contains("compared with 'right'") && text.contains("compared with 'other_imu'"),
             qPrintable(text));
    other.imus.push_back({"second"});
    evical::test::ownResult(other).state.imus.emplace_back();
    screen.setReference(other, "other.yaml");
    QVERIFY(table->isColumnHidden(4));
    QVERIFY(allTextForResultScreen(screen).contains("cannot be compared"));
  }

  void correlation_namesItsStrongestPair() {
    CorrelationView view;
    view.resize(500, 500);
    NamedResult named;
    named.cameras = {{"left"}};
    UncertaintyReport& report = evical::test::ownResult(named).uncertainty;
    for (const QuantityId id :
         {QuantityId::TimeOffset, QuantityId::LineDelay, QuantityId::EdgeLocalisationBias})
      report.columns.push_back({QuantityOwner::Camera, 0, id});
    Eigen::MatrixXd& correlation = report.correlation;
    correlation.setIdentity(3, 3);
    correlation(0, 2) = correlation(2, 0) = -0.9;
    correlation(0, 1) = correlation(1, 0) = 0.2;
    view.setResult(named);
    QCOMPARE(view.strongestPairs(1),
             QStringList{"left: time offset and left: edge localisation bias: -0.90"});
    const QImage picture = view.grab().toImage();
    // Bottom left cell: a with c, blue; the diagonal red.
    const QPoint blue = view.cellMiddle(2, 0), red = view.cellMiddle(0, 0);
    QVERIFY(picture.pixelColor(blue).blue() > picture.pixelColor(blue).red() + 60);
    QVERIFY(picture.pixelColor(red).red() > picture.pixelColor(red).blue() + 60);
    QCOMPARE(view.textAt(blue), QString("left: edge localisation bias and left: time offset: -0.900"));
    QVERIFY(view.textAt(QPoint(2, 2)).isEmpty());
    QTest::mouseClick(&view, Qt::LeftButton, {}, blue);
    QCOMPARE(view.pinnedText(), view.textAt(blue));
    QVERIFY(view.grab().toImage() != picture);
    QTest::mouseClick(&view, Qt::LeftButton, {}, red);
    QCOMPARE(view.pinnedText(), view.textAt(red));
    QTest::mouseClick(&view, Qt::LeftButton, {}, red);
    QVERIFY(view.pinnedText().isEmpty());
    QCOMPARE(view.grab().toImage(), picture);
  }

  // 210 quantities with 70 names, as of a rig with four cameras and two IMUs.
  void correlation_ofALargeRig_isPaintedAtOnce() {
    CorrelationView view;
    view.resize(700, 700);
    NamedResult named;
    UncertaintyReport& report = evical::test::ownResult(named).uncertainty;
    constexpr int kCameras = 35;
    for (int k = 0; k < kCameras; ++k) {
      named.cameras.push_back({"camera_" + std::to_string(k)});
      for (const QuantityId id : {QuantityId::Rotation, QuantityId::Translation})
        for (std::size_t part = 0; part < 3; ++part)
          report.columns.push_back({QuantityOwner::Camera, static_cast<std::size_t>(k), id, part});
    }
    const auto count = static_cast<Eigen::Index>(report.columns.size());
    report.correlation = Eigen::MatrixXd::Constant(count, count, 0.5);
    view.setResult(named);
    view.show();
    QVERIFY(QTest::qWaitForWindowExposed(&view));
    const auto paint_ms = [&](const auto& act) {
      const evical::ui::test::ComputedTime since;
      act();
      QCoreApplication::sendPostedEvents();
      QCoreApplication::processEvents();
      return since.elapsed_ms();
    };
    const double whole_ms = paint_ms([&] { view.repaint(); });
    QVERIFY2(whole_ms < 100.0 * evical::ui::test::slowness(),
             qPrintable(QString("%1 ms for all").arg(whole_ms)));
    const double cell_ms = paint_ms([&] { QTest::mouseMove(&view, view.cellMiddle(100, 50)); });
    QVERIFY2(cell_ms < 30.0 * evical::ui::test::slowness(),
             qPrintable(QString("%1 ms for a cell").arg(cell_ms)));
  }

  void observability_isSaidInWords() {
    ObservabilityView view;
    QVERIFY(view.text().contains("No calibration"));
    view.setObservability({0.25, 4.0, 100.0}, {"translation along the camera's z axis"});
    QVERIFY(view.text().contains("camera's z axis"));
    QVERIFY(view.text().contains("0.5 times"));
    QVERIFY(view.text().contains("1 of 3"));
    view.setObservability({4.0}, {"rotation"});
    QVERIFY(view.text().contains("the needed accuracy"));
    view.setObservability({}, {});
    QVERIFY(view.text().contains("were given"));
  }
};

EVICAL_TEST(TestResultScreen)
#include "tst_result_screen.moc"
