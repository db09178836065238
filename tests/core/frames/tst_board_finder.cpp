// Every kind of board in rendered images with a known truth: all points are found, in their order, with
// errors that agree with their covariances.
#include "core/base/error.h"
#include "core/frames/board_finder.h"
#include "core/frames/ideal_views.h"
#include "core/frames/views_from_frames.h"
#include "core/geometry/camera_model.h"
#include "tests/support/aruco_library.h"
#include "tests/support/rendered_board.h"
#include "tests/support/test_program.h"

#include <Eigen/LU>
#include <opencv2/core.hpp>

#include <cmath>
#include <ctime>

namespace {

using namespace evical;

Board boardOfBoardFinder(BoardType type, int rows, int cols, double spacing_m, double radius_m,
                         double tag_size_m) {
  Board board;
  board.type = type;
  board.rows = rows;
  board.cols = cols;
  board.spacing_m = spacing_m;
  board.radius_m = radius_m;
  board.tag_size_m = tag_size_m;
  return board;
}

PrintedBoard asymmetricCircles() {
  return {boardOfBoardFinder(BoardType::AsymmetricCircles, 11, 4, 0.05, 0.02, 0.0), 2, 0, false};
}
PrintedBoard brightCircles() {
  PrintedBoard printed{boardOfBoardFinder(BoardType::SymmetricCircles, 6, 9, 0.05, 0.018, 0.0), 2, 0, false};
  printed.board.circles = CircleShade::Bright;
  return printed;
}
PrintedBoard checkerboardForBoardFinder() {
  return {boardOfBoardFinder(BoardType::Checkerboard, 6, 9, 0.05, 0.0, 0.0), 2, 0, false};
}
PrintedBoard kalibrGrid() {
  return {boardOfBoardFinder(BoardType::AprilGrid, 6, 6, 0.088 * 1.3, 0.0, 0.088), 2, 0, false};
}
PrintedBoard plainGrid() {
  return {boardOfBoardFinder(BoardType::AprilGrid, 4, 5, 0.088 * 1.3, 0.0, 0.088), 1, 0, false};
}
PrintedBoard charuco() {
  return {boardOfBoardFinder(BoardType::Charuco, 7, 10, 0.05, 0.0, 0.037), 2, cv::aruco::DICT_5X5_250, false};
}
PrintedBoard legacyCharuco() {
  return {boardOfBoardFinder(BoardType::Charuco, 6, 9, 0.05, 0.0, 0.037), 2, cv::aruco::DICT_4X4_50, true};
}

// The board fills most of the picture.
double distanceFor(const Board& board) {
  return 1.15 * std::max(board.extent_m().x() * 460.0 / 600.0, board.extent_m().y() * 460.0 / 400.0);
}

struct BoardFinderErrors {
  int found = 0, wrong = 0;
  double squares = 0.0, normalised = 0.0, stated = 0.0;

  double rms_px() const { return std::sqrt(squares / (2.0 * found)); }
  double sigma_px() const { return std::sqrt(stated / found); }
  double ratio() const { return std::sqrt(normalised / (2.0 * found)); }
};

// A circle's position and covariance after the distortion of its image; a corner's as measured.
std::optional<CircleObservation> undistorted(const FoundPoint& point, const CameraIntrinsics& camera) {
  const std::vector<ViewFromFrame> views = viewsFromFrames({{0.0, 0.0, {point}}}, 2);
  return inIdealPixels(views.front().view.circles.front(), camera);
}

void compareForBoardFinder(const FoundPoints& points, const Board& board, const CameraIntrinsics& camera,
                           const RigidTransform& camera_from_board, BoardFinderErrors& errors) {
  for (const FoundPoint& point : asTrue(points, board, camera, camera_from_board)) {
    const auto truth = truePoint(board, point.point, camera, camera_from_board);
    const auto ideal = undistorted(point, camera);
    if (!truth || !ideal || (*truth - point.at_px).norm() > 2.0) {
      ++errors.wrong;
      continue;
    }
    const Eigen::Vector2d error = pixelFromIdeal(camera, ideal->centre_px) - *truth;
    ++errors.found;
    errors.squares += error.squaredNorm();
    errors.normalised += error.dot(point.covariance_px2.inverse() * error);
    errors.stated += 0.5 * point.covariance_px2.trace();
  }
}

int pointsInView(const Board& board, const CameraIntrinsics& camera, const RigidTransform& pose) {
  int count = 0;
  for (int k = 0; k < board.pointCount(); ++k) {
    const auto at = truePoint(board, k, camera, pose);
    const double margin = board.hasCircles() ? 1.5 * board.radius_m * 460.0 / pose.translation_m.z() : 8.0;
    count += at && (at->array() > margin).all() && at->x() < camera.resolution_px.width_px - margin &&
             at->y() < camera.resolution_px.height_px - margin;
  }
  return count;
}

RigidTransform wholeBoard(const Board& board, const Eigen::Vector3d& turn) {
  return lookAt(board, (std::abs(turn.z()) > 1.0 ? 1.45 : 1.0) * distanceFor(board), turn);
}

class TestBoardFinder : public QObject {
  Q_OBJECT
 private slots:
  void rendered_isFoundWithErrorsAsStated_data();
  void rendered_isFoundWithErrorsAsStated();
  void point0_isTheSameCornerHoweverTheBoardIsHeld_data();
  void point0_isTheSameCornerHoweverTheBoardIsHeld();
  void part_isFoundWhereItSaysWhichPartItIs_data();
  void part_isFoundWhereItSaysWhichPartItIs();
  void pictureWithoutBoard_showsNothing_data();
  void pictureWithoutBoard_showsNothing();
  void wrongNumbers_areDoubted_data();
  void wrongNumbers_areDoubted();
  void drawingOfOpenCv_isFound();
  void rotatedTags_areFoundAndNamed_data();
  void rotatedTags_areFoundAndNamed();
  void pictureOfOneRow_isRenumberedLater();
  void tagsOfOpenCv_areFound();
  void coarsePicture_isFound();
};

void TestBoardFinder::rendered_isFoundWithErrorsAsStated_data() {
  QTest::addColumn<PrintedBoard>("printed");
  QTest::newRow("asymmetric circles") << asymmetricCircles();
  QTest::newRow("bright circles") << brightCircles();
  QTest::newRow("checkerboard") << checkerboardForBoardFinder();
  QTest::newRow("Kalibr's grid") << kalibrGrid();
  QTest::newRow("grid with a border of 1 bit") << plainGrid();
  QTest::newRow("ChArUco") << charuco();
  QTest::newRow("ChArUco, legacy") << legacyCharuco();
}

// Perspective, a lens that bends edges by 30 px, blur and noise. The parts of covariances for print and
// optics are omitted, since these images have no such errors.
void TestBoardFinder::rendered_isFoundWithErrorsAsStated() {
  QFETCH(const PrintedBoard, printed);
  const Board& board = printed.board;
  const CameraIntrinsics camera = distortingCamera();
  FrameOptions options;
  options.min_sigma_px = 0.005;
  BoardFinder finder(board, options);
  BoardFinderErrors errors;
  int possible = 0;
  double seconds = 0.0;
  unsigned seed = 0;
  for (const Eigen::Vector3d& turn : {Eigen::Vector3d(0.0, 0.0, 0.02), Eigen::Vector3d(0.45, 0.1, 0.2),
                                      Eigen::Vector3d(-0.2, 0.5, -0.3), Eigen::Vector3d(0.1, -0.3, 2.0)}) {
    const RigidTransform pose = wholeBoard(board, turn);
    const GrayImage image = renderBoard(printed, camera, pose, {40.0, 200.0, 0.8, 6.0, ++seed});
    const std::clock_t begin = std::clock();
    const FoundPoints points = finder.find(image);
    seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    compareForBoardFinder(points, board, camera, pose, errors);
    possible += pointsInView(board, camera, pose);
  }
  qInfo("%d of %d, %d wrong, %.3f px RMS a coordinate for %.3f stated, ratio %.2f, %.1f ms per frame",
        errors.found, possible, errors.wrong, errors.rms_px(), errors.sigma_px(), errors.ratio(),
        1e3 * seconds / 4);
  QCOMPARE(errors.wrong, 0);
  QVERIFY(errors.found > 0.98 * possible);
  QVERIFY(errors.ratio() > 0.7 && errors.ratio() < 1.4);
  QCOMPARE(finder.doubt(), std::string());
}

void TestBoardFinder::point0_isTheSameCornerHoweverTheBoardIsHeld_data() {
  QTest::addColumn<PrintedBoard>("printed");
  QTest::newRow("asymmetric circles") << asymmetricCircles();
  QTest::newRow("checkerboard") << checkerboardForBoardFinder();
}

void TestBoardFinder::point0_isTheSameCornerHoweverTheBoardIsHeld() {
  QFETCH(const PrintedBoard, printed);
  QVERIFY(!printed.board.hasHalfTurnAmbiguity());
  for (const double turn : {0.0, 1.57, 3.14, -1.57}) {
    BoardFinder finder(printed.board, FrameOptions{});
    const RigidTransform pose = lookAt(printed.board, 1.6 * distanceFor(printed.board), {0.1, 0.1, turn});
    BoardFinderErrors errors;
    compareForBoardFinder(finder.find(renderBoard(printed, distortingCamera(), pose, {})), printed.board,
                          distortingCamera(), pose, errors);
    QCOMPARE(errors.wrong, 0);
    QCOMPARE(errors.found, printed.board.pointCount());
  }
}

void TestBoardFinder::part_isFoundWhereItSaysWhichPartItIs_data() {
  QTest::addColumn<PrintedBoard>("printed");
  QTest::addColumn<bool>("says");
  QTest::newRow("Kalibr's grid") << kalibrGrid() << true;
  QTest::newRow("ChArUco") << charuco() << true;
  QTest::newRow("asymmetric circles") << asymmetricCircles() << false;
}

// About the left half of the board is outside the image. If circles are cut off on all sides, several
// placements on the board are possible.
void TestBoardFinder::part_isFoundWhereItSaysWhichPartItIs() {
  QFETCH(const PrintedBoard, printed);
  QFETCH(const bool, says);
  const Board& board = printed.board;
  CameraIntrinsics camera = distortingCamera();
  camera.distortion = {};
  const double beside = 0.6 * board.extent_m().x();
  const RigidTransform pose =
      lookAt(board, (says ? 0.7 : 0.5) * distanceFor(board), {0.1, 0.2, 0.1}, {says ? -beside : 0.0, 0.0});
  BoardFinder finder(board, FrameOptions{});
  BoardFinderErrors errors;
  compareForBoardFinder(finder.find(renderBoard(printed, camera, pose, {})), board, camera, pose, errors);
  const int in_view = pointsInView(board, camera, pose);
  QCOMPARE(errors.wrong, 0);
  QVERIFY(in_view < 0.8 * board.pointCount());
  if (says) QVERIFY2(errors.found > 0.9 * in_view, std::to_string(errors.found).c_str());
}

void TestBoardFinder::pictureWithoutBoard_showsNothing_data() {
  QTest::addColumn<PrintedBoard>("printed");
  QTest::newRow("asymmetric circles") << asymmetricCircles();
  QTest::newRow("checkerboard") << checkerboardForBoardFinder();
  QTest::newRow("Kalibr's grid") << kalibrGrid();
  QTest::newRow("ChArUco") << charuco();
}

// Another board, only noise, uniform grey, and an image of a few pixels.
void TestBoardFinder::pictureWithoutBoard_showsNothing() {
  QFETCH(const PrintedBoard, printed);
  BoardFinder finder(printed.board, FrameOptions{});
  const PrintedBoard other = printed.board.hasCircles() ? checkerboardForBoardFinder() : asymmetricCircles();
  QVERIFY(finder.find(renderBoard(other, distortingCamera(), wholeBoard(other.board, {0.1, 0.1, 0.1}), {}))
              .empty());
  QVERIFY(
      finder
          .find(renderBoard(other, distortingCamera(), wholeBoard(other.board, {}), {128, 128, 0.7, 20.0, 1}))
          .empty());
  QVERIFY(finder.find({{640, 480}, std::vector<std::uint8_t>(640 * 480, 90)}).empty());
  QVERIFY(finder.find({{1, 1}, {0}}).empty());
  QVERIFY(finder.find({{20, 16}, std::vector<std::uint8_t>(320, 90)}).empty());
}

void TestBoardFinder::wrongNumbers_areDoubted_data() {
  QTest::addColumn<PrintedBoard>("printed");
  QTest::addColumn<Board>("said");
  QTest::addColumn<TagBorder>("border");
  QTest::addColumn<QString>("doubt");
  const PrintedBoard grid = kalibrGrid();
  QTest::newRow("too few tags")
      << grid << boardOfBoardFinder(BoardType::AprilGrid, 5, 6, 0.1144, 0.0, 0.088) << TagBorder::Automatic
      << "tag 35 was detected, but a board of 5 x 6 tags has tags 0 to 29: check rows and columns";
  QTest::newRow("rows for columns")
      << grid << boardOfBoardFinder(BoardType::AprilGrid, 4, 9, 0.1144, 0.0, 0.088) << TagBorder::Automatic
      << "the detected tags do not fit a board of 4 x 9 tags: check rows and columns";
  QTest::newRow("border") << grid << grid.board << TagBorder::One
                          << "a tag border of 2 bits fits better than one of 1";
  QTest::newRow("right") << grid << grid.board << TagBorder::Two << "";
  PrintedBoard later = grid;
  later.first_tag = 10;
  QTest::newRow("numbers from 10") << later << grid.board << TagBorder::Automatic
                                   << "tags 10 to 45 were detected, but a board of 6 x 6 tags from 0 on has "
                                      "tags up to 35: this is another "
                                      "board, or first_tag should be 10";
  PrintedBoard mirrored = grid;
  mirrored.mirrored = true;
  QTest::newRow("mirrored") << mirrored << grid.board << TagBorder::Automatic
                            << "the tags can only be read in the mirror image: the camera's pictures or the "
                               "printed board are mirrored";
  PrintedBoard markers = charuco();
  markers.mirrored = true;
  QTest::newRow("mirrored ChArUco") << markers << markers.board << TagBorder::Automatic
                                    << "the markers can only be read in the mirror image: the camera's "
                                       "pictures or the printed board are mirrored";
}

void TestBoardFinder::wrongNumbers_areDoubted() {
  QFETCH(const PrintedBoard, printed);
  QFETCH(const Board, said);
  QFETCH(const TagBorder, border);
  QFETCH(const QString, doubt);
  FrameOptions options;
  options.tag_border = border;
  BoardFinder finder(said, options);
  for (const double turn : {0.0, 0.1, 0.2})
    finder.find(renderBoard(printed, distortingCamera(), wholeBoard(printed.board, {0.1, 0.1, turn}), {}));
  QCOMPARE(QString::fromStdString(finder.doubt()), doubt);
}

// A board as drawn by OpenCV.
void TestBoardFinder::drawingOfOpenCv_isFound() {
  for (const int rows : {5, 6}) {
    cv::Mat picture;
    test::aruco::drawCharucoBoard(test::aruco::dictionary(cv::aruco::DICT_6X6_250), {8, rows}, 0.04F, 0.03F,
                                  {640, 80 * rows}, picture);
    cv::copyMakeBorder(picture, picture, 40, 40, 40, 40, cv::BORDER_CONSTANT, 255);
    GrayImage image{{picture.cols, picture.rows}, {}};
    image.pixels.assign(picture.datastart, picture.dataend);
    BoardFinder finder(boardOfBoardFinder(BoardType::Charuco, rows, 8, 0.04, 0.0, 0.03), FrameOptions{});
    const FoundPoints points = finder.find(image);
    QCOMPARE(points.size(), static_cast<std::size_t>(7 * (rows - 1)));
    for (const FoundPoint& point : points) {
      const Eigen::Vector2d expected(40.0 + 80.0 * (point.point % 7 + 1) - 0.5,
                                     40.0 + 80.0 * (point.point / 7 + 1) - 0.5);
      QVERIFY((point.at_px - expected).norm() < 0.1);
    }
  }
}

void TestBoardFinder::rotatedTags_areFoundAndNamed_data() {
  QTest::addColumn<PrintedBoard>("printed");
  QTest::addColumn<QString>("layout");
  const QStringList turns = {"", "rotated by 90 deg clockwise within their squares",
                             "rotated by 180 deg within their squares",
                             "rotated by 90 deg counterclockwise within their squares"};
  const QStringList orders = {"", "numbered row by row from the top left",
                              "numbered column by column from the bottom left",
                              "numbered column by column from the top left"};
  for (int order = 0; order < 4; ++order) {
    for (int turn = 0; turn < 4; ++turn) {
      PrintedBoard grid = plainGrid();
      grid.clockwise_turns = turn;
      grid.order = static_cast<TagOrder>(order);
      QString expected = turns[turn];
      if (turn > 0 && order > 0) expected += " and ";
      expected += orders[order];
      QTest::addRow("grid, order %d, %d turns", order, turn) << grid << expected;
    }
  }
  for (int turn = 1; turn < 4; ++turn) {
    PrintedBoard kalibr = kalibrGrid();
    kalibr.clockwise_turns = turn;
    QTest::addRow("square grid, %d turns", turn) << kalibr << turns[turn];
    for (PrintedBoard markers : {charuco(), legacyCharuco()}) {
      markers.clockwise_turns = turn;
      QTest::addRow("ChArUco of %d rows, %d turns", markers.board.rows, turn) << markers << turns[turn];
    }
  }
}

// In all rotations of the whole board, and for one that is partly outside of the picture.
void TestBoardFinder::rotatedTags_areFoundAndNamed() {
  QFETCH(const PrintedBoard, printed);
  QFETCH(const QString, layout);
  const Board& board = printed.board;
  const CameraIntrinsics camera = distortingCamera();
  BoardFinder finder(board, FrameOptions{});
  for (const Eigen::Vector3d& turn :
       {Eigen::Vector3d(0.4, 0.1, 0.1), Eigen::Vector3d(-0.2, 0.4, 1.7), Eigen::Vector3d(0.1, -0.3, 3.1)}) {
    const RigidTransform pose = wholeBoard(board, turn);
    BoardFinderErrors errors;
    compareForBoardFinder(finder.find(renderBoard(printed, camera, pose, {})), board, camera, pose, errors);
    QCOMPARE(errors.wrong, 0);
    QVERIFY(errors.found > 0.98 * pointsInView(board, camera, pose));
  }
  const RigidTransform part =
      lookAt(board, 0.7 * distanceFor(board), {0.1, 0.2, 0.1}, {-0.4 * board.extent_m().x(), 0.0});
  BoardFinderErrors errors;
  compareForBoardFinder(finder.find(renderBoard(printed, camera, part, {})), board, camera, part, errors);
  QCOMPARE(errors.wrong, 0);
  QVERIFY(errors.found > 0.9 * pointsInView(board, camera, part));
  const QString usual =
      board.type == BoardType::Charuco ? "OpenCV's boards, the markers" : "Kalibr's boards, the tags";
  const QString expected =
      layout.isEmpty() ? "" : "compared with " + usual + " are " + layout + "; this is accounted for";
  QCOMPARE(QString::fromStdString(finder.remark()), expected);
  QCOMPARE(finder.doubt(), std::string());
}

// One row is at the top or at the bottom, depending on the order, which a later picture shows.
void TestBoardFinder::pictureOfOneRow_isRenumberedLater() {
  PrintedBoard printed = plainGrid();
  printed.order = TagOrder::RowsDown;
  const Board& board = printed.board;
  const CameraIntrinsics camera = distortingCamera();
  BoardFinder finder(board, FrameOptions{});
  const double distance_m = 0.22;  // of which a picture has about one row
  const RigidTransform top = lookAt(board, distance_m, {}, {0.0, 1.5 * board.spacing_m});
  finder.find(renderBoard(printed, camera, top, {}));
  QVERIFY(!finder.renumbered());
  const RigidTransform whole = wholeBoard(board, {});
  QCOMPARE(finder.find(renderBoard(printed, camera, whole, {})).size(),
           static_cast<std::size_t>(board.pointCount()));
  QVERIFY(finder.renumbered() && !finder.renumbered());
  BoardFinderErrors errors;
  compareForBoardFinder(finder.find(renderBoard(printed, camera, top, {})), board, camera, top, errors);
  QCOMPARE(errors.wrong, 0);
  QVERIFY(errors.found >= 4);
}

// OpenCV draws AprilTags rotated by 180 deg, and numbers a grid from the top left.
void TestBoardFinder::tagsOfOpenCv_areFound() {
  const int side = 80, gap = 24, margin = 60, rows = 3, cols = 5;
  cv::Mat picture(2 * margin + rows * (side + gap) - gap, 2 * margin + cols * (side + gap) - gap, CV_8UC1,
                  255);
  const auto dictionary = test::aruco::dictionary(cv::aruco::DICT_APRILTAG_36h11);
  for (int row = -1; row < rows; ++row)
    for (int col = -1; col < cols; ++col)
      picture(cv::Rect(margin + side + col * (side + gap), margin + side + row * (side + gap), gap, gap)) = 0;
  cv::Mat without_squares(picture.size(), CV_8UC1, 255);
  for (int id = 0; id < rows * cols; ++id) {
    cv::Mat tag;
    test::aruco::drawMarker(*dictionary, id, side, tag);
    const cv::Rect place(margin + id % cols * (side + gap), margin + id / cols * (side + gap), side, side);
    tag.copyTo(picture(place));
    tag.copyTo(without_squares(place));
  }
  GrayImage image{{picture.cols, picture.rows}, {}}, bare = image;
  image.pixels.assign(picture.datastart, picture.dataend);
  bare.pixels.assign(without_squares.datastart, without_squares.dataend);
  const Board board = boardOfBoardFinder(BoardType::AprilGrid, rows, cols, 0.104, 0.0, 0.08);
  BoardFinder finder(board, FrameOptions{});
  const FoundPoints points = finder.find(image);
  QCOMPARE(points.size(), static_cast<std::size_t>(board.pointCount()));
  for (const FoundPoint& point : points) {
    const Eigen::Vector2d expected = 1000.0 * board.point_m(point.point).array() + (margin - 0.5);
    QVERIFY((point.at_px - expected).norm() < 0.3);
  }
  QCOMPARE(finder.remark(),
           std::string("compared with Kalibr's boards, the tags are rotated by 180 deg within "
                       "their squares and numbered row by row from the top left; this is "
                       "accounted for"));
  BoardFinder of_bare(board, FrameOptions{});
  for (int picture_number = 0; picture_number < 3; ++picture_number) QVERIFY(of_bare.find(bare).empty());
  QVERIFY(of_bare.doubt().find("not the small squares between them") != std::string::npos);
}

// A sensor of few pixels: the checkerboard is searched in an enlarged picture.
void TestBoardFinder::coarsePicture_isFound() {
  CameraIntrinsics camera = distortingCamera();
  camera.resolution_px = {128, 128};
  camera.focal_length_px = {90.0, 90.0};
  camera.principal_point_px = {64.0, 64.0};
  const Board board = checkerboardForBoardFinder().board;
  const RigidTransform pose = lookAt(board, 0.4, {0.1, 0.1, 0.1});
  BoardFinder finder(board, FrameOptions{});
  BoardFinderErrors errors;
  compareForBoardFinder(
      finder.find(renderBoard(checkerboardForBoardFinder(), camera, pose, {40, 200, 0.5, 2.0, 1})), board,
      camera, pose, errors);
  QCOMPARE(errors.wrong, 0);
  QCOMPARE(errors.found, board.pointCount());
}

}  // namespace

EVICAL_TEST(TestBoardFinder)
#include "tst_board_finder.moc"
