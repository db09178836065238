#include "core/report/hdf5_content.h"

#include "core/base/error.h"

#include <hdf5.h>

#include <algorithm>
#include <functional>
#include <memory>

namespace evical {
namespace {

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

}  // namespace

std::string hdf5Content(std::span<const Hdf5Dataset> datasets, const std::string& comment) {
  constexpr std::size_t kStep_bytes = 16384;
  closeNothingAtExit();
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

}  // namespace evical
