#include "core/pipeline/session/session_guess.h"

#include "core/base/atomic_file.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>
#include <QtTest>

#include <algorithm>

using namespace evical;

namespace {

StreamSummary eventStream(const std::string& name, Resolution resolution_px = {346, 260}) {
  StreamSummary stream;
  stream.info.name = name;
  stream.info.type = StreamType::Events;
  stream.info.resolution_px = resolution_px;
  stream.count = 1000;
  stream.seen_px = {340, 250};
  return stream;
}

StreamSummary frameStream(const std::string& name, Resolution resolution_px = {346, 260}) {
  StreamSummary stream = eventStream(name, resolution_px);
  stream.info.type = StreamType::Frames;
  return stream;
}

StreamSummary imuStream(const std::string& name, const std::string& acceleration_unit = "m/s^2") {
  StreamSummary stream;
  stream.info.name = name;
  stream.info.type = StreamType::Imu;
  stream.count = 1000;
  stream.acceleration_unit = acceleration_unit;
  return stream;
}

Inspection holding(std::vector<StreamSummary> streams) {
  return {"rosbag", std::move(streams), {}};
}

std::string withoutCommentMarks(std::string yaml) {
  const std::size_t begin = yaml.find("# board:"), end = yaml.find("cameras:");
  std::string board = yaml.substr(begin, end - begin);
  for (std::size_t at = board.find("# "); at != std::string::npos; at = board.find("# ", at))
    board.erase(at, 2);
  return yaml.replace(begin, end - begin, board);
}

bool noted(const SessionDraft& draft, const std::string& text) {
  return std::any_of(draft.notes.begin(), draft.notes.end(),
                     [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

#define VERIFY_REFUSED(call, part)                                                     \
  try {                                                                                \
    call;                                                                              \
    QFAIL("was not refused");                                                          \
  } catch (const CalibrationError& error) {                                            \
    QVERIFY(error.kind() == ErrorKind::BadInput);                                      \
    QVERIFY2(std::string(error.what()).find(part) != std::string::npos, error.what()); \
  }

}  // namespace

class TestSessionGuess : public QObject {
  Q_OBJECT

 private slots:
  void name_isTheStreamsButForItsKind_data() {
    QTest::addColumn<QString>("stream");
    QTest::addColumn<QString>("camera");
    QTest::addColumn<QString>("imu");
    QTest::newRow("topic") << "/davis/left/events"
                           << "davis_left"
                           << "davis_left_imu";
    QTest::newRow("topic of one part") << "/events"
                                       << "camera"
                                       << "imu";
    QTest::newRow("no topic") << "events"
                              << "camera"
                              << "imu";
    QTest::newRow("without a slash in front") << "left/events"
                                              << "left"
                                              << "left_imu";
    QTest::newRow("several slashes in front") << "//left/events"
                                              << "left"
                                              << "left_imu";
  }
  void name_isTheStreamsButForItsKind() {
    QFETCH(QString, stream);
    QFETCH(QString, camera);
    QFETCH(QString, imu);
    QCOMPARE(guessedCamera(eventStream(stream.toStdString()), {}).name, camera.toStdString());
    QCOMPARE(guessedImu(imuStream(stream.toStdString()), {}, {}).name, imu.toStdString());
  }

  void name_thatIsTakenGetsANumber() {
    const Session session = guessedSession(
        "r.bag", holding({eventStream("/a/events"), eventStream("/a/more"), eventStream("/a/most")}));
    QCOMPARE(session.cameras.size(), std::size_t{3});
    QCOMPARE(session.cameras[0].name, std::string("a"));
    QCOMPARE(session.cameras[1].name, std::string("a_2"));
    QCOMPARE(session.cameras[2].name, std::string("a_3"));
  }

  void session_hasEveryStreamThatHoldsSomething() {
    StreamSummary silent = eventStream("/right/events");
    silent.count = 0;
    StreamSummary frames = eventStream("/left/image");
    frames.info.type = StreamType::Frames;
    const Session session = guessedSession(
        "r.bag", holding({frames, eventStream("/left/events"), silent, imuStream("/left/imu")}));
    QCOMPARE(session.recording.string(), std::string("r.bag"));
    QCOMPARE(session.cameras.size(), std::size_t{1});
    QCOMPARE(session.cameras[0].stream, std::string("/left/events"));
    QCOMPARE(session.cameras[0].resolution_px, (Resolution{346, 260}));
    QVERIFY(!session.cameras[0].intrinsics && session.cameras[0].recording.empty());
    QCOMPARE(session.imus.size(), std::size_t{1});
    QCOMPARE(session.reference, std::string("left_imu"));
    QVERIFY(session.board == Board{});
  }

  void session_withoutAnImuRefersToItsFirstCamera() {
    const Session session =
        guessedSession("r.bag", holding({eventStream("/left/events"), eventStream("/right/events")}));
    QCOMPARE(session.reference, std::string("left"));
  }

  void accelerationsThatLookLikeGAreTakenForIt() {
    QVERIFY(guessedImu(imuStream("/imu", "g"), {}, {}).acceleration_unit == AccelerationUnit::Gravity);
    QVERIFY(!guessedImu(imuStream("/imu", "m/s^2"), {}, {}).acceleration_unit);
    StreamSummary said = imuStream("/imu", "g");
    said.info.acceleration_unit = AccelerationUnit::Gravity;  // the format states it: no guess is needed
    QVERIFY(!guessedImu(said, {}, {}).acceleration_unit);
  }

  void missingSensors_areThoseOfAKindThatTheSessionLacks() {
    const Inspection other = holding({eventStream("/right/events"), imuStream("/right/imu")});
    const Session session = guessedSession("r.bag", holding({eventStream("/left/events")}));
    const Session found = withMissingSensors(session, "other.bag", other);
    QCOMPARE(found.cameras.size(), std::size_t{1});
    QCOMPARE(found.imus.at(0).recording.string(), std::string("other.bag"));
    QCOMPARE(found.reference, std::string("right_imu"));
    QCOMPARE(withMissingSensors(found, "third.bag", other).imus.size(), std::size_t{1});
  }

  void reference_thatIsThereStays() {
    Session session = guessedSession("r.bag", holding({imuStream("/a/imu"), imuStream("/b/imu")}));
    session.reference = "b_imu";
    keepReference(session);
    QCOMPARE(session.reference, std::string("b_imu"));
    session.imus.pop_back();
    keepReference(session);
    QCOMPARE(session.reference, std::string("a_imu"));
  }

  // In addition to events they are included only on request.
  void resolution_thatNobodySaysIsThatOfTheEvents_data() {
    QTest::addColumn<int>("seen_width_px");
    QTest::addColumn<int>("seen_height_px");
    QTest::addColumn<int>("width_px");
    QTest::addColumn<int>("height_px");
    QTest::newRow("all of a usual sensor") << 320 << 240 << 320 << 240;
    QTest::newRow("all but its rim") << 345 << 258 << 346 << 260;
    QTest::newRow("no usual sensor") << 500 << 400 << 500 << 400;
  }
  void resolution_thatNobodySaysIsThatOfTheEvents() {
    QFETCH(int, seen_width_px);
    QFETCH(int, seen_height_px);
    QFETCH(int, width_px);
    QFETCH(int, height_px);
    StreamSummary stream = eventStream("/events", {});
    stream.seen_px = {seen_width_px, seen_height_px};
    const Inspection inspection = holding({stream, imuStream("/imu")});
    Session session = guessedSession("a.bag", inspection);
    QVERIFY(!session.cameras[0].resolution_px.known());
    QVERIFY((withSeenResolutions(session, "a.bag", inspection).cameras[0].resolution_px ==
             Resolution{width_px, height_px}));
    // Not by another file's stream of this name, and not if the user has set it.
    QVERIFY(!withSeenResolutions(session, "b.bag", inspection).cameras[0].resolution_px.known());
    session.cameras[0].resolution_px = {640, 480};
    QVERIFY(
        (withSeenResolutions(session, "a.bag", inspection).cameras[0].resolution_px == Resolution{640, 480}));
  }

  void frames_areCamerasWhereNothingElseSees() {
    StreamSummary frames = eventStream("/cam0/image");
    frames.info.type = StreamType::Frames;
    const Session alone = guessedSession("r.bag", holding({frames, imuStream("/imu")}));
    QCOMPARE(alone.cameras.size(), std::size_t{1});
    QCOMPARE(alone.cameras[0].stream, std::string("/cam0/image"));
    const Session beside = guessedSession("r.bag", holding({frames, eventStream("/events")}));
    QVERIFY(beside.cameras.size() == 1 && beside.cameras[0].stream == "/events");
    frames.info.timed = false;
    QVERIFY(guessedSession("r.bag", holding({frames})).cameras.empty());
  }

  void useless_isWhatHasNeitherEventsNorImuSamples() {
    StreamSummary triggers = eventStream("/triggers");
    triggers.info.type = StreamType::Triggers;
    Inspection inspection = holding({triggers});
    inspection.faults.push_back({"", FaultKind::Truncated, 0.0, "The file ends in the middle of a chunk"});
    const auto error = whyUseless("r.bag", inspection);
    QVERIFY(error && error->kind() == ErrorKind::BadInput);
    QCOMPARE(error->place(), std::string("r.bag"));
    QCOMPARE(error->problem(), std::string("it has neither events, frames, points nor IMU samples. The "
                                           "file ends in the middle of a chunk"));
    inspection.streams.push_back(imuStream("/imu"));
    QVERIFY(!whyUseless("r.bag", inspection));
  }

  void draft_isTheGuessedSessionWithABoardToBeFilledIn() {
    QTemporaryDir folder;
    const std::filesystem::path recording = folder.filePath("r.bag").toStdString();
    writeFileWhole(recording, "x");
    const Inspection inspection = holding({eventStream("/left/events"), imuStream("/left/imu")});
    const SessionDraft draft = draftSession({{recording, inspection}}, folder.path().toStdString());
    const Session guessed = guessedSession(recording, inspection);
    QCOMPARE(sessionYaml(draft.session, folder.path().toStdString()),
             sessionYaml(guessed, folder.path().toStdString()));
    QCOMPARE(draft.notes.size(), 1u);
    QVERIFY2(draft.notes[0].starts_with("board: complete its entry"), draft.notes[0].c_str());

    const std::filesystem::path file = folder.filePath("session.yaml").toStdString();
    writeFileWhole(file, draft.yaml);
    VERIFY_REFUSED(readSession(file), "board");
    writeFileWhole(file, withoutCommentMarks(draft.yaml));
    QCOMPARE(sessionYaml(readSession(file), folder.path().toStdString()),
             sessionYaml(guessed, folder.path().toStdString()));
  }

  void draft_saysWhatIsMissing() {
    const SessionDraft draft = draftSession({{"r.raw", holding({eventStream("events", {})})}}, ".");
    QVERIFY(draft.yaml.find("    # resolution_px: [340, 250]  # not in the recording") != std::string::npos);
    QVERIFY(draft.yaml.find("    # intrinsics: ") != std::string::npos);
    QCOMPARE(draft.notes.size(), std::size_t{3});
    QVERIFY(draft.notes[1].find("cameras.camera: give resolution_px") == 0);
    QVERIFY(draft.notes[2].find("there is no IMU") == 0);
  }

  void draft_takesTheSensorsOfAllRecordings() {
    const SessionDraft draft = draftSession({{"left.raw", holding({eventStream("events")})},
                                             {"right.raw", holding({eventStream("events")})},
                                             {"imu.csv", holding({imuStream("imu")})}},
                                            ".");
    QCOMPARE(draft.session.recording.string(), std::string("left.raw"));
    QCOMPARE(draft.session.cameras.size(), std::size_t{2});
    QVERIFY(draft.session.cameras[0].recording.empty());
    QCOMPARE(draft.session.cameras[1].recording.string(), std::string("right.raw"));
    QCOMPARE(draft.session.cameras[1].name, std::string("camera_2"));
    QCOMPARE(draft.session.imus.at(0).recording.string(), std::string("imu.csv"));
    QCOMPARE(draft.session.reference, std::string("imu"));
    QVERIFY(draft.yaml.find("    # clock_offset_s: ") != std::string::npos);
  }

  // The sensors of a phone: the nearest names belong together.
  void draft_joinsFilesOfOneImu() {
    const auto half = [](const std::string& file, bool gyroscope) {
      StreamSummary stream = imuStream(file);
      (gyroscope ? stream.without_force : stream.without_rate) = stream.count;
      return holding({stream});
    };
    const SessionDraft draft = draftSession({{"right/Accelerometer.csv", half("Accelerometer.csv", false)},
                                             {"left/Gyroscope.csv", half("Gyroscope.csv", true)},
                                             {"camera.raw", holding({eventStream("events")})},
                                             {"left/Accelerometer.csv", half("Accelerometer.csv", false)},
                                             {"right/Gyroscope.csv", half("Gyroscope.csv", true)}},
                                            ".");
    QCOMPARE(draft.session.imus.size(), std::size_t{2});
    QVERIFY(draft.session.imus[0].name == "imu" && draft.session.imus[1].name == "imu_2");
    for (const SessionImu& imu : draft.session.imus) {
      QCOMPARE(imu.stream, std::string("Gyroscope.csv"));
      QCOMPARE(imu.accelerometer_stream, std::string("Accelerometer.csv"));
      QVERIFY(imu.recording.parent_path() == imu.accelerometer_recording.parent_path());
    }
    QVERIFY2(draft.yaml.find("recording: [left/Gyroscope.csv, left/Accelerometer.csv]") != std::string::npos,
             draft.yaml.c_str());
  }

  void draft_ofFramesAlone_hasFrameCameras() {
    const SessionDraft draft = draftSession(
        {{"r.bag", holding({frameStream("/cam0/image_raw", {752, 480}), imuStream("/imu0")})}}, ".");
    QCOMPARE(draft.session.cameras.at(0).stream, std::string("/cam0/image_raw"));
    QCOMPARE(draft.session.imus.size(), std::size_t{1});
  }

  void draft_remarksOnFramesBesideEvents() {
    const SessionDraft draft =
        draftSession({{"r.bag", holding({eventStream("/left/events"), frameStream("/left/image"),
                                         frameStream("/cam0/image", {752, 480})})}},
                     ".");
    QCOMPARE(draft.session.cameras.size(), std::size_t{1});
    QVERIFY(draft.yaml.find("frames: {stream: /left/image, same_sensor_as: left}") != std::string::npos);
    QVERIFY(draft.yaml.find("frames: {stream: /cam0/image}") != std::string::npos);
    QVERIFY(noted(draft, "the frames of /left/image in r.bag are not used; to use them, add a camera with"));
    QVERIFY(noted(draft, "the frames of /cam0/image in r.bag are not used"));
  }

  // A folder of pictures that is given in addition to the events.
  void draft_takesRecordingsOfFramesOnly() {
    StreamSummary untimed = frameStream("pictures");
    untimed.info.timed = false;
    const Inspection events = holding({eventStream("/left/events")});
    const SessionDraft draft = draftSession(
        {{"r.bag", events}, {"frames", holding({frameStream("cam0")})}, {"untimed", holding({untimed})}},
        ".");
    QCOMPARE(draft.session.cameras.size(), std::size_t{2});
    QCOMPARE(draft.session.cameras[1].recording.string(), std::string("frames"));
    QVERIFY(draft.yaml.find("# same_sensor_as: left  # if both streams are of the same sensor") !=
            std::string::npos);
    QVERIFY(!noted(draft, "cam0"));
    QVERIFY(noted(draft, "the frames of pictures in untimed are not used: they have no times"));
    const SessionDraft with_imu = draftSession(
        {{"r.bag", events}, {"imu.bag", holding({imuStream("/imu"), frameStream("/web")})}}, ".");
    QCOMPARE(with_imu.session.cameras.size(), std::size_t{1});
    QVERIFY(noted(with_imu,
                  "the frames of /web in imu.bag are not used; to use them, add a camera with "
                  "stream: /web and recording: imu.bag"));
  }

  void anyBoard_takesEventsFirst() {
    Session session;
    session.board.type = BoardType::AprilGrid;
    const Inspection both = holding({eventStream("/left/events"), frameStream("/left/image")});
    QCOMPARE(withMissingSensors(session, {}, both).cameras.at(0).stream, std::string("/left/events"));
    QCOMPARE(withMissingSensors({}, {}, both).cameras.at(0).stream, std::string("/left/events"));
  }

  void draft_thatMakesNoSessionIsRefused() {
    const Inspection events = holding({eventStream("/left/events")}), imu = holding({imuStream("/imu")});
    VERIFY_REFUSED(draftSession({{"imu.csv", imu}}, "."), "imu.csv");
    VERIFY_REFUSED(draftSession({{"a.bag", events}, {"b.bag", holding({})}}, "."), "b.bag");
    VERIFY_REFUSED(draftSession({{"a.bag", events}, {"a.bag", events}}, "."), "already another sensor's");
  }
};

EVICAL_TEST(TestSessionGuess)
#include "tst_session_guess.moc"
