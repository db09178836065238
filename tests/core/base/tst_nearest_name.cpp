#include "core/base/nearest_name.h"

#include "core/base/number.h"
#include "tests/support/test_program.h"

using namespace evical;

class TestNearestName : public QObject {
  Q_OBJECT

 private slots:
  void editDistance_countsEdits_data() {
    QTest::addColumn<QString>("a");
    QTest::addColumn<QString>("b");
    QTest::addColumn<int>("distance");
    QTest::newRow("same") << "rows"
                          << "rows" << 0;
    QTest::newRow("insertion") << "row"
                               << "rows" << 1;
    QTest::newRow("swap of neighbours") << "colour"
                                        << "coluor" << 1;
    QTest::newRow("nothing in common") << "abc"
                                       << "xyz" << 3;
    QTest::newRow("against nothing") << ""
                                     << "rows" << 4;
  }
  void editDistance_countsEdits() {
    QFETCH(QString, a);
    QFETCH(QString, b);
    QTEST(editDistance(a.toStdString(), b.toStdString()), "distance");
    QTEST(editDistance(b.toStdString(), a.toStdString()), "distance");
  }

  void counted_hasAPlural() {
    QCOMPARE(counted(1, "view"), std::string("1 view"));
    QCOMPARE(counted(0, "view"), std::string("0 views"));
    QCOMPARE(counted(1, "event", "was", "were"), std::string("1 event was"));
    QCOMPARE(counted(2, "event", "was", "were"), std::string("2 events were"));
  }

  void nearestName_findsWhatWasMeant() {
    const std::vector<std::string> known{"rows", "cols", "spacing_m"};
    QCOMPARE(nearestName("spacing", known), std::string("spacing_m"));
    QCOMPARE(nearestName("col", known), std::string("cols"));
  }
  void nearestName_ofSomethingElse_isNone() {
    QCOMPARE(nearestName("temperature", std::vector<std::string>{"rows", "cols"}), std::string());
  }
  void nameAdvice_withoutNearName_listsAll() {
    const std::string advice = nameAdvice("temperature", std::vector<std::string>{"rows", "cols"});
    QVERIFY2(advice.find("rows, cols") != std::string::npos, advice.c_str());
  }
};

EVICAL_TEST(TestNearestName)
#include "tst_nearest_name.moc"
