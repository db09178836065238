// evical.Session: the sensors to calibrate, and their recording.
#include "core/pipeline/session/session.h"
#include "core/base/number.h"

#include "core/base/error.h"
#include "core/pipeline/session/session_guess.h"
#include "core/pipeline/session/session_keys.h"
#include "core/recording/recording_reader.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/interpreter.h"
#include "python/interruptible.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace evical::python {
namespace {

namespace py = pybind11;

// True if the option refuses fractions; its value may be whole by chance.
bool isCount(const OptionRow& row) {
  if (row.value.find_first_not_of("-0123456789") != std::string::npos) return false;
  try {
    CalibrationOptions other;
    setOption(other, row.name, row.value + ".0");
    return false;
  } catch (const CalibrationError&) {
    return true;
  }
}

// The value of an option as bool, int, float or str: the same type for each of its values.
py::object valueOf(const OptionRow& row) {
  if (row.choices == std::vector<std::string>{"false", "true"}) return py::bool_(row.value == "true");
  if (!row.choices.empty()) return py::str(row.value);
  const py::object text = py::str(row.value);
  return isCount(row) ? py::object(py::int_(text)) : py::object(py::float_(text));
}

py::object optionsOf(const Session& session) {
  py::dict options;
  for (const OptionRow& row : optionRows(session.options)) options[py::str(row.name)] = valueOf(row);
  return readOnly(options);
}

// A value that is refused leaves the session unchanged. The session's sensors stay where they are, since
// Python has references to them.
void setKey(Session& session, const std::string& key, const py::object& value) {
  const std::string text = py::isinstance<py::bool_>(value) ? (value.cast<bool>() ? "true" : "false")
                                                            : py::str(value).cast<std::string>();
  Session tried = session;
  setInSession(tried, key, text);
  validate(tried.options);
  setInSession(session, key, text);
}

// Numbers that must be given, unlike those of a form, which people see before they use them.
Board notGiven() {
  Board board;
  board.rows = board.cols = 0;
  board.spacing_m = board.radius_m = 0.0;
  return board;
}

Session guess(const py::args& given, const py::object& progress) {
  if (given.empty())
    throw badInput("recordings", "no path is given", "Give the path of at least one recording");
  std::vector<std::filesystem::path> recordings;
  for (const py::handle& path : given)
    recordings.push_back(std::filesystem::absolute(path.cast<std::filesystem::path>()));
  SessionDraft draft;
  RunLog log;
  runInterruptibly(progress, log, [&](const RunContext& context) {
    std::vector<InspectedRecording> inspected;
    for (const std::filesystem::path& recording : recordings) {
      context.progress.stageStarted("inspect " + recording.filename().string());
      const std::unique_ptr<RecordingReader> reader = openRecording(recording);
      inspected.push_back({recording, inspectRecording(*reader, {}, context)});
      for (const RecordingFault& fault : inspected.back().inspection.faults)
        context.progress.log(LogLevel::Warning, fault.text);
    }
    draft = draftSession(inspected, ".");
    for (const std::string& note : draft.notes) context.progress.log(LogLevel::Info, note);
  });
  draft.session.board = notGiven();
  for (SessionImu& imu : draft.session.imus) imu.noise = {0.0, 0.0, 0.0, 0.0};
  return draft.session;
}

// Sensors by name. Each is a reference into the session and keeps it alive.
template <class Sensor>
py::object sensorByName(std::vector<Sensor>& sensors, const py::object& session) {
  py::dict found;
  for (Sensor& sensor : sensors)
    found[identifierOf(sensor.name)] =
        py::cast(&sensor, py::return_value_policy::reference_internal, session);
  return readOnly(found);
}

// A name as an attribute.
template <class Sensor>
auto getName(std::string Sensor::*member) {
  return [member](const Sensor& sensor) { return identifierOf(sensor.*member); };
}
template <class Sensor>
auto setName(std::string Sensor::*member) {
  return [member](Sensor& sensor, const py::str& name) { sensor.*member = bytesOf(name); };
}

template <std::size_t Count>
std::size_t indexOf(const std::array<const char*, Count>& words, const std::string& word, const char* place) {
  std::string known;
  for (std::size_t i = 0; i < Count; ++i) {
    if (word == words[i]) return i;
    known += (known.empty() ? "" : ", ") + std::string(words[i]);
  }
  throw badInput(place, fmt::format("'{}' is not a valid value", word), "Give one of: " + known);
}

constexpr std::array kShades{"dark", "bright"};

py::tuple stateOfBoard(const Board& board) {
  std::vector<std::array<double, 2>> given_m;
  for (const Eigen::Vector2d& point_m : board.given_m) given_m.push_back({point_m.x(), point_m.y()});
  return py::make_tuple(boardTypeName(board.type), board.rows, board.cols, board.spacing_m, board.radius_m,
                        kShades[static_cast<std::size_t>(board.circles)], board.tag_size_m, given_m,
                        board.first_tag);
}

Board boardFromMembers(const py::tuple& state) {
  Board board;
  board.type = static_cast<BoardType>(indexOf(kBoardTypeNames, state[0].cast<std::string>(), "board.type"));
  board.rows = state[1].cast<int>();
  board.cols = state[2].cast<int>();
  board.spacing_m = state[3].cast<double>();
  board.radius_m = state[4].cast<double>();
  board.circles = static_cast<CircleShade>(indexOf(kShades, state[5].cast<std::string>(), "board.circles"));
  board.tag_size_m = state[6].cast<double>();
  for (const auto& point_m : state[7].cast<std::vector<std::array<double, 2>>>())
    board.given_m.emplace_back(point_m[0], point_m[1]);
  board.first_tag = state[8].cast<int>();
  return board;
}

Board boardFromState(const py::tuple& state) {
  return restored(state, 9, "Board", boardFromMembers);
}

Session sessionFromState(const py::tuple& state) {
  return restored(state, 2, "Session", [](const py::tuple& s) {
    Session session = parseSession(bytesOf(s[0].cast<py::str>()), "/");
    session.source = s[1].cast<std::filesystem::path>();
    return session;
  });
}

// Tuples, since changes of a list would be lost.
template <class Values>
py::object tupleOf(const Values& values) {
  return py::tuple(py::cast(values));
}

void bindBoard(py::module_& module) {
  py::class_<Board>(module, "Board",
                    "The printed target. Its frame: x along a row, y down the columns, z into the board; m.")
      .def(py::init(&notGiven), "A board without dimensions: give all that its type has.")
      .def_property(
          "type", [](const Board& b) { return boardTypeName(b.type); },
          [](Board& b, const std::string& type) {
            b.type = static_cast<BoardType>(indexOf(kBoardTypeNames, type, "board.type"));
          },
          "asymmetric_circles, symmetric_circles, checkerboard, aprilgrid or charuco; session files may also "
          "have points.")
      .def_readwrite("rows", &Board::rows, "Number of rows of circles, inner corners, tags or squares.")
      .def_readwrite("cols", &Board::cols)
      .def_readwrite("spacing_m", &Board::spacing_m,
                     "Distance between rows of circles, edge of a square, or distance between tags.")
      .def_readwrite("radius_m", &Board::radius_m, "Radius of the circles.")
      .def_readwrite("tag_size_m", &Board::tag_size_m, "Edge length of a tag's black square.")
      .def_readwrite("first_tag", &Board::first_tag, "Number of an AprilGrid's first tag.")
      .def_property(
          "circles", [](const Board& b) { return kShades[static_cast<std::size_t>(b.circles)]; },
          [](Board& b, const std::string& shade) {
            b.circles = static_cast<CircleShade>(indexOf(kShades, shade, "board.circles"));
          },
          "dark or bright.")
      .def_property_readonly(
          "points_m",
          [](const Board& b) {
            validate(b);
            const std::vector<Eigen::Vector2d> points = boardPoints_m(b);
            Eigen::MatrixXd all = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(points.size()), 3);
            for (std::size_t i = 0; i < points.size(); ++i)
              all.row(static_cast<Eigen::Index>(i)).head<2>() = points[i].transpose();
            return arrayOf(all);
          },
          "(N, 3): circle centres or corners by index, in the board's frame. Raises InputError if the board "
          "is invalid.")
      .def(py::pickle(&stateOfBoard, &boardFromState))
      .def("__repr__", [](const Board& b) {
        return fmt::format("<evical.Board {}, {} x {}, {} m>", boardTypeName(b.type), b.rows, b.cols,
                           b.spacing_m);
      });
}

void setResolution(SessionCamera& camera, const std::optional<std::array<int, 2>>& size_px) {
  // 0 means unknown here and is omitted from files. Values that would be taken for it are refused at once.
  if (size_px && ((*size_px)[0] <= 0 || (*size_px)[1] <= 0))
    throw badInput(fmt::format("cameras.{}.resolution_px", camera.name), "must be two numbers above 0");
  camera.resolution_px = size_px ? Resolution{(*size_px)[0], (*size_px)[1]} : Resolution{};
}

void bindSensors(py::module_& module) {
  py::class_<SessionCamera>(module, "SessionCamera", "A camera of a session.")
      .def_property_readonly("name", getName(&SessionCamera::name))
      .def_property("stream", getName(&SessionCamera::stream), setName(&SessionCamera::stream),
                    "Topic or stream name in the file.")
      .def_property(
          "intrinsics",
          [](const SessionCamera& c) -> std::optional<CameraIntrinsics> { return c.intrinsics; },
          [](SessionCamera& c, const std::optional<CameraIntrinsics>& lens) { c.intrinsics = lens; },
          "A Camera; None: the lens is calibrated first, from the same events. This is a copy: assign a "
          "Camera to change it.")
      .def_property(
          "resolution_px",
          [](const SessionCamera& c) -> py::object {
            if (!c.resolution_px.known()) return py::none();
            return py::make_tuple(c.resolution_px.width_px, c.resolution_px.height_px);
          },
          setResolution,
          "Tuple (width, height) in px, assigned from a list or tuple; None: the recording states it.")
      .def_readwrite("recording", &SessionCamera::recording, "Separate recording; empty: the session's.")
      .def_readwrite("clock_offset_s", &SessionCamera::clock_offset_s,
                     "Known offset that is added to the stream's times.")
      .def_property(
          "rejected_windows_s", [](const SessionCamera& c) { return tupleOf(c.rejected_windows_s); },
          [](SessionCamera& c, const std::vector<double>& times_s) { c.rejected_windows_s = times_s; },
          "Tuple; calibrations of the rig exclude the event windows and frames at these times since the "
          "recording's start. Assign a list or tuple to change it.");
  py::class_<SessionImu>(module, "SessionImu", "An IMU of a session.")
      .def_property_readonly("name", getName(&SessionImu::name))
      .def_property("stream", getName(&SessionImu::stream), setName(&SessionImu::stream))
      .def_property("accelerometer_stream", getName(&SessionImu::accelerometer_stream),
                    setName(&SessionImu::accelerometer_stream),
                    "Stream of the accelerometer, if it is separate; `stream` is then the gyroscope's.")
      .def_property(
          "gyroscope_noise_density", [](const SessionImu& i) { return i.noise.gyroscope_density; },
          [](SessionImu& i, double density) { i.noise.gyroscope_density = density; },
          "rad/s/sqrt(Hz); 0: not given.")
      .def_property(
          "accelerometer_noise_density", [](const SessionImu& i) { return i.noise.accelerometer_density; },
          [](SessionImu& i, double density) { i.noise.accelerometer_density = density; },
          "m/s^2/sqrt(Hz); 0: not given.")
      .def_readwrite("recording", &SessionImu::recording, "Separate recording; empty: the session's.")
      .def_readwrite("accelerometer_recording", &SessionImu::accelerometer_recording,
                     "The accelerometer's own file; empty: `recording` has both sensors.")
      .def_readwrite("columns", &SessionImu::columns,
                     "Header of a text table that replaces the file's; empty: the file's.")
      .def_readwrite("accelerometer_columns", &SessionImu::accelerometer_columns,
                     "The same for the accelerometer's own file.")
      .def_readonly(
          "acceleration_factor", &SessionImu::acceleration_factor,
          "Factor of the unit, for raw counts; Session.set(\"imus.NAME.acceleration_unit\", \"0.002 g\") "
          "sets both.")
      .def_readonly("angular_rate_factor", &SessionImu::angular_rate_factor,
                    "Factor of the unit, for raw counts; Session.set sets both.")
      .def_readwrite("clock_offset_s", &SessionImu::clock_offset_s,
                     "Known offset that is added to the stream's times.");
}

}  // namespace

void bindSession(py::module_& module) {
  bindBoard(module);
  bindSensors(module);
  py::class_<Session>(module, "Session", "Recording, board, sensors, and their known parameters.")
      .def_static("load", &readSession, py::arg("path"), py::call_guard<OthersWork>(),
                  "From a session file. Raises InputError that names file, key and line.")
      .def_static(
          "guess", &guess, py::arg("progress") = py::none(),
          "guess(*recordings, progress=None): drafts a session from recordings, with their event streams as "
          "cameras, and their IMUs. Board and noise are not given (0): fill them in, or calibrate raises "
          "InputError; the logger \"evical\" lists what is missing. "
          "Reads the whole recordings. Raises InputError if no session results.")
      .def("save", &writeSession, py::arg("path"), "Writes a session file: the whole file or nothing.")
      .def(
          "to_yaml",
          [](const Session& s, const std::filesystem::path& folder) {
            return textOf(sessionYaml(s, folder));
          },
          py::arg("folder") = ".", "The text that save writes, with paths relative to `folder`.")
      .def("set", &setKey, py::arg("key"), py::arg("value"),
           "Sets one value, as `--set` on the command line: an option (\"group.option\"), \"imus.NAME.KEY\" "
           "for units and axes, or \"time_range_s\". If it raises InputError, nothing is changed.")
      .def_property_readonly("options", &optionsOf,
                             "Values of all options by name; read-only: use `set` to change them.")
      .def_readonly("source", &Session::source, "The file it was read from.")
      .def_readwrite("recording", &Session::recording)
      .def_property(
          "time_range_s",
          [](const Session& s) { return s.time_range_s ? tupleOf(*s.time_range_s) : py::none(); },
          [](Session& s, const std::optional<std::array<double, 2>>& range_s) { s.time_range_s = range_s; },
          "Tuple (begin, end) since the recording's start; None: the whole recording.")
      .def_readwrite("board", &Session::board)
      .def_property("reference", getName(&Session::reference), setName(&Session::reference),
                    "Name of an IMU; of a camera if there is no IMU.")
      .def_property_readonly(
          "cameras", [](const py::object& self) { return sensorByName(self.cast<Session&>().cameras, self); },
          "SessionCamera by name. The mapping is read-only, the cameras are not.")
      .def_property_readonly(
          "imus", [](const py::object& self) { return sensorByName(self.cast<Session&>().imus, self); },
          "SessionImu by name.")
      .def("copy", [](const Session& s) { return s; })
      .def("__copy__", [](const Session& s) { return s; })
      .def("__deepcopy__", [](const Session& s, const py::dict&) { return s; })
      .def(py::pickle(
          [](const Session& s) { return py::make_tuple(identifierOf(sessionYaml(s, "/")), s.source); },
          &sessionFromState))
      .def("__repr__", [](const Session& s) {
        return textOf(fmt::format("<evical.Session of '{}': {}, {}>", s.recording.string(),
                                  counted(s.cameras.size(), "camera"), counted(s.imus.size(), "IMU")));
      });
}

}  // namespace evical::python
