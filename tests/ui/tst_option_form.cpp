// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/option_form.h"

#include "core/base/error.h"
#include "core/frontend/detection_options.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/session/calibration_options.h"
#include "tests/support/test_program.h"
#include "tests/ui/screenshots.h"
#include "ui/forms/option_editor.h"
#include "ui/theme/theme.h"

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QScrollArea>
#include <QSignalSpy>
#include <QToolButton>

using namespace evical;
using namespace evical::ui;

namespace {

// A form for options, connected to the document like in the window.
struct OptionFormFixture {
  CalibrationOptions options;
  OptionForm form;
  QSignalSpy edited{&form, &OptionForm::edited};

  OptionFormFixture() {
    form.resize(340, 700);
    form.setRows(documentedOptions(options));
    QObject::connect(&form, &OptionForm::edited, &form, [this](const QString& name, const QString& value) {
      try {
        CalibrationOptions changed = options;
        setOption(changed, name.toStdString(), value.toStdString());
        validate(changed);
        options = changed;
        form.setRows(documentedOptions(options));
      } catch (const CalibrationError& error) {
        form.showRefusal(name, error);
      }
    });
    form.show();
  }
  QLineEdit* field(const QString& name) { return form.editor(name)->findChild<QLineEdit*>(); }
  void type(const QString& name, const QString& value) {
    field(name)->selectAll();
    QTest::keyClicks(field(name), value);
    QTest::keyClick(field(name), Qt::Key_Return);
  }
  QLineEdit* search() { return form.findChild<QLineEdit*>(QString(), Qt::FindDirectChildrenOnly); }
  QString allText(const QString& name) {
    QString all;
    for (const QLabel* const label : form.editor(name)->findChildren<QLabel*>()) all += label->text() + "\n";
    return all;
  }
};

}  // namespace

class TestOptionForm : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() { applyTheme(*qApp, Appearance::Light); }

  void everyOption_hasAnEditorWithHelpUnitAndRange() {
    OptionFormFixture test;
    test.form.showExpert(true);
    const std::vector<OptionRow> rows = documentedOptions();
    for (const OptionRow& row : rows) {
      const QString name = QString::fromStdString(row.name);
      QVERIFY2(test.form.editor(name), qPrintable(name));
      const QString text = test.allText(name);
      const QString help =
          QString::fromStdString(row.help);  // tool tips are HTML, in which quotes are escaped
      QVERIFY2(text.contains(help) || text.contains(help.toHtmlEscaped()), qPrintable(name));
      QVERIFY2(row.choices.size() > 0 || text.contains(QString::fromStdString(row.maximum)),
               qPrintable(name));
      QVERIFY(test.form.editor(name)->toolTip().contains(name));
    }
    QCOMPARE(test.form.shownOptions().size(), static_cast<qsizetype>(rows.size()));
  }

  void typedNumber_isSaid_andMarkedAsChanged() {
    OptionFormFixture test;
    test.type("grid.min_circles", "9");
    QCOMPARE(test.edited.count(), 1);
    QCOMPARE(test.options.front_end->grid.min_circles, 9);
    QVERIFY(test.form.editor("grid.min_circles")->isChanged());
  }

  void numberOutOfRange_isRefusedNextToTheField_untilItIsMended() {
    OptionFormFixture test;
    const int before = test.options.front_end->grid.min_circles;
    test.type("grid.min_circles", "-3");
    QCOMPARE(test.options.front_end->grid.min_circles, before);
    QVERIFY(test.allText("grid.min_circles").contains("below the minimum"));
    QVERIFY(test.allText("grid.min_circles").contains(QString("It stays at %1").arg(before)));
    QCOMPARE(test.field("grid.min_circles")->text(), QString::number(before));
    test.type("grid.min_circles", "banana");
    QVERIFY(test.allText("grid.min_circles").contains("'banana' is not a whole number"));
    QCOMPARE(test.field("grid.min_circles")->text(), QString::number(before));
    test.type("grid.min_circles", "9");
    QVERIFY(!test.allText("grid.min_circles").contains("below the minimum"));
    QCOMPARE(test.options.front_end->grid.min_circles, 9);
  }

  void slider_turnsTheNumber_andIsTurnedByIt() {
    OptionFormFixture test;
    auto* const slider = test.form.editor("detection.window_travel_px")->findChild<OptionSlider*>();
    slider->setValue(slider->maximum());
    QCOMPARE(test.options.front_end->detection.window_travel_px, 20.0);
    QCOMPARE(test.field("detection.window_travel_px")->text(), QString("20"));
    slider->setValue(slider->minimum());
    QCOMPARE(test.options.front_end->detection.window_travel_px, 0.5);
    const int before = slider->value();
    test.type("detection.window_travel_px", "10");
    QVERIFY(slider->value() > before);
    QCOMPARE(test.options.front_end->detection.window_travel_px, 10.0);
  }

  void slider_ofWholeNumbersHasNoOthers_andOfSeveralPowersStepsInPowers() {
    OptionFormFixture test;
    auto* const whole = test.form.editor("intrinsics.radtan_coefficients")->findChild<OptionSlider*>();
    QCOMPARE(whole->maximum() - whole->minimum(), 1);
    auto* const powers =
        test.form.editor("optimisation.priors.smooth_rotation_rad_s2")->findChild<OptionSlider*>();
    powers->setValue(powers->maximum() / 2);  // the geometric middle of 0.1 and 1 000 000
    QVERIFY(std::abs(test.options.optimisation->smooth_rotation_rad_s2 / 316.0 - 1.0) < 0.01);
    for (const OptionRow& row : documentedOptions()) {
      if (const auto* const slider =
              test.form.editor(QString::fromStdString(row.name))->findChild<OptionSlider*>())
        QVERIFY2(slider->minimum() < slider->maximum(), row.name.c_str());
    }
  }

  // Every position of every slider is a valid value of the option.
  void slider_endsAreWithinTheRange() {
    OptionFormFixture test;
    for (const OptionRow& row : documentedOptions()) {
      auto* const slider = test.form.editor(QString::fromStdString(row.name))->findChild<OptionSlider*>();
      if (slider == nullptr) continue;
      for (const int position : {slider->maximum(), slider->minimum()}) {
        slider->setValue(position);
        QVERIFY2(!test.allText(QString::fromStdString(row.name)).contains("below the minimum"),
                 row.name.c_str());
        QVERIFY2(!test.allText(QString::fromStdString(row.name)).contains("above the maximum"),
                 row.name.c_str());
      }
      test.options = {};
      test.form.setRows(documentedOptions(test.options));
    }
  }

  void searchedWords_standOut() {
    OptionFormFixture test;
    QTest::keyClicks(test.search(), "min circ");
    QVERIFY(test.allText("grid.min_circles").contains("background-color"));
    test.search()->clear();
    QVERIFY(!test.allText("grid.min_circles").contains("background-color"));
  }

  void optionWithoutEffect_saysWhy() {
    OptionFormFixture test;
    test.form.setIdle({{"grid.min_circles", "there is no board"}});
    QVERIFY(test.allText("grid.min_circles").contains("No effect here: there is no board."));
    test.form.setIdle({});
    QVERIFY(!test.allText("grid.min_circles").contains("No effect"));
  }

  void optionThatAnotherExcludes_isRefusedNextToBoth_untilOneIsMended() {
    OptionFormFixture test;
    const QString lower = "detection.min_window_s", upper = "detection.max_window_s";
    const QString said = "detection.min_window_s (0.1 s) is above detection.max_window_s (0.05 s)";
    test.type(lower, "0.1");
    QCOMPARE(test.options, CalibrationOptions{});
    QVERIFY(test.field(lower)->text() != QString("0.1"));
    for (const QString& name : {lower, upper}) QVERIFY2(test.allText(name).contains(said), qPrintable(name));
    test.type(upper, "0.15");  // accepted, since the value that was refused does not count
    for (const QString& name : {lower, upper}) QVERIFY2(!test.allText(name).contains(said), qPrintable(name));
    test.type(lower, "0.1");
    QCOMPARE(test.options.front_end->detection.min_window_s, 0.1);
    QVERIFY(!test.allText(lower).contains(said));
    test.type(upper, "0.05");
    QVERIFY(test.allText(lower).contains(said));
    test.type(upper, "0.15");  // the value in use
    for (const QString& name : {lower, upper}) QVERIFY2(!test.allText(name).contains(said), qPrintable(name));
    test.type(upper, "0.05");
    test.type(upper, "7");  // a separate mistake
    QVERIFY(!test.allText(lower).contains(said));
    QVERIFY(test.allText(upper).contains("above the maximum"));
  }

  void resetThatAnotherExcludes_isRefusedNextToBoth() {
    OptionFormFixture test;
    test.type("detection.max_window_s", "0.15");
    test.type("detection.min_window_s", "0.1");
    QTest::mouseClick(test.form.editor("detection.max_window_s")->findChild<QToolButton*>(), Qt::LeftButton);
    QCOMPARE(test.options.front_end->detection.max_window_s, 0.15);
    for (const QString name : {"detection.min_window_s", "detection.max_window_s"})
      QVERIFY2(test.allText(name).contains("is above"), qPrintable(name));
  }

  void expertOptions_areShownWhenAskedFor() {
    OptionFormFixture test;
    QStringList common, all;
    for (const OptionRow& row : documentedOptions()) {
      all << QString::fromStdString(row.name);
      if (row.level == Level::Public) common << all.last();
    }
    QCOMPARE(test.form.shownOptions(), common);
    auto* const button = test.form.findChild<QToolButton*>("expert");
    QVERIFY(button);
    QCOMPARE(button->text(), QString("More options (%1)").arg(all.size() - common.size()));
    QTest::mouseClick(button, Qt::LeftButton);
    QCOMPARE(test.form.shownOptions(), all);
    QCOMPARE(button->text(), QString("Fewer options"));
    QTest::mouseClick(button, Qt::LeftButton);
    QCOMPARE(test.form.shownOptions(), common);
  }

  void expertOption_thatIsChangedOrSearchedFor_isShown() {
    OptionFormFixture test;
    QVERIFY(!test.form.shownOptions().contains("grid.min_partial"));
    test.search()->setText("min_partial");
    QCOMPARE(test.form.shownOptions(), QStringList{"grid.min_partial"});
    test.search()->clear();
    QVERIFY(!test.form.shownOptions().contains("grid.min_partial"));
    setOption(test.options, "grid.min_partial", "0.5");
    test.form.setRows(documentedOptions(test.options));
    QVERIFY(test.form.shownOptions().contains("grid.min_partial"));
  }

  void reset_bringsTheDefaultBack() {
    OptionFormFixture test;
    const int before = test.options.front_end->grid.min_circles;
    test.type("grid.min_circles", "9");
    OptionEditor* const editor = test.form.editor("grid.min_circles");
    QTest::mouseClick(editor->findChild<QToolButton*>(), Qt::LeftButton);
    QCOMPARE(test.options.front_end->grid.min_circles, before);
    QVERIFY(!editor->isChanged());
    QCOMPARE(test.field("grid.min_circles")->text(), QString::number(before));
  }

  void switchesAndChoices_areBoxes() {
    OptionFormFixture test;
    int switches = 0, choices = 0;
    for (const OptionRow& row : documentedOptions()) {
      OptionEditor* const editor = test.form.editor(QString::fromStdString(row.name));
      if (row.choices == std::vector<std::string>{"false", "true"}) {
        ++switches;
        QCOMPARE(editor->findChild<QCheckBox*>()->isChecked(), row.value == "true");
      } else if (!row.choices.empty()) {
        ++choices;
        QCOMPARE(editor->findChild<QComboBox*>()->count(), static_cast<int>(row.choices.size()));
      }
    }
    QVERIFY(switches > 0 && choices > 0);
  }

  void search_leavesWhatMatchesInNameOrHelp() {
    OptionFormFixture test;
    test.form.showExpert(true);
    QTest::keyClicks(test.search(), "min circles");
    QVERIFY(test.form.shownOptions().contains("grid.min_circles"));
    QVERIFY(test.form.shownOptions().size() < 8);
    test.search()->setText("zzz nothing has this");
    QVERIFY(test.form.shownOptions().isEmpty());
    test.search()->clear();
    QCOMPARE(test.form.shownOptions().size(), static_cast<qsizetype>(documentedOptions().size()));
  }

  void rowsFromElsewhere_areShown() {
    OptionFormFixture test;
    setOption(test.options, "grid.min_circles", "11");
    test.form.setRows(documentedOptions(test.options));
    QCOMPARE(test.field("grid.min_circles")->text(), QString("11"));
    QCOMPARE(test.edited.count(), 0);
  }

  void names_loseTheirGroupAndUnit() {
    OptionRow row;
    row.name = "normal_flow.plane_radius_px";
    row.unit = "px";
    QCOMPARE(OptionEditor::shownName(row), QString("plane radius"));
  }

  void form_looksAsItShould_data() {
    QTest::addColumn<bool>("dark");
    QTest::addColumn<bool>("expert");
    QTest::newRow("light") << false << false;
    QTest::newRow("dark") << true << false;
    QTest::newRow("dark_expert") << true << true;
  }
  void form_looksAsItShould() {
    QFETCH(bool, dark);
    QFETCH(bool, expert);
    applyTheme(*qApp, dark ? Appearance::Dark : Appearance::Light);
    OptionFormFixture test;
    test.form.showExpert(expert);
    for (QToolButton* const heading : test.form.findChildren<QToolButton*>("group"))
      if (heading->text() == "Detection" || heading->text().contains("solver")) heading->setChecked(true);
    test.type("detection.min_window_s", "0.1");
    QTest::qWait(50);
    QVERIFY(test.form.minimumSizeHint().width() <= 340);
    QVERIFY(test.form.grab().save(
        evical::ui::test::screenshotPath("option_form_%1.png").arg(QTest::currentDataTag())));
    applyTheme(*qApp, Appearance::Light);
  }

  void everyOption_isWholeAtTheMinimumWidth() {
    OptionFormFixture test;
    test.form.showExpert(true);
    for (QToolButton* const heading : test.form.findChildren<QToolButton*>("group"))
      heading->setChecked(true);
    test.form.resize(test.form.minimumWidth(), 700);
    QTest::qWait(50);
    const int room_px = test.form.findChild<QScrollArea*>()->viewport()->width();
    for (const OptionRow& row : documentedOptions()) {
      const OptionEditor* const editor = test.form.editor(QString::fromStdString(row.name));
      const int end_px = editor->mapTo(editor->window(), QPoint(editor->width(), 0)).x();
      QVERIFY2(editor->isVisible() && end_px <= room_px + 8, row.name.c_str());
      QVERIFY2(editor->minimumSizeHint().width() <= editor->width(), row.name.c_str());
    }
  }

  void form_fitsIntoItsDock() {
    OptionFormFixture test;
    test.search()->setText("circle");
    QTest::qWait(50);
    QVERIFY(test.form.minimumSizeHint().width() <= 340);
    QVERIFY(test.form.grab().save(evical::ui::test::screenshotPath("option_form.png")));
  }
};

EVICAL_TEST(TestOptionForm)
#include "tst_option_form.moc"
