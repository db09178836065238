// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/ui/simulated_session.h"

#include "core/base/atomic_file.h"
#include "core/numerics/angles.h"
#include "core/pipeline/session/session.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/recording/recording_writer.h"
#include "core/synthetic/event_simulator.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/simulated_recording.h"
#include "tests/support/test_folders.h"

#include <QFile>

#include <Eigen/Geometry>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace evical::ui::test {
namespace {

Scenario scenario(const char* name, double duration_s) {
  Scenario read = readScenario(evical::test::scenarioPath(name));
  read.duration_s = duration_s;
  return read;
}

Scenario twoCameras() {
  Scenario rig = scenario("davis346", 4.0);
  SimulatedCamera right = rig.cameras.front();
  right.name = "right";
  right.stream = "/davis_right/events";
  right.imu_from_camera =
      right.imu_from_camera * RigidTransform{Eigen::Quaterniond::Identity(), {0.1, 0.0, 0.0}};
  right.time_offset_s -= 0.003;
  rig.cameras.push_back(right);
  return rig;
}

StreamInfo streamInfo(const std::string& name, StreamType type, Resolution resolution_px = {}) {
  StreamInfo info;
  info.name = name;
  info.type = type;
  info.resolution_px = resolution_px;
  return info;
}

// The IMU of the first camera.
void writeBag(const Scenario& rig, std::size_t camera, const std::filesystem::path& file) {
  const SimulatedCamera& own = rig.cameras[camera];
  std::vector<StreamInfo> streams = {
      streamInfo(own.stream, StreamType::Events, own.intrinsics.resolution_px)};
  std::vector<ImuSample> samples;
  if (camera == 0) {
    streams.push_back(streamInfo(rig.imus.front().stream, StreamType::Imu));
    samples = simulateImu(rig, 0);
  }
  const auto writer = createBag(file, streams, false);
  std::span<const ImuSample> left(samples);
  simulateEvents(rig, camera, [&](EventSpan events) {
    if (events.empty()) return;
    std::size_t due = 0;
    while (due < left.size() && left[due].time_ns <= events.back().time_ns) ++due;
    if (due > 0) writer->write(1, left.first(due));
    left = left.subspan(due);
    writer->write(0, events);
  });
  writer->finish();
}

void simulateTwoCameras(const std::filesystem::path& folder) {
  const Scenario rig = twoCameras();
  for (std::size_t k = 0; k < rig.cameras.size(); ++k)
    writeBag(rig, k, folder / (rig.cameras[k].name + ".bag"));
  const std::filesystem::path of_one_bag = folder / "of_one_bag.yaml";
  writeFileWhole(of_one_bag, sessionYaml(rig, "left.bag"));
  Session session = readSession(of_one_bag);
  session.cameras[1].recording = folder / "right.bag";
  writeSession(session, folder / "session.yaml");
}

}  // namespace

QString simulatedSession() {
  return QString::fromStdString(evical::test::simulatedRecording("davis346", 4.0).string());
}

QString simulatedHdSession() {
  return QString::fromStdString(evical::test::simulatedRecording("hd", 3.5).string());
}

QString simulatedTwoCameraSession() {
  return QString::fromStdString(evical::test::simulatedOnce("two_cameras", simulateTwoCameras).string());
}

QString simulatedFurtherSession(int number, double turned_deg) {
  constexpr std::int64_t kHour_ns = 3'600'000'000'000;
  const std::string name = QString("further_%1_%2").arg(number).arg(turned_deg).toStdString();
  const auto make = [number, turned_deg](const std::filesystem::path& folder) {
    Scenario rig = scenario("davis346", 6.0);
    rig.seed += static_cast<std::uint64_t>(number);
    rig.start_ns += number * kHour_ns;
    RigidTransform& pose = rig.cameras.front().imu_from_camera;
    pose.rotation = pose.rotation * Eigen::AngleAxisd(kRadPerDeg * turned_deg, Eigen::Vector3d::UnitY());
    simulate(rig, folder, {});
  };
  return QString::fromStdString(evical::test::simulatedOnce(name, make).string());
}

QString copyOfSimulatedSession(const QString& folder) {
  const QString copy = folder + "/session.yaml";
  writeSession(readSession(simulatedSession().toStdString()), copy.toStdString());
  return copy;
}

QString copyWithRecording(const QString& folder) {
  Session session = readSession(simulatedSession().toStdString());
  const QString recording = folder + "/recording.bag";
  QFile::copy(QString::fromStdString(session.recording.string()), recording);
  session.recording = recording.toStdString();
  const QString copy = folder + "/session.yaml";
  writeSession(session, copy.toStdString());
  return copy;
}

}  // namespace evical::ui::test
