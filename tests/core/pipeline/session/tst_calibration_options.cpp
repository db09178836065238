#include "core/frontend/detection_options.h"
#include "core/initialisation/initialisation_options.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/session/calibration_options.h"

#include "core/pipeline/session/option_pages.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <tuple>

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
      const std::string name(nameInTables(row.name));
      groups.insert(name.substr(0, name.rfind('.')));
      QCOMPARE(name != row.name, row.level == Level::Tuning);
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
    QCOMPARE(options.optimisation->threads, 7);
    QCOMPARE(options.optimisation->needed_rotation_deg, 0.25);
    const std::vector<OptionRow> differing = differingOptions(options);
    QCOMPARE(differing.size(), std::size_t(2));
    QCOMPARE(differing[0].name, std::string("optimisation.solver.threads"));
    QCOMPARE(differing[1].name, std::string("optimisation.verdict.needed_rotation_deg"));
  }

  void namesInPartsOfAGroup_areUniqueInTheWhole() {
    std::set<std::string> names;
    for (const OptionRow& row : optionRows())
      if (nameInTables(row.name).starts_with("optimisation."))
        QVERIFY2(names.insert(row.name.substr(row.name.rfind('.'))).second, row.name.c_str());
    QVERIFY(names.size() > 40);
  }

  void someOptionsAreForEveryone_someForExperts_mostForTuning() {
    std::map<Level, int> counts;
    for (const OptionRow& row : optionRows()) ++counts[row.level];
    for (const auto& [level, least, most] :
         {std::tuple(Level::Public, 24, 48), std::tuple(Level::Expert, 50, 80)})
      QVERIFY2(counts[level] >= least && counts[level] <= most, std::to_string(counts[level]).c_str());
    QCOMPARE(documentedOptions().size(),
             static_cast<std::size_t>(counts[Level::Public] + counts[Level::Expert]));
  }

  void tuning_isSetByItsPrefixOnly() {
    CalibrationOptions options;
    setOption(options, "tuning.optimisation.max_rounds", "3");  // without the middle part
    QCOMPARE(options.optimisation->max_rounds, 3);
    QCOMPARE(differingOptions(options)[0].name, std::string("tuning.optimisation.solver.max_rounds"));
    for (const auto& [name, other] : {std::pair("grid.min_sine", "tuning.grid.min_sine"),
                                      std::pair("optimisation.max_rounds", "tuning.optimisation.max_rounds"),
                                      std::pair("tuning.grid.min_circles", "Write grid.min_circles")}) {
      try {
        setOption(options, name, "9");
        QFAIL("must throw");
      } catch (const CalibrationError& error) {
        QVERIFY2(QString(error.advice().c_str()).contains(other), error.what());
      }
    }
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
    add("detection.min_window_s", "0.1", "detection.max_window_s", "0.005");
    add("tuning.detection.search_interval_s", "2", "tuning.detection.max_search_interval_s", "1");
    add("tuning.bursts.min_gap_s", "0.1", "tuning.bursts.max_gap_s", "0.05");
    add("detection.min_radius_px", "90", "detection.max_radius_px", "80");
    add("tuning.moving_circle.last_gate_px", "3", "tuning.moving_circle.first_gate_px", "2");
    add("tuning.grid.min_step_radii", "6", "tuning.grid.max_step_radii", "5");
    add("tuning.tracking.last_gate_px", "3.5", "tuning.tracking.first_gate_px", "3");
    add("tuning.tracking.min_polarity_cosine", "0.9", "tuning.tracking.full_polarity_cosine", "0.1");
    add("tuning.tracking.min_event_part", "0.9", "tuning.tracking.full_event_part", "0.1");
    add("tuning.intrinsics.first_look_length_s", "2", "tuning.intrinsics.first_look_period_s", "1");
    add("intrinsics.min_views", "90", "intrinsics.max_views", "80");
    add("tuning.initialisation.pair_gap_s", "0.4", "tuning.initialisation.max_pair_s", "0.3");
    add("tuning.initialisation.min_acceleration_m_s2", "50", "tuning.initialisation.max_acceleration_m_s2",
        "40");
    add("tuning.initialisation.min_rotation_rate_rad_s", "5", "tuning.initialisation.max_rotation_rate_rad_s",
        "4");
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
    QTest::newRow("option") << "grid.min_circle"
                            << "min_circles";
    QTest::newRow("group") << "gird.min_circles"
                           << "grid.min_circles";
    QTest::newRow("no group") << "min_circles"
                              << "grid.min_circles";
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
    for (const Level least : {Level::Public, Level::Expert, Level::Tuning}) {
      const std::string text = optionText(least);
      for (const OptionRow& row : optionRows())
        QVERIFY2((text.find(row.name + " ") != std::string::npos) == (row.level >= least), row.name.c_str());
    }
    QVERIFY(optionText(Level::Public).find("evical options --all") != std::string::npos);
  }

  void pages_nameEveryOption_butThoseOfTuning() {
    const std::string text = optionMarkdown(), yaml = optionYaml();
    for (const OptionRow& row : documentedOptions())
      QVERIFY2(text.find("`" + row.name + "`") != std::string::npos, row.name.c_str());
    QVERIFY(std::count(text.begin(), text.end(), '\n') <= 150);
    for (const std::string& page : {text, yaml})
      for (const char* const tuned : {"tuning", "min_sine", "egomotion"})
        QVERIFY2(page.find(tuned) == std::string::npos, tuned);
  }
};

EVICAL_TEST(TestCalibrationOptions)
#include "tst_calibration_options.moc"
