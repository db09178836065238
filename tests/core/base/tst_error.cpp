#include "core/base/error.h"

#include "tests/support/test_program.h"

using namespace evical;

class TestError : public QObject {
  Q_OBJECT

 private slots:
  void text_saysWhereWhatAndWhatToDo_data() {
    QTest::addColumn<QString>("place");
    QTest::addColumn<QString>("problem");
    QTest::addColumn<QString>("advice");
    QTest::addColumn<QString>("text");
    QTest::newRow("all") << "a.yaml: rows"
                         << "is 0"
                         << "Count them"
                         << "a.yaml: rows: is 0. Count them";
    QTest::newRow("no advice") << "a.yaml"
                               << "is empty"
                               << ""
                               << "a.yaml: is empty";
    QTest::newRow("no place") << ""
                              << "nothing moves"
                              << "Move it"
                              << "nothing moves. Move it";
  }
  void text_saysWhereWhatAndWhatToDo() {
    QFETCH(QString, place);
    QFETCH(QString, problem);
    QFETCH(QString, advice);
    QFETCH(QString, text);
    const CalibrationError error(ErrorKind::BadInput, place.toStdString(), problem.toStdString(),
                                 advice.toStdString());
    QCOMPARE(QString(error.what()), text);
    QCOMPARE(QString::fromStdString(error.place()), place);
    QCOMPARE(QString::fromStdString(error.problem()), problem);
    QCOMPARE(QString::fromStdString(error.advice()), advice);
  }

  void kinds_areThoseOfTheirMakers() {
    QVERIFY(badInput("a", "b").kind() == ErrorKind::BadInput);
    QVERIFY(calibrationFailed("a", "b").kind() == ErrorKind::CalibrationFailed);
    QCOMPARE(badInput("a", "b", "c").advice(), std::string("c"));
    QCOMPARE(calibrationFailed("a", "b", "c").place(), std::string("a"));
  }

  void error_isCaughtAsAStandardException() {
    try {
      throw badInput("place", "problem");
    } catch (const std::exception& caught) {
      QCOMPARE(QString(caught.what()), QString("place: problem"));
    }
  }
};

EVICAL_TEST(TestError)
#include "tst_error.moc"
