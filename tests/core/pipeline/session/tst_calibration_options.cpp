#include "core/pipeline/session/calibration_options.h"

#include "core/pipeline/session/option_pages.h"
#include "tests/support/test_program.h"

#include <algorithm>
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
      groups.insert(row.name.substr(0, row.name.rfind('.')));
    }
    std::set<std::string> known;
    for (const OptionSection& section : optionSections()) known.insert(section.name);
    QCOMPARE(groups, known);
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

  void middlePartOfAName_mayBeLeftOut() {
    CalibrationOptions options;
    setOption(options, "optimisation.threads", "7");
    setOption(options, "optimisation.needed_rotation_deg", "0.25");
    QCOMPARE(options.optimisation.threads, 7);
    QCOMPARE(options.optimisation.needed_rotation_deg, 0.25);
    const std::vector<OptionRow> differing = differingOptions(options);
    QCOMPARE(differing.size(), std::size_t(2));
    QCOMPARE(differing[0].name, std::string("optimisation.solver.threads"));
    QCOMPARE(differing[1].name, std::string("optimisation.verdict.needed_rotation_deg"));
  }

  void namesInPartsOfAGroup_areUniqueInTheWhole() {
    std::set<std::string> names;
    for (const OptionRow& row : optionRows())
      if (row.name.starts_with("optimisation."))
        QVERIFY2(names.insert(row.name.substr(row.name.rfind('.'))).second, row.name.c_str());
    QVERIFY(names.size() > 40);
  }

  void someOptionsAreForEveryone_mostForExperts() {
    const std::vector<OptionRow> rows = optionRows();
    const auto common =
        std::count_if(rows.begin(), rows.end(), [](const OptionRow& row) { return !row.expert; });
    QVERIFY2(common >= 24 && common <= 48, std::to_string(common).c_str());
  }

  void optionsThatExcludeEachOther_areRefused_data() {
    QTest::addColumn<QString>("lower");
    QTest::addColumn<QString>("lower_value");
    QTest::addColumn<QString>("upper");
    QTest::addColumn<QString>("upper_value");
    const auto add = [](const char* lower, const char* lower_value, const char* upper,
                        const char* upper_value) {
      QTest::newRow(lower) << lower << lower_value << upper << upper_value;
    };
    add("detection.shortest_window_s", "0.1", "detection.longest_window_s", "0.005");
    add("detection.search_interval_s", "2", "detection.longest_search_interval_s", "1");
    add("bursts.shortest_gap_s", "0.1", "bursts.longest_gap_s", "0.05");
    add("detection.smallest_radius_px", "90", "detection.largest_radius_px", "80");
    add("moving_circle.last_gate_px", "3", "moving_circle.first_gate_px", "2");
    add("grid.shortest_step_radii", "6", "grid.longest_step_radii", "5");
    add("tracking.last_gate_px", "3.5", "tracking.first_gate_px", "3");
    add("tracking.least_polarity_cosine", "0.9", "tracking.full_polarity_cosine", "0.1");
    add("tracking.least_event_part", "0.9", "tracking.full_event_part", "0.1");
    add("intrinsics.first_look_length_s", "2", "intrinsics.first_look_period_s", "1");
    add("intrinsics.least_views", "90", "intrinsics.most_views", "80");
    add("initialisation.pair_gap_s", "0.4", "initialisation.longest_pair_s", "0.3");
    add("initialisation.least_acceleration_m_s2", "50", "initialisation.largest_acceleration_m_s2", "40");
    add("initialisation.least_rotation_rate_rad_s", "5", "initialisation.largest_rotation_rate_rad_s", "4");
  }
  void optionsThatExcludeEachOther_areRefused() {
    QFETCH(QString, lower);
    QFETCH(QString, lower_value);
    QFETCH(QString, upper);
    QFETCH(QString, upper_value);
    CalibrationOptions options;
    validate(options);
    setOption(options, lower.toStdString(), lower_value.toStdString());
    setOption(options, upper.toStdString(), upper_value.toStdString());
    try {
      validate(options);
      QFAIL("must throw");
    } catch (const OptionConflict& conflict) {
      QVERIFY(conflict.kind() == ErrorKind::BadInput);
      const QString text = conflict.what();
      for (const QString& part :
           {lower, lower_value, upper, upper_value, QString("at most"), QString("at least")})
        QVERIFY2(text.contains(part), conflict.what());
    }
    setOption(options, lower.toStdString(), upper_value.toStdString());
    validate(options);
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
    QTest::newRow("part of a group") << "optimisation.solver.thread"
                                     << "threads";
    QTest::newRow("part left out") << "optimisation.thread"
                                   << "optimisation.solver.threads";
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

  void text_namesWhatPeopleTurn_andTheRestIfAsked() {
    const std::string common = optionText(false), all = optionText(true);
    for (const OptionRow& row : optionRows()) {
      QVERIFY2((common.find(row.name + " ") != std::string::npos) == !row.expert, row.name.c_str());
      QVERIFY2(all.find(row.name + " ") != std::string::npos, row.name.c_str());
    }
    QVERIFY(common.find("evical options --all") != std::string::npos);
  }

  void markdown_namesEveryOption() {
    const std::string text = optionMarkdown();
    for (const OptionRow& row : optionRows())
      QVERIFY2(text.find("`" + row.name + "`") != std::string::npos, row.name.c_str());
  }
};

EVICAL_TEST(TestCalibrationOptions)
#include "tst_calibration_options.moc"
