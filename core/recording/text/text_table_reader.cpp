#include "core/recording/text/text_table_reader.h"

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/base/plain_text.h"
#include "core/base/time.h"
#include "core/recording/column_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>

namespace evical {
namespace {

constexpr std::size_t kTextPacketEvents = 10'000;
constexpr std::int64_t kTextPacketSpan_ns = 10'000'000;
constexpr std::size_t kTextPacketSamples = 10;
constexpr std::uint64_t kMaxBadLines = 10;                 // reported individually
constexpr std::size_t kHead_bytes = std::size_t{1} << 18;  // a second of any IMU's samples
constexpr std::int64_t kDay_ns = 86'400 * kSecond_ns;
constexpr const char* kFiles[] = {"events.txt", "imu.txt", "events.csv", "imu.csv"};

bool parsePixel(std::string_view text, std::uint16_t& value) {
  if (parseNumber(text, value)) return true;
  double number = 0.0;  // as numpy.savetxt writes it
  if (!parseNumber(text, number) || number < 0.0 || number > 65535.0) return false;
  value = static_cast<std::uint16_t>(number);
  return static_cast<double>(value) == number;
}

bool parsePolarity(std::string_view text, bool& brighter) {
  double number = 0.0;
  brighter = text == "1" || text == "true" || text == "True";
  if (brighter || text == "0" || text == "false" || text == "False") return true;
  if (!parseNumber(text, number)) return false;
  brighter = number == 1.0;
  return number == 1.0 || number == 0.0 || number == -1.0;
}

bool isComment(std::string_view line) {
  const std::string_view column = takeColumn(line);
  return column.empty() || column.front() == '#' || column.front() == '%';
}

bool parseVector(const std::vector<std::string_view>& cells, const std::array<std::size_t, 3>& axes,
                 const TextStyle& style, const std::array<double, 3>& factor, Eigen::Vector3d& vector) {
  for (std::size_t i = 0; i < 3; ++i) {
    double& value = vector[static_cast<Eigen::Index>(i)];
    if (!parseCell(cells[axes[i]], style, value)) return false;
    value *= factor[i];
  }
  return true;
}

const char* rowOf(const TextColumns& columns) {
  if (columns.type == StreamType::Events) return "t x y p";
  if (columns.type == StreamType::Points) return "t point x y";
  return columns.measured_by == MeasuredBy::Gyroscope       ? "t gx gy gz"
         : columns.measured_by == MeasuredBy::Accelerometer ? "t ax ay az"
                                                            : "t ax ay az gx gy gz";
}

TextColumns columnsIn(const std::filesystem::path& file) {
  const std::string head = firstTextBytes(file, kHead_bytes);
  return findColumns(head, head.size() == kHead_bytes, {}, file.filename().string());
}

std::vector<std::filesystem::path> textFiles(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::filesystem::path& file = entry.path();
    const std::filesystem::path extension =
        file.extension() == ".gz" ? file.stem().extension() : file.extension();
    if (entry.is_regular_file() && (extension == ".csv" || extension == ".txt" || extension == ".gcsv"))
      files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Tables of IMUs, or of one of their sensors, in a folder; also those whose columns the session names.
std::vector<std::filesystem::path> imuTables(const std::filesystem::path& folder, const ColumnNames& names) {
  std::vector<std::filesystem::path> files = textFiles(folder);
  std::erase_if(files, [&](const std::filesystem::path& file) {
    const std::string name = visible(file.filename().string());
    const bool known =
        std::any_of(std::begin(kFiles), std::end(kFiles), [&](const char* each) { return name == each; });
    return known || (!names.contains(name) && columnsIn(file).type != StreamType::Imu);
  });
  return files;
}

}  // namespace

bool isTextTable(const std::filesystem::path& file) {
  const std::string head = firstTextBytes(file, kHead_bytes);
  return findColumns(head, head.size() == kHead_bytes).isTable();
}

bool hasImuTables(const std::filesystem::path& folder, const ColumnNames& names) {
  return !imuTables(folder, names).empty();
}

bool isTextFolder(const std::filesystem::path& folder) {
  return std::any_of(std::begin(kFiles), std::end(kFiles),
                     [&](const char* name) { return std::filesystem::exists(folder / name); });
}

TextTableReader::TextTableReader(const std::filesystem::path& path, const ColumnNames& names) {
  const auto namesOf = [&](const std::string& file) {
    const auto found = names.find(file);
    return found == names.end() ? std::string() : found->second;
  };
  if (!std::filesystem::is_directory(path)) {
    addTable(path, namesOf(visible(path.filename().string())));
    return;
  }
  for (const char* name : kFiles)
    if (std::filesystem::exists(path / name)) addTable(path / name, namesOf(name));
  const auto isImu = [](const StreamInfo& stream) { return stream.type == StreamType::Imu; };
  if (std::any_of(streams_.begin(), streams_.end(), isImu)) return;
  for (const std::filesystem::path& file : imuTables(path, names))
    addTable(file, namesOf(visible(file.filename().string())));
  addUnreadSensors(path, names);
}

// Reports tables that a sensor's name leads to expect, but that cannot be read.
void TextTableReader::addUnreadSensors(const std::filesystem::path& folder, const ColumnNames& names) {
  for (const std::filesystem::path& file : textFiles(folder)) {
    const std::string name = visible(file.filename().string());
    const TextColumns columns = columnsIn(file);
    if (names.contains(name) || columns.problem.empty() || !sensorNamed(file.stem().string())) continue;
    faults_.push_back(
        {name, FaultKind::Corrupt, 0.0, fmt::format("{} is not read: {}.", name, columns.problem)});
  }
}

void TextTableReader::addTable(const std::filesystem::path& path, const std::string& names) {
  const std::string head = firstTextBytes(path, kHead_bytes);
  TextColumns columns = findColumns(head, head.size() == kHead_bytes, names, path.filename().string());
  if (!columns.problem.empty()) throw badInput(path.string(), columns.problem, columns.advice);
  if (columns.type == StreamType::Other)
    throw badInput(path.string(),
                   "the lines are neither events nor IMU samples, and no header names the columns",
                   "Add a line such as \"t_us,x,y,p\" or \"time_s,point,x_px,y_px\" at the top");
  if (path.extension() == ".csv" || path.stem().extension() == ".csv") format_ = "csv";
  const std::vector<TextColumns> further = std::move(columns.further);
  addSource(path, std::move(columns));
  for (const TextColumns& other : further) addSource(path, other);
}

// A stream of a file. One of several IMUs has its own name.
void TextTableReader::addSource(const std::filesystem::path& path, TextColumns columns) {
  StreamInfo stream;
  stream.name = visible(path.filename().string()) + (columns.part.empty() ? "" : ":" + columns.part);
  stream.type = columns.type;
  stream.message = rowOf(columns);
  if (!columns.scales.empty()) stream.message += "; " + columns.scales;
  if (!columns.unused.empty()) stream.message += "; not used: " + columns.unused;
  stream.resolution_px = columns.resolution_px;
  stream.time_unit_ns = columns.time.back().unit_ns == kMicrosecond_ns ? kMicrosecond_ns : 1;
  stream.acceleration_unit = columns.acceleration_unit;
  stream.angular_rate_unit = columns.angular_rate_unit;
  streams_.push_back(stream);
  for (const std::string& note : columns.notes) faults_.push_back({stream.name, FaultKind::Guess, 0.0, note});
  const std::size_t width = columns.count();
  sources_.push_back(
      {TextLines(path), std::move(columns), width, true, false, std::numeric_limits<std::int64_t>::min()});
}

void TextTableReader::select(const std::vector<std::size_t>& streams) {
  for (Source& source : sources_) source.wanted = false;
  for (const std::size_t stream : streams) sources_.at(stream).wanted = true;
}

// The stream with the earliest time is read first, so that all files advance together.
bool TextTableReader::read(Packet& packet) {
  packet.clear();
  while (packet.empty()) {
    Source* behind = nullptr;
    for (Source& source : sources_) {
      const bool runs = source.wanted && !source.finished;
      if (runs && (!behind || source.last_ns < behind->last_ns)) behind = &source;
    }
    if (!behind) return false;
    packet.stream = static_cast<std::size_t>(behind - sources_.data());
    if (behind->columns.type == StreamType::Events) {
      fillEvents(*behind, packet.stream, packet.events);
    } else if (behind->columns.type == StreamType::Points) {
      fillPoints(*behind, packet.stream, packet.points);
    } else {
      fillImu(*behind, packet.stream, packet.imu_samples);
    }
  }
  return true;
}

// A packet ends if time steps back: events within a packet are in order, and nothing is rearranged.
void TextTableReader::fillEvents(Source& source, std::size_t stream, std::vector<Event>& events) {
  if (source.has_next_event) events.push_back(source.next_event);
  source.has_next_event = false;
  std::string_view line;
  Event event{};
  for (;;) {
    if (!events.empty() && source.lines.wouldWait()) return;
    if (!source.lines.next(line)) break;
    if (!parseEvent(source, line, event)) {
      if (isNoRow(source, line)) continue;
      if (isOtherType(source))
        ++source.other_types;
      else
        addBadLine(source, stream);
      continue;
    }
    addDay(source, event.time_ns);
    if (!events.empty() && (event.time_ns < events.back().time_ns || events.size() >= kTextPacketEvents ||
                            event.time_ns - events.front().time_ns >= kTextPacketSpan_ns)) {
      source.next_event = event;
      source.has_next_event = true;
      source.last_ns = event.time_ns;
      return;
    }
    events.push_back(event);
  }
  finish(source, stream);
}

void TextTableReader::fillImu(Source& source, std::size_t stream, std::vector<RawImuSample>& samples) {
  std::string_view line;
  RawImuSample sample;
  while (samples.size() < kTextPacketSamples) {
    if (!samples.empty() && source.lines.wouldWait()) return;
    if (!source.lines.next(line)) return finish(source, stream);
    if (parseImu(source, line, sample)) {
      addDay(source, sample.time_ns);
      samples.push_back(sample);
      source.last_ns = sample.time_ns;
    } else if (!isNoRow(source, line)) {
      addBadLine(source, stream);
    }
  }
}

// A packet contains the points of one time.
void TextTableReader::fillPoints(Source& source, std::size_t stream, std::vector<MeasuredPoint>& points) {
  if (source.next_point) points.push_back(*source.next_point);
  source.next_point.reset();
  std::string_view line;
  MeasuredPoint point;
  while (source.lines.next(line)) {
    if (!parsePoint(source, line, point)) {
      if (!isNoRow(source, line)) addBadLine(source, stream);
      continue;
    }
    addDay(source, point.time_ns);
    source.last_ns = point.time_ns;
    if (!points.empty() && point.time_ns != points.back().time_ns) {
      source.next_point = point;
      return;
    }
    constexpr std::size_t kMax = std::size_t{std::numeric_limits<std::uint16_t>::max()} + 1;
    if (points.size() == kMax)
      throw badInput(fmt::format("{} (line {})", streams_[stream].name, source.lines.number()),
                     fmt::format("more than {} points have the same time", kMax),
                     "Give each view another time");
    points.push_back(point);
  }
  finish(source, stream);
}

void TextTableReader::finish(Source& source, std::size_t stream) {
  source.finished = true;
  if (source.bad_lines > kMaxBadLines)
    faults_.push_back(
        {streams_[stream].name, FaultKind::Corrupt, 0.0,
         fmt::format("{} left out; {} in all.",
                     counted(source.bad_lines - kMaxBadLines, "more line", "is", "are"), source.bad_lines)});
  if (source.other_types > 0)
    faults_.push_back({streams_[stream].name, FaultKind::Triggers, 0.0,
                       counted(source.other_types, "line", "is", "are") +
                           " left out: their type is neither 0 (darker) nor 1 (brighter)."});
  if (!source.lines.isDamaged()) return;
  faults_.push_back(
      {streams_[stream].name, FaultKind::Truncated, 0.0,
       fmt::format("The packed file is damaged after line {}; the rest is lost.", source.lines.number())});
}

// Times of day start again at midnight.
void TextTableReader::addDay(Source& source, std::int64_t& time_ns) {
  if (!source.columns.clock_times) return;
  const std::int64_t since_ns = source.clock_ns ? time_ns - *source.clock_ns : 0;
  if (since_ns > kDay_ns / 2) {  // a late sample from before midnight
    time_ns += source.days_ns - kDay_ns;
    return;
  }
  if (since_ns < -kDay_ns / 2) source.days_ns += kDay_ns;
  source.clock_ns = time_ns;
  time_ns += source.days_ns;
}

bool TextTableReader::isNoRow(const Source& source, std::string_view line) const {
  const std::optional<RowSelection>& only = source.columns.only;
  return source.lines.number() < source.columns.first_row || isComment(line) ||
         (only && parts_.size() > only->column && parts_[only->column] != only->text);  // of another IMU
}

// A trigger or a reset among events.
bool TextTableReader::isOtherType(const Source& source) const {
  std::uint16_t type = 0;
  return source.columns.has_types && parts_.size() >= source.width &&
         parseNumber(parts_[source.columns.polarity], type) && type > 1;
}

bool TextTableReader::parseEvent(const Source& source, std::string_view line, Event& event) {
  const TextColumns& columns = source.columns;
  splitColumns(line, columns.style, parts_);
  return parts_.size() >= source.width && parseTimes(parts_, columns, event.time_ns) &&
         parsePixel(parts_[columns.x], event.x_px) && parsePixel(parts_[columns.y], event.y_px) &&
         parsePolarity(parts_[columns.polarity], event.brighter);
}

bool TextTableReader::parsePoint(const Source& source, std::string_view line, MeasuredPoint& point) {
  const TextColumns& columns = source.columns;
  splitColumns(line, columns.style, parts_);
  std::uint16_t index = 0;
  double x_px = 0.0, y_px = 0.0, sigma_px = 0.0;
  const auto real = [&](std::size_t column, double& number) {
    return parseCell(parts_[column], columns.style, number);
  };
  if (parts_.size() < source.width || !parseTimes(parts_, columns, point.time_ns) ||
      !parseNumber(parts_[columns.point], index) || !real(columns.x, x_px) || !real(columns.y, y_px) ||
      (columns.sigma && !real(*columns.sigma, sigma_px)) || sigma_px < 0.0)
    return false;
  point.point = index;
  point.x_px = static_cast<float>(x_px);
  point.y_px = static_cast<float>(y_px);
  point.sigma_px = static_cast<float>(sigma_px);
  return true;
}

bool TextTableReader::parseImu(const Source& source, std::string_view line, RawImuSample& sample) {
  const TextColumns& columns = source.columns;
  splitColumns(line, columns.style, parts_);
  sample.measured_by = columns.measured_by;
  const bool own =
      parts_.size() >= source.width && (!columns.only || parts_[columns.only->column] == columns.only->text);
  return own && parseTimes(parts_, columns, sample.time_ns) &&
         (!columns.measures(MeasuredBy::Accelerometer) ||
          parseVector(parts_, columns.acceleration, columns.style, columns.acceleration_factor,
                      sample.specific_force)) &&
         (!columns.measures(MeasuredBy::Gyroscope) ||
          parseVector(parts_, columns.rate, columns.style, columns.rate_factor, sample.angular_rate));
}

void TextTableReader::addBadLine(Source& source, std::size_t stream) {
  if (++source.bad_lines > kMaxBadLines) return;
  const std::string time = timeOutOfRange(parts_, source.columns);
  if (!time.empty()) {
    faults_.push_back({streams_[stream].name, FaultKind::Unit, 0.0,
                       fmt::format("Line {}: {}; it is left out.", source.lines.number(), time)});
    return;
  }
  const bool last = source.lines.atEnd();
  faults_.push_back(
      {streams_[stream].name, last ? FaultKind::Truncated : FaultKind::Corrupt, 0.0,
       fmt::format("Line {} is not \"{}\"; it is left out.", source.lines.number(), rowOf(source.columns))});
}

// Follows one table. Several would be read by their times, each waiting for the others. A packed one needs
// its end.
bool TextTableReader::follow(const std::shared_ptr<Growth>& growth) {
  if (sources_.size() != 1 || sources_.front().lines.isPacked()) return false;
  sources_.front().lines.follow(growth);
  return true;
}

double TextTableReader::fractionRead() const {
  double read = 0.0, size = 1.0;
  for (const Source& source : sources_) {
    if (!source.wanted) continue;
    read += static_cast<double>(source.lines.bytesRead());
    size += static_cast<double>(source.lines.size());
  }
  return read / std::max(1.0, size - 1.0);
}

}  // namespace evical
