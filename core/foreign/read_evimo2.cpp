// Source: better-flow/evimo: evimo/dataset.h (at 02db528: read_params, read_cam_intr, read_extr), and
// tools/evimo2_v2_generate/generate_extrinsics_npz.py (at 35286e2: read_camera_extrinsics), which requires
// four lines, the last of them 0, and defines the third as the camera's time minus the pose's.
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include "core/base/error.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <charconv>
#include <map>
#include <sstream>

namespace evical {
namespace {

CalibrationError evimo2Broken(const std::filesystem::path& file, const std::string& what) {
  return badInput(file.string(), what, "Export again");
}

std::vector<std::vector<double>> evimo2LinesOf(const std::filesystem::path& file) {
  std::vector<std::vector<double>> lines;
  std::istringstream text(textOf(file));
  for (std::string line; std::getline(text, line);) {
    std::vector<double>& numbers = lines.emplace_back();
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      double& number = numbers.emplace_back();
      const auto end = std::from_chars(word.data(), word.data() + word.size(), number);
      if (end.ec != std::errc{} || end.ptr != word.data() + word.size())
        throw evimo2Broken(file, fmt::format("'{}' is not a number", word));
    }
  }
  return lines;
}

std::map<std::string, std::string> parametersOf(const std::filesystem::path& file) {
  std::map<std::string, std::string> parameters;
  std::istringstream text(textOf(file));
  const auto trimmed = [](const std::string& word) {
    const std::size_t first = word.find_first_not_of(" \t\r");
    return first == std::string::npos ? std::string()
                                      : word.substr(first, word.find_last_not_of(" \t\r") - first + 1);
  };
  for (std::string line; std::getline(text, line);) {
    const std::size_t colon = std::min(line.find(':'), line.size());
    parameters[trimmed(line.substr(0, colon))] = colon < line.size() ? trimmed(line.substr(colon + 1)) : "";
  }
  return parameters;
}

CameraIntrinsics evimo2LensOf(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "params.txt";
  const auto parameters = parametersOf(file);
  const auto text = [&](const char* key) {
    const auto found = parameters.find(key);
    if (found == parameters.end()) throw evimo2Broken(file, fmt::format("has no {}", key));
    return found->second;
  };
  const auto size_px = [&](const char* key) {
    const std::string word = text(key);
    int size = 0;
    const auto end = std::from_chars(word.data(), word.data() + word.size(), size);
    if (end.ec != std::errc{} || size <= 0)
      throw evimo2Broken(file, fmt::format("{} must be a whole number", key));
    return size;
  };
  const bool radtan = text("dist_model") == "radtan";
  if (!radtan && text("dist_model") != "equidistant")
    throw evimo2Broken(file, "dist_model must be radtan or equidistant");
  if (!parameters.contains("ros_event_topic") && !parameters.contains("ros_image_topic"))
    throw evimo2Broken(file, "has no topic");
  const auto lines = evimo2LinesOf(folder / "calib.txt");
  if (lines.size() != 1 || lines[0].size() != 8)
    throw evimo2Broken(folder / "calib.txt", "must have one line of eight numbers");
  // res_x counts rows.
  return lensFrom(radtan ? CameraModel::PinholeRadtan : CameraModel::PinholeEquidistant,
                  {lines[0].begin(), lines[0].begin() + 4}, {lines[0].begin() + 4, lines[0].end()},
                  {size_px("res_y"), size_px("res_x")});
}

ReadFile evimo2CameraOf(const std::filesystem::path& folder) {
  ReadFile file{folder / "extrinsics.txt"};
  const auto lines = evimo2LinesOf(file.path);
  constexpr std::size_t kNumbers[] = {6, 7, 1, 1};
  for (std::size_t i = 0; i < std::size(kNumbers); ++i)
    if (lines.size() != std::size(kNumbers) || lines[i].size() != kNumbers[i])
      throw evimo2Broken(file.path, "must have lines of 6, 7, 1 and 1 numbers");
  if (lines[3][0] != 0.0) throw evimo2Broken(file.path, "the fourth line must be 0");
  const std::vector<double>& place = lines[0];
  using Axis = Eigen::AngleAxisd;
  ReadCamera camera;
  camera.name = folder.filename().string();
  camera.lens = evimo2LensOf(folder);
  camera.frame_from_camera = RigidTransform{
      Eigen::Quaterniond(Axis(place[5], Eigen::Vector3d::UnitZ()) * Axis(place[4], Eigen::Vector3d::UnitY()) *
                         Axis(place[3], Eigen::Vector3d::UnitX())),
      {place[0], place[1], place[2]}};
  camera.time_offset_s = -lines[2][0];
  file.cameras = {camera};
  return file;
}

}  // namespace

ReadBack readEvimo2(const std::filesystem::path& folder) {
  ReadBack read;
  read.max_imus = 0;
  std::error_code problem;
  std::vector<std::filesystem::path> cameras;
  for (const auto& entry : std::filesystem::directory_iterator(folder, problem))
    if (entry.is_directory(problem)) cameras.push_back(entry.path());
  std::sort(cameras.begin(), cameras.end());
  for (const std::filesystem::path& camera : cameras) read.files.push_back(evimo2CameraOf(camera));
  return read;
}

}  // namespace evical
