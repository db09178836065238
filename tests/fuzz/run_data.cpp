// run.data: as a file, and with the datasets of a small run changed by the input, since the parts' checksums
// reject damage. libhdf5 itself gets none of it.
#include "core/pipeline/runs/run_data.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <type_traits>

namespace {

using namespace evical;

CalibrationRun smallRun() {
  CalibrationRun run;
  run.result.state.cameras.resize(1);
  run.result.state.imus.resize(1);
  const std::vector<Eigen::Vector3d> at_knots(2, Eigen::Vector3d::Zero());
  run.result.state.imus[0].bias_drift = {0.0, 1.0, at_knots, at_knots};
  run.result.state.world_from_imu_rotation.control_points.assign(5, Eigen::Quaterniond::Identity());
  run.result.state.imu_in_world_m.control_points.assign(5, Eigen::Vector3d::Zero());
  run.result.cameras.resize(1);
  run.result.imus.resize(1);
  run.result.iterations = {{0, 0, 1.0, 1.0, 1.0, run.result.state.cameras, {"board"}}};
  run.result.circle_residuals.resize(2);
  run.result.latencies.resize(1);
  run.result.uncertainty.cameras.resize(1);
  run.result.uncertainty.imus.resize(1);
  run.result.uncertainty.columns.resize(2);
  run.result.uncertainty.standard_deviations.setOnes(2);
  run.result.uncertainty.correlation.setIdentity(2, 2);
  run.intrinsics.emplace_back().emplace().image = {1, 2, {{}, {}}, 0.0, 0.0};
  run.detections.cameras.resize(1);
  run.detections.cameras[0].views = {{0.5, ViewKind::Complete, {{}, {}}}, {}};
  run.detections.lenses.resize(1);
  run.detections.lenses[0].given.emplace();
  run.detections.resolutions_px.resize(1);
  run.detections.imus = {{"imu", {}, {{}, {}}}};
  run.detections.faults.resize(1);
  return run;
}

struct Change {
  std::uint8_t dataset = 0, place = 0, what = 0;
  std::int64_t value = 0;
};

void damage(const Change& change, std::optional<Hdf5Dataset>& dataset) {
  if (!dataset || change.what == 0) return dataset.reset();
  std::visit(
      [&](auto& values) {
        if (change.what == 1) return values.resize(change.place);
        if (values.empty()) return;
        auto& value = values[change.place % values.size()];
        if constexpr (std::is_arithmetic_v<std::remove_reference_t<decltype(value)>>)
          std::memcpy(&value, &change.value, std::min(sizeof value, sizeof change.value));
      },
      dataset->data);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string whole = runData(smallRun());
  static const Hdf5Source datasets = runDatasets(whole);
  static std::map<std::string, std::optional<Hdf5Dataset>> known;  // reading them each time is slow
  parseRunData({reinterpret_cast<const char*>(data), size});
  std::size_t asked = 0;
  const Hdf5Source changed = [&](const std::string& path) {
    if (!known.contains(path)) known[path] = datasets(path);
    std::optional<Hdf5Dataset> dataset = known[path];
    for (std::size_t at = 0; at + 11 <= size; at += 11) {
      Change change{data[at], data[at + 1], data[at + 2], 0};
      std::memcpy(&change.value, data + at + 3, sizeof change.value);
      if (change.dataset == asked % 256) damage(change, dataset);
    }
    ++asked;
    return dataset;
  };
  runFrom(changed, whole.size());
  return 0;
}
