// Source: JakobEngel/dso, src/util/Undistort.cpp (at 927edc6: getUndistorterForFile, readFromFile), unchanged
// in lukasvst/dm-vio; and lukasvst/dm-vio, src/IMU/IMUSettings.cpp (at 432b7af: IMUCalibration::loadFromFile)
// and src/util/SettingsUtil.cpp (at fcc306b: tryReadFromYaml).
#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <sstream>

namespace evical {
namespace {

struct CameraLines {
  std::array<std::string, 4> lines;
  std::string file;

  std::string place(std::size_t line) const { return fmt::format("{} (line {})", file, line + 1); }

  // The numbers that sscanf reads from the line's beginning.
  std::vector<double> numbers(std::size_t line, std::size_t count) const {
    std::istringstream words(lines[line]);
    std::vector<double> values;
    for (double value = 0.0; values.size() < count && words >> value;) values.push_back(value);
    if (values.size() != count) throw badInput(place(line), fmt::format("must have {} numbers", count));
    return values;
  }

  std::ptrdiff_t words(std::size_t line) const {
    std::istringstream all(lines[line]);
    return std::distance(std::istream_iterator<std::string>(all), {});
  }

  Resolution resolution(std::size_t line) const {
    std::istringstream words(lines[line]);
    Resolution size;
    if (!(words >> size.width_px >> size.height_px) || !size.known())
      throw badInput(place(line), "must have a width and a height");
    return size;
  }
};

CameraLines dmVioLinesOf(const std::filesystem::path& path) {
  CameraLines read{{}, path.string()};
  std::istringstream text(textOf(path));
  for (std::string& line : read.lines)
    if (!std::getline(text, line)) throw badInput(read.file, "has fewer than four lines");
  return read;
}

CameraIntrinsics dsoLensOf(CameraLines read) {
  const std::size_t name_end = read.lines[0].find(' ');
  const std::string name = read.lines[0].substr(0, name_end);
  if (name != "RadTan" && name != "EquiDistant" && name != "KannalaBrandt")
    throw badInput(read.place(0), fmt::format("lens model '{}' is not supported", name));
  read.lines[0].erase(0, name_end);
  const std::vector<double> p = read.numbers(0, 8);
  if (read.words(0) != std::ssize(p))
    throw badInput(read.place(0), "must have eight numbers, and nothing after them");
  if (p[2] < 1.0 && p[3] < 1.0)
    throw badInput(read.place(0), "has values relative to the image's size",
                   "Multiply them by width and height, and subtract 0.5 px from the principal point");
  return lensFrom(name == "RadTan" ? CameraModel::PinholeRadtan : CameraModel::PinholeEquidistant,
                  {p[0], p[1], p[2], p[3]}, {p[4], p[5], p[6], p[7]}, read.resolution(1));
}

ReadFile readDmVioCamera(const std::filesystem::path& path) {
  const CameraLines read = dmVioLinesOf(path);
  const CameraIntrinsics lens = dsoLensOf(read);
  const std::vector<double> rectified = read.numbers(2, 5);
  if (rectified[2] > 1.0 || rectified[3] > 1.0)
    throw badInput(read.place(2), "must be relative to the image's size");
  const Resolution size = read.resolution(3);
  constexpr int kPyramid_px = 8;  // three levels
  if (size.width_px % kPyramid_px != 0 || size.height_px % kPyramid_px != 0)
    throw badInput(read.place(3), "allows fewer than three pyramid levels");
  ReadCamera camera;
  camera.lens = lens;
  return {path, {camera}};
}

ReadFile readCamchain(const std::filesystem::path& path) {
  const YamlNode pose = YamlNode::load(path)["cam0"]["T_cam_imu"];
  ReadCamera camera;
  camera.frame_from_camera = inverse(rigidFrom(rowsOf(pose, 4, 4), pose.place()));
  return {path, {camera}};
}

ReadFile readNoise(const std::filesystem::path& path) {
  const YamlNode root = YamlNode::load(path);
  const auto number = [&](const char* key) { return root[key].real(); };
  ReadImu imu;
  imu.noise = {number("gyroscope_noise_density"), number("accelerometer_noise_density"),
               number("gyroscope_random_walk"), number("accelerometer_random_walk")};
  ReadFile file{path};
  file.imus.push_back(imu);
  return file;
}

}  // namespace

ReadFile readDsoCameraFile(const std::filesystem::path& path) {
  ReadFile file{path, {ReadCamera{}}};
  file.cameras.front().lens = dsoLensOf(dmVioLinesOf(path));
  return file;
}

ReadBack readDmVio(const std::filesystem::path& folder) {
  ReadBack read{{readDmVioCamera(folder / "camera.txt")}, 1, 1};
  // DSO without DM-VIO reads only the camera.
  if (!pathExists(folder / "camchain.yaml") && !pathExists(folder / "noise.yaml")) return read;
  read.files.push_back(readCamchain(folder / "camchain.yaml"));
  read.files.push_back(readNoise(folder / "noise.yaml"));
  return read;
}

}  // namespace evical
