// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/stream_table.h"

#include "core/base/time.h"
#include "ui/screens/format_number.h"
#include "ui/theme/theme.h"

#include <QComboBox>
#include <QEvent>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QRegularExpression>

#include <algorithm>

namespace evical::ui {
namespace {

enum StreamColumn { kRole, kStream, kContent, kCount, kRate, kRange, kFaults, kStreamColumns };
constexpr int kNameRole = Qt::UserRole, kRecordingRole = Qt::UserRole + 1;

// 12.02 M/s is more readable than 12022916 per second.
QString rateText(const StreamSummary& stream) {
  constexpr double kMillion = 1e6, kThousand = 1e3;
  if (stream.rate_hz <= 0.0) return {};
  const QString unit = stream.info.type == StreamType::Events ? "ev/s" : "Hz";
  if (stream.rate_hz >= kMillion)
    return QString("%1 M%2").arg(stream.rate_hz / kMillion, 0, 'f', 2).arg(unit);
  if (stream.info.type == StreamType::Events && stream.rate_hz >= kThousand)
    return QString("%1 k%2").arg(stream.rate_hz / kThousand, 0, 'f', 1).arg(unit);
  return QString("%1 %2").arg(stream.rate_hz, 0, 'f', 1).arg(unit);
}

QString contentText(const StreamSummary& stream) {
  switch (stream.info.type) {
    case StreamType::Events: {
      const Resolution size = stream.info.resolution_px.known() ? stream.info.resolution_px : stream.seen_px;
      return QObject::tr("events, %1 x %2 px").arg(size.width_px).arg(size.height_px);
    }
    case StreamType::Imu:
      if (imuStreamKind(stream) == ImuStreamKind::Gyroscope)
        return QObject::tr("gyroscope, %1").arg(unitText(stream.angular_rate_unit));
      if (imuStreamKind(stream) == ImuStreamKind::Accelerometer)
        return QObject::tr("accelerometer, %1").arg(unitText(stream.acceleration_unit));
      return QObject::tr("IMU, %1, %2")
          .arg(unitText(stream.acceleration_unit), unitText(stream.angular_rate_unit));
    case StreamType::Frames:
      if (!stream.info.readable) return fromCore(stream.info.message);
      if (!stream.info.resolution_px.known())
        return QObject::tr("frames (%1)").arg(fromCore(stream.info.message));
      return QObject::tr("frames, %1 x %2 px")
          .arg(stream.info.resolution_px.width_px)
          .arg(stream.info.resolution_px.height_px);
    case StreamType::Points:
      return QObject::tr("points of the board");
    default:
      return fromCore(stream.info.message);
  }
}

QString rangeText(const StreamSummary& stream) {
  if (stream.count == 0 || stream.last_ns <= stream.first_ns) return {};
  return QObject::tr("%1 s").arg(secondsSince(stream.first_ns, stream.last_ns), 0, 'f', 2);
}

// Frames without times suit intrinsics only, which the window does not calibrate from frames alone.
bool canBeCamera(const StreamInfo& info) {
  return info.type == StreamType::Events || info.type == StreamType::Points ||
         (info.type == StreamType::Frames && info.readable && info.timed);
}

QComboBox* roleBox(const StreamInfo& info, QWidget* parent) {
  auto* const box = new QComboBox(parent);
  box->setFocusPolicy(Qt::StrongFocus);
  box->addItem(icon("ignore"), QObject::tr("Ignore"), static_cast<int>(StreamRole::Ignore));
  if (canBeCamera(info))
    box->addItem(icon("camera"), QObject::tr("Camera"), static_cast<int>(StreamRole::Camera));
  if (info.type == StreamType::Imu)
    box->addItem(icon("imu"), QObject::tr("IMU"), static_cast<int>(StreamRole::Imu));
  box->setEnabled(box->count() > 1);
  return box;
}

QTableWidgetItem* readOnlyItem(const QString& shown) {
  auto* const item = new QTableWidgetItem(shown);
  item->setFlags(Qt::ItemIsEnabled | Qt::ItemIsSelectable);
  item->setToolTip(shown);
  return item;
}

// A text in which lines do not break within the coordinates of a pixel.
QString withWholePixels(QString text) {
  static const QRegularExpression pixel("\\((\\d+), (\\d+)\\)");
  return text.replace(pixel, QString("(\\1,%1\\2)").arg(QChar(QChar::Nbsp)));
}

}  // namespace

StreamTable::StreamTable(QWidget* parent) : QTableWidget(0, kStreamColumns, parent) {
  constexpr int kRow_px = 34;
  setHorizontalHeaderLabels(
      {tr("Role"), tr("Stream"), tr("Content"), tr("Count"), tr("Rate"), tr("Duration"), tr("Faults")});
  verticalHeader()->hide();
  verticalHeader()->setDefaultSectionSize(kRow_px);
  setShowGrid(false);
  setSelectionMode(QAbstractItemView::NoSelection);
  setFocusPolicy(Qt::NoFocus);
  horizontalHeader()->setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
  horizontalHeader()->setHighlightSections(false);
  horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  horizontalHeader()->setSectionResizeMode(kRole, QHeaderView::Fixed);
  horizontalHeader()->setSectionResizeMode(kFaults, QHeaderView::Stretch);
  setAccessibleName(tr("Streams of the recording"));
}

void StreamTable::clearStreams() {
  setRowCount(0);
  fitHeight();
}

void StreamTable::addInspection(const Inspection& inspection, const std::filesystem::path& own_recording) {
  for (const StreamSummary& stream : inspection.streams) addStream(stream, inspection.faults, own_recording);
  showIcons();
  fitHeight();
}

void StreamTable::fitHeight() {
  constexpr int kMaxRows = 5;  // more are reached by scrolling: the forms below need space
  const int rows = std::clamp(rowCount(), 1, kMaxRows);
  setFixedHeight(horizontalHeader()->sizeHint().height() + rows * verticalHeader()->defaultSectionSize() + 6);
}

void StreamTable::addStream(const StreamSummary& stream, const std::vector<RecordingFault>& faults,
                            const std::filesystem::path& own_recording) {
  const int row = rowCount();
  insertRow(row);
  QComboBox* const box = roleBox(stream.info, this);
  box->setAccessibleName(tr("Role of %1").arg(fromCore(stream.info.name)));
  // Vertically centred, at its own height.
  auto* const cell = new QWidget(this);
  auto* const layout = new QHBoxLayout(cell);
  layout->setContentsMargins(2, 0, 2, 0);
  layout->addWidget(box);
  setCellWidget(row, kRole, cell);
  constexpr int kPadding_px = 24;
  setColumnWidth(kRole, std::max(columnWidth(kRole), box->sizeHint().width() + kPadding_px));
  connect(box, &QComboBox::activated, this, [this, row] { emit roleChosen(row, role(row)); });
  const QString name = fromCore(stream.info.name), file = fromCore(own_recording.filename().string());
  setItem(row, kStream, readOnlyItem(file.isEmpty() || file == name ? name : file + ": " + name));
  item(row, kStream)->setData(kNameRole, name);
  item(row, kStream)->setData(kRecordingRole, fromCore(own_recording.string()));
  if (!own_recording.empty()) item(row, kStream)->setToolTip(fromCore(own_recording.string()));
  setItem(row, kContent, readOnlyItem(contentText(stream)));
  setItem(row, kCount, readOnlyItem(stream.count == 0 ? QString() : countText(stream.count)));
  setItem(row, kRate, readOnlyItem(rateText(stream)));
  setItem(row, kRange, readOnlyItem(rangeText(stream)));
  addFaults(row, stream, faults);
}

void StreamTable::addFaults(int row, const StreamSummary& stream, const std::vector<RecordingFault>& faults) {
  QStringList own;
  for (const RecordingFault& fault : faults)
    if (fault.stream == stream.info.name) own << withWholePixels(fromCore(fault.text));
  const QString note = withWholePixels(fromCore(stream.note));
  const QString none = stream.count == 0 ? QString() : note.isEmpty() ? tr("none found") : note;
  setItem(row, kFaults,
          readOnlyItem(own.isEmpty()     ? none
                       : own.size() == 1 ? own.front()
                                         : tr("%1 faults: %2").arg(own.size()).arg(own.front())));
  const bool only_note = own.isEmpty() && !note.isEmpty();
  item(row, kFaults)
      ->setData(Qt::UserRole, stream.count == 0 || only_note ? -1 : static_cast<int>(own.size()));
  if (own.isEmpty()) own << tr("No faults found");
  if (!note.isEmpty()) own << note;
  item(row, kFaults)->setToolTip(own.join('\n'));
}

void StreamTable::showIcons() {
  for (int row = 0; row < rowCount(); ++row) {
    const int faults = item(row, kFaults)->data(Qt::UserRole).toInt();
    if (faults < 0) continue;
    item(row, kFaults)->setIcon(faults == 0 ? icon("done", theme().good) : icon("warning", theme().warning));
  }
}

void StreamTable::setSession(const Session& session) {
  for (int row = 0; row < rowCount(); ++row) {
    const std::string name = item(row, kStream)->data(kNameRole).toString().toStdString();
    const std::string recording = item(row, kStream)->data(kRecordingRole).toString().toStdString();
    const auto isThis = [&](const auto& sensor) {
      return sensor.stream == name && sensor.recording.string() == recording;
    };
    StreamRole role = StreamRole::Ignore;
    if (std::any_of(session.cameras.begin(), session.cameras.end(), isThis)) role = StreamRole::Camera;
    const auto isOfImu = [&](const SessionImu& imu) {
      return isThis(imu) || (imu.accelerometer_stream == name && imu.recording.string() == recording);
    };
    if (std::any_of(session.imus.begin(), session.imus.end(), isOfImu)) role = StreamRole::Imu;
    QComboBox* const box = roleBoxOf(row);
    box->setCurrentIndex(std::max(0, box->findData(static_cast<int>(role))));
  }
}

QComboBox* StreamTable::roleBoxOf(int row) const {
  return cellWidget(row, kRole)->findChild<QComboBox*>();
}

StreamRole StreamTable::role(int row) const {
  return static_cast<StreamRole>(roleBoxOf(row)->currentData().toInt());
}

void StreamTable::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) showIcons();
  QTableWidget::changeEvent(event);
}

}  // namespace evical::ui
