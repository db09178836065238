#include "core/pipeline/calibration_options.h"
#include "tests/support/test_program.h"

#include <charconv>
#include <set>

using namespace evical;

namespace {

double number(const std::string& text) {
  double value = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

class TestCalibrationOptions : public QObject {
  Q_OBJECT

 private slots:
  void defaults_lieInTheirRanges() {
    for (const OptionRow& row : optionRows()) {
      QCOMPARE(row.value, row.default_value);
      if (row.choices.empty()) {
        QVERIFY2(number(row.minimum) < number(row.maximum), row.name.c_str());
        QVERIFY2(number(row.value) >= number(row.minimum), row.name.c_str());
        QVERIFY2(number(row.value) <= number(row.maximum), row.name.c_str());
      } else {
        QVERIFY2(std::find(row.choices.begin(), row.choices.end(), row.value) != row.choices.end(),
                 row.name.c_str());
      }
      QVERIFY2(row.help.size() > 8 && row.help.back() == '.', row.name.c_str());
    }
  }

  void names_areUnique_andEveryGroupHasSome() {
    std::set<std::string> names, groups;
    for (const OptionRow& row : optionRows()) {
      QVERIFY2(names.insert(row.name).second, row.name.c_str());
      groups.insert(row.name.substr(0, row.name.find('.')));
    }
    const std::vector<std::string> known = optionGroups();
    QCOMPARE(groups, std::set<std::string>(known.begin(), known.end()));
  }

  void everyOption_canBeSet_andDiffers() {
    for (const OptionRow& row : optionRows()) {
      CalibrationOptions options;
      std::string other = row.choices.empty() ? row.maximum : row.choices.front();
      if (other == row.default_value) other = row.choices.empty() ? row.minimum : row.choices.back();
      setOption(options, row.name, other);
      const std::vector<OptionRow> differing = differingOptions(options);
      QCOMPARE(differing.size(), std::size_t(1));
      QCOMPARE(differing[0].name, row.name);
      QCOMPARE(differing[0].value, other);
      QVERIFY2(options != CalibrationOptions{}, row.name.c_str());
    }
  }

  void unknownName_isRefusedWithTheNearest_data() {
    QTest::addColumn<QString>("name");
    QTest::addColumn<QString>("nearest");
    QTest::newRow("option") << "grid.least_circle"
                            << "least_circles";
    QTest::newRow("group") << "gird.least_circles"
                           << "grid.least_circles";
    QTest::newRow("no group") << "least_circles"
                              << "grid.least_circles";
  }
  void unknownName_isRefusedWithTheNearest() {
    QFETCH(QString, name);
    QFETCH(QString, nearest);
    CalibrationOptions options;
    try {
      setOption(options, name.toStdString(), "7");
      QFAIL("must throw");
    } catch (const CalibrationError& error) {
      QVERIFY2(QString(error.what()).contains("'" + nearest + "'"), error.what());
    }
  }

  void markdown_namesEveryOption() {
    const std::string text = optionMarkdown();
    for (const OptionRow& row : optionRows())
      QVERIFY2(text.find("`" + row.name + "`") != std::string::npos, row.name.c_str());
  }
};

EVICAL_TEST(TestCalibrationOptions)
#include "tst_calibration_options.moc"
