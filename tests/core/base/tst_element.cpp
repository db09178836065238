#include "core/base/element.h"

#include "tests/support/test_program.h"

using namespace evical;

class TestElement : public QObject {
  Q_OBJECT

 private slots:
  void elementOrNone_isTheElement_orEmptyBeyondTheEnd() {
    const std::vector<int> numbers = {4, 5};
    QCOMPARE(elementOrNone(numbers, 1), 5);
    QCOMPARE(elementOrNone(numbers, 2), 0);
  }
};

EVICAL_TEST(TestElement)
#include "tst_element.moc"
