// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of a session, stored as folders: next to its file in NAME.runs, or with the user's data if it has no
// file. Reads and writes in order in a separate thread; GUI thread only.
#pragma once

#include "core/pipeline/runs/saved_run.h"
#include "core/report/result_yaml.h"
#include "ui/jobs/job_runner.h"

#include <QObject>
#include <QString>
#include <QThreadPool>

#include <filesystem>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace evical::ui {

class RunHistory : public QObject {
  Q_OBJECT

 public:
  // Limits for one session, and for all sessions without a file together.
  static constexpr std::size_t kMaxRuns = 20, kMaxRunsWithoutFile = 60;
  static constexpr std::uintmax_t kMaxBytes = 500'000'000, kMaxBytesWithoutFile = 1'000'000'000;

  explicit RunHistory(QObject* parent = nullptr);
  ~RunHistory() override;  // completes pending writes

  // Lists the runs of another session. Without a file, by its recording; without both, none.
  void setSession(const QString& session_file, const std::filesystem::path& recording);
  // Moves the runs of a session without a file to its new file.
  void moveTo(const QString& session_file);
  const std::filesystem::path& place() const { return place_; }

  void keep(std::shared_ptr<const CalibrationRun> run, const Session& session, const QString& version,
            const QString& log);
  void rename(const std::filesystem::path& folder, const QString& name);
  void remove(const std::vector<std::filesystem::path>& folders);

  // Oldest first.
  const std::vector<RunSummary>& runs() const { return runs_; }
  // Folder where a run is stored or was opened from; empty: none yet.
  std::filesystem::path folderOf(const std::shared_ptr<const CalibrationRun>& run) const;

  // A saved run, and the numbers of one; `done` is called in the GUI thread, unless it `failed`.
  void open(const std::filesystem::path& path, const std::function<void(const SavedRun&)>& done);
  void openNumbers(const std::filesystem::path& folder, const std::function<void(const NamedResult&)>& done);

 signals:
  void changed();  // runs()
  void failed(const QString& what_was_tried, const evical::ui::JobError& error);

 private:
  using Done = std::function<void()>;
  void work(const QString& what, std::function<Done()> piece);
  void listAnew();

  QThreadPool pool_;
  std::filesystem::path place_;
  bool has_file_ = false;
  std::vector<RunSummary> runs_;
  std::vector<std::pair<std::weak_ptr<const CalibrationRun>, std::filesystem::path>> folders_;
};

}  // namespace evical::ui
