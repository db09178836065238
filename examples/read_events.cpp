// Reads the events and IMU samples of a recording of any format and counts them: read_events RECORDING.
#include "core/base/error.h"
#include "core/recording/recording_reader.h"

#include <cstdio>
#include <memory>
#include <vector>

using namespace evical;

namespace {

struct Count {
  std::size_t events = 0, brighter = 0, imu_samples = 0;
};

void countStreams(const char* path) {
  const std::unique_ptr<RecordingReader> reader = openRecording(path);
  std::vector<Count> counts(reader->streams().size());
  Packet packet;  // only one packet is in memory at a time
  while (reader->read(packet)) {
    Count& count = counts[packet.stream];
    count.events += packet.events.size();
    count.imu_samples += packet.imu_samples.size();
    for (const Event& event : packet.events) count.brighter += event.brighter ? 1 : 0;
  }
  std::printf("%s: %s\n", path, reader->format().c_str());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const StreamInfo& stream = reader->streams()[i];
    std::printf("  %s (%s): %zu events, of which %zu are ON; %zu IMU samples\n", stream.name.c_str(),
                streamTypeName(stream.type), counts[i].events, counts[i].brighter, counts[i].imu_samples);
  }
  for (const RecordingFault& fault : reader->faults()) std::printf("  %s\n", fault.text.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "read_events RECORDING\n");
    return 2;
  }
  try {
    countStreams(argv[1]);
    return 0;
  } catch (const CalibrationError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
