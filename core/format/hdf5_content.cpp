#include "core/format/hdf5_content.h"

#include "core/base/error.h"

#include <hdf5.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <span>
#include <utility>

namespace evical {
namespace {

constexpr std::size_t kStep_bytes = 1 << 20;  // of a file in memory

// Handle that closes itself.
using Handle = std::unique_ptr<const hid_t, std::function<void(const hid_t*)>>;

Handle held(hid_t id, herr_t (*close)(hid_t)) {
  if (id < 0) throw calibrationFailed("HDF5", "the file cannot be created");
  return {new hid_t(id), [close](const hid_t* each) {
            close(*each);
            delete each;
          }};
}

void require(herr_t outcome) {
  if (outcome < 0) throw calibrationFailed("HDF5", "the file cannot be created");
}

// Type of h5py's str: any length, UTF-8.
Handle textType() {
  Handle type = held(H5Tcopy(H5T_C_S1), H5Tclose);
  require(H5Tset_size(*type, H5T_VARIABLE));
  require(H5Tset_cset(*type, H5T_CSET_UTF8));
  return type;
}

hid_t narrowest(const std::vector<std::int64_t>& integers) {
  const auto holdsAll = [&]<class Number>(Number) {
    return std::ranges::all_of(integers, [](std::int64_t each) { return std::in_range<Number>(each); });
  };
  return holdsAll(std::int8_t{})    ? H5T_STD_I8LE
         : holdsAll(std::int16_t{}) ? H5T_STD_I16LE
         : holdsAll(std::int32_t{}) ? H5T_STD_I32LE
                                    : H5T_STD_I64LE;
}

void writeDataset(hid_t file, const Hdf5Dataset& dataset) {
  const Handle links = held(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  require(H5Pset_create_intermediate_group(*links, 1));
  const Handle creation = held(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  require(H5Pset_obj_track_times(*creation, false));
  const std::vector<hsize_t> shape(dataset.shape.begin(), dataset.shape.end());
  const Handle space =
      held(shape.empty() ? H5Screate(H5S_SCALAR)
                         : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
           H5Sclose);
  const auto write = [&](hid_t stored, hid_t own, const void* data) {
    const Handle written = held(
        H5Dcreate2(file, dataset.path.c_str(), stored, *space, *links, *creation, H5P_DEFAULT), H5Dclose);
    require(H5Dwrite(*written, own, H5S_ALL, H5S_ALL, H5P_DEFAULT, data));
  };
  const auto writeTexts = [&](std::span<const std::string> texts) {
    const Handle type = textType();
    std::vector<const char*> characters;
    for (const std::string& text : texts) characters.push_back(text.c_str());
    write(*type, *type, static_cast<const void*>(characters.data()));
  };
  if (const auto* const text = std::get_if<std::string>(&dataset.data))
    writeTexts({text, 1});
  else if (const auto* const texts = std::get_if<std::vector<std::string>>(&dataset.data))
    writeTexts(*texts);
  else if (const auto* const integers = std::get_if<std::vector<std::int64_t>>(&dataset.data))
    write(dataset.narrow ? narrowest(*integers) : H5T_STD_I64LE, H5T_NATIVE_INT64, integers->data());
  else
    write(H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, std::get<std::vector<double>>(dataset.data).data());
}

void writeComment(hid_t file, const std::string& comment) {
  const Handle type = textType(), space = held(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute =
      held(H5Acreate2(file, "comment", *type, *space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const char* const characters = comment.c_str();
  require(H5Awrite(*attribute, *type, static_cast<const void*>(&characters)));
}

// Required as for recordings: after damaged files the library prints errors when it is closed at the
// program's end. The first caller disables this.
void closeNothingAtExit() {
  static const herr_t once = H5dont_atexit();
  static_cast<void>(once);
}

// One thread in the library at a time, since some builds are not thread-safe; suppresses its error output.
class InLibrary {
 public:
  InLibrary() : lock_(mutex()) {
    closeNothingAtExit();
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~InLibrary() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  InLibrary(const InLibrary&) = delete;
  InLibrary& operator=(const InLibrary&) = delete;

 private:
  static std::recursive_mutex& mutex() {
    static std::recursive_mutex only;
    return only;
  }

  std::lock_guard<std::recursive_mutex> lock_;
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

// Unique name, since the library treats equal names as one file.
std::string nameInMemory() {
  static int made = 0;
  return "in memory " + std::to_string(++made);
}

// Checks a file's claim: it has few numbers, or stores as many as it claims.
std::size_t sizeOf(hid_t dataset, hid_t type, const std::vector<hsize_t>& shape, const std::string& place) {
  constexpr hsize_t kFew = 100'000;
  const hsize_t most = std::max(kFew, H5Dget_storage_size(dataset) / std::max<hsize_t>(H5Tget_size(type), 1));
  hsize_t size = 1;
  for (const hsize_t each : shape) {
    if (each == 0 || each > most / size) throw badInput(place, "does not have the size that it claims");
    size *= each;
  }
  return static_cast<std::size_t>(size);
}

std::vector<std::string> textsOf(hid_t dataset, hid_t type, std::size_t size, const std::string& place) {
  std::vector<char*> characters(size, nullptr);
  if (H5Tis_variable_str(type) <= 0 ||
      H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, static_cast<void*>(characters.data())) < 0)
    throw badInput(place, "is not a text of variable length");
  std::vector<std::string> texts;
  for (char* const each : characters) {
    texts.emplace_back(each == nullptr ? "" : each);
    H5free_memory(each);
  }
  return texts;
}

template <class Number>
std::vector<Number> numbersOf(hid_t dataset, hid_t own, std::size_t size, const std::string& place) {
  std::vector<Number> numbers(size);
  if (H5Dread(dataset, own, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()) < 0)
    throw badInput(place, "cannot be read");
  return numbers;
}

Hdf5Dataset datasetOf(hid_t dataset, const std::string& path, const std::string& place) {
  const Handle type = held(H5Dget_type(dataset), H5Tclose), space = held(H5Dget_space(dataset), H5Sclose);
  const Handle creation = held(H5Dget_create_plist(dataset), H5Pclose);
  if (H5Pget_layout(*creation) == H5D_VIRTUAL || H5Pget_external_count(*creation) > 0)
    throw badInput(place, "is kept in another file, which is not opened");
  if (H5Pget_nfilters(*creation) > 0) throw badInput(place, "is packed, which Evical does not do");
  constexpr int kMaxDimensions = 8;
  const int dimensions = H5Sget_simple_extent_ndims(*space);
  if (dimensions < 0 || dimensions > kMaxDimensions) throw badInput(place, "has no shape");
  std::vector<hsize_t> shape(static_cast<std::size_t>(dimensions));
  H5Sget_simple_extent_dims(*space, shape.data(), nullptr);
  const std::size_t size = sizeOf(dataset, *type, shape, place);
  Hdf5Dataset found{path, {shape.begin(), shape.end()}, {}};
  const H5T_class_t kind = H5Tget_class(*type);
  if (kind == H5T_STRING) {
    std::vector<std::string> texts = textsOf(dataset, *type, size, place);
    if (shape.empty())
      found.data = std::move(texts.front());
    else
      found.data = std::move(texts);
  } else if (kind == H5T_INTEGER && H5Tget_size(*type) <= sizeof(std::int64_t)) {
    found.data = numbersOf<std::int64_t>(dataset, H5T_NATIVE_INT64, size, place);
  } else if (kind == H5T_FLOAT && H5Tget_size(*type) == sizeof(double)) {
    found.data = numbersOf<double>(dataset, H5T_NATIVE_DOUBLE, size, place);
  } else {
    throw badInput(place, "is neither float64 nor integers nor text");
  }
  return found;
}

// Opened and closed by one thread at a time.
class OpenedFile {
 public:
  OpenedFile(std::string_view content, const std::string& file) : file_(file) {
    const InLibrary library;
    const Handle access = held(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    require(H5Pset_fapl_core(*access, kStep_bytes, false));
    // The library copies the content; its parameter is not const.
    require(H5Pset_file_image(*access, const_cast<char*>(content.data()), content.size()));
    const hid_t opened = H5Fopen(nameInMemory().c_str(), H5F_ACC_RDONLY, *access);
    if (opened < 0) throw badInput(file, "is not an HDF5 file, or is cut off", "Export again");
    handle_ = held(opened, H5Fclose);
  }
  ~OpenedFile() {
    const InLibrary library;
    handle_.reset();
  }
  OpenedFile(const OpenedFile&) = delete;
  OpenedFile& operator=(const OpenedFile&) = delete;

  std::optional<Hdf5Dataset> dataset(const std::string& path) const {
    const InLibrary library;
    if (hasLink(path)) throw badInput(file_ + ": " + path, "is a link, which is not followed");
    const hid_t dataset = H5Dopen2(*handle_, path.c_str(), H5P_DEFAULT);
    if (dataset < 0) return std::nullopt;
    const Handle held_dataset = held(dataset, H5Dclose);
    return datasetOf(dataset, path, file_ + ": " + path);
  }

 private:
  // True if a part of the path is a link, which may lead to another file.
  bool hasLink(const std::string& path) const {
    for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
      H5L_info_t link{};
      const std::string part = path.substr(0, end);
      if (H5Lget_info(*handle_, part.c_str(), &link, H5P_DEFAULT) < 0) return false;
      if (link.type != H5L_TYPE_HARD) return true;
      if (end == std::string::npos) return false;
    }
  }

  std::string file_;
  Handle handle_;
};

}  // namespace

void writeHdf5(const std::function<void(const Hdf5Sink& add)>& fill, const std::string& comment,
               const TextSink& sink) {
  const InLibrary library;
  const Handle access = held(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  require(H5Pset_fapl_core(*access, kStep_bytes, false));  // in memory
  const Handle file = held(H5Fcreate(nameInMemory().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, *access), H5Fclose);
  fill([&](const Hdf5Dataset& dataset) { writeDataset(*file, dataset); });
  writeComment(*file, comment);
  require(H5Fflush(*file, H5F_SCOPE_GLOBAL));
  void* memory = nullptr;  // not copied, since it may be large
  require(H5Fget_vfd_handle(*file, H5P_DEFAULT, &memory));
  const ssize_t size = H5Fget_file_image(*file, nullptr, 0);
  require(size > 0 ? 0 : -1);
  sink({*static_cast<const char**>(memory), static_cast<std::size_t>(size)});
}

Hdf5Source hdf5Source(std::string_view content, const std::string& file) {
  const auto opened = std::make_shared<const OpenedFile>(content, file);
  return [opened](const std::string& path) { return opened->dataset(path); };
}

}  // namespace evical
