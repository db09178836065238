// Boards of type points: any target whose points are detected by another program.
#include "core/pipeline/session/given_points.h"

#include "core/base/error.h"
#include "core/pipeline/lens/intrinsics_calibration.h"
#include "core/pipeline/session/session.h"
#include "core/pipeline/session/session_boards.h"
#include "tests/core/pipeline/session/refused_session.h"
#include "tests/support/test_program.h"

#include <Eigen/Geometry>

#include <QTemporaryDir>

#include <cmath>

namespace {

using namespace evical;

// Points that none of our grids has; the first one is not at the origin.
std::vector<Eigen::Vector2d> scattered_m() {
  std::vector<Eigen::Vector2d> points_m;
  for (int i = 0; i < 40; ++i)
    points_m.emplace_back(-0.2 + 0.4 * std::fmod(0.618 * i + 0.3, 1.0),
                          0.05 + 0.3 * std::fmod(0.414 * i, 1.0));
  return points_m;
}

void writeForGivenPoints(const QString& path, const QString& text) {
  QFile file(path);
  QVERIFY(file.open(QIODevice::WriteOnly));
  file.write(text.toUtf8());
}

QString asTable(const std::vector<Eigen::Vector2d>& points_m) {
  QString text = "name,y_m,x_m,point\n";
  for (std::size_t i = points_m.size(); i-- > 0;)  // in any order
    text +=
        QString("p%1,%2,%3,%1\n").arg(i).arg(points_m[i].y(), 0, 'g', 17).arg(points_m[i].x(), 0, 'g', 17);
  return text;
}

// The points through a camera of 400 px, seen from all sides.
QString asSeen(const std::vector<Eigen::Vector2d>& points_m) {
  QString text = "time_s,point,x_px,y_px\n";
  for (int view = 0; view < 60; ++view) {
    const double turn_rad = 2.0 * view;
    const Eigen::Quaterniond tilt(
        Eigen::AngleAxisd(0.5, Eigen::Vector3d(std::cos(turn_rad), std::sin(turn_rad), 0.3).normalized()));
    const Eigen::Vector3d away_m(0.12 * std::cos(1.3 * view), 0.1 * std::sin(0.7 * view), 0.55);
    for (std::size_t i = 0; i < points_m.size(); ++i) {
      const Eigen::Vector3d at_m(points_m[i].x(), points_m[i].y() - 0.2, 0.0);
      const Eigen::Vector3d p = tilt * at_m + away_m;
      text += QString("%1,%2,%3,%4\n")
                  .arg(0.1 * view)
                  .arg(i)
                  .arg(319.5 + 400.0 * p.x() / p.z(), 0, 'f', 6)
                  .arg(239.5 + 400.0 * p.y() / p.z(), 0, 'f', 6);
    }
  }
  return text;
}

Session sessionWith(const QTemporaryDir& folder, const QString& points_m) {
  writeForGivenPoints(folder.filePath("seen.csv"), asSeen(scattered_m()));
  const QString path = folder.filePath("session.yaml");
  writeForGivenPoints(path,
                      "evical_session: 1\nrecording: seen.csv\nboard: {type: points, points_m: " + points_m +
                          "}\ncameras: {cam: {points: seen.csv, resolution_px: [640, 480]}}\n");
  return readSession(path.toStdString());
}

}  // namespace

class TestGivenPoints : public QObject {
  Q_OBJECT

 private slots:
  void table_isReadByItsNames_inAnyOrder() {
    const QTemporaryDir folder;
    writeForGivenPoints(folder.filePath("board.csv"), asTable(scattered_m()));
    QVERIFY(loadPoints(folder.filePath("board.csv").toStdString()) == scattered_m());
  }

  void tableWithoutNames_isIndexAndPlace() {
    const QTemporaryDir folder;
    writeForGivenPoints(folder.filePath("board.csv"),
                        "# mm would be wrong\n1 0.1 0 0.5\n0,0,0,0.5\n2 0 0.1 0.5\n");
    const std::vector<Eigen::Vector2d> points_m = loadPoints(folder.filePath("board.csv").toStdString());
    QCOMPARE(points_m.size(), std::size_t{3});
    QVERIFY(points_m[1] == Eigen::Vector2d(0.1, 0.0));
  }

  void whatIsNoTable_isRefused_data() {
    QTest::addColumn<QString>("text");
    QTest::addColumn<QStringList>("said");
    QTest::newRow("gap") << "0,0,0\n2,1,0\n3,1,1\n" << QStringList{"board.csv", "point 1 is missing"};
    QTest::newRow("twice") << "0,0,0\n0,1,0\n" << QStringList{"line 2", "listed twice"};
    QTest::newRow("no number") << "0,0,0\n1,one,0\n" << QStringList{"line 2", "is not a point"};
    QTest::newRow("too few columns") << "0,0,0\n1,1\n" << QStringList{"line 2", "is not a point"};
    QTest::newRow("no column") << "point,x,y\n0,0,0\n" << QStringList{"line 1", "has no column x_m"};
    QTest::newRow("negative") << "-1,0,0\n" << QStringList{"line 1", "not a valid point index"};
    QTest::newRow("huge") << "1e9,0,0\n" << QStringList{"line 1", "not a valid point index"};
    QTest::newRow("not flat") << "0,0,0,0\n1,1,0,0.1\n" << QStringList{"line 2", "one plane"};
    QTest::newRow("empty") << "" << QStringList{"session.yaml", "has no points"};
    QTest::newRow("three points") << "0,0,0\n1,1,0\n2,0,1\n" << QStringList{"session.yaml", "too few"};
    QTest::newRow("on a line") << "0,0,0\n1,1,1\n2,2,2\n3,3,3\n" << QStringList{"session.yaml", "one line"};
    QTest::newRow("in one place") << "0,0,0\n1,1,1\n2,1,1\n3,3,0\n"
                                  << QStringList{"session.yaml", "as another one"};
  }
  void whatIsNoTable_isRefused() {
    QFETCH(QString, text);
    QFETCH(QStringList, said);
    const QTemporaryDir folder;
    writeForGivenPoints(folder.filePath("board.csv"), text);
    try {
      sessionWith(folder, "board.csv");
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      for (const QString& part : said) QVERIFY2(QString(error.what()).contains(part), error.what());
    }
  }

  void keysOfPatterns_areRefused() {
    const QTemporaryDir folder;
    try {
      sessionWith(folder, "[[0, 0], [1, 0], [0, 1], [1, 1]], rows: 3");
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      test::verifyRefusal(error, {"rows"});
    }
  }

  void sessionKeepsThem() {
    const QTemporaryDir folder;
    writeForGivenPoints(folder.filePath("board.csv"), asTable(scattered_m()));
    const Session session = sessionWith(folder, "board.csv");
    QCOMPARE(session.board.pointCount(), 40);
    const QTemporaryDir other;
    const QString saved = boardsYaml(session).c_str();
    writeForGivenPoints(other.filePath("session.yaml"),
                        "evical_session: 1\nrecording: seen.csv\n" + saved +
                            "cameras: {cam: {points: seen.csv, resolution_px: [640, 480]}}\n");
    writeForGivenPoints(other.filePath("seen.csv"), asSeen(scattered_m()));
    QVERIFY(readSession(other.filePath("session.yaml").toStdString()).board == session.board);
  }

  void lensIsFoundFromThem() {
    const QTemporaryDir folder;
    writeForGivenPoints(folder.filePath("board.csv"), asTable(scattered_m()));
    const IntrinsicsRun run = calibrateIntrinsics(sessionWith(folder, "board.csv"), 0, RunContext{});
    QVERIFY((run.result.intrinsics.focal_length_px - Eigen::Vector2d(400.0, 400.0)).norm() < 0.05);
    QVERIFY((run.result.intrinsics.principal_point_px - Eigen::Vector2d(319.5, 239.5)).norm() < 0.05);
  }
};

EVICAL_TEST(TestGivenPoints)
#include "tst_given_points.moc"
