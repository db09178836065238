// Images in HDF5 in the layouts of M3ED and MVSEC, in files that h5py creates; skipped without it
// (python3-h5py).
#include "core/base/error.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

#include <QProcess>

using namespace evical;
using namespace evical::test;

class TestHdf5Frames : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase();
  void m3edsPictures_comeWithTheirTimes_data();
  void m3edsPictures_comeWithTheirTimes();
  void mvsecsPictures_haveRealTimes();
  void colours_areRgb();
  void otherPictures_areListedOnly();
  void differentNumbers_areSaid();
  void damagedChunk_losesItsPicturesOnly();
  void shortUnpackedChunk_losesItsPicturesOnly();

 private:
  bool write(const std::string& script) const;
  Contents read() const { return readEverything(folder_ / "a.h5"); }
  static std::size_t streamNamed(const Contents& contents, const std::string& name) {
    std::size_t i = 0;
    while (i < contents.streams.size() && contents.streams[i].name != name) ++i;
    return i;
  }
  ScratchFolder folder_;
};

// Events of one camera, and `pictures` of 6 x 4 pixels whose values increase by one.
bool TestHdf5Frames::write(const std::string& script) const {
  const std::string start = R"(
import h5py, numpy as np
f = h5py.File('a.h5', 'w'); n = 100; i = np.arange(n)
for name, values in (('x', i % 6), ('y', i % 4), ('t', i * 10), ('p', i % 2)):
    f['prophesee/left/' + name] = values.astype('i8' if name == 't' else 'u2')
pictures = np.arange(5 * 4 * 6).astype('u1').reshape(5, 4, 6, 1); ts = 100 + 40 * np.arange(5)
)";
  QProcess python;
  python.setWorkingDirectory(QString::fromStdString(folder_.path().string()));
  python.start("/usr/bin/python3", {"-c", QString::fromStdString(start + script)});
  const bool good = python.waitForFinished(120'000) && python.exitCode() == 0;
  if (!good) qWarning("%s", python.readAllStandardError().constData());
  return good;
}

void TestHdf5Frames::initTestCase() {
  QProcess python;
  python.start("/usr/bin/python3", {"-c", "import h5py"});
  if (!python.waitForFinished(120'000) || python.exitCode() != 0) QSKIP("python3-h5py is not installed");
}

void TestHdf5Frames::m3edsPictures_comeWithTheirTimes_data() {
  QTest::addColumn<QString>("options");
  QTest::newRow("contiguous") << "";
  QTest::newRow("a picture a chunk, gzip") << ", chunks=(1, 4, 6, 1), compression='gzip'";
  QTest::newRow("chunks across pictures, lzf") << ", chunks=(2, 3, 4, 1), compression='lzf'";
}

void TestHdf5Frames::m3edsPictures_comeWithTheirTimes() {
  QFETCH(QString, options);
  QVERIFY(write("f['ovc/ts'] = ts\nf.create_dataset('ovc/left/data', data=pictures" + options.toStdString() +
                ")"));
  const Contents contents = read();
  const std::size_t stream = streamNamed(contents, "ovc/left/data");
  const std::vector<Frame>& frames = contents.frames.at(stream);
  QCOMPARE(frames.size(), std::size_t{5});
  QCOMPARE(contents.eventCount(), 100u);
  for (std::size_t i = 0; i < 5; ++i) {
    QCOMPARE(frames[i].time_ns, (100 + 40 * static_cast<std::int64_t>(i)) * 1000);
    QVERIFY(frames[i].format == FrameFormat::Gray8);
    QCOMPARE(frames[i].size_px.width_px, 6);
    QCOMPARE(frames[i].size_px.height_px, 4);
    QCOMPARE(frames[i].row_bytes, std::size_t{6});
    QCOMPARE(frames[i].bytes.size(), std::size_t{24});
    QCOMPARE(int(frames[i].bytes[23]), int(24 * i + 23));
  }
  QCOMPARE(contents.streams[stream].resolution_px.width_px, 6);
  QCOMPARE(contents.streams[stream].messages, std::uint64_t{5});
  QVERIFY(contents.faults.empty());
  QCOMPARE(readAll(folder_ / "a.h5").frameCount(), 0u);  // by default
}

void TestHdf5Frames::mvsecsPictures_haveRealTimes() {
  QVERIFY(
      write("f['davis/left/image_raw_ts'] = 1.5 + 0.05 * np.arange(5)\n"
            "f['davis/left/image_raw'] = pictures[..., 0]"));
  const Contents contents = read();
  const std::vector<Frame>& frames = contents.frames.at(streamNamed(contents, "davis/left/image_raw"));
  QCOMPARE(frames.size(), std::size_t{5});
  QCOMPARE(frames[1].time_ns, 1'550'000'000);
}

void TestHdf5Frames::colours_areRgb() {
  QVERIFY(write("f['ovc/ts'] = ts\nf['ovc/rgb/data'] = np.repeat(pictures, 3, axis=3)"));
  const Contents contents = read();
  const Frame& frame = contents.frames.at(streamNamed(contents, "ovc/rgb/data"))[0];
  QVERIFY(frame.format == FrameFormat::Rgb8);
  QCOMPARE(frame.row_bytes, std::size_t{18});
  QCOMPARE(frame.bytes.size(), std::size_t{72});
}

void TestHdf5Frames::otherPictures_areListedOnly() {
  QVERIFY(write("f['ovc/ts'] = ts\nf['ovc/left/data'] = pictures.astype('u2')\nf['depth/data'] = pictures"));
  const Contents contents = read();
  QCOMPARE(contents.frameCount(), 0u);
  for (const char* name : {"ovc/left/data", "depth/data"}) {
    const StreamInfo& stream = contents.streams.at(streamNamed(contents, name));
    QVERIFY(stream.type == StreamType::Frames);
    QVERIFY(!stream.readable);
  }
  QVERIFY(contents.hasFault(FaultKind::Corrupt));  // states that the first one has 16 bits
}

void TestHdf5Frames::differentNumbers_areSaid() {
  QVERIFY(write("f['ovc/ts'] = ts[:3]\nf['ovc/left/data'] = pictures"));
  const Contents contents = read();
  QCOMPARE(contents.frameCount(), 3u);
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

void TestHdf5Frames::damagedChunk_losesItsPicturesOnly() {
  QVERIFY(write(R"(
f['ovc/ts'] = ts
d = f.create_dataset('ovc/left/data', data=pictures, chunks=(1, 4, 6, 1), compression='gzip')
place = d.id.get_chunk_info(2).byte_offset
f.close()
file = open('a.h5', 'r+b'); file.seek(place); file.write(b'\xff' * 8); file.close()
)"));
  const Contents contents = read();
  QCOMPARE(contents.frameCount(), 4u);
  QCOMPARE(contents.eventCount(), 100u);
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

// It states that no filter was used, but has fewer bytes than a chunk.
void TestHdf5Frames::shortUnpackedChunk_losesItsPicturesOnly() {
  QVERIFY(write(R"(
f['ovc/ts'] = ts
d = f.create_dataset('ovc/left/data', shape=(5, 4, 6, 1), dtype='u1', chunks=(1, 4, 6, 1), compression='gzip')
for i in (0, 1, 3, 4): d[i] = pictures[i]
d.id.write_direct_chunk((2, 0, 0, 0), b'short', filter_mask=1)
)"));
  const Contents contents = read();
  QCOMPARE(contents.frameCount(), 4u);
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

EVICAL_TEST(TestHdf5Frames)
#include "tst_hdf5_frames.moc"
