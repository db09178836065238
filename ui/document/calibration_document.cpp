// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/document/calibration_document.h"

#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/geometry/camera_model.h"
#include "core/pipeline/rig/detected_recording.h"
#include "core/pipeline/session/session_boards.h"
#include "core/pipeline/session/session_keys.h"

#include <QDir>
#include <QFileInfo>
#include <QUndoCommand>

#include <algorithm>
#include <utility>

namespace evical::ui {
namespace {

std::filesystem::path pathOf(const QString& file) {
  return std::filesystem::path(file.toStdString());
}

// The session's camera with a run's stream, which may have another name and place; null: none.
template <class AnySession>
auto sameStream(const Session& of_run, std::size_t camera, AnySession& session)
    -> decltype(&session.cameras[0]) {
  for (auto& each : session.cameras)
    if (camera < of_run.cameras.size() && each.stream == of_run.cameras[camera].stream &&
        each.recording == of_run.cameras[camera].recording)
      return &each;
  return nullptr;
}

// Key of a place in a session: "cameras.left.board" of "session: cameras.left.board".
QString keyIn(const std::string& place) {
  const std::size_t end = place.find(": ");
  return QString::fromStdString(end == std::string::npos ? place : place.substr(end + 2));
}

}  // namespace

class CalibrationDocument::EditCommand final : public QUndoCommand {
 public:
  EditCommand(CalibrationDocument& document, Session after, const QString& what, QString merge_key)
      : QUndoCommand(what),
        document_(document),
        before_(document.session_),
        after_(std::move(after)),
        merge_key_(std::move(merge_key)),
        edition_before_(document.edition_),
        edition_after_(++document.newest_edition_) {}

  void undo() override { document_.set(before_, edition_before_); }
  void redo() override { document_.set(after_, edition_after_); }
  int id() const override { return merge_key_.isEmpty() ? -1 : 1; }
  bool mergeWith(const QUndoCommand* other) override {
    const auto* const next = dynamic_cast<const EditCommand*>(other);
    if (next == nullptr || next->merge_key_ != merge_key_) return false;
    after_ = next->after_;
    edition_after_ = next->edition_after_;
    return true;
  }

 private:
  CalibrationDocument& document_;
  Session before_, after_;
  QString merge_key_;
  int edition_before_, edition_after_;
};

class CalibrationDocument::RunCommand final : public QUndoCommand {
 public:
  RunCommand(CalibrationDocument& document, const RunRecord& record, const QString& what)
      : QUndoCommand(what),
        document_(document),
        before_{document.last_, document.previous_},
        after_{record, document.last_} {
    document_.run_commands_.push_back(this);
  }
  ~RunCommand() override { std::erase(document_.run_commands_, this); }

  void undo() override { document_.set(before_); }
  void redo() override { document_.set(after_); }

 private:
  CalibrationDocument& document_;
  Runs before_, after_;
};

CalibrationDocument::CalibrationDocument(QObject* parent) : QObject(parent) {
  connect(&undo_stack_, &QUndoStack::cleanChanged, this, &CalibrationDocument::fileChanged);
}

// The undo stack emits signals when it is destroyed, when the receivers may be gone.
CalibrationDocument::~CalibrationDocument() {
  undo_stack_.blockSignals(true);
  undo_stack_.clear();
}

QString CalibrationDocument::title() const {
  if (!file_.isEmpty()) {
    const QFileInfo file(file_);  // most are called session.yaml, so the folder is shown, too
    return file.absoluteDir().dirName() + '/' + file.fileName();
  }
  if (!hasSession()) return {};
  return QString::fromStdString(session_.recording.filename().string());
}

void CalibrationDocument::open(const QString& session_file) {
  replace(readSession(pathOf(session_file)), session_file);
}

void CalibrationDocument::startSession(const Session& session) {
  replace(session, {});
}

void CalibrationDocument::openRun(RunRecord record) {
  Session session = record.session;
  replace(std::move(session), {}, std::move(record));
}

void CalibrationDocument::openRun(RunRecord record, const QString& session_file) {
  replace(readSessionOfRun(pathOf(session_file)), session_file, std::move(record));
}

void CalibrationDocument::replace(Session session, const QString& session_file, RunRecord run) {
  session_ = std::move(session);
  file_ = session_file;
  board_confirmed_ = !session_file.isEmpty();  // saved sessions count as confirmed
  undo_stack_.clear();
  saved_edition_ = edition_;
  last_ = std::move(run);
  previous_ = {};
  reference_.reset();
  emit sessionReplaced();
  emit sessionChanged();
  emit fileChanged();
  emit runsChanged();
  emit referenceChanged();
}

void CalibrationDocument::save(const QString& session_file) {
  Session to_write = session_;
  to_write.recording = std::filesystem::absolute(session_.recording);
  writeSession(to_write, pathOf(session_file));
  file_ = session_file;
  session_.source = pathOf(session_file);
  saved_edition_ = edition_;
  undo_stack_.setClean();
  emit fileChanged();
}

void CalibrationDocument::loadReference(const QString& result_or_truth_file) {
  setReference({readResultYaml(pathOf(result_or_truth_file)), QFileInfo(result_or_truth_file).fileName()});
}

void CalibrationDocument::setReference(ReferenceResult reference) {
  reference_ = std::move(reference);
  emit referenceChanged();
}

void CalibrationDocument::moveRecording(const std::filesystem::path& from, const std::filesystem::path& to) {
  const auto place = std::filesystem::weakly_canonical(from);
  const auto moved = [&](Session session) {
    const auto move = [&](std::filesystem::path& path) {
      if (!path.empty() && std::filesystem::weakly_canonical(path) == place) path = to;
    };
    move(session.recording);
    for (std::filesystem::path& more : session.more_recordings) move(more);
    for (SessionCamera& camera : session.cameras) move(camera.recording);
    for (SessionImu& imu : session.imus) {
      move(imu.recording);
      move(imu.accelerometer_recording);
    }
    return session;
  };
  last_.session = moved(last_.session);
  previous_.session = moved(previous_.session);
  const bool has_file = !file_.isEmpty();
  const Session session = moved(session_);
  if (has_file) {
    edit(session, tr("Find the recording"));
  } else {
    set(session, edition_);
  }
  emit runsChanged();
}

void CalibrationDocument::forgetReference() {
  if (!reference_) return;
  reference_.reset();
  emit referenceChanged();
}

void CalibrationDocument::confirmBoard() {
  if (std::exchange(board_confirmed_, true)) return;
  emit boardConfirmationChanged();
}

void CalibrationDocument::edit(const Session& session, const QString& what, const QString& merge_key) {
  if (boardsYaml(session) != boardsYaml(session_)) confirmBoard();
  undo_stack_.push(new EditCommand(*this, session, what, merge_key));
}

void CalibrationDocument::setOption(const QString& name, const QString& value) {
  Session changed = session_;
  evical::setOption(changed.options, name.toStdString(), value.toStdString());
  validate(changed.options);
  if (changed.options == session_.options) return;
  edit(changed, tr("Set %1").arg(name), name);
}

void CalibrationDocument::resetOptions() {
  if (session_.options == CalibrationOptions{}) return;
  Session changed = session_;
  changed.options = {};
  edit(changed, tr("Reset all parameters"));
}

void CalibrationDocument::set(const Session& session, int edition) {
  session_ = session;
  session_.source = pathOf(file_);
  edition_ = edition;
  emit sessionChanged();
}

void CalibrationDocument::set(const Runs& runs) {
  last_ = runs.last;
  previous_ = runs.previous;
  emit runsChanged();
}

RejectedTimes CalibrationDocument::rejections() const {
  RejectedTimes rejected_s(last_.run ? last_.run->detections.cameras.size() : 0);
  for (std::size_t k = 0; k < rejected_s.size(); ++k)
    if (const SessionCamera* const camera = sameStream(last_.session, k, session_))
      rejected_s[k] = windowsAt(camera->rejected_windows_s, last_.run->detections.cameras[k]);
  return rejected_s;
}

bool CalibrationDocument::rejectionsArePending() const {
  return last_.run && rejections() != rejectedTimes_s(last_.run->detections);
}

int CalibrationDocument::rejectedCount() const {
  std::size_t count = 0;
  for (const SessionCamera& camera : session_.cameras) count += camera.rejected_windows_s.size();
  return static_cast<int>(count);
}

void CalibrationDocument::setRejections(const RejectedTimes& rejected_s, const QString& what) {
  if (rejected_s == rejections()) return;
  Session changed = session_;
  for (std::size_t k = 0; k < rejected_s.size(); ++k)
    if (SessionCamera* const camera = sameStream(last_.session, k, changed))
      camera->rejected_windows_s = rejected_s[k];
  edit(changed, what);
}

// If the stack has steps that restore runs, a run is a step, too: otherwise undo would lose it.
void CalibrationDocument::addRun(RunRecord record) {
  if (!run_commands_.empty()) return addUndoableRun(record, tr("Calibrate"));
  set(Runs{std::move(record), last_});
}

void CalibrationDocument::addUndoableRun(const RunRecord& record, const QString& what) {
  undo_stack_.push(new RunCommand(*this, record, what));
}

bool CalibrationDocument::runIsOutdated() const {
  return last_.run && !sameExceptNames(last_.session, session_);
}

std::vector<SessionProblem> sessionProblems(const Session& session, CalibrationAim aim) {
  std::vector<SessionProblem> problems;
  if (session.recording.empty()) return {{"recording", QObject::tr("Open a recording first")}};
  if (!pathExists(session.recording)) {
    problems.push_back({"recording", QObject::tr("%1 is missing. Find the recording or restore it")
                                         .arg(QString::fromStdString(session.recording.string()))});
  }
  if (session.cameras.empty())
    problems.push_back({"cameras", QObject::tr("Choose at least one stream as camera")});
  if (aim == CalibrationAim::Rig && session.imus.empty() && session.cameras.size() < 2)
    problems.push_back(
        {"imus",
         QObject::tr("Choose one stream as IMU, or a second one as camera; or calibrate the camera alone")});
  if (aim == CalibrationAim::Rig && session.board_blinks)
    problems.push_back(
        {"board",
         QObject::tr("A flashing board determines only one camera's lens: calibrate the camera alone")});
  const auto check = [&](const QString& field, auto&& checked) {
    try {
      checked();
    } catch (const CalibrationError& error) {
      problems.push_back(
          {field.isEmpty() ? keyIn(error.place()) : field,
           QString::fromStdString(error.advice().empty() ? error.problem()
                                                         : error.problem() + ". " + error.advice())});
    }
  };
  for (std::size_t i = 0; i <= session.further_boards.size(); ++i)
    check(QString::fromStdString(boardKey(session, i)), [&] {
      validate(boardAt(session, i));
      if (const auto& measured = measuredAt(session, i)) validate(*measured, boardAt(session, i));
    });
  for (const SessionCamera& camera : session.cameras) {
    if (!camera.intrinsics || !camera.intrinsics->resolution_px.known()) continue;
    check(QString::fromStdString("cameras." + camera.name + ".intrinsics"),
          [&] { validate(*camera.intrinsics, camera.name); });
  }
  if (problems.empty()) check({}, [&] { validate(session, "session"); });
  return problems;
}

}  // namespace evical::ui
