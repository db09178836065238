#include "core/recording/text_reader.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/time.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <optional>
#include <utility>

namespace evical {
namespace {

constexpr const char* kEventsFile = "events.txt";
constexpr const char* kImuFile = "imu.txt";
constexpr std::size_t kPacketEvents = 1U << 14;
constexpr std::size_t kPacketSamples = 64;
constexpr std::int64_t kPacketSpan_ns = 10'000'000;  // so that streams alternate finely enough
constexpr int kLinesToTry = 1000;                    // without a single line of numbers: no table
constexpr std::size_t kMostColumns = 16;

// Where the columns of an IMU table are; the data set's order unless a header says otherwise.
struct ImuColumns {
  std::size_t time = 0, count = 7;
  std::array<std::size_t, 3> acceleration = {1, 2, 3}, angular_rate = {4, 5, 6};
};

bool isComment(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string_view::npos || line[first] == '#' || line[first] == '%';
}

// Lower-case words of a header or comment line.
std::vector<std::string> headerWords(std::string_view line) {
  std::string text(line);
  for (char& character : text)
    character = character == '#' || character == '%'
                    ? ' '
                    : static_cast<char>(std::tolower(static_cast<unsigned char>(character)));
  std::vector<std::string> words;
  ColumnParser parser(text);
  while (!parser.atEnd()) words.emplace_back(parser.word());
  return words;
}

bool contains(const std::string& word, std::string_view part) {
  return word.find(part) != std::string::npos;
}

// "id timestamp ang_vel_x .. lin_acc_z" (UZH-FPV) and the like; nothing if these aren't names of all seven
// columns.
std::optional<ImuColumns> imuColumns(const std::vector<std::string>& words) {
  ImuColumns columns;
  columns.count = words.size();
  std::size_t times = 0, accelerations = 0, rates = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "t" || words[i].starts_with("time")) {
      columns.time = i;
      ++times;
    } else if (contains(words[i], "acc") || (words[i].size() == 2 && words[i][0] == 'a')) {
      if (accelerations < 3) columns.acceleration[accelerations] = i;
      ++accelerations;
    } else if (contains(words[i], "ang") || contains(words[i], "gyr") || contains(words[i], "omega") ||
               (words[i].size() == 2 && (words[i][0] == 'g' || words[i][0] == 'w'))) {
      if (rates < 3) columns.angular_rate[rates] = i;
      ++rates;
    }
  }
  if (times != 1 || accelerations != 3 || rates != 3 || words.size() > kMostColumns) return std::nullopt;
  return columns;
}

// Numbers in the line; 0 if there is anything else in it.
std::size_t countNumbers(std::string_view line) {
  ColumnParser parser(line);
  double value = 0.0;
  std::size_t count = 0;
  while (!parser.atEnd()) {
    if (!parser.real(value)) return 0;
    ++count;
  }
  return count;
}

bool parseEvent(std::string_view line, Event& event) {
  ColumnParser parser(line);
  std::int64_t x = 0, y = 0, polarity = 0;
  if (!parser.decimal(9, event.time_ns) || !parser.decimal(0, x) || !parser.decimal(0, y) ||
      !parser.decimal(0, polarity) || !parser.atEnd())
    return false;
  constexpr std::int64_t kLargest = std::numeric_limits<std::uint16_t>::max();
  if (x < 0 || y < 0 || x > kLargest || y > kLargest || polarity < -1 || polarity > 1) return false;
  event.x_px = static_cast<std::uint16_t>(x);
  event.y_px = static_cast<std::uint16_t>(y);
  event.brighter = polarity > 0;
  return true;
}

bool parseSample(std::string_view line, const ImuColumns& columns, ImuSample& sample) {
  ColumnParser parser(line);
  std::array<double, kMostColumns> values = {};
  for (std::size_t i = 0; i < columns.count; ++i)
    if (i == columns.time ? !parser.decimal(9, sample.time_ns) : !parser.real(values[i])) return false;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    sample.specific_force_m_s2[axis] = values[columns.acceleration[static_cast<std::size_t>(axis)]];
    sample.angular_rate_rad_s[axis] = values[columns.angular_rate[static_cast<std::size_t>(axis)]];
  }
  return parser.atEnd();
}

}  // namespace

struct TextReader::Source {
  explicit Source(const std::filesystem::path& path) : lines(path) {}

  LineReader lines;
  std::string stream;
  std::optional<ImuColumns> imu_columns;  // none: events
  std::uint64_t first_data_line = 0;
  bool selected = true, exhausted = false;
  Packet pending;
  std::optional<std::int64_t> first_ns;

  bool empty() const { return pending.events.empty() && pending.imu_samples.empty(); }
  std::int64_t nextTime() const {
    return pending.events.empty() ? pending.imu_samples.front().time_ns : pending.events.front().time_ns;
  }
  // False where the line is no event or sample.
  bool parse(std::string_view line);
  bool packetFull() const;
};

bool TextReader::Source::parse(std::string_view line) {
  if (imu_columns) {
    ImuSample sample;
    if (!parseSample(line, *imu_columns, sample)) return false;
    pending.imu_samples.push_back(sample);
  } else {
    Event event;
    if (!parseEvent(line, event)) return false;
    pending.events.push_back(event);
  }
  return true;
}

bool TextReader::Source::packetFull() const {
  if (imu_columns)
    return pending.imu_samples.size() >= kPacketSamples ||
           pending.imu_samples.back().time_ns - pending.imu_samples.front().time_ns >= kPacketSpan_ns;
  return pending.events.size() >= kPacketEvents ||
         pending.events.back().time_ns - pending.events.front().time_ns >= kPacketSpan_ns;
}

bool TextReader::directoryHolds(const std::filesystem::path& directory) {
  return std::filesystem::exists(directory / kEventsFile) || std::filesystem::exists(directory / kImuFile);
}

TextReader::TextReader(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) {
    addFile(path);
    return;
  }
  for (const char* name : {kEventsFile, kImuFile})
    if (std::filesystem::exists(path / name)) addFile(path / name);
}

TextReader::~TextReader() = default;

// Looks at the first lines to learn which table this is.
void TextReader::addFile(const std::filesystem::path& path) {
  LineReader lines(path);
  if (lines.file().size() == 0)
    throw badInput(path.string(), "is empty", "Record again, or give another file");
  auto source = std::make_unique<Source>(path);
  StreamInfo info;
  std::vector<std::string> names;
  std::string_view line;
  std::size_t columns = 0;
  for (int i = 0; i < kLinesToTry && columns == 0 && lines.next(line); ++i) {
    columns = isComment(line) ? 0 : countNumbers(line);
    if (columns == 2) {  // "width height" before the first event
      ColumnParser parser(line);
      std::int64_t width = 0, height = 0;
      if (parser.decimal(0, width) && parser.decimal(0, height) && width > 0 && height > 0 && width < 65536 &&
          height < 65536)
        info.resolution_px = {static_cast<int>(width), static_cast<int>(height)};
    }
    if (columns == 0 && names.empty()) names = headerWords(line);
    if (columns != 4 && columns < 7) columns = 0;
  }
  const std::optional<ImuColumns> named = imuColumns(names);
  if (columns == 4) {
    if (names.size() == 4 && (names[0].starts_with("x") || names[3].starts_with("t")))
      throw badInput(path.string(), fmt::format("has the columns {}", joined(names)),
                     "Reorder them to t x y p, t in seconds");
    info.type = StreamType::Events;
    info.name = "events";
    info.message = "t x y p";
  } else if (columns == 7 || (named && named->count == columns)) {
    info.type = StreamType::Imu;
    info.name = "imu";
    info.message = "t ax ay az gx gy gz";
    source->imu_columns = named && named->count == columns ? *named : ImuColumns();
  } else {
    throw badInput(path.string(), "has no lines of events (t x y p) or IMU samples (t ax ay az gx gy gz)",
                   "Times are in seconds, columns are separated by blanks or commas");
  }
  source->stream = info.name;
  source->first_data_line = lines.lineNumber();
  streams_.push_back(info);
  sources_.push_back(std::move(source));
}

void TextReader::select(const std::vector<std::size_t>& streams) {
  for (std::size_t i = 0; i < sources_.size(); ++i)
    sources_[i]->selected = std::find(streams.begin(), streams.end(), i) != streams.end();
}

void TextReader::fill(Source& source) {
  std::string_view line;
  while (source.lines.next(line)) {
    if (source.lines.lineNumber() < source.first_data_line) continue;
    if (!source.parse(line)) {
      if (isComment(line)) continue;
      const double at_s =
          source.first_ns && !source.empty() ? secondsSince(*source.first_ns, source.nextTime()) : 0.0;
      const bool last = source.lines.fractionRead() >= 1.0;
      faults_.add(source.stream, last ? "truncated" : "malformed", at_s,
                  fmt::format("line {} of {} is {}: '{}'", source.lines.lineNumber(),
                              source.lines.file().path().filename().string(), last ? "cut off" : "malformed",
                              line.substr(0, 60)));
      continue;
    }
    if (!source.first_ns) source.first_ns = source.nextTime();
    if (source.packetFull()) return;
  }
  source.exhausted = true;
}

bool TextReader::read(Packet& packet) {
  Source* earliest = nullptr;
  for (const std::unique_ptr<Source>& source : sources_) {
    if (!source->selected) continue;
    if (source->empty() && !source->exhausted) fill(*source);
    if (!source->empty() && (earliest == nullptr || source->nextTime() < earliest->nextTime()))
      earliest = source.get();
  }
  if (earliest == nullptr) return false;
  packet.events.clear();
  packet.imu_samples.clear();
  std::swap(packet.events, earliest->pending.events);
  std::swap(packet.imu_samples, earliest->pending.imu_samples);
  packet.stream = 0;
  while (sources_[packet.stream].get() != earliest) ++packet.stream;
  return true;
}

double TextReader::fractionRead() const {
  double read = 0.0, total = 0.0;
  for (const std::unique_ptr<Source>& source : sources_) {
    if (!source->selected) continue;
    const auto size = static_cast<double>(source->lines.file().size());
    read += size * source->lines.fractionRead();
    total += size;
  }
  return total > 0.0 ? read / total : 1.0;
}

}  // namespace evical
