#include "core/base/element.h"
#include "core/base/plain_text.h"
#include "core/data/quantity.h"
#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/format/npy.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/report/shown_quantity.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace evical {
namespace {

class Arrays {
 public:
  // Keys are `sensor`.key, or only the key without a sensor.
  void setSensor(const std::string& sensor) { prefix_ = sensor.empty() ? "" : sensor + "."; }

  void add(const std::string& key, std::string npy) { arrays_.push_back({prefix_ + key, std::move(npy)}); }
  void add(const std::string& key, const Eigen::Vector3d& vector) {
    add(key, npyList(std::span<const double>(vector.data(), 3)));
  }
  void addKnown(const std::string& key, double number) {  // 0: unknown
    if (number != 0.0) add(key, npyNumber(number));
  }

  std::string file() const { return npz(arrays_); }

 private:
  std::string prefix_;
  std::vector<NpzArray> arrays_;
};

// SI units, one array per quantity; quantities that were not estimated are omitted.
template <class Rows, class Uncertainty>
void addSigmas(const Rows& rows, const Uncertainty& uncertainty, Arrays& arrays) {
  forEachQuantity(rows, [&](const auto& row) {
    const Eigen::VectorXd sigmas = quantityNumbers(row.sigma(uncertainty));
    if (sigmas.isZero(0.0)) return;
    arrays.add(std::string(row.info.name) + "_std",
               npyList(std::span<const double>(sigmas.data(), static_cast<std::size_t>(sigmas.size()))));
  });
}

template <class State>
void addTiming(const State& state, Arrays& arrays) {
  arrays.add("time_offset_s", npyNumber(state.time_offset_s));
  if (state.time_offset_drift_ppm == 0.0) return;
  arrays.add("time_offset_drift_ppm", npyNumber(state.time_offset_drift_ppm));
  arrays.add("time_offset_at_s", npyNumber(state.time_offset_at_s));
}

void addNumpyCamera(const RigCamera& camera, const CameraState& state, const CameraUncertainty& uncertainty,
                    Arrays& arrays) {
  const CameraIntrinsics& own = camera.intrinsics;
  arrays.setSensor(camera.file_name);
  arrays.add("stream", npyText(camera.stream));
  arrays.add("model", npyText(cameraModelName(own.model)));
  arrays.add("K", npyMatrix(cameraMatrix(own)));
  arrays.add("D", npyList(distortionOf(own, coefficientCount(own.model))));
  arrays.add("resolution",
             npyList(std::array<std::int64_t, 2>{own.resolution_px.width_px, own.resolution_px.height_px}));
  arrays.add("T_ref_cam", npyMatrix(matrixOf(camera.reference_from_camera)));
  addTiming(state, arrays);
  addSigmas(kCameraQuantities, uncertainty, arrays);
}

void addImu(const RigImu& imu, const ImuUncertainty& uncertainty, Arrays& arrays) {
  const ImuState& state = imu.state;
  arrays.setSensor(imu.file_name);
  arrays.add("stream", npyText(imu.stream));
  arrays.add("T_ref_imu", npyMatrix(matrixOf(state.reference_from_imu)));
  addTiming(state, arrays);
  arrays.add("accelerometer_M", npyMatrix(state.accelerometer_scale_misalignment));
  arrays.add("gyroscope_M", npyMatrix(state.gyroscopeMatrix()));
  arrays.add("accelerometer_bias_m_s2", state.accelerometer_bias_m_s2);
  arrays.add("gyroscope_bias_rad_s", state.gyroscope_bias_rad_s);
  arrays.addKnown("accelerometer_delay_s", state.accelerometer_delay_s);
  arrays.addKnown("accelerometer_noise_density", imu.noise.accelerometer_density);
  arrays.addKnown("gyroscope_noise_density", imu.noise.gyroscope_density);
  arrays.addKnown("accelerometer_random_walk", imu.noise.accelerometer_random_walk);
  arrays.addKnown("gyroscope_random_walk", imu.noise.gyroscope_random_walk);
  arrays.addKnown("rate_hz", imu.rate_hz);
  addSigmas(kImuQuantities, uncertainty, arrays);
}

void addCovariance(const NamedResult& named, Arrays& arrays) {
  if (named.result->uncertainty.columns.empty()) return;
  std::vector<std::string> names = columnNames(named);
  for (std::string& name : names) name = printable(name);
  arrays.add("covariance_names", npyList(names));
  arrays.add("covariance", npyMatrix(named.result->uncertainty.covariance()));
}

template <class Sensors>
std::string numpyNamesOf(const Sensors& sensors) {
  std::vector<std::string> names;
  for (const auto& sensor : sensors) names.push_back(sensor.file_name);
  return npyList(names);
}

}  // namespace

ExportedFiles exportNumpy(const NamedResult& result) {
  const Rig rig = rigOf(result);
  const UncertaintyReport& uncertainty = result.result->uncertainty;
  const bool inertial = !rig.imus.empty();
  Arrays arrays;
  arrays.add("program", npyText(rig.program));
  arrays.add("status", npyText(rig.status));
  arrays.add("notes", npyList(rig.timing));
  arrays.add("cameras", numpyNamesOf(rig.cameras));
  arrays.add("imus", numpyNamesOf(rig.imus));
  std::string reference = inertial ? rig.imus.front().file_name : rig.cameras.front().file_name;
  for (const RigCamera& camera : rig.cameras)
    if (!inertial && camera.name == printable(result.reference)) reference = camera.file_name;
  arrays.add("reference", npyText(reference));
  if (inertial) arrays.add("gravity_m_s2", rig.gravity_m_s2);
  addCovariance(result, arrays);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    addNumpyCamera(rig.cameras[i], result.result->state.cameras[i], elementOrNone(uncertainty.cameras, i),
                   arrays);
  for (const RigImu& imu : rig.imus) {
    const auto named =
        std::find_if(result.imus.begin(), result.imus.end(),
                     [&](const SensorDescription& each) { return printable(each.name) == imu.name; });
    addImu(imu, elementOrNone(uncertainty.imus, static_cast<std::size_t>(named - result.imus.begin())),
           arrays);
  }
  ExportedFiles exported;
  exported.files.push_back({"calibration.npz", arrays.file()});
  exported.files.push_back(
      {"README.txt",
       readMe(rig, {"calibration.npz is for numpy.load, without pickles; docs/exports.md of "
                    "Evical explains its keys.",
                    "T_ref_cam transforms points of the camera to the sensor `reference`; t_ref = "
                    "t_sensor + time_offset_s.",
                    "measured = M true + bias, for accelerometer and gyroscope."})});
  return exported;
}

}  // namespace evical
