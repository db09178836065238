#include "core/base/option_yaml.h"
#include "tests/support/test_program.h"

using namespace evical;

namespace {

enum class Method { RingVote, NormalFlow };
struct SampleOptions {
  int radius_px = 2;
  double error_s = 1e-3;
  bool quick = false;
  Method method = Method::RingVote;
  bool operator==(const SampleOptions&) const = default;
};
constexpr auto kSampleFields =
    std::tuple{Field{"radius_px", &SampleOptions::radius_px, 1, 5, "px", "Radius."},
               Field{"error_s", &SampleOptions::error_s, 1e-5, 1e-1, "s", "Error."},
               Switch{"quick", &SampleOptions::quick, "Quick."},
               Choice{"method", &SampleOptions::method, std::array{"ring_vote", "normal_flow"}, "Method."}};

}  // namespace

class TestOptionYaml : public QObject {
  Q_OBJECT

 private slots:
  void set_takesEveryKind() {
    SampleOptions options;
    setOption(options, kSampleFields, "g", "radius_px", "5");
    setOption(options, kSampleFields, "g", "error_s", "2e-2");
    setOption(options, kSampleFields, "g", "quick", "true");
    setOption(options, kSampleFields, "g", "method", "normal_flow");
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
      setOption(options, kSampleFields, "g", name.toStdString(), value.toStdString());
      QFAIL("must throw");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      for (const QString& part : said) QVERIFY2(QString(error.what()).contains(part), error.what());
    }
    QVERIFY(options == SampleOptions{});
  }

  void rows_setAgain_giveTheSameOptions() {
    const SampleOptions options{4, 1.0 / 30.0, true, Method::NormalFlow};
    SampleOptions read;
    for (const OptionRow& row : optionRows(options, kSampleFields, ""))
      setOption(read, kSampleFields, "", row.name, row.value);
    QVERIFY(read == options);
  }
};

EVICAL_TEST(TestOptionYaml)
#include "tst_option_yaml.moc"
