// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/board/boards_form.h"

#include "core/pipeline/session/session_boards.h"
#include "tests/support/test_program.h"
#include "tests/ui/simulated_session.h"
#include "ui/document/calibration_document.h"
#include "ui/forms/number_field.h"
#include "ui/screens/board/board_form.h"
#include "ui/screens/recording/camera_form.h"
#include "ui/screens/recording/recording_screen.h"
#include "ui/theme/theme.h"

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QSpinBox>
#include <QTabBar>
#include <QTemporaryDir>
#include <QToolButton>

using namespace evical;
using namespace evical::ui;

namespace {

using Names = std::vector<std::string>;

// The screen with a document, wired like in the window, with three cameras.
struct BoardsFormFixture {
  CalibrationDocument document;
  RecordingScreen screen;

  BoardsFormFixture() {
    QObject::connect(&screen, &RecordingScreen::sessionEdited, &document, &CalibrationDocument::edit);
    QObject::connect(&document, &CalibrationDocument::sessionChanged, &screen, [this] { show(); });
    Session session = readSession(evical::ui::test::simulatedSession().toStdString());
    for (const char* const name : {"frames", "side"}) {
      session.cameras.push_back(session.cameras[0]);
      session.cameras.back().name = session.cameras.back().stream = name;
    }
    document.startSession(session);
    screen.resize(1040, 900);
    screen.show();
    QApplication::processEvents();
  }

  void show() {
    screen.setSession(document.session());
    std::vector<std::pair<QString, QString>> problems;
    for (const SessionProblem& problem : sessionProblems(document.session()))
      problems.emplace_back(problem.field, problem.text);
    screen.setProblems(problems);
  }
  const Session& session() const { return document.session(); }
  Names names() const { return boardNames(session()); }
  template <class Widget>
  Widget* find(const char* name) const {
    return screen.findChild<Widget*>(name);
  }
  QTabBar* tabs() const { return find<QTabBar>("boards"); }
  QLineEdit* name() const { return find<QLineEdit>("board_name"); }
  BoardForm* form() const { return screen.findChild<BoardForm*>(); }
  void click(const char* button) const { QTest::mouseClick(find<QToolButton>(button), Qt::LeftButton); }
  void choose(int tab) const { QTest::mouseClick(tabs(), Qt::LeftButton, {}, tabs()->tabRect(tab).center()); }
  void type(const QString& text) const {
    name()->selectAll();
    QTest::keyClicks(name(), text);
    QTest::keyClick(name(), Qt::Key_Return);
  }
  QComboBox* boardOf(std::size_t camera) const {
    const QString called = QString::fromStdString(session().cameras[camera].name);
    for (CameraForm* const each : screen.findChildren<CameraForm*>())
      if (each->findChildren<QLineEdit*>().at(0)->text() == called)
        return each->findChild<QComboBox*>("board");
    return nullptr;
  }
  void see(std::size_t camera, const QString& board) const {
    QComboBox* const box = boardOf(camera);
    box->setCurrentText(board);
    emit box->activated(box->currentIndex());
  }
  QString problem() const {
    QStringList shown;
    for (const QLabel* const label : form()->findChildren<QLabel*>())
      if (label->property("role") == "problem" && !label->isHidden()) shown << label->text();
    return shown.join('\n');
  }
};

}  // namespace

class TestBoardsForm : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() { applyTheme(*qApp, Appearance::Light); }

  void oneBoard_needsNeitherChoiceNorName() {
    BoardsFormFixture test;
    for (QWidget* const hidden :
         {static_cast<QWidget*>(test.tabs()), static_cast<QWidget*>(test.find<QToolButton>("remove_board")),
          static_cast<QWidget*>(test.name()), static_cast<QWidget*>(test.find<QLabel>("seen_by"))})
      QVERIFY(!hidden->isVisible());
    QVERIFY(test.find<QToolButton>("add_board")->isEnabled());
    Session alone = test.session();
    alone.cameras.resize(1);
    test.document.edit(alone, "One camera");
    QVERIFY(!test.find<QToolButton>("add_board")->isEnabled());
    QVERIFY(test.find<QToolButton>("add_board")->toolTip().contains("more boards than cameras"));
  }

  void addedBoard_isChosen_andEditedAlone() {
    BoardsFormFixture test;
    const Board first = test.session().board;
    test.click("add_board");
    QCOMPARE(test.names(), (Names{"board", "board_2"}));
    QVERIFY(test.tabs()->isVisible() && test.name()->isVisible());
    QCOMPARE(test.tabs()->currentIndex(), 1);
    QCOMPARE(test.name()->text(), QString("board_2"));
    QCOMPARE(test.find<QLabel>("seen_by")->text(), QString("no camera yet"));
    test.form()->findChildren<QSpinBox*>().at(0)->setValue(9);
    test.form()->findChild<QCheckBox*>()->click();
    QVERIFY(test.session().board == first && !test.session().measured);
    QCOMPARE(boardAt(test.session(), 1).rows, 9);
    QVERIFY(measuredAt(test.session(), 1).has_value());
    test.choose(0);
    QCOMPARE(test.form()->findChildren<QSpinBox*>().at(0)->value(), first.rows);
    QVERIFY(!test.form()->findChild<QCheckBox*>()->isChecked());
    for (int i = 0; i < 3; ++i) test.document.undoStack().undo();
    QCOMPARE(test.names(), Names{"board"});
    QVERIFY(test.session().cameras[0].board.empty() && !test.tabs()->isVisible());
    QCOMPARE(test.document.undoStack().redoText(), QString("Add a board"));
  }

  // Undo steps merge only within one board.
  void editsOfTwoBoards_areTwoSteps() {
    BoardsFormFixture test;
    test.click("add_board");
    QSpinBox* const rows = test.form()->findChildren<QSpinBox*>().at(0);
    rows->setValue(9);
    rows->setValue(7);
    test.choose(0);
    rows->setValue(5);
    test.document.undoStack().undo();
    QCOMPARE(test.session().board.rows, 11);
    QCOMPARE(boardAt(test.session(), 1).rows, 7);
    test.document.undoStack().undo();
    QCOMPARE(boardAt(test.session(), 1).rows, 11);
  }

  // Without the final key.
  void typedNumber_isThatOfTheBoardItWasTypedFor() {
    BoardsFormFixture test;
    test.click("add_board");
    auto* const spacing = test.form()->findChildren<NumberField*>().at(0);
    spacing->setFocus();
    spacing->selectAll();
    QTest::keyClicks(spacing, "41");
    test.choose(0);
    QCOMPARE(test.tabs()->currentIndex(), 0);
    QCOMPARE(boardAt(test.session(), 1).spacing_m, 0.041);
    QVERIFY(test.session().board.spacing_m != 0.041);
  }

  void removedBoard_leavesItsCamerasToTheWorlds_andComesBack() {
    BoardsFormFixture test;
    test.click("add_board");
    test.see(1, "board_2");
    test.see(2, "board_2");
    QCOMPARE(test.find<QLabel>("seen_by")->text(), QString("frames, side"));
    test.click("add_board");
    test.choose(1);
    test.click("remove_board");
    QCOMPARE(test.names(), (Names{"board", "board_3"}));
    for (const SessionCamera& camera : test.session().cameras) QCOMPARE(camera.board, std::string("board"));
    test.document.undoStack().undo();
    QCOMPARE(test.names(), (Names{"board", "board_2", "board_3"}));
    QCOMPARE(test.session().cameras[2].board, std::string("board_2"));
    QCOMPARE(test.name()->text(), QString("board_2"));  // the restored board is displayed
  }

  void renamedBoard_isWhatItsCamerasSee() {
    BoardsFormFixture test;
    test.click("add_board");
    test.see(1, "board_2");
    test.type(" tags ");
    QCOMPARE(test.names(), (Names{"board", "tags"}));
    QCOMPARE(test.tabs()->tabText(1), QString("tags"));
    QCOMPARE(test.session().cameras[1].board, std::string("tags"));
    QCOMPARE(test.boardOf(1)->currentText(), QString("tags"));
    test.document.undoStack().undo();
    QCOMPARE(test.session().cameras[1].board, std::string("board_2"));
  }

  void badName_isSaidAtItsField_andChangesNothing_data() {
    QTest::addColumn<QString>("typed");
    QTest::addColumn<QString>("said");
    QTest::newRow("empty") << " "
                           << "empty";
    QTest::newRow("taken") << "board"
                           << "another board's";
    QTest::newRow("a sensor's") << "frames"
                                << "sensor's";
  }
  void badName_isSaidAtItsField_andChangesNothing() {
    QFETCH(QString, typed);
    QFETCH(QString, said);
    BoardsFormFixture test;
    test.click("add_board");
    auto* const problem = test.find<QLabel>("name_problem");
    QVERIFY(!problem->isVisible());
    test.type(typed);
    QVERIFY(problem->isVisible());
    QVERIFY2(problem->text().contains(said), qPrintable(problem->text()));
    QCOMPARE(test.name()->text(), typed);  // to be corrected
    QCOMPARE(test.names(), (Names{"board", "board_2"}));
    test.type("tags");
    QVERIFY(!problem->isVisible());
    QCOMPARE(test.names(), (Names{"board", "tags"}));
  }

  void worldCameraThatSeesAnother_makesThatTheWorlds() {
    BoardsFormFixture test;
    test.click("add_board");
    test.form()->findChildren<QSpinBox*>().at(0)->setValue(9);
    test.see(0, "board_2");
    QCOMPARE(test.names(), (Names{"board_2", "board"}));
    QCOMPARE(test.session().board.rows, 9);
    QCOMPARE(test.tabs()->currentIndex(), 0);  // the same board
    QVERIFY2(test.problem().isEmpty(), qPrintable(test.problem()));
  }

  void problemsOfBoards_sayOfWhich() {
    BoardsFormFixture test;
    test.click("add_board");
    test.choose(0);
    QVERIFY2(test.problem().startsWith("board_2: no camera sees it"), qPrintable(test.problem()));
    test.see(1, "board_2");
    QVERIFY2(test.problem().isEmpty(), qPrintable(test.problem()));
    Session wrong = test.session();
    wrong.further_boards[0].board.radius_m = 1.0;
    test.document.edit(wrong, "Circles that touch");
    QVERIFY2(test.problem().startsWith("board_2: "), qPrintable(test.problem()));
  }

  void boards_areSavedAndOpened() {
    BoardsFormFixture test;
    test.click("add_board");
    test.see(1, "board_2");
    test.type("left wall");
    test.form()->findChildren<QSpinBox*>().at(1)->setValue(6);
    test.form()->findChild<QCheckBox*>()->click();
    const QTemporaryDir folder;
    test.document.save(folder.filePath("session.yaml"));
    const Session again = readSession(folder.filePath("session.yaml").toStdString());
    QCOMPARE(boardNames(again), (Names{"board", "left wall"}));
    QCOMPARE(boardAt(again, 1).cols, 6);
    QVERIFY(measuredAt(again, 1) && measuredAt(again, 1) == measuredAt(test.session(), 1));
    QCOMPARE(again.cameras[1].board, std::string("left wall"));
    QCOMPARE(sessionYaml(again, "/"), sessionYaml(test.session(), "/"));
  }

  // A board without a pattern cannot be shown on a screen.
  void givenPoints_doNotFlash() {
    BoardsFormFixture test;
    Session session = test.session();
    session.board = boardOfPoints({{-0.1, 0.0}, {0.1, 0.0}, {0.0, 0.1}, {0.1, 0.2}});
    test.click("board_more");
    QVERIFY(test.find<QCheckBox>("blinks")->isVisible());
    test.document.edit(session, "Points");
    QVERIFY(!test.find<QCheckBox>("blinks")->isVisible());
    test.document.undoStack().undo();
    QVERIFY(test.find<QCheckBox>("blinks")->isVisible());
  }

  void rarelyNeededRows_areFolded_unlessTheSessionUsesThem() {
    BoardsFormFixture test;
    auto* const more = test.find<QToolButton>("board_more");
    auto* const blinks = test.find<QCheckBox>("blinks");
    auto* const measured = test.form()->findChild<QCheckBox*>();
    QVERIFY(more->isVisible() && !blinks->isVisible() && !measured->isVisible());
    test.click("board_more");
    QVERIFY(blinks->isVisible() && measured->isVisible());
    test.click("board_more");
    QVERIFY(!blinks->isVisible() && !measured->isVisible());
    Session session = test.session();
    session.board_blinks = true;
    test.document.edit(session, "Flashes");
    QVERIFY(blinks->isVisible() && blinks->isChecked() && !more->isEnabled());
    session.board_blinks = false;
    session.measured = MeasuredLength{10, 0.5, 0.0005};
    test.document.edit(session, "Measured");
    QVERIFY(measured->isVisible() && measured->isChecked() && !more->isEnabled());
  }

  // They come from a file: shown, but neither chosen nor counted here.
  void givenPoints_areShown_andMayGiveWay() {
    BoardForm form;
    const auto isShown = [&](const QString& title) {
      for (QLabel* const label : form.findChildren<QLabel*>())
        if (label->text() == title) return !label->isHidden();
      return false;
    };
    auto* const type = form.findChildren<QComboBox*>().at(0);
    const auto canBeChosen = [&] {
      const QModelIndex points = type->model()->index(static_cast<int>(BoardType::Points), 0);
      return (type->model()->flags(points) & Qt::ItemIsEnabled) != 0;
    };
    form.setBoard({}, {});
    QVERIFY(!canBeChosen() && isShown("Rows") && isShown("Spacing [mm]"));
    form.setBoard(boardOfPoints({{-0.1, 0.0}, {0.1, 0.0}, {0.0, 0.1}, {0.1, 0.2}}), {});
    QCOMPARE(type->currentText(), QString("Points of a table"));
    QVERIFY(canBeChosen() && !isShown("Rows") && !isShown("Spacing [mm]") && !isShown("Tag [mm]"));
    std::vector<Board> edited;
    connect(&form, &BoardForm::edited, &form, [&](const Board& board) { edited.push_back(board); });
    type->setCurrentIndex(0);
    emit type->activated(0);
    QVERIFY(edited == std::vector{Board()});
  }
};

EVICAL_TEST(TestBoardsForm)
#include "tst_boards_form.moc"
