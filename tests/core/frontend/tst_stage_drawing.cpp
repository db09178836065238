#include "core/frontend/stage_drawing.h"

#include "core/base/error.h"
#include "core/frontend/stage_image_writer.h"
#include "tests/core/frontend/synthetic_bursts.h"
#include "tests/support/test_program.h"

#include <png.h>

namespace {

using namespace evical;
using namespace evical::test;

BoardScene scene() {
  return MovingBoard().scene();
}

struct Rgb {
  int r, g, b;
};

Rgb at(const RgbImage& image, int x, int y) {
  const std::uint8_t* p = image.rgb.data() + 3 * (y * image.width_px + x);
  return {p[0], p[1], p[2]};
}

WindowTrace trackedBoard() {
  const MovingBoard moving;
  WindowTrace tracked;
  tracked.motion = moving.motionAt(0.0);
  tracked.ended = TrackingEnd::Held;
  for (int i = 0; i < moving.board.pointCount(); ++i) {
    CircleObservation circle;
    circle.circle = i;
    circle.centre_px = moving.imageAt(i, 0.0).centre_px;
    circle.covariance_px2 = 1e-3 * Eigen::Matrix2d::Identity();
    tracked.circles.push_back(circle);
  }
  return tracked;
}

class TestStageDrawing : public QObject {
  Q_OBJECT
 private slots:
  void bursts_areColouredByPolarityAndAge();
  void size_isAWholeMultiple();
  void png_isReadBackTheSame();
  void png_thatCannotBeWritten_saysWhere();
  void board_isDrawn();
  void search_isDrawnWhateverItsOutcome();
  void writer_writesEveryNth();
};

void TestStageDrawing::bursts_areColouredByPolarityAndAge() {
  const SyntheticWindow synthetic(
      {burstAt(10, 10, 0.01, true), burstAt(20, 10, -0.01, true), burstAt(30, 10, 0.01, false)});
  const RgbImage image = drawBursts(synthetic.window, scene(), "");
  const int factor = image.width_px / kDavis_px.width_px;
  const int bar = (image.height_px - factor * kDavis_px.height_px) / 2;
  const auto cell = [&](int x) { return at(image, factor * x + 1, bar + factor * 10 + 1); };
  QVERIFY(cell(10).r > cell(10).b);
  QVERIFY(cell(30).b > cell(30).r);
  QVERIFY(cell(20).r < cell(10).r / 2);  // older: fainter
  QVERIFY(cell(20).r > cell(40).r);
}

void TestStageDrawing::size_isAWholeMultiple() {
  const SyntheticWindow synthetic({});
  const RgbImage image = drawBursts(synthetic.window, scene(), "");
  QCOMPARE(image.width_px, 3 * kDavis_px.width_px);
  QCOMPARE(image.rgb.size(), static_cast<std::size_t>(3 * image.width_px * image.height_px));
}

void TestStageDrawing::png_isReadBackTheSame() {
  QTemporaryDir directory;
  RgbImage image{5, 3, {}};
  for (int k = 0; k < 45; ++k) image.rgb.push_back(static_cast<std::uint8_t>(5 * k));
  const QString path = directory.filePath("small.png");
  writePng(path.toStdString(), image);
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  QVERIFY(png_image_begin_read_from_file(&png, path.toUtf8().constData()));
  png.format = PNG_FORMAT_RGB;
  QCOMPARE(png.width, 5u);
  QCOMPARE(png.height, 3u);
  std::vector<std::uint8_t> read(PNG_IMAGE_SIZE(png));
  QVERIFY(png_image_finish_read(&png, nullptr, read.data(), 0, nullptr));
  QVERIFY(read == image.rgb);
}

void TestStageDrawing::png_thatCannotBeWritten_saysWhere() {
  try {
    writePng("/nowhere/at/all.png", RgbImage{1, 1, {0, 0, 0}});
    QFAIL("no error");
  } catch (const CalibrationError& error) {
    QCOMPARE(error.kind(), ErrorKind::BadInput);
    QCOMPARE(error.place(), std::string("/nowhere/at/all.png"));
  }
}

void TestStageDrawing::board_isDrawn() {
  const SyntheticWindow synthetic({});
  const WindowTrace tracked = trackedBoard();
  const RgbImage image = drawTrackedWindow(synthetic.window, tracked, scene());
  const int factor = image.width_px / kDavis_px.width_px;
  const int bar = (image.height_px - factor * kDavis_px.height_px) / 2;
  for (int i = 0; i < MovingBoard().board.pointCount(); ++i) {
    const OutlineImage circle = MovingBoard().imageAt(i, 0.0);
    const Eigen::Vector2d side = circle.centre_px + Eigen::Vector2d(std::sqrt(1.0 / circle.shape(0, 0)), 0.0);
    int brightest = 0;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx)
        brightest = std::max(brightest, at(image, static_cast<int>((side.x() + 0.5) * factor) + dx,
                                           bar + static_cast<int>((side.y() + 0.5) * factor) + dy)
                                            .g);
    }
    QVERIFY2(brightest > 100, qPrintable(QString::number(i)));
  }
}

void TestStageDrawing::search_isDrawnWhateverItsOutcome() {
  const SyntheticWindow synthetic({});
  BoardSearch search;
  QVERIFY(!drawSearch(synthetic.window, search, scene()).rgb.empty());
  search.candidates.push_back({{100.0, 100.0}, 8.0, {1.0, 0.0}, 0.0, 1.0});
  search.circles.push_back({{100.0, 100.0}, {50.0, 0.0}, 8.0, 0.1, 40, 16});
  search.lattice.push_back({0, 0, 0});
  search.motion = MovingBoard().motionAt(0.0);
  search.motion->ideal_from_board(2, 2) = 1e-9;  // any value that a failed search may leave behind
  QVERIFY(!drawSearch(synthetic.window, search, scene()).rgb.empty());
  const NormalFlowStages arcs = findArcs(synthetic.window, FrontEndOptions{});
  QVERIFY(!drawSearch(synthetic.window, search, scene(), &arcs).rgb.empty());
}

void TestStageDrawing::writer_writesEveryNth() {
  QTemporaryDir directory;
  const BoardScene the_scene = scene();
  const SyntheticWindow synthetic({});
  StageImageWriter writer(directory.filePath("deep/down").toStdString(), 3, the_scene);
  for (int k = 0; k < 7; ++k) writer.windowTracked(synthetic.window, trackedBoard());
  for (int k = 0; k < 2; ++k) writer.windowSearched(BoardSearch{}, 0);
  QCOMPARE(writer.imagesWritten(), 4);
  QCOMPARE(QDir(directory.filePath("deep/down")).entryList(QDir::Files, QDir::Name),
           QStringList({"search_0000.png", "window_0000.png", "window_0003.png", "window_0006.png"}));
}

}  // namespace

EVICAL_TEST(TestStageDrawing)
#include "tst_stage_drawing.moc"
