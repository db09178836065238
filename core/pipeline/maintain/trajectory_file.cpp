#include "core/pipeline/maintain/trajectory_file.h"

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/base/time.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>

namespace evical {
namespace {

constexpr std::size_t kNumbersInRow = 8;
// Poses closer in time than this are skipped.
constexpr double kNearest_s = 0.0095;
constexpr double kEpoch_s = 1e8;

bool isComment(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string::npos || line[first] == '#' ||
         (std::isalpha(static_cast<unsigned char>(line[first])) != 0);
}

std::array<double, kNumbersInRow> numbersOf(const std::string& line, const std::string& place) {
  std::array<double, kNumbersInRow> numbers = {};
  const char* at = line.c_str();
  for (double& number : numbers) {
    while (*at == ' ' || *at == '\t' || *at == ',' || *at == ';') ++at;
    const std::size_t length = std::strcspn(at, " \t,;\r");
    const std::optional<double> read = realFrom({at, length});
    if (!read)
      throw badInput(place, "does not have eight numbers",
                     "Give trajectory.csv of a calibration, or lines 'time x y z qx qy qz qw'");
    number = *read;
    at += length;
  }
  return numbers;
}

TimedPose poseFrom(const std::array<double, kNumbersInRow>& n, double start_s, const std::string& place) {
  TimedPose pose;
  pose.time_s = std::abs(n[0]) > kEpoch_s ? n[0] - start_s : n[0];
  pose.position_m = {n[1], n[2], n[3]};
  pose.world_from_imu = Eigen::Quaterniond(n[7], n[4], n[5], n[6]);
  constexpr double kOff = 0.01;
  if (std::abs(pose.world_from_imu.norm() - 1.0) > kOff)
    throw badInput(place, "its last four numbers are not a rotation: a quaternion x, y, z, w of length 1",
                   "Give lines 'time x y z qx qy qz qw'");
  pose.world_from_imu.normalize();
  return pose;
}

}  // namespace

std::vector<TimedPose> readTrajectory(const std::filesystem::path& file, std::int64_t log_start_ns) {
  std::ifstream stream(file);
  if (!stream)
    throw badInput(file.string(), "the file cannot be opened", "Check the path and its permissions");
  const double start_s = static_cast<double>(log_start_ns) / kNanosecondsPerSecond;
  std::vector<TimedPose> poses;
  std::string line;
  for (std::size_t number = 1; std::getline(stream, line); ++number) {
    if (isComment(line)) continue;
    const std::string place = fmt::format("{} (line {})", file.string(), number);
    const TimedPose pose = poseFrom(numbersOf(line, place), start_s, place);
    if (!poses.empty() && pose.time_s < poses.back().time_s)
      throw badInput(place, "time runs backwards", "Sort the trajectory by time");
    if (poses.empty() || pose.time_s - poses.back().time_s > kNearest_s) poses.push_back(pose);
  }
  constexpr std::size_t kFewest = 20;
  if (poses.size() < kFewest)
    throw badInput(file.string(), "has only " + counted(poses.size(), "pose"),
                   "Give trajectory.csv of a calibration, or lines 'time x y z qx qy qz qw'");
  return poses;
}

}  // namespace evical
