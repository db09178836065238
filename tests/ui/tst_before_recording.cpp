// SPDX-License-Identifier: GPL-3.0-or-later
// Steps before a recording: printing and measuring a board, and the instructions for the motion.
#include "core/pipeline/rig/recording_assessment.h"
#include "core/pipeline/session/session.h"
#include "core/printing/blink_page.h"
#include "core/printing/board_drawing.h"
#include "tests/support/test_program.h"
#include "tests/ui/clipped_text.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/window_fixture.h"
#include "ui/document/printed_board.h"
#include "ui/forms/number_field.h"
#include "ui/screens/board/board_form.h"
#include "ui/screens/board/measured_form.h"
#include "ui/screens/board/print_board_dialog.h"
#include "ui/screens/recording/how_to_record_dialog.h"
#include "ui/screens/recording/motion_picture.h"
#include "ui/window/print_board.h"
#include "ui/window/session_files.h"

#include <QCheckBox>
#include <QComboBox>
#include <QFile>
#include <QLabel>
#include <QListWidget>
#include <QMenu>
#include <QPushButton>
#include <QScopeGuard>
#include <QScrollArea>
#include <QScrollBar>
#include <QSet>
#include <QSpinBox>
#include <QToolButton>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

std::string contentOfBeforeRecording(const QString& path) {
  QFile file(path);
  return file.open(QIODevice::ReadOnly) ? file.readAll().toStdString() : std::string();
}

QString saidBy(const QWidget& dialog) {
  QString all;
  for (const QLabel* const label : dialog.findChildren<QLabel*>())
    if (label->isVisibleTo(&dialog)) all += label->text() + '\n';
  return all;
}

void openLastStep(const QWidget& dialog) {
  auto* const step = dialog.findChild<QToolButton*>("after_printing");
  QVERIFY(!dialog.findChild<QCheckBox*>("is_measured")->isVisible());
  QTest::mouseClick(step, Qt::LeftButton);
  QVERIFY(dialog.findChild<QCheckBox*>("is_measured")->isVisible());
}

void chooseType(const PrintBoardDialog& dialog, int type) {
  auto* const types = dialog.findChild<BoardForm*>()->findChild<QComboBox*>();
  types->setCurrentIndex(type);
  emit types->activated(type);
}

}  // namespace

class TestBeforeRecording : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

 private slots:
  void initTestCase() {
    usePrivateFolders(scratch_);
    simulatedSession();
  }
  void init() { QSettings().clear(); }

  void board_isWrittenAsCoreDrawsIt_data() {
    QTest::addColumn<int>("type");
    QTest::addColumn<QString>("ending");
    for (int type = 0; type < static_cast<int>(kPatternNames.size()); ++type)
      QTest::addRow("%s as PDF", kPatternNames[static_cast<std::size_t>(type)]) << type << "pdf";
    QTest::newRow("SVG") << 0 << "svg";
    QTest::newRow("PNG") << 0 << "png";
    QTest::newRow("page that blinks") << 0 << "html";
  }
  void board_isWrittenAsCoreDrawsIt() {
    QFETCH(int, type);
    QFETCH(QString, ending);
    WindowFixture test;
    showPrintBoard(&test.window, test.window.workbench());
    auto* const dialog = test.child<PrintBoardDialog>();
    chooseType(*dialog, type);
    dialog->findChild<QComboBox*>("paper")->setCurrentText("A2");
    const Board board = dialog->board();
    QCOMPARE(static_cast<int>(board.type), type);
    const SheetOptions options = dialog->sheetOptions();
    QCOMPARE(options.paper->name, std::string("A2"));
    const QString file = scratch_.filePath("board." + ending);
    QFile::remove(file);
    dialog->saveTo(file);
    QTRY_VERIFY_WITH_TIMEOUT(dialog->findChild<QPushButton*>("open_board")->isVisible(), kPatience_ms);
    const std::string expected = ending == "pdf"   ? boardPdf(board, options, dialog->tagPrint())
                                 : ending == "svg" ? boardSvg(board, options, dialog->tagPrint())
                                 : ending == "png" ? boardPng(board, 300.0, options, dialog->tagPrint())
                                                   : blinkPage(board, options.margin_m, dialog->tagPrint());
    QVERIFY(contentOfBeforeRecording(file) == expected);
    QVERIFY(saidBy(*dialog).contains(file));
    QVERIFY(dialog->findChild<QCheckBox*>("is_measured")->isVisible());  // the next step
  }

  void measuredLength_arrivesInTheSession() {
    WindowFixture test;
    test.document().startSession(readSession(simulatedSession().toStdString()));
    QVERIFY(!test.document().boardConfirmed());
    showPrintBoard(&test.window, test.window.workbench());
    auto* const dialog = test.child<PrintBoardDialog>();
    openLastStep(*dialog);
    dialog->findChild<QCheckBox*>("is_measured")->click();
    QCOMPARE(dialog->findChild<QSpinBox*>("measured_circles")->value(), 6);  // of 11 staggered rows
    type(dialog->findChild<QLineEdit*>("measured_length"), "502.5");
    QTest::mouseClick(dialog->findChild<QPushButton*>("take_board"), Qt::LeftButton);
    QVERIFY(saidBy(*dialog).contains("The session uses this board, with its measured length"));
    const Session& session = test.document().session();
    QVERIFY(session.measured.has_value());
    QCOMPARE(session.measured->spacings, 10);
    QCOMPARE(session.measured->length_m, 0.5025);
    QVERIFY(std::abs(session.board.spacing_m - 0.05025) < 1e-12);
    QVERIFY(test.document().boardConfirmed());
    test.document().undoStack().undo();
    QVERIFY(!test.document().session().measured);
    test.document().undoStack().redo();
    answerQuestion(QMessageBox::Discard);
    QVERIFY(test.window.close());
  }

  void boardWithoutASession_isThatOfTheNextRecording() {
    WindowFixture test;
    QVERIFY(!lastPrintedBoard());
    QTest::mouseClick(test.child<QPushButton>("print_board_button"), Qt::LeftButton);
    auto* const dialog = test.child<PrintBoardDialog>();
    QVERIFY(dialog != nullptr && dialog->isVisible());
    dialog->findChild<BoardForm*>()->findChildren<QSpinBox*>().at(0)->setValue(9);
    openLastStep(*dialog);
    dialog->findChild<QCheckBox*>("is_measured")->click();
    type(dialog->findChild<QLineEdit*>("measured_length"), "161");
    QTest::mouseClick(dialog->findChild<QPushButton*>("take_board"), Qt::LeftButton);
    QVERIFY(saidBy(*dialog).contains("for the next recording that you open"));
    const Session recorded = readSession(simulatedSession().toStdString());
    test.window.files().open(QString::fromStdString(recorded.recording.string()));
    QTRY_VERIFY_WITH_TIMEOUT(test.document().hasSession(), kPatience_ms);
    QCOMPARE(test.document().session().board.rows, 9);
    QCOMPARE(test.document().session().measured->length_m, 0.161);
    QVERIFY(test.window.close());
  }

  void paperThatIsTooSmall_isSaid_andASmallerBoardIsOffered() {
    PrintBoardDialog dialog(Board{}, nullptr);
    dialog.show();
    auto* const shrink = dialog.findChild<QPushButton*>("shrink_board");
    QVERIFY(!shrink->isVisible());
    QCOMPARE(dialog.findChild<QComboBox*>("paper")->currentText(), QString("A1"));  // smallest that it fits
    dialog.findChild<QComboBox*>("paper")->setCurrentText("A4");
    QVERIFY2(saidBy(dialog).contains("A4") && saidBy(dialog).contains("larger paper"),
             qPrintable(saidBy(dialog)));
    QVERIFY(!dialog.findChild<QPushButton*>("save_board")->isEnabled());
    dialog.findChild<QComboBox*>("paper")->setCurrentText("A0");
    QVERIFY(dialog.findChild<QPushButton*>("save_board")->isEnabled());
    QVERIFY(!shrink->isVisible());
    dialog.findChild<QComboBox*>("paper")->setCurrentText("A4");
    const QString spacing =
        QLocale::c().toString(1e3 * boardThatFits(Board{}, dialog.sheetOptions(), {})->spacing_m);
    QVERIFY2(shrink->isVisible() && shrink->text().contains(spacing), qPrintable(shrink->text()));
    QTest::mouseClick(shrink, Qt::LeftButton);
    QVERIFY(dialog.findChild<QPushButton*>("save_board")->isEnabled());
    QVERIFY(std::abs(dialog.board().radius_m / dialog.board().spacing_m -
                     Board{}.radius_m / Board{}.spacing_m) < 1e-9);
    QVERIFY(!shrink->isVisible());
  }

  void usualPaperOfTheCountry_isProposed_withABoardThatFitsIt_data() {
    QTest::addColumn<QLocale>("locale");
    QTest::addColumn<QString>("paper");
    QTest::addColumn<double>("spacing_m");
    QTest::newRow("Germany") << QLocale(QLocale::German, QLocale::Germany) << "A4" << 0.021;
    QTest::newRow("United Kingdom") << QLocale(QLocale::English, QLocale::UnitedKingdom) << "A4" << 0.021;
    QTest::newRow("United States") << QLocale(QLocale::English, QLocale::UnitedStates) << "Letter" << 0.02;
  }
  void usualPaperOfTheCountry_isProposed_withABoardThatFitsIt() {
    QFETCH(const QLocale, locale);
    QFETCH(const QString, paper);
    QFETCH(const double, spacing_m);
    const auto restored = qScopeGuard([before = QLocale()] { QLocale::setDefault(before); });
    QLocale::setDefault(locale);
    WindowFixture test;
    showPrintBoard(&test.window, test.window.workbench());
    auto* const dialog = test.child<PrintBoardDialog>();
    auto* const papers = dialog->findChild<QComboBox*>("paper");
    QCOMPARE(papers->currentText(), paper);
    QCOMPARE(papers->itemText(0) + papers->itemText(1) + papers->itemText(2), QString("A4LetterA3"));
    QCOMPARE(papers->itemText(papers->count() - 1), QString("Size of the board"));
    QVERIFY(std::abs(dialog->board().spacing_m - spacing_m) < 1e-9);
    QVERIFY(dialog->findChild<QPushButton*>("save_board")->isEnabled());
  }

  void dialog_fitsASmallDisplay_withAllFieldsOfAllTypes() {
    WindowFixture test;
    showPrintBoard(&test.window, test.window.workbench());
    auto* const dialog = test.child<PrintBoardDialog>();
    openLastStep(*dialog);
    for (int type = 0; type < static_cast<int>(kPatternNames.size()); ++type) {
      chooseType(*dialog, type);
      spin(100);
      QVERIFY2(dialog->width() <= 1024 && dialog->height() <= 660,  // less the window's title
               qPrintable(QString("%1 x %2").arg(dialog->width()).arg(dialog->height())));
      for (const QScrollArea* const area : dialog->findChildren<QScrollArea*>())
        QVERIFY(area->verticalScrollBar()->maximum() == 0 && area->horizontalScrollBar()->maximum() == 0);
      QVERIFY2(clippedTexts(*dialog).isEmpty(), qPrintable(clippedTexts(*dialog).join('\n')));
      QSet<int> left_edges;
      for (const QLabel* const label : dialog->findChildren<QLabel*>())
        if (const QWidget* const field = label->buddy();
            field && field->isVisible() && !dialog->findChild<MeasuredForm*>()->isAncestorOf(field))
          left_edges << field->mapTo(dialog, QPoint()).x();
      QCOMPARE(left_edges.size(), 1);
    }
  }

  void save_offersTheFormats() {
    PrintBoardDialog dialog(Board{}, nullptr);
    dialog.show();
    QString path;
    connect(&dialog, &PrintBoardDialog::fileRequested, &dialog,
            [&path](const BoardFile& file) { path = file.path; });
    const QList<QAction*> formats = dialog.findChild<QPushButton*>("save_board")->menu()->actions();
    QCOMPARE(formats.size(), 3);
    QCOMPARE(formats[1]->text(), QString("SVG..."));
    answerFileDialog(scratch_.filePath("chosen.svg"));
    formats[1]->trigger();
    QCOMPARE(path, scratch_.filePath("chosen.svg"));
  }

  void folderThatIsNotThere_isSaid() {
    WindowFixture test;
    showPrintBoard(&test.window, test.window.workbench());
    auto* const dialog = test.child<PrintBoardDialog>();
    dialog->saveTo(scratch_.filePath("nowhere/board.pdf"));
    QTRY_VERIFY_WITH_TIMEOUT(saidBy(*dialog).contains("nowhere"), kPatience_ms);
    QTRY_VERIFY_WITH_TIMEOUT(!saidBy(*dialog).contains("Writing"), kPatience_ms);
    QVERIFY(!dialog->findChild<QPushButton*>("open_board")->isVisible());
  }

  void motions_move_andCanBeHeld() {
    HowToRecordDialog dialog(Motion::Moving, nullptr);
    dialog.resize(900, 560);
    dialog.show();
    QVERIFY(QTest::qWaitForWindowExposed(&dialog));
    auto* const picture = dialog.findChild<MotionPicture*>();
    QTRY_VERIFY(picture->share() > 0.0);
    const QImage before = picture->grab().toImage();
    QTRY_VERIFY(picture->grab().toImage() != before);
    dialog.activateWindow();
    QVERIFY(QTest::qWaitForWindowActive(&dialog));
    QTest::keyClick(QApplication::focusWidget(), Qt::Key_Space);
    QTRY_VERIFY(!picture->playing());  // a button is pressed for a moment
    const double held = picture->share();
    spin(200);
    QCOMPARE(picture->share(), held);
  }

  void motions_areStillsWherePeopleWantThat_andEachIsAnother() {
    HowToRecordDialog dialog(Motion::Reduced, nullptr);
    dialog.resize(900, 560);
    dialog.show();
    QVERIFY(QTest::qWaitForWindowExposed(&dialog));
    auto* const picture = dialog.findChild<MotionPicture*>();
    QVERIFY(!picture->playing());
    std::vector<QImage> seen;
    for (const ShownMotion& motion : shownMotions()) {
      dialog.showMotion(motion.name);
      QCOMPARE(picture->accessibleName(), motion.title);
      QVERIFY(saidBy(dialog).contains(motion.words));
      const QImage now = picture->grab().toImage();
      for (const QImage& other : seen) QVERIFY2(now != other, qPrintable(motion.name));
      seen.push_back(now);
    }
  }

  // Board, camera and arrows stay inside pictures of any shape.
  void motions_areNotCut() {
    MotionPicture picture;
    picture.setSceneOnly(true);
    for (const QSize& size : {QSize(300, 500), QSize(600, 200)}) {
      picture.resize(size);
      for (const ShownMotion& motion : shownMotions()) {
        picture.setMotion(motion);
        for (const double share : {0.0, 0.08, 0.12, 0.25, 0.42, 0.6, 0.75}) {
          picture.setShare(share);
          const QImage image = picture.grab().toImage();
          const QRect inside = image.rect().adjusted(1, 1, -1, -1);
          for (int y = 0; y < image.height(); ++y)
            for (int x = 0; x < image.width(); ++x)
              if (!inside.contains(x, y))
                QVERIFY2(image.pixel(x, y) == image.pixel(0, 0), qPrintable(motion.name));
        }
      }
    }
  }

  void motions_areSteppedThrough() {
    HowToRecordDialog dialog(Motion::Reduced, nullptr);
    dialog.show();
    const auto* const picture = dialog.findChild<MotionPicture*>();
    auto* const previous = dialog.findChild<QToolButton*>("previous_motion");
    auto* const next = dialog.findChild<QToolButton*>("next_motion");
    QVERIFY(!previous->isEnabled());
    QTest::mouseClick(next, Qt::LeftButton);
    QCOMPARE(picture->accessibleName(), shownMotions()[1].title);
    QTest::mouseClick(previous, Qt::LeftButton);
    QCOMPARE(picture->accessibleName(), shownMotions()[0].title);
    dialog.showMotion(shownMotions().back().name);
    QVERIFY(!next->isEnabled());
    // The program rates recordings by the same numbers.
    QVERIFY(saidBy(dialog).contains(QString("%1 to %2").arg(kGoodSpeed_px_s).arg(kFastSpeed_px_s)));
  }

  // The displayed motion must follow the advice itself.
  void motions_turnAndShiftAsTheyAreCalled() {
    const auto spreadOf = [](const ShownMotion& motion) {
      Eigen::Matrix<double, 6, 1> largest = Eigen::Matrix<double, 6, 1>::Zero();
      for (int i = 0; i < 100; ++i) {
        const RigidTransform pose = motion.world_from_camera(0.01 * i);
        const Eigen::AngleAxisd turn(pose.rotation);
        largest.head<3>() = largest.head<3>().cwiseMax((turn.angle() * turn.axis()).cwiseAbs());
        largest.tail<3>() = largest.tail<3>().cwiseMax(pose.translation_m.cwiseAbs());
      }
      return largest;
    };
    const std::vector<std::pair<QString, int>> along = {{"left_right", 1}, {"up_down", 0}, {"about_lens", 2},
                                                        {"sideways", 3},   {"upwards", 4}, {"nearer", 5}};
    for (const auto& [name, axis] : along)
      for (const ShownMotion& motion : shownMotions()) {
        if (motion.name != name) continue;
        Eigen::Index most = 0;
        spreadOf(motion).maxCoeff(&most);
        QCOMPARE(static_cast<int>(most), axis);
      }
    QVERIFY((spreadOf(shownMotions().back()).array() > 0.03).all());
  }
};

EVICAL_TEST(TestBeforeRecording)
#include "tst_before_recording.moc"
