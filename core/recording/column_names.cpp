#include "core/recording/column_names.h"

#include "core/base/plain_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <span>
#include <vector>

namespace evical {
namespace {

using Words = std::vector<std::string>;
using Known = std::span<const std::string_view>;

constexpr std::string_view kAccelerationWords[] = {
    "acc",    "accel", "accels", "accelerometer", "accelerometers", "acceleration", "accelerations", "force",
    "forces", "a",     "f"};
constexpr std::string_view kRateWords[] = {"gyro",
                                           "gyr",
                                           "gyros",
                                           "gyroscope",
                                           "gyroscopes",
                                           "omega",
                                           "angular",
                                           "angvel",
                                           "angularvelocity",
                                           "angularrate",
                                           "rotationrate",
                                           "rate",
                                           "rates",
                                           "w",
                                           "g"};
// "ang_vel_x" is a rate, "ang_x" may be an angle.
constexpr std::string_view kAngleWord = "ang";
constexpr std::string_view kVelocityWords[] = {"vel", "velocity", "velocities", "speed", "rate", "rates"};
// Words of a sensor's columns that do not tell which IMU it belongs to.
constexpr std::string_view kQuantityWords[] = {"ang",    "vel",      "velocity", "velocities", "speed",
                                               "linear", "specific", "lin",      "rot",        "rotation"};
// Words of columns that contain the same sensor's samples in several processing stages.
constexpr std::string_view kStageWords[] = {
    "raw",      "cal",  "calib",      "calibrated", "uncal", "uncalib",     "uncalibrated", "filt",
    "filtered", "lpf",  "unfiltered", "corrected",  "comp",  "compensated", "uncomp",       "uncompensated",
    "low",      "high", "wide",       "narrow",     "ln",    "wr",          "est",          "estimated",
    "estimate", "true", "truth",      "gt",         "fused", "mean",        "average"};
// Words next to an axis that do not name a quantity.
constexpr std::string_view kBareWords[] = {"axis", "value", "values", "val", "data", "reading", "component"};
constexpr std::string_view kTemperatureUnits[] = {"c",      "degc", "celsius", "k",
                                                  "kelvin", "f",    "degf",    "fahrenheit"};
// Words in columns that name a sensor, but contain another quantity of it.
constexpr std::string_view kOtherWords[] = {
    "covariance", "cov",          "variance", "var",         "std",         "stddev",     "bias",  "biases",
    "delta",      "dt",           "integral", "orientation", "quat",        "quaternion", "mag",   "magn",
    "magnet",     "magnetometer", "magnetic", "temp",        "temperature", "accuracy",   "user",  "gravity",
    "relative",   "status",       "offset",   "scale",       "clipping",    "attitude",   "pose",  "position",
    "count",      "id",           "exposure", "duration",    "interval",    "jerk",       "angle", "angles",
    "roll",       "pitch",        "yaw",      "heading",     "euler",       "pressure"};
// With one of these words, the column is a time, for any sensor.
constexpr std::string_view kStampWords[] = {"time",  "times",  "timestamp", "timestamps",
                                            "stamp", "stamps", "datetime"};
constexpr std::string_view kTimeWords[] = {"time",    "times",    "timestamp",  "timestamps",   "stamp",
                                           "stamps",  "datetime", "t",          "ts",           "sec",
                                           "secs",    "second",   "seconds",    "nsec",         "nsecs",
                                           "nanosec", "nanosecs", "nanosecond", "nanoseconds",  "ns",
                                           "usec",    "usecs",    "microsec",   "microseconds", "us",
                                           "msec",    "msecs",    "millisec",   "milliseconds", "ms",
                                           "millis",  "micros",   "clock"};
// Words next to the x of an event.
constexpr std::string_view kPlaceWords[] = {"event", "events", "ev",     "pos", "coord", "coords",
                                            "px",    "pixel",  "pixels", "pix", "addr",  "field"};
constexpr std::string_view kPolarityWords[] = {"p", "pol", "ps", "pols", "polarity", "polarities", "on"};
constexpr std::string_view kPointWords[] = {"point", "circle", "corner"};
constexpr std::string_view kSigmaWords[] = {"sigma", "std"};
constexpr std::string_view kUnitWords[] = {
    "m",   "s",    "s2",  "2",    "sec", "sec2", "ms2", "mps2", "mss", "g",       "mg",      "rad", "rads",
    "deg", "degs", "dps", "mdps", "per", "px",   "ns",  "us",   "ms",  "degrees", "radians", "1"};

bool isIn(std::string_view word, Known known) {
  return std::find(known.begin(), known.end(), word) != known.end();
}
bool hasOne(const Words& words, Known known) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return isIn(word, known); });
}
bool has(const Words& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool isUpper(char c) {
  return std::isupper(static_cast<unsigned char>(c)) != 0;
}
bool isLower(char c) {
  return std::islower(static_cast<unsigned char>(c)) != 0;
}
bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}
bool isWordLetter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0;
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

// In lower case; "GyroX" becomes "gyro x", and "covariance0" "covariance 0".
std::string spaced(std::string_view name) {
  std::string text;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool camel = i > 0 && isUpper(name[i]) && isLower(name[i - 1]);
    // Not within units ("s2") or within "x0": a word has at least three letters.
    const bool number = i > 2 && isDigit(name[i]) && isWordLetter(name[i - 1]) && !isDigit(name[i - 1]) &&
                        isWordLetter(name[i - 2]) && isWordLetter(name[i - 3]) && !isDigit(name[i - 2]);
    if (camel || number) text += ' ';
    text += static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
  }
  return text;
}

Words wordsOf(std::string_view text) {
  Words words(1);
  for (const char c : text) {
    if (isWordLetter(c))
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

int axisOf(std::string_view word) {
  constexpr std::string_view kAxes[] = {"x", "y", "z"};
  const auto found = std::find(std::begin(kAxes), std::end(kAxes), word);
  return found == std::end(kAxes) ? -1 : static_cast<int>(found - std::begin(kAxes));
}

// Degree, squared and micro signs in Latin-1, as words; empty for other bytes.
std::string_view latin1Sign(char c) {
  return c == '\xB0' ? "deg" : c == '\xB2' ? "2" : c == '\xB5' ? "u" : "";
}

// Only letters and digits, so that "m/s^2", "m s^-2" and "m_s2" are equal.
std::string plainUnit(std::string_view unit) {
  std::string plain;
  std::string text = replaced(replaced(std::string(unit), "\xC2\xB0", "deg"), "\xC2\xB2", "2");
  text = replaced(replaced(std::move(text), "\xC2\xB5", "u"), "\xCE\xBC", "u");
  bool ascii = true;  // of the preceding byte: the signs are single bytes, unlike those of UTF-8
  for (const char c : text) {
    if (isWordLetter(c))
      plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (ascii)
      plain += latin1Sign(c);
    ascii = static_cast<unsigned char>(c) < 0x80;
  }
  return plain;
}

// Removes "[...]" and "(...)" from `text`: units; an axis stays.
std::string takeBrackets(std::string& text) {
  std::string unit;
  for (std::size_t begin = text.find_first_of("[("); begin != std::string::npos;
       begin = text.find_first_of("[(", begin)) {
    const std::size_t end = std::min(text.find_first_of("])", begin), text.size());
    const std::string inside = text.substr(begin + 1, end - begin - 1);
    const Words words = wordsOf(inside);
    const bool is_axis =
        words.size() == 1 && (axisOf(words[0]) >= 0 || (words[0].size() == 1 && isDigit(words[0][0])));
    if (!is_axis) unit = inside;
    text.replace(begin, std::min(end + 1, text.size()) - begin, is_axis ? " " + words[0] : "");
  }
  return unit;
}

// "ax" and "accx" become "a x" and "acc x"; so do "xacc" and "xgyro", as autopilots write them. "ax0" becomes
// "0 a x".
void splitAxes(Words& words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    std::string word = words[i];
    if (word.size() > 2 && isDigit(word.back()) && axisOf(word.substr(word.size() - 2, 1)) >= 0) {
      words.insert(words.begin() + static_cast<std::ptrdiff_t>(i), word.substr(word.size() - 1));
      word.pop_back();
      words[++i] = word;
    }
    if (word.size() < 2 || isIn(word, kAccelerationWords) || isIn(word, kRateWords)) continue;
    const std::string front = word.substr(0, word.size() - 1), back = word.substr(1);
    const auto isSensor = [](const std::string& w) {
      return isIn(w, kAccelerationWords) || isIn(w, kRateWords);
    };
    if (axisOf(word.substr(word.size() - 1)) >= 0 && isSensor(front)) {
      words[i] = front;
      words.insert(words.begin() + static_cast<std::ptrdiff_t>(i) + 1, word.substr(word.size() - 1));
    } else if (back.size() > 1 && axisOf(word.substr(0, 1)) >= 0 && isSensor(back)) {
      words[i] = back;
      words.insert(words.begin() + static_cast<std::ptrdiff_t>(i) + 1, word.substr(0, 1));
    }
  }
}

// Removes the axis from the words: the last letter that is an axis, otherwise the last digit.
void takeAxis(Words& words, ColumnName& column) {
  const auto take = [&](auto isAxis, auto number) {
    const auto found = std::find_if(words.rbegin(), words.rend(), isAxis);
    if (found == words.rend()) return false;
    column.axis = number(*found);
    words.erase(std::next(found).base());
    return true;
  };
  column.lettered = take([](const std::string& w) { return axisOf(w) >= 0; },
                         [](const std::string& w) { return axisOf(w); });
  if (!column.lettered)
    take([](const std::string& w) { return w.size() == 1 && w[0] >= '0' && w[0] <= '3'; },
         [](const std::string& w) { return w[0] - '0'; });
}

// The words at the end that are a unit of this kind and not part of a name.
std::string takeUnit(Words& words, ColumnKind kind) {
  const auto isUnit = [kind](const std::string& unit) {
    return kind == ColumnKind::AngularRate ? angularRateUnitOf(unit).has_value()
                                           : accelerationUnitOf(unit).has_value();
  };
  std::size_t count = 0;
  while (count + 1 < words.size() && isIn(words[words.size() - 1 - count], kUnitWords)) ++count;
  for (; count > 0; --count) {
    std::string unit;
    for (std::size_t i = words.size() - count; i < words.size(); ++i) unit += words[i];
    if (isDigit(unit.front()) || !isUnit(unit)) continue;
    words.resize(words.size() - count);
    return unit;
  }
  return {};
}

// Not "rad" and "deg", which may be angles.
bool isRateUnit(const std::string& unit) {
  const std::string plain = plainUnit(unit);
  const bool angle = plain == "rad" || plain == "radians" || plain == "deg" || plain == "degrees";
  return !angle && angularRateUnitOf(unit).has_value();
}

std::string joinedWords(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : "_") + word;
  return text;
}

// Sensor of a vector's component; Other if it is not an IMU's.
ColumnKind vectorKind(const Words& words, const std::string& unit) {
  if (hasOne(words, kOtherWords)) return ColumnKind::Other;
  if (has(words, "alpha")) return ColumnKind::Alpha;
  const bool angle_is_rate = hasOne(words, kVelocityWords) || isRateUnit(unit) ||
                             (has(words, "per") || has(words, "dps") || has(words, "rads") ||
                              has(words, "degs") || (!words.empty() && words.back() == "s"));
  // The first word decides: in "acc_g_x", g is the unit.
  for (const std::string& word : words) {
    if (isIn(word, kAccelerationWords)) return ColumnKind::Acceleration;
    if (word == kAngleWord && angle_is_rate) return ColumnKind::AngularRate;
    if (!isIn(word, kRateWords)) continue;
    const bool acceleration = has(words, "acceleration") || has(words, "acc") || has(words, "accel");
    return acceleration ? ColumnKind::Other : ColumnKind::AngularRate;
  }
  return ColumnKind::Other;
}

ColumnKind plainKind(const Words& words) {
  const auto onlyBeside = [&](std::string_view word) {
    return has(words, word) && std::all_of(words.begin(), words.end(), [&](const std::string& other) {
             return other == word || isIn(other, kPlaceWords);
           });
  };
  if (onlyBeside("x") || onlyBeside("xs")) return ColumnKind::X;
  if (onlyBeside("y") || onlyBeside("ys")) return ColumnKind::Y;
  if (words.empty()) return ColumnKind::Other;
  // "t_x" is a translation.
  const bool of_axis =
      !hasOne(words, kStampWords) && std::ranges::any_of(words, [](const auto& w) { return axisOf(w) >= 0; });
  if (hasOne(words, kTimeWords) && !hasOne(words, kOtherWords) && !of_axis) return ColumnKind::Time;
  if (isIn(words.back(), kPolarityWords)) return ColumnKind::Polarity;
  if (words.back() == "type" && (words.size() == 1 || words[0] == "event")) return ColumnKind::EventType;
  if (isIn(words.front(), kPointWords)) return ColumnKind::Point;
  if (isIn(words.front(), kSigmaWords)) return ColumnKind::Sigma;
  return ColumnKind::Other;
}

// "I" (ArduPilot), "imu", "imu_id", "sensor_index": the number of the IMU that the row belongs to.
bool isImuNumber(const Words& words) {
  constexpr std::string_view kSensors[] = {"imu", "sensor", "device", "dev", "instance", "i"};
  constexpr std::string_view kNumbers[] = {"id",  "index",  "idx",      "no",  "nr",
                                           "num", "number", "instance", "name"};
  if (words.empty() || !isIn(words[0], kSensors)) return false;
  return words.size() == 1 || (words.size() == 2 && isIn(words[1], kNumbers));
}

// One of the three columns of a vector; nullopt otherwise.
std::optional<ColumnName> vectorColumn(Words words, const std::string& unit) {
  splitAxes(words);
  ColumnName column;
  column.kind = vectorKind(words, unit);
  if (column.kind == ColumnKind::Other) return std::nullopt;
  takeAxis(words, column);
  if (column.axis < 0) return std::nullopt;
  const std::string written = takeUnit(words, column.kind);
  column.unit = unit.empty() ? written : unit;
  column.group = joinedWords(words);
  std::erase_if(words, [](const std::string& word) {
    return isIn(word, kAccelerationWords) || isIn(word, kRateWords) || isIn(word, kQuantityWords);
  });
  column.imu = joinedWords(words);
  column.of_stage = hasOne(words, kStageWords);
  return column;
}

// "t_us" is a time with a unit; "stamp_nsecs" has the unit in its only word for time.
std::string timeUnitIn(const Words& words) {
  if (has(words, "fine") && has(words, "time")) return "100us";  // Xsens' SampleTimeFine
  if (has(words, "startup") && has(words, "time")) return "ns";  // VectorNav's TimeStartup
  if (!words.empty() && timeUnitNamed(words.back())) return words.back();
  // "seconds_elapsed"
  const auto inside = std::ranges::find_if(
      words, [](const std::string& word) { return word.size() > 1 && timeUnitNamed(word).has_value(); });
  return inside == words.end() ? "" : *inside;
}

// "T[C]" is a temperature.
bool isTimeIn(const Words& words, const std::string& unit) {
  if (unit.empty() || timeUnitNamed(unit)) return true;
  return hasOne(words, kStampWords) && !isIn(plainUnit(unit), kTemperatureUnits);
}

// "x", "x_axis": an axis of an unnamed sensor.
int bareAxisOf(const Words& words) {
  int axis = -1;
  for (const std::string& word : words) {
    if (axisOf(word) >= 0 && axis < 0)
      axis = axisOf(word);
    else if (!isIn(word, kBareWords))
      return -1;
  }
  return axis;
}

template <class Unit>
struct UnitSpelling {
  std::string_view plain;
  ScaledUnit<Unit> unit;
};

constexpr UnitSpelling<AccelerationUnit> kAccelerationSpellings[] = {
    {"ms2", {AccelerationUnit::MetresPerSecond2}},
    {"msec2", {AccelerationUnit::MetresPerSecond2}},
    {"mps2", {AccelerationUnit::MetresPerSecond2}},
    {"mss", {AccelerationUnit::MetresPerSecond2}},
    {"mpers2", {AccelerationUnit::MetresPerSecond2}},
    {"mpersec2", {AccelerationUnit::MetresPerSecond2}},
    {"g", {AccelerationUnit::Gravity}},
    {"gs", {AccelerationUnit::Gravity}},
    {"gn", {AccelerationUnit::Gravity}},
    {"mg", {AccelerationUnit::Gravity, 1e-3}},
    {"millig", {AccelerationUnit::Gravity, 1e-3}},
    {"mms2", {AccelerationUnit::MetresPerSecond2, 1e-3}},
    {"cms2", {AccelerationUnit::MetresPerSecond2, 1e-2}}};

constexpr UnitSpelling<AngularRateUnit> kRateSpellings[] = {
    {"rads", {AngularRateUnit::RadiansPerSecond}},
    {"rads1", {AngularRateUnit::RadiansPerSecond}},
    {"rad", {AngularRateUnit::RadiansPerSecond}},
    {"radsec", {AngularRateUnit::RadiansPerSecond}},
    {"radps", {AngularRateUnit::RadiansPerSecond}},
    {"radpersec", {AngularRateUnit::RadiansPerSecond}},
    {"radians", {AngularRateUnit::RadiansPerSecond}},
    {"radianss", {AngularRateUnit::RadiansPerSecond}},
    {"radianspersecond", {AngularRateUnit::RadiansPerSecond}},
    {"mrads", {AngularRateUnit::RadiansPerSecond, 1e-3}},
    {"degs", {AngularRateUnit::DegreesPerSecond}},
    {"degs1", {AngularRateUnit::DegreesPerSecond}},
    {"deg", {AngularRateUnit::DegreesPerSecond}},
    {"degsec", {AngularRateUnit::DegreesPerSecond}},
    {"dps", {AngularRateUnit::DegreesPerSecond}},
    {"degps", {AngularRateUnit::DegreesPerSecond}},
    {"degpersec", {AngularRateUnit::DegreesPerSecond}},
    {"degrees", {AngularRateUnit::DegreesPerSecond}},
    {"degreess", {AngularRateUnit::DegreesPerSecond}},
    {"degreessec", {AngularRateUnit::DegreesPerSecond}},
    {"degreespersecond", {AngularRateUnit::DegreesPerSecond}},
    {"mdps", {AngularRateUnit::DegreesPerSecond, 1e-3}},
    {"mdegs", {AngularRateUnit::DegreesPerSecond, 1e-3}},
    {"degh", {AngularRateUnit::DegreesPerSecond, 1.0 / 3600.0}}};

template <class Unit, std::size_t N>
std::optional<ScaledUnit<Unit>> spelled(std::string_view unit, const UnitSpelling<Unit> (&spellings)[N]) {
  const std::string plain = plainUnit(unit);
  const auto found =
      std::find_if(std::begin(spellings), std::end(spellings),
                   [&](const UnitSpelling<Unit>& spelling) { return spelling.plain == plain; });
  return found == std::end(spellings) ? std::nullopt : std::optional(found->unit);
}

// Removes a positive number from the front of `text`: "0.000488 g", "1/16384 g". nullopt if it has none.
std::optional<double> takeFactor(std::string_view& text) {
  const auto take = [&text]() -> std::optional<double> {
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || !std::isfinite(number) || number <= 0.0) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
  };
  std::optional<double> factor = take();
  if (!factor || !text.starts_with('/')) return factor;
  text.remove_prefix(1);
  const std::optional<double> divisor = take();
  return divisor ? std::optional(*factor / *divisor) : std::nullopt;
}

// A unit, or a number of units, as for raw counts.
template <class Unit, std::size_t N>
std::optional<ScaledUnit<Unit>> scaled(std::string_view unit, const UnitSpelling<Unit> (&spellings)[N]) {
  unit = trimmed(unit);
  if (unit.empty() || !(isDigit(unit.front()) || unit.front() == '.')) return spelled(unit, spellings);
  const std::optional<double> factor = takeFactor(unit);
  auto found = factor ? spelled(unit, spellings) : std::nullopt;
  if (found) found->factor *= *factor;
  return found;
}

}  // namespace

std::optional<ScaledUnit<AccelerationUnit>> accelerationUnitOf(std::string_view unit) {
  return scaled(unit, kAccelerationSpellings);
}

std::optional<ScaledUnit<AngularRateUnit>> angularRateUnitOf(std::string_view unit) {
  return scaled(unit, kRateSpellings);
}

std::optional<std::int64_t> timeUnitNamed(std::string_view unit) {
  struct Spelling {
    std::int64_t unit_ns;
    std::array<std::string_view, 8> names;
  };
  const std::string plain = plainUnit(unit);
  constexpr Spelling kUnits[] = {
      {1, {"ns", "nsec", "nsecs", "nanosec", "nanosecs", "nanosecond", "nanoseconds"}},
      {1000, {"us", "usec", "usecs", "microsec", "microsecond", "microseconds", "micros"}},
      {100'000, {"100us"}},
      {1'000'000, {"ms", "msec", "msecs", "millisec", "millisecond", "milliseconds", "millis"}},
      {1'000'000'000, {"s", "sec", "secs", "second", "seconds"}}};
  for (const Spelling& spelling : kUnits)
    if (!plain.empty() &&
        std::find(spelling.names.begin(), spelling.names.end(), plain) != spelling.names.end())
      return spelling.unit_ns;
  return std::nullopt;
}

ColumnName columnNamed(std::string_view name) {
  std::string text = spaced(name);
  const std::string unit = takeBrackets(text);
  const Words words = wordsOf(text);
  if (!hasOne(words, kStampWords))
    if (std::optional<ColumnName> column = vectorColumn(words, unit)) return *column;
  ColumnName column;
  column.kind = plainKind(words);
  column.unit = unit;
  Words rest = words;
  if (column.kind == ColumnKind::Time && !isTimeIn(words, unit)) column.kind = ColumnKind::Other;
  column.other_quantity = column.kind == ColumnKind::Other &&
                          (hasOne(words, kOtherWords) || isIn(plainUnit(unit), kTemperatureUnits));
  column.bare_axis = bareAxisOf(words);
  column.numbers_imus = isImuNumber(words);
  if (column.kind == ColumnKind::Time) {
    if (unit.empty()) column.unit = timeUnitIn(words);
    while (!rest.empty() && timeUnitNamed(rest.back())) rest.pop_back();
  }
  column.group = joinedWords(rest);
  return column;
}

std::optional<MeasuredBy> sensorNamed(std::string_view name) {
  const Words words = wordsOf(spaced(name));
  const auto isLong = [&](const std::string& word, Known known) {
    return word.size() > 2 && isIn(word, known);
  };
  bool acceleration = false, rate = false;
  for (const std::string& word : words) {
    acceleration = acceleration || isLong(word, kAccelerationWords);
    rate = rate || isLong(word, kRateWords);
  }
  const bool velocity = has(words, std::string(kAngleWord)) && hasOne(words, kVelocityWords);
  if (acceleration == (rate || velocity) || hasOne(words, kOtherWords)) return std::nullopt;
  return acceleration ? MeasuredBy::Accelerometer : MeasuredBy::Gyroscope;
}

}  // namespace evical
