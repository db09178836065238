// SPDX-License-Identifier: GPL-3.0-or-later
// All state of a calibration: the session with its file and its undo, the last run, the one before, and what
// they are compared with. GUI thread only; knows no widgets.
#pragma once

#include "core/pipeline/calibration_pipeline.h"
#include "core/pipeline/session.h"
#include "core/report/result_yaml.h"

#include <QObject>
#include <QString>
#include <QUndoStack>

#include <memory>
#include <optional>

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
  QString file;
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
  bool modified() const { return has_unsaved_recording_ || !undo_stack_.isClean(); }
  QUndoStack& undoStack() { return undo_stack_; }

  // These throw CalibrationError and leave everything as it was.
  void open(const QString& session_file);
  void save(const QString& session_file);
  void loadReference(const QString& result_or_truth_file);

  void startSession(const Session& session);  // new, of no file: unsaved
  void forgetReference();

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
  // The session is not as it was when the last run was made.
  bool runIsOutdated() const;

  const std::optional<ReferenceResult>& reference() const { return reference_; }

 signals:
  void sessionReplaced();  // another one: open, new
  void sessionChanged();   // in anything, also by undo
  void fileChanged();      // name or modified flag
  void boardConfirmationChanged();
  void runsChanged();
  void referenceChanged();

 private:
  class EditCommand;

  void replace(Session session, const QString& session_file, bool unsaved);
  void set(const Session& session);

  Session session_;
  QString file_;
  bool has_unsaved_recording_ = false;
  bool board_confirmed_ = false;
  QUndoStack undo_stack_;
  RunRecord last_, previous_;
  std::optional<ReferenceResult> reference_;
};

// What the program knows of a session that cannot be calibrated, by field: "cameras.left.intrinsics", ...
struct SessionProblem {
  QString field, text;
};
std::vector<SessionProblem> sessionProblems(const Session& session);

}  // namespace evical::ui
