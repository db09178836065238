// h5py creates files of data sets and reads the files that we write; without it (python3-h5py) those tests
// are skipped.
#include "core/base/error.h"
#include "core/recording/recording_writer.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QProcess>
#include <QRegularExpression>

#include <cmath>

using namespace evical;
using namespace evical::test;

namespace {

constexpr const char* kPython = "/usr/bin/python3";

// A script's output; empty if it fails.
QString runPython(const std::string& script, const std::filesystem::path& folder) {
  QProcess python;
  python.setWorkingDirectory(QString::fromStdString(folder.string()));
  python.start(kPython, {"-c", QString::fromStdString("import h5py, numpy as np\n" + script)});
  if (!python.waitForFinished(120'000) || python.exitCode() != 0) {
    qWarning("%s", python.readAllStandardError().constData());
    return {};
  }
  return QString::fromUtf8(python.readAllStandardOutput()).trimmed() + " ";
}

bool hasH5py() {
  QProcess python;
  python.start(kPython, {"-c", "import h5py"});
  return python.waitForFinished(120'000) && python.exitCode() == 0 &&
         python.error() != QProcess::FailedToStart;
}

// The arrays that the scripts below store: 3000 events, 50 samples.
constexpr const char* kArrays = R"(
n = 3000; i = np.arange(n)
x = (i * 7 % 64).astype('u2'); y = (i * 3 % 48).astype('u2'); p = (i % 3 == 0).astype('u1'); t = 5 + 11 * i
m = 50; ts = 100 + 1000 * np.arange(m); w = np.ones((m, 3)) * [1, 2, 3]; a = np.ones((m, 3)) * [4, 5, 7.5]
)";

void compareWithArrays(const std::vector<Event>& events, std::int64_t offset_ns = 0) {
  QCOMPARE(events.size(), 3000u);
  for (std::size_t i = 0; i < events.size(); ++i) {
    QCOMPARE(events[i].time_ns, (5 + 11 * static_cast<std::int64_t>(i)) * 1000 + offset_ns);
    QCOMPARE(unsigned(events[i].x_px), unsigned(i * 7 % 64));
    QCOMPARE(unsigned(events[i].y_px), unsigned(i * 3 % 48));
    QCOMPARE(events[i].brighter, i % 3 == 0);
  }
}

struct Hdf5Sums {
  std::uint64_t events = 0, on = 0, x = 0, y = 0, t_us = 0, t_ns = 0;
};

Hdf5Sums sumsOfHdf5(const std::vector<Event>& events) {
  Hdf5Sums sums;
  for (const Event& event : events) {
    ++sums.events;
    sums.on += event.brighter ? 1 : 0;
    sums.x += event.x_px;
    sums.y += event.y_px;
    sums.t_ns += static_cast<std::uint64_t>(event.time_ns);
    sums.t_us += static_cast<std::uint64_t>(event.time_ns / 1000);
  }
  return sums;
}

}  // namespace

class TestHdf5 : public QObject {
  Q_OBJECT

 private slots:
  void evlibSample_matchesItsManifest();
  void metavisionSample_matchesItsManifest();
  void roundTrip_keepsEventsAndSamples();
  void dsecWriter_isReadByH5py();
  void dsecWriter_refusesWhatTheLayoutCannotHold();
  void layouts_areFound_data();
  void layouts_areFound();
  void timesInOtherUnits_areRecognised_data();
  void timesInOtherUnits_areRecognised();
  void wrappedCounters_areContinued();
  void namedColumns_areRead();
  void columnsThatAreNoEvents_areRefused();
  void tumVieFolder_isOneRecording();
  void lengthsThatDiffer_areStated();
  void missingDatasets_areBadInput();
  void unknownFilter_isNamed();
  void cutAnywhere_isBadInputOrStated();
  void damagedChunk_losesItsRowsOnly_data();
  void damagedChunk_losesItsRowsOnly();
  void damageAnywhere_neverCrashes();
  void contentOfOtherFiles_isRefused_data();
  void contentOfOtherFiles_isRefused();
  void foundByTheFuzzer_isRefused_data();
  void foundByTheFuzzer_isRefused();
  void programsEnd_isQuietAfterDamage();

 private:
  std::filesystem::path writeSample(std::size_t events) const;
  ScratchFolder folder_;
};

void TestHdf5::evlibSample_matchesItsManifest() {
  const Contents contents = readAll(test::sourcePath("tests/data/recordings/evlib_raw_events.hdf5"));
  QCOMPARE(contents.streams.size(), 1u);
  QCOMPARE(contents.streams[0].name, std::string("raw_events"));
  QCOMPARE(contents.streams[0].time_unit_ns, std::int64_t{1});
  const Hdf5Sums sums = sumsOfHdf5(contents.events.at(0));
  QCOMPARE(sums.events, 17u);
  QCOMPARE(sums.on, 0u);
  QCOMPARE(sums.x, 1103u);
  QCOMPARE(sums.y, 1801u);
  QCOMPARE(sums.t_ns, 57'663'991u);
  QVERIFY(contents.faults.empty());
}

void TestHdf5::metavisionSample_matchesItsManifest() {
  const Contents contents = readAll(test::sourcePath("tests/data/recordings/metavision_ecf.hdf5"));
  QCOMPARE(contents.streams.size(), 2u);
  QCOMPARE(contents.streams[0].resolution_px.width_px, 640);
  QVERIFY(contents.streams[1].type == StreamType::Triggers);
  QCOMPARE(contents.streams[1].messages, 1534u);
  const Hdf5Sums sums = sumsOfHdf5(contents.events.at(0));
  QCOMPARE(sums.events, 60'000u);
  QCOMPARE(sums.on, 18'663u);
  QCOMPARE(sums.x, 19'316'943u);
  QCOMPARE(sums.y, 20'785'843u);
  QCOMPARE(sums.t_us, 451'907'871'246u);
  QVERIFY(contents.faults.empty());
}

std::filesystem::path TestHdf5::writeSample(std::size_t count) const {
  const std::vector<Event> events = someEvents(count);
  const std::vector<ImuSample> samples = someSamples(count / 100);
  const std::filesystem::path path = folder_ / "sample.h5";
  const auto writer =
      createDsec(path, {{"a", StreamType::Events, "", {64, 48}}, {"b", StreamType::Imu, "", {}}});
  for (std::size_t i = 0; i < count / 1000; ++i) {
    writer->write(0, EventSpan(events).subspan(i * 1000, 1000));
    writer->write(1, std::span(samples).subspan(i * 10, 10));
  }
  writer->finish();
  return path;
}

void TestHdf5::roundTrip_keepsEventsAndSamples() {
  const std::filesystem::path path = writeSample(200'000);
  for (const auto& entry : std::filesystem::directory_iterator(path.parent_path()))
    QCOMPARE(entry.path().string().find(".part"), std::string::npos);
  const auto reader = openRecording(path);
  QCOMPARE(reader->format(), std::string("hdf5"));
  const Contents contents = readAll(*reader);
  QVERIFY(contents.faults.empty());
  QCOMPARE(contents.streams.size(), 2u);
  QCOMPARE(contents.streams[0].name, std::string("events"));
  QCOMPARE(contents.streams[0].resolution_px.height_px, 48);
  QCOMPARE(contents.streams[0].time_unit_ns, std::int64_t{1000});
  QCOMPARE(contents.streams[1].name, std::string("imu"));
  QVERIFY(sameEvents(contents.events.at(0), someEvents(200'000)));
  QVERIFY(sameSamples(contents.imu.at(1), someSamples(2'000)));
  QCOMPARE(reader->fractionRead(), 1.0);
}

void TestHdf5::dsecWriter_isReadByH5py() {
  if (!hasH5py()) QSKIP("python3-h5py is not installed");
  writeSample(10'000);
  // h5py has no Blosc: only the layout, the filter and unpacked data are tested.
  const QString printed = runPython(R"(
f = h5py.File('sample.h5', 'r')
e = f['events']
print([e[k].dtype.name for k in 'xypt'], e['t'].shape[0], f['ms_to_idx'].dtype.name, f['ms_to_idx'].shape[0],
      int(f['t_offset'][()]), e['x'].id.get_create_plist().get_filter(0)[0], f['imu/omega'].shape)
)",
                                    folder_.path());
  QCOMPARE(
      printed.trimmed(),
      QString("['uint16', 'uint16', 'uint8', 'uint32'] 10000 uint64 100 1700000000000000 32001 (100, 3)"));
}

void TestHdf5::dsecWriter_refusesWhatTheLayoutCannotHold() {
  const StreamInfo camera{"a", StreamType::Events, "", {64, 48}};
  QVERIFY_THROWS_EXCEPTION(CalibrationError, createDsec(folder_ / "two.h5", {camera, camera}));
  const auto writer = createDsec(folder_ / "long.h5", {camera});
  const std::vector<Event> events{{5'000, 1, 1, true}, {4'300'000'000'000, 1, 1, true}};
  QVERIFY_THROWS_EXCEPTION(CalibrationError, writer->write(0, events));
}

void TestHdf5::layouts_areFound_data() {
  QTest::addColumn<QString>("script");
  QTest::addColumn<QString>("events");
  QTest::addColumn<QString>("imu");
  QTest::addColumn<qlonglong>("offset_ns");
  const auto row = [](const char* name, const char* events, const char* imu, qlonglong offset_ns,
                      const char* script) { QTest::newRow(name) << script << events << imu << offset_ns; };
  row("DSEC with gzip", "events", "", 7'000'000, R"(
f['events/x'] = x; f['events/y'] = y; f['events/p'] = p; f['t_offset'] = np.int64(7000)
f.create_dataset('events/t', data=t.astype('u4'), compression='gzip', chunks=(100,), shuffle=True))");
  row("e2calib with LZF", "events", "", 0, R"(
for k, v in dict(x=x, y=y, p=p, t=t.astype('i8')).items(): f.create_dataset(k, data=v, compression='lzf', chunks=(700,)))");
  row("M3ED", "prophesee/left", "ovc/imu", 0, R"(
g = f.create_group('prophesee/left')
for k, v in dict(x=x, y=y, p=p.astype('i1'), t=t.astype('i8')).items():
  g.create_dataset(k, data=v, compression='lzf', shuffle=True, fletcher32=True, chunks=(512,))
g['calib/resolution'] = np.array([64, 48]); f['ovc/imu/ts'] = ts; f['ovc/imu/omega'] = w; f['ovc/imu/accel'] = a)");
  row("MVSEC, acceleration first", "davis/left/events", "davis/left/imu", 0, R"(
f['davis/left/events'] = np.stack([x, y, t * 1e-6, np.where(p, 1.0, -1.0)], axis=1)
f['davis/left/imu'] = np.hstack([a, w]); f['davis/left/imu_ts'] = ts * 1e-6)");
  row("MVSEC, rate first", "davis/left/events", "davis/left/imu", 0, R"(
f.create_dataset('davis/left/events', data=np.stack([x, y, t * 1e-6, np.where(p, 1.0, -1.0)], axis=1),
                 compression='gzip', chunks=(128, 2))
f['davis/left/imu'] = np.hstack([w, a]); f['davis/left/imu_ts'] = ts * 1e-6)");
  row("v2e, time first", "events", "", 0, R"(
f['events'] = np.stack([t, x, y, p], axis=1).astype('u4'))");
  row("evlib", "raw_events", "", 0, R"(
f['raw_events/x'] = x.astype('i4'); f['raw_events/y'] = y.astype('i4'); f['raw_events/p'] = p.astype(bool)
f['raw_events/t'] = t * 1e-6)");
  row("e2vid", "events", "", 0, R"(
f['events/xs'] = x; f['events/ys'] = y; f['events/ps'] = p.astype(bool); f['events/ts'] = t * 1e-6)");
  row("Metavision without compression", "CD/events", "", 0, R"(
d = np.zeros(n, dtype={'names': list('xypt'), 'formats': ['<u2', '<u2', '<i2', '<i8'],
                       'offsets': [0, 2, 4, 8], 'itemsize': 16})
d['x'] = x; d['y'] = y; d['p'] = p; d['t'] = t; f['CD/events'] = d; f.attrs['geometry'] = '64x48')");
  row("ns", "events", "", 0, R"(
f['events/x'] = x; f['events/y'] = y; f['events/p'] = p; f['events/t'] = 1000 * t + 1700000000000000000)");
}

void TestHdf5::layouts_areFound() {
  if (!hasH5py()) QSKIP("python3-h5py is not installed");
  QFETCH(QString, script);
  QFETCH(QString, events);
  QFETCH(QString, imu);
  QFETCH(qlonglong, offset_ns);
  QVERIFY(!runPython(kArrays + ("f = h5py.File('layout.h5', 'w')\n" + script.toStdString()) + "\nf.close()",
                     folder_.path())
               .isEmpty());
  const auto reader = openRecording(folder_ / "layout.h5");
  const std::size_t stream = findStream(*reader, events.toStdString(), StreamType::Events);
  const Contents contents = readAll(*reader);
  if (qstrcmp(QTest::currentDataTag(), "ns") == 0) offset_ns = 1'700'000'000'000'000'000;
  compareWithArrays(contents.events.at(stream), offset_ns);
  QVERIFY(contents.faults.empty());
  QCOMPARE(contents.sampleCount(), imu.isEmpty() ? 0u : 50u);
  if (imu.isEmpty()) return;
  const std::vector<ImuSample>& samples =
      contents.imu.at(findStream(*reader, imu.toStdString(), StreamType::Imu));
  QCOMPARE(samples[3].time_ns, std::int64_t{3'100'000});
  QVERIFY((samples[3].angular_rate_rad_s == Eigen::Vector3d(1, 2, 3)));
  QVERIFY((samples[3].specific_force_m_s2 == Eigen::Vector3d(4, 5, 7.5)));
}

// No sensor has 54045 pixels in a row: impossible coordinates are refused, and with other values of p it is
// not an event table.
void TestHdf5::timesInOtherUnits_areRecognised_data() {
  QTest::addColumn<QString>("times");  // of 3000 events in 3 s
  QTest::addColumn<QString>("said");
  QTest::newRow("us") << "1000 * i"
                      << "";
  QTest::newRow("s") << "0.001 * i"
                     << "";
  QTest::newRow("ns of the day") << "1700000000000000000 + 1000000 * i"
                                 << "";
  QTest::newRow("ns since the start") << "1000000 * i"
                                      << "read as ns";
  QTest::newRow("ms as real numbers") << "1.0 * i"
                                      << "read as ms";
}

void TestHdf5::timesInOtherUnits_areRecognised() {
  if (!hasH5py()) QSKIP("h5py is not installed");
  QFETCH(QString, times);
  QFETCH(QString, said);
  const std::string script = std::string(kArrays) + "t = " + times.toStdString() +
                             "\nwith h5py.File('unit.h5', 'w') as f:\n"
                             "    for k, v in dict(x=x, y=y, p=p, t=t).items(): f['events/' + k] = v\n"
                             "print('done')\n";
  QVERIFY(!runPython(script, folder_.path()).isEmpty());
  const Contents contents = readAll(folder_ / "unit.h5");
  const std::vector<Event>& events = contents.events.at(0);
  QCOMPARE(events.size(), std::size_t{3000});
  QCOMPARE(qint64(events[2999].time_ns - events[0].time_ns), qint64(2'999'000'000));
  QCOMPARE(contents.faults.size(), std::size_t{said.isEmpty() ? 0U : 1U});
  if (!said.isEmpty())
    QVERIFY2(contents.faults[0].text.find(said.toStdString()) != std::string::npos,
             contents.faults[0].text.c_str());
}

void TestHdf5::wrappedCounters_areContinued() {
  if (!hasH5py()) QSKIP("h5py is not installed");
  const std::string script = std::string(kArrays) +
                             "t = ((2**32 - 1000000 + 1000 * i) % 2**32).astype('u4')\n"
                             "with h5py.File('wrap.h5', 'w') as f:\n"
                             "    for k, v in dict(x=x, y=y, p=p, t=t).items(): f['events/' + k] = v\n"
                             "print('done')\n";
  QVERIFY(!runPython(script, folder_.path()).isEmpty());
  const Contents contents = readAll(folder_ / "wrap.h5");
  const std::vector<Event>& events = contents.events.at(0);
  QCOMPARE(qint64(events[2999].time_ns - events[0].time_ns), qint64(2'999'000'000));
  QVERIFY(contents.hasFault(FaultKind::TimeWrap));
}

void TestHdf5::namedColumns_areRead() {
  if (!hasH5py()) QSKIP("h5py is not installed");
  const std::string script =
      std::string(kArrays) +
      "with h5py.File('named.h5', 'w') as f:\n"
      "    for k, v in dict(u=x, v=y, sign=p, when=t, it=ts, w=w, a=a).items(): f['rec/' + k] = v\n"
      "print('done')\n";
  QVERIFY(!runPython(script, folder_.path()).isEmpty());
  try {
    openRecording(folder_ / "named.h5");
    QFAIL("accepted");
  } catch (const CalibrationError& error) {
    QVERIFY2(QString(error.what()).contains("columns:"), error.what());
  }
  const ColumnNames names = {{"camera", "t_us=rec/when, x=rec/u, y=/rec/v, p=rec/sign"},
                             {"imu", "t_us=rec/it,gyro=rec/w,accel=rec/a"}};
  const Contents contents = readAll(*openRecording(folder_ / "named.h5", names));
  QCOMPARE(contents.streams.size(), std::size_t{2});
  QCOMPARE(contents.streams[0].name, std::string("camera"));
  compareWithArrays(contents.events.at(0));
  QCOMPARE(contents.imu.at(1).size(), std::size_t{50});
  QVERIFY((contents.imu.at(1)[0].specific_force_m_s2 == Eigen::Vector3d(4.0, 5.0, 7.5)));
  QCOMPARE(qint64(contents.imu.at(1)[1].time_ns), qint64(1'100'000));
  for (const char* wrong : {"t_us=rec/when,x=rec/u,y=rec/nothing,p=rec/sign", "t_us=rec/when,x=rec/u"})
    QVERIFY_THROWS_EXCEPTION(CalibrationError, openRecording(folder_ / "named.h5", {{"camera", wrong}}));
}

void TestHdf5::columnsThatAreNoEvents_areRefused() {
  if (!hasH5py()) QSKIP("python3-h5py is not installed");
  QVERIFY(!runPython(kArrays + std::string(R"(
f = h5py.File('no_events.h5', 'w'); f['events'] = np.stack([x, y, t[::-1], t[::-1]], axis=1).astype('f8'); f.close()
f = h5py.File('types.h5', 'w')
f['events/x'] = x; f['events/y'] = y; f['events/t'] = t; f['events/p'] = (np.arange(n) % 4).astype('u1'); f.close())"),
                     folder_.path())
               .isEmpty());
  QVERIFY_THROWS_EXCEPTION(CalibrationError, openRecording(folder_ / "no_events.h5"));
  const Contents contents = readAll(folder_ / "types.h5");
  QVERIFY(contents.eventCount() > 0);
  for (const auto& [stream, events] : contents.events)
    for (std::size_t i = 0; i < events.size(); ++i) QCOMPARE(events[i].brighter, i % 2 == 1);
  QVERIFY(contents.faults.at(0).text.find("polarity other than 1, 0 and -1") != std::string::npos);
}

void TestHdf5::tumVieFolder_isOneRecording() {
  if (!hasH5py()) QSKIP("python3-h5py is not installed");
  const std::filesystem::path folder = folder_ / "tumvie";
  std::filesystem::create_directory(folder);
  QVERIFY(!runPython(kArrays + std::string(R"(
for side in ('left', 'right'):
  f = h5py.File('run-events_%s.h5' % side, 'w')
  f['events/x'] = x; f['events/y'] = y; f['events/p'] = p; f['events/t'] = t; f.close())"),
                     folder)
               .isEmpty());
  std::ofstream(folder / "imu_data.txt")
      << "# timestamp gx gy gz ax ay az temperature\n"
      << "443.0 1 2 3 4 5 6 38.1\n"
      << std::string(5000, '7') << "\nrubbish\n1685 1 2 3 4 5 6 38\n2000 1 2";
  const Contents contents = readAll(folder);
  QCOMPARE(contents.streams.size(), 3u);
  QCOMPARE(contents.streams[1].name, std::string("events_right"));
  compareWithArrays(contents.events.at(0));
  compareWithArrays(contents.events.at(1));
  const std::vector<ImuSample>& samples = contents.imu.at(2);
  QCOMPARE(samples.size(), 2u);
  QCOMPARE(samples[1].time_ns, std::int64_t{1'685'000});
  QVERIFY((samples[1].specific_force_m_s2 == Eigen::Vector3d(4, 5, 6)));
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

void TestHdf5::lengthsThatDiffer_areStated() {
  if (!hasH5py()) QSKIP("python3-h5py is not installed");
  runPython(kArrays + std::string(R"(
f = h5py.File('short.h5', 'w')
f['events/x'] = x; f['events/y'] = y[:-5]; f['events/p'] = p[:-70]; f['events/t'] = t; f.close())"),
            folder_.path());
  const Contents contents = readAll(folder_ / "short.h5");
  QCOMPARE(contents.eventCount(), 2930u);
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

void TestHdf5::missingDatasets_areBadInput() {
  if (!hasH5py()) QSKIP("python3-h5py is not installed");
  for (const char* script :
       {"f['events/x'] = x; f['events/y'] = y; f['events/t'] = t", "", "f['events/x'] = 3",
        "f['ovc/imu/ts'] = ts; f['ovc/imu/omega'] = w", "f.create_group('events')",
        "f['events/x'] = x; f['events/y'] = y; f['events/t'] = t; f['events/p'] = np.array(['a'] * n, "
        "dtype='S1')",
        "f.create_dataset('x', (10**12,), 'u2', chunks=True); f.create_dataset('y', (10**12,), 'u2', "
        "chunks=True)\n"
        "f.create_dataset('t', (10**12,), 'i8', chunks=True); f.create_dataset('p', (10**12,), 'u1', "
        "chunks=True)"}) {
    runPython(kArrays + (std::string("f = h5py.File('missing.h5', 'w')\n") + script) + "\nf.close()",
              folder_.path());
    QVERIFY_THROWS_EXCEPTION(CalibrationError, openRecording(folder_ / "missing.h5"));
  }
}

void TestHdf5::unknownFilter_isNamed() {
  std::string bytes = fileBytes(writeSample(1'000));
  // The filter's number is in the description of every dataset, as the id 32001 before the name "blosc".
  const std::string id("\x01\x7D", 2);
  for (std::size_t at = bytes.find(id); at != std::string::npos; at = bytes.find(id, at + 1))
    bytes[at] = '\x0F';
  try {
    openRecording(folder_.write("filter.h5", bytes));
    QFAIL("a file with an unknown filter was opened");
  } catch (const CalibrationError& error) {
    QVERIFY(error.problem().find("32015 (Zstandard)") != std::string::npos);
  }
}

void TestHdf5::cutAnywhere_isBadInputOrStated() {
  const std::string whole = fileBytes(writeSample(10'000));
  for (std::size_t length = 0; length < whole.size(); length += 101) {
    try {
      const Contents contents = readAll(folder_.write("cut.h5", whole.substr(0, length)));
      QVERIFY(!contents.faults.empty());
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
    }
  }
}

void TestHdf5::damagedChunk_losesItsRowsOnly_data() {
  QTest::addColumn<QString>("compression");
  QTest::newRow("LZF") << "lzf";
  QTest::newRow("gzip") << "gzip";
}

void TestHdf5::damagedChunk_losesItsRowsOnly() {
  if (!hasH5py()) QSKIP("python3-h5py is not installed");
  QFETCH(QString, compression);
  const QString place = runPython(R"(
n = 200000; i = np.arange(n)
f = h5py.File('chunk.h5', 'w')
for k, v in dict(x=(i % 64).astype('u2'), y=(i % 48).astype('u2'), p=(i % 2).astype('u1'), t=i).items():
  f.create_dataset('events/' + k, data=v, compression=')" +
                                      compression.toStdString() + R"(', chunks=(65536,))
print(f['events/t'].id.get_chunk_info(1).byte_offset))",
                                  folder_.path());
  std::string bytes = fileBytes(folder_ / "chunk.h5");
  bytes.replace(place.trimmed().toUInt() + 8, 64, std::string(64, '\xFF'));
  const Contents contents = readAll(folder_.write("chunk_damaged.h5", bytes));
  QCOMPARE(contents.eventCount(), 200'000u - 65'536u);
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
  QVERIFY(contents.faults[0].text.find("at byte " + place.trimmed().toStdString()) != std::string::npos);
}

// A file from a stranger must not make another one readable: its bytes would become events.
void TestHdf5::contentOfOtherFiles_isRefused_data() {
  QTest::addColumn<QString>("script");
  QTest::addColumn<QString>("name");
  QTest::newRow("external storage")
      << "f.create_dataset('events/x', (n,), 'u2', external=[('secret', 0, 2 * n)])"
      << "events/x";
  QTest::newRow("virtual dataset")
      << "v = h5py.VirtualLayout((n,), 'u2'); v[:] = h5py.VirtualSource('other.h5', 's', "
         "(n,)); f.create_virtual_dataset('events/x', v)"
      << "events/x";
  QTest::newRow("external link") << "f['events/x'] = h5py.ExternalLink('other.h5', 's')"
                                 << "events/x";
  QTest::newRow("linked offset") << "f['events/x'] = x; f['t_offset'] = h5py.ExternalLink('other.h5', 's')"
                                 << "t_offset";
}

void TestHdf5::contentOfOtherFiles_isRefused() {
  if (!hasH5py()) QSKIP("h5py is not installed");
  QFETCH(QString, script);
  QFETCH(QString, name);
  runPython(std::string(kArrays) + R"(
open('secret', 'wb').write(bytes([7]) * 2 * n)
h5py.File('other.h5', 'w')['s'] = np.full(n, 1799, 'u2')
f = h5py.File('elsewhere.h5', 'w')
f['events/y'] = y; f['events/p'] = p; f['events/t'] = t
)" + script.toStdString(),
            folder_.path());
  const QString says = "ontent of " + name + " is in another file, which is not opened";
  try {
    const Contents contents = readAll(folder_ / "elsewhere.h5");
    QCOMPARE(name, QString("t_offset"));
    compareWithArrays(contents.events.at(0));
    QVERIFY(contents.hasFault(FaultKind::Corrupt));
    QVERIFY2(QString::fromStdString(contents.faults.at(0).text).contains(says),
             contents.faults[0].text.c_str());
  } catch (const CalibrationError& error) {
    QVERIFY2(QString(error.what()).contains(says), error.what());
  }
}

void TestHdf5::foundByTheFuzzer_isRefused_data() {
  QTest::addColumn<QString>("file");
  QTest::addColumn<QString>("problem");
  QTest::newRow("a table as large as the address space") << "table_of_all_memory.h5"
                                                         << "damaged";
  // HDF5 1.14 reads zeros there, which are not events.
  QTest::newRow("rows that are not there") << "rows_of_nothing.h5"
                                           << "stores|is left out";
}

void TestHdf5::foundByTheFuzzer_isRefused() {
  QFETCH(QString, file);
  QFETCH(QString, problem);
  try {
    readAll(test::sourcePath("tests/fuzz/seeds/hdf5/" + file.toStdString()));
    QFAIL("read");
  } catch (const CalibrationError& error) {
    QVERIFY(error.kind() == ErrorKind::BadInput);
    QVERIFY2(QString::fromStdString(error.problem()).contains(QRegularExpression(problem)),
             error.problem().c_str());
  }
}

void TestHdf5::damageAnywhere_neverCrashes() {
  const std::string whole = fileBytes(writeSample(2'000));
  for (std::size_t at = 0; at < whole.size(); at += 97) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    try {
      QVERIFY(readAll(folder_.write("damaged.h5", damaged)).eventCount() <= 2'000u);
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
    }
  }
}

// At program end, HDF5's library used to complain about objects that were lost.
void TestHdf5::programsEnd_isQuietAfterDamage() {
  QProcess program;
  program.start(QCoreApplication::applicationFilePath(), {"tst_hdf5", "damageAnywhere_neverCrashes"});
  QVERIFY(program.waitForFinished(120'000));
  QCOMPARE(program.exitCode(), 0);
  QCOMPARE(program.readAllStandardError(), QByteArray());
}

EVICAL_TEST(TestHdf5)
#include "tst_hdf5.moc"
