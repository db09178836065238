// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/recording_screen.h"

#include "core/format/intrinsics_yaml.h"
#include "core/geometry/camera_model.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/session/session_guess.h"
#include "tests/support/test_program.h"
#include "tests/ui/simulated_session.h"
#include "ui/forms/form_words.h"
#include "ui/forms/number_field.h"
#include "ui/screens/board/board_drawing.h"
#include "ui/screens/board/board_form.h"
#include "ui/screens/recording/camera_form.h"
#include "ui/screens/recording/check_card.h"
#include "ui/screens/recording/imu_form.h"
#include "ui/screens/recording/stream_table.h"
#include "ui/screens/recording/time_range_form.h"
#include "ui/theme/theme.h"

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QScrollArea>
#include <QScrollBar>
#include <QSignalSpy>
#include <QSpinBox>
#include <QTemporaryDir>
#include <QToolButton>

using namespace evical;
using namespace evical::ui;

namespace {

// The screen with a session, wired like in the window.
struct RecordingScreenFixture {
  Session session;
  std::shared_ptr<const Inspection> inspection;
  RecordingScreen screen;
  QStringList edits;

  RecordingScreenFixture() {
    session = readSession(evical::ui::test::simulatedSession().toStdString());
    const auto reader = openRecording(session.recording);
    inspection = std::make_shared<Inspection>(inspectRecording(*reader));
    QObject::connect(&screen, &RecordingScreen::sessionEdited, &screen,
                     [this](const Session& changed, const QString& what) {
                       edits << what;
                       session = changed;
                       screen.setSession(session);
                     });
    screen.setSession(session);
    screen.addInspection(QString::fromStdString(session.recording.string()), inspection);
    screen.resize(1040, 680);
    screen.show();
  }
  StreamTable* streams() { return screen.findChild<StreamTable*>(); }
  void choose(int row, StreamRole role) {
    auto* const box = streams()->cellWidget(row, 0)->findChild<QComboBox*>();
    box->setCurrentIndex(box->findData(static_cast<int>(role)));
    emit box->activated(box->currentIndex());
  }
  // An assessment with all criteria, on the card.
  void assess() {
    RecordingAssessment assessment;
    for (int thing = 0; thing < static_cast<int>(AssessedThing::Obstacle); ++thing)
      assessment.all.push_back(
          {static_cast<AssessedThing>(thing), "left", Light::Fair, "1 s", "2 s", "Record for longer."});
    assessment.board_seen = assessment.can_be_calibrated = true;
    screen.checkCard()->setAssessment(assessment);
    QApplication::processEvents();
  }
  QScrollArea* page() {
    return qobject_cast<QScrollArea*>(screen.checkCard()->parentWidget()->parentWidget()->parentWidget());
  }
  int top(QWidget* widget) { return widget->mapTo(&screen, QPoint()).y(); }
  int bottom(QWidget* widget) { return top(widget) + widget->height(); }
  static void type(QLineEdit* field, const QString& text) {
    field->selectAll();
    QTest::keyClicks(field, text);
    QTest::keyClick(field, Qt::Key_Return);
  }
  QString problems() {
    QStringList shown;
    for (const QLabel* const label : screen.findChildren<QLabel*>()) {
      if (label->property("role") == "problem" && !label->isHidden()) shown << label->text();
    }
    return shown.join('\n');
  }
};

}  // namespace

class TestRecordingScreen : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() { applyTheme(*qApp, Appearance::Light); }

  void longFileName_doesNotWidenThePage() {
    RecordingScreenFixture test;
    QApplication::processEvents();
    const int width_px = test.page()->widget()->minimumSizeHint().width();
    test.session.recording = "/data/" + std::string(200, 'x') + ".bag";
    test.screen.setSession(test.session);
    test.screen.addInspection(QString::fromStdString(test.session.recording.string()), test.inspection);
    QApplication::processEvents();
    QCOMPARE(test.page()->widget()->minimumSizeHint().width(), width_px);
    QCOMPARE(test.page()->horizontalScrollBar()->maximum(), 0);
  }

  void streams_areListedWithRatesAndRoles() {
    RecordingScreenFixture test;
    QCOMPARE(test.streams()->rowCount(), 2);
    QStringList all;
    for (int row = 0; row < 2; ++row)
      for (int column = 1; column < test.streams()->columnCount(); ++column)
        all << test.streams()->item(row, column)->text();
    QVERIFY(all.contains("/davis_left/events"));
    QVERIFY(all.contains("events, 346 x 260 px"));
    QVERIFY(all.contains("1000.0 Hz"));
    QCOMPARE(test.streams()->role(all.indexOf("/davis_left/events") == 0 ? 0 : 1), StreamRole::Camera);
  }

  void fewHotPixels_areNoWarning() {
    RecordingScreenFixture test;
    const auto faultsOf = [&](StreamRole role) {
      return test.streams()->item(test.streams()->role(0) == role ? 0 : 1, 6);
    };
    const QTableWidgetItem* const note = faultsOf(StreamRole::Camera);
    QVERIFY2(note->text().contains("hot pixels"), qPrintable(note->text()));
    QVERIFY(!note->text().contains(QRegularExpression("\\(\\d+, ")));  // a pixel stays on one line
    QVERIFY(note->icon().isNull() && note->toolTip().contains("No faults found"));
    QVERIFY(!faultsOf(StreamRole::Imu)->icon().isNull());
    Inspection faulty = *test.inspection;
    faulty.faults = {{faulty.streams[0].info.name, FaultKind::HotPixels, 0.0, "Many hot pixels."}};
    test.screen.addInspection("other.bag", std::make_shared<Inspection>(faulty));
    QCOMPARE(test.streams()->item(2, 6)->text(), QString("Many hot pixels."));
    QVERIFY(!test.streams()->item(2, 6)->icon().isNull());
  }

  void detailsOfTheCheck_leaveTheForms() {
    RecordingScreenFixture test;
    test.assess();
    auto* const form = test.screen.findChild<BoardForm*>();
    test.screen.checkCard()->findChild<QToolButton*>("check_details")->click();
    QApplication::processEvents();
    QVERIFY2(test.screen.checkCard()->text().contains("1 s, required 2 s"),
             qPrintable(test.screen.checkCard()->text()));
    QVERIFY(form->isVisible() && form->height() > 100);
    QVERIFY(test.top(form) > test.bottom(test.screen.checkCard()));
    QVERIFY(test.page()->verticalScrollBar()->maximum() > 0);
  }

  // A check that starts, ends or fails, and problems that come and go: nothing moves under the mouse.
  void fields_stayInPlace_whateverTheCheckShows() {
    RecordingScreenFixture test;
    test.screen.resize(1027, 685);
    QApplication::processEvents();
    std::vector<QWidget*> fields;
    for (const char* const form : {"BoardForm", "CameraForm", "StreamTable"})
      for (QWidget* const widget : test.screen.findChildren<QWidget*>())
        if (QString(widget->metaObject()->className()).endsWith(form)) {
          fields.push_back(widget);
          for (NumberField* const field : widget->findChildren<NumberField*>())
            if (field->isVisible()) fields.push_back(field);
        }
    QVERIFY(fields.size() > 5);
    const auto places = [&] {
      QApplication::processEvents();
      std::vector<QRect> all;
      for (QWidget* const field : fields)
        all.emplace_back(field->mapTo(&test.screen, QPoint()), field->size());
      return all;
    };
    const std::vector<QRect> before = places();
    CheckCard& card = *test.screen.checkCard();
    card.setChecking(0.1);
    QVERIFY(places() == before);
    test.assess();
    QVERIFY(places() == before);
    card.setUnconfirmedBoard("11 x 4, 50 mm");
    QVERIFY(places() == before);
    card.setFailed(QString("the board was never found in 250 windows ").repeated(12));
    QVERIFY(places() == before);
    card.offerFollowing(true);
    QVERIFY(places() == before);
    card.offerFollowing(false);
    card.setUnconfirmedBoard({});
    test.screen.setProblems(
        {{"board.radius_m", "must be less than half"}, {"cameras.left.intrinsics", "bad"}, {"imus", "x"}});
    QVERIFY(places() == before);
    QVERIFY(test.problems().contains("bad") && test.problems().contains("x"));
    test.screen.setProblems({});
    card.clear();
    QVERIFY(card.isVisible() && !card.text().contains("Record for longer"));
    QVERIFY(places() == before);
    card.clear("This recording is calibrated", QString("The page Result shows more. ").repeated(12));
    QVERIFY(places() == before);
    // The same with the table of checks.
    card.findChild<QToolButton*>("check_details")->setChecked(true);
    test.assess();
    const std::vector<QRect> with_table = places();
    card.setChecking(0.1);
    QVERIFY(places() == with_table);
    card.clear();
    QVERIFY(places() == with_table);
    // With the result no check is due: neither a blank place nor a button without effect remains.
    card.clear("This recording is calibrated", "The page Result shows more.");
    QVERIFY(places() == before && !card.findChild<QToolButton*>("check_details")->isVisible());
  }

  // The form has millimetres and labels, a session file metres and keys.
  void messages_haveTheWordsOfTheForm() {
    RecordingScreenFixture test;
    test.screen.setProblems(
        {{"board.spacing_m", "must be greater than 0. Measure it on the print, in metres"}});
    QVERIFY2(test.problems().contains("in millimetres"), qPrintable(test.problems()));
    QCOMPARE(inFormWords("the board seems 100 % larger than specified (spacing 0.025 m): measure it"),
             QString("the board seems 100 % larger than specified (spacing 25 mm): measure it"));
    QCOMPARE(inFormWords("set board.spacing_m: 0.05"), QString("set spacing 50 mm"));
    QCOMPARE(inFormWords("Set radius_m to 0.0125"), QString("Set radius to 12.5 mm"));
    QCOMPARE(inFormWords("the board is 0.5 m away"), QString("the board is 0.5 m away"));
  }

  // A number that is longer than its field shows its start.
  void longNumbers_showTheirStart() {
    RecordingScreenFixture test;
    Session session = test.session;
    session.cameras.front().intrinsics->distortion[0] = -0.380015228531;
    test.screen.setSession(session);
    int looked = 0;
    for (const NumberField* const field :
         test.screen.findChild<CameraForm*>()->findChildren<NumberField*>()) {
      QCOMPARE(field->cursorPosition(), 0);
      ++looked;
    }
    QVERIFY(looked > 8);
  }

  // A window of 1280 x 800.
  void lensOfACamera_isSeenWithoutScrolling() {
    RecordingScreenFixture test;
    test.screen.resize(1027, 685);
    test.assess();
    QCOMPARE(test.page()->verticalScrollBar()->maximum(), 0);
    const auto fields = test.screen.findChild<CameraForm*>()->findChildren<NumberField*>();
    int seen = 0;
    for (const NumberField* const field : fields) {
      if (!field->isVisible()) continue;
      QVERIFY2(field->visibleRegion().boundingRect() == field->rect(), qPrintable(field->accessibleName()));
      ++seen;
    }
    QCOMPARE(seen, 11);  // two each of resolution, focal length and principal point; five coefficients
  }

  void smallPage_scrolls() {
    RecordingScreenFixture test;
    test.screen.resize(900, 300);
    QApplication::processEvents();
    QVERIFY(test.page()->verticalScrollBar()->maximum() > 0);
    QVERIFY(test.top(test.screen.findChild<TimeRangeForm*>()) >= test.bottom(test.streams()));
    QCOMPARE(test.page()->horizontalScrollBar()->maximum(), 0);
  }

  void role_ignored_takesTheSensorOut_andBack() {
    RecordingScreenFixture test;
    const int imu_row = test.streams()->role(0) == StreamRole::Imu ? 0 : 1;
    test.choose(imu_row, StreamRole::Ignore);
    QVERIFY(test.session.imus.empty());
    test.choose(imu_row, StreamRole::Imu);
    QCOMPARE(test.session.imus.size(), std::size_t{1});
    QCOMPARE(test.session.reference, test.session.imus[0].name);
    QCOMPARE(test.edits.size(), 2);
  }

  void framesAndPoints_mayBeCameras() {
    RecordingScreenFixture test;
    StreamSummary frames;
    frames.info.name = "/cam0/image_raw";
    frames.info.type = StreamType::Frames;
    frames.info.resolution_px = {752, 480};
    frames.count = 300;
    StreamSummary untimed = frames;
    untimed.info.name = "pictures";
    untimed.info.timed = false;
    StreamSummary points = frames;
    points.info.name = "corners.csv";
    points.info.type = StreamType::Points;
    test.screen.addInspection(
        "frames.bag", std::make_shared<Inspection>(Inspection{"rosbag", {frames, untimed, points}, {}}));
    QCOMPARE(test.streams()->item(2, 2)->text(), QString("frames, 752 x 480 px"));
    test.choose(2, StreamRole::Camera);
    QCOMPARE(test.session.cameras.back().stream, frames.info.name);
    QCOMPARE(test.session.cameras.back().recording.string(), std::string("frames.bag"));
    test.choose(4, StreamRole::Camera);
    QCOMPARE(test.session.cameras.size(), std::size_t{3});
    QVERIFY(!test.streams()->cellWidget(3, 0)->findChild<QComboBox*>()->isEnabled());
  }

  void role_isReadInFull() {
    RecordingScreenFixture test;
    QApplication::processEvents();
    for (int row = 0; row < test.streams()->rowCount(); ++row) {
      const auto* const box = test.streams()->cellWidget(row, 0)->findChild<QComboBox*>();
      QVERIFY(box->width() >= box->sizeHint().width());
    }
  }

  void board_isEdited() {
    RecordingScreenFixture test;
    auto* const form = test.screen.findChild<BoardForm*>();
    form->findChildren<QSpinBox*>().at(0)->setValue(9);
    QCOMPARE(test.session.board.rows, 9);
    RecordingScreenFixture::type(form->findChildren<NumberField*>().at(0), "35.5");
    QCOMPARE(test.session.board.spacing_m, 0.0355);
    QCOMPARE(test.edits.size(), 2);
  }

  void boardOfAnotherType_hasItsOwnSizes() {
    RecordingScreenFixture test;
    auto* const form = test.screen.findChild<BoardForm*>();
    QComboBox* const type = form->findChildren<QComboBox*>().at(0);
    NumberField *const radius = form->findChildren<NumberField*>().at(1),
                       *const tag = form->findChildren<NumberField*>().at(2);
    QVERIFY(radius->isVisible() && !tag->isVisible());
    const auto choose = [&](const QString& name) {
      type->setCurrentText(name);
      emit type->activated(type->currentIndex());
    };
    choose("AprilGrid");
    QVERIFY(test.session.board.type == BoardType::AprilGrid && test.session.board.radius_m == 0.0);
    QVERIFY(!radius->isVisible() && tag->isVisible());
    validate(test.session.board);
    RecordingScreenFixture::type(tag, "30");
    QCOMPARE(test.session.board.tag_size_m, 0.03);
    choose("Asymmetric (staggered)");
    QVERIFY(test.session.board.tag_size_m == 0.0 && test.session.board.radius_m > 0.0);
    validate(test.session.board);
  }

  void boardOfMoreTagsThanThereAre_isSaidInsteadOfDrawn() {
    BoardDrawing drawing;
    drawing.resize(400, 400);
    Board board;
    board.type = BoardType::AprilGrid;
    board.radius_m = 0.0;
    board.tag_size_m = 0.04;
    const auto inkOf = [&](int rows) {
      board.rows = board.cols = rows;
      drawing.setBoard(board);
      const QImage picture = drawing.grab().toImage();
      return picture.pixelColor(200, 200).lightness() < 60 || picture.pixelColor(206, 206).lightness() < 60;
    };
    QVERIFY(inkOf(3));    // in the middle a tag
    QVERIFY(!inkOf(25));  // 625
  }

  // The sheet's margin grows with the drawing; the ruler above stays at its place.
  void largeDrawing_hasItsMeasureInIt() {
    BoardDrawing drawing;
    drawing.resize(1000, 1200);
    drawing.setBoard({});
    const QImage picture = drawing.grab().toImage();
    int of_measure = 0;
    for (int y = 0; y < picture.height(); ++y)
      for (int x = 0; x < picture.width(); ++x) {
        const QColor blue = picture.pixelColor(x, y);  // as nothing else in it
        of_measure += blue.blue() > blue.red() + 60 ? 1 : 0;
      }
    QVERIFY2(of_measure > 100, qPrintable(QString::number(of_measure)));  // a line as long as two spacings
  }

  void boardMeasuredOverManySpacings_tellsSpacingAndSigma() {
    RecordingScreenFixture test;
    auto* const form = test.screen.findChild<BoardForm*>();
    auto* const measured = form->findChild<QCheckBox*>();
    NumberField* const spacing = form->findChildren<NumberField*>().at(0);
    NumberField *const length = form->findChildren<NumberField*>().at(3),
                       *const sigma = form->findChildren<NumberField*>().at(4);
    QSpinBox* const spacings = form->findChildren<QSpinBox*>().at(2);
    QVERIFY(!measured->isChecked() && spacing->isEnabled() && !length->isVisible());
    measured->click();
    QVERIFY(test.session.measured == (MeasuredLength{10, 10 * test.session.board.spacing_m, 0.0005}));
    QVERIFY(!spacing->isEnabled() && length->isVisible());
    RecordingScreenFixture::type(length, "352");
    QCOMPARE(test.session.board.spacing_m, 0.352 / 10);
    QCOMPARE(spacing->text(), QString("35.2"));
    spacings->setValue(8);
    QCOMPARE(test.session.board.spacing_m, 0.352 / 8);
    RecordingScreenFixture::type(sigma, "0.2");
    QCOMPARE(test.session.options.optimisation->board_spacing_sigma, 0.0002 / 0.352);
    QCOMPARE(test.edits.size(), 4);
    measured->click();
    QVERIFY(!test.session.measured && spacing->isEnabled());
    QCOMPARE(test.session.board.spacing_m, 0.352 / 8);
    QCOMPARE(test.session.options.optimisation->board_spacing_sigma, PriorOptions().board_spacing_sigma);
  }

  void timeRange_isEdited_andEmptyMeansAll() {
    RecordingScreenFixture test;
    auto* const begin = test.screen.findChild<QLineEdit*>("time_range_begin");
    auto* const end = test.screen.findChild<QLineEdit*>("time_range_end");
    auto* const words = test.screen.findChild<QLabel*>("time_range_words");
    QVERIFY(words->text().contains("All of the recording"));
    RecordingScreenFixture::type(begin, "0.5");
    QVERIFY(test.session.time_range_s.has_value());
    QCOMPARE((*test.session.time_range_s)[0], 0.5);
    QVERIFY((*test.session.time_range_s)[1] > 3.0);  // the recording's end
    RecordingScreenFixture::type(end, "2,5");
    QCOMPARE((*test.session.time_range_s)[1], 2.5);
    QVERIFY2(words->text().startsWith("2 s"), qPrintable(words->text()));
    QTest::mouseClick(test.screen.findChild<TimeRangeForm*>()->findChild<QToolButton*>(), Qt::LeftButton);
    QVERIFY(!test.session.time_range_s);
    QVERIFY(begin->text().isEmpty() && end->text().isEmpty());
    QCOMPARE(test.edits, QStringList(3, "Change the time range"));
  }

  void timeRange_thatIsNone_isExplained_andChangesNothing_data() {
    QTest::addColumn<QString>("begin");
    QTest::addColumn<QString>("end");
    QTest::addColumn<QString>("words");
    QTest::newRow("no number") << "soon"
                               << ""
                               << "Enter seconds";
    QTest::newRow("negative") << "-1"
                              << ""
                              << "Enter seconds";
    QTest::newRow("not finite") << "0"
                                << "inf"
                                << "Enter seconds";
    QTest::newRow("end first") << "2"
                               << "1"
                               << "after the begin";
    QTest::newRow("beyond the recording") << "99"
                                          << "100"
                                          << "ends at";
  }
  void timeRange_thatIsNone_isExplained_andChangesNothing() {
    QFETCH(QString, begin);
    QFETCH(QString, end);
    QFETCH(QString, words);
    RecordingScreenFixture test;
    test.session.time_range_s = {0.25, 1.75};
    test.screen.setSession(test.session);
    test.edits.clear();
    auto* const begin_field = test.screen.findChild<QLineEdit*>("time_range_begin");
    auto* const end_field = test.screen.findChild<QLineEdit*>("time_range_end");
    begin_field->setText(begin);
    end_field->setText(end);
    QTest::keyClick(end_field, Qt::Key_Return);
    auto* const shown = test.screen.findChild<QLabel*>("time_range_words");
    QVERIFY2(shown->text().contains(words), qPrintable(shown->text()));
    QCOMPARE(shown->property("role").toString(), QString("problem"));
    QVERIFY(test.edits.isEmpty());
    QCOMPARE(begin_field->text(), begin);  // to be corrected
  }

  void units_areTheFormats_untilTheyAreGiven() {
    RecordingScreenFixture test;
    test.session.imus[0].angular_rate_unit.reset();
    test.session.imus[0].acceleration_unit.reset();
    test.screen.setSession(test.session);
    const auto boxes = test.screen.findChild<ImuForm*>()->findChildren<QComboBox*>();
    for (const QComboBox* const units : {boxes.at(1), boxes.at(2)}) {
      QCOMPARE(units->currentText(), QString("from the file"));
      QVERIFY(!units->toolTip().isEmpty());
    }
    boxes.at(2)->setCurrentIndex(2);
    emit boxes.at(2)->activated(2);
    QCOMPARE(test.session.imus[0].acceleration_unit, std::optional(AccelerationUnit::Gravity));
    QVERIFY(!test.session.imus[0].angular_rate_unit);
  }

  void noisePreset_setsBothDensities_andNoMore() {
    RecordingScreenFixture test;
    test.session.imus[0].noise.gyroscope_random_walk = 2e-5;
    test.screen.setSession(test.session);
    auto* const presets = test.screen.findChild<ImuForm*>()->findChildren<QComboBox*>().at(0);
    presets->setCurrentText("Bosch BMI160, typical");
    QCOMPARE(presets->currentText(), QString("Bosch BMI160, typical"));
    emit presets->activated(presets->currentIndex());
    QVERIFY(qAbs(test.session.imus[0].noise.gyroscope_density - 1.2217e-4) < 1e-8);
    QVERIFY(qAbs(test.session.imus[0].noise.accelerometer_density - 1.7652e-3) < 1e-7);
    QCOMPARE(test.session.imus[0].noise.gyroscope_random_walk, 2e-5);
  }

  void numberThatIsNone_isMarked_andGivesWayToTheOneThatHolds() {
    RecordingScreenFixture test;
    auto* const density = test.screen.findChild<ImuForm*>()->findChildren<NumberField*>().at(0);
    RecordingScreenFixture::type(density, "much");
    QVERIFY(density->hasRefused());
    QVERIFY(test.edits.isEmpty());
    QCOMPARE(density->text().toDouble(), test.session.imus[0].noise.gyroscope_density);
    RecordingScreenFixture::type(density, "2e-4");
    QVERIFY(!density->hasRefused());
    QCOMPARE(test.session.imus[0].noise.gyroscope_density, 2e-4);
  }

  void intrinsics_areReadFromAFile() {
    RecordingScreenFixture test;
    QTemporaryDir folder;
    QFile file(folder.filePath("camera.yaml"));
    QVERIFY(file.open(QIODevice::WriteOnly));
    CameraIntrinsics other = *test.session.cameras[0].intrinsics;
    other.focal_length_px = {300.0, 301.0};
    file.write(intrinsicsYaml(other, 0).c_str());
    file.close();
    auto* const form = test.screen.findChild<CameraForm*>();
    form->loadIntrinsics(file.fileName());
    QCOMPARE(test.session.cameras[0].intrinsics->focal_length_px.x(), 300.0);
    form->loadIntrinsics(evical::ui::test::simulatedSession());
    QVERIFY(!test.problems().isEmpty());
    QCOMPARE(test.session.cameras[0].intrinsics->focal_length_px.x(), 300.0);
  }

  void intrinsics_mayBeLeftToTheRecording() {
    RecordingScreenFixture test;
    auto* const form = test.screen.findChild<CameraForm*>();
    auto* const model = form->findChild<QComboBox*>();
    const auto choose = [&](int index) {
      model->setCurrentIndex(index);
      emit model->activated(index);
    };
    const int not_known = model->count() - 1;
    choose(not_known);
    QVERIFY(!test.session.cameras[0].intrinsics);
    QCOMPARE(model->currentIndex(), not_known);
    choose(1);
    QVERIFY(test.session.cameras[0].intrinsics);
    QVERIFY(test.session.cameras[0].intrinsics->model == CameraModel::PinholeEquidistant);
  }

  // The fields are those of the model, with the start values of such a lens.
  void coefficients_areThoseOfTheModel() {
    RecordingScreenFixture test;
    auto* const form = test.screen.findChild<CameraForm*>();
    auto* const model = form->findChild<QComboBox*>();
    const double focal_px = test.session.cameras[0].intrinsics->focal_length_px.x();
    const std::pair<CameraModel, QString> models[] = {{CameraModel::DoubleSphere, "xi, alpha"},
                                                      {CameraModel::Eucm, "alpha, beta"},
                                                      {CameraModel::OmniRadtan, "xi, k1, k2, p1, p2"},
                                                      {CameraModel::PinholeEquidistant, "k1, k2, k3, k4"}};
    for (const auto& [lens, names] : models) {
      model->setCurrentIndex(static_cast<int>(lens));
      emit model->activated(static_cast<int>(lens));
      const CameraIntrinsics& typed = *test.session.cameras[0].intrinsics;
      QVERIFY(typed.model == lens);
      validate(typed, "left");
      QVERIFY(std::abs(idealFocalLength_px(typed).x() - focal_px) < 1e-9);
      QCOMPARE(form->findChild<QLabel*>("coefficient_names")->text(), names);
    }
  }

  void rename_keepsTheReference() {
    RecordingScreenFixture test;
    auto* const name = test.screen.findChild<ImuForm*>()->findChildren<QLineEdit*>().at(0);
    RecordingScreenFixture::type(name, "handheld");
    QCOMPARE(test.session.imus[0].name, std::string("handheld"));
    QCOMPARE(test.session.reference, std::string("handheld"));
  }

  void shutterAndSensor_areChosen() {
    RecordingScreenFixture test;
    SessionCamera frames;
    frames.name = "frames";
    frames.stream = "/davis_left/image_raw";
    test.session.cameras.push_back(frames);
    test.screen.setSession(test.session);
    const auto nameOf = [](CameraForm* form) { return form->findChildren<QLineEdit*>().at(0); };
    const auto formOf = [&](const QString& camera) {
      for (CameraForm* const form : test.screen.findChildren<CameraForm*>())
        if (nameOf(form)->text() == camera) return form;
      return static_cast<CameraForm*>(nullptr);
    };
    const QString first = QString::fromStdString(test.session.cameras[0].name);
    const auto choose = [&](const char* box_name, int index) {
      auto* const box = formOf("frames")->findChild<QComboBox*>(box_name);
      box->setCurrentIndex(index);
      emit box->activated(index);
    };
    QVERIFY(formOf(first)->findChild<QComboBox*>("shutter")->isHidden());  // of events
    QVERIFY(!formOf("frames")->findChild<QComboBox*>("shutter")->isHidden());
    choose("shutter", 1);
    QVERIFY(test.session.cameras[1].shutter == Shutter::Rolling);
    choose("same_sensor_as", 1);
    QCOMPARE(test.session.cameras[1].same_sensor_as, first.toStdString());
    RecordingScreenFixture::type(nameOf(formOf(first)), "davis");
    QCOMPARE(test.session.cameras[1].same_sensor_as, std::string("davis"));
    // A camera whose sensor another one uses cannot use that of a third one.
    QCOMPARE(formOf("davis")->findChild<QComboBox*>("same_sensor_as")->count(), 1);
  }

  void problems_areSaidAtTheirFields() {
    RecordingScreenFixture test;
    test.screen.setProblems({{"cameras.left.intrinsics", "no intrinsics"}, {"board", "circles touch"}});
    const auto ofBoard = test.screen.findChild<BoardForm*>()->findChildren<QLabel*>();
    QVERIFY(std::any_of(ofBoard.begin(), ofBoard.end(),
                        [](const QLabel* label) { return label->text() == "circles touch"; }));
    QVERIFY(test.problems().contains("no intrinsics"));
    test.screen.setProblems({});
    QVERIFY(test.problems().trimmed().isEmpty());
  }

  void sensorsOfAnotherFile_areListedAndUsed() {
    RecordingScreenFixture test;
    const QString other = "/elsewhere/other.bag";
    auto* const clock_offset = test.screen.findChild<ImuForm*>()->findChildren<NumberField*>().last();
    QVERIFY(!clock_offset->isVisibleTo(&test.screen));
    test.screen.addInspection(other, test.inspection);
    QCOMPARE(test.streams()->rowCount(), 4);
    const int imu_row = test.streams()->role(0) == StreamRole::Imu ? 0 : 1;
    QCOMPARE(test.streams()->role(2 + imu_row), StreamRole::Ignore);  // of the same name, but not the same
    QVERIFY(test.streams()->item(2 + imu_row, 1)->text().startsWith("other.bag: /davis_left/"));
    test.choose(2 + imu_row, StreamRole::Imu);
    QCOMPARE(test.session.imus.size(), std::size_t{2});
    QCOMPARE(test.session.imus[1].recording.string(), other.toStdString());
    QVERIFY(test.session.imus[0].recording.empty());
    test.choose(imu_row, StreamRole::Ignore);
    QCOMPARE(test.session.imus.size(), std::size_t{1});
    QCOMPARE(test.session.reference, test.session.imus[0].name);
    QCOMPARE(test.streams()->role(2 + imu_row), StreamRole::Imu);
    auto* const offset = test.screen.findChild<ImuForm*>()->findChildren<NumberField*>().last();
    QVERIFY(offset->isVisibleTo(offset->parentWidget()));
    RecordingScreenFixture::type(offset, "-12.5");
    QCOMPARE(test.session.imus[0].clock_offset_s, -12.5);
  }

  void missingSensors_areTakenFromAnotherRecording() {
    RecordingScreenFixture test;
    Session session = test.session;
    QCOMPARE(withMissingSensors(session, "other.bag", *test.inspection).imus.size(), std::size_t{1});
    session.imus.clear();
    session.reference = "left";
    session = withMissingSensors(session, "other.bag", *test.inspection);
    QCOMPARE(session.cameras.size(), std::size_t{1});
    QCOMPARE(session.imus.at(0).recording.string(), std::string("other.bag"));
    QCOMPARE(session.reference, session.imus.at(0).name);
  }

  void guessedSession_takesTheStreamsAsTheyAre() {
    RecordingScreenFixture test;
    const Session guessed = guessedSession("some.bag", *test.inspection);
    QCOMPARE(guessed.cameras.at(0).stream, std::string("/davis_left/events"));
    QCOMPARE(guessed.cameras.at(0).name, std::string("davis_left"));
    QCOMPARE(guessed.cameras.at(0).resolution_px, (Resolution{346, 260}));
    QCOMPARE(guessed.imus.at(0).name, std::string("davis_left_imu"));
    QCOMPARE(guessed.reference, std::string("davis_left_imu"));
    QVERIFY(!guessed.cameras.at(0).intrinsics);
  }
};

EVICAL_TEST(TestRecordingScreen)
#include "tst_recording_screen.moc"
