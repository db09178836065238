// evical.open, evical.inspect: recordings as NumPy arrays.
#include "core/base/error.h"
#include "core/frames/gray_image.h"
#include "core/recording/inspection.h"
#include "core/recording/recording_server.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/interpreter.h"
#include "python/interruptible.h"
#include "python/open_recording.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>

namespace evical::python {
namespace {

namespace py = pybind11;

struct Stream {
  StreamInfo info;
};

// One packet with its stream's description. Arrays of its data keep it alive.
struct PacketOfStream {
  std::shared_ptr<Packet> packet;
  StreamInfo info;
  std::string path;
};

struct FrameOfPacket {
  std::shared_ptr<Packet> packet;
  std::size_t index = 0;
  std::string place;

  const Frame& frame() const { return packet->frames[index]; }
};

py::dtype eventType() {
  static_assert(sizeof(bool) == 1);
  return recordType({{"t", "<i8", offsetof(Event, time_ns)},
                     {"x", "<u2", offsetof(Event, x_px)},
                     {"y", "<u2", offsetof(Event, y_px)},
                     {"p", "?", offsetof(Event, brighter)}},
                    sizeof(Event));
}

// Eigen's vector consists of three doubles only.
py::dtype imuType() {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double) && std::is_standard_layout_v<RawImuSample>);
  return recordType({{"t", "<i8", offsetof(RawImuSample, time_ns)},
                     {"angular_rate", "(3,)<f8", offsetof(RawImuSample, angular_rate)},
                     {"acceleration", "(3,)<f8", offsetof(RawImuSample, specific_force)}},
                    sizeof(RawImuSample));
}

py::dtype pointType() {
  return recordType({{"t", "<i8", offsetof(MeasuredPoint, time_ns)},
                     {"point", "<i4", offsetof(MeasuredPoint, point)},
                     {"x", "<f4", offsetof(MeasuredPoint, x_px)},
                     {"y", "<f4", offsetof(MeasuredPoint, y_px)},
                     {"sigma", "<f4", offsetof(MeasuredPoint, sigma_px)}},
                    sizeof(MeasuredPoint));
}

// A view of the packet's own memory, which `owner` keeps alive.
template <class Record>
py::array recordsOf(const std::vector<Record>& records, const py::dtype& type, const py::object& owner) {
  return {type, {static_cast<py::ssize_t>(records.size())}, {}, records.data(), owner};
}

py::list framesOf(const PacketOfStream& packet) {
  py::list frames;
  for (std::size_t i = 0; i < packet.packet->frames.size(); ++i)
    frames.append(FrameOfPacket{packet.packet, i, packet.path + ": " + packet.info.name});
  return frames;
}

struct PixelLayout {
  const char *name, *type;
  py::ssize_t channels, bytes;
};
PixelLayout layoutOf(const Frame& frame) {
  switch (frame.format) {
    case FrameFormat::Gray8:
      return {"gray8", "u1", 1, 1};
    case FrameFormat::Gray16:
      return {"gray16", frame.big_endian ? ">u2" : "<u2", 1, 2};
    case FrameFormat::Rgb8:
      return {"rgb8", "u1", 3, 1};
    case FrameFormat::Bgr8:
      return {"bgr8", "u1", 3, 1};
    case FrameFormat::Rgba8:
      return {"rgba8", "u1", 4, 1};
    case FrameFormat::Bgra8:
      return {"bgra8", "u1", 4, 1};
    case FrameFormat::BayerRggb8:
      return {"bayer_rggb8", "u1", 1, 1};
    case FrameFormat::BayerBggr8:
      return {"bayer_bggr8", "u1", 1, 1};
    case FrameFormat::BayerGbrg8:
      return {"bayer_gbrg8", "u1", 1, 1};
    case FrameFormat::BayerGrbg8:
      return {"bayer_grbg8", "u1", 1, 1};
    case FrameFormat::BayerRggb16:
      return {"bayer_rggb16", frame.big_endian ? ">u2" : "<u2", 1, 2};
    case FrameFormat::BayerBggr16:
      return {"bayer_bggr16", frame.big_endian ? ">u2" : "<u2", 1, 2};
    case FrameFormat::BayerGbrg16:
      return {"bayer_gbrg16", frame.big_endian ? ">u2" : "<u2", 1, 2};
    case FrameFormat::BayerGrbg16:
      return {"bayer_grbg16", frame.big_endian ? ">u2" : "<u2", 1, 2};
    case FrameFormat::Encoded:
      break;
  }
  return {"encoded", "u1", 1, 1};
}

py::array brightnessOf(const FrameOfPacket& frame) {
  GrayImage image;
  {
    const OthersWork others_work;
    image = decodeFrame(frame.frame(), frame.place);
  }
  return py::array_t<std::uint8_t>({image.size_px.height_px, image.size_px.width_px}, image.pixels.data());
}

py::array pixelsOf(const py::object& self) {
  const auto& owner = self.cast<const FrameOfPacket&>();
  const Frame& frame = owner.frame();
  if (frame.format == FrameFormat::Encoded) return brightnessOf(owner);
  const PixelLayout layout = layoutOf(frame);
  const py::ssize_t height = frame.size_px.height_px, width = frame.size_px.width_px,
                    pixel_bytes = layout.channels * layout.bytes;
  const auto row_bytes = static_cast<py::ssize_t>(frame.row_bytes);
  if (height <= 0 || width <= 0 || row_bytes < width * pixel_bytes ||
      static_cast<py::ssize_t>(frame.bytes.size()) < (height - 1) * row_bytes + width * pixel_bytes)
    throw badInput(owner.place, "a frame has fewer bytes than its resolution requires", "Record again");
  std::vector<py::ssize_t> shape = {height, width}, strides = {row_bytes, pixel_bytes};
  if (layout.channels > 1) {
    shape.push_back(layout.channels);
    strides.push_back(layout.bytes);
  }
  return {py::dtype(layout.type), shape, strides, frame.bytes.data(), self};
}

py::object resolutionOf(const Resolution& size_px) {
  return size_px.known() ? py::object(py::make_tuple(size_px.width_px, size_px.height_px)) : py::none();
}

constexpr std::chrono::milliseconds kBetweenSignals(50);

// Repeats `attempt`, which waits for its turn without the interpreter's lock; Ctrl-C ends the wait.
template <class Attempt>
auto waitFor(const OpenRecording& recording, const Attempt& attempt) {
  for (;;) {
    decltype(attempt(kBetweenSignals)) done{};
    try {
      const OthersWork others_read;
      done = attempt(kBetweenSignals);
    } catch (const OpenRecording::Closed&) {
      throwClosed(recording.path());
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (done) return done;
  }
}

py::object nextPacket(OpenRecording& recording) {
  std::shared_ptr<Packet> packet =
      *waitFor(recording, [&](std::chrono::milliseconds longest) { return recording.read(longest); });
  if (!packet) return py::none();
  StreamInfo info = recording.stream(packet->stream);
  return py::cast(PacketOfStream{std::move(packet), std::move(info), recording.path()});
}

void closeRecording(OpenRecording& recording) {
  waitFor(recording, [&](std::chrono::milliseconds longest) { return recording.close(longest); });
}

std::shared_ptr<OpenRecording> notClosed(std::shared_ptr<OpenRecording> recording) {
  if (recording->isOfOtherProcess()) static_cast<void>(recording->streams());  // throws
  if (recording->closed()) throwClosed(recording->path());
  return recording;
}

std::shared_ptr<OpenRecording> openForPython(const std::filesystem::path& path,
                                             const std::optional<std::vector<py::str>>& streams) {
  std::optional<std::vector<std::string>> names;
  if (streams) names.emplace();
  for (const py::str& stream : streams.value_or(std::vector<py::str>())) names->push_back(bytesOf(stream));
  const OthersWork others_work;
  return std::make_shared<OpenRecording>(path, names);
}

py::object inspect(const std::filesystem::path& path, const py::object& progress) {
  std::string json;
  RunLog log;
  runInterruptibly(progress, log, [&](const RunContext& context) {
    const std::unique_ptr<RecordingReader> reader = openRecording(pathForReading(path));
    constexpr bool kWithChecksums = true;
    json = inspectionJson(inspectRecording(*reader, {}, context), kWithChecksums);
  });
  return py::module_::import("json").attr("loads")(textOf(json));
}

void bindParts(py::module_& module) {
  py::class_<Stream>(module, "Stream", "One stream of a recording.")
      .def_property_readonly("name", [](const Stream& s) { return identifierOf(s.info.name); })
      .def_property_readonly(
          "type", [](const Stream& s) { return streamTypeName(s.info.type); },
          "events, imu, frames, points, triggers or other.")
      .def_property_readonly(
          "message", [](const Stream& s) { return textOf(s.info.message); },
          "The file's name for the type of data.")
      .def_property_readonly(
          "resolution_px", [](const Stream& s) { return resolutionOf(s.info.resolution_px); },
          "Tuple (width, height) in px; None if the file does not state it.")
      .def_property_readonly(
          "readable", [](const Stream& s) { return s.info.readable; },
          "False: the stream is only listed and cannot be read.")
      .def_property_readonly(
          "acceleration_to_m_s2", [](const Stream& s) { return metresPerSecond2(s.info.acceleration_unit); },
          "Factor that converts `acceleration` of an IMU to m/s^2, according to the format.")
      .def_property_readonly(
          "angular_rate_to_rad_s", [](const Stream& s) { return radiansPerSecond(s.info.angular_rate_unit); },
          "Factor that converts `angular_rate` of an IMU to rad/s, according to the format.")
      .def("__repr__", [](const Stream& s) {
        return textOf(fmt::format("<evical.Stream '{}': {}>", s.info.name, streamTypeName(s.info.type)));
      });
  py::class_<RecordingFault>(module, "Fault", "A damage or an anomaly of a recording.")
      .def_property_readonly(
          "stream", [](const RecordingFault& f) { return identifierOf(f.stream); },
          "Name of the stream; empty: the whole file.")
      .def_property_readonly("kind", [](const RecordingFault& f) { return nameOf(f.kind); })
      .def_readonly("at_s", &RecordingFault::at_s, "Seconds since the stream's first time; 0 if unknown.")
      .def_property_readonly(
          "text", [](const RecordingFault& f) { return textOf(f.text); }, "Description in one sentence.")
      .def("__repr__", [](const RecordingFault& f) {
        return textOf(fmt::format("<evical.Fault {}: {}>", nameOf(f.kind), f.text));
      });
  py::class_<FrameOfPacket>(module, "Frame", "An image of a frame camera.")
      .def_property_readonly(
          "t", [](const FrameOfPacket& f) { return f.frame().time_ns; }, "Timestamp, ns.")
      .def_property_readonly(
          "exposure_s", [](const FrameOfPacket& f) { return f.frame().exposure_s; },
          "Exposure time; 0: unknown.")
      .def_property_readonly(
          "format", [](const FrameOfPacket& f) { return layoutOf(f.frame()).name; },
          "gray8, gray16, rgb8, bgr8, rgba8, bgra8, bayer_rggb8, bayer_bggr8, bayer_gbrg8, bayer_grbg8 or "
          "encoded.")
      .def_property_readonly(
          "image", pixelsOf,
          "Stored pixels without a copy: (height, width) or (height, width, channels), uint8 or uint16. For "
          "encoded images the decoded brightness, uint8.")
      .def_property_readonly("brightness", brightnessOf,
                             "(height, width), uint8: the grey image in which the board is searched.");
}

void bindPacket(py::module_& module) {
  py::class_<PacketOfStream>(module, "Packet",
                             "Consecutive events, IMU samples, frames or points of one stream.")
      .def_property_readonly("stream", [](const PacketOfStream& p) { return Stream{p.info}; })
      .def_property_readonly(
          "events",
          [](const py::object& self) {
            return recordsOf(self.cast<const PacketOfStream&>().packet->events, eventType(), self);
          },
          "(N,) records t [ns, int64], x, y [px, uint16; (0, 0) is top left], p [bool, True: brighter], "
          "sorted by t. A view of the packet's memory. Recording.faults has an entry if packets of a "
          "stream overlap.")
      .def_property_readonly(
          "imu",
          [](const py::object& self) {
            return recordsOf(self.cast<const PacketOfStream&>().packet->imu_samples, imuType(), self);
          },
          "(N,) records t [ns, int64], angular_rate (3,), acceleration (3,) in the recording's units "
          "(Stream.angular_rate_to_rad_s, Stream.acceleration_to_m_s2) and in the IMU's frame. At rest the "
          "acceleration is +g upwards.")
      .def_property_readonly(
          "points",
          [](const py::object& self) {
            return recordsOf(self.cast<const PacketOfStream&>().packet->points, pointType(), self);
          },
          "(N,) records t [ns, int64], point [index], x, y, sigma [px, float32; a sigma of 0: not stated].")
      .def_property_readonly("frames", framesOf, "A list of Frame.")
      .def("__len__",
           [](const PacketOfStream& p) {
             return p.packet->events.size() + p.packet->imu_samples.size() + p.packet->points.size() +
                    p.packet->frames.size();
           })
      .def("__repr__", [](const PacketOfStream& p) {
        return textOf(fmt::format("<evical.Packet of '{}', {}>", p.info.name, streamTypeName(p.info.type)));
      });
}

}  // namespace

void bindRecording(py::module_& module) {
  bindParts(module);
  bindPacket(module);
  py::class_<OpenRecording, std::shared_ptr<OpenRecording>>(
      module, "Recording",
      "An open recording. Iterate over its packets once, then close it, or use `with`. Only one packet is "
      "in memory at a time. Threads may share a recording; each packet goes to one of them.")
      .def("__enter__", notClosed)
      .def("__exit__", [](OpenRecording& r, const py::args&) { closeRecording(r); })
      .def("close", closeRecording, "Closes the file; arrays remain valid. A second call does nothing.")
      .def_property_readonly("closed", &OpenRecording::closed)
      .def("__iter__", notClosed)
      .def("__next__",
           [](OpenRecording& r) {
             py::object packet = nextPacket(r);
             if (packet.is_none()) throw py::stop_iteration();
             return packet;
           })
      .def_property_readonly("format", &OpenRecording::format)
      .def_property_readonly(
          "streams",
          [](const OpenRecording& r) {
            std::vector<Stream> streams;
            for (StreamInfo& info : r.streams()) streams.push_back({std::move(info)});
            return streams;
          },
          "All streams of the file, including those that are not read.")
      .def_property_readonly("faults", &OpenRecording::faults,
                             "Faults found so far; complete after the last packet.")
      .def_property_readonly("fraction_read", &OpenRecording::fractionRead,
                             "Fraction of the file's bytes that is read, 0..1.")
      .def("__repr__", [](const OpenRecording& r) {
        return textOf(fmt::format("<evical.Recording '{}', {}{}>", r.path(), r.format(),
                                  r.isOfOtherProcess() ? ", of another process"
                                  : r.closed()         ? ", closed"
                                                       : ""));
      });
  module.def("_set_recording_server", setRecordingServer, py::arg("command"));
  module.def("_serve_recording", serveRecording, py::arg("path"), py::arg("names") = "");
  module.def("_open", openForPython, py::arg("path"), py::arg("streams"));
  module.def("inspect", inspect, py::arg("path"), py::arg("progress") = py::none(),
             "Contents and faults of a recording: the dictionary of `evical inspect --json --checksum`. "
             "Reads the whole recording.");
}

}  // namespace evical::python
