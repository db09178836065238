#include "core/recording/text/text_table_reader.h"

#include "core/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>

namespace evical {
namespace {

constexpr std::size_t kTextPacketEvents = 10'000;
constexpr std::int64_t kTextPacketSpan_ns = 10'000'000;
constexpr std::size_t kTextPacketSamples = 10;
constexpr int kMostBadLines = 10;  // reported one by one
constexpr std::size_t kHead_bytes = std::size_t{1} << 16;
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

int digitsOf(std::int64_t unit_ns) {
  int digits = 0;
  for (; unit_ns >= 10; unit_ns /= 10) ++digits;
  return digits;
}

bool parseVector(const std::vector<std::string_view>& parts, std::size_t first, Eigen::Vector3d& vector) {
  return parseNumber(parts[first], vector.x()) && parseNumber(parts[first + 1], vector.y()) &&
         parseNumber(parts[first + 2], vector.z());
}

const char* progressMessage(StreamType type) {
  return type == StreamType::Events   ? "t x y p"
         : type == StreamType::Points ? "t point x y"
                                      : "t ax ay az gx gy gz";
}

}  // namespace

StreamType textTableType(std::string_view first_bytes) {
  return findColumns(first_bytes, true).type;
}

bool isTextFolder(const std::filesystem::path& folder) {
  return std::any_of(std::begin(kFiles), std::end(kFiles),
                     [&](const char* name) { return std::filesystem::exists(folder / name); });
}

TextTableReader::TextTableReader(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) {
    addSource(path);
    return;
  }
  for (const char* name : kFiles)
    if (std::filesystem::exists(path / name)) addSource(path / name);
}

void TextTableReader::addSource(const std::filesystem::path& path) {
  const std::string head = firstTextBytes(path, kHead_bytes);
  TextColumns columns = findColumns(head, head.size() == kHead_bytes);
  const std::string name = path.filename().string();
  if (name == kFiles[0] && columns.header_line == 0) {
    const Resolution size_px = columns.resolution_px;
    columns = {};  // the name says it all, also where the numbers allow a guess
    columns.type = StreamType::Events;
    columns.resolution_px = size_px;
  } else if (name == kFiles[1] && columns.header_line == 0) {
    columns = {};
    columns.type = StreamType::Imu;
  }
  if (columns.type == StreamType::Other) {
    throw badInput(path.string(),
                   "the lines are neither events nor IMU samples, and no header names the columns",
                   "Put a line such as \"t_us,x,y,p\" or \"time_s,point,x_px,y_px\" on top");
  }
  if (path.extension() == ".csv" || path.stem().extension() == ".csv") format_ = "csv";
  StreamInfo stream;
  stream.name = name;
  stream.type = columns.type;
  stream.message = progressMessage(columns.type);
  stream.resolution_px = columns.resolution_px;
  stream.time_unit_ns = columns.time_unit_ns == 1000 ? 1000 : 1;
  stream.acceleration_unit = columns.acceleration_unit;
  stream.angular_rate_unit = columns.angular_rate_unit;
  streams_.push_back(stream);
  if (!columns.guess.empty()) faults_.push_back({name, FaultKind::Guess, 0.0, columns.guess});
  const int digits = digitsOf(columns.time_unit_ns);
  sources_.push_back(
      {TextLines(path), std::move(columns), digits, true, false, std::numeric_limits<std::int64_t>::min()});
}

void TextTableReader::select(const std::vector<std::size_t>& streams) {
  for (Source& source : sources_) source.wanted = false;
  for (const std::size_t stream : streams) sources_.at(stream).wanted = true;
}

// The stream that is behind goes first, so that files are read side by side.
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

// A packet ends where time steps back: within a packet events are in order, and nothing is rearranged.
void TextTableReader::fillEvents(Source& source, std::size_t stream, std::vector<Event>& events) {
  if (source.has_next_event) events.push_back(source.next_event);
  source.has_next_event = false;
  std::string_view line;
  Event event{};
  while (source.lines.next(line)) {
    if (!parseEvent(source, line, event)) {
      if (isNoRow(source, line)) continue;
      addBadLine(source, stream);
      continue;
    }
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
    if (!source.lines.next(line)) return finish(source, stream);
    if (parseImu(source, line, sample)) {
      samples.push_back(sample);
      source.last_ns = sample.time_ns;
    } else if (!isNoRow(source, line)) {
      addBadLine(source, stream);
    }
  }
}

// A packet holds the points of one time.
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
    source.last_ns = point.time_ns;
    if (!points.empty() && point.time_ns != points.back().time_ns) {
      source.next_point = point;
      return;
    }
    points.push_back(point);
  }
  finish(source, stream);
}

void TextTableReader::finish(Source& source, std::size_t stream) {
  source.finished = true;
  if (!source.lines.isDamaged()) return;
  faults_.push_back({streams_[stream].name, FaultKind::Truncated, 0.0,
                     fmt::format("The packed file is damaged after line {}; what comes behind is lost.",
                                 source.lines.number())});
}

bool TextTableReader::isNoRow(const Source& source, std::string_view line) {
  return source.lines.number() == source.columns.header_line || isComment(line);
}

bool TextTableReader::parseEvent(const Source& source, std::string_view line, Event& event) {
  const TextColumns& columns = source.columns;
  splitColumns(line, parts_);
  return parts_.size() >= columns.count() &&
         parseTime(parts_[columns.time], source.time_digits, event.time_ns) &&
         parsePixel(parts_[columns.x], event.x_px) && parsePixel(parts_[columns.y], event.y_px) &&
         parsePolarity(parts_[columns.polarity], event.brighter);
}

bool TextTableReader::parsePoint(const Source& source, std::string_view line, MeasuredPoint& point) {
  const TextColumns& columns = source.columns;
  splitColumns(line, parts_);
  std::uint16_t index = 0;
  double x_px = 0.0, y_px = 0.0, sigma_px = 0.0;
  if (parts_.size() < columns.count() ||
      !parseTime(parts_[columns.time], source.time_digits, point.time_ns) ||
      !parseNumber(parts_[columns.point], index) || !parseNumber(parts_[columns.x], x_px) ||
      !parseNumber(parts_[columns.y], y_px) ||
      (columns.sigma && !parseNumber(parts_[*columns.sigma], sigma_px)) || sigma_px < 0.0)
    return false;
  point.point = index;
  point.x_px = static_cast<float>(x_px);
  point.y_px = static_cast<float>(y_px);
  point.sigma_px = static_cast<float>(sigma_px);
  return true;
}

bool TextTableReader::parseImu(const Source& source, std::string_view line, RawImuSample& sample) {
  const TextColumns& columns = source.columns;
  splitColumns(line, parts_);
  return parts_.size() >= columns.count() &&
         parseTime(parts_[columns.time], source.time_digits, sample.time_ns) &&
         parseVector(parts_, columns.acceleration, sample.specific_force) &&
         parseVector(parts_, columns.rate, sample.angular_rate);
}

void TextTableReader::addBadLine(const Source& source, std::size_t stream) {
  const std::string& name = streams_[stream].name;
  const auto alike = [&](const RecordingFault& fault) {
    return fault.stream == name && fault.kind != FaultKind::Guess;
  };
  if (std::count_if(faults_.begin(), faults_.end(), alike) >= kMostBadLines) return;
  const bool last = source.lines.atEnd();
  faults_.push_back({name, last ? FaultKind::Truncated : FaultKind::Corrupt, 0.0,
                     fmt::format("Line {} is not \"{}\"; it is left out.", source.lines.number(),
                                 streams_[stream].message)});
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
