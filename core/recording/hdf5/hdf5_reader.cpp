#include "core/recording/hdf5/hdf5_reader.h"

#include "core/recording/hdf5/hdf5_layouts.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <system_error>
#include <utility>

namespace evical {
namespace {

constexpr const char* kImuText = "imu_data.txt";

// "events_left" of "mocap-desk-events_left.h5"; empty for other files.
std::string cameraOf(const std::filesystem::path& path) {
  const std::string stem = path.stem().string();
  if (path.extension() != ".h5") return {};
  for (const char* camera : {"events_left", "events_right"})
    if (stem.ends_with(camera)) return camera;
  return {};
}

std::vector<std::filesystem::path> cameraFiles(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (!cameraOf(entry.path()).empty()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

struct Hdf5Reader::Source {
  std::unique_ptr<hdf5::EventTable> events;
  std::unique_ptr<hdf5::ImuTable> imu;
  std::unique_ptr<hdf5::FrameTable> frames;
  std::size_t stream = 0;
  bool wanted = true, finished = false;
  std::uint64_t row = 0;
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
  std::vector<Event> rest;  // after a large step back in time
  EventOrder order;
};

bool isTumVieFolder(const std::filesystem::path& folder) {
  return !cameraFiles(folder).empty();
}

bool hasTumVieImu(const std::filesystem::path& folder) {
  return std::filesystem::is_regular_file(folder / kImuText);
}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path, ColumnNames names) : names_(std::move(names)) {
  const hdf5::Quiet quiet;
  if (!std::filesystem::is_directory(path)) {
    addFile(path, "");
    return;
  }
  for (const std::filesystem::path& file : cameraFiles(path)) addFile(file, cameraOf(file));
  if (std::filesystem::exists(path / kImuText)) addImuText(path / kImuText);
}

Hdf5Reader::~Hdf5Reader() = default;

void Hdf5Reader::addFile(const std::filesystem::path& path, const std::string& camera) {
  const hdf5::Handle file = hdf5::openFile(path);
  hdf5::FoundStreams all = hdf5::findStreams(file, path.string(), names_);
  for (const std::string& problem : all.problems) addFault("", FaultKind::Corrupt, problem);
  for (hdf5::FoundStream& found : all.streams) {
    auto source = std::make_unique<Source>();
    source->events = std::move(found.events);
    source->imu = std::move(found.imu);
    source->frames = std::move(found.frames);
    source->wanted = !source->frames;  // frames are not read by default
    source->stream = streams_.size();
    if (!camera.empty() && found.info.type == StreamType::Events) found.info.name = camera;
    streams_.push_back(found.info);
    const std::string problem = source->events   ? source->events->takeProblem()
                                : source->imu    ? source->imu->takeProblem()
                                : source->frames ? source->frames->takeProblem()
                                                 : std::string();
    noteProblem(*source, problem);
    if (source->events && !source->events->note().empty())
      addFault(streams_.back().name, FaultKind::Guess, source->events->note());
    sources_.push_back(std::move(source));
  }
}

void Hdf5Reader::addImuText(const std::filesystem::path& path) {
  auto source = std::make_unique<Source>();
  source->imu = hdf5::openImuText(path);
  source->stream = streams_.size();
  StreamInfo info;
  info.name = "imu";
  info.type = StreamType::Imu;
  info.message = "t, gyro, acc, temperature";
  info.time_unit_ns = 1000;
  streams_.push_back(info);
  sources_.push_back(std::move(source));
}

void Hdf5Reader::select(const std::vector<std::size_t>& streams) {
  for (const auto& source : sources_) source->wanted = false;
  for (const std::size_t stream : streams) sources_.at(stream)->wanted = true;
}

// The stream with the earliest time is read first, so that all advance together.
bool Hdf5Reader::read(Packet& packet) {
  const hdf5::Quiet quiet;
  for (;;) {
    Source* behind = nullptr;
    for (const auto& source : sources_) {
      const bool runs =
          source->wanted && !source->finished && (source->events || source->imu || source->frames);
      if (runs && (!behind || source->last_ns < behind->last_ns)) behind = source.get();
    }
    packet.clear();
    if (!behind) return false;
    if (fill(*behind, packet)) return true;
  }
}

bool Hdf5Reader::fill(Source& source, Packet& packet) {
  packet.stream = source.stream;
  if (source.events) return fillEvents(source, packet.events);
  if (source.frames) return fillFrames(source, packet.frames);
  source.imu->load(packet.imu_samples);
  noteProblem(source, source.imu->takeProblem());
  source.finished = packet.imu_samples.empty();
  if (!source.finished) source.last_ns = packet.imu_samples.back().time_ns;
  return !source.finished;
}

bool Hdf5Reader::fillEvents(Source& source, std::vector<Event>& events) {
  if (!source.rest.empty()) {
    std::swap(events, source.rest);
    source.rest.clear();
  } else if (source.row < source.events->rows()) {
    source.row = source.events->load(source.row, events);
    noteProblem(source, source.events->takeProblem());
  } else {
    source.finished = true;
    noteOrder(source);
  }
  if (events.empty()) return false;
  source.order.split(events, source.rest);
  source.last_ns = events.back().time_ns;
  return true;
}

bool Hdf5Reader::fillFrames(Source& source, std::vector<Frame>& frames) {
  if (source.row >= source.frames->rows()) {
    source.finished = true;
    return false;
  }
  Frame& frame = frames.emplace_back();
  const bool good = source.frames->load(source.row++, frame);
  noteProblem(source, source.frames->takeProblem());
  if (good) source.last_ns = frame.time_ns;
  return good;
}

void Hdf5Reader::noteProblem(const Source& source, const std::string& problem) {
  if (problem.empty()) return;
  addFault(streams_[source.stream].name, FaultKind::Corrupt,
           fmt::format("Some rows are left out: {}.", problem));
}

void Hdf5Reader::noteOrder(const Source& source) {
  if (source.order.changedAnything())
    addFault(streams_[source.stream].name, FaultKind::Unsorted, source.order.text());
}

// Fraction of the rows that are read. The IMU's text file is not counted: its length is unknown, and it is
// short.
double Hdf5Reader::fractionRead() const {
  double read = 0.0, rows = 0.0;
  for (const auto& source : sources_) {
    if (!source->wanted || (!source->events && !source->frames)) continue;
    read += static_cast<double>(source->row);
    rows += static_cast<double>(source->events ? source->events->rows() : source->frames->rows());
  }
  return rows == 0.0 ? 1.0 : read / rows;
}

void Hdf5Reader::addFault(const std::string& stream, FaultKind kind, std::string text) {
  const auto alike = [&](const RecordingFault& fault) {
    return fault.stream == stream && fault.kind == kind;
  };
  if (std::count_if(faults_.begin(), faults_.end(), alike) < kMostAlikeFaults)
    faults_.push_back({stream, kind, 0.0, std::move(text)});
}

}  // namespace evical
