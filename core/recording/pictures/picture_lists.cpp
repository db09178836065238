#include "core/recording/pictures/picture_lists.h"

#include "core/base/plain_text.h"
#include "core/base/time.h"
#include "core/recording/pictures/picture_names.h"
#include "core/recording/pictures/picture_times.h"
#include "core/recording/plausible_times.h"
#include "core/recording/text/text_table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

namespace evical::pictures {
namespace {

namespace fs = std::filesystem;

constexpr int kMicroseconds = 3, kNanoseconds = 0, kSeconds = 9;  // digits of a unit in ns

std::vector<PictureList> listPictures(const fs::path& folder, const std::string& name);

bool isFile(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}
bool isFolder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

PictureList newList(std::string name, const char* layout, fs::path folder) {
  PictureList list;
  list.name = std::move(name);
  list.layout = layout;
  list.folder = std::move(folder);
  return list;
}

std::string folderName(const fs::path& folder) {
  const fs::path plain = folder.filename().empty() ? folder.parent_path() : folder;
  const std::string name = visible(plain.filename().string());
  return name.empty() || name == "." || name == ".." ? "pictures" : name;
}

std::vector<std::int64_t> timesOf(const PictureList& list) {
  std::vector<std::int64_t> times_ns;
  for (const Picture& picture : list.pictures) times_ns.push_back(picture.time_ns);
  return times_ns;
}

bool hasPlausibleTimes(const PictureList& list) {
  constexpr std::size_t kFewest = 6;  // fewer may be anything
  return list.pictures.size() < kFewest || areTimesOfPictures(timesOf(list));
}

void numberPictures(PictureList& list, const std::string& why) {
  list.timed = false;
  for (std::size_t i = 0; i < list.pictures.size(); ++i)
    list.pictures[i].time_ns = static_cast<std::int64_t>(i) * kSecond_ns;
  addFault(
      list, FaultKind::Guess,
      why +
          ", and are numbered 1 s apart: they determine intrinsics only. For "
          "more, name the files by their times in ns (12 digits or more), or add a data.csv as in EuRoC.");
}

// The times of the names; false if these are only a count.
bool takeTimesOfNames(PictureList& list) {
  std::vector<std::string> names;
  for (const Picture& picture : list.pictures) names.push_back(picture.name);
  const TimesInNames found = timesInNames(names);
  if (found.times_ns.empty()) return false;
  if (!found.note.empty()) addFault(list, FaultKind::Guess, found.note);
  std::vector<Picture> timed;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (found.times_ns[i])
      timed.push_back({*found.times_ns[i], 0.0, names[i]});
    else
      addFault(list, FaultKind::Untimed,
               fmt::format("The name of {} is not a time; it is left out.", names[i]));
  }
  list.pictures = std::move(timed);
  return true;
}

// A list with the times of a table in their usual unit; if that cannot be, in the unit that gives a rate of
// cameras, or by the names, or without times.
template <class Build>
PictureList withPlausibleTimes(int usual_digits, const std::string& table, const Build& build) {
  PictureList list = build(usual_digits);
  if (hasPlausibleTimes(list)) return list;
  const auto nameOf = [](int digits) {
    return digits == 9 ? "s" : digits == 6 ? "ms" : digits == 3 ? "us" : "ns";
  };
  for (const int digits : {9, 6, 3, 0}) {
    if (digits == usual_digits) continue;
    PictureList other = build(digits);
    if (other.pictures.size() != list.pictures.size() || !hasPlausibleTimes(other)) continue;
    addFault(other, FaultKind::Guess,
             fmt::format("The times in {} are read as {}: in {}, no camera takes pictures at this rate.",
                         table, nameOf(digits), nameOf(usual_digits)));
    return other;
  }
  if (takeTimesOfNames(list)) {
    addFault(list, FaultKind::Guess,
             fmt::format("The times in {} cannot be true in any unit; those in the names are used.", table));
  } else {
    numberPictures(list, fmt::format("The pictures have times in {} that cannot be true in any unit", table));
  }
  return list;
}

// Without data.csv the names may be the times.
void addEurocCamera(const fs::path& folder, PictureFolder& found) {
  if (!isFolder(folder / "data")) return;
  const fs::path table = folder / "data.csv";
  if (!isFile(table)) {
    const std::string name = folderName(folder);
    if (!name.starts_with("cam") && !name.starts_with("image")) return;
    for (PictureList& list : listPictures(folder / "data", name)) found.lists.push_back(std::move(list));
    return;
  }
  found.lists.push_back(withPlausibleTimes(kNanoseconds, table.filename().string(), [&](int digits) {
    PictureList list = newList(folderName(folder), "EuRoC", folder / "data");
    readNamedTimes(table, digits, list);
    return list;
  }));
}

void addImuTable(const std::string& name, const fs::path& file, PictureFolder& found) {
  if (isFile(file) && isTextTable(file)) found.imus.push_back({visible(name), file});
}

PictureFolder findEuroc(const fs::path& folder) {
  PictureFolder found;
  addEurocCamera(folder, found);
  if (!found.lists.empty()) return found;
  for (const std::string& name : folderNames(folder)) {
    const fs::path part = folder / name;
    addEurocCamera(part, found);
    if (name.starts_with("imu")) addImuTable(name, part / "data.csv", found);
  }
  return found;
}

// The first file in the folders with this end of its name: the data set's sequences prepend their names.
std::optional<fs::path> findEndingWith(const std::vector<fs::path>& folders, const std::string& ending) {
  for (const fs::path& folder : folders) {
    std::error_code error;
    fs::directory_iterator entry(folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
      const std::string name = entry->path().filename().string();
      const bool ends = name == ending || name.ends_with("_" + ending);
      if (ends && isFile(entry->path())) return entry->path();
    }
  }
  return std::nullopt;
}

// images/left/rectified; begins and ends of exposures, or the times that both cameras share.
std::optional<PictureList> dsecCamera(const fs::path& root, const fs::path& images, const std::string& side,
                                      const std::string& kind) {
  const fs::path camera = images / side;
  const std::string ending = "exposure_timestamps_" + side + ".txt";
  std::optional<fs::path> exposures = findEndingWith({camera, images, root}, ending);
  if (!exposures && isFile(camera / "exposure_timestamps.txt"))
    exposures = camera / "exposure_timestamps.txt";
  const std::optional<fs::path> times = findEndingWith({images, root}, "image_timestamps.txt");
  const fs::path plain = images / "timestamps.txt";
  if (!exposures && !times && !isFile(plain)) return std::nullopt;
  const fs::path table = exposures ? *exposures : times.value_or(plain);
  return withPlausibleTimes(kMicroseconds, table.filename().string(), [&](int digits) {
    PictureList list = newList(side + "/" + kind, "DSEC", camera / kind);
    pairWithTimes(readTimes(table, digits, exposures.has_value(), list), exposures.has_value(), list);
    return list;
  });
}

PictureFolder findDsec(const fs::path& folder) {
  PictureFolder found;
  const fs::path images = isFolder(folder / "images") ? folder / "images" : folder;
  for (const char* side : {"left", "right"}) {
    for (const char* kind : {"rectified", "distorted"}) {
      if (!isFolder(images / side / kind)) continue;
      if (auto list = dsecCamera(folder, images, side, kind)) found.lists.push_back(std::move(*list));
    }
    const fs::path events = folder / "events" / side / "events.h5";
    if (isFile(events)) found.events.push_back({std::string("events/") + side, events});
  }
  return found;
}

// Names that are times, otherwise only an order.
PictureList listByNames(const fs::path& folder, const std::string& name, std::vector<std::string> names) {
  PictureList list = newList(name, "Kalibr", folder);
  for (std::string& each : names) list.pictures.push_back({0, 0.0, std::move(each)});
  if (takeTimesOfNames(list)) return list;
  list.layout = "pictures";
  numberPictures(list, "The pictures have no times");
  return list;
}

// A table of times for the pictures of a folder, in this folder or the one above.
std::optional<fs::path> findTable(const fs::path& folder) {
  const fs::path above = folder.parent_path();
  for (const char* name :
       {"data.csv", "times.txt", "timestamps.txt", "times.csv", "timestamps.csv", "images.txt"})
    if (isFile(folder / name)) return folder / name;
  for (const std::string& name :
       {folderName(folder) + ".txt", std::string("times.txt"), std::string("timestamps.txt")})
    if (isFile(above / name)) return above / name;
  return std::nullopt;
}

// Names that differ only by a word are of several cameras if these have the same numbers: left00.png,
// right00.png.
std::vector<std::vector<std::string>> byCamera(const std::vector<std::string>& names) {
  constexpr std::size_t kMaxCameras = 8;
  std::map<std::string, std::vector<std::string>> groups;
  std::map<std::string, std::set<std::string>> numbers;
  for (const std::string& name : names) {
    const NumberInName number = numberInName(name);
    groups[number.rest].push_back(name);
    numbers[number.rest].insert(fmt::format("{}.{}", number.whole, number.fraction));
  }
  const bool alike = std::ranges::all_of(
      numbers, [&](const auto& group) { return group.second == numbers.begin()->second; });
  if (!alike || groups.size() < 2 || groups.size() > kMaxCameras || numbers.begin()->second.size() < 2)
    return {names};
  std::vector<std::vector<std::string>> cameras;
  for (auto& [word, own] : groups) cameras.push_back(std::move(own));
  return cameras;
}

// "left" of "left_0012.png".
std::string cameraWord(const std::string& name) {
  std::string word = numberInName(name).rest;
  const auto isSeparator = [](char c) { return c == '_' || c == '-' || c == '.' || c == ' '; };
  while (!word.empty() && isSeparator(word.back())) word.pop_back();
  while (!word.empty() && isSeparator(word.front())) word.erase(0, 1);
  return word.empty() ? "other" : word;
}

// The pictures of a folder, one list for each camera; with the times of a table, if there is one, or of their
// names.
std::vector<PictureList> listPictures(const fs::path& folder, const std::string& name) {
  const std::vector<std::string> names = pictureNames(folder);
  if (names.empty()) return {};
  if (const std::optional<fs::path> table = findTable(folder)) {
    const std::string file = table->filename().string();
    PictureList list = withPlausibleTimes(
        usualDigits(*table, file == "data.csv" ? kNanoseconds : kSeconds), file, [&](int digits) {
          PictureList timed = newList(name, file == "data.csv" ? "EuRoC" : "table of times", folder);
          readAnyTimes(*table, digits, timed);
          return timed;
        });
    if (!list.pictures.empty()) return {std::move(list)};
  }
  std::vector<PictureList> lists;
  for (const std::vector<std::string>& camera : byCamera(names)) {
    const std::string word = cameraWord(camera.front());
    const bool alone = camera.size() == names.size();
    lists.push_back(listByNames(folder,
                                alone                ? name
                                : name == "pictures" ? word
                                                     : name + "/" + word,
                                camera));
  }
  return lists;
}

PictureFolder findByNames(const fs::path& folder) {
  PictureFolder found;
  found.lists = listPictures(folder, "pictures");
  if (!found.lists.empty()) return found;
  for (const std::string& name : folderNames(folder))
    for (PictureList& list : listPictures(folder / name, visible(name)))
      found.lists.push_back(std::move(list));
  for (int i = 0; i < 10 && !found.lists.empty(); ++i) {
    const std::string name = fmt::format("imu{}", i);
    addImuTable(name, folder / (name + ".csv"), found);
  }
  return found;
}

}  // namespace

PictureFolder findTumViePictures(const fs::path& folder) {
  PictureFolder found;
  for (const std::string side : {"left", "right"}) {
    const fs::path camera = folder / (side + "_images");
    const auto times = findEndingWith({camera, folder}, "image_timestamps_" + side + ".txt");
    if (!isFolder(camera) || !times) continue;
    PictureList list = withPlausibleTimes(kMicroseconds, times->filename().string(), [&](int digits) {
      PictureList timed = newList(side + "_images", "TUM-VIE", camera);
      pairWithTimes(readTimes(*times, digits, false, timed), false, timed);
      return timed;
    });
    const auto exposures = findEndingWith({camera, folder}, "image_exposures_" + side + ".txt");
    if (exposures) readExposures(*exposures, list);
    found.lists.push_back(std::move(list));
  }
  return found;
}

PictureFolder findRpgPictures(const fs::path& folder) {
  PictureFolder found;
  if (!isFile(folder / "images.txt")) return found;
  found.lists.push_back(withPlausibleTimes(kSeconds, "images.txt", [&](int digits) {
    PictureList list = newList("images", "RPG", folder);
    readNamedTimes(folder / "images.txt", digits, list);
    return list;
  }));
  return found;
}

PictureFolder findPictures(const fs::path& folder) {
  PictureFolder found = findEuroc(folder);
  if (found.lists.empty()) found = findEuroc(folder / "mav0");
  if (found.lists.empty()) found = findDsec(folder);
  if (found.lists.empty()) found = findTumViePictures(folder);
  if (found.lists.empty()) found = findRpgPictures(folder);
  if (found.lists.empty()) found = findByNames(folder);
  return found;
}

}  // namespace evical::pictures
