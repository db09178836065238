#include "core/recording/pictures/picture_names.h"

#include "core/base/time.h"
#include "core/recording/plausible_times.h"
#include "core/recording/text/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <system_error>

namespace evical::pictures {
namespace {

constexpr std::string_view kExtensions[] = {".png", ".jpg", ".jpeg", ".pgm", ".ppm",
                                            ".pnm", ".tif", ".tiff", ".bmp"};
constexpr std::size_t kFewestTimeDigits = 12;

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

// The leading digits, without zeros before them, and the rest.
std::string_view takeNumber(std::string_view& text) {
  std::size_t end = 0;
  while (end < text.size() && isDigit(text[end])) ++end;
  std::string_view digits = text.substr(0, end);
  while (digits.starts_with('0')) digits.remove_prefix(1);
  text.remove_prefix(end);
  return digits;
}

template <class Wanted>
std::vector<std::string> namesIn(const std::filesystem::path& folder, const Wanted& isWanted) {
  std::vector<std::string> names;
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    std::string name = entry->path().filename().string();
    if (!name.starts_with('.') && isWanted(*entry)) names.push_back(std::move(name));
  }
  std::sort(names.begin(), names.end(), naturallyBefore);
  return names;
}

std::size_t endOfDigits(std::string_view text, std::size_t from) {
  while (from < text.size() && isDigit(text[from])) ++from;
  return from;
}

// "20240506_070809123", "2024-05-06-07-08-09": from the first four digits on.
std::optional<std::int64_t> dateInName(std::string_view name) {
  constexpr std::size_t kYear = 4, kToSeconds = 14, kLongest = kToSeconds + 9;
  const std::string_view stem = name.substr(0, name.rfind('.'));
  std::string digits;
  for (std::size_t at = 0; at < stem.size();) {
    const std::size_t end = endOfDigits(stem, at);
    if (!digits.empty() || end - at >= kYear) digits += stem.substr(at, end - at);
    at = std::max(end, at + 1);
  }
  const bool century = digits.starts_with("19") || digits.starts_with("20");
  if (!century || digits.size() < kToSeconds || digits.size() > kLongest) return std::nullopt;
  const auto part = [&](std::size_t from) { return digits.substr(from, 2); };
  std::int64_t time_ns = 0;
  const bool good = parseDate(fmt::format("{}-{}-{}T{}:{}:{}.{}Z", digits.substr(0, kYear), part(4), part(6),
                                          part(8), part(10), part(12), digits.substr(kToSeconds) + "0"),
                              time_ns);
  return good ? std::optional(time_ns) : std::nullopt;
}

// Digits of the fractions of seconds after '_': "1700000000_050000000", also without their leading zeros.
int fractionDigits(const std::vector<std::string>& names) {
  std::size_t longest = 0;
  for (const std::string& name : names) longest = std::max(longest, numberInName(name).fraction.size());
  return longest <= 3 ? 3 : longest <= 6 ? 6 : 9;
}

// "1700000000.050000", "1700000000_050000000".
std::optional<std::int64_t> secondsInName(std::string_view name, int digits) {
  constexpr std::size_t kEpochDigits = 10, kFewestDecimals = 6;
  const NumberInName number = numberInName(name);
  const bool decimal = number.separator == '.';
  const bool epoch = number.whole.size() == kEpochDigits;
  if (number.fraction.empty() || number.fraction.size() > 9) return std::nullopt;
  if (!epoch && !(decimal && number.fraction.size() >= kFewestDecimals)) return std::nullopt;
  std::int64_t whole_ns = 0, fraction_ns = 0;
  if (decimal) {
    const bool good = parseSeconds(fmt::format("{}.{}", number.whole, number.fraction), whole_ns);
    return good ? std::optional(whole_ns) : std::nullopt;
  }
  if (!parseSeconds(number.whole, whole_ns) || !parseTime(number.fraction, 9 - digits, fraction_ns))
    return std::nullopt;
  return fraction_ns < kSecond_ns ? std::optional(whole_ns + fraction_ns) : std::nullopt;
}

// Units of whole numbers in names, in the order of preference. Short numbers are a count, not ms or s.
struct NameUnit {
  const char* name;
  int digits;  // of the unit in ns
  std::size_t fewest_digits, max_digits;
};
constexpr NameUnit kNameUnits[] = {
    {"ns", 0, kFewestTimeDigits, 19}, {"us", 3, kFewestTimeDigits, 16}, {"ms", 6, 13, 13}, {"s", 9, 10, 10}};

std::optional<std::int64_t> unitsInName(std::string_view name, const NameUnit& unit) {
  const NumberInName number = numberInName(name);
  std::string_view significant = number.whole;
  const bool sized = significant.size() >= unit.fewest_digits;
  while (significant.starts_with('0')) significant.remove_prefix(1);
  const bool is_epoch = unit.digits < 6 || significant.size() == unit.fewest_digits;
  std::int64_t time_ns = 0;
  const bool good = number.fraction.empty() && sized && is_epoch && significant.size() <= unit.max_digits &&
                    parseTime(number.whole, unit.digits, time_ns) && isTime(time_ns);
  return good ? std::optional(time_ns) : std::nullopt;
}

// Most names have a time, and the times a rate of cameras.
bool isPlausible(const std::vector<std::optional<std::int64_t>>& times) {
  std::vector<std::int64_t> known_ns;
  for (const auto& time_ns : times)
    if (time_ns) known_ns.push_back(*time_ns);
  if (known_ns.empty() || 2 * known_ns.size() < times.size()) return false;
  return areTimesOfPictures(std::move(known_ns));
}

}  // namespace

bool isPictureName(const std::filesystem::path& name) {
  std::string extension = name.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return std::find(std::begin(kExtensions), std::end(kExtensions), extension) != std::end(kExtensions);
}

bool naturallyBefore(std::string_view a, std::string_view b) {
  std::string_view rest_a = a, rest_b = b;
  while (!rest_a.empty() && !rest_b.empty()) {
    if (isDigit(rest_a.front()) && isDigit(rest_b.front())) {
      const std::string_view number_a = takeNumber(rest_a), number_b = takeNumber(rest_b);
      if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
      if (number_a != number_b) return number_a < number_b;
    } else {
      if (rest_a.front() != rest_b.front()) return rest_a.front() < rest_b.front();
      rest_a.remove_prefix(1);
      rest_b.remove_prefix(1);
    }
  }
  if (rest_a.size() != rest_b.size()) return rest_a.size() < rest_b.size();
  return a < b;
}

std::vector<std::string> pictureNames(const std::filesystem::path& folder) {
  return namesIn(folder, [](const std::filesystem::directory_entry& entry) {
    std::error_code ignored;
    return isPictureName(entry.path()) && entry.is_regular_file(ignored);
  });
}

std::vector<std::string> folderNames(const std::filesystem::path& folder) {
  return namesIn(folder, [](const std::filesystem::directory_entry& entry) {
    std::error_code ignored;
    return entry.is_directory(ignored);
  });
}

NumberInName numberInName(std::string_view name) {
  const std::string_view stem = name.substr(0, name.rfind('.'));
  std::size_t begin = 0, length = 0;
  for (std::size_t at = 0; at < stem.size();) {
    const std::size_t end = endOfDigits(stem, at);
    if (end - at > length) begin = at, length = end - at;
    at = std::max(end, at + 1);
  }
  // The fraction may be longer: "12.345678".
  std::size_t before = begin;
  if (begin > 1 && stem[begin - 1] == '.')
    while (before > 1 && isDigit(stem[before - 2])) --before;
  if (before < begin) {
    begin = before - 1;
    length = endOfDigits(stem, begin) - begin;
  }
  NumberInName number;
  number.whole = stem.substr(begin, length);
  std::size_t end = begin + length;
  if (end + 1 < stem.size() && (stem[end] == '.' || stem[end] == '_' || stem[end] == '-')) {
    const std::size_t last = endOfDigits(stem, end + 1);
    if (length > 0 && last > end + 1) {
      number.separator = stem[end];
      number.fraction = stem.substr(end + 1, last - end - 1);
      end = last;
    }
  }
  number.rest = std::string(stem.substr(0, begin)) + std::string(stem.substr(end));
  return number;
}

TimesInNames timesInNames(const std::vector<std::string>& names) {
  TimesInNames dates{{}, "The names of the pictures are interpreted as dates, in UTC."};
  for (const std::string& name : names) dates.times_ns.push_back(dateInName(name));
  if (isPlausible(dates.times_ns)) return dates;
  TimesInNames seconds;
  const int digits = fractionDigits(names);
  for (const std::string& name : names) seconds.times_ns.push_back(secondsInName(name, digits));
  if (isPlausible(seconds.times_ns)) return seconds;
  for (const NameUnit& unit : kNameUnits) {
    TimesInNames found;
    for (const std::string& name : names) found.times_ns.push_back(unitsInName(name, unit));
    if (!isPlausible(found.times_ns)) continue;
    if (unit.digits > 0)
      found.note =
          fmt::format("The names of the pictures are interpreted as times in {}, not in ns.", unit.name);
    return found;
  }
  return {};
}

bool staysInside(const std::filesystem::path& name) {
  const bool leaves = std::any_of(name.begin(), name.end(), [](const auto& part) { return part == ".."; });
  return !name.empty() && name.is_relative() && !leaves;
}

}  // namespace evical::pictures
