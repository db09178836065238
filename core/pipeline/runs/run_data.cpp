#include "core/pipeline/runs/run_data.h"

#include "core/base/file_places.h"
#include "core/base/time.h"
#include "core/data/quantity.h"
#include "core/pipeline/runs/columns.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

namespace evical {

namespace columns {

EVICAL_FIELDS(RigidTransform, rotation, translation_m);
EVICAL_FIELDS(So3Spline, start_s, knot_spacing_s, control_points);
EVICAL_FIELDS(VectorSpline, start_s, knot_spacing_s, control_points);
EVICAL_FIELDS(Resolution, width_px, height_px);
EVICAL_FIELDS(CameraIntrinsics, model, resolution_px, focal_length_px, principal_point_px, distortion);
EVICAL_FIELDS(LensUncertainty, std, correlation);
EVICAL_FIELDS(CameraLens, given, detection_intrinsics, solved, given_with);
EVICAL_FIELDS(CameraState, reference_from_camera, time_offset_s, edge_localisation_bias_px,
              slow_edge_localisation_bias_px, lens, time_offset_drift_ppm, time_offset_at_s, line_delay_us,
              exposure_share);
EVICAL_FIELDS(BiasDrift, start_s, knot_spacing_s, gyroscope_rad_s, accelerometer_m_s2);
EVICAL_FIELDS(ImuState, reference_from_imu, time_offset_s, gyroscope_bias_rad_s, accelerometer_bias_m_s2,
              gyroscope_scale_misalignment, accelerometer_scale_misalignment, gyroscope_from_accelerometer,
              accelerometer_delay_s, bias_drift, time_offset_drift_ppm, time_offset_at_s);
EVICAL_FIELDS(BoardState, scale, stretch, row_curvature_1_m, column_curvature_1_m, twist_1_m,
              world_from_board);
EVICAL_FIELDS(CalibrationState, world_from_imu_rotation, imu_in_world_m, cameras, imus, board, further_boards,
              gravity_in_world_m_s2);
EVICAL_FIELDS(CameraUncertainty, rotation_std_rad, translation_std_m, time_offset_std_s,
              edge_localisation_bias_std_px, slow_edge_localisation_bias_std_px, intrinsics_std,
              time_offset_drift_std_ppm, line_delay_std_us, exposure_share_std);
EVICAL_FIELDS(ImuUncertainty, rotation_std_rad, translation_std_m, time_offset_std_s,
              gyroscope_bias_std_rad_s, accelerometer_bias_std_m_s2, gyroscope_scale_misalignment_std,
              accelerometer_scale_misalignment_std, gyroscope_drift_std_rad_s, accelerometer_drift_std_m_s2,
              gyroscope_rotation_std_rad, time_offset_drift_std_ppm, accelerometer_delay_std_s);
EVICAL_FIELDS(BoardUncertainty, rotation_std_rad, translation_std_m, scale_std, stretch_std,
              row_curvature_std_1_m, column_curvature_std_1_m, twist_std_1_m);
EVICAL_FIELDS(QuantityAddress, owner, sensor, id, component, model);
EVICAL_FIELDS(UncertaintyReport, columns, standard_deviations, correlation, cameras, imus, board,
              further_boards, given, gravity_direction_std_rad, gravity_norm_std_m_s2, observability, weakest,
              directions);
EVICAL_FIELDS(SensorLatency, camera, against, latency_s, std_s);
EVICAL_FIELDS(CameraFit, reprojection_rms_px, normalised_rms, neighbour_agreement, windows_total,
              windows_complete, windows_partial, windows_used, windows_rejected, circles_used,
              circles_rejected);
EVICAL_FIELDS(ImuFit, gyroscope_rms_rad_s, accelerometer_rms_m_s2);
EVICAL_FIELDS(IterationRecord, stage, iteration, cost, gradient, step, cameras, released);
EVICAL_FIELDS(CircleResidual, camera, view, circle, time_s, centre_px, residual_px, sigma_px, used);
EVICAL_FIELDS(RejectedWindow, camera, time_s);
EVICAL_FIELDS(QuantityDifference, name, unit, difference, sigma);
EVICAL_FIELDS(SplitHalfCheck, block_s, windows, quantities, rms_sigmas, failure);
EVICAL_FIELDS(Repair, key, value);
EVICAL_FIELDS(QualityWarning, text, repair, name, explains);
EVICAL_FIELDS(Timing, read_s, detect_s, initialise_s, optimise_s, split_half_check_s, total_s);
EVICAL_FIELDS(CalibrationResult, status, reason, repair, causes, freed, start_ns, state, uncertainty,
              latencies, cameras, imus, iterations, circle_residuals, rejected_windows, split_half_check,
              notes, timing, memory_peak_mb);
EVICAL_FIELDS(ImageCell, middle_px, circles, sigma_px);
EVICAL_FIELDS(ImageMap, columns, rows, cells, rms_px, max_px);
EVICAL_FIELDS(IntrinsicsResult, status, reason, advice, intrinsics, covariance, edge_localisation_bias_px,
              edge_localisation_bias_std_px, image, reprojection_rms_px, normalised_rms, largest_tilt_deg,
              views_found, views_used, circles_used, circles_rejected, passes, moved_px, elapsed_s);
EVICAL_FIELDS(CircleObservation, circle, time_s, centre_px, covariance_px2, velocity_px_s,
              edge_localisation_bias_effect, semi_axes_px, angle_rad, events, residual_rms_px,
              rows_below_middle, longer_exposed_s);
EVICAL_FIELDS(BoardView, time_s, kind, circles);
EVICAL_FIELDS(WindowReport, time_s, half_width_s, outcome, events, candidates, circles, tracked);
EVICAL_FIELDS(LatticeEnds, beyond_in_view, beyond_seen, edge_in_view, edge_missing, lines, lines_lead);
EVICAL_FIELDS(BoardExtent, rows, cols);
EVICAL_FIELDS(PolarityDelay, later_s, std_s);
EVICAL_FIELDS(BoardObservations, camera, kind, views, windows, extent, events, polarity_delay, narrowest_px,
              single_events, stamp_step_s);
EVICAL_FIELDS(ImuNoise, gyroscope_density, accelerometer_density, gyroscope_random_walk,
              accelerometer_random_walk);
EVICAL_FIELDS(ImuSample, time_ns, angular_rate_rad_s, specific_force_m_s2, measured_by);
EVICAL_FIELDS(ImuData, name, noise, samples, prior);
EVICAL_FIELDS(RecordingFault, stream, kind, at_s, text);
EVICAL_FIELDS(DetectionResult, start_ns, cameras, lenses, imus, resolutions_px, faults, read_s, detect_s,
              rejected_views, imu_stamp_steps_s);

template <>
inline constexpr auto kLast<CalibrationStatus> = CalibrationStatus::Failed;
template <>
inline constexpr auto kLast<CameraModel> = CameraModel::OmniRadtan;
template <>
inline constexpr auto kLast<QuantityOwner> = QuantityOwner::Rig;
template <>
inline constexpr auto kLast<QuantityId> = QuantityId::Gravity;
template <>
inline constexpr auto kLast<ViewKind> = ViewKind::Partial;
template <>
inline constexpr auto kLast<WindowOutcome> = WindowOutcome::OtherPattern;
template <>
inline constexpr auto kLast<CameraKind> = CameraKind::Points;
template <>
inline constexpr auto kLast<FaultKind> = FaultKind::Untimed;
template <>
inline constexpr auto kLast<MeasuredBy> = MeasuredBy::Accelerometer;

template <>
inline constexpr bool kLeftOut<ImuPrior> = true;

}  // namespace columns

namespace {

constexpr std::string_view kMagic = "evical run data\n";
constexpr const char* kChecksum = "result_yaml_checksum";  // the first part
constexpr const char* kForeign =
    "run.data is not used: it belongs to another run than result.yaml, result.yaml was changed later, or "
    "run.data is damaged. "
    "Its trajectory, convergence and residuals are missing. Calibrate again to get them, or restore "
    "result.yaml";

unsigned long sumOf(std::string_view bytes) {
  return crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

// A line with name, length and checksum, followed by the bytes of an HDF5 file: parts are checked
// independently, and the library does not receive damaged bytes.
struct Part {
  std::string name;
  std::size_t size = 0;
  unsigned long sum = 0;

  Part(std::string name_of, std::string_view bytes)
      : name(std::move(name_of)), size(bytes.size()), sum(sumOf(bytes)) {}
  // The name is empty if this is not the line of a part.
  explicit Part(const std::string& line) {
    std::istringstream words(line);
    if (!(words >> name >> size >> std::hex >> sum)) name.clear();
  }

  std::string line() const { return fmt::format("{} {} {:08x}\n", name, size, sum); }
};

template <class T>
void addPart(const std::string& name, const T& value, const TextSink& sink) {
  const auto fill = [&](const Hdf5Sink& add) { columns::write(name, value, add); };
  writeHdf5(fill, "run: " + name, [&](std::string_view bytes) {
    sink(Part(name, bytes).line());
    sink(bytes);
  });
}

// Parts before the position at which the file is truncated or damaged.
std::map<std::string, Hdf5Source> partsOf(std::string_view content) {
  std::map<std::string, Hdf5Source> parts;
  if (!content.starts_with(kMagic)) return parts;
  content.remove_prefix(kMagic.size());
  for (std::size_t end = 0; (end = content.find('\n')) != content.npos;) {
    const Part part(std::string(content.substr(0, end)));
    content.remove_prefix(end + 1);
    if (part.name.empty() || part.size > content.size()) break;
    const std::string_view bytes = content.substr(0, part.size);
    content.remove_prefix(part.size);
    if (sumOf(bytes) == part.sum)
      parts[part.name] = hdf5Source(bytes, "run.data");
    else
      parts[part.name] = [](const std::string&) -> std::optional<Hdf5Dataset> { throw columns::damaged(); };
  }
  return parts;
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

// Related lists must have the same size, and indices must be valid.
bool isWhole(const CalibrationResult& result) {
  const CalibrationState& state = result.state;
  const UncertaintyReport& uncertainty = result.uncertainty;
  const std::size_t cameras = state.cameras.size();
  const auto columns = static_cast<Eigen::Index>(uncertainty.columns.size());
  const std::vector<QuantityAddress> numbers = quantityAddresses(state);
  return result.cameras.size() == cameras && uncertainty.cameras.size() == cameras &&
         result.imus.size() == state.imus.size() && uncertainty.imus.size() == state.imus.size() &&
         (uncertainty.directions.empty() ||
          uncertainty.directions.size() == uncertainty.observability.size()) &&
         uncertainty.further_boards.size() == state.further_boards.size() &&
         uncertainty.standard_deviations.size() == columns && uncertainty.correlation.rows() == columns &&
         uncertainty.correlation.cols() == columns &&
         std::ranges::all_of(uncertainty.columns,
                             [&](const auto& each) { return columnOf(each, numbers).has_value(); }) &&
         isWhole(state.world_from_imu_rotation) && isWhole(state.imu_in_world_m) &&
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

bool isWhole(const DetectionResult& detections) {
  const auto whole = [](const auto& each) { return isWhole(each); };
  return isTime(detections.start_ns) && detections.lenses.size() == detections.cameras.size() &&
         detections.resolutions_px.size() == detections.cameras.size() &&
         (detections.rejected_views.empty() ||
          detections.rejected_views.size() == detections.cameras.size()) &&
         std::all_of(detections.rejected_views.begin(), detections.rejected_views.end(), whole) &&
         std::all_of(detections.cameras.begin(), detections.cameras.end(), whole) &&
         std::all_of(detections.imus.begin(), detections.imus.end(), whole);
}

// Residuals must refer to existing views and circles.
bool fits(const CalibrationResult& result, const DetectionResult& detections) {
  return result.state.cameras.size() == detections.cameras.size() &&
         result.state.imus.size() == detections.imus.size() &&
         std::all_of(result.circle_residuals.begin(), result.circle_residuals.end(),
                     [&](const CircleResidual& r) {
                       return r.camera >= 0 &&
                              static_cast<std::size_t>(r.camera) < detections.cameras.size() && r.view >= 0 &&
                              static_cast<std::size_t>(r.view) <
                                  detections.cameras[static_cast<std::size_t>(r.camera)].views.size() &&
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

// Reads a part, and lists the missing data if that fails.
template <class T>
bool readWhole(const Hdf5Source& datasets, std::size_t most, const std::string& name, const char* what,
               T& value, std::vector<std::string>& missing) {
  std::string problem;
  try {
    columns::read(name, value, datasets, most);
    if (!isWhole(value)) problem = "is inconsistent";
  } catch (const CalibrationError& error) {
    problem = error.problem();
  }
  if (problem.empty()) return true;
  value = {};
  missing.push_back(fmt::format("{}: this part {}", what, problem));
  return false;
}

void addParts(const CalibrationRun& run, const TextSink& sink) {
  addPart("result", run.result, sink);
  addPart("intrinsics", run.intrinsics, sink);
  addPart("observations", run.detections, sink);
}

// True for files without a checksum, which older versions wrote. Reads only the first part.
bool isTiedTo(const std::string& result_yaml, std::string_view content) {
  if (!content.starts_with(kMagic)) return true;
  const std::size_t end = std::min(content.find('\n', kMagic.size()), content.size() - 1);
  const Part part(std::string(content.substr(kMagic.size(), end + 1 - kMagic.size())));
  if (part.name != kChecksum) return true;
  std::int64_t sum = -1;
  try {
    constexpr std::size_t kMax = 1;
    columns::read(kChecksum, sum, runDatasets(std::string(content.substr(0, end + 1 + part.size))), kMax);
  } catch (const CalibrationError&) {
    return false;
  }
  return sum == static_cast<std::int64_t>(sumOf(result_yaml));
}

}  // namespace

void writeRunData(const CalibrationRun& run, const std::string& result_yaml, const TextSink& sink) {
  sink(kMagic);
  addPart(kChecksum, static_cast<std::int64_t>(sumOf(result_yaml)), sink);
  addParts(run, sink);
}

std::string runData(const CalibrationRun& run) {
  return std::string(kMagic) + wholeText([&](const TextSink& sink) { addParts(run, sink); });
}

ReadRunData readRunData(const std::filesystem::path& file, const std::optional<std::string>& result_yaml) {
  ReadRunData read;
  const std::string content = contentOfFile(file);
  if (!content.empty() && result_yaml && !isTiedTo(*result_yaml, content)) {
    read.missing.emplace_back(kForeign);
    return read;
  }
  if (!content.empty()) return parseRunData(content);
  read.missing.push_back(
      fmt::format("trajectory, convergence, signals and residuals: {} is missing", file.filename().string()));
  return read;
}

std::optional<std::string> whyRunDataIsForeign(const std::filesystem::path& result_file) {
  constexpr std::size_t kFirstParts = std::size_t{1} << 16;
  const std::string begin = contentOfFile(result_file.parent_path() / "run.data", kFirstParts);
  if (begin.empty() || isTiedTo(contentOfFile(result_file), begin)) return std::nullopt;
  return kForeign;
}

Hdf5Source runDatasets(const std::string& content) {
  return [parts = partsOf(content)](const std::string& path) {
    const auto part = parts.find(path.substr(0, path.find('/')));
    if (part == parts.end()) throw badInput("", "is missing");
    return part->second(path);
  };
}

ReadRunData parseRunData(const std::string& content) {
  return runFrom(runDatasets(content), content.size());
}

ReadRunData runFrom(const Hdf5Source& datasets, std::size_t most) {
  ReadRunData read;
  const auto readPart = [&](const char* name, const char* what, auto& value) {
    return readWhole(datasets, most, name, what, value, read.missing);
  };
  constexpr const char* kSeen = "detections of the board, and IMU samples";
  read.has_result = readPart("result", "trajectory, convergence and residuals", read.run.result);
  readPart("intrinsics", "calibration of the lenses", read.run.intrinsics);
  read.has_pass = readPart("observations", kSeen, read.run.detections);
  if (read.has_result && read.has_pass && !fits(read.run.result, read.run.detections)) {
    read.run.detections = {};
    read.has_pass = false;
    read.missing.push_back(fmt::format("{}: this part is of another run", kSeen));
  }
  return read;
}

}  // namespace evical
