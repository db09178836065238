// The page that flashes a board: complete in one file, with the same board as on paper.
#include "core/base/error.h"
#include "core/printing/blink_page.h"
#include "core/printing/board_drawing.h"
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

QString scriptOf(const Board& board) {
  const QString page = QString::fromStdString(blinkPage(board, 0.01));
  const qsizetype begin = page.indexOf("<script>") + 8;
  return page.mid(begin, page.indexOf("</script>") - begin);
}

// The part of the page that needs no browser.
QString functionsOf(const Board& board) {
  const QString script = scriptOf(board);
  return script.left(script.indexOf("measureRefresh((refresh_hz)"));
}

// The script's output.
QString runInNode(const QString& script) {
  QProcess node;
  node.start("node", {"-e", script});
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
      SheetOptions options;
      options.margin_m = 0.01;
      const QString shown = QString::fromStdString(boardPicture(board, options.margin_m).elements),
                    printed = QString::fromStdString(boardSvg(board, options));
      QVERIFY(page.contains(shown));
      QStringList shapes = shown.split('\n').filter(QRegularExpression("^<(rect|circle)"));
      QVERIFY(shapes.size() >= board.pointCount() / 4);
      for (const QString& shape : shapes) QVERIFY2(printed.contains(shape), qPrintable(shape));
    }
    QCOMPARE(boardPicture(checkerboard(), 0.01).width_mm, 10 * 30.0 + 2 * 10.0);
  }

  void boardThatMakesNoSense_isRefused() {
    Board board = checkerboard();
    board.rows = 1;
    QVERIFY_THROWS_EXCEPTION(CalibrationError, blinkPage(board, 0.01));
  }

  // A substitute for the browser functions that the page uses: it flashes, at half the chosen rate in frames,
  // until Escape.
  void script_flashesUntilEscape() {
    if (QStandardPaths::findExecutable("node").isEmpty()) QSKIP("node is not installed");
    const QString browser = R"(
const elements = {}, handlers = {}, queue = [];
const element = (id) => elements[id] = elements[id] || { value: id === "length" ? "150" : "2", style: {}, setAttribute() {},
  getBoundingClientRect: () => ({ width: 600 }), add() {}, addEventListener: (name, then) => handlers[id + name] = then };
const classes = new Set();
globalThis.document = { getElementById: element, addEventListener: (name, then) => handlers[name] = then,
  body: { classList: { add: (name) => classes.add(name), remove: (name) => classes.delete(name) } }, documentElement: {} };
globalThis.window = { innerWidth: 1280, innerHeight: 720, devicePixelRatio: 1, addEventListener() {} };
globalThis.screen = { width: 1920, height: 1080 };
globalThis.Option = class {};
globalThis.requestAnimationFrame = (then) => queue.push(then);
if (!globalThis.navigator) globalThis.navigator = {};
)";
    const QString play = R"(
let now = 0;
const shown = [];
for (let k = 0; k < 70; ++k) queue.splice(0).forEach((then) => then(now += 1000 / 60));
console.log(elements.refresh.textContent, elements.session.textContent.includes("0.035000"));
handlers.startclick();
console.log(classes.has("flashing"), elements.session.textContent.includes("0.023250"));
for (let k = 0; k < 8; ++k) { queue.splice(0).forEach((then) => then(now += 1000 / 60)); shown.push(elements.ink.style.visibility[0]); }
console.log(shown.join(""));
handlers.keydown({ key: "Escape" });
console.log(classes.has("flashing"));
)";
    const QString said = runInNode(browser + scriptOf(checkerboard()) + play);
    QCOMPARE(said, QString("(the screen's refresh rate is 60 Hz) true\ntrue true\nvvhhvvhh\nfalse\n"));
  }

  void script_saysTheTrueSpacing() {
    if (QStandardPaths::findExecutable("node").isEmpty()) QSKIP("node is not installed");
    // On a screen of 1920 x 1080 px, 0.25 mm each, the checkerboard of 320 mm x 230 mm takes 1080 px in
    // height.
    const QString said =
        runInNode(functionsOf(checkerboard()) +
                  "const placed = layOut(1920, 1080, 1);"
                  "console.log(placed.spacing_px, trueSpacing_m(placed, 600, 150));"
                  "console.log(sessionText(trueSpacing_m(placed, 600, 150)));"
                  "console.log(trueSpacing_m(placed, 600, NaN));"
                  "console.log(JSON.stringify(ratesOf(60).chosen), ratesOf(144).chosen.hz);");
    QVERIFY2(said.contains("140 0.035\n"), qPrintable(said));  // floor(30 * 1080 / 230)
    QVERIFY2(said.contains("spacing_m: 0.035000\n  blinking: true"), qPrintable(said));
    QVERIFY2(said.contains("undefined"), qPrintable(said));
    QVERIFY2(said.contains("{\"frames\":1,\"hz\":30} 24"), qPrintable(said));
    const QString tags = runInNode(functionsOf(aprilGrid()) + "console.log(sessionText(0.045));");
    QVERIFY2(tags.contains("tag_size_m: 0.036000"), qPrintable(tags));
  }
};

EVICAL_TEST(TestBlinkPage)
#include "tst_blink_page.moc"
