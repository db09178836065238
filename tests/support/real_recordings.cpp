#include "tests/support/real_recordings.h"

#include "core/base/error.h"
#include "core/geometry/camera_model.h"
#include "core/intrinsics/intrinsics_options.h"
#include "core/numerics/angles.h"

#include <QFile>
#include <QProcess>

#include <cmath>
#include <map>
#include <optional>
#include <vector>

namespace evical::test {
namespace {

QByteArray unpacked(const QString& file) {
  QProcess gzip;
  gzip.start("gzip", {"-dc", file});
  gzip.waitForFinished();
  return gzip.readAllStandardOutput();
}

void write(const QString& file, const QByteArray& content) {
  QFile out(file);
  if (!out.open(QIODevice::WriteOnly) || out.write(content) != content.size())
    throw badInput(file.toStdString(), "cannot be written", "Free some space");
}

QByteArray read(const QString& file) {
  QFile in(file);
  return in.open(QIODevice::ReadOnly) ? in.readAll() : QByteArray();
}

// The lines after the first, in columns.
std::vector<QList<QByteArray>> rowsOf(const QByteArray& table) {
  std::vector<QList<QByteArray>> rows;
  const QList<QByteArray> lines = table.split('\n');
  for (qsizetype i = 1; i < lines.size(); ++i)
    if (!lines[i].isEmpty()) rows.push_back(lines[i].split(','));
  return rows;
}

// "frame_ns, tag, corner, x_px, y_px, ...", corners of a tag counter-clockwise from the bottom left.
QByteArray tagPoints(const QByteArray& corners) {
  QByteArray points = "time_ns,point,x_px,y_px\n";
  for (const QList<QByteArray>& row : rowsOf(corners))
    points += row[0] + ',' + QByteArray::number(4 * row[1].toInt() + row[2].toInt()) + ',' + row[3] + ',' +
              row[4] + '\n';
  return points;
}

// "time, col, row, x_px, y_px[, first event, last event]": circles of one message form one view at the middle
// of their measurement interval.
QByteArray gridPoints(const QByteArray& table, int cols) {
  std::map<QByteArray, std::vector<QList<QByteArray>>> views;
  for (const QList<QByteArray>& row : rowsOf(table)) views[row[0]].push_back(row);
  QByteArray points = "time_s,point,x_px,y_px\n";
  for (const auto& [stamp, view] : views) {
    const double whole_s = std::floor(stamp.toDouble());
    const auto spread = [whole_s, &rows = view](int column) {
      double sum_s = 0.0;
      for (const QList<QByteArray>& row : rows)
        sum_s += (row[column].left(10).toDouble() - whole_s) + row[column].mid(10).prepend('0').toDouble();
      return sum_s / static_cast<double>(rows.size());
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

Session sessionOf(const QDir& work, const char* yaml) {
  const QString file = work.filePath("session.yaml");
  write(file, yaml);
  return readSession(file.toStdString());
}

}  // namespace

QString realRecordings() {
  const QString folder = qEnvironmentVariable("EVICAL_DATA");
  return folder.isEmpty() ? folder : folder + "/real";
}

Session eurocImuApril(const QString& real, const QDir& work) {
  const QString data = real + "/euroc_imu_april";
  write(work.filePath("cam0.csv"), tagPoints(unpacked(data + "/cam0_corners.csv.gz")));
  write(work.filePath("imu0.csv"), unpacked(data + "/imu0.csv.gz"));
  return sessionOf(work, R"(evical_session: 1
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
)");
}

RigidTransform eurocImuFromCamera() {
  Eigen::Matrix3d rotation;
  rotation << 0.0148655429818, -0.999880929698, 0.00414029679422, 0.999557249008, 0.0149672133247,
      0.025715529948, -0.0257744366974, 0.00375618835797, 0.999660727178;
  return {Eigen::Quaterniond(rotation), {-0.0216401454975, -0.064676986768, 0.00981073058949}};
}

double raysFromEuroc_deg(const CameraState& camera) {
  const Eigen::Quaterniond imu_from_camera = eurocImuFromCamera().rotation;
  double squares = 0.0;
  int count = 0;
  for (double x_px = 75.0; x_px <= 677.0; x_px += 43.0) {
    for (double y_px = 48.0; y_px <= 432.0; y_px += 48.0) {
      const std::optional<Eigen::Vector3d> one = unprojectRay(*camera.lens.given, {x_px, y_px}),
                                           other = unprojectRay(*camera.lens.inUse(), {x_px, y_px});
      if (!one || !other) continue;
      const Eigen::Vector3d a = imu_from_camera * *one, b = camera.reference_from_camera.rotation * *other;
      squares += std::pow(kDegPerRad * std::atan2(a.cross(b).norm(), a.dot(b)), 2);
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

Session efcalib(const QString& real, const QDir& work) {
  write(work.filePath("events.csv"), gridPoints(read(real + "/efcalib/event_circles.csv"), 6));
  write(work.filePath("frames.csv"), gridPoints(read(real + "/efcalib/frame_corners.csv"), 6));
  return sessionOf(work, R"(evical_session: 1
recording: events.csv
board: {type: checkerboard, rows: 3, cols: 6, spacing_m: 0.04}
cameras:
  events: {stream: events.csv, resolution_px: [346, 260]}
  frames: {recording: frames.csv, stream: frames.csv, resolution_px: [1280, 1024]}
reference: events
)");
}

Session dvs128Blinking(const QString& real, int rows, int cols) {
  const QDir folder(real + "/dvs128_blinking");
  Session session;
  session.board.type = BoardType::Checkerboard;
  session.board.rows = rows;
  session.board.cols = cols;
  session.board.spacing_m = 0.055;
  session.board.radius_m = 0.0;
  session.board_blinks = true;
  for (const QString& name : folder.entryList({"*.aedat"}, QDir::Files, QDir::Name))
    session.more_recordings.emplace_back(folder.filePath(name).toStdString());
  session.recording = session.more_recordings.front();
  session.more_recordings.erase(session.more_recordings.begin());
  session.cameras.push_back({"camera", "events", {}, {}});
  session.reference = "camera";
  session.options.intrinsics.edit().min_views = 8;
  return session;
}

Session dvs128Moving(const QString& real) {
  Session session;
  session.board.type = BoardType::Checkerboard;
  session.board.rows = 6;
  session.board.cols = 9;
  session.board.spacing_m = 0.03;
  session.board.radius_m = 0.0;
  session.recording = (real + "/dvs128_checkerboard_moving/chessboard.aedat").toStdString();
  session.cameras.push_back({"camera", "events", {}, {}});
  session.reference = "camera";
  return session;
}

Session pictures(const QDir& from, const QString& pattern, const QDir& work) {
  work.mkpath("pictures");
  for (const QString& name : from.entryList({pattern}, QDir::Files, QDir::Name))
    QFile::copy(from.filePath(name), work.filePath("pictures/" + name));
  Session session = sessionOf(work, R"(evical_session: 1
recording: pictures
board: {type: checkerboard, rows: 6, cols: 9, spacing_m: 0.03}
cameras:
  camera: {stream: pictures}
reference: camera
)");
  session.options.intrinsics.edit().min_views = 5;
  return session;
}

}  // namespace evical::test
