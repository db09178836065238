#include "core/recording/ros_message.h"

#include "core/recording/rosbag_format.h"

namespace evical {
namespace {

constexpr std::uint32_t kSecond_ns = 1'000'000'000;
constexpr std::size_t kCovarianceSize = 9 * sizeof(double);

struct Header {
  std::int64_t stamp_ns = 0;
};

bool readHeader(ByteReader& reader, Header& header) {
  std::uint32_t sequence = 0, seconds = 0, nanoseconds = 0;
  Bytes frame;
  if (!reader.read(sequence) || !reader.read(seconds) || !reader.read(nanoseconds) ||
      !reader.takeSized(frame))
    return false;
  header.stamp_ns = std::int64_t{seconds} * kSecond_ns + nanoseconds;
  return nanoseconds < kSecond_ns;
}

// Sizes beyond 65536 can't be meant: coordinates are u16.
bool readResolution(ByteReader& reader, Resolution& resolution) {
  std::uint32_t height = 0, width = 0;
  if (!reader.read(height) || !reader.read(width)) return false;
  if (height <= 65536 && width <= 65536) resolution = {static_cast<int>(width), static_cast<int>(height)};
  return true;
}

bool readVector(ByteReader& reader, Eigen::Vector3d& vector) {
  return reader.read(vector.x()) && reader.read(vector.y()) && reader.read(vector.z());
}

void appendHeader(std::vector<std::uint8_t>& bytes, std::uint32_t sequence, std::int64_t stamp_ns,
                  std::string_view frame) {
  appendLittleEndian(bytes, sequence);
  appendBagTime(bytes, stamp_ns);
  appendSized(bytes, bytesOf(frame));
}

void appendVector(std::vector<std::uint8_t>& bytes, const Eigen::Vector3d& vector) {
  for (const double value : vector) appendLittleEndian(bytes, value);
}

// -1 in a covariance's first element: "this quantity isn't measured"; zeros: "covariance not known".
void appendCovariance(std::vector<std::uint8_t>& bytes, double first) {
  appendLittleEndian(bytes, first);
  bytes.insert(bytes.end(), kCovarianceSize - sizeof(double), 0);
}

}  // namespace

std::optional<EventArrayView> parseEventArray(Bytes message) {
  ByteReader reader(message);
  Header header;
  EventArrayView view;
  std::uint32_t count = 0;
  if (!readHeader(reader, header) || !readResolution(reader, view.resolution_px) || !reader.read(count))
    return std::nullopt;
  if (reader.remaining() != std::size_t{count} * kRosEventSize ||
      !reader.take(reader.remaining(), view.events))
    return std::nullopt;
  view.stamp_ns = header.stamp_ns;
  return view;
}

bool decodeEvents(const std::uint8_t* bytes, std::size_t count, Event* events) {
  std::uint32_t largest_ns = 0;
  for (std::size_t i = 0; i < count; ++i, bytes += kRosEventSize) {
    const auto seconds = loadLittleEndian<std::uint32_t>(bytes + 4);
    const auto nanoseconds = loadLittleEndian<std::uint32_t>(bytes + 8);
    largest_ns = nanoseconds > largest_ns ? nanoseconds : largest_ns;
    events[i] = {std::int64_t{seconds} * kSecond_ns + nanoseconds, loadLittleEndian<std::uint16_t>(bytes),
                 loadLittleEndian<std::uint16_t>(bytes + 2), bytes[12] != 0};
  }
  return largest_ns < kSecond_ns;
}

std::optional<ImuSample> parseImu(Bytes message) {
  ByteReader reader(message);
  Header header;
  Bytes skipped;
  ImuSample sample;
  const bool whole = readHeader(reader, header) &&
                     reader.take(4 * sizeof(double) + kCovarianceSize, skipped) &&
                     readVector(reader, sample.angular_rate_rad_s) && reader.take(kCovarianceSize, skipped) &&
                     readVector(reader, sample.specific_force_m_s2) && reader.take(kCovarianceSize, skipped);
  if (!whole || reader.remaining() != 0) return std::nullopt;
  sample.time_ns = header.stamp_ns;
  return sample;
}

std::optional<Resolution> parseResolution(Bytes message) {
  ByteReader reader(message);
  Header header;
  Resolution resolution;
  if (!readHeader(reader, header) || !readResolution(reader, resolution)) return std::nullopt;
  return resolution;
}

void appendEventArray(std::vector<std::uint8_t>& bytes, std::uint32_t sequence, std::string_view frame,
                      Resolution resolution, EventSpan events) {
  appendHeader(bytes, sequence, events.empty() ? 0 : events.front().time_ns, frame);
  appendLittleEndian(bytes, static_cast<std::uint32_t>(resolution.height_px));
  appendLittleEndian(bytes, static_cast<std::uint32_t>(resolution.width_px));
  appendLittleEndian(bytes, static_cast<std::uint32_t>(events.size()));
  for (const Event& event : events) {
    appendLittleEndian(bytes, event.x_px);
    appendLittleEndian(bytes, event.y_px);
    appendBagTime(bytes, event.time_ns);
    bytes.push_back(event.brighter ? 1 : 0);
  }
}

void appendImu(std::vector<std::uint8_t>& bytes, std::uint32_t sequence, std::string_view frame,
               const ImuSample& sample) {
  appendHeader(bytes, sequence, sample.time_ns, frame);
  for (const double value : {0.0, 0.0, 0.0, 1.0})
    appendLittleEndian(bytes, value);  // orientation, not measured
  appendCovariance(bytes, -1.0);
  appendVector(bytes, sample.angular_rate_rad_s);
  appendCovariance(bytes, 0.0);
  appendVector(bytes, sample.specific_force_m_s2);
  appendCovariance(bytes, 0.0);
}

}  // namespace evical
