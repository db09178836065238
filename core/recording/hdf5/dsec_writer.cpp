// HDF5 in DSEC's layout: events/{x, y, p, t}, t in us since t_offset, ms_to_idx with the first event of each
// millisecond; Blosc with zstd. DSEC has its IMU in other files; here it is a group as in M3ED, imu/{ts,
// omega, accel}: us of the same clock, including t_offset.
#include "core/base/error.h"
#include "core/base/time.h"
#include "core/recording/hdf5/hdf5_filters.h"
#include "core/recording/recording_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

namespace evical {
namespace {

constexpr hsize_t kEventChunk = 65'536, kImuChunk = 1'024;

// A dataset that grows at its end, chunk by chunk. Why it cannot be written is put into `problem`: the
// library forgets it when the next handle is closed.
template <class Number>
class GrowingDataset {
 public:
  GrowingDataset(hid_t file, std::string& problem, const char* path, hid_t type, hsize_t chunk_rows,
                 hsize_t columns = 1)
      : type_(type),
        chunk_rows_(chunk_rows),
        columns_(columns),
        rank_(columns == 1 ? 1 : 2),
        problem_(problem) {
    const std::array<hsize_t, 2> none{0, columns}, most{H5S_UNLIMITED, columns}, chunk{chunk_rows, columns};
    const hdf5::Handle space(H5Screate_simple(rank_, none.data(), most.data()), H5Sclose);
    const hdf5::Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(creation, rank_, chunk.data());
    hdf5::setBlosc(creation, sizeof(Number), sizeof(Number) * chunk_rows * columns);
    const hdf5::Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links, 1);
    dataset_ = hdf5::Handle(H5Dcreate2(file, path, type, space, links, creation, H5P_DEFAULT), H5Dclose);
  }

  bool valid() const { return dataset_.valid(); }

  bool add(Number number) {
    buffer_.push_back(number);
    return buffer_.size() < chunk_rows_ * columns_ || flush();
  }

  bool flush() {
    const hsize_t rows = buffer_.size() / columns_;
    if (rows == 0) return true;
    const std::array<hsize_t, 2> start{rows_, 0}, count{rows, columns_}, extent{rows_ + rows, columns_};
    if (H5Dset_extent(dataset_, extent.data()) < 0) {
      problem_ = hdf5::lastProblem();
      return false;
    }
    const hdf5::Handle file_space(H5Dget_space(dataset_), H5Sclose);
    const hdf5::Handle memory_space(H5Screate_simple(rank_, count.data(), nullptr), H5Sclose);
    H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
    const bool written =
        H5Dwrite(dataset_, type_, memory_space, file_space, H5P_DEFAULT, buffer_.data()) >= 0;
    if (!written) problem_ = hdf5::lastProblem();
    rows_ += rows;
    buffer_.clear();
    return written;
  }

 private:
  hdf5::Handle dataset_;
  hid_t type_;
  hsize_t chunk_rows_, columns_, rows_ = 0;
  int rank_;
  std::string& problem_;
  std::vector<Number> buffer_;
};

class DsecWriter : public RecordingWriter {
 public:
  DsecWriter(const std::filesystem::path& path, const std::vector<StreamInfo>& streams)
      : path_(path.string()), part_(path) {
    const hdf5::Quiet quiet;
    for (const StreamInfo& stream : streams) types_.push_back(stream.type);
    for (const StreamInfo& stream : streams) requireOnly(stream);
    hdf5::registerFilters();
    file_ =
        hdf5::Handle(H5Fcreate(part_.partPath().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    require(file_.valid());
    for (const StreamInfo& stream : streams) {
      if (stream.type == StreamType::Events) addEvents(stream.resolution_px);
      if (stream.type == StreamType::Imu) imu_.emplace(file_, problem_);
    }
  }

  ~DsecWriter() override {
    const hdf5::Quiet quiet;
    events_.reset();
    imu_.reset();
    file_.reset();
  }

  void write(std::size_t stream, EventSpan events) override {
    const hdf5::Quiet quiet;
    requireType(stream, StreamType::Events);
    for (const Event& event : events) {
      const std::int64_t time_us = nearestMicrosecond(event.time_ns);
      if (!offset_us_) offset_us_ = time_us;
      const std::int64_t since_us = time_us - *offset_us_;
      if (since_us < 0 || since_us > std::numeric_limits<std::uint32_t>::max()) {
        throw calibrationFailed(path_, fmt::format("an event is {} us after the first", since_us),
                                "DSEC's layout covers 2^32 us, and nothing before the first event");
      }
      // First event at or after each millisecond.
      for (; millisecond_ * 1000 <= since_us; ++millisecond_) require(events_->milliseconds.add(count_));
      require(events_->x.add(event.x_px) && events_->y.add(event.y_px) &&
              events_->t.add(static_cast<std::uint32_t>(since_us)) && events_->p.add(event.brighter ? 1 : 0));
      ++count_;
    }
  }

  void write(std::size_t stream, std::span<const ImuSample> samples) override {
    const hdf5::Quiet quiet;
    requireType(stream, StreamType::Imu);
    for (const ImuSample& sample : samples) {
      bool good = imu_->ts.add(nearestMicrosecond(sample.time_ns));
      for (const double value : sample.angular_rate_rad_s) good = imu_->omega.add(value) && good;
      for (const double value : sample.specific_force_m_s2) good = imu_->accel.add(value) && good;
      require(good);
    }
  }

  // Groups of the layout.
  std::vector<std::string> streamNames() const override {
    std::vector<std::string> names;
    for (const StreamType type : types_) names.emplace_back(type == StreamType::Events ? "events" : "imu");
    return names;
  }

  void finish() override {
    const hdf5::Quiet quiet;
    if (events_) {
      require(events_->x.flush() && events_->y.flush() && events_->t.flush() && events_->p.flush() &&
              events_->milliseconds.flush());
      writeOffset();
    }
    if (imu_) require(imu_->ts.flush() && imu_->omega.flush() && imu_->accel.flush());
    require(H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0);  // closing a dataset would not report an error
    events_.reset();
    imu_.reset();
    require(H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0);
    file_.reset();
    part_.finish();
  }

 private:
  struct Events {
    Events(hid_t file, std::string& problem)
        : x(file, problem, "events/x", H5T_NATIVE_UINT16, kEventChunk),
          y(file, problem, "events/y", H5T_NATIVE_UINT16, kEventChunk),
          p(file, problem, "events/p", H5T_NATIVE_UINT8, kEventChunk),
          t(file, problem, "events/t", H5T_NATIVE_UINT32, kEventChunk),
          milliseconds(file, problem, "ms_to_idx", H5T_NATIVE_UINT64, kImuChunk) {}
    GrowingDataset<std::uint16_t> x, y;
    GrowingDataset<std::uint8_t> p;
    GrowingDataset<std::uint32_t> t;
    GrowingDataset<std::uint64_t> milliseconds;
  };
  struct Imu {
    Imu(hid_t file, std::string& problem)
        : ts(file, problem, "imu/ts", H5T_NATIVE_INT64, kImuChunk),
          omega(file, problem, "imu/omega", H5T_NATIVE_DOUBLE, kImuChunk, 3),
          accel(file, problem, "imu/accel", H5T_NATIVE_DOUBLE, kImuChunk, 3) {}
    GrowingDataset<std::int64_t> ts;
    GrowingDataset<double> omega, accel;
  };

  void requireOnly(const StreamInfo& stream) const {
    if (stream.type != StreamType::Events && stream.type != StreamType::Imu) {
      throw badInput(path_, fmt::format("stream {} has neither events nor IMU samples", stream.name));
    }
    if (std::count(types_.begin(), types_.end(), stream.type) > 1) {
      throw badInput(path_, "DSEC's layout has one camera and one IMU per file",
                     "Write one file for each, or a bag");
    }
  }

  void addEvents(const Resolution& size_px) {
    events_.emplace(file_, problem_);
    require(events_->x.valid() && events_->milliseconds.valid());
    if (!size_px.known()) return;
    const hdf5::Handle group(H5Gopen2(file_, "events", H5P_DEFAULT), H5Gclose);
    const hdf5::Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
    const auto side = [&](const char* name, std::int32_t value) {
      const hdf5::Handle attribute(H5Acreate2(group, name, H5T_STD_I32LE, scalar, H5P_DEFAULT, H5P_DEFAULT),
                                   H5Aclose);
      require(H5Awrite(attribute, H5T_NATIVE_INT32, &value) >= 0);
    };
    side("width", size_px.width_px);
    side("height", size_px.height_px);
  }

  void writeOffset() {
    const std::int64_t offset_us = offset_us_.value_or(0);
    const hdf5::Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
    const hdf5::Handle dataset(
        H5Dcreate2(file_, "t_offset", H5T_STD_I64LE, scalar, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    require(H5Dwrite(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &offset_us) >= 0);
  }

  void requireType(std::size_t stream, StreamType type) const {
    if (types_.at(stream) != type)
      throw calibrationFailed(path_, fmt::format("stream {} was given samples of another type", stream));
  }

  void require(bool good) const {
    if (good) return;
    throw calibrationFailed(
        path_,
        fmt::format("the file cannot be written: {}", problem_.empty() ? hdf5::lastProblem() : problem_),
        "Check the folder, its permissions and the disk space");
  }

  std::string path_, problem_;
  PartFile part_;  // renames the file when it is complete; HDF5 writes the content
  hdf5::Handle file_;
  std::vector<StreamType> types_;
  std::optional<Events> events_;
  std::optional<Imu> imu_;
  std::optional<std::int64_t> offset_us_;
  std::int64_t millisecond_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace

std::unique_ptr<RecordingWriter> createDsec(const std::filesystem::path& path,
                                            const std::vector<StreamInfo>& streams) {
  return std::make_unique<DsecWriter>(path, streams);
}

}  // namespace evical
