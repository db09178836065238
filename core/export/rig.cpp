#include "core/export/rig.h"

#include "core/base/element.h"
#include "core/base/error.h"
#include "core/base/plain_text.h"
#include "core/data/quantity.h"

#include <fmt/format.h>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace evical {
namespace {

// Two names may become equal ("a b", "a/b"): then the later one gets a number.
std::string fileName(const std::string& name, std::set<std::string>& taken) {
  std::string text;
  for (const char letter : name) {
    const bool plain = (letter >= '0' && letter <= '9') || (letter >= 'a' && letter <= 'z') ||
                       (letter >= 'A' && letter <= 'Z') || letter == '_' || letter == '-' || letter == '.';
    text += plain ? letter : '_';
  }
  if (text.empty() || text.front() == '.' || text.front() == '-') text.insert(0, "sensor");
  std::string unique = text;
  for (int number = 2; !taken.insert(unique).second; ++number) unique = fmt::format("{}_{}", text, number);
  return unique;
}

// Checks all numbers of a sensor that exports may contain.
template <class Rows, class State>
void checkNumbers(const std::string& place, const Rows& rows, const State& state) {
  bool finite = true;
  forEachQuantity(rows, [&](const auto& row) {
    if (row.info.presence != QuantityPresence::WhereBothEstimated)
      finite = finite && quantityNumbers(row.value(state)).allFinite();
  });
  if (!finite) throwNotFinite(place);
}

RigCamera rigCameraOf(const NamedResult& result, std::size_t i, std::set<std::string>& taken) {
  const std::string& name = result.cameras[i].name;
  const CameraState& state = result.result->state.cameras.at(i);
  const std::optional<CameraIntrinsics>& intrinsics = state.lens.inUse();
  if (!intrinsics || !intrinsics->resolution_px.known())
    throw badInput(fmt::format("result: cameras.{}", name),
                   intrinsics ? "has no resolution_px" : "has no intrinsics",
                   "Export the result.yaml of a calibration");
  checkNumbers(fmt::format("result: cameras.{}", name), kCameraQuantities, state);
  return {printable(name),        fileName(name, taken), printable(result.cameras[i].stream),
          result.cameras[i].kind, *intrinsics,           state.reference_from_camera,
          state.time_offset_s,    state.line_delay_us,   elementOrNone(result.result->cameras, i)};
}

RigImu rigImuOf(const NamedResult& result, std::size_t i, std::set<std::string>& taken) {
  const std::string& name = result.imus[i].name;
  const SensorDescription& known = result.imus[i];
  const ImuState& state = result.result->state.imus.at(i);
  checkNumbers(fmt::format("result: imus.{}", name), kImuQuantities, state);
  return {printable(name), fileName(name, taken), printable(known.stream), known.noise, known.rate_hz, state};
}

// True if the estimate differs significantly from 0.
bool isSignificant(double value, double sigma) {
  constexpr double kChance_sigmas = 3.0;
  return value != 0.0 && std::abs(value) >= kChance_sigmas * sigma;
}

template <class State, class Uncertainty>
void remarkDrift(const std::string& name, const State& state, const Uncertainty& sigma,
                 std::vector<std::string>& remarks) {
  if (!isSignificant(state.time_offset_drift_ppm, sigma.time_offset_drift_std_ppm)) return;
  remarks.push_back(fmt::format(
      "{}: its clock drifts by {:.3g} ppm relative to the reference's; the time offset is that at {:.2f} "
      "s of its clock, other stamps need the drift, too",
      name, state.time_offset_drift_ppm, state.time_offset_at_s));
}

void remarkDelay(const std::string& name, const ImuState& state, const ImuUncertainty& sigma,
                 std::vector<std::string>& remarks) {
  if (!isSignificant(state.accelerometer_delay_s, sigma.accelerometer_delay_std_s)) return;
  remarks.push_back(
      fmt::format("{}: the accelerometer's samples are {:.3g} ms later than the gyroscope's of the "
                  "same stamp; subtract this from their stamps first",
                  name, 1e3 * state.accelerometer_delay_s));
}

void remarkRollingShutter(const std::string& name, const CameraState& state, const CameraUncertainty& sigma,
                          std::vector<std::string>& remarks) {
  if (!isSignificant(state.line_delay_us, sigma.line_delay_std_us)) return;
  remarks.push_back(
      fmt::format("{}: rolling shutter, {:.4g} us from row to row; the time offset is that of "
                  "the middle row",
                  name, state.line_delay_us));
}

// Largest difference between the first camera and the others.
double largestOffset_s(const Rig& rig) {
  double largest_s = 0.0;
  for (const RigCamera& camera : rig.cameras)
    largest_s = std::max(largest_s, std::abs(camera.time_offset_s - rig.cameras[0].time_offset_s));
  return largest_s;
}

}  // namespace

std::vector<std::string> timingRemarks(const NamedResult& result) {
  const CalibrationState& state = result.result->state;
  const UncertaintyReport& sigmas = result.result->uncertainty;
  std::vector<std::string> remarks;
  for (std::size_t i = 0; i < result.cameras.size(); ++i) {
    const CameraUncertainty sigma = elementOrNone(sigmas.cameras, i);
    remarkDrift(result.cameras[i].name, state.cameras.at(i), sigma, remarks);
    remarkRollingShutter(result.cameras[i].name, state.cameras[i], sigma, remarks);
  }
  for (std::size_t i = 0; i < result.imus.size(); ++i) {
    const ImuUncertainty sigma = elementOrNone(sigmas.imus, i);
    remarkDrift(result.imus[i].name, state.imus.at(i), sigma, remarks);
    remarkDelay(result.imus[i].name, state.imus[i], sigma, remarks);
  }
  return remarks;
}

Rig rigOf(const NamedResult& result) {
  Rig rig;
  rig.program = printable(result.version.empty() ? "Evical" : "Evical " + result.version);
  rig.status = statusName(result.result->status);
  if (!result.result->reason.empty()) rig.status += ": " + printable(result.result->reason);
  rig.gravity_m_s2 = result.result->state.gravity_in_world_m_s2;
  if (!rig.gravity_m_s2.allFinite()) throwNotFinite("result: gravity_m_s2");
  std::set<std::string> taken;
  for (std::size_t i = 0; i < result.cameras.size(); ++i)
    rig.cameras.push_back(rigCameraOf(result, i, taken));
  for (std::size_t i = 0; i < result.imus.size(); ++i) rig.imus.push_back(rigImuOf(result, i, taken));
  std::stable_partition(rig.imus.begin(), rig.imus.end(),
                        [&](const RigImu& imu) { return imu.name == printable(result.reference); });
  rig.timing = timingRemarks(result);
  for (const SensorDescription& imu : result.imus)
    if (!imu.accelerometer_stream.empty() && imu.accelerometer_stream != imu.stream)
      rig.timing.push_back(fmt::format(
          "{}: gyroscope and accelerometer have separate topics, {} and {}. A program that takes one "
          "topic gets the gyroscope's",
          imu.name, imu.stream, imu.accelerometer_stream));
  for (std::string& line : rig.timing) line = printable(line);
  return rig;
}

const RigImu& neededImu(const Rig& rig, const char* program) {
  if (!rig.imus.empty()) return rig.imus.front();
  throw badInput("result", fmt::format("has no IMU, which {} requires", program),
                 "Calibrate with an IMU, or export to ros, metavision or kalibr");
}

Eigen::Matrix4d matrixOf(const RigidTransform& pose) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = pose.rotation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = pose.translation_m;
  return matrix;
}

ImuNoise statedNoise(const RigImu& imu, ExportNotes& notes) {
  const bool known = imu.noise.gyroscope_density > 0.0 && imu.noise.accelerometer_density > 0.0;
  if (!known)
    notes.push_back(fmt::format(
        "{}: the result has no noise densities; Evical's defaults are written, replace them by your own",
        imu.name));
  const ImuNoise noise = known ? imu.noise : ImuNoise{};
  ImuNoise stated{noise.gyroscope_density, noise.accelerometer_density, imu.noise.gyroscope_random_walk,
                  imu.noise.accelerometer_random_walk};
  if (stated.gyroscope_random_walk > 0.0 && stated.accelerometer_random_walk > 0.0) return stated;
  // Programs refuse 0.
  notes.push_back(
      fmt::format("{}: random walks are not measured: a tenth of the noise densities is written, replace "
                  "them by your own",
                  imu.name));
  if (stated.gyroscope_random_walk <= 0.0) stated.gyroscope_random_walk = noise.gyroscope_density / 10.0;
  if (stated.accelerometer_random_walk <= 0.0)
    stated.accelerometer_random_walk = noise.accelerometer_density / 10.0;
  return stated;
}

double statedRate_hz(const RigImu& imu, ExportNotes& notes) {
  if (imu.rate_hz > 0.0) return imu.rate_hz;
  constexpr double kUsualRate_hz = 200.0;
  notes.push_back(fmt::format("{}: the result has no rate; {} Hz is written, replace it by your own",
                              imu.name, kUsualRate_hz));
  return kUsualRate_hz;
}

void noteLostMapping(const RigImu& imu, const char* program, ExportNotes& notes) {
  const auto off = [](const Eigen::Matrix3d& m) {
    return (m - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  };
  const double largest =
      std::max(off(imu.state.gyroscopeMatrix()), off(imu.state.accelerometer_scale_misalignment));
  if (largest == 0.0) return;
  notes.push_back(
      fmt::format("{}: {} does not support scales and misalignment, which are up to {:.2g} % here; correct "
                  "the samples first ({}'s mapping in result.yaml)",
                  imu.name, program, 100.0 * largest, imu.name));
}

void noteLostImus(const Rig& rig, const char* program, ExportNotes& notes) {
  if (rig.imus.size() > 1)
    notes.push_back(fmt::format("{} supports one IMU: only {} is written", program, rig.imus[0].name));
}

void noteLostOffsets(const Rig& rig, const char* program, ExportNotes& notes) {
  const double largest_s = largestOffset_s(rig);
  if (largest_s == 0.0) return;
  notes.push_back(fmt::format(
      "{} supports one time offset for all cameras: that of {} is written, others differ by up to "
      "{:.4g} ms; shift their stamps first",
      program, rig.cameras[0].name, 1e3 * largest_s));
}

void noteNoOffsets(const Rig& rig, const char* program, ExportNotes& notes) {
  if (largestOffset_s(rig) == 0.0) return;
  std::string text =
      fmt::format("{} does not support the cameras' time offsets: add to the stamps of", program);
  for (const RigCamera& camera : rig.cameras)
    text += fmt::format("{} {} {} s", &camera == &rig.cameras.front() ? "" : ",", camera.name,
                        camera.time_offset_s);
  notes.push_back(std::move(text));
}

void noteLostCameras(const Rig& rig, std::size_t most, const char* program, ExportNotes& notes) {
  if (rig.cameras.size() <= most) return;
  std::string left_out;
  for (std::size_t i = most; i < rig.cameras.size(); ++i)
    left_out += (left_out.empty() ? "" : ", ") + rig.cameras[i].name;
  notes.push_back(fmt::format("{} supports {} cameras: {} is left out", program, most, left_out));
}

std::string stampShifts(const Rig& rig) {
  std::string text = "Time offsets are not supported here: add to the stamps of the images";
  for (const RigCamera& camera : rig.cameras)
    text += fmt::format(" {} s ({})", real(camera.time_offset_s), camera.file_name);
  return text +
         fmt::format(" so that t_{} = t_cam + offset.", rig.imus.empty() ? rig.cameras[0].file_name : "imu");
}

std::string headerComment(const Rig& rig, const std::vector<std::string>& lines, Language language) {
  std::string text = fmt::format("Written by {}. Calibration: {}\n", rig.program, rig.status);
  for (const std::string& line : lines) text += line + "\n";
  for (const std::string& line : rig.timing) text += line + "\n";
  return commentIn(language, text);
}

std::string readMe(const Rig& rig, const std::vector<std::string>& lines) {
  return headerComment(rig, lines, Language::Text);
}

TriangularTimesRotation splitLower(const Eigen::Matrix3d& matrix) {
  // matrix^T = Q R, so matrix = R^T Q^T.
  const Eigen::HouseholderQR<Eigen::Matrix3d> qr(matrix.transpose());
  Eigen::Matrix3d lower = Eigen::Matrix3d(qr.matrixQR().triangularView<Eigen::Upper>()).transpose();
  Eigen::Matrix3d rotation = Eigen::Matrix3d(qr.householderQ()).transpose();
  for (int i = 0; i < 3; ++i)
    if (lower(i, i) < 0.0) {
      lower.col(i) *= -1.0;
      rotation.row(i) *= -1.0;
    }
  return {lower, rotation};
}

TriangularTimesRotation splitUpper(const Eigen::Matrix3d& matrix) {
  const Eigen::Matrix3d turned = matrix.rowwise().reverse().colwise().reverse();
  const TriangularTimesRotation split = splitLower(turned);
  return {split.triangular.rowwise().reverse().colwise().reverse(),
          split.rotation.rowwise().reverse().colwise().reverse()};
}

bool hasMapping(const ImuState& imu) {
  return imu.accelerometer_scale_misalignment != Eigen::Matrix3d::Identity() ||
         imu.gyroscopeMatrix() != Eigen::Matrix3d::Identity();
}

LowerTriangularImu lowerTriangular(const ImuState& imu) {
  if (!hasMapping(imu)) return {};
  const TriangularTimesRotation accelerometer = splitLower(imu.accelerometer_scale_misalignment);
  const TriangularTimesRotation gyroscope =
      splitLower(imu.gyroscopeMatrix() * accelerometer.rotation.transpose());
  return {accelerometer.rotation, accelerometer.triangular, gyroscope.triangular, gyroscope.rotation};
}

RigidTransform turnOf(const Eigen::Matrix3d& other_from_imu) {
  return {Eigen::Quaterniond(other_from_imu), Eigen::Vector3d::Zero()};
}

}  // namespace evical
