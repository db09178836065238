// Pictures of a folder, and their times: EuRoC, Kalibr, DSEC, TUM-VIE, the RPG event camera data set, or
// pictures without times.
#pragma once

#include "core/data/recording.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace evical::pictures {

struct Picture {
  std::int64_t time_ns = 0;
  double exposure_s = 0.0;  // 0: unknown
  std::string name;         // relative to the list's folder
};

// Pictures of one camera, in the order of the folder's own list or of their names.
struct PictureList {
  std::string name;    // of the stream
  std::string layout;  // "EuRoC"
  std::filesystem::path folder;
  std::vector<Picture> pictures;
  bool timed = true;  // false: they are numbered, 1 s apart
  std::vector<RecordingFault> faults;
};

struct SensorFile {
  std::string name;  // of the stream
  std::filesystem::path path;
};

struct PictureFolder {
  std::vector<PictureList> lists;  // empty: no pictures in a known layout
  std::vector<SensorFile> imus;    // EuRoC's and Kalibr's tables
  std::vector<SensorFile> events;  // DSEC's HDF5
};

// EuRoC: the folder mav0, its parent, or the folder of one camera (data.csv, data/). Kalibr: folders
// of pictures that are named by their ns, and imu0.csv. DSEC: the parent of images/, or images/ itself.
// TUM-VIE: left_images/, right_images/. RPG: images.txt.
PictureFolder findPictures(const std::filesystem::path& folder);

// Only those next to the text of an RPG recording, or next to the events of a TUM-VIE recording.
PictureFolder findRpgPictures(const std::filesystem::path& folder);
PictureFolder findTumViePictures(const std::filesystem::path& folder);

}  // namespace evical::pictures
