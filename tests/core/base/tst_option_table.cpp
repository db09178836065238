#include "core/base/option_table.h"

#include "tests/support/test_program.h"

using namespace evical;

namespace {

enum class Method { RingVote, NormalFlow };
struct SampleOptions {
  int radius_px;
  double error_s;
  bool quick;
  Method method;
  double min_part, max_part;
  int first, last;

  SampleOptions();
  constexpr explicit SampleOptions(NoDefaults) {}
  SampleOptions(int radius, double error, bool is_quick, Method from) : SampleOptions() {
    radius_px = radius;
    error_s = error;
    quick = is_quick;
    method = from;
  }
  bool operator==(const SampleOptions&) const = default;
};
constexpr std::tuple kSampleFields{
    Field{"radius_px", &SampleOptions::radius_px, 2, within(1, 5), "px", "Radius.", Level::Public,
          Applies::WithImu},
    Field{"error_s", &SampleOptions::error_s, 1e-3, within(1e-5, 1e-1), "s", "Error.", Level::Expert},
    Switch{"quick", &SampleOptions::quick, false, "Quick."},
    Choice{"method", &SampleOptions::method, Method::RingVote, std::array{"ring_vote", "normal_flow"},
           "Method."},
    Field{"min_part", &SampleOptions::min_part, 0.25, within(0.0, 1.0), "", "Least."},
    Field{"max_part", &SampleOptions::max_part, 0.5, within(0.0, 1.0), "", "Most."},
    Field{"first", &SampleOptions::first, 1, within(0, 9), "px", "First."},
    Field{"last", &SampleOptions::last, 1, within(0, 9), "px", "Last."}};
constexpr auto kSampleDefaults = defaultsOf<SampleOptions, kSampleFields>();
SampleOptions::SampleOptions() : SampleOptions(kSampleDefaults) {}

const OptionTable<SampleOptions> kTable(kSampleFields,
                                        Ordered{&SampleOptions::min_part, &SampleOptions::max_part},
                                        Ordered{&SampleOptions::first, &SampleOptions::last});

}  // namespace

class TestOptionTable : public QObject {
  Q_OBJECT

 private slots:
  void set_takesEveryKind() {
    SampleOptions options;
    kTable.set(options, "g", "radius_px", "5");
    kTable.set(options, "g", "error_s", "2e-2");
    kTable.set(options, "g", "quick", "true");
    kTable.set(options, "g", "method", "normal_flow");
    QVERIFY((options == SampleOptions{5, 2e-2, true, Method::NormalFlow}));
  }

  void set_refuses_data() {
    QTest::addColumn<QString>("name");
    QTest::addColumn<QString>("value");
    QTest::addColumn<QStringList>("said");
    QTest::newRow("too large") << "radius_px"
                               << "6" << QStringList{"g.radius_px", "6 px", "above", "5 px"};
    QTest::newRow("too small") << "error_s"
                               << "0" << QStringList{"g.error_s", "below", "1e-05 s"};
    QTest::newRow("not whole") << "radius_px"
                               << "1.5" << QStringList{"'1.5'", "whole number"};
    QTest::newRow("number and more") << "error_s"
                                     << "0.01s" << QStringList{"'0.01s'", "not a number"};
    QTest::newRow("empty") << "error_s"
                           << "" << QStringList{"not a number"};
    QTest::newRow("nan") << "error_s"
                         << "nan" << QStringList{"not a number"};
    QTest::newRow("switch") << "quick"
                            << "maybe" << QStringList{"'maybe'", "true or false"};
    QTest::newRow("choice") << "method"
                            << "ring_vot" << QStringList{"ring_vote, normal_flow", "Did you mean"};
    QTest::newRow("unknown") << "radius"
                             << "1" << QStringList{"g.radius", "radius_px"};
  }
  void set_refuses() {
    QFETCH(QString, name);
    QFETCH(QString, value);
    QFETCH(QStringList, said);
    SampleOptions options;
    try {
      kTable.set(options, "g", name.toStdString(), value.toStdString());
      QFAIL("must throw");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      for (const QString& part : said) QVERIFY2(QString(error.what()).contains(part), error.what());
    }
    QVERIFY(options == SampleOptions{});
  }

  void rows_sayWhatTheirTableSays() {
    const std::vector<OptionRow> rows = kTable.rows(SampleOptions{3, 1e-3, true, Method::NormalFlow}, "g");
    QCOMPARE(rows.size(), std::size_t(8));
    QCOMPARE(rows[0].name, std::string("g.radius_px"));
    QCOMPARE(rows[0].default_value, std::string("2"));
    QCOMPARE(rows[0].value, std::string("3"));
    QCOMPARE(rows[0].minimum, std::string("1"));
    QCOMPARE(rows[0].maximum, std::string("5"));
    QCOMPARE(rows[0].unit, std::string("px"));
    QVERIFY(rows[0].level == Level::Public && rows[0].applies == std::vector{Applies::WithImu});
    QVERIFY(rows[1].level == Level::Expert && rows[1].applies.empty());
    QVERIFY(rows[2].level == Level::Tuning);
    QCOMPARE(rows[2].name, std::string("tuning.g.quick"));
    QCOMPARE(rows[2].value, std::string("true"));
    QVERIFY((rows[3].choices == std::vector<std::string>{"ring_vote", "normal_flow"}));
  }

  void orderOfTwo_isChecked_data() {
    QTest::addColumn<double>("least");
    QTest::addColumn<double>("most");
    QTest::addColumn<bool>("fits");
    QTest::newRow("defaults") << 0.25 << 0.5 << true;
    QTest::newRow("equal") << 0.5 << 0.5 << true;
    QTest::newRow("swapped") << 0.75 << 0.5 << false;
  }
  void orderOfTwo_isChecked() {
    QFETCH(double, least);
    QFETCH(double, most);
    QFETCH(bool, fits);
    SampleOptions options;
    options.min_part = least;
    options.max_part = most;
    if (fits) return kTable.checkOrder(options, "g");
    QVERIFY_THROWS_EXCEPTION(OptionConflict, kTable.checkOrder(options, "g"));
  }

  void conflict_namesBothOptionsWithValuesAndWhatToDo() {
    SampleOptions options;
    options.first = 7;
    try {
      kTable.checkOrder(options, "g");
      QFAIL("must throw");
    } catch (const OptionConflict& conflict) {
      QVERIFY(conflict.kind() == ErrorKind::BadInput);
      QCOMPARE(conflict.lower(), std::string("tuning.g.first"));
      QCOMPARE(conflict.upper(), std::string("tuning.g.last"));
      QCOMPARE(conflict.problem(), std::string("tuning.g.first (7 px) is above tuning.g.last (1 px)"));
      QCOMPARE(conflict.advice(),
               std::string("Set tuning.g.first to at most 1 px, or tuning.g.last to at least 7 px"));
    }
  }

  void rows_setAgain_giveTheSameOptions() {
    const SampleOptions options{4, 1.0 / 30.0, true, Method::NormalFlow};
    SampleOptions read;
    for (const OptionRow& row : kTable.rows(options, "")) kTable.set(read, "", row.name, row.value);
    QVERIFY(read == options);
  }
};

EVICAL_TEST(TestOptionTable)
#include "tst_option_table.moc"
