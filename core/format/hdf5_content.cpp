#include "core/format/hdf5_content.h"

#include "core/base/error.h"

#include <hdf5.h>

#include <algorithm>
#include <functional>
#include <memory>

namespace evical {
namespace {

constexpr std::size_t kStep_bytes = 16384;  // of a file in memory

// Closes itself.
using Handle = std::unique_ptr<const hid_t, std::function<void(const hid_t*)>>;

Handle held(hid_t id, herr_t (*close)(hid_t)) {
  if (id < 0) throw calibrationFailed("HDF5", "the file cannot be made");
  return {new hid_t(id), [close](const hid_t* each) {
            close(*each);
            delete each;
          }};
}

void require(herr_t outcome) {
  if (outcome < 0) throw calibrationFailed("HDF5", "the file cannot be made");
}

// As h5py has str: of any length, UTF-8.
Handle textType() {
  Handle type = held(H5Tcopy(H5T_C_S1), H5Tclose);
  require(H5Tset_size(*type, H5T_VARIABLE));
  require(H5Tset_cset(*type, H5T_CSET_UTF8));
  return type;
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
  if (const auto* const text = std::get_if<std::string>(&dataset.data)) {
    const Handle type = textType();
    const char* const characters = text->c_str();
    write(*type, *type, static_cast<const void*>(&characters));
  } else if (const auto* const integers = std::get_if<std::vector<std::int64_t>>(&dataset.data)) {
    write(H5T_STD_I64LE, H5T_NATIVE_INT64, integers->data());
  } else {
    write(H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, std::get<std::vector<double>>(dataset.data).data());
  }
}

void writeComment(hid_t file, const std::string& comment) {
  const Handle type = textType(), space = held(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute =
      held(H5Acreate2(file, "comment", *type, *space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const char* const characters = comment.c_str();
  require(H5Awrite(*attribute, *type, static_cast<const void*>(&characters)));
}

// As where recordings are read: on damaged ones the library complains when it is closed at the program's end, and whoever
// calls it first says that it is not.
void closeNothingAtExit() {
  static const herr_t once = H5dont_atexit();
  static_cast<void>(once);
}

// Keeps the library from printing its errors, in this thread, for as long as it lives.
class Quiet {
 public:
  Quiet() {
    closeNothingAtExit();
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

// What a file claims is not trusted: the numbers of a calibration are few.
std::size_t sizeOf(const std::vector<hsize_t>& shape, const std::string& place) {
  constexpr hsize_t kMost = 100'000;
  hsize_t size = 1;
  for (const hsize_t each : shape) {
    if (each == 0 || each > kMost || size > kMost)
      throw badInput(place, "is of no size that a calibration has");
    size *= each;
  }
  return static_cast<std::size_t>(size);
}

std::string textOf(hid_t dataset, hid_t type, const std::string& place) {
  char* characters = nullptr;
  if (H5Tis_variable_str(type) <= 0 ||
      H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, static_cast<void*>(&characters)) < 0 ||
      characters == nullptr)
    throw badInput(place, "is no text of any length");
  std::string text = characters;
  H5free_memory(characters);
  return text;
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
  constexpr int kMostDimensions = 8;
  const int dimensions = H5Sget_simple_extent_ndims(*space);
  if (dimensions < 0 || dimensions > kMostDimensions) throw badInput(place, "has no shape");
  std::vector<hsize_t> shape(static_cast<std::size_t>(dimensions));
  H5Sget_simple_extent_dims(*space, shape.data(), nullptr);
  const std::size_t size = sizeOf(shape, place);
  Hdf5Dataset found{path, {shape.begin(), shape.end()}, {}};
  const H5T_class_t kind = H5Tget_class(*type);
  if (kind == H5T_STRING && shape.empty()) {
    found.data = textOf(dataset, *type, place);
  } else if (kind == H5T_INTEGER && H5Tget_size(*type) == sizeof(std::int64_t)) {
    found.data = numbersOf<std::int64_t>(dataset, H5T_NATIVE_INT64, size, place);
  } else if (kind == H5T_FLOAT && H5Tget_size(*type) == sizeof(double)) {
    found.data = numbersOf<double>(dataset, H5T_NATIVE_DOUBLE, size, place);
  } else {
    throw badInput(place, "is neither float64 nor int64 nor text");
  }
  return found;
}

}  // namespace

std::string hdf5Content(std::span<const Hdf5Dataset> datasets, const std::string& comment) {
  const Quiet quiet;
  const Handle access = held(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  require(H5Pset_fapl_core(*access, kStep_bytes, false));  // in memory
  const Handle file = held(H5Fcreate("in memory", H5F_ACC_TRUNC, H5P_DEFAULT, *access), H5Fclose);
  for (const Hdf5Dataset& dataset : datasets) writeDataset(*file, dataset);
  writeComment(*file, comment);
  require(H5Fflush(*file, H5F_SCOPE_GLOBAL));
  const ssize_t size = H5Fget_file_image(*file, nullptr, 0);
  std::string content(static_cast<std::size_t>(std::max<ssize_t>(size, 0)), '\0');
  if (size <= 0 || H5Fget_file_image(*file, content.data(), content.size()) != size)
    throw calibrationFailed("HDF5", "the file cannot be made");
  return content;
}

std::vector<Hdf5Dataset> hdf5Datasets(const std::string& content, const std::string& file,
                                      std::span<const std::string> paths) {
  const Quiet quiet;
  const Handle access = held(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  require(H5Pset_fapl_core(*access, kStep_bytes, false));
  std::string own = content;  // the library asks for what it may change
  require(H5Pset_file_image(*access, own.data(), own.size()));
  const hid_t opened = H5Fopen("in memory", H5F_ACC_RDONLY, *access);
  if (opened < 0) throw badInput(file, "is no HDF5 file, or is cut off", "Export again");
  const Handle held_file = held(opened, H5Fclose);
  std::vector<Hdf5Dataset> found;
  for (const std::string& path : paths) {
    const hid_t dataset = H5Dopen2(opened, path.c_str(), H5P_DEFAULT);
    if (dataset < 0) continue;
    const Handle held_dataset = held(dataset, H5Dclose);
    found.push_back(datasetOf(dataset, path, file + ": " + path));
  }
  return found;
}

}  // namespace evical
