// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/option_form.h"

#include "core/base/error.h"
#include "core/pipeline/calibration_options.h"
#include "tests/support/test_program.h"
#include "ui/forms/option_editor.h"
#include "ui/theme/theme.h"

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QSignalSpy>
#include <QToolButton>

using namespace evical;
using namespace evical::ui;

namespace {

// A form over options, as the window wires it to the document.
struct Fixture {
  CalibrationOptions options;
  OptionForm form;
  QSignalSpy edited{&form, &OptionForm::edited};

  Fixture() {
    form.resize(340, 700);
    form.setRows(optionRows(options));
    QObject::connect(&form, &OptionForm::edited, &form, [this](const QString& name, const QString& value) {
      try {
        setOption(options, name.toStdString(), value.toStdString());
        form.setRows(optionRows(options));
      } catch (const CalibrationError& error) {
        form.showProblem(name, QString::fromStdString(error.problem()));
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
    Fixture test;
    const std::vector<OptionRow> rows = optionRows();
    for (const OptionRow& row : rows) {
      const QString name = QString::fromStdString(row.name);
      QVERIFY2(test.form.editor(name), qPrintable(name));
      const QString text = test.allText(name);
      QVERIFY2(text.contains(QString::fromStdString(row.help)), qPrintable(name));
      QVERIFY2(row.choices.size() > 0 || text.contains(QString::fromStdString(row.maximum)),
               qPrintable(name));
      QVERIFY(test.form.editor(name)->toolTip().contains(name));
    }
    QCOMPARE(test.form.shownOptions().size(), static_cast<qsizetype>(rows.size()));
  }

  void typedNumber_isSaid_andMarkedAsChanged() {
    Fixture test;
    test.type("grid.least_circles", "9");
    QCOMPARE(test.edited.count(), 1);
    QCOMPARE(test.options.front_end.grid.least_circles, 9);
    QVERIFY(test.form.editor("grid.least_circles")->isChanged());
  }

  void numberOutOfRange_isRefusedNextToTheField_untilItIsMended() {
    Fixture test;
    const int before = test.options.front_end.grid.least_circles;
    test.type("grid.least_circles", "-3");
    QCOMPARE(test.options.front_end.grid.least_circles, before);
    QVERIFY(test.allText("grid.least_circles").contains("below the least"));
    QCOMPARE(test.field("grid.least_circles")->text(), QString("-3"));
    test.type("grid.least_circles", "9");
    QVERIFY(!test.allText("grid.least_circles").contains("below the least"));
    QCOMPARE(test.options.front_end.grid.least_circles, 9);
  }

  void reset_bringsTheDefaultBack() {
    Fixture test;
    const int before = test.options.front_end.grid.least_circles;
    test.type("grid.least_circles", "9");
    OptionEditor* const editor = test.form.editor("grid.least_circles");
    QTest::mouseClick(editor->findChild<QToolButton*>(), Qt::LeftButton);
    QCOMPARE(test.options.front_end.grid.least_circles, before);
    QVERIFY(!editor->isChanged());
    QCOMPARE(test.field("grid.least_circles")->text(), QString::number(before));
  }

  void switchesAndChoices_areBoxes() {
    Fixture test;
    int switches = 0, choices = 0;
    for (const OptionRow& row : optionRows()) {
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
    Fixture test;
    QTest::keyClicks(test.search(), "least circles");
    QVERIFY(test.form.shownOptions().contains("grid.least_circles"));
    QVERIFY(test.form.shownOptions().size() < 8);
    test.search()->setText("zzz nothing has this");
    QVERIFY(test.form.shownOptions().isEmpty());
    test.search()->clear();
    QCOMPARE(test.form.shownOptions().size(), static_cast<qsizetype>(optionRows().size()));
  }

  void rowsFromElsewhere_areShown() {
    Fixture test;
    setOption(test.options, "grid.least_circles", "11");
    test.form.setRows(optionRows(test.options));
    QCOMPARE(test.field("grid.least_circles")->text(), QString("11"));
    QCOMPARE(test.edited.count(), 0);
  }

  void names_loseTheirGroupAndUnit() {
    OptionRow row;
    row.name = "normal_flow.plane_radius_px";
    row.unit = "px";
    QCOMPARE(OptionEditor::shownName(row), QString("plane radius"));
  }

  void form_fitsIntoItsDock() {
    Fixture test;
    test.search()->setText("circle");
    QTest::qWait(50);
    QVERIFY(test.form.minimumSizeHint().width() <= 340);
    QDir().mkpath(EVICAL_SCREENSHOTS);
    QVERIFY(test.form.grab().save(EVICAL_SCREENSHOTS "/option_form.png"));
  }
};

EVICAL_TEST(TestOptionForm)
#include "tst_option_form.moc"
