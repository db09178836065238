#include "core/pipeline/session/session_boards.h"

#include "core/base/error.h"
#include "core/optimisation/optimisation_options.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <fstream>

using namespace evical;

namespace {

// Three boards, of which the first of three cameras sees the first, and so on.
Session threeBoards() {
  Session session;
  session.board_name = "plate";
  session.further_boards = {SessionBoard{{"tags", {}, 0.004}}, SessionBoard{{"wall", {}, {}}}};
  session.further_boards[0].board = {BoardType::AprilGrid, 6, 6, 0.1, 0.0, CircleShade::Dark, 0.08, {}};
  session.further_boards[1].board = {BoardType::Checkerboard, 6, 9, 0.04, 0.0, CircleShade::Dark, 0.0, {}};
  const std::vector<std::string> names = boardNames(session);
  for (std::size_t k = 0; k < names.size(); ++k) {
    session.cameras.push_back({"camera" + std::to_string(k), "/stream" + std::to_string(k), {}, {}});
    session.cameras.back().board = names[k];
  }
  session.imus.emplace_back();
  session.imus[0].name = session.reference = "imu";
  session.imus[0].stream = "/imu";
  return session;
}

std::vector<std::string> seen(const Session& session) {
  std::vector<std::string> names;
  for (const SessionCamera& camera : session.cameras) names.push_back(camera.board);
  return names;
}

using Names = std::vector<std::string>;

}  // namespace

class TestSessionBoards : public QObject {
  Q_OBJECT

 private slots:
  void addedBoard_isACopyUnderAFreeName() {
    Session session = threeBoards();
    addBoard(1, session);
    QCOMPARE(boardNames(session), (Names{"plate", "tags", "wall", "tags_2"}));
    QVERIFY(boardAt(session, 3) == boardAt(session, 1));
    QCOMPARE(session.further_boards[2].spacing_std, std::optional(0.004));
    addBoard(3, session);
    QCOMPARE(boardNames(session).back(), std::string("tags_3"));
    session.cameras[0].name = "plate_2";
    addBoard(0, session);
    QCOMPARE(boardNames(session).back(), std::string("plate_3"));
    QCOMPARE(seen(session), (Names{"plate", "tags", "wall"}));
  }

  // With a single board, no camera names its board.
  void secondBoard_leavesTheCamerasAtTheFirst_andGoesWithoutATrace() {
    Session session = threeBoards();
    session.further_boards.clear();
    session.board_name = "board";
    for (SessionCamera& camera : session.cameras) camera.board.clear();
    const std::string before = sessionYaml(session, "/");
    addBoard(0, session);
    QCOMPARE(seen(session), (Names{"board", "board", "board"}));
    session.cameras[2].board = "board_2";
    settleBoards(session);
    validate(session.board);
    validateBoards(session, "session");
    removeBoard(1, session);
    QCOMPARE(sessionYaml(session, "/"), before);
  }

  void removedBoard_leavesItsCamerasToTheWorlds() {
    Session session = threeBoards();
    removeBoard(1, session);
    QCOMPARE(boardNames(session), (Names{"plate", "wall"}));
    QCOMPARE(seen(session), (Names{"plate", "plate", "wall"}));
    validateBoards(session, "session");
  }

  void removedWorld_isFollowedByTheNext() {
    Session session = threeBoards();
    removeBoard(0, session);
    QCOMPARE(boardNames(session), (Names{"tags", "wall"}));
    QVERIFY(session.board.type == BoardType::AprilGrid);
    QCOMPARE(session.options.optimisation->board_spacing_sigma, 0.004);
    QCOMPARE(seen(session), (Names{"tags", "tags", "wall"}));
    validateBoards(session, "session");
  }

  void renamedBoard_keepsItsCameras() {
    Session session = threeBoards();
    renameBoard(0, "sheet", session);
    renameBoard(2, "left wall", session);
    QCOMPARE(boardNames(session), (Names{"sheet", "tags", "left wall"}));
    QCOMPARE(seen(session), (Names{"sheet", "tags", "left wall"}));
    renameBoard(1, "tags", session);  // its current name
    validateBoards(session, "session");
  }

  void badName_isRefused_data() {
    QTest::addColumn<QString>("name");
    QTest::addColumn<QString>("said");
    QTest::newRow("empty") << ""
                           << "empty";
    QTest::newRow("another board's") << "wall"
                                     << "another board's";
    QTest::newRow("the world's") << "plate"
                                 << "another board's";
    QTest::newRow("a camera's") << "camera1"
                                << "sensor's";
    QTest::newRow("an IMU's") << "imu"
                              << "sensor's";
  }
  void badName_isRefused() {
    QFETCH(QString, name);
    QFETCH(QString, said);
    Session session = threeBoards();
    try {
      renameBoard(1, name.toStdString(), session);
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      QCOMPARE(error.place(), std::string("boards.tags"));
      QVERIFY2(QString::fromStdString(error.problem()).contains(said), error.problem().c_str());
    }
    QCOMPARE(boardNames(session), (Names{"plate", "tags", "wall"}));
  }

  // The accuracy of each board is unchanged, whichever of them the options refer to.
  void worldCameraThatSeesAnother_makesThatTheWorlds() {
    Session session = threeBoards();
    const double of_plate = session.options.optimisation->board_spacing_sigma;
    session.cameras[0].board = "tags";
    session.cameras[1].board = "plate";
    QVERIFY_THROWS_EXCEPTION(CalibrationError, validateBoards(session, "session"));
    settleBoards(session);
    validateBoards(session, "session");
    QCOMPARE(boardNames(session), (Names{"tags", "plate", "wall"}));
    QCOMPARE(session.options.optimisation->board_spacing_sigma, 0.004);
    QCOMPARE(session.further_boards[0].spacing_std, std::optional(of_plate));
    QCOMPARE(session.further_boards[1].spacing_std, std::optional(of_plate));
    std::swap(session.cameras[0].board, session.cameras[1].board);
    settleBoards(session);
    QCOMPARE(boardNames(session), (Names{"plate", "tags", "wall"}));
    QCOMPARE(session.options.optimisation->board_spacing_sigma, of_plate);
    QCOMPARE(session.further_boards[0].spacing_std, std::optional(0.004));
  }

  void measuredBoards_keepTheirLengths_whicheverIsTheWorlds() {
    Session session = threeBoards();
    const MeasuredLength of_plate{10, 0.502, 0.0005}, of_tags{5, 0.51, 0.0};
    setMeasuredAt(0, of_plate, session);
    setMeasuredAt(1, of_tags, session);
    QCOMPARE(boardAt(session, 1).spacing_m, 0.51 / 5);
    QCOMPARE(session.further_boards[0].spacing_std, std::optional(kExactSpacing));
    session.cameras[0].board = "tags";
    session.cameras[1].board = "plate";
    settleBoards(session);
    QVERIFY(session.measured == of_tags && measuredAt(session, 1) == of_plate);
    QVERIFY(!session.options.optimisation->free_board_size);
    QCOMPARE(session.further_boards[0].spacing_std, std::optional(of_plate.relativeStd()));
    setMeasuredAt(1, std::nullopt, session);
    QVERIFY(!session.further_boards[0].spacing_std && boardAt(session, 1).spacing_m == 0.0502);
  }

  // Read from a file and written to it again.
  void editedBoards_areWrittenAndReadAgain() {
    const QTemporaryDir folder;
    const std::filesystem::path root = folder.path().toStdString();
    Session session = threeBoards();
    session.recording = root / "recording.bag";
    std::ofstream(session.recording) << "nothing";
    setMeasuredAt(2, MeasuredLength{8, 0.3216, 0.0004}, session);
    renameBoard(2, "left: wall", session);
    addBoard(2, session);
    session.cameras.push_back({"fourth", "/fourth", {}, {}});
    session.cameras.back().board = boardNames(session).back();
    session.cameras[0].board = "left: wall";
    session.cameras[2].board = "plate";
    settleBoards(session);
    writeSession(session, root / "session.yaml");
    const Session again = readSession(root / "session.yaml");
    QCOMPARE(boardNames(again), (Names{"left: wall", "plate", "tags", "left: wall_2"}));
    QCOMPARE(sessionYaml(again, root), sessionYaml(session, root));
    QCOMPARE(seen(again), seen(session));
    for (std::size_t i = 0; i < 4; ++i) {
      QVERIFY(boardAt(again, i) == boardAt(session, i));
      QVERIFY(measuredAt(again, i) == measuredAt(session, i));
    }
    for (std::size_t i = 0; i < 3; ++i)
      QCOMPARE(again.further_boards[i].spacing_std, session.further_boards[i].spacing_std);
    QCOMPARE(again.options.optimisation->board_spacing_sigma, 0.0004 / 0.3216);
  }
};

EVICAL_TEST(TestSessionBoards)
#include "tst_session_boards.moc"
