// SPDX-License-Identifier: GPL-3.0-or-later
// State of a calibration: the session with its file and undo stack, the last run, the previous one, and the
// reference for comparisons. GUI thread only; without widgets.
#pragma once

#include "core/pipeline/detection/view_rejection.h"
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

// A run with its session and log.
struct RunRecord {
  std::shared_ptr<const CalibrationRun> run;
  Session session;
  QString log;
};

// Reference for the comparison of runs: a truth, or an older result.
struct ReferenceResult {
  NamedResult named;
  QString title;  // name of its file, or title of the run
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
  // Runs are undone with the same keys, but do not modify the session.
  bool modified() const { return edition_ != saved_edition_; }
  QUndoStack& undoStack() { return undo_stack_; }

  // These throw CalibrationError and leave everything unchanged.
  void open(const QString& session_file);
  void save(const QString& session_file);
  void loadReference(const QString& result_or_truth_file);

  void startSession(const Session& session);  // new, without a file: unsaved
  // An older run with its session; without a file, but nothing is unsaved.
  void openRun(RunRecord record);
  // The same with the session's file; throws CalibrationError like open().
  void openRun(RunRecord record, const QString& session_file);
  void setReference(ReferenceResult reference);
  void forgetReference();
  // Changes the place of a recording in session and runs.
  void moveRecording(const std::filesystem::path& from, const std::filesystem::path& to);

  // One step of undo; consecutive steps with the same non-empty `merge_key` are merged.
  void edit(const Session& session, const QString& what, const QString& merge_key = {});
  // By full name; throws CalibrationError for an invalid value, OptionConflict if another option excludes it.
  void setOption(const QString& name, const QString& value);
  void resetOptions();

  // False for a guessed board that the user must still confirm.
  bool boardConfirmed() const { return board_confirmed_; }
  void confirmBoard();

  // The latest run; null before the first one and in a new session.
  const RunRecord& last() const { return last_; }
  const RunRecord& previous() const { return previous_; }
  void addRun(RunRecord record);
  // Like addRun(), as a step of undo that restores the previous runs. The following runs are steps as well.
  void addUndoableRun(const RunRecord& record, const QString& what);
  // The session has changed since the last run.
  bool runIsOutdated() const;

  // The session's rejected windows among those of the last run, by its cameras.
  RejectedTimes rejections() const;
  bool rejectionsArePending() const;  // they differ from the last run's
  int rejectedCount() const;          // windows of all cameras of the session
  // Puts such times into the session: one step of undo.
  void setRejections(const RejectedTimes& rejected_s, const QString& what);

  const std::optional<ReferenceResult>& reference() const { return reference_; }

 signals:
  void sessionReplaced();  // opened or new
  void sessionChanged();   // any change, also by undo
  void fileChanged();      // name or modified flag
  void boardConfirmationChanged();
  void runsChanged();
  void referenceChanged();

 private:
  class EditCommand;
  class RunCommand;
  struct Runs {
    RunRecord last, previous;
  };

  void replace(Session session, const QString& session_file, RunRecord run = {});
  void set(const Session& session, int edition);
  void set(const Runs& runs);

  Session session_;
  QString file_;
  bool board_confirmed_ = false;
  QUndoStack undo_stack_;
  int edition_ = 0, saved_edition_ = 0, newest_edition_ = 0;  // each edit has a new number
  RunRecord last_, previous_;
  std::vector<const QUndoCommand*> run_commands_;  // commands on the stack for runs
  std::optional<ReferenceResult> reference_;
};

// A reason why the session cannot be calibrated, by field: "cameras.left.intrinsics", ...
struct SessionProblem {
  QString field, text;
};
std::vector<SessionProblem> sessionProblems(const Session& session, CalibrationAim aim = CalibrationAim::Rig);

}  // namespace evical::ui
