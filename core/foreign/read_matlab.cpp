// Source: MathWorks' documentation of cameraParameters, cameraIntrinsics and stereoParameters, and its
// stereoParametersFromOpenCV.m (2021-2024): pixels from 1, rotations of row vectors. The numbers are those
// that the function assigns to fields of rig; the rest of the function creates objects of them.
#include "core/base/error.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include <fmt/format.h>

#include <charconv>
#include <map>
#include <sstream>

namespace evical {
namespace {

class Assignments {
 public:
  explicit Assignments(const std::filesystem::path& path) : file_(path.string()) {
    const std::string text = textOf(path);
    if (!text.starts_with("function rig = evical_rig()\n") || !text.ends_with("\nend\n"))
      throw badInput(file_, "is not a complete function evical_rig");
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t equals = line.find(" = ");
      if (line.starts_with("rig.") && line.ends_with(';') && equals != std::string::npos)
        values_[line.substr(0, equals)] = line.substr(equals + 3, line.size() - equals - 4);
    }
  }

  bool has(const std::string& name) const { return values_.contains(name); }
  std::string place(const std::string& name) const { return fmt::format("{}: {}", file_, name); }

  std::string text(const std::string& name) const {
    const std::string& value = at(name);
    if (value.size() < 2 || !value.starts_with('\'') || !value.ends_with('\''))
      throw badInput(place(name), "is not a text");
    return value.substr(1, value.size() - 2);
  }

  Eigen::MatrixXd matrix(const std::string& name, std::size_t rows, std::size_t cols) const {
    const std::string& value = at(name);
    if (!value.starts_with('[') || !value.ends_with(']')) throw badInput(place(name), "is not a matrix");
    std::istringstream lines(value.substr(1, value.size() - 2));
    std::vector<double> all;
    std::size_t count = 0;
    for (std::string line; std::getline(lines, line, ';'); ++count) {
      const std::size_t before = all.size();
      std::istringstream words(line);
      for (std::string word; std::getline(words, word, ',');) all.push_back(numberOf(word, name));
      if (all.size() - before != cols)
        throw badInput(place(name), fmt::format("does not have {} columns", cols));
    }
    if (count != rows) throw badInput(place(name), fmt::format("has {} rows, not {}", count, rows));
    return matrixFrom(all, static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(cols));
  }

  std::vector<double> row(const std::string& name, std::size_t count) const {
    const Eigen::RowVectorXd values = matrix(name, 1, count);
    return {values.begin(), values.end()};
  }

  double number(const std::string& name) const { return numberOf(at(name), name); }

 private:
  const std::string& at(const std::string& name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) throw badInput(place(name), "is not assigned");
    return found->second;
  }

  double numberOf(const std::string& word, const std::string& name) const {
    const char* const begin = word.data() + (word.starts_with(' ') ? 1 : 0);
    const char* const end = word.data() + word.size();
    double value = 0.0;
    const auto [last, error] = std::from_chars(begin, end, value);
    if (error != std::errc{} || last != end)
      throw badInput(place(name), fmt::format("'{}' is not a number", word));
    return value;
  }

  std::string file_;
  std::map<std::string, std::string> values_;
};

CameraIntrinsics matlabLensOf(const Assignments& read, const std::string& owner) {
  const auto field = [&](const char* name) { return owner + name; };
  const std::vector<double> f = read.row(field(".FocalLength"), 2), c = read.row(field(".PrincipalPoint"), 2);
  const std::vector<double> size = read.row(field(".ImageSize"), 2);  // rows, columns
  const Resolution resolution{static_cast<int>(size[1]), static_cast<int>(size[0])};
  const std::vector<double> k{f[0], f[1], c[0] - 1.0, c[1] - 1.0};
  const std::string model = read.text(field(".Model"));
  if (model == "KannalaBrandt")
    return lensFrom(CameraModel::PinholeEquidistant, k, read.row(field(".DistortionCoefficients"), 4),
                    resolution);
  if (model != "RadialTangential") throw badInput(read.place(field(".Model")), "is not a known model");
  const std::vector<double> radial = read.row(field(".RadialDistortion"), 3),
                            tangential = read.row(field(".TangentialDistortion"), 2);
  return lensFrom(CameraModel::PinholeRadtan, k,
                  {radial[0], radial[1], tangential[0], tangential[1], radial[2]}, resolution);
}

ReadCamera matlabCameraOf(const Assignments& read, const std::string& owner) {
  const std::string pose = owner + ".ReferenceFromCamera";
  ReadCamera camera;
  camera.name = read.text(owner + ".Name");
  camera.lens = matlabLensOf(read, owner);
  camera.frame_from_camera = rigidFrom(read.matrix(pose, 4, 4), read.place(pose));
  camera.time_offset_s = read.number(owner + ".TimeOffset");
  return camera;
}

ReadImu matlabImuOf(const Assignments& read, const std::string& owner) {
  const std::string pose = owner + ".ReferenceFromImu";
  const auto number = [&](const char* name) { return read.number(owner + name); };
  ReadImu imu;
  imu.name = read.text(owner + ".Name");
  imu.reference_from_imu = rigidFrom(read.matrix(pose, 4, 4), read.place(pose));
  imu.time_offset_s = number(".TimeOffset");
  imu.accelerometer = read.matrix(owner + ".AccelerometerMatrix", 3, 3);
  imu.gyroscope = read.matrix(owner + ".GyroscopeMatrix", 3, 3);
  imu.accelerometer_bias_m_s2 = read.matrix(owner + ".AccelerometerBias", 3, 1);
  imu.gyroscope_bias_rad_s = read.matrix(owner + ".GyroscopeBias", 3, 1);
  imu.rate_hz = number(".SampleRate");
  imu.noise = {number(".GyroscopeNoiseDensity"), number(".AccelerometerNoiseDensity"),
               number(".GyroscopeRandomWalk"), number(".AccelerometerRandomWalk")};
  return imu;
}

// p_2 = p_1 R + t, of rows.
ReadFile pairOf(const Assignments& read, const std::vector<ReadCamera>& cameras,
                const std::filesystem::path& path) {
  const std::vector<double> numbers = read.row("rig.stereo.Cameras", 2);
  const auto camera = [&](double number) {
    if (!(number >= 1.0) || number > static_cast<double>(cameras.size()))
      throw badInput(read.place("rig.stereo.Cameras"), "names a missing camera");
    ReadCamera named;
    named.name = cameras[static_cast<std::size_t>(number) - 1].name;
    return named;
  };
  const Eigen::MatrixXd rotation = read.matrix("rig.stereo.RotationOfCamera2", 3, 3).transpose(),
                        translation = read.matrix("rig.stereo.TranslationOfCamera2", 1, 3).transpose();
  const Eigen::MatrixXd second_from_first = (Eigen::MatrixXd(3, 4) << rotation, translation).finished();
  ReadCamera first = camera(numbers[0]), second = camera(numbers[1]);
  first.frame_from_camera = RigidTransform{};
  second.frame_from_camera =
      inverse(rigidFrom(second_from_first, read.place("rig.stereo.RotationOfCamera2")));
  ReadFile file{path, {first, second}};
  file.about_first_camera = true;
  return file;
}

}  // namespace

ReadBack readMatlab(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "evical_rig.m";
  const Assignments read(path);
  ReadFile file{path};
  const auto owner = [](const char* list, std::size_t before) {
    return fmt::format("rig.{}({})", list, before + 1);
  };
  while (read.has(owner("cameras", file.cameras.size()) + ".Name"))
    file.cameras.push_back(matlabCameraOf(read, owner("cameras", file.cameras.size())));
  while (read.has(owner("imus", file.imus.size()) + ".Name"))
    file.imus.push_back(matlabImuOf(read, owner("imus", file.imus.size())));
  if (!file.imus.empty()) file.gravity_m_s2 = read.number("rig.Gravity");
  ReadBack back{{file}};
  if (file.cameras.size() > 1 || read.has("rig.stereo.Cameras"))
    back.files.push_back(pairOf(read, file.cameras, path));
  return back;
}

}  // namespace evical
