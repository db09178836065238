#include "core/recording/pictures/picture_names.h"

#include "core/base/time.h"

#include <algorithm>
#include <charconv>
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

bool isPictureName(const std::filesystem::path& name) {
  std::string extension = name.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return std::find(std::begin(kExtensions), std::end(kExtensions), extension) != std::end(kExtensions);
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

}  // namespace

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

std::optional<std::int64_t> timeInName(std::string_view name) {
  const std::string_view stem = name.substr(0, name.rfind('.'));
  std::int64_t time_ns = 0;
  if (stem.size() < kFewestTimeDigits || !std::all_of(stem.begin(), stem.end(), isDigit)) return std::nullopt;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), time_ns);
  if (error != std::errc() || !isTime(time_ns)) return std::nullopt;
  return time_ns;
}

bool staysInside(const std::filesystem::path& name) {
  const bool leaves = std::any_of(name.begin(), name.end(), [](const auto& part) { return part == ".."; });
  return !name.empty() && name.is_relative() && !leaves;
}

}  // namespace evical::pictures
