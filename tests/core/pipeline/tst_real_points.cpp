// Real cameras and a real IMU, through points that other programs have measured: in the folder that EVICAL_DATA names. Its
// manifest tells what is known of each.
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/pipeline/calibration_pipeline.h"
#include "core/pipeline/session.h"

#include "tests/support/test_program.h"

#include <Eigen/Geometry>

#include <QProcess>
#include <QTemporaryDir>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace {

using namespace evical;

QByteArray unpacked(const QString& file) {
  QProcess gzip;
  gzip.start("gzip", {"-dc", file});
  gzip.waitForFinished();
  return gzip.readAllStandardOutput();
}

void write(const QString& file, const QByteArray& content) {
  QFile out(file);
  QVERIFY(out.open(QIODevice::WriteOnly));
  out.write(content);
}

QByteArray read(const QString& file) {
  QFile in(file);
  return in.open(QIODevice::ReadOnly) ? in.readAll() : QByteArray();
}

// The lines behind the first, in columns.
std::vector<QList<QByteArray>> rowsOf(const QByteArray& table) {
  std::vector<QList<QByteArray>> rows;
  const QList<QByteArray> lines = table.split('\n');
  for (qsizetype i = 1; i < lines.size(); ++i)
    if (!lines[i].isEmpty()) rows.push_back(lines[i].split(','));
  return rows;
}

// "frame_ns, tag, corner, x_px, y_px, ...", corners of a tag against the clock from the bottom left.
QByteArray tagPoints(const QByteArray& corners) {
  QByteArray points = "time_ns,point,x_px,y_px\n";
  for (const QList<QByteArray>& row : rowsOf(corners))
    points += row[0] + ',' + QByteArray::number(4 * row[1].toInt() + row[2].toInt()) + ',' + row[3] + ',' +
              row[4] + '\n';
  return points;
}

// "time, col, row, x_px, y_px[, first event, last event]": circles of one message are taken for one view at the middle
// of what they were measured in.
QByteArray gridPoints(const QByteArray& table, int cols) {
  std::map<QByteArray, std::vector<QList<QByteArray>>> views;
  for (const QList<QByteArray>& row : rowsOf(table)) views[row[0]].push_back(row);
  QByteArray points = "time_s,point,x_px,y_px\n";
  for (const auto& [stamp, view] : views) {
    const auto spread = [&](int column) {
      double sum_s = 0.0;
      const double whole_s = std::floor(stamp.toDouble());
      for (const QList<QByteArray>& row : view)
        sum_s += (row[column].left(10).toDouble() - whole_s) + row[column].mid(10).prepend('0').toDouble();
      return sum_s / static_cast<double>(view.size());
    };
    QByteArray time = stamp;
    if (view.front().size() > 5) {
      const auto middle_ns = static_cast<qint64>(std::llround(1e9 * 0.5 * (spread(5) + spread(6))));
      const qint64 since_ns = stamp.left(10).toLongLong() * 1'000'000'000 + middle_ns;
      time = QByteArray::number(since_ns / 1'000'000'000) + '.' +
             QByteArray::number(since_ns % 1'000'000'000).rightJustified(9, '0');
    }
    for (const QList<QByteArray>& row : view)
      points += time + ',' + QByteArray::number(row[2].toInt() * cols + row[1].toInt()) + ',' + row[3] + ',' +
                row[4] + '\n';
  }
  return points;
}

Eigen::Vector3d rotationVector_deg(const Eigen::Quaterniond& rotation) {
  return kDegPerRad * quaternionLog(rotation);
}

}  // namespace

class TestRealPoints : public QObject {
  Q_OBJECT

 private slots:
  void init() {
    folder_ = qEnvironmentVariable("EVICAL_DATA");
    if (folder_.isEmpty()) QSKIP("EVICAL_DATA, the folder of sample recordings, is not set");
    folder_ += "/real";
  }

  // EuRoC's AprilGrid before its first camera and its IMU. Raw corners of tags bend a lens that is free by 5 px.
  void aprilGridAndImu_areAsPublished() {
    const QTemporaryDir work;
    const QString data = folder_ + "/euroc_imu_april";
    write(work.filePath("cam0.csv"), tagPoints(unpacked(data + "/cam0_corners.csv.gz")));
    write(work.filePath("imu0.csv"), unpacked(data + "/imu0.csv.gz"));
    write(work.filePath("session.yaml"), R"(evical_session: 1
recording: cam0.csv
board: {type: aprilgrid, rows: 6, cols: 6, tag_size_m: 0.088, tag_spacing: 0.3}
cameras:
  cam0:
    stream: cam0.csv
    resolution_px: [752, 480]
    intrinsics:
      model: pinhole_radtan
      focal_length_px: [458.654, 457.296]
      principal_point_px: [367.215, 248.375]
      distortion: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]
imus:
  imu0:
    recording: imu0.csv
    stream: imu0.csv
    accelerometer_noise_density: 2.0e-3
    gyroscope_noise_density: 1.6968e-4
options: {optimisation.model.camera_intrinsics: fixed}
)");
    const CalibrationRun run =
        calibrate(readSession(work.filePath("session.yaml").toStdString()), RunContext{});
    const CameraState& camera = run.result.state.cameras.front();
    const CameraUncertainty& sigma = run.result.uncertainty.cameras.front();
    const Eigen::Vector3d turn_deg = rotationVector_deg(camera.reference_from_camera.rotation);
    const Eigen::Vector3d shift_mm = 1e3 * camera.reference_from_camera.translation_m;
    qInfo("rotation %.3f %.3f %.3f deg (%.3f), translation %.2f %.2f %.2f mm (%.2f), offset %.3f ms (%.3f)",
          turn_deg.x(), turn_deg.y(), turn_deg.z(), kDegPerRad * sigma.rotation_std_rad.norm(), shift_mm.x(),
          shift_mm.y(), shift_mm.z(), 1e3 * sigma.translation_std_m.norm(), 1e3 * camera.time_offset_s,
          1e3 * sigma.time_offset_std_s);
    qInfo("%d: %s", static_cast<int>(run.result.status), run.result.reason.c_str());
    QVERIFY(std::abs(turn_deg.norm() - 89.1) < 0.3);
    QVERIFY(turn_deg.head<2>().norm() < 2.0);
    QVERIFY((shift_mm - Eigen::Vector3d(-21.6, -64.7, 9.8)).norm() < 5.0);
    QVERIFY(std::abs(camera.time_offset_s) < 1e-3);
    QVERIFY(run.result.status == CalibrationStatus::Doubtful);
  }

  // An event camera's circles and a frame camera's corners, without an IMU; both lenses unknown. How large its circles
  // are is not known, so that what they seem displaced by would bend a board that is free to be bent. Both cameras'
  // clocks are stamped at other moments of a message than their authors took: 42 ms less half of 12 ms.
  void hybridRigWithoutImu_isAsPublished() {
    const QTemporaryDir work;
    write(work.filePath("events.csv"), gridPoints(read(folder_ + "/efcalib/event_circles.csv"), 6));
    write(work.filePath("frames.csv"), gridPoints(read(folder_ + "/efcalib/frame_corners.csv"), 6));
    write(work.filePath("session.yaml"), R"(evical_session: 1
recording: events.csv
board: {type: checkerboard, rows: 3, cols: 6, spacing_m: 0.04}
cameras:
  events: {stream: events.csv, resolution_px: [346, 260]}
  frames: {recording: frames.csv, stream: frames.csv, resolution_px: [1280, 1024]}
reference: events
options: {optimisation.model.board_bow: false}
)");
    const CalibrationRun run =
        calibrate(readSession(work.filePath("session.yaml").toStdString()), RunContext{});
    const CameraState& frames = run.result.state.cameras[1];
    const Eigen::Vector3d turn_deg = rotationVector_deg(frames.reference_from_camera.rotation);
    const Eigen::Vector3d shift_mm = 1e3 * frames.reference_from_camera.translation_m;
    const double events_px = run.intrinsics[0]->reprojection_rms_px;
    const double frames_px = run.intrinsics[1]->reprojection_rms_px;
    qInfo(
        "rotation %.3f %.3f %.3f deg, translation %.2f %.2f %.2f mm, offset %.3f ms, residuals %.3f, %.3f px",
        turn_deg.x(), turn_deg.y(), turn_deg.z(), shift_mm.x(), shift_mm.y(), shift_mm.z(),
        1e3 * frames.time_offset_s, events_px, frames_px);
    qInfo("%d: %s", static_cast<int>(run.result.status), run.result.reason.c_str());
    QVERIFY((turn_deg - Eigen::Vector3d(5.10, -9.13, -0.85)).norm() < 0.2);
    QVERIFY((shift_mm - Eigen::Vector3d(118.0, -8.7, 19.1)).norm() < 2.0);
    QVERIFY(std::abs(1e3 * frames.time_offset_s + 36.0) < 2.0);
    QVERIFY(events_px <= 0.12);
    QVERIFY(frames_px <= 0.175);
  }

 private:
  QString folder_;
};

EVICAL_TEST(TestRealPoints)
#include "tst_real_points.moc"
