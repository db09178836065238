#include "core/pipeline/simulate/drive_simulation.h"

#include "core/base/atomic_file.h"
#include "core/base/file_places.h"
#include "core/export/export_target.h"
#include "core/numerics/angles.h"
#include "core/recording/recording_writer.h"
#include "core/synthetic/drive_simulator.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace evical {
namespace {

ImuUncertainty sigmasOfCalibration(bool reference) {
  ImuUncertainty sigma;
  if (!reference) {
    sigma.rotation_std_rad.setConstant(0.01 * kRadPerDeg);
    sigma.translation_std_m.setConstant(2e-4);
    sigma.time_offset_std_s = 1e-5;
  }
  sigma.gyroscope_bias_std_rad_s.setConstant(2e-5);
  sigma.accelerometer_bias_std_m_s2.setConstant(2e-3);
  const Eigen::Matrix3d upper = Eigen::Matrix3d::Ones().triangularView<Eigen::Upper>();
  sigma.gyroscope_scale_misalignment_std = sigma.accelerometer_scale_misalignment_std = 2e-4 * upper;
  return sigma;
}

// Writes samples in time order, as a recorder does.
void writeSamples(const DriveScenario& scenario, RecordingWriter& writer, SimulationSummary& summary,
                  const RunContext& context) {
  std::vector<std::vector<ImuSample>> samples;
  for (std::size_t i = 0; i < scenario.imus.size(); ++i) {
    samples.push_back(simulateDriveImu(scenario, i));
    summary.imu_samples += samples.back().size();
    context.throwIfStopped();
  }
  constexpr std::int64_t kPart_ns = 10'000'000;
  std::vector<std::size_t> next(samples.size(), 0);
  std::uint64_t written = 0;
  for (std::int64_t until_ns = scenario.start_ns; written < summary.imu_samples; until_ns += kPart_ns) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const std::size_t begin = next[i];
      while (next[i] < samples[i].size() && samples[i][next[i]].time_ns <= until_ns) ++next[i];
      if (next[i] > begin)
        writer.write(i, std::span<const ImuSample>(samples[i]).subspan(begin, next[i] - begin));
      written += next[i] - begin;
    }
    context.throwIfStopped();
    context.progress.stageProgress(static_cast<double>(written) / static_cast<double>(summary.imu_samples));
  }
  writer.finish();
}

}  // namespace

NamedResult calibrationBefore(const DriveScenario& scenario) {
  NamedResult named;
  CalibrationResult result;
  named.reference = scenario.imus.front().name;
  for (const SimulatedImu& imu : scenario.imus) {
    SensorDescription known{imu.name, imu.stream};
    known.noise = {imu.gyroscope_density, imu.accelerometer_density, imu.gyroscope_walk,
                   imu.accelerometer_walk};
    known.rate_hz = imu.rate_hz;
    named.imus.push_back(known);
    result.uncertainty.imus.push_back(sigmasOfCalibration(result.state.imus.empty()));
    result.state.imus.push_back(imu);
  }
  result.imus.resize(scenario.imus.size());
  result.state.gravity_in_world_m_s2 = {0.0, 0.0, -scenario.gravity_m_s2};
  named.result = std::make_shared<const CalibrationResult>(std::move(result));
  return named;
}

SimulationSummary simulateDrive(const DriveScenario& scenario, const std::filesystem::path& folder,
                                const RunContext& context, const std::string& format_name) {
  const RecordingFormat& format = recordingFormat(format_name.empty() ? "bag" : format_name);
  std::vector<StreamInfo> streams;
  for (const SimulatedImu& imu : scenario.imus) {
    StreamInfo& stream = streams.emplace_back();
    stream.name = imu.stream;
    stream.type = StreamType::Imu;
  }
  const NewFolder new_folder(folder);
  SimulationSummary summary;
  summary.recording = format.isFolder() ? folder : folder / (std::string("recording") + format.extension);
  summary.session = folder / "calibration" / "result.yaml";
  summary.truth = folder / "truth.yaml";
  context.progress.stageStarted("simulate");
  NamedResult before = calibrationBefore(scenario);
  {
    const auto writer = createRecording(summary.recording, format.name, streams);
    const std::vector<std::string> names = writer->streamNames();
    for (std::size_t i = 0; i < names.size(); ++i) before.imus[i].stream = names[i];
    writeSamples(scenario, *writer, summary, context);
  }
  std::vector<FileContent> files;
  if (const std::string trajectory = driveTrajectoryCsv(scenario); !trajectory.empty())
    files.push_back({"trajectory.csv", trajectory});
  files.push_back({std::filesystem::path("calibration") / "result.yaml", resultYaml(before)});
  files.push_back({"truth.yaml", driveTruthYaml(scenario)});
  writeExportedFiles(folder, files);
  return summary;
}

}  // namespace evical
