// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/run_history.h"

#include "core/base/error.h"
#include "core/base/in_parallel.h"

#include <QCryptographicHash>
#include <QDateTime>
#include <QFileInfo>
#include <QStandardPaths>

#include <exception>
#include <system_error>

namespace evical::ui {
namespace {

std::filesystem::path pathOf(const QString& text) {
  return std::filesystem::path(text.toStdString());
}

std::filesystem::path placeBeside(const QString& session_file) {
  const QFileInfo file(session_file);
  return pathOf(file.absolutePath()) / pathOf(file.completeBaseName() + ".runs");
}

std::filesystem::path placeOfSessionsWithoutFile() {
  return pathOf(QStandardPaths::writableLocation(QStandardPaths::AppDataLocation)) / "runs";
}

// Recordings in different folders may have the same name.
std::filesystem::path placeOfRecording(const std::filesystem::path& recording) {
  const auto path = QString::fromStdString(std::filesystem::absolute(recording).string());
  const QByteArray sum = QCryptographicHash::hash(path.toUtf8(), QCryptographicHash::Sha1).toHex().left(8);
  return placeOfSessionsWithoutFile() / pathOf(QFileInfo(path).fileName() + "-" + sum);
}

bool canBeWritten(const std::filesystem::path& place) {
  const QFileInfo parent(QString::fromStdString(place.parent_path().string()));
  return parent.isDir() && parent.isWritable();
}

// Created immediately: another window may store a run in the same second.
std::filesystem::path newFolder(const std::filesystem::path& place, std::int64_t made_s) {
  std::filesystem::create_directories(place);
  const QString date = QDateTime::fromSecsSinceEpoch(made_s).toString("yyyy-MM-dd_hh-mm-ss");
  std::filesystem::path folder = place / pathOf(date);
  for (int number = 2; !std::filesystem::create_directory(folder); ++number)
    folder = place / pathOf(QString("%1_%2").arg(date).arg(number));
  return folder;
}

std::vector<RunSummary> allWithoutFile() {
  std::vector<RunSummary> all;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(placeOfSessionsWithoutFile(), error), end;
       !error && entry != end; entry.increment(error))
    for (RunSummary& run : listRuns(entry->path())) all.push_back(std::move(run));
  return all;
}

void moveRun(const std::filesystem::path& from, const std::filesystem::path& place) {
  std::filesystem::create_directories(place);
  const std::filesystem::path to = place / from.filename();
  std::error_code elsewhere;
  std::filesystem::rename(from, to, elsewhere);
  if (!elsewhere) return;
  std::filesystem::copy(from, to, std::filesystem::copy_options::recursive);
  std::filesystem::remove_all(from);
}

JobError errorOf(const std::exception& exception) {
  if (const auto* const error = dynamic_cast<const CalibrationError*>(&exception))
    return {error->kind() == ErrorKind::BadInput, QString::fromStdString(error->place()),
            QString::fromStdString(error->problem()), QString::fromStdString(error->advice())};
  return {false, {}, QString::fromUtf8(exception.what()), {}};
}

}  // namespace

RunHistory::RunHistory(QObject* parent) : QObject(parent) {
  pool_.setMaxThreadCount(1);
}

RunHistory::~RunHistory() {
  pool_.waitForDone();
}

void RunHistory::work(const QString& what, std::function<Done()> piece) {
  pool_.start([this, what, piece = std::move(piece)] {
    makeThreadModest();
    Done done;
    try {
      done = piece();
    } catch (const std::exception& exception) {
      done = [this, what, error = errorOf(exception)] { emit failed(what, error); };
    }
    QMetaObject::invokeMethod(this, done, Qt::QueuedConnection);
  });
}

void RunHistory::setSession(const QString& session_file, const std::filesystem::path& recording) {
  has_file_ = !session_file.isEmpty() && canBeWritten(placeBeside(session_file));
  place_ = has_file_ ? placeBeside(session_file) : recording.empty() ? "" : placeOfRecording(recording);
  runs_.clear();
  emit changed();
  if (!place_.empty()) listAnew();
}

void RunHistory::moveTo(const QString& session_file) {
  const std::filesystem::path from = place_, to = placeBeside(session_file);
  if (from == to) return;
  const bool moves = !has_file_ && canBeWritten(to);
  if (!moves && !canBeWritten(to)) return;
  place_ = to;
  has_file_ = true;
  for (auto& [run, folder] : folders_)
    if (moves && folder.parent_path() == from) folder = to / folder.filename();
  work(tr("The runs were not moved to the session's file"), [from, to, moves]() -> Done {
    if (moves)
      for (const RunSummary& run : listRuns(from)) moveRun(run.folder, to);
    return [] {};
  });
  listAnew();
}

void RunHistory::listAnew() {
  work(tr("The runs cannot be listed"), [this, place = place_]() -> Done {
    return [this, place, runs = listRuns(place)] {
      if (place != place_) return;  // the session has changed meanwhile
      runs_ = runs;
      emit changed();
    };
  });
}

void RunHistory::keep(std::shared_ptr<const CalibrationRun> run, const Session& session,
                      const QString& version, const QString& log) {
  if (place_.empty()) return;
  const std::int64_t made_s = QDateTime::currentSecsSinceEpoch();
  work(tr("The run was not stored"),
       [this, run, session, version, log, made_s, place = place_, has_file = has_file_]() -> Done {
         const std::filesystem::path folder = newFolder(place, made_s);
         keepRun(folder, session, run, version.toStdString(), log.toStdString(), made_s);
         removeOldRuns(listRuns(place), kMaxRuns, kMaxBytes);
         if (!has_file) removeOldRuns(allWithoutFile(), kMaxRunsWithoutFile, kMaxBytesWithoutFile);
         return [this, run, folder] {
           std::erase_if(folders_, [](const auto& each) { return each.first.expired(); });
           const bool here =
               folder.parent_path() == place_ || !std::filesystem::exists(place_ / folder.filename());
           folders_.emplace_back(run, here ? folder : place_ / folder.filename());
           listAnew();
         };
       });
}

void RunHistory::rename(const std::filesystem::path& folder, const QString& name) {
  work(tr("The run was not renamed"), [folder, name]() -> Done {
    renameRun(folder, name.trimmed().toStdString());
    return [] {};
  });
  listAnew();
}

void RunHistory::remove(const std::vector<std::filesystem::path>& folders) {
  work(tr("The run was not deleted"), [folders]() -> Done {
    for (const std::filesystem::path& folder : folders) std::filesystem::remove_all(folder);
    return [] {};
  });
  listAnew();
}

std::filesystem::path RunHistory::folderOf(const std::shared_ptr<const CalibrationRun>& run) const {
  for (const auto& [kept, folder] : folders_)
    if (run && kept.lock() == run) return folder;
  return {};
}

void RunHistory::open(const std::filesystem::path& path, const std::function<void(const SavedRun&)>& done) {
  const QString name = QString::fromStdString(path.filename().string());
  work(tr("%1 cannot be opened").arg(name), [this, path, done]() -> Done {
    return [this, done, saved = readSavedRun(path)] {
      folders_.emplace_back(saved.run, saved.summary.folder);
      done(saved);
    };
  });
}

void RunHistory::openNumbers(const std::filesystem::path& folder,
                             const std::function<void(const NamedResult&)>& done) {
  work(tr("The run cannot be used for the comparison"), [folder, done]() -> Done {
    return [done, named = readResultYaml(resultFileOf(folder))] { done(named); };
  });
}

}  // namespace evical::ui
