#include "core/recording/numpy/numpy_layouts.h"

#include "core/base/time.h"
#include "core/data/recording.h"
#include "core/recording/column_guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <type_traits>
#include <utility>

namespace evical::numpy {
namespace {

constexpr std::size_t kHeadRows = 2000;
constexpr std::size_t kEnoughArrayRows = 100;
constexpr double kFewestArrayEventsPerS = 50.0;  // as seconds; slower ones are us with fractions
constexpr std::size_t kFewestRows = 5;           // of a table identified by its numbers: a matrix has four
constexpr double kCoarse_ns = 1000.0;

// Numbers of one kind, one per row, with the stated and the actual number of rows.
struct Numbers {
  Column column;
  std::uint64_t claimed = 0, rows = 0;
};

void countRows(const Array& array, Numbers& numbers) {
  const Column& column = numbers.column;
  const std::uint64_t there = array.range.bytes, before = column.data_offset + column.start;
  const std::uint64_t most = there > before ? (there - before) / column.stride : 0;
  numbers.rows = std::min(numbers.claimed, most);
}

Numbers numbersOf(const Array& array, const Field& field, std::uint64_t rows) {
  Numbers numbers;
  numbers.column.array = array.name;
  numbers.column.range = array.range;
  numbers.column.data_offset = array.header.data_offset;
  numbers.column.stride = array.header.element_bytes;
  numbers.column.offset = field.offset;
  numbers.column.type = *field.type;
  numbers.claimed = rows;
  return numbers;
}

bool isPlain(const Array& array) {
  const ArrayHeader& header = array.header;
  return !header.isStructured() && !header.objects && header.fields.front().type &&
         header.fields.front().count == 1;
}

// One column: (N), (N, 1) or a single number.
std::optional<Numbers> listOf(const Array& array) {
  const auto& shape = array.header.shape;
  const auto longer = std::count_if(shape.begin(), shape.end(), [](std::uint64_t side) { return side != 1; });
  if (!isPlain(array) || longer > 1) return std::nullopt;
  Numbers numbers = numbersOf(array, array.header.fields.front(), array.header.elements());
  countRows(array, numbers);
  return numbers;
}

// Array with this number of columns: (N, count) in either order of memory, or (count, N).
std::vector<Numbers> columnsOf(const Array& array, std::size_t count) {
  const auto& shape = array.header.shape;
  if (!isPlain(array) || shape.size() != 2 || (shape[0] != count && shape[1] != count)) return {};
  const bool lying = shape[1] != count;
  const std::uint64_t rows = lying ? shape[1] : shape[0];
  const bool interleaved = lying == array.header.by_columns;
  const std::size_t size = array.header.element_bytes;
  std::vector<Numbers> columns(count, numbersOf(array, array.header.fields.front(), rows));
  for (std::size_t i = 0; i < count; ++i) {
    Column& column = columns[i].column;
    if (interleaved) {
      column.stride = count * size;
      column.offset = i * size;
    } else if (__builtin_mul_overflow(rows, i * size, &column.start) || column.start > array.range.bytes) {
      column.start = array.range.bytes;  // beyond the existing bytes
    }
    countRows(array, columns[i]);
  }
  return columns;
}

// A single whole number.
std::optional<std::int64_t> scalarOf(const Array& array) {
  const std::optional<Numbers> numbers = listOf(array);
  if (!numbers || numbers->rows != 1) return std::nullopt;
  ColumnBlocks blocks(std::span(&numbers->column, 1), 1);
  std::optional<std::int64_t> value;
  if (blocks.next(1) == 1)
    blocks.forEach(0, [&](std::size_t, auto number) {
      constexpr auto kMax = static_cast<decltype(number)>(kLatestTime_ns);
      if (number <= kMax && number >= decltype(number)(0) - (std::is_signed_v<decltype(number)> ? kMax : 0))
        value = static_cast<std::int64_t>(number);
    });
  return value;
}

// The first rows of some columns.
std::vector<ColumnNumbers> headOf(std::span<const Column> columns, std::uint64_t rows, std::size_t& count) {
  std::vector<ColumnNumbers> heads(columns.size());
  ColumnBlocks blocks(columns, rows);
  count = 0;
  while (count < kHeadRows) {
    const std::size_t got = blocks.next(kHeadRows - count);
    if (got == 0) break;
    for (std::size_t i = 0; i < columns.size(); ++i)
      blocks.forEach(i, [&](std::size_t row, auto number) {
        heads[i].add(static_cast<double>(number), count + row == 0);
      });
    count += got;
  }
  return heads;
}

// Unit of the first times, if neither name nor type determines it.
std::int64_t unitOfTimes(const ColumnNumbers& times, std::size_t rows) {
  const bool slow = rows >= kEnoughArrayRows &&
                    static_cast<double>(rows) < kFewestArrayEventsPerS * (times.last - times.first);
  return !times.whole && slow ? 1000 : guessTimeUnit_ns(times, rows);
}

// x, y, t, p combined to one table.
EventLayout layoutOf(const std::array<Numbers, 4>& numbers, std::optional<std::int64_t> unit_ns) {
  EventLayout layout;
  layout.rows = std::numeric_limits<std::uint64_t>::max();
  std::array<std::uint64_t, 4> rows{};
  bool all = true;
  for (std::size_t i = 0; i < 4; ++i) {
    layout.columns[i] = numbers[i].column;
    rows[i] = numbers[i].rows;
    layout.rows = std::min(layout.rows, rows[i]);
    all = all && numbers[i].rows == numbers[i].claimed;
  }
  if (std::set<std::uint64_t>(rows.begin(), rows.end()).size() > 1) {
    layout.problem = fmt::format("x, y, t, p have {}, {}, {}, {} rows; the first {} are read.", rows[0],
                                 rows[1], rows[2], rows[3], layout.rows);
  } else if (!all) {
    layout.problem = fmt::format("The array states {} rows and has {}; the file is cut off.",
                                 numbers[2].claimed, numbers[2].rows);
  }
  std::size_t count = 0;
  const ColumnNumbers times = headOf(std::span(&layout.columns[2], 1), layout.rows, count)[0];
  const std::int64_t type_unit_ns = layout.columns[2].type.unit_ns;
  layout.unit_ns = type_unit_ns > 0 ? type_unit_ns : unit_ns.value_or(unitOfTimes(times, count));
  const bool obvious = type_unit_ns > 0 || unit_ns || count == 0 || layout.unit_ns == 1'000'000'000;
  if (!obvious)
    layout.guess = fmt::format(
        "The unit of time is not stated; {} is assumed. If it is wrong, rename the times to t_ns, "
        "t_us or t_s.",
        timeUnitName(layout.unit_ns));
  if (layout.columns[2].type.kind == NumberType::Kind::Real && layout.columns[2].type.bytes < 8 &&
      count > 0) {
    const auto time = static_cast<float>(times.largest);
    layout.step_ns = static_cast<double>(layout.unit_ns) *
                     static_cast<double>(std::nextafter(time, std::numeric_limits<float>::max()) - time);
    if (layout.step_ns <= kCoarse_ns) layout.step_ns = 0.0;
  }
  return layout;
}

// Types of the records of Evical's Python module.
bool hasOwnTypes(const EventLayout& layout) {
  const auto is = [&](std::size_t i, NumberType::Kind kind, int bytes) {
    return layout.columns[i].type.kind == kind && layout.columns[i].type.bytes == bytes;
  };
  return is(0, NumberType::Kind::Unsigned, 2) && is(1, NumberType::Kind::Unsigned, 2) &&
         is(2, NumberType::Kind::Signed, 8) && is(3, NumberType::Kind::Truth, 1);
}

void useOwnUnit(EventLayout& layout) {
  std::size_t count = 0;
  const ColumnNumbers times = headOf(std::span(&layout.columns[2], 1), layout.rows, count)[0];
  if (layout.unit_ns != 1000 || !areOwnTimes_ns(times, count)) return;
  layout.unit_ns = 1;
  layout.guess =
      "The unit of time is not stated; the types of the fields are those of Evical's records, whose times "
      "are "
      "in ns. If this is wrong, rename the times to t_us or t_s.";
}

class ArrayLayoutFinder {
 public:
  explicit ArrayLayoutFinder(const std::vector<Array>& arrays) : arrays_(arrays) {}

  FoundArrays run() {
    for (const Array& array : arrays_) {
      if (array.header.isStructured()) {
        addStructured(array);
      } else if (const NamedPart part = partNamed(array.name); part.part != Part::None) {
        groups_[part.group][part.part].push_back({&array, part});
      }
    }
    for (auto& [name, group] : groups_) addGroup(name, group);
    for (const Array& array : arrays_)
      if (!used_.contains(&array)) addTable(array);
    for (const Array& array : arrays_)
      if (!used_.contains(&array)) found_.others.push_back(&array);
    if (found_.events.size() == 1) found_.events.front().name = "events";
    return std::move(found_);
  }

 private:
  struct Candidate {
    const Array* array;
    NamedPart part;
  };
  using Group = std::map<Part, std::vector<Candidate>>;

  void add(EventLayout layout, const std::string& name, std::string message) {
    layout.name = name.empty() ? "events" : name;
    layout.message = std::move(message);
    found_.events.push_back(std::move(layout));
  }

  void addStructured(const Array& array) {
    if (array.header.objects) return;
    std::array<Numbers, 4> numbers;
    std::array<bool, 4> has{};
    std::optional<std::int64_t> unit_ns;
    std::string names;
    const auto take = [&](std::size_t i, const Field& field, std::size_t index) {
      if (std::exchange(has[i], true)) return;
      Field part = field;
      part.offset += index * static_cast<std::size_t>(field.type->bytes);
      numbers[i] = numbersOf(array, part, array.header.elements());
      countRows(array, numbers[i]);
      if (index == 0) names += (names.empty() ? "" : ", ") + field.name;
    };
    for (const Field& field : array.header.fields) {
      if (!field.type) continue;
      const NamedPart part = partNamed(field.name);
      if (part.part == Part::Xy && field.count == 2) take(0, field, 0), take(1, field, 1);
      if (field.count != 1) continue;
      if (part.part == Part::X) take(0, field, 0);
      if (part.part == Part::Y) take(1, field, 0);
      if (part.part == Part::Time) take(2, field, 0), unit_ns = part.unit_ns;
      if (part.part == Part::Polarity) take(3, field, 0);
    }
    if (!has[0] || !has[1] || !has[2] || !has[3]) return;
    used_.insert(&array);
    EventLayout layout = layoutOf(numbers, unit_ns);
    if (names == "t, x, y, p" && hasOwnTypes(layout)) useOwnUnit(layout);
    add(std::move(layout), array.name, "fields " + names);
  }

  // Selects, among several arrays for a part, the one with the same length as the others, otherwise the one
  // with the usual name.
  static const Candidate* chosen(const Group& group, Part part, std::uint64_t rows) {
    const auto found = group.find(part);
    if (found == group.end()) return nullptr;
    const Candidate* best = nullptr;
    const auto fits = [rows](const Candidate& candidate) {
      return candidate.array->header.elements() == rows;
    };
    for (const Candidate& candidate : found->second) {
      if (!listOf(*candidate.array)) continue;
      const bool better = !best || (fits(candidate) && !fits(*best)) ||
                          (fits(candidate) == fits(*best) && candidate.part.rank < best->part.rank);
      if (better) best = &candidate;
    }
    return best;
  }

  void addGroup(const std::string& name, const Group& group) {
    std::array<std::optional<Numbers>, 4> numbers;
    std::vector<const Array*> sources;
    takeMatrix(group, Part::Xyp, 3, numbers, sources);
    if (!numbers[0]) takeMatrix(group, Part::Xy, 2, numbers, sources);
    std::optional<std::int64_t> unit_ns;
    constexpr std::pair<std::size_t, Part> kParts[] = {
        {0, Part::X}, {1, Part::Y}, {3, Part::Polarity}, {2, Part::Time}};
    for (const auto& [i, part] : kParts) {
      if (numbers[i] && i != 3) continue;
      const Candidate* candidate = chosen(group, part, numbers[0] ? numbers[0]->claimed : 0);
      if (!candidate || numbers[i]) continue;
      numbers[i] = listOf(*candidate->array);
      sources.push_back(candidate->array);
      if (part == Part::Time) unit_ns = candidate->part.unit_ns;
    }
    const auto count =
        std::count_if(numbers.begin(), numbers.end(), [](const auto& part) { return part.has_value(); });
    if (count == 3) noteMissing(name, numbers);
    if (count < 4) return;
    used_.insert(sources.begin(), sources.end());
    EventLayout layout = layoutOf({*numbers[0], *numbers[1], *numbers[2], *numbers[3]}, unit_ns);
    takeExtras(group, layout);
    if (!name.empty() && groups_.contains("")) takeExtras(groups_.at(""), layout);
    std::string names;
    for (const Array* source : sources) names += (names.empty() ? "" : ", ") + source->name;
    add(std::move(layout), name, "arrays " + names);
  }

  static void takeMatrix(const Group& group, Part part, std::size_t columns,
                         std::array<std::optional<Numbers>, 4>& numbers, std::vector<const Array*>& sources) {
    const auto found = group.find(part);
    if (found == group.end()) return;
    const Array& array = *found->second.front().array;
    const std::vector<Numbers> parts = columnsOf(array, columns);
    if (parts.empty()) return;
    numbers[0] = parts[0];
    numbers[1] = parts[1];
    if (columns == 3) numbers[3] = parts[2];
    sources.push_back(&array);
  }

  void takeExtras(const Group& group, EventLayout& layout) {
    const auto scalar = [&](Part part) -> std::int64_t {
      const auto found = group.find(part);
      if (found == group.end()) return 0;
      used_.insert(found->second.front().array);
      return scalarOf(*found->second.front().array).value_or(0);
    };
    std::int64_t offset_ns = 0;
    if (!__builtin_mul_overflow(scalar(Part::TimeOffset), layout.unit_ns, &offset_ns) && offset_ns != 0 &&
        isTime(offset_ns))
      layout.offset_ns = offset_ns;
    const std::int64_t width = scalar(Part::Width), height = scalar(Part::Height);
    const auto isSide = [](std::int64_t side) { return side >= 1 && side <= kLargestSide_px; };
    if (isSide(width) && isSide(height)) layout.size_px = {static_cast<int>(width), static_cast<int>(height)};
  }

  void noteMissing(const std::string& name, const std::array<std::optional<Numbers>, 4>& numbers) {
    constexpr const char* kNames[] = {"x", "y", "t", "p"};
    std::string there, missing;
    for (std::size_t i = 0; i < 4; ++i) {
      if (!numbers[i]) missing = kNames[i];
      if (numbers[i]) there += (there.empty() ? "" : ", ") + numbers[i]->column.array;
    }
    found_.problems.push_back(
        fmt::format("{}{} are not events without {}.", name.empty() ? "" : name + ": ", there, missing));
  }

  // Four columns, identified by their numbers.
  void addTable(const Array& array) {
    const std::vector<Numbers> numbers = columnsOf(array, 4);
    if (numbers.empty()) return;
    std::vector<Column> columns;
    std::uint64_t rows = std::numeric_limits<std::uint64_t>::max();
    for (const Numbers& part : numbers) {
      columns.push_back(part.column);
      rows = std::min(rows, part.rows);
    }
    std::size_t count = 0;
    const std::vector<ColumnNumbers> heads = headOf(columns, rows, count);
    if (count < (arrays_.size() == 1 ? 1 : kFewestRows)) return;
    const std::optional<EventColumns> order = guessEventColumns(heads);
    if (!order) return;
    used_.insert(&array);
    EventLayout layout = layoutOf(
        {numbers[order->x], numbers[order->y], numbers[order->time], numbers[order->polarity]}, std::nullopt);
    std::array<char, 4> letters{};
    letters[order->x] = 'x';
    letters[order->y] = 'y';
    letters[order->time] = 't';
    letters[order->polarity] = 'p';
    const std::string text = fmt::format("{}", fmt::join(letters, ","));
    const char* unit = timeUnitName(layout.unit_ns);
    layout.guess.clear();
    if (text != "t,x,y,p" || layout.unit_ns != 1'000'000'000)
      layout.guess = fmt::format(
          "The columns of {} are interpreted as {}, t in {}. If this is wrong, save them as arrays x, y, "
          "t_{}, p with numpy.savez.",
          array.name, text, unit, unit);
    add(std::move(layout), array.name, "columns " + text);
  }

  const std::vector<Array>& arrays_;
  std::map<std::string, Group> groups_;
  std::set<const Array*> used_;
  FoundArrays found_;
};

}  // namespace

FoundArrays findEvents(const std::vector<Array>& arrays) {
  return ArrayLayoutFinder(arrays).run();
}

bool nameEvents(const std::vector<std::string>& arrays) {
  std::map<std::string, std::set<Part>> groups;
  for (const std::string& name : arrays) {
    const NamedPart part = partNamed(name);
    groups[part.group].insert(part.part);
  }
  return std::any_of(groups.begin(), groups.end(), [](const auto& entry) {
    const std::set<Part>& has = entry.second;
    const bool place =
        has.contains(Part::Xyp) || has.contains(Part::Xy) || (has.contains(Part::X) && has.contains(Part::Y));
    return place && has.contains(Part::Time) && (has.contains(Part::Xyp) || has.contains(Part::Polarity));
  });
}

}  // namespace evical::numpy

namespace evical::numpy {
namespace {

struct Spelling {
  std::string_view name;
  Part part;
};
constexpr Spelling kSpellings[] = {
    {"x", Part::X},
    {"xs", Part::X},
    {"x_pos", Part::X},  // N-ImageNet
    {"x_px", Part::X},
    {"x_coords", Part::X},
    {"y", Part::Y},
    {"ys", Part::Y},
    {"y_pos", Part::Y},
    {"y_px", Part::Y},
    {"y_coords", Part::Y},
    {"t", Part::Time},
    {"ts", Part::Time},
    {"timestamp", Part::Time},  // dv
    {"timestamps", Part::Time},
    {"time", Part::Time},
    {"times", Part::Time},
    {"stamp", Part::Time},
    {"stamps", Part::Time},
    {"p", Part::Polarity},
    {"ps", Part::Polarity},
    {"pol", Part::Polarity},
    {"pols", Part::Polarity},
    {"polarity", Part::Polarity},
    {"polarities", Part::Polarity},
    {"on", Part::Polarity},  // Event Stream
    {"xy", Part::Xy},        // EVIMO2
    {"xyp", Part::Xyp},
    {"t_offset", Part::TimeOffset},  // DSEC
    {"width", Part::Width},
    {"height", Part::Height},
};

bool takePart(std::string_view name, NamedPart& found) {
  const auto spelling = std::find_if(std::begin(kSpellings), std::end(kSpellings),
                                     [&](const Spelling& candidate) { return candidate.name == name; });
  if (spelling == std::end(kSpellings)) return false;
  found.part = spelling->part;
  found.rank = static_cast<std::size_t>(spelling - std::begin(kSpellings));
  return true;
}

// The whole name, or the part after one of its separators; the longest first.
bool takeName(std::string_view name, NamedPart& found) {
  if (takePart(name, found)) return true;
  for (std::size_t at = name.find_first_of("/_.- "); at != std::string_view::npos;
       at = name.find_first_of("/_.- ", at + 1)) {
    if (!takePart(name.substr(at + 1), found)) continue;
    found.group = name.substr(0, at);
    return true;
  }
  return false;
}

}  // namespace

NamedPart partNamed(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  NamedPart found;
  if (const std::optional<std::int64_t> unit_ns = timeUnitOf(lower)) {
    std::string_view stem = std::string_view(lower).substr(0, lower.find_last_of("[(_ "));
    while (stem.ends_with(' ') || stem.ends_with('_')) stem.remove_suffix(1);
    if (takeName(stem, found) && found.part == Part::Time) {
      found.unit_ns = unit_ns;
      return found;
    }
    found = {};
  }
  takeName(lower, found);
  return found;
}

}  // namespace evical::numpy
