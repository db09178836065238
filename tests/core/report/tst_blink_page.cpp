// The page that flashes a board: whole in one file, and the board in it as it is printed.
#include "core/base/error.h"
#include "core/report/blink_page.h"
#include "core/report/board_drawing.h"
#include "tests/support/test_program.h"

#include <QProcess>
#include <QRegularExpression>
#include <QStandardPaths>

#include <string>

using namespace evical;

namespace {

Board checkerboard() {
  Board board;
  board.type = BoardType::Checkerboard;
  board.rows = 6;
  board.cols = 9;
  board.spacing_m = 0.03;
  board.radius_m = 0.0;
  return board;
}

Board aprilGrid() {
  Board board = checkerboard();
  board.type = BoardType::AprilGrid;
  board.tag_size_m = 0.024;
  return board;
}

// The page's script, with `more` at its end, in node; what it prints.
QString runInNode(const std::string& page, const QString& more) {
  QString script = QString::fromStdString(page);
  script = script.mid(script.indexOf("<script>") + 8);
  script = script.left(script.indexOf("</script>"));
  script = script.left(script.indexOf("measureRefresh((refresh_hz)"));  // from there on it needs a browser
  QProcess node;
  node.start("node", {"-e", script + more});
  node.waitForFinished();
  return QString::fromUtf8(node.readAllStandardOutput() + node.readAllStandardError());
}

}  // namespace

class TestBlinkPage : public QObject {
  Q_OBJECT

 private slots:
  void page_needsNothingFromElsewhere() {
    const QString page = QString::fromStdString(blinkPage(checkerboard(), 0.01));
    QVERIFY(page.startsWith("<!DOCTYPE html>"));
    QVERIFY(!page.contains(QRegularExpression("@[A-Z]+@")));
    QVERIFY(!page.contains(QRegularExpression("(src|href)\\s*=")));
    for (auto links = QRegularExpression("https?://[^\"']*").globalMatch(page); links.hasNext();)
      QCOMPARE(links.next().captured(), QString("http://www.w3.org/2000/svg"));
    QVERIFY(page.contains("epilepsy"));
  }

  void page_hasTheBoardThatIsPrinted() {
    for (const Board& board : {checkerboard(), aprilGrid(), Board{}}) {
      const QString page = QString::fromStdString(blinkPage(board, 0.01));
      const BoardPicture picture = boardPicture(board, 0.01);
      QVERIFY(page.contains(QString::fromStdString(picture.elements)));
      QVERIFY(
          QString::fromStdString(boardSvg(board, 0.01)).contains(QString::fromStdString(picture.elements)));
    }
    QCOMPARE(boardPicture(checkerboard(), 0.01).width_mm, 10 * 30.0 + 2 * 10.0);
  }

  void boardThatMakesNoSense_isRefused() {
    Board board = checkerboard();
    board.rows = 1;
    QVERIFY_EXCEPTION_THROWN(blinkPage(board, 0.01), CalibrationError);
  }

  void script_saysTheTrueSpacing() {
    if (QStandardPaths::findExecutable("node").isEmpty()) QSKIP("node is not installed");
    // Of a screen of 1920 x 1080 px, 0.25 mm each, the checkerboard of 320 mm x 230 mm takes 1080 px in height.
    const QString said =
        runInNode(blinkPage(checkerboard(), 0.01),
                  "const layout = layOut(1920, 1080, 1);"
                  "console.log(layout.spacing_px, trueSpacing_m(layout, 600, 150));"
                  "console.log(sessionText(trueSpacing_m(layout, 600, 150)));"
                  "console.log(trueSpacing_m(layout, 600, NaN));"
                  "console.log(JSON.stringify(ratesOf(60).chosen), ratesOf(144).chosen.hz);");
    QVERIFY2(said.contains("140 0.035\n"), qPrintable(said));  // floor(30 * 1080 / 230)
    QVERIFY2(said.contains("spacing_m: 0.035000\n  blinking: true"), qPrintable(said));
    QVERIFY2(said.contains("undefined"), qPrintable(said));
    QVERIFY2(said.contains("{\"frames\":1,\"hz\":30} 24"), qPrintable(said));
    const QString tags = runInNode(blinkPage(aprilGrid(), 0.01), "console.log(sessionText(0.045));");
    QVERIFY2(tags.contains("tag_size_m: 0.036000"), qPrintable(tags));
  }
};

EVICAL_TEST(TestBlinkPage)
#include "tst_blink_page.moc"
