// Real images of checkerboards, if available: frames of a camera (Debian's opencv-doc), and accumulated
// events of a blinking screen (EVICAL_DATA). Their lenses are known from other estimates.
#include "core/frames/frame_tracker.h"
#include "core/intrinsics/estimate_intrinsics.h"
#include "tests/support/test_program.h"

#include <QDir>

#include <cmath>

namespace {

using namespace evical;

Board nineBySix(double spacing_m) {
  Board board;
  board.type = BoardType::Checkerboard;
  board.rows = 6;
  board.cols = 9;
  board.spacing_m = spacing_m;
  board.radius_m = 0.0;
  return board;
}

struct Calibrated {
  int pictures = 0, found = 0;
  IntrinsicsResult result;
};

Calibrated calibrate(const QDir& folder, const QString& pattern) {
  const Board board = nineBySix(0.03);
  FrameTracker tracker("camera", board, FrameOptions{});
  Calibrated calibrated;
  Resolution size;
  for (const QString& name : folder.entryList({pattern}, QDir::Files, QDir::Name)) {
    QFile file(folder.filePath(name));
    if (!file.open(QIODevice::ReadOnly)) continue;
    const QByteArray bytes = file.readAll();
    Frame frame;
    frame.format = FrameFormat::Encoded;
    frame.bytes.assign(bytes.begin(), bytes.end());
    const GrayImage image = decodeFrame(frame, name.toStdString());
    size = image.size_px;
    tracker.track(image, {2.0 * calibrated.pictures++, 0.0});
  }
  const BoardObservations seen = tracker.finish();
  calibrated.found = static_cast<int>(seen.views.size());
  IntrinsicsOptions options;
  options.min_views = 5;
  calibrated.result = estimateIntrinsics({board, size, seen, {}, {}}, options, {});
  const IntrinsicsResult& r = calibrated.result;
  qInfo("%d of %d found, f %.2f %.2f, c %.2f %.2f, k1 %.4f k2 %.4f, %.3f px RMS, normalised %.2f, %s",
        calibrated.found, calibrated.pictures, r.intrinsics.focal_length_px.x(),
        r.intrinsics.focal_length_px.y(), r.intrinsics.principal_point_px.x(),
        r.intrinsics.principal_point_px.y(), r.intrinsics.distortion[0], r.intrinsics.distortion[1],
        r.reprojection_rms_px, r.normalised_rms, r.reason.c_str());
  return calibrated;
}

class TestRealFrames : public QObject {
  Q_OBJECT
 private slots:
  void framesOfACamera_giveItsLens();
  void accumulatedEvents_giveTheirLens();
};

void TestRealFrames::framesOfACamera_giveItsLens() {
  const QDir folder("/usr/share/doc/opencv-doc/examples/data");
  if (!folder.exists("left01.jpg")) QSKIP("Debian's package opencv-doc is not installed");
  const Calibrated left = calibrate(folder, "left??.jpg");
  QCOMPARE(left.pictures, 13);
  QVERIFY(left.found >= 12);
  QVERIFY(std::abs(left.result.intrinsics.focal_length_px.x() / 534.0 - 1.0) < 0.004);
  QVERIFY(left.result.reprojection_rms_px < 0.35);
}

void TestRealFrames::accumulatedEvents_giveTheirLens() {
  const QDir folder(qEnvironmentVariable("EVICAL_DATA") + "/real/vector_blinking");
  if (qEnvironmentVariableIsEmpty("EVICAL_DATA") || !folder.exists("001.png"))
    QSKIP("EVICAL_DATA, the folder of sample recordings, is not set");
  const Calibrated events = calibrate(folder, "*.png");
  QCOMPARE(events.pictures, 75);
  QVERIFY(events.found >= 72);
  QVERIFY(std::abs(events.result.intrinsics.focal_length_px.x() / 327.3 - 1.0) < 0.004);
}

}  // namespace

EVICAL_TEST(TestRealFrames)
#include "tst_real_frames.moc"
