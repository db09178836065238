#include "core/base/yaml_node.h"

#include "core/base/plain_text.h"
#include "tests/support/file_cost.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <fstream>
#include <functional>

using namespace evical;
using namespace evical::test;

namespace {

YamlNode yaml(const std::string& text) {
  return YamlNode::parse(text, "file.yaml");
}

using Ask = std::function<void(const YamlNode&)>;

}  // namespace
Q_DECLARE_METATYPE(Ask)

class TestYamlNode : public QObject {
  Q_OBJECT

 private slots:
  void kinds_areToldApart() {
    const YamlNode root = yaml("map: {a: 1}\nlist: [1, 2]\nvalue: 7\nnothing:\n");
    QVERIFY(root.isMap() && root["map"].isMap());
    QVERIFY(root["list"].isSequence() && !root["list"].isMap());
    QVERIFY(root["value"].isScalar() && !root["value"].isSequence());
    QVERIFY(root["nothing"].isNull() && !root["nothing"].isScalar());
    QVERIFY(root.has("nothing") && !root.has("other"));
    QVERIFY(!root.find("other"));
    QVERIFY((root.keys() == std::vector<std::string>{"map", "list", "value", "nothing"}));
  }

  void values_areReadAsTheirTypes() {
    const YamlNode root = yaml(
        "word: left cam\nreal: -2.5e-3\nwhole: 11\ntime: 1700000000123456789\n"
        "reals: [1, 2.5, -3]\nchoice: dark\nquoted: \"a: b\"\n");
    QCOMPARE(root["word"].text(), std::string("left cam"));
    QCOMPARE(root["quoted"].text(), std::string("a: b"));
    QCOMPARE(root["real"].real(), -2.5e-3);
    QCOMPARE(root["real"].real(-1.0, 1.0, "m"), -2.5e-3);
    QCOMPARE(root["whole"].integer(2, 100), 11);
    QCOMPARE(root["time"].nanoseconds(), std::int64_t(1700000000123456789));
    QVERIFY((root["reals"].reals() == std::vector<double>{1.0, 2.5, -3.0}));
    QCOMPARE(root["reals"].reals(3).size(), std::size_t(3));
    QCOMPARE(root["choice"].choice({"bright", "dark"}), std::size_t(1));
  }

  void controlCharacters_areSeen_data() {
    QTest::addColumn<QByteArray>("text");
    QTest::addColumn<bool>("control");
    QTest::addColumn<QByteArray>("shown");    // visible()
    QTest::addColumn<QByteArray>("printed");  // printable()
    const auto row = [](const char* name, const QByteArray& text, bool control, const QByteArray& shown,
                        const QByteArray& printed = {}) {
      QTest::newRow(name) << text << control << shown << (printed.isNull() ? shown : printed);
    };
    row("nothing", "", false, "");
    row("words", "a b, \xc3\xb6 \xe2\x82\xac \xf0\x9f\x93\xb7", false,
        "a b, \xc3\xb6 \xe2\x82\xac \xf0\x9f\x93\xb7");
    row("Hebrew, Arabic", "\xd7\xa9 \xd8\xb4 \xe2\x80\x8f", false, "\xd7\xa9 \xd8\xb4 \xe2\x80\x8f");
    row("NUL", QByteArray("a\0b", 3), true, "a\\x00b");
    row("newline", "a\nb", true, "a\\x0ab");
    row("ESC", "\x1b[2J", true, "\\x1b[2J");
    row("DEL", "\x7f", true, "\\u007f");
    row("NEL", "\xc2\x85", true, "\\u0085");
    row("CSI", "\xc2\x9b", true, "\\u009b");
    row("no-break space", "\xc2\xa0", false, "\xc2\xa0");
    row("line separator", "\xe2\x80\xa8", true, "\\u2028");
    row("override", "\xe2\x80\xae", true, "\\u202e");
    row("isolate", "\xe2\x81\xa7", true, "\\u2067");
    row("no character", "\xef\xbf\xbf", true, "\\uffff");
    row("Latin 1", "l\xf6g", false, "l\xf6g", "l\\xf6g");
    row("byte of NEL", "\x85", false, "\x85", "\\x85");
    row("overlong newline", "\xc0\x8a", false, "\xc0\x8a", "\\xc0\\x8a");
    row("surrogate", "\xed\xa0\x80", false, "\xed\xa0\x80", "\\xed\\xa0\\x80");
    row("beyond Unicode", "\xf4\x90\x80\x80", false, "\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80");
    row("cut off", "\xe2\x82", false, "\xe2\x82", "\\xe2\\x82");
  }
  void controlCharacters_areSeen() {
    QFETCH(QByteArray, text);
    QFETCH(bool, control);
    QFETCH(QByteArray, shown);
    QFETCH(QByteArray, printed);
    const std::string own = text.toStdString();
    QCOMPARE(hasControl(own), control);
    QCOMPARE(QByteArray::fromStdString(visible(own)), shown);
    QCOMPARE(QByteArray::fromStdString(printable(own)), printed);
    QCOMPARE(QByteArray::fromStdString(visible(own, "\n")), text == "a\nb" ? text : shown);
    // In YAML every text reads back, and names are refused.
    const YamlNode root =
        yaml("key: " + yamlText(own) + "\n" + (text.isEmpty() ? "" : yamlText(own)) + ": 1\n");
    QCOMPARE(QByteArray::fromStdString(root["key"].anyText()), text);
    QCOMPARE(QByteArray::fromStdString(yaml("key: " + yamlLine(own))["key"].text()), shown);
    if (!control) {
      QCOMPARE(QByteArray::fromStdString(root["key"].text()), text);
      return;
    }
    QVERIFY_THROWS_EXCEPTION(CalibrationError, root["key"].text());
    QVERIFY_THROWS_EXCEPTION(CalibrationError, root.keys());
  }

  void wordsOfOtherTypes_areQuoted() {
    for (const char* const word :
         {"true", "False", "NULL", "yes", "No", "on", "OFF", "y", "N", "~", "1e5", ".inf", ""})
      QCOMPARE(yamlText(word), "\"" + std::string(word) + "\"");
    for (const char* const word : {"left", "/dvs/events", "one", "nothing"})
      QCOMPARE(yamlText(word), std::string(word));
  }

  void places_nameFileKeyAndLine() {
    const YamlNode root = yaml("board:\n  rows: 11\ncameras:\n  - {stream: a}\n  - {stream: b}\n");
    QCOMPARE(root.place(), std::string("file.yaml"));
    QCOMPARE(root["board"]["rows"].place(), std::string("file.yaml: board.rows (line 2)"));
    QCOMPARE(root["cameras"].items()[1]["stream"].place(),
             std::string("file.yaml: cameras[1].stream (line 5)"));
    QCOMPARE(root["board"]["rows"].key(), std::string("board.rows"));
    const CalibrationError error = root["board"]["rows"].error("is odd", "Count again");
    QVERIFY(error.kind() == ErrorKind::BadInput);
    QCOMPARE(QString(error.what()), QString("file.yaml: board.rows (line 2): is odd. Count again"));
  }

  void mistakes_areRefusedAtTheirPlace_data() {
    QTest::addColumn<QString>("text");
    QTest::addColumn<Ask>("ask");
    QTest::addColumn<QString>("place");
    QTest::addColumn<QString>("says");
    const auto add = [](const char* name, const char* text, Ask ask, const char* place, const char* says) {
      QTest::newRow(name) << QString(text) << std::move(ask) << QString(place) << QString(says);
    };
    const char* const kValue = "a: 1\nb: x\n";
    add(
        "missing key", kValue, [](const YamlNode& n) { n["c"]; }, "file.yaml: c", "is missing. Add 'c'");
    add(
        "unknown key", "a: 1\nrwos: 3\n",
        [](const YamlNode& n) {
          n.allowOnly({"a", "rows"});
        },
        "file.yaml: rwos (line 2)", "unknown key. Did you mean 'rows'?");
    add(
        "key twice", "a: 1\nb: 2\na: 3\n", [](const YamlNode& n) { n.keys(); }, "file.yaml: a (line 3)",
        "occurs twice, first in line 1");
    add(
        "another key where one occurs twice", "a: 1\nb: 2\na: 3\n", [](const YamlNode& n) { n["b"]; },
        "file.yaml: a (line 3)", "occurs twice");
    add(
        "include", "a: !include other.yaml\n", [](const YamlNode& n) { n["a"]; }, "file.yaml: a (line 1)",
        "has the tag !include, which is not read");
    add(
        "key that is a list", "[1, 2]: 3\n", [](const YamlNode& n) { n.keys(); }, "file.yaml",
        "a key that is not a plain word");
    add(
        "no map", "a: 1\n", [](const YamlNode& n) { n["a"].keys(); }, "file.yaml: a (line 1)",
        "must be a map");
    add(
        "nothing found in no map", "a: 1\n", [](const YamlNode& n) { n["a"].find("b"); },
        "file.yaml: a (line 1)", "must be a map");
    add(
        "no list", kValue, [](const YamlNode& n) { n["a"].items(); }, "file.yaml: a (line 1)",
        "must be a list");
    add(
        "no number", kValue, [](const YamlNode& n) { n["b"].real(); }, "file.yaml: b (line 2)",
        "'x' is not a number");
    add(
        "nan", "a: .nan\n", [](const YamlNode& n) { n["a"].real(); }, "file.yaml: a (line 1)",
        "not a number");
    add(
        "too large", kValue, [](const YamlNode& n) { n["a"].real(0.0, 0.5, "m"); }, "file.yaml: a (line 1)",
        "1 m is above the maximum of 0.5 m");
    add(
        "too small", kValue, [](const YamlNode& n) { n["a"].integer(2, 5); }, "file.yaml: a (line 1)",
        "1 is below the minimum of 2");
    add(
        "not whole", "a: 1.5\n", [](const YamlNode& n) { n["a"].integer(0, 5); }, "file.yaml: a (line 1)",
        "'1.5' is not a whole number");
    add(
        "time beyond 64 bits", "a: 9223372036854775808\n", [](const YamlNode& n) { n["a"].nanoseconds(); },
        "file.yaml: a (line 1)", "is not a whole number");
    add(
        "too few numbers", "a: [1, 2]\n", [](const YamlNode& n) { n["a"].reals(3); }, "file.yaml: a (line 1)",
        "has 2 numbers, 3 are needed");
    add(
        "number of a list", "a:\n  - 1\n  - x\n", [](const YamlNode& n) { n["a"].reals(); },
        "file.yaml: a[1] (line 3)", "'x' is not a number");
    add(
        "no such word", kValue,
        [](const YamlNode& n) {
          n["b"].choice({"dark", "bright"});
        },
        "file.yaml: b (line 2)", "'x' is not one of dark, bright");
    add(
        "no value", "a:\n", [](const YamlNode& n) { n["a"].text(); }, "file.yaml: a (line 1)",
        "has no value");
    add(
        "map for a value", "a: {b: 1}\n", [](const YamlNode& n) { n["a"].text(); }, "file.yaml: a (line 1)",
        "must be one value");
  }
  void mistakes_areRefusedAtTheirPlace() {
    QFETCH(QString, text);
    QFETCH(Ask, ask);
    QFETCH(QString, place);
    QFETCH(QString, says);
    const YamlNode root = yaml(text.toStdString());
    try {
      ask(root);
      QFAIL("must throw");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      QCOMPARE(QString::fromStdString(error.place()), place);
      QVERIFY2(QString(error.what()).contains(says), error.what());
    }
  }

  void textThatIsNoYaml_isRefusedWithTheLine() {
    try {
      yaml("a: 1\nb: [1, 2\nc: 3\n");
      QFAIL("must throw");
    } catch (const CalibrationError& error) {
      QVERIFY2(
          QString(error.what()).contains(QRegularExpression("file.yaml \\(line [23]\\): is not valid YAML")),
          error.what());
    }
  }

  void tagsOfYaml_areRead() {
    const YamlNode root = yaml("%YAML:1.0\n---\nk: !!opencv-matrix {rows: 3}\nn: !!float 1\nt: \"1\"\n");
    QCOMPARE(root["k"]["rows"].integer(0, 9), 3);
    QCOMPARE(root["n"].real(), 1.0);
    QVERIFY(root["t"].isQuoted() && !root["n"].isQuoted());
  }

  void bombs_costLittle_data() {
    QTest::addColumn<QString>("unit");
    QTest::addColumn<int>("count");
    QTest::addColumn<QString>("says");
    QTest::newRow("keys") << "k%1: 0\n" << 400'000 << "more than 200000 values";
    QTest::newRow("keys, fewer") << "k%1: 0\n" << 100'000 << "^read$";
    QTest::newRow("cameras") << "cam%1: {}\n" << 100'000 << "^read$";
    QTest::newRow("numbers") << "%1," << 1'000'000 << "more than 200000 values";
    QTest::newRow("depth") << "[" << 100'000 << "nested too deeply";
  }
  void bombs_costLittle() {
    QFETCH(QString, unit);
    QFETCH(int, count);
    QFETCH(QString, says);
    QString text = unit.startsWith("%1") ? "D: [" : "";
    for (int i = 0; i < count; ++i)
      text += unit.contains("%1") ? QString(unit).replace("%1", QString::number(i)) : unit;
    const FileCost cost = costOf([&] {
      const YamlNode root = yaml(text.toStdString());
      for (const std::string& key : root.keys()) root.has(key);
      return std::string("read");
    });
    VERIFY_COST(cost, says);
  }

  void files_areReadOrRefused() {
    QTemporaryDir folder;
    const std::filesystem::path file = folder.filePath("a.yaml").toStdString();
    std::ofstream(file) << "rows: 3\n";
    QCOMPARE(YamlNode::load(file)["rows"].integer(0, 9), 3);
    QCOMPARE(YamlNode::load(file)["rows"].place(), file.string() + ": rows (line 1)");
    QVERIFY_THROWS_EXCEPTION(CalibrationError, YamlNode::load(folder.filePath("gone.yaml").toStdString()));
    QVERIFY_THROWS_EXCEPTION(CalibrationError, YamlNode::load(folder.path().toStdString()));
    std::ofstream(file, std::ios::trunc) << "";
    QVERIFY_THROWS_EXCEPTION(CalibrationError, YamlNode::load(file));
  }

  void text_isQuotedWhereItNeedsIt_data() {
    QTest::addColumn<QString>("text");
    QTest::addColumn<QString>("written");
    QTest::newRow("word") << "left_cam"
                          << "left_cam";
    QTest::newRow("topic") << "/davis_left/events"
                           << "/davis_left/events";
    QTest::newRow("empty") << ""
                           << "\"\"";
    QTest::newRow("number") << "11"
                            << "\"11\"";
    QTest::newRow("blank") << "left cam"
                           << "\"left cam\"";
    QTest::newRow("colon") << "a: b"
                           << "\"a: b\"";
    QTest::newRow("switch") << "true"
                            << "\"true\"";
    QTest::newRow("null") << "null"
                          << "\"null\"";
    QTest::newRow("quote") << "a\"b"
                           << "\"a\\\"b\"";
    QTest::newRow("backslash") << "C:\\x"
                               << "\"C:\\\\x\"";
    QTest::newRow("line break") << "a\nb"
                                << "\"a\\nb\"";
    QTest::newRow("umlaut") << "Küche"
                            << "\"Küche\"";
  }
  void text_isQuotedWhereItNeedsIt() {
    QFETCH(QString, text);
    QFETCH(QString, written);
    QCOMPARE(QString::fromStdString(yamlText(text.toStdString())), written);
    const YamlNode read = yaml("key: " + written.toStdString() + "\n")["key"];
    QCOMPARE(QString::fromStdString(read.anyText()), text);  // also of lines
  }
};

EVICAL_TEST(TestYamlNode)
#include "tst_yaml_node.moc"
