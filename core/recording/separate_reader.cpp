#include "core/recording/separate_reader.h"

#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/recording/byte_cursor.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>
#include <new>
#include <string_view>
#include <thread>
#include <type_traits>
#include <utility>

namespace evical {
namespace {

enum class Answer : std::uint8_t { State, Packet, End, Error };
enum class Question : std::uint8_t { Select, Read };

template <class Number>
void putInto(std::string& message, Number number) {
  static_assert(std::is_trivially_copyable_v<Number>);
  message.append(reinterpret_cast<const char*>(&number), sizeof(number));
}
void putInto(std::string& message, const std::string& text) {
  putInto(message, static_cast<std::uint32_t>(text.size()));
  message += text;
}

bool sendAll(int socket, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

enum class Silence { Awaited, Limited };
enum class Heard { All, Closed, Silent, Stopped };

thread_local std::stop_token stop_of_waits;
bool is_reader_process = false;

// Waits in short pieces, and ignores pieces that took much longer than requested: the program was stopped
// (Ctrl-Z).
Heard waitFor(int socket, Silence silence) {
  constexpr int kPiece_ms = 100;
  for (int waited_ms = 0; waited_ms < SeparateReader::longest_silence_ms;) {
    pollfd waiting{socket, POLLIN, 0};
    const auto begin = std::chrono::steady_clock::now();
    const int ready = ::poll(&waiting, 1, silence == Silence::Limited ? kPiece_ms : -1);
    if (ready > 0) return Heard::All;
    if (ready < 0 && errno != EINTR) return Heard::Closed;
    if (silence == Silence::Limited && stop_of_waits.stop_requested()) return Heard::Stopped;
    if (std::chrono::steady_clock::now() - begin < 10 * std::chrono::milliseconds(kPiece_ms))
      waited_ms += kPiece_ms;
  }
  return Heard::Silent;
}

Heard receiveAll(int socket, char* bytes, std::size_t count, Silence silence) {
  while (count > 0) {
    if (const Heard heard = waitFor(socket, silence); heard != Heard::All) return heard;
    const ssize_t got = ::recv(socket, bytes, count, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return Heard::Closed;
    bytes += got;
    count -= static_cast<std::size_t>(got);
  }
  return Heard::All;
}

bool sendMessage(int socket, const std::string& message) {
  std::string length;
  putInto(length, static_cast<std::uint64_t>(message.size()));
  return sendAll(socket, length) && sendAll(socket, message);
}

Heard receiveMessage(int socket, std::string& message, Silence silence = Silence::Limited) {
  std::uint64_t length = 0;
  const Heard heard = receiveAll(socket, reinterpret_cast<char*>(&length), sizeof(length), silence);
  if (heard != Heard::All) return heard;
  message.resize(static_cast<std::size_t>(length));
  return receiveAll(socket, message.data(), message.size(), silence);
}

void putStream(std::string& message, const StreamInfo& info) {
  putInto(message, info.name);
  putInto(message, info.type);
  putInto(message, info.message);
  putInto(message, info.resolution_px.width_px);
  putInto(message, info.resolution_px.height_px);
  putInto(message, info.messages);
  putInto(message, info.time_unit_ns);
  putInto(message, info.acceleration_unit);
  putInto(message, info.angular_rate_unit);
  putInto(message, static_cast<std::uint8_t>(info.host_clock_offset_s.has_value()));
  putInto(message, info.host_clock_offset_s.value_or(0.0));
  putInto(message, static_cast<std::uint8_t>(info.readable));
  putInto(message, static_cast<std::uint8_t>(info.timed));
}

StreamInfo takeStream(ByteCursor& cursor) {
  StreamInfo info;
  info.name = cursor.sized();
  info.type = cursor.number<StreamType>();
  info.message = cursor.sized();
  info.resolution_px.width_px = cursor.number<int>();
  info.resolution_px.height_px = cursor.number<int>();
  info.messages = cursor.number<std::uint64_t>();
  info.time_unit_ns = cursor.number<std::int64_t>();
  info.acceleration_unit = cursor.number<AccelerationUnit>();
  info.angular_rate_unit = cursor.number<AngularRateUnit>();
  const bool has_offset = cursor.number<std::uint8_t>() != 0;
  const auto offset_s = cursor.number<double>();
  if (has_offset) info.host_clock_offset_s = offset_s;
  info.readable = cursor.number<std::uint8_t>() != 0;
  info.timed = cursor.number<std::uint8_t>() != 0;
  return info;
}

void putFault(std::string& message, const RecordingFault& fault) {
  putInto(message, fault.stream);
  putInto(message, fault.kind);
  putInto(message, fault.at_s);
  putInto(message, fault.text);
}

RecordingFault takeFault(ByteCursor& cursor) {
  RecordingFault fault;
  fault.stream = cursor.sized();
  fault.kind = cursor.number<FaultKind>();
  fault.at_s = cursor.number<double>();
  fault.text = cursor.sized();
  return fault;
}

std::string stateOf(const RecordingReader& reader) {
  std::string message;
  putInto(message, reader.format());
  putInto(message, reader.fractionRead());
  putInto(message, static_cast<std::uint32_t>(reader.streams().size()));
  for (const StreamInfo& info : reader.streams()) putStream(message, info);
  putInto(message, static_cast<std::uint32_t>(reader.faults().size()));
  for (const RecordingFault& fault : reader.faults()) putFault(message, fault);
  return message;
}

void putVector(std::string& message, const Eigen::Vector3d& vector) {
  for (int i = 0; i < 3; ++i) putInto(message, vector[i]);
}

void putFrame(std::string& message, const Frame& frame) {
  putInto(message, frame.time_ns);
  putInto(message, frame.exposure_s);
  putInto(message, frame.format);
  putInto(message, static_cast<std::uint8_t>(frame.big_endian));
  putInto(message, frame.size_px.width_px);
  putInto(message, frame.size_px.height_px);
  putInto(message, static_cast<std::uint64_t>(frame.row_bytes));
  putInto(message, static_cast<std::uint64_t>(frame.bytes.size()));
  message.append(reinterpret_cast<const char*>(frame.bytes.data()), frame.bytes.size());
}

void takeFrame(ByteCursor& cursor, Frame& frame) {
  frame.time_ns = cursor.number<std::int64_t>();
  frame.exposure_s = cursor.number<double>();
  frame.format = cursor.number<FrameFormat>();
  frame.big_endian = cursor.number<std::uint8_t>() != 0;
  frame.size_px.width_px = cursor.number<int>();
  frame.size_px.height_px = cursor.number<int>();
  frame.row_bytes = static_cast<std::size_t>(cursor.number<std::uint64_t>());
  const std::string_view bytes = cursor.take(cursor.number<std::uint64_t>());
  frame.bytes.assign(bytes.begin(), bytes.end());
}

// Points come only from text, which is read in this process.
std::string messageOf(const Packet& packet, double fraction_read) {
  std::string message;
  putInto(message, Answer::Packet);
  putInto(message, fraction_read);
  putInto(message, static_cast<std::uint64_t>(packet.stream));
  putInto(message, static_cast<std::uint64_t>(packet.events.size()));
  putInto(message, static_cast<std::uint64_t>(packet.imu_samples.size()));
  putInto(message, static_cast<std::uint64_t>(packet.frames.size()));
  message.append(reinterpret_cast<const char*>(packet.events.data()), packet.events.size() * sizeof(Event));
  for (const RawImuSample& sample : packet.imu_samples) {
    putInto(message, sample.time_ns);
    putVector(message, sample.angular_rate);
    putVector(message, sample.specific_force);
  }
  for (const Frame& frame : packet.frames) putFrame(message, frame);
  return message;
}

std::string messageOf(ErrorKind kind, const std::string& place, const std::string& problem,
                      const std::string& advice) {
  std::string message;
  putInto(message, Answer::Error);
  putInto(message, kind);
  for (const std::string& text : {place, problem, advice}) putInto(message, text);
  return message;
}

std::string answerTo(const std::string& question, RecordingReader& reader) {
  ByteCursor cursor(question);
  std::string answer;
  if (cursor.number<Question>() == Question::Select) {
    std::vector<std::size_t> streams(cursor.number<std::uint32_t>());
    for (std::size_t& stream : streams) stream = static_cast<std::size_t>(cursor.number<std::uint64_t>());
    reader.select(streams);
    putInto(answer, Answer::State);
    return answer + stateOf(reader);
  }
  Packet packet;
  if (reader.read(packet)) return messageOf(packet, reader.fractionRead());
  putInto(answer, Answer::End);
  return answer + stateOf(reader);
}

// The libraries' messages at a crash are suppressed: this program explains the crash.
void beQuiet() {
  const int nothing = ::open("/dev/null", O_WRONLY);
  if (nothing >= 0) ::dup2(nothing, STDERR_FILENO);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  std::signal(SIGINT, SIG_IGN);  // the waiting process decides
  std::signal(SIGTERM, SIG_IGN);
  for (const int fatal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) std::signal(fatal, SIG_DFL);
}

[[noreturn]] void throwError(const std::filesystem::path& path, std::string_view message) {
  ByteCursor cursor(message);
  const auto kind = cursor.number<ErrorKind>();
  std::string place(cursor.sized()), problem(cursor.sized()), advice(cursor.sized());
  if (place.empty()) place = path.string();
  throw CalibrationError(kind, std::move(place), std::move(problem), std::move(advice));
}

// Starts the server with the socket at the expected descriptor. A fork would inherit locks of other
// threads; a new process does not.
pid_t spawn(const std::vector<std::string>& command, const std::filesystem::path& path,
            const std::string& names, int socket) {
  std::vector<std::string> words = command;
  words.push_back(path.string());
  if (!names.empty()) words.push_back(names);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, socket, kServerSocket);
  // Ctrl-C addresses this program, which ends the server; the signal is blocked until the server ignores it.
  sigset_t held;
  ::sigemptyset(&held);
  for (const int signal : {SIGINT, SIGTERM}) ::sigaddset(&held, signal);
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setsigmask(&attributes, &held);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  pid_t process = -1;
  const int error =
      ::posix_spawnp(&process, arguments.front(), &actions, &attributes, arguments.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&actions);
  errno = error;
  return error == 0 ? process : -1;
}

}  // namespace

bool isReaderProcess() {
  return is_reader_process;
}

void serveReader(int socket, const SeparateReader::Open& open) {
  is_reader_process = true;
  beQuiet();
  const auto attempt = [&](const auto& work) {
    try {
      return work();
    } catch (const CalibrationError& error) {
      return messageOf(error.kind(), error.place(), error.problem(), error.advice());
    } catch (const std::bad_alloc&) {
      return messageOf(ErrorKind::BadInput, "", "there is not enough memory to read it", "");
    } catch (const std::exception& error) {
      return messageOf(ErrorKind::BadInput, "", error.what(), "");
    }
  };
  std::unique_ptr<RecordingReader> reader;
  const std::string first = attempt([&] {
    reader = open();
    std::string state;
    putInto(state, Answer::State);
    return state + stateOf(*reader);
  });
  bool heard = sendMessage(socket, first);
  std::string question;
  while (heard && reader && receiveMessage(socket, question, Silence::Awaited) == Heard::All)
    heard = sendMessage(socket, attempt([&] { return answerTo(question, *reader); }));
  ::_exit(0);
}

StopWaiting::StopWaiting(std::stop_token stop) : before_(stop_of_waits) {
  if (stop.stop_possible()) stop_of_waits = std::move(stop);
}

bool StopWaiting::isRequested() {
  return stop_of_waits.stop_requested();
}

StopWaiting::~StopWaiting() {
  stop_of_waits = std::move(before_);
}

SeparateReader::SeparateReader(const std::filesystem::path& path, const Open& open) : path_(path) {
  begin([&](int own, int other) {
    const pid_t process = ::fork();
    if (process != 0) return process;
    ::close(own);
    serveReader(other, open);
  });
}

SeparateReader::SeparateReader(const std::filesystem::path& path, const std::vector<std::string>& server,
                               const std::string& names)
    : path_(path) {
  begin([&](int, int other) { return spawn(server, path, names, other); });
}

void SeparateReader::begin(const std::function<pid_t(int own, int other)>& start) {
  int sockets[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0)
    throw calibrationFailed(path_.string(), fmt::format("cannot be read: {}", std::strerror(errno)),
                            "Close other files and programs");
  process_ = start(sockets[0], sockets[1]);
  const int error = errno;
  ::close(sockets[1]);
  socket_ = sockets[0];
  if (process_ < 0) {
    end();
    throw calibrationFailed(path_.string(), fmt::format("cannot be read: {}", std::strerror(error)),
                            "Close other programs");
  }
  takeFirstState();
}

void SeparateReader::takeFirstState() {
  std::string message;
  const Heard heard = receiveMessage(socket_, message);
  if (heard == Heard::All && !message.empty()) {
    std::string_view rest(message);
    const auto kind = static_cast<Answer>(rest.front());
    rest.remove_prefix(1);
    if (kind == Answer::State) {
      takeState(rest);
      return;
    }
    end();
    throwError(path_, rest);
  }
  if (heard == Heard::Stopped) {
    end();
    throw Cancelled{};
  }
  const End how = howItEnded(heard == Heard::Silent);
  end();
  throwIfKilled(how);
  if (how.kind == End::Kind::Silent)
    throw calibrationFailed(path_.string(), "cannot be read: " + how.reason,
                            "Check the disk or the network, and try again");
  if (how.kind == End::Kind::Exit)
    throw calibrationFailed(
        path_.string(), fmt::format("the process that reads HDF5 files cannot be started ({})", how.reason),
        "Install Evical again");
  throw badInput(
      path_.string(),
      fmt::format("the process that reads it ended unexpectedly ({}): the file is probably damaged",
                  how.reason),
      "Copy it again, or record again");
}

SeparateReader::~SeparateReader() {
  end();
}

// In any state: the result is not used any more.
void SeparateReader::end() {
  if (socket_ >= 0) ::close(std::exchange(socket_, -1));
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
  process_ = -1;
}

void SeparateReader::takeState(std::string_view message) {
  ByteCursor cursor(message);
  format_ = cursor.sized();
  fraction_read_ = cursor.number<double>();
  streams_.resize(cursor.number<std::uint32_t>());
  for (StreamInfo& info : streams_) info = takeStream(cursor);
  faults_.resize(cursor.number<std::uint32_t>());
  for (RecordingFault& fault : faults_) fault = takeFault(cursor);
}

void SeparateReader::select(const std::vector<std::size_t>& streams) {
  std::string question, answer;
  putInto(question, Question::Select);
  putInto(question, static_cast<std::uint32_t>(streams.size()));
  for (const std::size_t stream : streams) putInto(question, static_cast<std::uint64_t>(stream));
  // If the server has ended, the next read reports it.
  const bool answered = sendMessage(socket_, question) && receiveMessage(socket_, answer) == Heard::All;
  if (answered && static_cast<Answer>(answer.front()) == Answer::Error)
    throwError(path_, std::string_view(answer).substr(1));
}

// Requests the next packet before this one is processed, so that both processes work.
bool SeparateReader::ask() {
  std::string question;
  putInto(question, Question::Read);
  return sendMessage(socket_, question);
}

bool SeparateReader::read(Packet& packet) {
  packet.clear();
  if (finished_) return false;
  if (!asked_) static_cast<void>(ask());
  if (const Heard heard = receiveMessage(socket_, message_); heard != Heard::All) {
    finished_ = true;
    if (heard == Heard::Stopped) return false;
    const End end = howItEnded(heard == Heard::Silent);
    throwIfKilled(end);
    const double percent = 100.0 * fraction_read_;
    faults_.push_back({"", FaultKind::Corrupt, 0.0,
                       end.kind == End::Kind::Silent
                           ? fmt::format("The file can only be read up to {:.0f} %: {}. The rest is lost.",
                                         percent, end.reason)
                           : fmt::format("The file is probably damaged: the process that reads it ended "
                                         "unexpectedly ({}) after {:.0f} %. "
                                         "The rest is lost.",
                                         end.reason, percent)});
    return false;
  }
  const auto kind = static_cast<Answer>(message_.front());
  const std::string_view rest = std::string_view(message_).substr(1);
  finished_ = kind != Answer::Packet;
  if (kind == Answer::Error) throwError(path_, rest);
  if (kind == Answer::End) takeState(rest);
  if (finished_) return false;
  asked_ = ask();
  takePacket(rest, packet);
  return true;
}

void SeparateReader::takePacket(std::string_view message, Packet& packet) {
  ByteCursor cursor(message);
  fraction_read_ = cursor.number<double>();
  packet.stream = static_cast<std::size_t>(cursor.number<std::uint64_t>());
  const auto events = static_cast<std::size_t>(cursor.number<std::uint64_t>());
  packet.imu_samples.resize(static_cast<std::size_t>(cursor.number<std::uint64_t>()));
  packet.frames.resize(static_cast<std::size_t>(cursor.number<std::uint64_t>()));
  packet.events.resize(events);
  const std::string_view bytes = cursor.take(events * sizeof(Event));
  if (!bytes.empty()) std::memcpy(packet.events.data(), bytes.data(), bytes.size());
  for (RawImuSample& sample : packet.imu_samples) {
    sample.time_ns = cursor.number<std::int64_t>();
    for (int i = 0; i < 3; ++i) sample.angular_rate[i] = cursor.number<double>();
    for (int i = 0; i < 3; ++i) sample.specific_force[i] = cursor.number<double>();
  }
  for (Frame& frame : packet.frames) takeFrame(cursor, frame);
}

// Killed by the system or a person: the file may be intact.
void SeparateReader::throwIfKilled(const End& end) const {
  if (end.kind == End::Kind::Killed)
    throw calibrationFailed(path_.string(), "the process that reads it was killed; memory may have run out",
                            "Close other programs, and try again");
}

SeparateReader::End SeparateReader::howItEnded(bool silent) {
  const int rounds = silent ? 1 : 100;  // of 10 ms: a process that has closed its socket exits soon
  int status = 0;
  pid_t ended = 0;
  for (int round = 0; process_ > 0 && ended == 0 && round < rounds; ++round) {
    ended = ::waitpid(process_, &status, WNOHANG);
    if (ended == 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  if (process_ > 0 && ended == 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    process_ = -1;
    if (!silent) return {End::Kind::Signal, "it closed the connection"};
    return {End::Kind::Silent, fmt::format("no answer for {:g} s", 1e-3 * longest_silence_ms)};
  }
  const bool known = process_ > 0 && ended == process_;
  process_ = -1;
  if (!known) return {End::Kind::Signal, "for an unknown reason"};
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) return {End::Kind::Killed, "killed"};
  if (WIFSIGNALED(status)) return {End::Kind::Signal, fmt::format("signal {}", WTERMSIG(status))};
  return {End::Kind::Exit, fmt::format("exit code {}", WEXITSTATUS(status))};
}

}  // namespace evical
