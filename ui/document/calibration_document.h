// SPDX-License-Identifier: GPL-3.0-or-later
// All state of a calibration: the session with its file and its undo, the last run, the one before, and what
// they are compared with. GUI thread only; knows no widgets.
#pragma once

#include "core/pipeline/pass/view_rejection.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/session/session.h"
#include "core/report/result_yaml.h"
#include "ui/document/calibration_aim.h"

#include <QObject>
#include <QString>
#include <QUndoStack>

#include <memory>
#include <optional>
#include <vector>

namespace evical::ui {

// A run, and what it was made from.
struct RunRecord {
  std::shared_ptr<const CalibrationRun> run;
  Session session;
  QString log;
};

// What runs are compared with: a truth, or a result of another time.
struct ReferenceResult {
  NamedResult named;
  QString title;  // its file's name, or the run's
};

class CalibrationDocument : public QObject {
  Q_OBJECT

 public:
  explicit CalibrationDocument(QObject* parent = nullptr);
  ~CalibrationDocument() override;

  const Session& session() const { return session_; }
  bool hasSession() const { return !session_.recording.empty(); }
  QString file() const { return file_; }  // empty: never saved
  QString title() const;                  // the file's name, or the recording's
  // Runs are undone with the same keys, but are nothing to be saved with the session.
  bool modified() const { return edition_ != saved_edition_; }
  QUndoStack& undoStack() { return undo_stack_; }

  // These throw CalibrationError and leave everything as it was.
  void open(const QString& session_file);
  void save(const QString& session_file);
  void loadReference(const QString& result_or_truth_file);

  void startSession(const Session& session);  // new, of no file: unsaved
  // A run of another time, with the session that it was made from; of no file, but nothing is unsaved.
  void openRun(RunRecord record);
  // The same beside its session's file; throws CalibrationError as open() does.
  void openRun(RunRecord record, const QString& session_file);
  void setReference(ReferenceResult reference);
  void forgetReference();
  // The recording is elsewhere: session and runs name that place.
  void moveRecording(const std::filesystem::path& from, const std::filesystem::path& to);

  // One step for undo; steps in a row with the same non-empty `merge_key` become one.
  void edit(const Session& session, const QString& what, const QString& merge_key = {});
  // By full name; throws CalibrationError for what is no value of this option, OptionConflict where
  // another option excludes it.
  void setOption(const QString& name, const QString& value);
  void resetOptions();

  // Whether a person has said that the board is this one: a guessed one nobody has looked at.
  bool boardConfirmed() const { return board_confirmed_; }
  void confirmBoard();

  // The latest one; null before the first, and when another session comes.
  const RunRecord& last() const { return last_; }
  const RunRecord& previous() const { return previous_; }
  void addRun(RunRecord record);
  // The same as a step for undo, which brings the runs back that were here before. What follows it is one, too.
  void addUndoableRun(const RunRecord& record, const QString& what);
  // The session is not as it was when the last run was made.
  bool runIsOutdated() const;

  // What the next calibration from the last run's detections is to leave out: at first what that run left out.
  const RejectedTimes& rejections() const { return rejections_; }
  bool rejectionsArePending() const;  // they are not the last run's
  // One step for undo.
  void setRejections(RejectedTimes rejected_s, const QString& what);

  const std::optional<ReferenceResult>& reference() const { return reference_; }

 signals:
  void sessionReplaced();  // another one: open, new
  void sessionChanged();   // in anything, also by undo
  void fileChanged();      // name or modified flag
  void boardConfirmationChanged();
  void runsChanged();
  void rejectionsChanged();  // also with the runs
  void referenceChanged();

 private:
  class EditCommand;
  class RunCommand;
  class RejectionCommand;
  struct Runs {
    RunRecord last, previous;
    RejectedTimes rejections;
  };

  void replace(Session session, const QString& session_file, RunRecord run = {});
  void set(const Session& session, int edition);
  void set(const Runs& runs);
  void set(const RejectedTimes& rejections);

  Session session_;
  QString file_;
  bool board_confirmed_ = false;
  QUndoStack undo_stack_;
  int edition_ = 0, saved_edition_ = 0, newest_edition_ = 0;  // each edit makes one of its own
  RunRecord last_, previous_;
  RejectedTimes rejections_;
  std::vector<const QUndoCommand*> run_commands_;  // on the stack: of runs, and of what they leave out
  std::optional<ReferenceResult> reference_;
};

// What the program knows of a session that cannot be calibrated, by field: "cameras.left.intrinsics", ...
struct SessionProblem {
  QString field, text;
};
std::vector<SessionProblem> sessionProblems(const Session& session, CalibrationAim aim = CalibrationAim::Rig);

}  // namespace evical::ui
