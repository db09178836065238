// Typical mistakes of users, one per row, on one right recording: the first reason names the cause with its
// value and the advice removes it. No row of a wrong input advises to record again, which would not help.
#include "tests/system/session_case.h"

using namespace evical::test;

namespace {

using Edit = std::function<QString(QString session)>;

// Replaces the first match; the pattern must occur.
Edit replaced(const QString& pattern, const QString& by) {
  return [=](QString session) {
    const QRegularExpression expression(pattern, QRegularExpression::MultilineOption);
    if (!session.contains(expression)) return QString();
    const QRegularExpressionMatch match = expression.match(session);
    return session.replace(match.capturedStart(), match.capturedLength(), by);
  };
}

// Multiplies the numbers of a key, which may be a list.
Edit multiplied(const QString& key, double factor) {
  return [=](QString session) {
    const QRegularExpression line("^( *" + key + ": )(.*)$", QRegularExpression::MultilineOption);
    const QRegularExpressionMatch match = line.match(session);
    if (!match.hasMatch()) return QString();
    QStringList numbers;
    for (const QString& number : match.captured(2).remove('[').remove(']').split(','))
      numbers.append(QString::number(factor * number.toDouble(), 'g', 9));
    const QString values = numbers.size() == 1 ? numbers.first() : "[" + numbers.join(", ") + "]";
    return session.replace(match.capturedStart(), match.capturedLength(), match.captured(1) + values);
  };
}

Edit both(const Edit& first, const Edit& second) {
  return [=](const QString& session) { return second(first(session)); };
}

Edit inImu(const QString& line) {
  return replaced("^  left_imu:\n", "  left_imu:\n    " + line + "\n");
}

enum class Stage {
  Session,  // refused before the recording is read
  Imu,      // only IMU data are affected: the detections of the right session are used
  Events    // detections are affected
};

struct Mistake {
  const char* name;
  Stage stage;
  Edit edit;
  const char* cause;  // regular expressions of the verdict's text
  const char* advice;
};

const std::vector<Mistake>& mistakes() {
  static const std::vector<Mistake> all = {
      // The session file
      {"04 no board", Stage::Session, replaced("^board:\n(  .*\n)+", ""), "board: is missing",
       "type, rows, cols.*'#'"},
      {"04 empty board", Stage::Session, replaced("^board:\n(  .*\n)+", "board:\n"), "board .*is empty",
       "type, rows, cols.*'#'"},
      {"05 no noise density", Stage::Session, replaced("^    gyroscope_noise_density:.*\n", ""),
       "gyroscope_noise_density is missing", "data sheet in rad/s/sqrt.Hz.; typical: 0.000187"},
      {"16 key mistyped", Stage::Session, replaced("spacing_m:", "spacing:"), "board.spacing .*unknown key",
       "Did you mean 'spacing_m'"},
      {"50 value mistyped", Stage::Session, replaced("asymmetric_circles", "asymetric_circles"),
       "'asymetric_circles' is not one of", "Did you mean 'asymmetric_circles'"},
      {"03 recording missing", Stage::Session, replaced("^recording:.*$", "recording: recordng.bag"),
       "recording .*'.*recordng.bag' does not exist", "relative to the session"},
      {"14 millimetres", Stage::Session, replaced("spacing_m: .*", "spacing_m: 50"),
       "board.spacing_m .*50 m is above the maximum of 10 m", "50 mm are 0.05 m"},
      {"48 a unit", Stage::Session, replaced("spacing_m: .*", "spacing_m: 5cm"), "'5cm' is not a number",
       "Give a number from .* m"},
      {"43 noise in micro-g", Stage::Session,
       replaced("accelerometer_noise_density: .*", "accelerometer_noise_density: 400"),
       "400 m/s\\^2/sqrt.Hz. is above the maximum", "micro-g/sqrt.Hz. by 9.81e-6"},
      {"43 gyroscope noise in deg/h", Stage::Session,
       replaced("gyroscope_noise_density: .*", "gyroscope_noise_density: 38"),
       "38 rad/s/sqrt.Hz. is above the maximum", "deg/h/sqrt.Hz. by 4.848e-6"},
      {"18 keys of Kalibr", Stage::Session,
       replaced("^board:\n(  .*\n)+",
                "board:\n  target_type: aprilgrid\n  tagCols: 6\n  tagRows: 6\n  tagSize: 0.03\n"),
       "board.target_type .*key of Kalibr's target files", "Import that file"},
      {"22 tab", Stage::Session, replaced("^  rows:", "\trows:"), "not valid YAML: .*tab",
       "Indent with spaces"},
      {"07 rows and columns exchanged", Stage::Session,
       both(replaced("rows: 11", "rows: 4"), replaced("cols: 4", "cols: 11")), "looks the same when turned",
       "Are rows and cols exchanged .11 and 4."},
      {"08 even rows", Stage::Session, replaced("rows: 11", "rows: 10"), "looks the same when turned",
       "an odd number of rows"},
      {"24 resolution of another mode", Stage::Session,
       replaced("^    resolution_px: .*$", "    resolution_px: [240, 180]"),
       "is for 346 x 260 px, but resolution_px is 240 x 180", "intrinsics of this camera at this resolution"},
      {"51 reference mistyped", Stage::Session, replaced("reference: left_imu", "reference: lef_imu"),
       "lef_imu", "Did you mean 'left_imu'"},
      {"10 stream of the camera", Stage::Session,
       replaced("^    stream: .*events.*$", "    stream: /dvs/evnts"),
       "cameras.left.stream: '/dvs/evnts': the recording has no stream of type events",
       "Its streams of this type: "},
      {"11 stream of the IMU", Stage::Session, replaced("^    stream: .*imu.*$", "    stream: /dvs/imu"),
       "imus.left_imu.stream: '/dvs/imu': the recording has no stream of type imu",
       "Its streams of this type: "},
      // Times
      {"27 clocks of 1970 and of uptime", Stage::Events, inImu("clock_offset_s: -1700000000"),
       "do not overlap in time.*agree if the IMU's clock is (1700000000|1699999999|1.7e).* s behind",
       "Add (1700000000|1699999999).* to clock_offset_s of left_imu"},
      {"52 time range behind the end", Stage::Events, replaced("^board:", "time_range_s: [20, 30]\nboard:"),
       "lasts (10.0|9.9) s, but time_range_s begins at 20 s", "Give a range within the recording"},
      {"53 too short", Stage::Events, replaced("^board:", "time_range_s: [0, 2]\nboard:"),
       "too short: (2.0|1.9)\\d* s, at least 3.00 s are required", "Record at least 20 s of varied motion"},
      {"clock 1 % too slow", Stage::Imu, inImu("clock_scale: 0.99"),
       "Verdict: doubtful - the clocks of left and left_imu differ by (0.9\\d|1) % in their rates",
       "Check the rate.*imus.left_imu.clock_scale: 1.0(09|1)\\d* or cameras.left.clock_scale: 0.99"},
      // Units and axes
      {"12 SI called g", Stage::Imu, replaced("acceleration_unit: .*", "acceleration_unit: g"),
       "left_imu: the median norm of the accelerations is 9\\d.*: the unit seems to be m/s\\^2",
       "Set acceleration_unit: m/s\\^2"},
      {"13 rad/s called deg/s", Stage::Imu, replaced("angular_rate_unit: .*", "angular_rate_unit: deg/s"),
       "left_imu: the gyroscope's rates are 5\\d.* times too small.*: their unit seems to be rad/s",
       "Set angular_rate_unit: rad/s"},
      {"26 gyroscope turned by half a turn", Stage::Imu, inImu("gyroscope_axes: x,-y,-z"),
       "left_imu: the axes of accelerometer and gyroscope seem permuted.*if the gyroscope's are read as "
       ".x,y,z.",
       "Set gyroscope_axes: x,y,z for this IMU"},
      {"28 gyroscope left-handed", Stage::Imu, inImu("gyroscope_axes: y,x,z"),
       "left_imu: the gyroscope's axes seem left-handed.*if read as .x,y,z.",
       "Set gyroscope_axes: x,y,z for this IMU"},
      {"angular rates negated", Stage::Imu, inImu("gyroscope_axes: -x,-y,-z"),
       "left_imu: the angular rates seem negated", "Set gyroscope_axes: x,y,z for this IMU"},
      // Noise
      {"23 noise 10^4 times too large", Stage::Imu, multiplied("gyroscope_noise_density", 1e4),
       "left_imu: gyroscope_noise_density .1.87 rad/s/sqrt.Hz.. is .*e.0?[34] times too large: the samples "
       "have about 0.0001[5-9]",
       "Give the data sheet's value in rad/s/sqrt.Hz."},
      {"23 noise 1000 times too large", Stage::Imu,
       both(multiplied("gyroscope_noise_density", 1e3), multiplied("accelerometer_noise_density", 1e3)),
       "left_imu: .*_noise_density .*times too large: the samples have about", "Give the data sheet's value"},
      {"44 noise in deg/s", Stage::Imu, multiplied("gyroscope_noise_density", 57.29578),
       "left_imu: gyroscope_noise_density .0.0107 rad/s/sqrt.Hz.. is (4|5|6)\\d.* times too large.*seems to "
       "be in deg/s/sqrt.Hz.",
       "Give the data sheet's value in rad/s/sqrt.Hz."},
      {"noise 100 times too small", Stage::Imu, multiplied("gyroscope_noise_density", 0.01),
       "left_imu: gyroscope_noise_density .1.87e-06 rad/s/sqrt.Hz.. is \\d+ times too small: the samples "
       "have about 0.0001[5-9]",
       "Give the data sheet's value in rad/s/sqrt.Hz."},
      {"noise densities exchanged", Stage::Imu,
       both(replaced("gyroscope_noise_density: .*", "gyroscope_noise_density: 0.00186"),
            replaced("accelerometer_noise_density: .*", "accelerometer_noise_density: 0.000187")),
       "Verdict: doubtful - left_imu: gyroscope_noise_density .* and accelerometer_noise_density .* seem to "
       "be exchanged",
       "the samples have about 0.0001[5-9].* and 0.00[12]"},
      // The board
      {"06 fewer rows", Stage::Events, replaced("rows: 11", "rows: 9"),
       "visible board seems larger than 9 x 4", "[Cc]heck rows and columns"},
      {"20 bright for dark", Stage::Events, replaced("circles: dark", "circles: bright"),
       "board was never found", "check rows, columns and circles .dark or bright."},
      {"17 AprilGrid for events", Stage::Events,
       replaced("^board:\n(  .*\n)+",
                "board:\n  type: aprilgrid\n  rows: 6\n  cols: 6\n  spacing_m: 0.039\n  tag_size_m: 0.03\n"),
       "board was never found", "[Cc]heck .*type, rows, columns and tags"},
      {"49 spacing ten times too large", Stage::Events, multiplied("spacing_m", 10),
       "spacing_m .0.5 m. is (8|9|10).* times too large: accelerations agree with about 0.0(5|6)",
       "Measure the board"},
      {"49 all sizes ten times too large", Stage::Events,
       both(multiplied("spacing_m", 10), multiplied("radius_m", 10)),
       "spacing_m .0.5 m. is (9|10).* times too large: accelerations agree with about 0.05",
       "Measure the board"},
      {"49 spacing of half a column", Stage::Events,
       both(multiplied("spacing_m", 0.5), multiplied("radius_m", 0.5)),
       "spacing_m .0.025 m. is (1.9\\d|2) times too small: accelerations agree with about 0.05",
       "Measure the board"},
      {"15 spacing 10 % too large", Stage::Events,
       both(multiplied("spacing_m", 1.1), multiplied("radius_m", 1.1)),
       "the board seems (9|10) % smaller than specified .spacing 0.055 m.", "measure it.*0.0(5|49)"},
      {"19 radius five times too small", Stage::Events, multiplied("radius_m", 0.2),
       "board: radius_m .0.004 m. is [45].* times too small: the circles' edges agree with about "
       "0.0(18|19|2)",
       "Measure the diameter.*half of it"},
      {"19 diameter for radius", Stage::Events,
       both(replaced("radius_m: .*", "radius_m: 0.033"), multiplied("spacing_m", 1.0)),
       "board: radius_m .0.033 m. is 1.[6-9]\\d* times too large: the circles' edges agree with about "
       "0.0(18|19|2)",
       "Measure the diameter.*half of it"},
      // The lens
      {"21 focal length twice too large", Stage::Events, multiplied("focal_length_px", 2.0),
       "left: the given lens differs from that of the recording by .* px.*focal lengths of 2[56]\\d.* px "
       "agree.*2.* times too large",
       "Remove intrinsics"},
      {"21 focal length twice too small", Stage::Events, multiplied("focal_length_px", 0.5),
       "left: the given lens differs from that of the recording by .* px.*focal lengths of 2[56]\\d.* px "
       "agree.*(2|1.9).* times too small",
       "Remove intrinsics"},
      {"lens of half the resolution", Stage::Events,
       both(multiplied("focal_length_px", 0.5), multiplied("principal_point_px", 0.5)),
       "left: the given lens differs.*times too small, and the principal point alike.*another resolution",
       "Remove intrinsics"},
      {"distortion of the opposite sign", Stage::Events, multiplied("distortion", -1.0),
       "left: the given lens differs.*px agree", "Remove intrinsics"},
  };
  return all;
}

}  // namespace

class TestMistakes : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase();
  void rightSession_isOk();
  void path_thatIsWrong_isNamed();
  void command_thatIsWrong_isNamed();
  void mistake_isNamedFirst_data();
  void mistake_isNamedFirst();

 private:
  SessionCase right_{"mistakes"};
};

void TestMistakes::initTestCase() {
  const Outcome outcome = right_.calibrate();
  VERIFY_OUTCOME(outcome, 0);
  VERIFY_TEXT(outcome.output, "Verdict: ok");
}

void TestMistakes::rightSession_isOk() {
  const QString result = QString::fromUtf8(readFile(right_.result() + "/result.yaml"));
  VERIFY_TEXT(result, "status: ok");
  QVERIFY2(!result.contains("noise_density (") && !result.contains("the given lens"),
           qPrintable(result.left(2000)));
}

void TestMistakes::path_thatIsWrong_isNamed() {
  Outcome outcome = runProgram({"calibrate", right_.path("recording.bag"), "-o", right_.path("other")});
  VERIFY_OUTCOME(outcome, 2);
  VERIFY_SAYS(outcome, "MB, too much for a YAML file.*not the recording itself.*evical init");
  outcome = runProgram({"calibrate", right_.path("sesion.yaml"), "-o", right_.path("other")});
  VERIFY_OUTCOME(outcome, 2);
  VERIFY_SAYS(outcome, "sesion.yaml: does not exist.*Did you mean 'session.yaml'");
}

void TestMistakes::command_thatIsWrong_isNamed() {
  const std::vector<std::pair<QStringList, QString>> all = {
      {{"calibrate", right_.session()}, "--output is required"},
      {{"calibrate", right_.session(), "--ouput", "x"}, "unknown option --ouput.*Did you mean '--output'"},
      {{"calibrat", right_.session()}, "unknown command 'calibrat'.*Did you mean 'calibrate'"},
      {{"init", right_.path("recording.bag"), "-o", right_.session()}, "session.yaml.*exists"}};
  for (const auto& [arguments, says] : all) {
    const Outcome outcome = runProgram(arguments);
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, says);
  }
}

void TestMistakes::mistake_isNamedFirst_data() {
  QTest::addColumn<int>("index");
  for (std::size_t k = 0; k < mistakes().size(); ++k)
    QTest::newRow(mistakes()[k].name) << static_cast<int>(k);
}

void TestMistakes::mistake_isNamedFirst() {
  QFETCH(int, index);
  const Mistake& mistake = mistakes().at(static_cast<std::size_t>(index));
  SessionCase test("mistakes");
  const QString before = QString::fromUtf8(readFile(test.session())), after = mistake.edit(before);
  QVERIFY2(!after.isEmpty() && after != before, "the session does not have this line");
  writeFile(test.session(), after.toUtf8());
  const Outcome outcome = test.calibrate(
      mistake.stage == Stage::Imu ? QStringList{"--detections", right_.result()} : QStringList());
  if (mistake.stage == Stage::Session) VERIFY_OUTCOME(outcome, 2);
  // From the verdict or the error on: warnings of the log come before. One line.
  const QString text =
      outcome.exit_code == 0 ? outcome.output.mid(outcome.output.indexOf("Verdict:")) : outcome.errors;
  const QString line = QString(text).replace('\n', ' ');
  VERIFY_TEXT(line, mistake.cause);
  VERIFY_TEXT(line, mistake.advice);
  QVERIFY2(
      !line.contains("ecord again") && !line.contains("ecord longer") && !line.contains("pixels are slow"),
      qPrintable(line));
}

EVICAL_TEST(TestMistakes)
#include "tst_mistakes.moc"
