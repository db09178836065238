#include "core/pipeline/pass/pass_input.h"

#include "core/initialisation/initialisation_options.h"
#include "core/optimisation/optimisation_options.h"

#include <Eigen/LU>

#include <cstddef>
#include <utility>

namespace evical {
namespace {

// Fixes time offsets in the initialisation that are fixed in the batch.
void holdTimeOffsets(CalibrationInput& input) {
  for (std::size_t k = 0; k < input.cameras.size(); ++k)
    if (!input.isReferenceCamera(k))
      input.cameras[k].prior.time_offset = heldTimeOffset(input.cameras[k].prior);
  for (std::size_t k = 0; k < input.imus.size(); ++k)
    if (k != input.reference_imu) input.imus[k].prior.time_offset = heldTimeOffset(input.imus[k].prior);
}

}  // namespace

CalibrationInput makeInput(const Session& session, DetectionResult& pass) {
  CalibrationInput input;
  input.start_ns = pass.start_ns;
  input.board_name = session.board_name;
  input.board = session.board;
  input.further_boards.assign(session.further_boards.begin(), session.further_boards.end());
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    const SessionCamera& camera = session.cameras[k];
    input.cameras.push_back(
        {camera.name, pass.lenses.at(k), std::move(pass.cameras[k]), camera.prior, camera.shutter});
    if (const std::size_t sensor = session.sensorOf(k); sensor != k)
      input.cameras.back().same_sensor_as = sensor;
    input.cameras.back().board = session.boardIndexOf(k);
  }
  input.imus = std::move(pass.imus);
  for (std::size_t k = 0; k < session.imus.size(); ++k) input.imus[k].prior = session.imus[k].prior;
  input.reference_imu = session.referenceImu();
  input.reference_camera = session.referenceCamera();
  input.gravity_norm_m_s2 = session.options.initialisation->gravity_m_s2;
  if (!session.options.optimisation->free_time_offsets) holdTimeOffsets(input);
  return input;
}

StatedSigns statedSigns(const Session& session) {
  StatedSigns stated;
  for (const SessionCamera& camera : session.cameras) stated.mirroring.push_back(camera.mirrored);
  for (const SessionImu& imu : session.imus) {
    Eigen::Matrix3d axes;
    for (Eigen::Index i = 0; i < 3; ++i)
      axes.col(i) = readAs(imu.accelerometer_axes, Eigen::Vector3d::Unit(i));
    const double unit = metresPerSecond2(imu.acceleration_unit.value_or(AccelerationUnit::Gravity));
    stated.inverted_forces.push_back(unit * axes.determinant() < 0.0);
  }
  return stated;
}

void restorePass(CalibrationInput input, DetectionResult& pass) {
  if (input.cameras.empty()) return;
  for (std::size_t k = 0; k < input.cameras.size(); ++k)
    pass.cameras[k] = std::move(input.cameras[k].observations);
  pass.imus = std::move(input.imus);
  for (ImuData& imu : pass.imus) imu.prior = {};
}

}  // namespace evical
