#include "core/recording/pictures/picture_lists.h"

#include "core/base/plain_text.h"
#include "core/base/time.h"
#include "core/recording/pictures/picture_names.h"
#include "core/recording/pictures/picture_times.h"
#include "core/recording/text/text_table_reader.h"

#include <fmt/format.h>

#include <optional>
#include <system_error>
#include <utility>

namespace evical::pictures {
namespace {

namespace fs = std::filesystem;

constexpr int kMicroseconds = 3, kNanoseconds = 0, kSeconds = 9;  // digits of a unit in ns
constexpr std::int64_t kShortestInterval_ns = 100'000;            // of a frame camera

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

void addEurocCamera(const fs::path& folder, PictureFolder& found) {
  if (!isFile(folder / "data.csv") || !isFolder(folder / "data")) return;
  PictureList list = newList(folderName(folder), "EuRoC", folder / "data");
  readNamedTimes(folder / "data.csv", kNanoseconds, list);
  found.lists.push_back(std::move(list));
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
  PictureList list = newList(side + "/" + kind, "DSEC", camera / kind);
  const std::string ending = "exposure_timestamps_" + side + ".txt";
  std::optional<fs::path> exposures = findEndingWith({camera, images, root}, ending);
  if (!exposures && isFile(camera / "exposure_timestamps.txt"))
    exposures = camera / "exposure_timestamps.txt";
  const std::optional<fs::path> times = findEndingWith({images, root}, "image_timestamps.txt");
  const fs::path plain = images / "timestamps.txt";
  if (exposures) {
    pairWithTimes(readTimes(*exposures, kMicroseconds, true, list), true, list);
  } else if (times || isFile(plain)) {
    pairWithTimes(readTimes(times.value_or(plain), kMicroseconds, false, list), false, list);
  } else {
    return std::nullopt;
  }
  return list;
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

void numberPictures(PictureList& list) {
  list.timed = false;
  for (std::size_t i = 0; i < list.pictures.size(); ++i)
    list.pictures[i].time_ns = static_cast<std::int64_t>(i) * 1'000'000'000;
  addFault(list, FaultKind::Guess,
           "The pictures have no times, and are numbered 1 s apart: they determine intrinsics only. For "
           "more, name the files by their times in ns (12 digits or more), or add a data.csv as in EuRoC.");
}

// Names that other programs than Kalibr use.
void correctMicroseconds(PictureList& list) {
  const std::vector<Picture>& all = list.pictures;
  if (all.size() < 2) return;
  const std::int64_t span_ns = all.back().time_ns - all.front().time_ns;
  const bool too_fast = span_ns / static_cast<std::int64_t>(all.size() - 1) < kShortestInterval_ns;
  if (!too_fast || all.back().time_ns > kLatestTime_ns / 1000) return;
  for (Picture& picture : list.pictures) picture.time_ns *= 1000;
  addFault(list, FaultKind::Guess, "The names of the pictures are interpreted as times in us, not in ns.");
}

// Names that are times, otherwise only an order.
std::optional<PictureList> listByNames(const fs::path& folder, const std::string& name) {
  PictureList list = newList(name, "Kalibr", folder);
  std::vector<std::string> names = pictureNames(folder), others;
  if (names.empty()) return std::nullopt;
  for (const std::string& each : names) {
    if (const auto time_ns = timeInName(each))
      list.pictures.push_back({*time_ns, 0.0, each});
    else
      others.push_back(each);
  }
  if (list.pictures.size() >= others.size()) {
    for (const std::string& other : others)
      addFault(list, FaultKind::Untimed,
               fmt::format("The name of {} is not a time in ns; it is left out.", other));
    correctMicroseconds(list);
    return list;
  }
  list.layout = "pictures";
  list.pictures.clear();
  for (std::string& each : names) list.pictures.push_back({0, 0.0, std::move(each)});
  numberPictures(list);
  return list;
}

PictureFolder findByNames(const fs::path& folder) {
  PictureFolder found;
  if (auto list = listByNames(folder, "pictures")) {
    found.lists.push_back(std::move(*list));
    return found;
  }
  for (const std::string& name : folderNames(folder))
    if (auto list = listByNames(folder / name, visible(name))) found.lists.push_back(std::move(*list));
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
    PictureList list = newList(side + "_images", "TUM-VIE", camera);
    pairWithTimes(readTimes(*times, kMicroseconds, false, list), false, list);
    const auto exposures = findEndingWith({camera, folder}, "image_exposures_" + side + ".txt");
    if (exposures) readExposures(*exposures, list);
    found.lists.push_back(std::move(list));
  }
  return found;
}

PictureFolder findRpgPictures(const fs::path& folder) {
  PictureFolder found;
  if (!isFile(folder / "images.txt")) return found;
  PictureList list = newList("images", "RPG", folder);
  readNamedTimes(folder / "images.txt", kSeconds, list);
  found.lists.push_back(std::move(list));
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
