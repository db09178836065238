// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/recording_screen.h"

#include "core/pipeline/session/session_boards.h"
#include "core/pipeline/session/session_guess.h"
#include "ui/forms/form_words.h"
#include "ui/screens/board/boards_form.h"
#include "ui/screens/recording/aim_chooser.h"
#include "ui/screens/recording/camera_form.h"
#include "ui/screens/recording/check_card.h"
#include "ui/screens/recording/imu_form.h"
#include "ui/screens/recording/stream_table.h"
#include "ui/screens/recording/time_range_form.h"
#include "ui/screens/wrapped_label.h"
#include "ui/theme/theme.h"

#include <QComboBox>
#include <QEvent>
#include <QFormLayout>
#include <QFrame>
#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
#include <QScrollBar>
#include <QStackedWidget>
#include <QTabWidget>
#include <QVBoxLayout>

#include <algorithm>
#include <limits>
#include <optional>

namespace evical::ui {
namespace {

bool isOfUnfinishedFile(FaultKind kind) {
  return kind == FaultKind::Truncated || kind == FaultKind::NoIndex;
}

// Card with an optional widget on the heading's line.
QFrame* card(const QString& heading, QWidget* content, QWidget* parent, QWidget* beside = nullptr) {
  auto* const frame = new QFrame(parent);
  frame->setProperty("card", "true");
  auto* const layout = new QVBoxLayout(frame);
  layout->setContentsMargins(14, 10, 14, 12);
  auto* const line = new QHBoxLayout;
  line->addWidget(wrappedLabel(heading, "heading", frame), beside == nullptr ? 1 : 0);
  if (beside != nullptr) line->addWidget(beside, 1);
  layout->addLayout(line);
  layout->addWidget(content, 1);
  return frame;
}

QScrollArea* scrolling(QWidget* content, QScrollArea* area) {
  area->setWidget(content);
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->viewport()->setAutoFillBackground(false);
  content->setAutoFillBackground(false);
  return area;
}

// Scrolls vertically: has the width of its content.
class PageArea final : public QScrollArea {
 public:
  using QScrollArea::QScrollArea;
  QSize minimumSizeHint() const override {
    return {widget()->minimumSizeHint().width() + verticalScrollBar()->sizeHint().width(),
            QScrollArea::minimumSizeHint().height()};
  }
};

// Takes the rest of the page, and scrolls inside: the page must not scroll for the preferred height.
class FormsRow final : public QWidget {
 public:
  using QWidget::QWidget;
  bool hasHeightForWidth() const override { return false; }
  QSize sizeHint() const override { return minimumSizeHint(); }
};

// From the first to the last event or sample of any stream.
std::optional<double> duration_s(const Inspection& inspection) {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
  for (const StreamSummary& stream : inspection.streams) {
    const bool is_read = stream.info.type == StreamType::Events || stream.info.type == StreamType::Imu;
    if (stream.count == 0 || !is_read) continue;
    first_ns = std::min(first_ns, stream.first_ns);
    last_ns = std::max(last_ns, stream.last_ns);
  }
  if (last_ns <= first_ns) return std::nullopt;
  return 1e-9 * static_cast<double>(last_ns - first_ns);
}

void showOrHide(QLabel* shown, const QString& text) {
  shown->setText(text);
  shown->setVisible(!text.isEmpty());
}

}  // namespace

RecordingScreen::RecordingScreen(QWidget* parent)
    : QWidget(parent),
      stack_(new QStackedWidget(this)),
      title_(new ElidedLabel("title", this)),
      path_(new ElidedLabel("hint", this)),
      verdict_(wrappedLabel({}, "heading", this)),
      looking_text_(wrappedLabel({}, "hint", this)),
      file_faults_(wrappedLabel({}, "problem", this)),
      looking_(new QProgressBar(this)),
      streams_(new StreamTable(this)),
      time_range_(new TimeRangeForm(this)),
      boards_(new BoardsForm(this)),
      check_(new CheckCard(this)),
      sensors_(new QTabWidget(this)),
      reference_(new QComboBox(this)),
      reference_form_(new QFormLayout),
      aim_(new AimChooser(this)),
      camera_only_(new QPushButton(icon("calibrate"), tr("Calibrate the camera"), this)) {
  stack_->addWidget(makeEmpty());
  stack_->addWidget(makeContent());
  stack_->addWidget(makeReading());
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(stack_);
  connect(boards_, &BoardsForm::sessionEdited, this, &RecordingScreen::sessionEdited);
  connect(time_range_, &TimeRangeForm::edited, this, [this](const TimeRangeForm::Range& range_s) {
    Session changed = session_;
    changed.time_range_s = range_s;
    emit sessionEdited(changed, tr("Change the time range"), "time_range");
  });
  connect(streams_, &StreamTable::roleChosen, this,
          [this](int row, StreamRole role) { chooseRole(row, static_cast<int>(role)); });
  connect(reference_, &QComboBox::textActivated, this, [this](const QString& name) {
    Session changed = session_;
    changed.reference = name.toStdString();
    settleBoards(changed);
    emit sessionEdited(changed, tr("Change the reference"), {});
  });
}

QWidget* RecordingScreen::makeEmpty() {
  auto* const empty = new QWidget(this);
  auto* const layout = new QVBoxLayout(empty);
  auto* const text = wrappedLabel(tr("No recording yet."), "heading", empty);
  text->setAlignment(Qt::AlignCenter);
  auto* const open = new QPushButton(icon("recording"), tr("Open a recording..."), empty);
  connect(open, &QPushButton::clicked, this, &RecordingScreen::openRecordingRequested);
  layout->addStretch();
  layout->addWidget(text);
  layout->addWidget(open, 0, Qt::AlignHCenter);
  layout->addStretch();
  return empty;
}

QWidget* RecordingScreen::makeReading() {
  constexpr int kBar_px = 320;
  auto* const page = new QWidget(this);
  auto* const layout = new QVBoxLayout(page);
  reading_text_ = wrappedLabel({}, "heading", page);
  reading_text_->setObjectName("reading");
  reading_text_->setAlignment(Qt::AlignCenter);
  reading_bar_ = new QProgressBar(page);
  reading_bar_->setRange(0, 1000);
  reading_bar_->setTextVisible(false);
  reading_bar_->setFixedWidth(kBar_px);
  reading_bar_->setAccessibleName(tr("Progress of the reading"));
  layout->addStretch();
  layout->addWidget(reading_text_);
  layout->addWidget(reading_bar_, 0, Qt::AlignHCenter);
  layout->addStretch();
  return page;
}

void RecordingScreen::setReading(const QString& recording) {
  reading_text_->setText(tr("Reading %1...").arg(recording));
  reading_bar_->setValue(0);
  reading_ = !recording.isEmpty();
  showPart();
}

void RecordingScreen::showPart() {
  stack_->setCurrentIndex(reading_ ? 2 : session_.recording.empty() ? 0 : 1);
}

QWidget* RecordingScreen::makeHeader() {
  auto* const header = new QWidget(this);
  auto* const layout = new QVBoxLayout(header);
  layout->setContentsMargins(4, 0, 4, 0);
  layout->setSpacing(2);
  auto* const line = new QHBoxLayout;
  line->addWidget(title_, 1);
  verdict_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  line->addWidget(verdict_, 1);
  camera_only_->setObjectName("camera_only");
  camera_only_->setToolTip(tr("Calibrates the lens only: one camera without an IMU determines nothing else"));
  camera_only_->hide();
  connect(camera_only_, &QPushButton::clicked, this, &RecordingScreen::cameraOnlyRequested);
  line->addWidget(camera_only_);
  layout->addLayout(line);
  auto* const below = new QHBoxLayout;
  below->addWidget(path_, 1);
  below->addWidget(aim_);
  layout->addLayout(below);
  return header;
}

QWidget* RecordingScreen::makeContent() {
  auto* const content = new QWidget(this);
  auto* const streams = new QWidget(content);
  auto* const column = new QVBoxLayout(streams);
  column->setContentsMargins(0, 0, 0, 0);
  looking_->setRange(0, 1000);
  looking_->setTextVisible(false);
  for (QWidget* const widget : std::initializer_list<QWidget*>{looking_text_, looking_, streams_,
                                                               makeRangeAndFiles(streams), file_faults_})
    column->addWidget(widget);
  auto* const layout = new QVBoxLayout(content);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(10);
  layout->addWidget(makeHeader());
  layout->addWidget(card(tr("Streams"), streams, content));
  layout->addWidget(check_);
  layout->addWidget(makeForms(), 1);
  for (QLabel* const hidden : {file_faults_, looking_text_}) hidden->hide();
  looking_->hide();
  return scrolling(content, new PageArea(this));
}

QWidget* RecordingScreen::makeRangeAndFiles(QWidget* parent) {
  auto* const line = new QWidget(parent);
  auto* const layout = new QHBoxLayout(line);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(time_range_, 1);
  auto* const add = new QPushButton(icon("open"), tr("Sensors from another recording..."), line);
  add->setObjectName("add_recording");
  add->setToolTip(
      tr("An IMU or a camera that was recorded into a separate file or folder, by the same clock or with a "
         "known "
         "offset"));
  connect(add, &QPushButton::clicked, this, &RecordingScreen::addRecordingRequested);
  layout->addWidget(add);
  return line;
}

QWidget* RecordingScreen::makeForms() {
  constexpr int kMinSensors_px = 246;  // tabs, and the form of a camera down to its distortion
  auto* const forms = new FormsRow(this);
  auto* const sensors = new QWidget(forms);
  auto* const column = new QVBoxLayout(sensors);
  column->setContentsMargins(0, 0, 0, 0);
  sensors_->setMinimumHeight(kMinSensors_px);
  column->addWidget(sensors_, 1);
  reference_->setToolTip(
      tr("The IMU that defines the reference frame and clock; a camera "
         "if there is no IMU"));
  reference_form_->addRow(tr("Reference"), reference_);
  column->addLayout(reference_form_);
  auto* const row = new QHBoxLayout(forms);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(10);
  row->addWidget(card(tr("Board"), boards_, forms, boards_->chooser()), 1);
  row->addWidget(card(tr("Sensors"), sensors, forms), 1);
  return forms;
}

void RecordingScreen::setSession(const Session& session) {
  const bool other_recording = session.recording != session_.recording;
  session_ = session;
  showPart();
  title_->setText(QString::fromStdString(session.recording.filename().string()));
  path_->setText(QString::fromStdString(session.recording.parent_path().string()));
  title_->setToolTip(QString::fromStdString(session.recording.string()));
  path_->setToolTip(title_->toolTip());
  boards_->setSession(session);
  other_recording ? listStreams() : streams_->setSession(session);
  time_range_->setRange(session.time_range_s);
  showSensors();
}

// Cameras that may share this camera's sensor. None if others already share this camera's.
std::vector<std::string> RecordingScreen::possibleSensors(std::size_t camera) const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < session_.cameras.size(); ++i) {
    if (session_.cameras[i].same_sensor_as == session_.cameras[camera].name) return {};
    if (i != camera && session_.cameras[i].same_sensor_as.empty()) names.push_back(session_.cameras[i].name);
  }
  return names;
}

// Empty if there is only one.
std::vector<std::string> RecordingScreen::possibleBoards() const {
  return session_.further_boards.empty() ? std::vector<std::string>() : boardNames(session_);
}

// Forms are rebuilt only if the number of sensors changes: an edit must not lose the focus.
void RecordingScreen::showSensors() {
  if (cameras_.size() != session_.cameras.size() || imus_.size() != session_.imus.size()) {
    while (sensors_->count() > 0) delete sensors_->widget(0);
    cameras_.clear();
    imus_.clear();
    for (std::size_t i = 0; i < session_.cameras.size(); ++i) {
      cameras_.push_back(new CameraForm);
      sensors_->addTab(scrolling(cameras_.back(), new QScrollArea), icon("camera"), {});
      connect(cameras_.back(), &CameraForm::edited, this,
              [this, i](const SessionCamera& camera, const QString& field) { editCamera(i, camera, field); });
    }
    for (std::size_t i = 0; i < session_.imus.size(); ++i) {
      imus_.push_back(new ImuForm);
      sensors_->addTab(scrolling(imus_.back(), new QScrollArea), icon("imu"), {});
      connect(imus_.back(), &ImuForm::edited, this,
              [this, i](const SessionImu& imu, const QString& field) { editImu(i, imu, field); });
    }
  }
  int tab = 0;
  reference_->clear();
  for (std::size_t i = 0; i < cameras_.size(); ++i, ++tab) {
    cameras_[i]->setFound(foundIntrinsics(i));
    cameras_[i]->setCamera(session_.cameras[i], possibleSensors(i), possibleBoards());
    sensors_->setTabText(tab, QString::fromStdString(session_.cameras[i].name));
    if (imus_.empty()) reference_->addItem(sensors_->tabText(tab));
  }
  for (std::size_t i = 0; i < imus_.size(); ++i, ++tab) {
    imus_[i]->setImu(session_.imus[i]);
    sensors_->setTabText(tab, QString::fromStdString(session_.imus[i].name));
    reference_->addItem(sensors_->tabText(tab));
  }
  reference_->setCurrentText(QString::fromStdString(session_.reference));
  reference_form_->setRowVisible(reference_, reference_->count() > 1);
  showShutters();
}

// Event cameras have no shutter. Streams that are not read yet may be of frames.
void RecordingScreen::showShutters() {
  const std::size_t count = std::min(cameras_.size(), session_.cameras.size());
  for (std::size_t i = 0; i < count; ++i) cameras_[i]->offerShutter(!isOfEvents(session_.cameras[i]));
}

bool RecordingScreen::isOfEvents(const SessionCamera& camera) const {
  for (const Inspected& one : inspected_)
    for (const StreamSummary& stream : one.inspection->streams)
      if (ownRecording(one) == camera.recording && stream.info.name == camera.stream)
        return stream.info.type == StreamType::Events;
  return false;
}

void RecordingScreen::setFoundIntrinsics(const std::vector<std::optional<CameraIntrinsics>>& found) {
  found_intrinsics_ = found;
  for (std::size_t i = 0; i < cameras_.size(); ++i) cameras_[i]->setFound(foundIntrinsics(i));
}

std::optional<CameraIntrinsics> RecordingScreen::foundIntrinsics(std::size_t camera) const {
  return camera < found_intrinsics_.size() ? found_intrinsics_[camera] : std::nullopt;
}

// Problems are on the card and below the board's drawing, which have room for them: fields must not move.
void RecordingScreen::setProblems(const std::vector<std::pair<QString, QString>>& field_and_text) {
  QStringList on_card;
  std::vector<bool> wrong(cameras_.size(), false);
  for (const auto& [field, text] : field_and_text) {
    QString said = text;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      const QString name = QString::fromStdString(session_.cameras[i].name);
      if (!field.startsWith("cameras." + name + ".")) continue;
      wrong[i] = true;
      if (cameras_.size() > 1) said = name + ": " + text;
    }
    if (!BoardsForm::isOfBoards(field)) on_card << said;
  }
  for (std::size_t i = 0; i < cameras_.size(); ++i)
    sensors_->setTabIcon(static_cast<int>(i), icon(wrong[i] ? "warning" : "camera"));
  boards_->setProblems(field_and_text);
  check_->setMissing(inFormWords(on_card.join('\n')));
  problems_ = field_and_text.size();
  showVerdict();
}

void RecordingScreen::offerCameraOnly(bool offered) {
  camera_only_->setVisible(offered);
  showVerdict();
}

void RecordingScreen::setReservation(const QString& text, Light light) {
  reservation_ = text;
  reservation_light_ = light;
  showVerdict();
}

void RecordingScreen::setCalibrating(bool calibrating) {
  calibrating_ = calibrating;
  showVerdict();
}

void RecordingScreen::showVerdict() {
  const bool camera_only = !camera_only_->isHidden();
  const QString reservation = calibrating_ ? tr("Calibrating") : reservation_;
  const Light light = calibrating_ ? Light::Good : reservation_light_;
  const bool reserved = !camera_only && !reservation.isEmpty();
  verdict_->setText(problems_ == 1  ? tr("One thing is missing")
                    : problems_ > 1 ? tr("%1 things are missing").arg(problems_)
                    : camera_only   ? tr("Only the lens can be calibrated:")
                    : reserved      ? reservation
                                    : tr("Ready to calibrate"));
  const bool bad = problems_ > 0 || (reserved && light == Light::Poor);
  const bool undecided = reserved && light == Light::Good;
  const bool fair = !camera_only && light == Light::Fair;
  const QColor colour = bad         ? theme().bad
                        : undecided ? theme().faint_text
                        : fair      ? theme().warning
                                    : theme().good;
  verdict_->setStyleSheet(QString("color: %1").arg(colour.name()));
}

void RecordingScreen::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) showVerdict();
  QWidget::changeEvent(event);
}

void RecordingScreen::clearInspections() {
  inspected_.clear();
  time_range_->setDuration({});
  streams_->clearStreams();
  showOrHide(file_faults_, {});
}

void RecordingScreen::setInspecting(const QString& recording) {
  showOrHide(looking_text_, tr("Reading %1...").arg(recording));
  looking_->setValue(0);
  looking_->show();
}

void RecordingScreen::setInspectionProgress(double fraction) {
  reading_bar_->setValue(static_cast<int>(1000.0 * fraction));
  looking_->setValue(static_cast<int>(1000.0 * fraction));
}

void RecordingScreen::addInspection(const QString& recording, std::shared_ptr<const Inspection> inspection) {
  inspected_.push_back({recording.toStdString(), std::move(inspection)});
  looking_text_->hide();
  looking_->hide();
  listStreams();
  showShutters();
  showFileFaults();
}

std::filesystem::path RecordingScreen::ownRecording(const Inspected& one) const {
  return one.recording == session_.recording ? std::filesystem::path() : one.recording;
}

void RecordingScreen::listStreams() {
  streams_->clearStreams();
  for (const Inspected& one : inspected_) {
    streams_->addInspection(*one.inspection, ownRecording(one));
    if (one.recording == session_.recording) time_range_->setDuration(duration_s(*one.inspection));
  }
  streams_->setSession(session_);
}

void RecordingScreen::setBeingWritten(bool being_written) {
  if (being_written == being_written_) return;
  being_written_ = being_written;
  showFileFaults();
}

// Faults without a stream: truncated or corrupt files.
void RecordingScreen::showFileFaults() {
  QStringList faults;
  for (const Inspected& one : inspected_)
    for (const RecordingFault& fault : one.inspection->faults)
      if (fault.stream.empty() && !(being_written_ && isOfUnfinishedFile(fault.kind)))
        faults << QString::fromStdString(fault.text);
  showOrHide(file_faults_, faults.join('\n'));
}

void RecordingScreen::setInspectionFailed(const QString& why) {
  looking_->hide();
  looking_text_->hide();
  showOrHide(file_faults_, why);
}

void RecordingScreen::chooseRole(int row, int role) {
  auto stream = static_cast<std::size_t>(row);
  auto one = inspected_.begin();
  for (; one != inspected_.end() && stream >= one->inspection->streams.size(); ++one)
    stream -= one->inspection->streams.size();
  if (one == inspected_.end()) return;
  const StreamSummary& summary = one->inspection->streams[stream];
  const std::filesystem::path own_recording = ownRecording(*one);
  Session changed = session_;
  const auto isThis = [&](const auto& sensor) {
    return sensor.stream == summary.info.name && sensor.recording == own_recording;
  };
  std::erase_if(changed.cameras, isThis);
  std::erase_if(changed.imus, [&](const SessionImu& imu) {
    const bool is_accelerometer = imu.accelerometer_stream == summary.info.name;
    return isThis(imu) || (is_accelerometer && imu.recording == own_recording);
  });
  if (static_cast<StreamRole>(role) == StreamRole::Camera)
    changed.cameras.push_back(withSeenResolution(guessedCamera(summary, changed, own_recording), summary));
  if (static_cast<StreamRole>(role) == StreamRole::Imu) {
    const SessionImu guessed = guessedImu(summary, *one->inspection, changed, own_recording);
    // If the other one of the two streams is already an IMU, this one replaces it.
    std::erase_if(changed.imus, [&](const SessionImu& imu) {
      return imu.recording == own_recording &&
             (imu.stream == guessed.stream || imu.stream == guessed.accelerometer_stream);
    });
    changed.imus.push_back(guessed);
  }
  keepReference(changed);
  settleBoards(changed);
  emit sessionEdited(changed, tr("Change the role of %1").arg(QString::fromStdString(summary.info.name)), {});
}

void RecordingScreen::renameReference(const std::string& from, const std::string& to,
                                      Session& session) const {
  if (session.reference == from) session.reference = to;
  for (SessionCamera& camera : session.cameras)
    if (camera.same_sensor_as == from) camera.same_sensor_as = to;
}

void RecordingScreen::editCamera(std::size_t index, const SessionCamera& camera, const QString& field) {
  Session changed = session_;
  renameReference(changed.cameras.at(index).name, camera.name, changed);
  changed.cameras.at(index) = camera;
  settleBoards(changed);
  const QString name = QString::fromStdString(camera.name);
  emit sessionEdited(changed, tr("Change %1").arg(name), "cameras." + name + "." + field);
}

void RecordingScreen::editImu(std::size_t index, const SessionImu& imu, const QString& field) {
  Session changed = session_;
  renameReference(changed.imus.at(index).name, imu.name, changed);
  changed.imus.at(index) = imu;
  const QString name = QString::fromStdString(imu.name);
  emit sessionEdited(changed, tr("Change %1").arg(name), "imus." + name + "." + field);
}

}  // namespace evical::ui
