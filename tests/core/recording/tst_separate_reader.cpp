#include "core/recording/separate_reader.h"

#include "core/base/error.h"
#include "tests/support/test_program.h"

#include <sys/wait.h>
#include <unistd.h>

#include <QElapsedTimer>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stop_token>
#include <thread>
#include <utility>

namespace {

using namespace evical;

// Returns events of one second each, and fails in some way at one of them.
class CountingReader : public RecordingReader {
 public:
  using Deed = void (*)();
  explicit CountingReader(int packets, int deed_at = -1, Deed deed = nullptr)
      : packets_(packets), deed_at_(deed_at), deed_(deed) {
    StreamInfo events, imu;
    events.name = "events";
    events.type = StreamType::Events;
    events.resolution_px = {346, 260};
    imu.name = "imu";
    imu.type = StreamType::Imu;
    imu.acceleration_unit = AccelerationUnit::Gravity;
    imu.host_clock_offset_s = 2.5;
    streams_ = {events, imu};
  }

  const std::vector<StreamInfo>& streams() const override { return streams_; }
  void select(const std::vector<std::size_t>& streams) override { selected_ = streams; }
  bool read(Packet& packet) override {
    if (next_ == deed_at_) deed_();
    if (next_ == packets_) {
      faults_.push_back({"events", FaultKind::Gap, 1.5, "A gap."});
      return false;
    }
    packet = {};
    packet.stream = selected_.empty() ? static_cast<std::size_t>(next_ % 2) : selected_.front();
    const std::int64_t time_ns = 1'000'000'000LL * next_++;
    if (packet.stream == 0) packet.events = {{time_ns, 7, 8, true}, {time_ns + 1, 9, 10, false}};
    if (packet.stream == 1) packet.imu_samples = {{time_ns, {1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}};
    return true;
  }
  double fractionRead() const override { return static_cast<double>(next_) / packets_; }
  const std::vector<RecordingFault>& faults() const override { return faults_; }
  std::string format() const override { return "counting"; }

 private:
  int packets_, deed_at_, next_ = 0;
  Deed deed_;
  std::vector<std::size_t> selected_;
  std::vector<StreamInfo> streams_;
  std::vector<RecordingFault> faults_;
};

void writeWhereNothingIs() {
  ::raise(SIGSEGV);
}

std::vector<Packet> readAll(RecordingReader& reader) {
  std::vector<Packet> packets(1);
  while (reader.read(packets.back())) packets.emplace_back();
  packets.pop_back();
  return packets;
}

class TestSeparateReader : public QObject {
  Q_OBJECT
 private slots:
  void everything_comesAcross();
  void selection_comesAcross();
  void reader_thatFalls_endsTheRecording_data();
  void reader_thatFalls_endsTheRecording();
  void fallAtOpening_isBadInput();
  void reader_thatHangs_isEnded();
  void stop_endsTheWaitForAReaderThatHangs();
  void closedConnection_isNoSilence();
  void serverThatCannotStart_isSaid();
  void error_isThrownHere();
  void reader_thatIsNotReadToItsEnd_leavesNoProcess();
};

void TestSeparateReader::everything_comesAcross() {
  SeparateReader reader("file", [] { return std::make_unique<CountingReader>(5); });
  QCOMPARE(reader.format(), std::string("counting"));
  QCOMPARE(reader.streams().size(), std::size_t{2});
  QVERIFY((reader.streams()[0].resolution_px == Resolution{346, 260}));
  QVERIFY(reader.streams()[1].acceleration_unit == AccelerationUnit::Gravity);
  QCOMPARE(*reader.streams()[1].host_clock_offset_s, 2.5);
  QVERIFY(!reader.streams()[0].host_clock_offset_s);
  const std::vector<Packet> packets = readAll(reader);
  QCOMPARE(packets.size(), std::size_t{5});
  QCOMPARE(packets[4].events[1].time_ns, std::int64_t{4'000'000'001});
  QCOMPARE(int{packets[4].events[1].x_px}, 9);
  QVERIFY(packets[4].events[0].brighter && !packets[4].events[1].brighter);
  QVERIFY(packets[3].events.empty());
  QVERIFY((packets[3].imu_samples.at(0).specific_force == Eigen::Vector3d{4.0, 5.0, 6.0}));
  QCOMPARE(reader.fractionRead(), 1.0);
  QCOMPARE(reader.faults().size(), std::size_t{1});
  QCOMPARE(reader.faults()[0].text, std::string("A gap."));
  QVERIFY(reader.faults()[0].kind == FaultKind::Gap);
  Packet packet;
  QVERIFY(!reader.read(packet));
}

void TestSeparateReader::selection_comesAcross() {
  SeparateReader reader("file", [] { return std::make_unique<CountingReader>(4); });
  reader.select({1});
  for (const Packet& packet : readAll(reader)) QCOMPARE(packet.stream, std::size_t{1});
}

void TestSeparateReader::reader_thatFalls_endsTheRecording_data() {
  QTest::addColumn<bool>("aborts");
  QTest::newRow("by a signal") << false;
  QTest::newRow("by abort") << true;
}

void TestSeparateReader::reader_thatFalls_endsTheRecording() {
  QFETCH(bool, aborts);
  SeparateReader reader("file", [&] {
    return std::make_unique<CountingReader>(10, 4, aborts ? [] { std::abort(); } : &writeWhereNothingIs);
  });
  QCOMPARE(readAll(reader).size(), std::size_t{4});
  QCOMPARE(reader.faults().size(), std::size_t{1});
  QVERIFY(reader.faults()[0].kind == FaultKind::Corrupt);
  const std::string expected = aborts ? "signal 6) after 40 %" : "signal 11) after 40 %";
  QVERIFY2(reader.faults()[0].text.find(expected) != std::string::npos, reader.faults()[0].text.c_str());
}

void TestSeparateReader::fallAtOpening_isBadInput() {
  try {
    SeparateReader reader("some.h5", []() -> std::unique_ptr<RecordingReader> { std::abort(); });
    QFAIL("opened");
  } catch (const CalibrationError& error) {
    QVERIFY(error.kind() == ErrorKind::BadInput);
    QCOMPARE(error.place(), std::string("some.h5"));
    QVERIFY2(error.problem().find("damaged") != std::string::npos, error.what());
  }
}

void TestSeparateReader::reader_thatHangs_isEnded() {
  const int usual_ms = std::exchange(SeparateReader::longest_silence_ms, 200);
  SeparateReader reader("file.h5", [] {
    return std::make_unique<CountingReader>(10, 4, [] {
      for (;;) ::pause();
    });
  });
  QCOMPARE(readAll(reader).size(), std::size_t{4});
  SeparateReader::longest_silence_ms = usual_ms;
  QVERIFY2(reader.faults().back().text.find("no answer for 0.2 s") != std::string::npos,
           reader.faults().back().text.c_str());
  QVERIFY(::waitpid(-1, nullptr, WNOHANG) < 0);  // no process is left
}

// A window that is closed, or Ctrl-C, need not wait for 30 s.
void TestSeparateReader::stop_endsTheWaitForAReaderThatHangs() {
  std::stop_source stop;
  const auto hang = [] {
    for (;;) ::pause();
  };
  SeparateReader reader("file.h5", [&] { return std::make_unique<CountingReader>(10, 2, hang); });
  std::jthread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    stop.request_stop();
  });
  QElapsedTimer timer;
  timer.start();
  {
    const StopWaiting until_stop(stop.get_token());
    QCOMPARE(readAll(reader).size(), std::size_t{2});
    QVERIFY(reader.faults().empty());
    QVERIFY_THROWS_EXCEPTION(Cancelled, SeparateReader("other.h5", [&]() -> std::unique_ptr<RecordingReader> {
                               hang();
                               return nullptr;
                             }));
  }
  QVERIFY2(timer.elapsed() < 10'000, qPrintable(QString::number(timer.elapsed())));
}

void TestSeparateReader::closedConnection_isNoSilence() {
  SeparateReader reader("file.h5", [] {
    return std::make_unique<CountingReader>(10, 4, [] {
      for (int descriptor = 3; descriptor < 1024; ++descriptor) ::close(descriptor);
      for (;;) ::pause();
    });
  });
  QCOMPARE(readAll(reader).size(), std::size_t{4});
  const std::string& text = reader.faults().back().text;
  QVERIFY2(text.find("it closed the connection") != std::string::npos, text.c_str());
  QVERIFY2(text.find("no answer") == std::string::npos, text.c_str());
  QVERIFY(::waitpid(-1, nullptr, WNOHANG) < 0);  // no process is left
}

void TestSeparateReader::serverThatCannotStart_isSaid() {
  using Server = std::vector<std::string>;
  for (const auto& [server, problem] :
       {std::pair{Server{"/nowhere/server"}, "No such file"}, std::pair{Server{"/bin/false"}, "exit code 1"},
        std::pair{Server{"/bin/sh", "-c", "kill -9 $$"}, "was killed"}}) {
    try {
      SeparateReader reader("some.h5", server);
      QFAIL("opened");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::CalibrationFailed);
      QVERIFY2(error.problem().find(problem) != std::string::npos, error.what());
    }
  }
  QVERIFY(::waitpid(-1, nullptr, WNOHANG) < 0);
}

void TestSeparateReader::error_isThrownHere() {
  try {
    SeparateReader reader("file", []() -> std::unique_ptr<RecordingReader> {
      throw badInput("a place", "a problem", "an advice");
    });
    QFAIL("opened");
  } catch (const CalibrationError& error) {
    QVERIFY(error.kind() == ErrorKind::BadInput);
    QCOMPARE(std::string(error.what()), std::string(badInput("a place", "a problem", "an advice").what()));
  }
}

void TestSeparateReader::reader_thatIsNotReadToItsEnd_leavesNoProcess() {
  {
    SeparateReader reader("file", [] { return std::make_unique<CountingReader>(1'000'000); });
    Packet packet;
    QVERIFY(reader.read(packet));
  }
  QCOMPARE(::waitpid(-1, nullptr, WNOHANG), -1);  // no child is left
}

}  // namespace

EVICAL_TEST(TestSeparateReader)
#include "tst_separate_reader.moc"
