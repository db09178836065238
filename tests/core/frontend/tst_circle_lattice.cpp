#include "core/frontend/moving_circle.h"

#include "core/frontend/board_placement.h"
#include "tests/support/test_program.h"

#include <map>
#include <set>
#include <utility>

namespace {

using namespace evical;

constexpr double kStep_px = 30.0;

MovingCircle circleAt(double x_px, double y_px, double radius_px = 10.0) {
  MovingCircle circle;
  circle.centre_px = {x_px, y_px};
  circle.radius_px = radius_px;
  return circle;
}

// Row by row, 30 px apart.
std::vector<MovingCircle> square(int rows, int cols) {
  std::vector<MovingCircle> circles;
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col)
      circles.push_back(circleAt(50.0 + kStep_px * col, 40.0 + kStep_px * row));
  }
  return circles;
}

std::set<std::size_t> membersOf(const CircleLattice& lattice) {
  std::set<std::size_t> members;
  for (const LatticeNode& node : lattice) members.insert(node.circle);
  return members;
}

class TestCircleLattice : public QObject {
  Q_OBJECT
 private slots:
  void square_isOrderedByItsSteps();
  void twoCircles_areNoLattice();
  void missingCircle_leavesAHole();
  void outlier_isNoMember_data();
  void outlier_isNoMember();
  void neighbours_areWithinTheOptionsSteps();
  void steps_followAPerspective();
  void largerLattice_wins();
};

// Steps along i and j follow the image's lattice, and i x j has the orientation of x to y.
void TestCircleLattice::square_isOrderedByItsSteps() {
  const std::vector<MovingCircle> circles = square(3, 4);
  const CircleLattice lattice = findCircleLattice(circles, GridOptions{});
  QCOMPARE(lattice.size(), std::size_t{12});
  std::map<std::pair<int, int>, Eigen::Vector2d> at;
  for (const LatticeNode& node : lattice) at[{node.i, node.j}] = circles[node.circle].centre_px;
  QCOMPARE(at.size(), std::size_t{12});
  const Eigen::Vector2d origin = at.at({0, 0});
  const Eigen::Vector2d a = (at.contains({1, 0}) ? at.at({1, 0}) - origin : origin - at.at({-1, 0}));
  const Eigen::Vector2d b = (at.contains({0, 1}) ? at.at({0, 1}) - origin : origin - at.at({0, -1}));
  QCOMPARE(a.norm(), kStep_px);
  QCOMPARE(b.norm(), kStep_px);
  QCOMPARE(a.x() * b.y() - a.y() * b.x(), kStep_px * kStep_px);
  for (const auto& [place, centre_px] : at)
    QVERIFY((centre_px - (origin + place.first * a + place.second * b)).norm() < 1e-9);
}

void TestCircleLattice::twoCircles_areNoLattice() {
  QVERIFY(findCircleLattice({}, GridOptions{}).empty());
  QVERIFY(findCircleLattice({circleAt(50, 50), circleAt(80, 50)}, GridOptions{}).empty());
}

void TestCircleLattice::missingCircle_leavesAHole() {
  std::vector<MovingCircle> circles = square(3, 3);
  circles.erase(circles.begin() + 4);  // the middle
  const CircleLattice lattice = findCircleLattice(circles, GridOptions{});
  QCOMPARE(lattice.size(), std::size_t{8});
}

void TestCircleLattice::outlier_isNoMember_data() {
  QTest::addColumn<double>("x_px");
  QTest::addColumn<double>("y_px");
  QTest::addColumn<double>("radius_px");
  QTest::newRow("between four") << 65.0 << 55.0 << 10.0;
  QTest::newRow("a step on, but twice as large") << 170.0 << 40.0 << 20.0;
  QTest::newRow("a step and a half on") << 185.0 << 40.0 << 10.0;
}

void TestCircleLattice::outlier_isNoMember() {
  QFETCH(double, x_px);
  QFETCH(double, y_px);
  QFETCH(double, radius_px);
  std::vector<MovingCircle> circles = square(3, 4);
  circles.push_back(circleAt(x_px, y_px, radius_px));
  const std::set<std::size_t> members = membersOf(findCircleLattice(circles, GridOptions{}));
  QCOMPARE(members.size(), std::size_t{12});
  QVERIFY(!members.contains(12));
}

void TestCircleLattice::neighbours_areWithinTheOptionsSteps() {
  const std::vector<MovingCircle> circles = square(3, 3);  // 3 radii apart
  GridOptions options;
  options.max_step_radii = 2.9;
  QVERIFY(findCircleLattice(circles, options).empty());
  options.max_step_radii = 3.1;
  QCOMPARE(findCircleLattice(circles, options).size(), std::size_t{9});
  options.min_step_radii = 3.05;
  QVERIFY(findCircleLattice(circles, options).empty());
}

// Steps that each shrink by a tenth end at half of their first length.
void TestCircleLattice::steps_followAPerspective() {
  std::vector<MovingCircle> circles;
  double x_px = 40.0, step_px = 40.0;
  for (int col = 0; col < 8; ++col) {
    for (int row = 0; row < 3; ++row)
      circles.push_back(circleAt(x_px, 130.0 + (row - 1) * step_px, step_px / 3.0));
    x_px += step_px;
    step_px *= 0.9;
  }
  QCOMPARE(findCircleLattice(circles, GridOptions{}).size(), std::size_t{24});
}

void TestCircleLattice::largerLattice_wins() {
  std::vector<MovingCircle> circles = square(2, 3);
  for (const MovingCircle& circle : square(3, 4)) {
    circles.push_back(circle);
    circles.back().centre_px += Eigen::Vector2d(170.0, 100.0);
  }
  const std::set<std::size_t> members = membersOf(findCircleLattice(circles, GridOptions{}));
  QCOMPARE(members.size(), std::size_t{12});
  QVERIFY(*members.begin() >= 6);
}

}  // namespace

EVICAL_TEST(TestCircleLattice)
#include "tst_circle_lattice.moc"
