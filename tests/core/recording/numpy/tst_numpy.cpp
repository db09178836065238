// NumPy's arrays of events. The format is that of numpy/numpy, numpy/lib/format.py (a8154c6); who writes
// what:
//   neuromorphs/tonic, tonic/datasets/dvs_lips.py (09c528c): structured x, y, p, t;
//   82magnolia/n_imagenet, real_cnn_model/data/imagenet.py (a0b1f73): event_data of x, y, t, p in archives;
//   open-neuromorphic/expelliarmus, README.md: structured t, x, y, p in us;
//   uzh-rpg/rpg_vid2e, esim_torch/scripts/generate_events.py (ecbb11a): numbered archives of x, y, t, p in
//   ns; better-flow/evimo, docs_sphinx/source/ground-truth-format.md (6800ea9): EVIMO's rows of t, x, y, p
//   and pickled meta, EVIMO2's dataset_events_t, _xy and _p; dv's Python package hands out timestamp, x, y,
//   polarity with padding (seen in programs that use it, not in its source).
#include "core/base/error.h"
#include "core/recording/conversion.h"
#include "tests/core/recording/numpy/numpy_builder.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

#include <QProcess>

#include <unistd.h>
#include <cmath>
#include <functional>
#include <limits>

using namespace evical;
using namespace evical::test;

namespace {

constexpr std::int64_t kNumpyStart_ns = 5'000'000'000;
constexpr std::size_t kCount = 3000;

std::vector<Event> theEvents() {
  return someEvents(kCount, kNumpyStart_ns);
}

// A field of an event in a type of NumPy's: "<i8"; times in `unit_ns`.
std::string value(double number, const std::string& type) {
  const bool swap = type[0] == '>';
  const std::string kind = type.substr(1);
  if (kind == "i1" || kind == "b1") return rawNumber(static_cast<std::int8_t>(number));
  if (kind == "u1") return rawNumber(static_cast<std::uint8_t>(number));
  if (kind == "i2") return rawNumber(static_cast<std::int16_t>(number), swap);
  if (kind == "u2") return rawNumber(static_cast<std::uint16_t>(number), swap);
  if (kind == "i4") return rawNumber(static_cast<std::int32_t>(number), swap);
  if (kind == "u4") return rawNumber(static_cast<std::uint32_t>(number), swap);
  if (kind == "f4") return rawNumber(static_cast<float>(number), swap);
  if (kind == "f8") return rawNumber(number, swap);
  if (kind == "V3") return "abc";
  return rawNumber(static_cast<std::int64_t>(number), swap);
}

struct Spelling {
  char part;  // x, y, t, p; another: padding
  std::string type;
};

double number(const Event& event, char part, double unit_ns, double off) {
  switch (part) {
    case 'x':
      return event.x_px;
    case 'y':
      return event.y_px;
    case 't':
      return static_cast<double>(event.time_ns) / unit_ns;
    case 'p':
      return event.brighter ? 1.0 : off;
    default:
      return 0.0;
  }
}

std::string rowsForNumpy(const std::vector<Spelling>& parts, double unit_ns, double off = 0.0,
                         const std::vector<Event>& events = theEvents()) {
  std::string bytes;
  for (const Event& event : events)
    for (const Spelling& part : parts) bytes += value(number(event, part.part, unit_ns, off), part.type);
  return bytes;
}

std::string columns(const std::vector<Spelling>& parts, double unit_ns, double off = 0.0) {
  std::string bytes;
  for (const Spelling& part : parts) bytes += rowsForNumpy({part}, unit_ns, off);
  return bytes;
}

std::string shape(std::size_t count = kCount, const std::string& rest = "") {
  return "(" + std::to_string(count) + "," + rest + ")";
}

// One column, of `unit_ns` if it is the time.
std::string column(char part, const std::string& type, double unit_ns = 1000.0, double off = 0.0) {
  return npyArray("'" + type + "'", shape(), rowsForNumpy({{part, type}}, unit_ns, off));
}

// x, y, t, p, each as an array, with a prefix and a suffix to their names.
std::vector<ZipFile> fourArrays(bool deflate, const std::string& before = "",
                                const std::string& behind_t = "", double unit_ns = 1000.0) {
  return {{before + "x.npy", column('x', "<u2"), deflate},
          {before + "y.npy", column('y', "<u2"), deflate},
          {before + "t" + behind_t + ".npy", column('t', "<i8", unit_ns), deflate},
          {before + "p.npy", column('p', "|i1", 1.0, -1.0), deflate}};
}

const std::vector<Spelling> kTonic = {{'x', "<i2"}, {'y', "<i2"}, {'p', "|b1"}, {'t', "<i8"}};
constexpr const char* kTonicDescr = "[('x', '<i2'), ('y', '<i2'), ('p', '|b1'), ('t', '<i8')]";

std::string tonic(std::size_t claimed = kCount) {
  return npyArray(kTonicDescr, shape(claimed), rowsForNumpy(kTonic, 1000.0));
}

std::string errorOf(const std::function<void()>& run) {
  try {
    run();
  } catch (const CalibrationError& error) {
    return error.what();
  }
  return {};
}

class TestNumpy : public QObject {
  Q_OBJECT

 private slots:
  void layouts_areRead_data();
  void layouts_areRead();
  void units_areNamedOrGuessed_data();
  void units_areNamedOrGuessed();
  void twoCameras_areTwoStreams();
  void offsetAndSize_areTaken();
  void folderOfArrays_isOneRecording();
  void numberedFiles_areReadOneAfterAnother();
  void objects_areNeverUnpickled();
  void whatIsNotRead_isSaid();
  void rowsThatAreNoEvents_areLeftOut();
  void stepsBack_areSortedOrEndAPacket();
  void timesOfFewBits_areSaid();
  void everyCut_isSaid_data();
  void everyCut_isSaid();
  void lies_areRefused_data();
  void lies_areRefused();
  void damage_isSaid_data();
  void damage_isSaid();
  void memory_doesNotGrow();
  void conversion_keepsEvents();
  void filesOfNumpyItself_areRead();

 private:
  std::filesystem::path write(const std::string& bytes) {
    return scratch_.write("file_" + std::to_string(++files_) + ".npz", bytes);
  }
  Contents read(const std::string& bytes) { return readAll(write(bytes)); }

  ScratchFolder scratch_;
  int files_ = 0;
};

void addRow(const char* name, const std::string& bytes, const char* guess = "us") {
  QTest::newRow(name) << QByteArray::fromStdString(bytes) << QString(guess);
}

void addStructured() {
  const auto npy = [](const std::string& descr, const std::vector<Spelling>& parts, double unit_ns = 1000.0) {
    return npyArray(descr, shape(), rowsForNumpy(parts, unit_ns));
  };
  addRow("tonic", tonic());
  addRow("Metavision", npy("[('x', '<u2'), ('y', '<u2'), ('p', '<i2'), ('t', '<i8')]",
                           {{'x', "<u2"}, {'y', "<u2"}, {'p', "<i2"}, {'t', "<i8"}}));
  addRow("dv, padded",
         npy("[('timestamp', '<i8'), ('x', '<i2'), ('y', '<i2'), ('polarity', '|i1'), ('', '|V3')]",
             {{'t', "<i8"}, {'x', "<i2"}, {'y', "<i2"}, {'p', "|i1"}, {' ', "|V3"}}));
  addRow("big endian", npy("[('t', '>i8'), ('x', '>u2'), ('y', '>i4'), ('p', '>f4')]",
                           {{'t', ">i8"}, {'x', ">u2"}, {'y', ">i4"}, {'p', ">f4"}}));
  addRow("real numbers, s",
         npy("[('t', '<f8'), ('x', '<f4'), ('y', '<f8'), ('p', '<f4')]",
             {{'t', "<f8"}, {'x', "<f4"}, {'y', "<f8"}, {'p', "<f4"}}, 1e9),
         "");
  addRow("titles", npy("[('t', '<u8'), ('x', '<u2'), ('y', '<u2'), (('on', 'p'), '|b1')]",
                       {{'t', "<u8"}, {'x', "<u2"}, {'y', "<u2"}, {'p', "|b1"}}));
  addRow("list of two", npy("[('ts', '<i8'), ('xy', '<u2', (2,)), ('pol', '|u1')]",
                            {{'t', "<i8"}, {'x', "<u2"}, {'y', "<u2"}, {'p', "|u1"}}));
  addRow("nested", npy("[('at', [('x', '<u2'), ('y', '<u2')]), ('what', [('t', '<i8'), ('p', '|u1')])]",
                       {{'x', "<u2"}, {'y', "<u2"}, {'t', "<i8"}, {'p', "|u1"}}));
  addRow("datetime64",
         npy("[('t', '<M8[us]'), ('x', '<u2'), ('y', '<u2'), ('p', '?')]",
             {{'t', "<i8"}, {'x', "<u2"}, {'y', "<u2"}, {'p', "|b1"}}),
         "");
  addRow("other fields",
         npy("[('id', '<i4'), ('t', '<i8'), ('x', '<u2'), ('y', '<u2'), ('p', '|u1'), ('name', '<U1')]",
             {{' ', "<i4"}, {'t', "<i8"}, {'x', "<u2"}, {'y', "<u2"}, {'p', "|u1"}, {' ', "<i4"}}));
  for (const int version : {2, 3})
    QTest::addRow("version %d", version)
        << QByteArray::fromStdString(
               npyFile(npyHeader(kTonicDescr, shape()), rowsForNumpy(kTonic, 1000.0), version))
        << "us";
  addRow("Python 2",
         npyFile("{'descr': " + std::string(kTonicDescr) + ", \"fortran_order\": False, 'shape': (3000L,)}",
                 rowsForNumpy(kTonic, 1000.0)));
}

void addTables() {
  const std::vector<Spelling> txyp = {{'t', "<f8"}, {'x', "<f8"}, {'y', "<f8"}, {'p', "<f8"}};
  const std::vector<Spelling> xytp = {{'x', "<i8"}, {'y', "<i8"}, {'t', "<i8"}, {'p', "<i8"}};
  const std::vector<Spelling> xypt = {{'x', "<f8"}, {'y', "<f8"}, {'p', "<f8"}, {'t', "<f8"}};
  const std::string n_by_4 = shape(kCount, " 4"), four_by_n = "(4, " + std::to_string(kCount) + ")";
  addRow("t x y p in s", npyArray("'<f8'", n_by_4, rowsForNumpy(txyp, 1e9, -1.0)), "");
  addRow("x y t p in us", npyArray("'<i8'", n_by_4, rowsForNumpy(xytp, 1e3)), "x,y,t,p, t in us");
  addRow("x y p t, whole reals", npyArray("'<f8'", n_by_4, rowsForNumpy(xypt, 1e3)), "x,y,p,t, t in us");
  addRow("in columns", npyArray("'<i8'", n_by_4, columns(xytp, 1e3), true), "x,y,t,p, t in us");
  addRow("transposed", npyArray("'<i8'", four_by_n, columns(xytp, 1e3)), "x,y,t,p, t in us");
  addRow("transposed, in columns", npyArray("'<i8'", four_by_n, rowsForNumpy(xytp, 1e3), true),
         "x,y,t,p, t in us");
  addRow("EVIMO",
         zipArchive({{"events.npy", npyArray("'<f8'", n_by_4, rowsForNumpy(txyp, 1e9)), true},
                     {"K.npy", npyArray("'<f8'", "(3, 3)", std::string(72, '\0')), true},
                     {"pose.npy", npyArray("'<f8'", "(4, 4)", std::string(128, '\0')), true}}),
         "");
  addRow("in columns, deflated",
         zipArchive({{"arr_0.npy", npyArray("'<i8'", n_by_4, columns(xytp, 1e3), true), true}}),
         "x,y,t,p, t in us");
}

void addArchives() {
  for (const bool deflate : {false, true}) {
    const char* how = deflate ? "deflated" : "stored";
    const auto row = [&](const char* name, const std::string& bytes, const char* guess = "us") {
      QTest::addRow("%s, %s", name, how) << QByteArray::fromStdString(bytes) << QString(guess);
    };
    row("vid2e", zipArchive(fourArrays(deflate)));
    row("prefixed", zipArchive(fourArrays(deflate, "event_")));
    row("in a folder", zipArchive(fourArrays(deflate, "events/")));
    row("N-ImageNet", zipArchive({{"event_data.npy", tonic(), deflate}}));
    row("EVIMO2",
        zipArchive({{"dataset_events_t.npy", column('t', "<f8", 1e9), deflate},
                    {"dataset_events_xy.npy",
                     npyArray("'<u2'", shape(kCount, " 2"), rowsForNumpy({{'x', "<u2"}, {'y', "<u2"}}, 1.0)),
                     deflate},
                    {"dataset_events_p.npy",
                     npyArray("'|u1'", shape(kCount, " 1"), rowsForNumpy({{'p', "|u1"}}, 1.0)), deflate}}),
        "");
    row("xyp",
        zipArchive(
            {{"t.npy", npyArray("'<f8'", shape(kCount, " 1"), rowsForNumpy({{'t', "<f8"}}, 1e9)), deflate},
             {"xyp.npy",
              npyArray("'<i2'", shape(kCount, " 3"), columns({{'x', "<i2"}, {'y', "<i2"}, {'p', "<i2"}}, 1.0),
                       true),
              deflate}}),
        "");
    std::vector<ZipFile> large = fourArrays(deflate), images = fourArrays(deflate);
    for (ZipFile& file : large) file.in_64 = true;
    row("zip64", zipArchive(large));
    row("zip64's end", zipArchive(large, true));
    row("comment", zipArchive(fourArrays(deflate), false, "written by PK\5\6 somebody"));
    images.insert(images.begin(),
                  {"timestamps.npy", npyArray("'<f8'", "(3,)", std::string(24, '\0')), deflate});
    row("times of images in addition", zipArchive(images));
  }
}

void TestNumpy::layouts_areRead_data() {
  QTest::addColumn<QByteArray>("bytes");
  QTest::addColumn<QString>("guess");  // part of the remark; empty: no remark
  addStructured();
  addTables();
  addArchives();
}

void TestNumpy::layouts_areRead() {
  QFETCH(QByteArray, bytes);
  QFETCH(QString, guess);
  const Contents contents = read(bytes.toStdString());
  QCOMPARE(contents.streams.at(0).name, "events");
  QCOMPARE(contents.streams.at(0).messages, std::uint64_t{kCount});
  QCOMPARE(contents.events.at(0).size(), kCount);
  QVERIFY(sameEvents(contents.events.at(0), theEvents()));
  QCOMPARE(contents.hasFault(FaultKind::Guess), !guess.isEmpty());
  QVERIFY(contents.faults.size() <= 1);
  if (!guess.isEmpty())
    QVERIFY2(contents.faults[0].text.find(guess.toStdString()) != std::string::npos,
             contents.faults[0].text.c_str());
}

void TestNumpy::units_areNamedOrGuessed_data() {
  QTest::addColumn<QString>("name");
  QTest::addColumn<QString>("type");
  QTest::addColumn<double>("first");
  QTest::addColumn<double>("step");  // between events
  QTest::addColumn<qint64>("last_ns");
  QTest::addColumn<bool>("guessed");
  const auto row = [](const char* tag, const char* name, const char* type, double first, double step,
                      qint64 last_ns, bool guessed) {
    QTest::newRow(tag) << name << type << first << step << last_ns << guessed;
  };
  constexpr qint64 kSteps = kCount - 1;
  row("us", "t", "<i8", 0, 10, 10'000 * kSteps, true);
  row("too slow for us", "t", "<i8", 0, 30'000, 30'000 * kSteps, true);
  row("ns since 1970", "timestamps", "<i8", 1.7e18, 1024, 1'700'000'000'000'000'000 + 1024 * kSteps, true);
  row("ns by name", "t_ns", "<u8", 0, 10, 10 * kSteps, false);
  row("us by name", "timestamp_us", "<f8", 0, 0.5, 500 * kSteps, false);
  row("ms by name", "time_ms", "<u4", 0, 2, 2'000'000 * kSteps, false);
  row("s by name", "t_s", "<i4", 0, 1, 1'000'000'000 * kSteps, false);
  row("s", "ts", "<f8", 0, 0.0005, 500'000 * kSteps, false);
  row("us with fractions", "ts", "<f8", 0, 10.25, 10'250 * kSteps, true);
}

void TestNumpy::units_areNamedOrGuessed() {
  QFETCH(QString, name);
  QFETCH(QString, type);
  QFETCH(double, first);
  QFETCH(double, step);
  QFETCH(qint64, last_ns);
  QFETCH(bool, guessed);
  std::vector<ZipFile> files = fourArrays(false);
  std::string times;
  for (std::size_t i = 0; i < kCount; ++i)
    times += value(first + step * static_cast<double>(i), type.toStdString());
  files[2] = {name.toStdString() + ".npy", npyArray("'" + type.toStdString() + "'", shape(), times)};
  const Contents contents = read(zipArchive(files));
  QCOMPARE(contents.events.at(0).back().time_ns, last_ns);
  QCOMPARE(contents.hasFault(FaultKind::Guess), guessed);
}

void TestNumpy::twoCameras_areTwoStreams() {
  std::vector<ZipFile> files = fourArrays(false, "left_");
  for (const ZipFile& file : fourArrays(true, "right_")) files.push_back(file);
  const std::filesystem::path path = write(zipArchive(files));
  const Contents contents = readAll(path);
  QCOMPARE(contents.streams.size(), std::size_t{2});
  QCOMPARE(contents.streams[0].name, "left");
  QCOMPARE(contents.streams[1].name, "right");
  for (const std::size_t stream : {0, 1}) QVERIFY(sameEvents(contents.events.at(stream), theEvents()));
  const std::unique_ptr<RecordingReader> reader = openRecording(path);
  reader->select({1});
  const Contents right = readAll(*reader);
  QVERIFY(!right.events.contains(0));
  QCOMPARE(right.eventCount(), kCount);
  QCOMPARE(reader->fractionRead(), 1.0);
}

void TestNumpy::offsetAndSize_areTaken() {
  constexpr std::int64_t kOffset_us = 1'605'537'493'718'345;
  std::vector<ZipFile> files = fourArrays(true);
  files.push_back({"t_offset.npy", npyArray("'<i8'", "()", rawNumber(kOffset_us))});
  files.push_back({"width.npy", npyArray("'<i8'", "()", rawNumber(std::int64_t{64}))});
  files.push_back({"height.npy", npyArray("'<i4'", "(1,)", rawNumber(std::int32_t{48}))});
  const Contents contents = read(zipArchive(files));
  QCOMPARE(contents.streams[0].resolution_px, (Resolution{64, 48}));
  QCOMPARE(contents.events.at(0).front().time_ns, kNumpyStart_ns + 1000 * kOffset_us);
}

void TestNumpy::folderOfArrays_isOneRecording() {
  scratch_.write("evimo2/dataset_events_t.npy", column('t', "<f8", 1e9));
  scratch_.write("evimo2/dataset_events_p.npy", column('p', "|u1"));
  const std::filesystem::path xy =
      scratch_.write("evimo2/dataset_events_xy.npy",
                     npyArray("'<u2'", shape(kCount, " 2"), rowsForNumpy({{'x', "<u2"}, {'y', "<u2"}}, 1.0)));
  scratch_.write("evimo2/dataset_depth.npz", zipArchive({{"depth_0.npy", tonic()}}));
  const Contents contents = readAll(xy.parent_path());
  QVERIFY(sameEvents(contents.events.at(0), theEvents()));
  QVERIFY2(contents.faults.at(0).text.find("dataset_depth.npz") != std::string::npos,
           contents.faults[0].text.c_str());
  const std::string said = errorOf([&] { openRecording(xy); });
  QVERIFY2(said.find("give the folder") != std::string::npos, said.c_str());
}

// Files numbered without leading zeros; the third is not an archive, the second has no events.
void TestNumpy::numberedFiles_areReadOneAfterAnother() {
  const std::vector<Event> events = theEvents();
  std::size_t begin = 0;
  for (const int file : {9, 10, 11, 100}) {
    const std::vector<Event> part(events.begin() + static_cast<std::ptrdiff_t>(begin),
                                  events.begin() + static_cast<std::ptrdiff_t>(begin + 700));
    begin += 700;
    std::vector<ZipFile> files;
    for (const char name : {'x', 'y', 't', 'p'})
      files.push_back(
          {std::string(1, name) + ".npy",
           npyArray("'<i8'", shape(part.size()), rowsForNumpy({{name, "<i8"}}, 1000.0, 0.0, part)), true});
    scratch_.write("numbered/" + std::to_string(file) + ".npz", zipArchive(files));
  }
  scratch_.write("numbered/8.npz", "not an archive");
  std::vector<ZipFile> none;
  for (const char name : {'x', 'y', 't', 'p'})
    none.push_back({std::string(1, name) + ".npy", npyArray("'<i8'", "(0,)", "")});
  scratch_.write("numbered/12.npz", zipArchive(none));
  scratch_.write("numbered/13.npz", zipArchive({{"z.npy", column('x', "<u2")}}));
  const Contents contents = readAll(scratch_ / "numbered");
  QVERIFY(sameEvents(contents.events.at(0), {events.begin(), events.begin() + 2800}));
  std::string said;
  for (const RecordingFault& fault : contents.faults) said += fault.text;
  QVERIFY2(said.find("13.npz is left out") != std::string::npos, said.c_str());
}

void TestNumpy::objects_areNeverUnpickled() {
  const std::string pickle = npyArray("'|O'", "(1,)", "\x80\x04}q.");
  const std::string said = errorOf([&] { read(pickle); });
  QVERIFY2(said.find("Python objects, not events, and are never unpickled") != std::string::npos,
           said.c_str());
  std::vector<ZipFile> files = fourArrays(true);
  files.push_back({"meta.npy", pickle, true});
  const Contents contents = read(zipArchive(files));
  QCOMPARE(contents.eventCount(), kCount);
  QVERIFY(contents.hasFault(FaultKind::Unreadable));
  const std::string fields =
      npyArray("[('x', '<i2'), ('y', '<i2'), ('p', '|b1'), ('t', '<i8'), ('who', '|O')]", shape(), "");
  QVERIFY(errorOf([&] { read(fields); }).find("never unpickled") != std::string::npos);
}

void TestNumpy::whatIsNotRead_isSaid() {
  std::vector<ZipFile> files = fourArrays(false);
  files.push_back({"imu.npy", npyArray("'<f8'", "(2, 7)", std::string(112, '\0'))});
  files.push_back({"frames.npy", npyArray("'|u1'", "(3, 4, 5)", std::string(60, '\0'))});
  files.push_back({"readme.txt", "not an array"});
  const Contents contents = read(zipArchive(files));
  QVERIFY(contents.hasFault(FaultKind::ImuLeftOut));
  QCOMPARE(contents.streams.size(), std::size_t{2});
  QCOMPARE(contents.streams[1].type, StreamType::Frames);
  QCOMPARE(contents.streams[1].messages, std::uint64_t{3});
  QVERIFY(!contents.streams[1].readable);
  files.erase(files.begin() + 3);
  const std::string said = errorOf([&] { read(zipArchive(files)); });
  QVERIFY2(said.find("x, y, t are not events without p") != std::string::npos, said.c_str());
}

void TestNumpy::rowsThatAreNoEvents_areLeftOut() {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const double table[][4] = {{1.5, 1, 2, 1},   {kNone, 1, 2, 1}, {1.6, -1, 2, 1},    {1.7, 1, 65536, 1},
                             {1.8, 1.5, 2, 1}, {1e300, 1, 2, 1}, {1.9, kNone, 2, 0}, {2.0, 3, 65535, 0}};
  std::string bytes;
  for (const auto& row : table)
    for (const double number : row) bytes += rawNumber(number);
  const Contents contents =
      read(npyArray("[('t_s', '<f8'), ('x', '<f8'), ('y', '<f8'), ('p', '<f8')]", "(8,)", bytes));
  QVERIFY(sameEvents(contents.events.at(0), {{1'500'000'000, 1, 2, true}, {2'000'000'000, 3, 65535, false}}));
  QCOMPARE(contents.faults.size(), std::size_t{2});
  QVERIFY2(contents.faults[0].text.starts_with("2 rows have no time"), contents.faults[0].text.c_str());
  QVERIFY2(contents.faults[1].text.starts_with("4 rows have invalid pixel coordinates"),
           contents.faults[1].text.c_str());
  QVERIFY(contents.faults[1].text.ends_with("from row 2 on."));
}

void TestNumpy::stepsBack_areSortedOrEndAPacket() {
  std::vector<Event> events = theEvents();
  std::swap(events[5].time_ns, events[6].time_ns);
  for (std::size_t i = 1000; i < events.size(); ++i) events[i].time_ns -= 1'000'000'000;
  const std::filesystem::path path =
      write(npyArray(kTonicDescr, shape(), rowsForNumpy(kTonic, 1000.0, 0.0, events)));
  const std::unique_ptr<RecordingReader> reader = openRecording(path);
  Packet packet;
  std::vector<std::size_t> sizes;
  while (reader->read(packet)) {
    QVERIFY(std::is_sorted(packet.events.begin(), packet.events.end(),
                           [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; }));
    sizes.push_back(packet.events.size());
  }
  QCOMPARE(sizes, (std::vector<std::size_t>{1000, kCount - 1000}));
  const auto isUnsorted = [](const RecordingFault& fault) { return fault.kind == FaultKind::Unsorted; };
  QVERIFY(std::any_of(reader->faults().begin(), reader->faults().end(), isUnsorted));
}

void TestNumpy::timesOfFewBits_areSaid() {
  for (const double start_s : {0.0, 500.0}) {
    std::string bytes;
    for (int i = 0; i < 100; ++i)
      for (const double part : {start_s + 0.001 * i + 0.0005, 3.0, 4.0, 1.0})
        bytes += rawNumber(static_cast<float>(part));
    const Contents contents = read(npyArray("'<f4'", "(100, 4)", bytes));
    QCOMPARE(contents.eventCount(), std::size_t{100});
    const bool said = contents.hasFault(FaultKind::Encoding);
    QCOMPARE(said, start_s > 0.0);
    if (said)
      QVERIFY2(contents.faults[0].text.find("0.031 ms") != std::string::npos,
               contents.faults[0].text.c_str());
  }
}

void TestNumpy::everyCut_isSaid_data() {
  QTest::addColumn<QByteArray>("bytes");
  QTest::newRow("array") << QByteArray::fromStdString(tonic());
  QTest::newRow("stored") << QByteArray::fromStdString(zipArchive(fourArrays(false)));
  QTest::newRow("deflated") << QByteArray::fromStdString(zipArchive(fourArrays(true)));
}

void TestNumpy::everyCut_isSaid() {
  QFETCH(QByteArray, bytes);
  const std::vector<Event> whole = theEvents();
  for (qsizetype size = bytes.size() - 1; size > 8; size -= 1 + size / 50) {
    Contents contents;
    const std::string said = errorOf([&] { contents = read(bytes.left(size).toStdString()); });
    if (!said.empty()) continue;
    QVERIFY(contents.hasFault(FaultKind::Truncated));
    QVERIFY(contents.eventCount() < whole.size());
    const std::vector<Event>& events = contents.events[0];
    QVERIFY(std::equal(events.begin(), events.end(), whole.begin(), [](const Event& a, const Event& b) {
      return a.time_ns == b.time_ns && a.x_px == b.x_px;
    }));
  }
}

void TestNumpy::lies_areRefused_data() {
  QTest::addColumn<QByteArray>("bytes");
  QTest::addColumn<QString>("said");
  const auto row = [](const char* name, const std::string& bytes, const char* said) {
    QTest::newRow(name) << QByteArray::fromStdString(bytes) << QString(said);
  };
  const std::string good = npyHeader(kTonicDescr, shape());
  row("shape beyond all numbers", npyFile(npyHeader(kTonicDescr, "(4611686018427387904, 4)"), ""),
      "impossible shape");
  row("negative shape", npyFile(npyHeader(kTonicDescr, "(-3,)"), ""), "array's header is damaged");
  row("no shape", npyFile("{'descr': '<u2', 'fortran_order': False}", ""), "does not state type");
  row("no dictionary", npyFile("import os", ""), "array's header is damaged");
  row("not closed", npyFile("{'descr': '<u2", ""), "array's header is damaged");
  row("brackets without end", npyFile(std::string(9000, '['), ""), "array's header is damaged");
  std::string nested = "'<u2'";
  for (int i = 0; i < 14; ++i) nested = "[('x', " + nested + ")]";
  row("types within types", npyFile(npyHeader(nested, shape()), ""), "nested too deeply");
  row("version", npyFile(good, "", 9), "format 9");
  row("header of 4 GB", "\x93NUMPY\2" + std::string(1, '\0') + "\xF0\xFF\xFF\xFF" + good,
      "claims 4294967280 bytes");
  row("header cut", npyFile(good, "").substr(0, 40), "array's header is cut off");
  row("unknown type", npyFile(npyHeader("'<q2'", shape()), ""), "not events");
  row("huge element", npyFile(npyHeader("'|V99999999999999999999'", shape()), ""), "is unknown");
  row("huge elements", npyFile(npyHeader("[('x', '|V65536'), ('y', '|V65536')]", shape()), ""), "too large");
  row("huge list", npyFile(npyHeader("[('x', '<u2', (4294967296, 4294967296))]", shape()), ""), "is unknown");
  row("nothing", npyFile(npyHeader("'|V0'", shape()), ""), "no bytes");
  row("one column", npyArray("'<u2'", shape(), rowsForNumpy({{'x', "<u2"}}, 1.0)), "give the folder");
  row("boxes", npyArray("[('t', '<u8'), ('x', '<f4'), ('y', '<f4'), ('w', '<f4')]", "(0,)", ""),
      "not events");
  row("quaternions", npyArray("'<f8'", "(2, 4)", std::string(16, '?') + std::string(48, '\x3F')),
      "not events");
  row("no arrays", zipArchive({{"events.txt", "0 1 2 1\n"}}), "ZIP archive");
  row("archive cut", zipArchive(fourArrays(false)).substr(0, 30'000), "directory");
  std::string archive = zipArchive(fourArrays(true));
  archive[archive.rfind("PK\5\6") + 16] = '\x7F';
  row("directory elsewhere", archive, "directory");
  archive = zipArchive(fourArrays(true));
  archive[archive.rfind("PK\1\2") + 10] = 12;
  row("packed otherwise", archive, "method 12");
  archive = zipArchive(fourArrays(true));
  archive[archive.rfind("PK\1\2") + 8] = 1;
  row("encrypted", archive, "without p");
}

void TestNumpy::lies_areRefused() {
  QFETCH(QByteArray, bytes);
  QFETCH(QString, said);
  const std::string error = errorOf([&] { read(bytes.toStdString()); });
  QVERIFY2(QString::fromStdString(error).contains(said), error.empty() ? "read" : error.c_str());
}

void TestNumpy::damage_isSaid_data() {
  QTest::addColumn<QByteArray>("bytes");
  QTest::addColumn<qsizetype>("events");
  QTest::addColumn<QString>("kind");
  QTest::addColumn<QString>("said");
  const auto row = [](const char* name, const std::string& bytes, std::size_t events, FaultKind kind,
                      const char* said) {
    QTest::newRow(name) << QByteArray::fromStdString(bytes) << static_cast<qsizetype>(events) << nameOf(kind)
                        << said;
  };
  row("a million million rows", tonic(1'000'000'000'000), kCount, FaultKind::Truncated,
      "states 1000000000000 rows and has 3000");
  std::vector<ZipFile> files = fourArrays(false);
  files[3].content = npyArray("'|i1'", "(10,)", std::string(10, '\1'));
  row("one is shorter", zipArchive(files), 10, FaultKind::Truncated, "the first 10 are read");
  for (const bool deflate : {false, true}) {
    files = fourArrays(deflate);
    files[1].claimed_checksum = 1;
    row(deflate ? "checksum, deflated" : "checksum, stored", zipArchive(files), kCount, FaultKind::Corrupt,
        "y: the checksum is wrong");
  }
  files = {{"events.npy", tonic(2 * kCount), true}};
  files[0].claimed_bytes = std::uint64_t{1} << 31;
  row("fewer bytes than claimed", zipArchive(files), kCount, FaultKind::Truncated,
      "fewer rows than it states");
  files = {{"events.npy", tonic(), true}};
  files[0].left_out_bytes = 500;
  QTest::newRow("packed bytes end early")
      << QByteArray::fromStdString(zipArchive(files)) << qsizetype{-1} << nameOf(FaultKind::Truncated)
      << "events: it ends before it should";
  std::string bad = zipArchive({{"events.npy", tonic(), true}});
  for (std::size_t i = bad.size() / 2; i < bad.size() / 2 + 10; ++i) bad[i] = static_cast<char>(~bad[i]);
  QTest::newRow("bytes changed") << QByteArray::fromStdString(bad) << qsizetype{-1} << ""
                                 << "events: ";
  files = fourArrays(false);
  std::string types;
  for (std::size_t i = 0; i < kCount; ++i) types += static_cast<char>(i % 4);
  files[3].content = npyArray("'|i1'", shape(kCount), types);
  row("types for polarities", zipArchive(files), kCount / 2, FaultKind::Corrupt,
      "polarity other than 1, 0 and -1");
  files = fourArrays(false);
  files.push_back({"frames.npy", "\x93NUMPY\1"});
  row("another array", zipArchive(files), kCount, FaultKind::Corrupt, "frames.npy is left out");
}

void TestNumpy::damage_isSaid() {
  QFETCH(QByteArray, bytes);
  QFETCH(qsizetype, events);
  QFETCH(QString, kind);
  QFETCH(QString, said);
  const Contents contents = read(bytes.toStdString());
  if (events >= 0) QCOMPARE(static_cast<qsizetype>(contents.eventCount()), events);
  if (events < 0) QVERIFY(contents.eventCount() > 0 && contents.eventCount() <= kCount);
  const auto matches = [&](const RecordingFault& fault) {
    return (kind.isEmpty() || nameOf(fault.kind) == kind) &&
           fault.text.find(said.toStdString()) != std::string::npos;
  };
  std::string all;
  for (const RecordingFault& fault : contents.faults)
    all += std::string(nameOf(fault.kind)) + ": " + fault.text + "\n";
  QVERIFY2(std::any_of(contents.faults.begin(), contents.faults.end(), matches), all.c_str());
}

std::size_t residentBytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t size = 0, resident = 0;
  file >> size >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// 130 MB that deflate to 130 kB; the same uncompressed, and with its columns far apart.
void TestNumpy::memory_doesNotGrow() {
  constexpr std::size_t kRows = 10'000'000, kMax_bytes = std::size_t{16} << 20;
  std::vector<std::filesystem::path> paths;
  {
    const std::string data(kRows * 13, '\0');
    paths.push_back(write(zipArchive({{"events.npy", npyArray(kTonicDescr, shape(kRows), data), true}})));
    paths.push_back(write(npyArray(kTonicDescr, shape(kRows), data)));
    std::vector<ZipFile> files;
    for (const char* name : {"x", "y", "t", "p"})
      files.push_back(
          {std::string(name) + ".npy", npyArray("'|u1'", shape(kRows), data.substr(0, kRows)), true});
    paths.push_back(write(zipArchive(files)));
  }
  for (const std::filesystem::path& path : paths) {
    const std::size_t before = residentBytes();
    std::size_t most = before, count = 0;
    const std::unique_ptr<RecordingReader> reader = openRecording(path);
    Packet packet;
    while (reader->read(packet)) {
      count += packet.events.size();
      most = std::max(most, residentBytes());
    }
    QCOMPARE(count, kRows);
    QVERIFY2(most - before < kMax_bytes, std::to_string(most - before).c_str());
  }
}

void TestNumpy::conversion_keepsEvents() {
  ConversionRequest request;
  request.input = write(zipArchive(fourArrays(true)));
  request.output = scratch_ / "converted.bag";
  class Silence : public ProgressSink {
   public:
    void stageStarted(const ProgressStage& /*stage*/) override {}
    void stageProgress(double /*fraction*/) override {}
    void log(LogLevel /*level*/, std::string_view /*text*/) override {}
  } silence;
  QCOMPARE(convertRecording(request, RunContext{silence}).events, std::uint64_t{kCount});
  const Contents contents = readAll(request.output);
  QVERIFY(sameEvents(contents.events.at(0), theEvents()));
  QCOMPARE(contents.streams[0].resolution_px, (Resolution{64, 46}));  // their range
}

// The real one, if installed (python3-h5py includes it).
void TestNumpy::filesOfNumpyItself_areRead() {
  constexpr const char* kScript = R"(
import numpy as np
i = np.arange(3000)
x, y, p, t = i * 7 % 64, i * 3 % 48, i % 3 == 0, 5000000 + i * 10
a = np.zeros(3000, dtype=[('t', '<i8'), ('x', '<u2'), ('y', '<u2'), ('p', '?')])
a['t'], a['x'], a['y'], a['p'] = t, x, y, p
np.save('structured.npy', a)
np.save('record.npy', a.view(np.recarray))
aligned = np.zeros(3000, dtype=np.dtype([('p', '?'), ('t', '>f8'), ('x', '<f2'), ('y', '<u4')], align=True))
aligned['t'], aligned['x'], aligned['y'], aligned['p'] = t * 1e-6, x, y, p
np.save('aligned.npy', aligned)
np.save('rows.npy', np.stack([t * 1e-6, x, y, p], axis=1))
np.save('fortran.npy', np.asfortranarray(np.stack([x, y, t, p], axis=1)))
np.savez('arrays.npz', x=x, y=y, t=t, p=p, more=np.array({'a': 1}))
np.savez_compressed('packed.npz', x=x, y=y, timestamps=t, polarity=p.astype(np.int8) * 2 - 1, t_offset=0)
np.savez_compressed('events.npz', a)
)";
  QProcess python;
  python.setWorkingDirectory(QString::fromStdString(scratch_.path().string()));
  python.start("/usr/bin/python3", {"-c", kScript});
  if (!python.waitForFinished(60'000) || python.exitCode() != 0) QSKIP("NumPy is not installed");
  for (const char* file : {"structured.npy", "record.npy", "aligned.npy", "rows.npy", "fortran.npy",
                           "arrays.npz", "packed.npz", "events.npz"})
    QVERIFY2(sameEvents(readAll(scratch_ / file).events.at(0), theEvents()), file);
}

}  // namespace

EVICAL_TEST(TestNumpy)
#include "tst_numpy.moc"
