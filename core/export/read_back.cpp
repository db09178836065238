#include "core/export/read_back.h"

#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/base/number.h"
#include "core/base/plain_text.h"
#include "core/export/rig.h"
#include "core/foreign/read_numbers.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/lens_fit.h"
#include "core/geometry/sphere_lens.h"
#include "core/numerics/angles.h"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

namespace evical {
namespace {

// Tolerated sum of relative rounding errors of single numbers; in lenses, of numbers of thousands of pixels.
constexpr double kSumOfRoundings = 10.0, kPixels = 1e4;

bool isCalled(const std::string& name, const std::string& sensor, const std::string& file_name,
              const std::string& stream) {
  return name == sensor || name == file_name || (!stream.empty() && name == stream) ||
         name == "/" + file_name;
}

template <class Sensor>
std::optional<std::size_t> indexOf(const std::string& name, std::size_t in_order,
                                   const std::vector<Sensor>& sensors) {
  if (name.empty()) return in_order < sensors.size() ? std::optional(in_order) : std::nullopt;
  for (std::size_t i = 0; i < sensors.size(); ++i)
    if (isCalled(name, sensors[i].name, sensors[i].file_name, sensors[i].stream)) return i;
  return std::nullopt;
}

void raise(std::optional<double>& largest, double value) {
  largest = largest && !(value > *largest) && !std::isnan(value) ? *largest : value;
}

// The lens that an exporter writes if the program does not support the camera's own model.
std::optional<LensFit> refitOf(const CameraIntrinsics& own, const CameraIntrinsics& read) {
  const bool radtan = read.model == CameraModel::PinholeRadtan;
  const bool lost_third = radtan && own.distortion[4] != 0.0 && read.distortion[4] == 0.0;
  if (read.model == own.model && !lost_third) return std::nullopt;
  return fitLens(own, read.model, radtan && read.distortion[4] == 0.0 ? 4 : coefficientCount(read.model));
}

// Largest distance between the pixels of the same ray, over the image, as in lens_fit.h; infinite if one is
// undefined.
double lensDifference_px(const CameraIntrinsics& own, const CameraIntrinsics& read) {
  constexpr int kColumns = 41, kRows = 31;
  const double min_z =
      isSphereModel(read.model) || read.model == own.model ? -1.0 : std::cos(85.0 * kRadPerDeg);
  double worst_px = 0.0;
  for (int row = 0; row < kRows; ++row)
    for (int col = 0; col < kColumns; ++col) {
      const Eigen::Vector2d pixel((own.resolution_px.width_px - 1.0) * col / (kColumns - 1),
                                  (own.resolution_px.height_px - 1.0) * row / (kRows - 1));
      const auto ray = unprojectRay(own, pixel);
      if (!ray || ray->z() < min_z) continue;
      const auto ours = project(own, *ray), theirs = project(read, *ray);
      if (!ours) continue;
      if (!theirs) return std::numeric_limits<double>::infinity();
      worst_px = std::max(worst_px, (*theirs - *ours).norm());
    }
  return worst_px;
}

class Comparison {
 public:
  Comparison(const NamedResult& result, const ReadBack& read) : rig_(rigOf(result)), read_(read) {
    findTurns();
    for (const ReadFile& file : read_.files) compareFile(file);
    askForMissing(cameras_, rig_.cameras, read_.max_cameras, "camera");
    askForMissing(imus_, rig_.imus, read_.max_imus, "IMU");
    difference_.cameras = cameras_.size();
    difference_.imus = imus_.size();
  }
  ReadBackDifference difference() && { return std::move(difference_); }

 private:
  void problem(const ReadFile& file, const std::string& sensor, const std::string& what) {
    difference_.problems.push_back(fmt::format("{}: {}: {}", file.path.string(), sensor, what));
  }

  // A program's M of another shape defines another frame of the IMU; M of both times this rotation must be
  // equal.
  void findTurns() {
    turns_.assign(rig_.imus.size(), Eigen::Matrix3d::Identity());
    for (const ReadFile& file : read_.files)
      for (std::size_t k = 0; k < file.imus.size(); ++k) {
        const auto i = indexOf(file.imus[k].name, k, rig_.imus);
        if (!i || !file.imus[k].accelerometer) continue;
        const Eigen::Matrix3d turn =
            file.imus[k].accelerometer->inverse() * rig_.imus[*i].state.accelerometer_scale_misalignment;
        const double off = (turn * turn.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
        if (off <= kSumOfRoundings * file.rounding)
          turns_[*i] = turn;
        else
          problem(file, rig_.imus[*i].name,
                  fmt::format("the accelerometer's scales and misalignment differ by {:.2g}", off));
      }
  }

  void compareFile(const ReadFile& file) {
    for (std::size_t k = 0; k < file.cameras.size(); ++k) {
      if (const auto i = indexOf(file.cameras[k].name, k, rig_.cameras))
        compareCamera(file, file.cameras[k], *i);
      else if (file.cameras[k].name.empty())
        difference_.problems.push_back(fmt::format("{}: has {} cameras, the result has {}",
                                                   file.path.string(), file.cameras.size(),
                                                   rig_.cameras.size()));
    }
    for (std::size_t k = 0; k < file.imus.size(); ++k) {
      if (const auto i = indexOf(file.imus[k].name, k, rig_.imus))
        compareImu(file, file.imus[k], *i);
      else if (file.imus[k].name.empty())
        difference_.problems.push_back(fmt::format("{}: has {} IMUs, the result has {}", file.path.string(),
                                                   file.imus.size(), rig_.imus.size()));
    }
    if (file.gravity_m_s2) compareNumber(file, "gravity", *file.gravity_m_s2, rig_.gravity_m_s2.norm());
  }

  void compareCamera(const ReadFile& file, const ReadCamera& read, std::size_t i) {
    const RigCamera& own = rig_.cameras[i];
    if (read.lens) {
      cameras_.insert(i);
      compareLens(file, own, *read.lens);
    }
    if (read.frame_from_camera)
      comparePose(file, own.name, *read.frame_from_camera, frameOf(file) * own.reference_from_camera);
    if (read.time_offset_s) compareTime(file, own.name, *read.time_offset_s, own.time_offset_s);
  }

  // Transform from Evical's reference to the frame of the file's poses.
  RigidTransform frameOf(const ReadFile& file) const {
    if (!file.about_first_camera) return rig_.imus.empty() ? RigidTransform{} : turnOf(turns_[0]);
    const auto first = indexOf(file.cameras.front().name, 0, rig_.cameras);
    return inverse(rig_.cameras[first.value_or(0)].reference_from_camera);
  }

  void compareLens(const ReadFile& file, const RigCamera& own, CameraIntrinsics read) {
    if (read.resolution_px.known() && read.resolution_px != own.intrinsics.resolution_px)
      problem(file, own.name,
              fmt::format("the resolution is {} x {}, the result's {} x {}", read.resolution_px.width_px,
                          read.resolution_px.height_px, own.intrinsics.resolution_px.width_px,
                          own.intrinsics.resolution_px.height_px));
    read.resolution_px = own.intrinsics.resolution_px;
    const double off_px = lensDifference_px(own.intrinsics, read), rounding_px = kPixels * file.rounding;
    const std::optional<LensFit> refit = refitOf(own.intrinsics, read);
    raise(refit ? difference_.refitted_px : difference_.lens_px, off_px);
    const double max_px = rounding_px + (refit ? refit->worst_px : 0.0);
    if (!(off_px <= max_px))
      problem(file, own.name,
              fmt::format("the lens differs by up to {:.3g} px{}", off_px,
                          refit ? fmt::format(", its refit by {:.3g} px", refit->worst_px) : ""));
  }

  void comparePose(const ReadFile& file, const std::string& sensor, const RigidTransform& read,
                   const RigidTransform& own) {
    const double turn_rad = rotationAngleBetween_rad(own.rotation, read.rotation);
    const double shift_m = (own.translation_m - read.translation_m).norm();
    raise(difference_.rotation_deg, turn_rad * kDegPerRad);
    raise(difference_.translation_mm, 1e3 * shift_m);
    const double rounding = kSumOfRoundings * file.rounding;
    if (!(turn_rad <= rounding) || !(shift_m <= rounding * std::max(1.0, own.translation_m.norm())))
      problem(
          file, sensor,
          fmt::format("the pose differs by {:.3g} deg and {:.3g} mm", turn_rad * kDegPerRad, 1e3 * shift_m));
  }

  void compareTime(const ReadFile& file, const std::string& sensor, double read_s, double own_s) {
    const double off_s = std::abs(read_s - own_s);
    raise(difference_.time_ms, 1e3 * off_s);
    if (!(off_s <= 0.5 * file.time_step_s + kSumOfRoundings * file.rounding * std::max(1.0, std::abs(own_s))))
      problem(file, sensor, fmt::format("the time offset differs by {:.3g} ms", 1e3 * off_s));
  }

  // Relative, except for numbers near 0.
  void compareNumbers(const ReadFile& file, const std::string& what, const Eigen::MatrixXd& read,
                      const Eigen::MatrixXd& own) {
    constexpr double kNearZero = 1e-6;
    const double off = (read - own).cwiseAbs().maxCoeff() / std::max(own.cwiseAbs().maxCoeff(), kNearZero);
    raise(difference_.numbers, off);
    if (!(off <= kSumOfRoundings * file.rounding))
      difference_.problems.push_back(
          fmt::format("{}: {} has a relative difference of {:.3g}", file.path.string(), what, off));
  }
  void compareNumber(const ReadFile& file, const std::string& what, double read, double own) {
    compareNumbers(file, what, Eigen::Matrix<double, 1, 1>(read), Eigen::Matrix<double, 1, 1>(own));
  }

  void compareImu(const ReadFile& file, const ReadImu& read, std::size_t i) {
    const RigImu& own = rig_.imus[i];
    imus_.insert(i);
    const auto called = [&](const char* what) { return fmt::format("{}: {}", own.name, what); };
    if (read.reference_from_imu)
      comparePose(file, own.name, inverse(turnOf(turns_[0])) * *read.reference_from_imu * turnOf(turns_[i]),
                  own.state.reference_from_imu);
    if (read.time_offset_s) compareTime(file, own.name, *read.time_offset_s, own.state.time_offset_s);
    if (read.accelerometer)
      compareNumbers(file, called("the accelerometer's matrix"), *read.accelerometer * turns_[i],
                     own.state.accelerometer_scale_misalignment);
    if (read.gyroscope)
      compareNumbers(file, called("the gyroscope's matrix"), *read.gyroscope * turns_[i],
                     own.state.gyroscopeMatrix());
    if (read.accelerometer_bias_m_s2)
      compareNumbers(file, called("the accelerometer's bias"), *read.accelerometer_bias_m_s2,
                     own.state.accelerometer_bias_m_s2);
    if (read.gyroscope_bias_rad_s)
      compareNumbers(file, called("the gyroscope's bias"), *read.gyroscope_bias_rad_s,
                     own.state.gyroscope_bias_rad_s);
    ExportNotes said;  // already reported by the exporter
    const double rate_hz = statedRate_hz(own, said);
    if (read.rate_hz) compareNumber(file, called("the rate"), *read.rate_hz, rate_hz);
    if (read.noise) compareNoise(file, own, *read.noise, read.noise_of_samples ? std::sqrt(rate_hz) : 1.0);
  }

  void compareNoise(const ReadFile& file, const RigImu& own, const ImuNoise& read, double of_density) {
    ExportNotes said;  // already reported by the exporter
    const ImuNoise noise = statedNoise(own, said);
    const auto compare = [&](const char* what, double ImuNoise::*number) {
      // Numbers this small are compared relative to their own values.
      compareNumber(file, fmt::format("{}: {}", own.name, what), read.*number / (of_density * noise.*number),
                    1.0);
    };
    compare("the gyroscope's noise", &ImuNoise::gyroscope_density);
    compare("the accelerometer's noise", &ImuNoise::accelerometer_density);
    compare("the gyroscope's random walk", &ImuNoise::gyroscope_random_walk);
    compare("the accelerometer's random walk", &ImuNoise::accelerometer_random_walk);
  }

  template <class Sensor>
  void askForMissing(const std::set<std::size_t>& found, const std::vector<Sensor>& sensors, std::size_t most,
                     const char* kind) {
    if (found.size() >= std::min(most, sensors.size())) return;
    std::string missing;
    for (std::size_t i = 0; i < sensors.size(); ++i)
      if (!found.contains(i)) missing += (missing.empty() ? "" : ", ") + sensors[i].name;
    difference_.problems.push_back(fmt::format("no file has the {} {}", kind, missing));
  }

  Rig rig_;
  const ReadBack& read_;
  std::vector<Eigen::Matrix3d> turns_;  // of IMUs: file's frame from Evical's
  std::set<std::size_t> cameras_, imus_;
  ReadBackDifference difference_;
};

std::string checkTextOf(const ReadBackDifference& difference) {
  std::vector<std::string> parts;
  std::string cameras = counted(difference.cameras, "camera");
  if (difference.lens_px) cameras += fmt::format(" within {:.1g} px", *difference.lens_px);
  if (difference.refitted_px)
    cameras += fmt::format("{} {:.2g} px after refitting", difference.lens_px ? "," : " within",
                           *difference.refitted_px);
  parts.push_back(cameras);
  if (difference.imus > 0) parts.push_back(counted(difference.imus, "IMU"));
  if (difference.rotation_deg)
    parts.push_back(fmt::format("poses within {:.1g} deg and {:.1g} mm", *difference.rotation_deg,
                                *difference.translation_mm));
  if (difference.time_ms) parts.push_back(fmt::format("time offsets within {:.1g} ms", *difference.time_ms));
  if (difference.numbers)
    parts.push_back(fmt::format("scales, biases and noise within {:.1g}", *difference.numbers));
  return fmt::format("{}", fmt::join(parts, ", "));
}

// The file as lines, by the rules of all languages: YAML, Python and others know more ends of a line than
// '\n'.
std::vector<std::string> linesOf(const std::string& content) {
  constexpr std::string_view kEnds[] = {"\n",   "\r",   "\v",       "\f",           "\x1c",
                                        "\x1d", "\x1e", "\xc2\x85", "\xe2\x80\xa8", "\xe2\x80\xa9"};
  std::vector<std::string> lines(1);
  for (std::string_view rest = content; !rest.empty();) {
    const auto* const end = std::find_if(std::begin(kEnds), std::end(kEnds),
                                         [&](std::string_view each) { return rest.starts_with(each); });
    if (end == std::end(kEnds)) {
      lines.back() += rest.front();
      rest.remove_prefix(1);
    } else {
      lines.emplace_back();
      rest.remove_prefix(end->size());
    }
  }
  return lines;
}

// Lines of the comments of a text file; nothing for JSON and binary files.
std::set<std::string> commentsIn(const std::filesystem::path& path, const std::string& content) {
  const std::string kind = path.extension().string();
  const bool xml = kind == ".launch" || kind == ".urdf", all = path.filename() == "README.txt";
  const char mark = kind == ".m" ? '%' : '#';
  std::set<std::string> comments;
  if (kind == ".json" || kind == ".npz" || kind == ".h5") return comments;
  bool within = all;
  for (const std::string& line : linesOf(content)) {
    within = within || (xml && line.starts_with("<!--"));
    const std::size_t begin = within ? 0 : line.find(mark);
    if (begin != std::string::npos && (begin == 0 || line[begin - 1] == ' '))
      comments.insert(line.substr(begin));
    within = within && (all || line.find("-->") == std::string::npos);
  }
  return comments;
}

// Comments have directions, signs and the verdict. Lines that someone added are accepted, characters that end
// a line only in some languages are not.
std::vector<std::string> commentProblems(const NamedResult& result, const ExportTarget& target,
                                         const std::filesystem::path& folder) {
  std::vector<std::string> problems;
  for (const FileContent& own : target.write(result).files) {
    const std::set<std::string> wanted = commentsIn(own.path, contentOf(own));
    if (wanted.empty() || !pathExists(folder / own.path)) continue;
    const std::string text = textOf(folder / own.path);
    const std::set<std::string> found = commentsIn(own.path, text);
    for (const std::string& line : wanted)
      if (!found.contains(line))
        problems.push_back(fmt::format("{}: the comment '{}' is missing", own.path.string(), line));
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      if (line.ends_with('\r')) line.pop_back();  // an editor's
      if (visible(line, "\t") != line)
        problems.push_back(
            fmt::format("{}: a line has a control character: '{}'", own.path.string(), printable(line)));
    }
  }
  return problems;
}

}  // namespace

ReadBackDifference differenceOf(const NamedResult& result, const ReadBack& read) {
  return Comparison(result, read).difference();
}

ExportCheck checkExport(const NamedResult& result, const ExportTarget& target,
                        const std::filesystem::path& folder) {
  try {
    ReadBackDifference difference = differenceOf(result, target.read(folder / target.name));
    for (std::string& problem : commentProblems(result, target, folder / target.name))
      difference.problems.push_back(std::move(problem));
    if (difference.problems.empty())
      return {true, fmt::format("{}: reads back: {}", target.name, checkTextOf(difference))};
    return {false,
            fmt::format("{}: does not read back: {}", target.name, fmt::join(difference.problems, "; "))};
  } catch (const CalibrationError& error) {
    return {false, fmt::format("{}: does not read back: {}", target.name, error.what())};
  }
}

}  // namespace evical
