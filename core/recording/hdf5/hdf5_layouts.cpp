#include "core/recording/hdf5/hdf5_layouts.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/plain_text.h"
#include "core/data/recording.h"
#include "core/recording/column_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <unordered_map>

namespace evical::hdf5 {
namespace {

constexpr std::size_t kMaxNamedTables = 12;
constexpr const char* kNamedColumns =
    "Name the datasets in the session, as columns: \"t_us=DATASET,x=DATASET,y=DATASET,p=DATASET\" of a "
    "camera, or "
    "\"t_us=DATASET,gyro=DATASET,accel=DATASET\" of an IMU";

std::string withoutSlash(std::string folder) {
  if (!folder.empty()) folder.pop_back();
  return folder;
}

// A scalar, or the first few numbers of a list; empty if the dataset does not exist.
std::vector<std::int64_t> readNumbers(hid_t file, const std::string& path, std::size_t most) {
  const Handle dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) return {};
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  if (count < 1 || static_cast<std::size_t>(count) > most) return {};
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(count));
  if (H5Dread(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) < 0) return {};
  return numbers;
}

int readSide(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return 0;
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle space(H5Aget_space(attribute), H5Sclose);
  std::int64_t side = 0;
  if (H5Sget_simple_extent_npoints(space) != 1) return 0;
  if (H5Aread(attribute, H5T_NATIVE_INT64, &side) < 0 || side < 1 || side > kLargestSide_px) return 0;
  return static_cast<int>(side);
}

// A text attribute of fixed or variable length.
std::string readText(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return {};
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1) return {};
  if (H5Tis_variable_str(type) > 0) {
    char* text = nullptr;
    if (H5Aread(attribute, type, static_cast<void*>(&text)) < 0 || !text) return {};
    std::string copy(text);
    H5free_memory(text);
    return copy;
  }
  constexpr std::size_t kLongest = 1 << 16;
  if (H5Tget_size(type) > kLongest) return {};
  std::string text(H5Tget_size(type), '\0');
  if (H5Aread(attribute, type, text.data()) < 0) return {};
  return text.substr(0, text.find('\0'));
}

// "640x480"
Resolution parseGeometry(const std::string& text) {
  Resolution size_px;
  const char* end = text.data() + text.size();
  const auto [middle, error] = std::from_chars(text.data(), end, size_px.width_px);
  if (error != std::errc() || middle == end || *middle != 'x') return {};
  const auto last = std::from_chars(middle + 1, end, size_px.height_px);
  const bool good = last.ec == std::errc() && size_px.width_px > 0 && size_px.height_px > 0 &&
                    size_px.width_px <= kLargestSide_px && size_px.height_px <= kLargestSide_px;
  return good ? size_px : Resolution{};
}

// Names of the columns of events in one folder.
constexpr std::initializer_list<const char*> kXNames = {"x", "xs", "col", "cols", "x_pos"};
constexpr std::initializer_list<const char*> kYNames = {"y", "ys", "row", "rows", "y_pos"};
constexpr std::initializer_list<const char*> kTimeNames = {"t",    "ts",    "timestamp",
                                                           "time", "times", "timestamps"};
constexpr std::initializer_list<const char*> kPolarityNames = {"p",        "ps",         "pol",
                                                               "polarity", "polarities", "on"};

bool isOneOf(const std::string& name, std::initializer_list<const char*> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

class TableLayoutFinder {
 public:
  TableLayoutFinder(hid_t file, const std::string& place)
      : file_(file), place_(place), list_(listDatasets(file, place)), datasets_(list_.datasets) {
    for (const DatasetInfo& dataset : datasets_) by_path_[dataset.path] = &dataset;
  }

  FoundStreams run(const ColumnNames& names) {
    for (const auto& [stream, columns] : names) addNamed(stream, columns);
    for (const DatasetInfo& dataset : datasets_) {
      const std::size_t rank = dataset.extent.size();
      if (dataset.type_class == H5T_COMPOUND) addCompound(dataset);
      if (rank == 1) addColumns(dataset);
      if (rank == 2) addTable(dataset);
      if (rank >= 3) addFrames(dataset);
      if (isPartOfAStream(dataset)) incomplete_.insert(dataset.folder());
    }
    for (const std::string& path : list_.elsewhere)
      problems_.push_back(
          fmt::format("The content of {} is in another file, which is not opened; it is left out.", path));
    for (const std::string& path : list_.damaged)
      problems_.push_back(fmt::format("{} is damaged; its content is left out.", path));
    const auto isReadable = [](const FoundStream& stream) {
      return stream.events || stream.imu || stream.frames;
    };
    if (std::none_of(found_.begin(), found_.end(), isReadable)) failWithNames();
    // The session's columns replace those of a layout.
    const auto first_found = found_.begin() + static_cast<std::ptrdiff_t>(names.size());
    found_.erase(std::remove_if(first_found, found_.end(),
                                [&](const FoundStream& stream) { return names.contains(stream.info.name); }),
                 found_.end());
    for (const std::string& folder : incomplete_)
      problems_.push_back(fmt::format("{} has some of the datasets of a stream, but not all; it is left out.",
                                      folder.empty() ? "The root" : withoutSlash(folder)));
    return {std::move(found_), std::move(problems_)};
  }

 private:
  const DatasetInfo* find(const std::string& folder, std::initializer_list<const char*> names) const {
    for (const char* name : names) {
      const auto found = by_path_.find(folder + name);
      if (found != by_path_.end()) return found->second;
    }
    return nullptr;
  }

  // Only of a listed dataset: a path could lead through a link into another file.
  std::vector<std::int64_t> numbersAt(const std::string& path, std::size_t most) const {
    return by_path_.contains(path) ? readNumbers(file_, path, most) : std::vector<std::int64_t>{};
  }

  // True for a part of a stream without its other parts: damaged names do not match.
  bool isPartOfAStream(const DatasetInfo& dataset) const {
    const std::string folder = dataset.folder(), name = dataset.name();
    const auto has = [&](std::initializer_list<const char*> names) { return find(folder, names) ? 1 : 0; };
    if (name == "omega" || name == "accel") return has({"ts"}) + has({"omega"}) + has({"accel"}) < 3;
    const bool is_column = isOneOf(name, kXNames) || isOneOf(name, kYNames);
    const int columns = has(kXNames) + has(kYNames) + has(kTimeNames) + has(kPolarityNames);
    return is_column && columns == 3;
  }

  const DatasetInfo* findList(const std::string& folder, std::initializer_list<const char*> names) const {
    const DatasetInfo* dataset = find(folder, names);
    return dataset && dataset->extent.size() == 1 ? dataset : nullptr;
  }

  FoundStream& add(std::string name, StreamType type, std::string message) {
    StreamInfo info;
    info.name = name.empty() ? streamTypeName(type) : std::move(name);
    info.type = type;
    info.message = std::move(message);
    found_.push_back({info, nullptr, nullptr, nullptr});
    return found_.back();
  }

  const DatasetInfo& named(const std::string& path, std::size_t rank) const {
    const DatasetInfo* dataset = find("", {path.c_str() + (path.starts_with('/') ? 1 : 0)});
    if (!dataset || dataset->extent.size() != rank)
      throw badInput(
          place_,
          fmt::format("the session's columns name {}, which is not a {} in this file; its datasets: {}", path,
                      rank == 1 ? "list" : "table of three columns", datasetNames()),
          kNamedColumns);
    return *dataset;
  }

  void addNamed(const std::string& name, const std::string& columns) {
    std::map<std::string, std::string> paths;
    std::optional<std::int64_t> unit_ns;
    for (std::string_view rest = columns; !rest.empty();) {
      const std::size_t end = std::min(rest.find(','), rest.size());
      const std::string_view part = rest.substr(0, end);
      const std::size_t equals = std::min(part.find('='), part.size());
      std::string key(trimmed(part.substr(0, equals)));
      if (key.starts_with("t_")) unit_ns = timeUnitNamed(key.substr(2));
      if (unit_ns) key = key.starts_with("t_") ? "t" : key;
      paths[key] = trimmed(part.substr(std::min(equals + 1, part.size())));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    const auto has = [&](std::initializer_list<const char*> keys) {
      return std::all_of(keys.begin(), keys.end(), [&](const char* key) { return paths.contains(key); });
    };
    if (has({"t", "x", "y", "p"})) {
      FoundStream& stream = add(name, StreamType::Events, "named columns");
      stream.events = openColumns(
          file_, {named(paths["x"], 1), named(paths["y"], 1), named(paths["t"], 1), named(paths["p"], 1)}, 0,
          place_, unit_ns);
      finishEvents(named(paths["x"], 1).folder(), stream);
    } else if (has({"t", "gyro", "accel"})) {
      const DatasetInfo& times = named(paths["t"], 1);
      FoundStream& stream = add(name, StreamType::Imu, "named columns");
      stream.imu =
          openImuColumns(file_, times, named(paths["gyro"], 2), named(paths["accel"], 2), place_, unit_ns);
      finishImu(times, stream);
    } else {
      throw badInput(place_,
                     fmt::format("the columns \"{}\" of {} do not identify its datasets", columns, name),
                     kNamedColumns);
    }
  }

  // `dataset` may be the x of a camera's x, y, t, p, or the times of an IMU.
  void addColumns(const DatasetInfo& dataset) {
    const std::string folder = dataset.folder();
    if (dataset.name() == "ts") addImuColumns(dataset);
    if (!isOneOf(dataset.name(), kXNames)) return;
    const DatasetInfo* y = findList(folder, kYNames);
    const DatasetInfo* t = findList(folder, kTimeNames);
    const DatasetInfo* p = findList(folder, kPolarityNames);
    if (!y || !t || !p) return;
    // DSEC's offset belongs to its only camera.
    const bool is_dsec = folder == "events/";
    const std::vector<std::int64_t> offset_us =
        is_dsec ? numbersAt("t_offset", 1) : std::vector<std::int64_t>{};
    FoundStream& stream = add(withoutSlash(folder), StreamType::Events, "x, y, t, p");
    stream.events = openColumns(file_, {dataset, *y, *t, *p}, offset_us.empty() ? 0 : offset_us[0], place_);
    finishEvents(folder, stream);
  }

  void finishEvents(const std::string& folder, FoundStream& stream) {
    stream.info.messages = stream.events->rows();
    stream.info.time_unit_ns = stream.events->timeScale().unit_ns;
    Resolution& size_px = stream.info.resolution_px;
    const std::vector<std::int64_t> sides = numbersAt(folder + "calib/resolution", 2);
    const auto isSide = [](std::int64_t side) { return side >= 1 && side <= kLargestSide_px; };
    if (sides.size() == 2 && isSide(sides[0]) && isSide(sides[1])) {
      size_px = {static_cast<int>(sides[0]), static_cast<int>(sides[1])};
    }
    const std::string group_path = folder.empty() ? "/" : folder;
    const Handle group(H5Gopen2(file_, group_path.c_str(), H5P_DEFAULT), H5Gclose);
    if (!size_px.known() && group.valid()) size_px = {readSide(group, "width"), readSide(group, "height")};
    if (!size_px.known()) size_px = parseGeometry(readText(file_, "geometry"));
  }

  void addImuColumns(const DatasetInfo& times) {
    const std::string folder = times.folder();
    const DatasetInfo* rates = find(folder, {"omega"});
    const DatasetInfo* accelerations = find(folder, {"accel"});
    const auto isTriple = [](const DatasetInfo* dataset) {
      return dataset && dataset->extent.size() == 2 && dataset->extent[1] == 3;
    };
    if (!isTriple(rates) || !isTriple(accelerations)) return;
    FoundStream& stream = add(withoutSlash(folder), StreamType::Imu, "ts, omega, accel");
    stream.imu = openImuColumns(file_, times, *rates, *accelerations, place_);
    finishImu(times, stream);
  }

  static void finishImu(const DatasetInfo& times, FoundStream& stream) {
    stream.info.messages = times.extent[0];
    stream.info.time_unit_ns = stream.imu->timeScale().unit_ns;
  }

  void addTable(const DatasetInfo& dataset) {
    if (dataset.name() == "events" && dataset.extent[1] == 4 && dataset.type_class != H5T_COMPOUND) {
      addEventRows(dataset);
    }
    const DatasetInfo* times = findList(dataset.folder(), {"imu_ts"});
    if (dataset.name() == "imu" && dataset.extent[1] == 6 && times) {
      FoundStream& stream = add(dataset.path, StreamType::Imu, "imu, imu_ts");
      stream.imu = openImuRows(file_, *times, dataset, place_);
      finishImu(*times, stream);
    }
  }

  void addEventRows(const DatasetInfo& dataset) {
    try {
      std::unique_ptr<EventTable> events = openEventRows(file_, dataset, place_);
      FoundStream& stream = add(dataset.path, StreamType::Events, "rows of x, y, t, p");
      stream.events = std::move(events);
      finishEvents(dataset.folder(), stream);
    } catch (const UnknownColumns& error) {
      problems_.push_back(fmt::format("{} is left out: {}.", dataset.path, error.what()));
    }
  }

  void addCompound(const DatasetInfo& dataset) {
    if (dataset.name() != "events" || dataset.extent.size() != 1) return;
    const auto has = [&](const char* member) {
      return std::find(dataset.members.begin(), dataset.members.end(), member) != dataset.members.end();
    };
    if (!has("p") || !has("t")) return;
    if (has("x") && has("y")) {
      FoundStream& stream = add(dataset.path, StreamType::Events, "compound of x, y, p, t");
      stream.events = openCompound(file_, dataset, place_);
      finishEvents(dataset.folder(), stream);
    } else if (has("id")) {
      addListed(dataset, StreamType::Triggers);
    }
  }

  // M3ED's times are in the folder above, for both cameras; MVSEC's are next to the pictures.
  void addFrames(const DatasetInfo& dataset) {
    const std::string folder = dataset.folder(), above = withoutSlash(folder);
    const std::string parent = above.substr(0, above.rfind('/') + 1);
    const DatasetInfo* times = findList(folder, {(dataset.name() + "_ts").c_str(), "ts"});
    if (!times) times = findList(parent, {"ts"});
    const bool pictures = dataset.name() == "data" || dataset.name() == "image_raw";
    if (!times || !pictures || dataset.type_class != H5T_INTEGER) {
      addListed(dataset, StreamType::Frames);
      return;
    }
    try {
      auto frames = std::make_unique<FrameTable>(file_, dataset, *times, place_);
      FoundStream& stream = add(dataset.path, StreamType::Frames, "pictures, times");
      stream.info.messages = frames->rows();
      stream.info.resolution_px = frames->size_px();
      stream.info.time_unit_ns = frames->timeScale().unit_ns;
      stream.frames = std::move(frames);
    } catch (const CalibrationError& error) {
      problems_.push_back(fmt::format("Pictures are left out: {}.", error.problem()));
      addListed(dataset, StreamType::Frames);
    }
  }

  void addListed(const DatasetInfo& dataset, StreamType type) {
    const bool bytes = dataset.type_class == H5T_INTEGER || type == StreamType::Triggers;
    if (!bytes) return;
    StreamInfo& info = add(dataset.path, type, "").info;
    info.messages = dataset.extent[0];
    info.readable = false;
  }

  std::string datasetNames() const {
    std::vector<std::string> names;
    for (const DatasetInfo& dataset : datasets_)
      if (names.size() < kMaxNamedTables) names.push_back(dataset.path);
    return joined(names) + (datasets_.size() > kMaxNamedTables ? ", ..." : "");
  }

  [[noreturn]] void failWithNames() const {
    const std::string why =
        problems_.empty() ? "" : ". " + problems_.front().substr(0, problems_.front().size() - 1);
    throw badInput(
        place_,
        datasets_.empty()
            ? "the HDF5 file has no datasets" + (why.empty() ? "; was the recording finished?" : why)
            : fmt::format("the HDF5 file has no events and no IMU in a known layout; its datasets: {}{}",
                          datasetNames(), why),
        std::string(
            "Convert it to one of DSEC, VECtor, TUM-VIE, e2calib, M3ED, MVSEC, evlib and Metavision. Or: ") +
            kNamedColumns);
  }

  hid_t file_;
  std::string place_;
  DatasetList list_;
  const std::vector<DatasetInfo>& datasets_;
  std::unordered_map<std::string, const DatasetInfo*> by_path_;
  std::vector<FoundStream> found_;
  std::set<std::string> incomplete_;  // folders
  std::vector<std::string> problems_;
};

}  // namespace

FoundStreams findStreams(hid_t file, const std::string& place, const ColumnNames& names) {
  return TableLayoutFinder(file, place).run(names);
}

}  // namespace evical::hdf5
