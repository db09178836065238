#include "core/recording/numpy/numpy_reader.h"

#include "core/recording/numpy/numpy_files.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/time.h"
#include "core/recording/column_guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace evical::numpy {
namespace {

constexpr std::size_t kPacketRows = 32'768;

template <class Number>
bool toTime(Number time, std::int64_t unit_ns, std::int64_t offset_ns, std::int64_t& time_ns) {
  if constexpr (std::is_floating_point_v<Number>) {
    const double scaled_ns = time * static_cast<double>(unit_ns);
    if (!(std::abs(scaled_ns) <= static_cast<double>(kLatestTime_ns))) return false;
    const double whole = std::floor(time);  // separate from its fraction, so that no digit is lost
    time_ns = static_cast<std::int64_t>(whole) * unit_ns +
              std::llround((time - whole) * static_cast<double>(unit_ns));
  } else {
    if (__builtin_mul_overflow(time, unit_ns, &time_ns)) return false;
  }
  return !__builtin_add_overflow(time_ns, offset_ns, &time_ns) && isTime(time_ns);
}

template <class Number>
bool toPixel(Number number, std::uint16_t& pixel) {
  if (!(number >= 0) || number > static_cast<Number>(std::numeric_limits<std::uint16_t>::max())) return false;
  pixel = static_cast<std::uint16_t>(number);
  return static_cast<Number>(pixel) == number;
}

}  // namespace

EventTable::EventTable(const EventLayout& layout)
    : blocks_(layout.columns, layout.rows),
      rows_(layout.rows),
      unit_ns_(layout.unit_ns),
      offset_ns_(layout.offset_ns) {}

bool EventTable::load(std::vector<Event>& events) {
  const std::uint64_t first_row = blocks_.rowsRead();
  const std::size_t count = blocks_.next(kPacketRows);
  events.resize(count);
  if (count == 0) return false;
  bad_.assign(count, 0);
  loadTimes(first_row, events);
  loadPlaces(first_row, events);
  loadPolarities(first_row, events);
  std::size_t kept = 0;
  for (std::size_t row = 0; row < count; ++row)
    if (bad_[row] == 0) events[kept++] = events[row];
  events.resize(kept);
  return true;
}

void EventTable::loadTimes(std::uint64_t first_row, std::vector<Event>& events) {
  blocks_.forEach(2, [&](std::size_t row, auto number) {
    if (toTime(number, unit_ns_, offset_ns_, events[row].time_ns)) return;
    bad_[row] = 1;
    untimed_.add(first_row + row);
  });
}

void EventTable::loadPlaces(std::uint64_t first_row, std::vector<Event>& events) {
  const auto leaveOut = [&](std::size_t row) {
    if (bad_[row] == 0) outside_.add(first_row + row);
    bad_[row] = 1;
  };
  blocks_.forEach(0, [&](std::size_t row, auto number) {
    if (!toPixel(number, events[row].x_px)) leaveOut(row);
  });
  blocks_.forEach(1, [&](std::size_t row, auto number) {
    if (!toPixel(number, events[row].y_px)) leaveOut(row);
  });
}

void EventTable::loadPolarities(std::uint64_t first_row, std::vector<Event>& events) {
  blocks_.forEach(3, [&](std::size_t row, auto number) {
    const std::optional<bool> brighter = brighterOf(number);
    events[row].brighter = brighter.value_or(false);
    if (brighter) return;
    if (bad_[row] == 0) unpolarised_.add(first_row + row);
    bad_[row] = 1;
  });
}

}  // namespace evical::numpy

namespace evical {
namespace {

constexpr std::size_t kMaxNamed = 20;
constexpr const char* kReadableArrays =
    "Save structured arrays with fields x, y, t, p, arrays of these names (also xy, timestamps, polarity "
    "and similar ones), or rows of four numbers: t, x, y, p in any order";

std::string list(const std::vector<std::string>& names) {
  const std::vector<std::string> first(
      names.begin(), names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), kMaxNamed)));
  return joined(first) + (names.size() > kMaxNamed ? ", ..." : "");
}

bool isOfAnImu(const std::string& name) {
  return name.find("imu") != std::string::npos || name.find("gyro") != std::string::npos ||
         name.find("accel") != std::string::npos;
}

// The first file with events in a folder of numbered files; the number of files if none has any.
std::size_t firstWithEvents(const std::vector<std::filesystem::path>& files) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    try {
      const numpy::FoundFiles found = numpy::arraysIn(files[i]);
      for (const numpy::EventLayout& layout : numpy::findEvents(found.arrays).events)
        if (layout.rows > 0) return i;
    } catch (const CalibrationError&) {
      // reported when it is read
    }
  }
  return files.size();
}

}  // namespace

bool isNumpyFile(const std::filesystem::path& path, std::string_view first_bytes) {
  return numpy::isArrayFile(path, first_bytes);
}

bool isNumpyFolder(const std::filesystem::path& folder) {
  if (numpy::nameEvents(numpy::arrayNames(folder))) return true;
  const std::vector<std::filesystem::path> files = numpy::numberedFiles(folder);
  return firstWithEvents(files) < files.size();
}

NumpyReader::NumpyReader(const std::filesystem::path& path) : path_(path) {
  numpy::FoundFiles found;
  std::size_t first_file = 0;
  if (!std::filesystem::is_directory(path)) {
    found = numpy::arraysIn(path);
  } else if (numpy::nameEvents(numpy::arrayNames(path))) {
    found = numpy::arraysOfFolder(path);
  } else {
    files_ = numpy::numberedFiles(path);
    first_file = firstWithEvents(files_);
    if (first_file == files_.size())
      throw badInput(path.string(), "the folder has no arrays of events", kReadableArrays);
    found = numpy::arraysIn(files_[first_file]);
  }
  for (const std::string& problem : found.problems) addFault("", FaultKind::Corrupt, problem);
  addArrays(found.arrays);
  if (!found.unread.empty())
    addFault("", FaultKind::Unreadable,
             fmt::format("The file also has data that are not read: {}.", list(found.unread)));
  for (Source& source : sources_) source.next_file = first_file;
}

void NumpyReader::addArrays(const std::vector<numpy::Array>& arrays) {
  const numpy::FoundArrays found = numpy::findEvents(arrays);
  if (found.events.empty()) failWithNames(arrays, found.problems);
  for (const numpy::EventLayout& layout : found.events) addStream(layout);
  for (const std::string& problem : found.problems) addFault("", FaultKind::Unreadable, problem);
  noteLeftOut(found.others);
}

void NumpyReader::addStream(const numpy::EventLayout& layout) {
  StreamInfo stream;
  stream.name = layout.name;
  stream.type = StreamType::Events;
  stream.message = layout.message;
  stream.resolution_px = layout.size_px;
  stream.messages = files_.empty() ? layout.rows : 0;
  stream.time_unit_ns = layout.unit_ns == 1000 ? 1000 : 1;
  streams_.push_back(std::move(stream));
  Source& source = sources_.emplace_back();
  source.layout = layout;
  if (!layout.problem.empty()) addFault(layout.name, FaultKind::Truncated, layout.problem);
  if (!layout.guess.empty()) addFault(layout.name, FaultKind::Guess, layout.guess);
  if (layout.step_ns > 0.0) {
    addFault(layout.name, FaultKind::Encoding,
             fmt::format("Times are numbers of {} bits with steps of {:.3f} ms; save them with 64 bits.",
                         8 * layout.columns[2].type.bytes, 1e-6 * layout.step_ns));
  }
}

void NumpyReader::noteLeftOut(const std::vector<const numpy::Array*>& others) {
  std::vector<std::string> objects, imus;
  for (const numpy::Array* array : others) {
    if (array->header.objects) {
      objects.push_back(array->name);
    } else if (isOfAnImu(array->name)) {
      imus.push_back(array->name);
    } else if (array->header.shape.size() >= 3) {
      StreamInfo stream;
      stream.name = array->name;
      stream.type = StreamType::Frames;
      stream.message = "array";
      stream.messages = array->header.shape.front();
      stream.readable = false;
      streams_.push_back(std::move(stream));
    }
  }
  if (!objects.empty())
    addFault("", FaultKind::Unreadable,
             fmt::format("Python objects are never unpickled: {}.", list(objects)));
  if (!imus.empty())
    addFault("", FaultKind::ImuLeftOut,
             fmt::format("IMU samples in arrays are not read: {}. Give the IMU as CSV.", list(imus)));
}

void NumpyReader::failWithNames(const std::vector<numpy::Array>& arrays,
                                const std::vector<std::string>& problems) const {
  std::vector<std::string> names;
  bool objects = false;
  for (const numpy::Array& array : arrays) {
    names.push_back(array.name);
    objects = objects || array.header.objects;
  }
  std::string problem = names.empty() ? "the file has no arrays"
                        : objects     ? "the arrays are Python objects, not events, and are never unpickled: "
                        : arrays.size() == 1 ? "this array is not events: "
                                             : "these arrays are not events: ";
  problem += list(names);
  // Notes are sentences, but errors have no full stop at their end.
  if (!faults_.empty()) problem += ". " + faults_.front().text.substr(0, faults_.front().text.size() - 1);
  if (!problems.empty()) problem += ". " + problems.front().substr(0, problems.front().size() - 1);
  if (arrays.size() == 1 && arrays.front().range.path == path_ && !objects &&
      !arrays.front().header.isStructured())
    problem += ". If each field is a separate file, give the folder";
  throw badInput(path_.string(), problem, kReadableArrays);
}

void NumpyReader::select(const std::vector<std::size_t>& streams) {
  for (Source& source : sources_) source.wanted = false;
  for (const std::size_t stream : streams) {
    static_cast<void>(streams_.at(stream));  // a wrong index is a bug of the caller
    if (stream < sources_.size()) sources_[stream].wanted = true;
  }
}

// The stream with the earliest time is read first, so that all advance together.
bool NumpyReader::read(Packet& packet) {
  for (;;) {
    Source* behind = nullptr;
    for (Source& source : sources_)
      if (source.wanted && !source.finished && (!behind || source.last_ns < behind->last_ns))
        behind = &source;
    packet.clear();
    if (!behind) return false;
    packet.stream = static_cast<std::size_t>(behind - sources_.data());
    if (fill(*behind, packet.events)) return true;
  }
}

bool NumpyReader::fill(Source& source, std::vector<Event>& events) {
  if (!source.rest.empty()) {
    std::swap(events, source.rest);
    source.rest.clear();
  } else if (!source.table && !openNext(source)) {
    finish(source);
    return false;
  } else if (!source.table->load(events)) {
    closeTable(source);
    return false;
  }
  if (events.empty()) return false;
  source.order.split(events, source.rest);
  source.last_ns = events.back().time_ns;
  return true;
}

// The file itself, or the next of numbered ones; these are read like the first.
bool NumpyReader::openNext(Source& source) {
  if (files_.empty()) {
    if (source.next_file++ > 0) return false;
    source.table = std::make_unique<numpy::EventTable>(source.layout);
    return true;
  }
  while (source.next_file < files_.size()) {
    const std::filesystem::path& file = files_[source.next_file++];
    try {
      const numpy::FoundFiles found = numpy::arraysIn(file);
      std::vector<numpy::EventLayout> layouts = numpy::findEvents(found.arrays).events;
      const auto layout = std::find_if(
          layouts.begin(), layouts.end(),
          [&](const numpy::EventLayout& candidate) { return candidate.name == source.layout.name; });
      if (layout == layouts.end()) throw badInput(file.string(), "there are no arrays of events");
      layout->unit_ns = source.layout.unit_ns;
      if (!layout->problem.empty())
        addFault(source.layout.name, FaultKind::Truncated, file.filename().string() + ": " + layout->problem);
      source.table = std::make_unique<numpy::EventTable>(*layout);
      return true;
    } catch (const CalibrationError& error) {
      addFault(source.layout.name, FaultKind::Unreadable,
               fmt::format("{} is left out: {}.", file.filename().string(), error.problem()));
    }
  }
  return false;
}

void NumpyReader::closeTable(Source& source) {
  const numpy::EventTable& table = *source.table;
  const std::string problem = table.problem();
  const std::string file = files_.empty() ? "" : files_[source.next_file - 1].filename().string() + ": ";
  if (!problem.empty())
    addFault(source.layout.name, table.rowsRead() < table.rows() ? FaultKind::Truncated : FaultKind::Corrupt,
             fmt::format("{}{}; {} of {} rows were read.", file, problem, table.rowsRead(), table.rows()));
  const auto say = [&](FaultKind kind, const Occurrences& rows, const char* what) {
    if (rows.count == 0) return;
    addFault(source.layout.name, kind,
             fmt::format("{}{} {}, from row {} on.", file, rows.count, what, rows.first_byte));
  };
  say(FaultKind::Untimed, table.untimed(), "rows have no time and are left out");
  say(FaultKind::Corrupt, table.unpolarised(),
      "rows have a polarity other than 1, 0 and -1 and are left out");
  say(FaultKind::Outside, table.outside(), "rows have invalid pixel coordinates and are left out");
  source.table.reset();
}

void NumpyReader::finish(Source& source) {
  source.finished = true;
  if (source.order.changedAnything()) addFault(source.layout.name, FaultKind::Unsorted, source.order.text());
}

// By rows, or by files.
double NumpyReader::fractionRead() const {
  double read = 0.0, all = 0.0;
  for (const Source& source : sources_) {
    if (!source.wanted) continue;
    const auto rows = static_cast<double>(source.table ? source.table->rowsRead() : 0);
    if (files_.empty()) {
      const auto total = static_cast<double>(source.layout.rows);
      read += source.table ? rows : source.next_file > 0 ? total : 0.0;
      all += total;
    } else {
      read += static_cast<double>(source.next_file) - (source.table ? 0.5 : 0.0);
      all += static_cast<double>(files_.size());
    }
  }
  return all == 0.0 ? 1.0 : std::min(1.0, read / all);
}

void NumpyReader::addFault(const std::string& stream, FaultKind kind, const std::string& text) {
  const auto alike = [&](const RecordingFault& fault) {
    return fault.stream == stream && fault.kind == kind;
  };
  if (std::count_if(faults_.begin(), faults_.end(), alike) < kMostAlikeFaults)
    faults_.push_back({stream, kind, 0.0, text});
}

}  // namespace evical
