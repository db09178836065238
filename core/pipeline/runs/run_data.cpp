#include "core/pipeline/runs/run_data.h"

#include "core/base/time.h"
#include "core/pipeline/runs/packed_members.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>

namespace evical {

// How many members each struct of a run has.
namespace packed {

template <>
inline constexpr int kMembers<RigidTransform> = 2;
template <>
inline constexpr int kMembers<So3Spline> = 3;
template <>
inline constexpr int kMembers<VectorSpline> = 3;
template <>
inline constexpr int kMembers<Resolution> = 2;
template <>
inline constexpr int kMembers<CameraIntrinsics> = 5;
template <>
inline constexpr int kMembers<LensUncertainty> = 2;
template <>
inline constexpr int kMembers<CameraLens> = 4;
template <>
inline constexpr int kMembers<CameraState> = 9;
template <>
inline constexpr int kMembers<BiasDrift> = 4;
template <>
inline constexpr int kMembers<ImuState> = 11;
template <>
inline constexpr int kMembers<BoardState> = 6;
template <>
inline constexpr int kMembers<CalibrationState> = 7;
template <>
inline constexpr int kMembers<CameraUncertainty> = 9;
template <>
inline constexpr int kMembers<ImuUncertainty> = 12;
template <>
inline constexpr int kMembers<BoardUncertainty> = 7;
template <>
inline constexpr int kMembers<UncertaintyReport> = 13;
template <>
inline constexpr int kMembers<SensorLatency> = 4;
template <>
inline constexpr int kMembers<CameraFit> = 9;
template <>
inline constexpr int kMembers<ImuFit> = 2;
template <>
inline constexpr int kMembers<IterationRecord> = 7;
template <>
inline constexpr int kMembers<CircleResidual> = 8;
template <>
inline constexpr int kMembers<RejectedWindow> = 2;
template <>
inline constexpr int kMembers<QuantityDifference> = 4;
template <>
inline constexpr int kMembers<CrossValidation> = 5;
template <>
inline constexpr int kMembers<Repair> = 2;
template <>
inline constexpr int kMembers<Doubt> = 4;
template <>
inline constexpr int kMembers<Timing> = 6;
template <>
inline constexpr int kMembers<CalibrationResult> = 17;
template <>
inline constexpr int kMembers<ImageCell> = 3;
template <>
inline constexpr int kMembers<ImageMap> = 5;
template <>
inline constexpr int kMembers<IntrinsicsResult> = 18;
template <>
inline constexpr int kMembers<CircleObservation> = 12;
template <>
inline constexpr int kMembers<BoardView> = 3;
template <>
inline constexpr int kMembers<WindowReport> = 7;
template <>
inline constexpr int kMembers<LatticeEnds> = 4;
template <>
inline constexpr int kMembers<BoardExtent> = 2;
template <>
inline constexpr int kMembers<PolarityDelay> = 2;
template <>
inline constexpr int kMembers<BoardObservations> = 8;
template <>
inline constexpr int kMembers<ImuNoise> = 4;
template <>
inline constexpr int kMembers<ImuSample> = 4;
template <>
inline constexpr int kMembers<ImuData> = 4;
template <>
inline constexpr int kMembers<RecordingFault> = 4;
template <>
inline constexpr int kMembers<RecordingPass> = 9;

template <>
inline constexpr auto kLast<CalibrationStatus> = CalibrationStatus::Failed;
template <>
inline constexpr auto kLast<CameraModel> = CameraModel::OmniRadtan;
template <>
inline constexpr auto kLast<ViewKind> = ViewKind::Partial;
template <>
inline constexpr auto kLast<WindowOutcome> = WindowOutcome::RejectedByHand;
template <>
inline constexpr auto kLast<CameraKind> = CameraKind::Points;
template <>
inline constexpr auto kLast<FaultKind> = FaultKind::Untimed;
template <>
inline constexpr auto kLast<MeasuredBy> = MeasuredBy::Accelerometer;

template <>
inline constexpr bool kLeftOut<ImuPrior> = true;

}  // namespace packed

namespace {

constexpr std::string_view kMagic = "evical run 1\n";

std::uint32_t sumOf(std::string_view bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

// Name, what types it is of, check sum, length, and the bytes themselves.
template <class T>
void addPart(const std::string& name, const T& value, const TextSink& sink) {
  std::uint32_t sum = 0;
  std::uint64_t length = 0;
  const TextSink measure = [&](std::string_view bytes) {
    sum = sumOf(bytes, sum);
    length += bytes.size();
  };
  packed::Packing measured(measure);
  measured.pack(value);
  measured.flush();
  packed::Packing part(sink);
  part.pack(name);
  part.pack(packed::description<T>());
  part.pack(sum);
  part.pack(length);
  part.pack(value);
  part.flush();
}

struct Part {
  std::string description, bytes;
  std::uint32_t sum = 0;
};

// Those before the place at which the file is cut off or damaged.
std::map<std::string, Part> partsOf(std::string_view content) {
  std::map<std::string, Part> parts;
  if (!content.starts_with(kMagic)) return parts;
  packed::Unpacking file(content.substr(kMagic.size()));
  try {
    while (!file.atEnd()) {
      std::string name;
      Part part;
      file.unpack(name);
      file.unpack(part.description);
      file.unpack(part.sum);
      file.unpack(part.bytes);
      parts[name] = std::move(part);
    }
  } catch (const CalibrationError&) {
    // What is missing is said by who looks for it.
  }
  return parts;
}

#ifdef EVICAL_FUZZ_RUN_DATA
constexpr bool kSumsCount = false;
#else
constexpr bool kSumsCount = true;
#endif

// Why it could not be read; empty if it was.
template <class T>
std::string readPart(const std::map<std::string, Part>& parts, const std::string& name, T& value) {
  const auto found = parts.find(name);
  if (found == parts.end()) return "is missing";
  const Part& part = found->second;
  if (part.description != packed::description<T>()) return "was written by another version of the program";
  if (kSumsCount && part.sum != sumOf(part.bytes)) return "is damaged";
  try {
    packed::Unpacking bytes(part.bytes);
    bytes.unpack(value);
    return bytes.atEnd() ? "" : "is damaged";
  } catch (const CalibrationError& error) {
    return error.problem();
  }
}

template <class Spline>
bool isWhole(const Spline& spline) {
  return spline.control_points.empty() ||
         (spline.control_points.size() > 3 && std::isfinite(spline.start_s) && spline.knot_spacing_s > 0.0 &&
          std::isfinite(spline.knot_spacing_s));
}

bool isWhole(const BiasDrift& drift) {
  return drift.gyroscope_rad_s.size() == drift.accelerometer_m_s2.size() &&
         (drift.knots() == 0 || drift.knot_spacing_s > 0.0);
}

// Lists that go with each other are of one size, and indices are of what there is.
bool isWhole(const CalibrationResult& result) {
  const CalibrationState& state = result.state;
  const UncertaintyReport& uncertainty = result.uncertainty;
  const std::size_t cameras = state.cameras.size();
  const auto names = static_cast<Eigen::Index>(uncertainty.names.size());
  return result.cameras.size() == cameras && uncertainty.cameras.size() == cameras &&
         result.imus.size() == state.imus.size() && uncertainty.imus.size() == state.imus.size() &&
         (uncertainty.directions.empty() ||
          uncertainty.directions.size() == uncertainty.observability.size()) &&
         uncertainty.further_boards.size() == state.further_boards.size() &&
         uncertainty.standard_deviations.size() == names && uncertainty.correlation.rows() == names &&
         uncertainty.correlation.cols() == names && isWhole(state.world_from_imu_rotation) &&
         isWhole(state.imu_in_world_m) &&
         state.world_from_imu_rotation.control_points.empty() ==
             state.imu_in_world_m.control_points.empty() &&
         std::all_of(state.imus.begin(), state.imus.end(),
                     [](const ImuState& imu) { return isWhole(imu.bias_drift); }) &&
         std::all_of(result.iterations.begin(), result.iterations.end(),
                     [&](const IterationRecord& each) { return each.cameras.size() == cameras; }) &&
         std::all_of(
             result.latencies.begin(), result.latencies.end(),
             [&](const SensorLatency& each) { return each.camera < cameras && each.against < cameras; }) &&
         std::all_of(result.rejected_windows.begin(), result.rejected_windows.end(),
                     [&](const RejectedWindow& each) { return each.camera < cameras; });
}

bool isWhole(const ImuData& imu) {
  return !imu.samples.empty() &&
         std::is_sorted(imu.samples.begin(), imu.samples.end(),
                        [](const ImuSample& a, const ImuSample& b) { return a.time_ns < b.time_ns; }) &&
         isTime(imu.samples.front().time_ns) && isTime(imu.samples.back().time_ns);
}

bool isEarlier(const BoardView& a, const BoardView& b) {
  return a.time_s < b.time_s;
}

bool isWhole(const std::vector<BoardView>& views) {
  const auto in_view = [](const BoardView& view) {
    return std::all_of(view.circles.begin(), view.circles.end(),
                       [](const CircleObservation& circle) { return circle.circle >= 0; });
  };
  return std::is_sorted(views.begin(), views.end(), isEarlier) &&
         std::all_of(views.begin(), views.end(), in_view);
}

bool isWhole(const BoardObservations& camera) {
  const auto earlier = [](const auto& a, const auto& b) { return a.time_s < b.time_s; };
  return isWhole(camera.views) && std::is_sorted(camera.windows.begin(), camera.windows.end(), earlier);
}

bool isWhole(const RecordingPass& pass) {
  const auto whole = [](const auto& each) { return isWhole(each); };
  return isTime(pass.start_ns) && pass.lenses.size() == pass.cameras.size() &&
         pass.resolutions_px.size() == pass.cameras.size() &&
         (pass.rejected_views.empty() || pass.rejected_views.size() == pass.cameras.size()) &&
         std::all_of(pass.rejected_views.begin(), pass.rejected_views.end(), whole) &&
         std::all_of(pass.cameras.begin(), pass.cameras.end(), whole) &&
         std::all_of(pass.imus.begin(), pass.imus.end(), whole);
}

// Residuals are of views and circles.
bool fits(const CalibrationResult& result, const RecordingPass& pass) {
  return result.state.cameras.size() == pass.cameras.size() && result.state.imus.size() == pass.imus.size() &&
         std::all_of(result.circle_residuals.begin(), result.circle_residuals.end(),
                     [&](const CircleResidual& r) {
                       return r.camera >= 0 && static_cast<std::size_t>(r.camera) < pass.cameras.size() &&
                              r.view >= 0 &&
                              static_cast<std::size_t>(r.view) <
                                  pass.cameras[static_cast<std::size_t>(r.camera)].views.size() &&
                              r.circle >= 0;
                     });
}

bool isWhole(const std::vector<std::optional<IntrinsicsResult>>& intrinsics) {
  return std::all_of(intrinsics.begin(), intrinsics.end(), [](const auto& each) {
    return !each || (each->image.columns >= 0 && each->image.rows >= 0 &&
                     each->image.cells.size() == static_cast<std::size_t>(each->image.columns) *
                                                     static_cast<std::size_t>(each->image.rows));
  });
}

// Reads a part, and says of what it leaves people without.
template <class T>
bool readWhole(const std::map<std::string, Part>& parts, const std::string& name, const char* what, T& value,
               std::vector<std::string>& missing) {
  std::string problem = readPart(parts, name, value);
  if (problem.empty() && !isWhole(value)) problem = "contradicts itself";
  if (problem.empty()) return true;
  value = {};
  missing.push_back(fmt::format("{}: this part {}", what, problem));
  return false;
}

}  // namespace

void writeRunData(const CalibrationRun& run, const TextSink& sink) {
  sink(kMagic);
  addPart("result", run.result, sink);
  addPart("intrinsics", run.intrinsics, sink);
  addPart("observations", run.pass, sink);
}

std::string runData(const CalibrationRun& run) {
  return wholeText([&](const TextSink& sink) { writeRunData(run, sink); });
}

ReadRunData readRunData(const std::filesystem::path& file) {
  ReadRunData read;
  std::ifstream stream(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (content.empty()) {
    read.missing.push_back(fmt::format("trajectory, convergence, signals and residuals: {} is not there",
                                       file.filename().string()));
    return read;
  }
  return parseRunData(content);
}

ReadRunData parseRunData(const std::string& content) {
  ReadRunData read;
  const std::map<std::string, Part> parts = partsOf(content);
  read.has_result =
      readWhole(parts, "result", "trajectory, convergence and residuals", read.run.result, read.missing);
  readWhole(parts, "intrinsics", "how the lenses were calibrated", read.run.intrinsics, read.missing);
  read.has_pass = readWhole(parts, "observations", "what was found of the board, and the IMUs' samples",
                            read.run.pass, read.missing);
  if (read.has_result && read.has_pass && !fits(read.run.result, read.run.pass)) {
    read.run.pass = {};
    read.has_pass = false;
    read.missing.push_back("what was found of the board, and the IMUs' samples: this part is of another run");
  }
  return read;
}

}  // namespace evical
