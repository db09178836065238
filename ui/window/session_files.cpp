// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/session_files.h"

#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/export/export_target.h"
#include "core/pipeline/runs/result_files.h"
#include "core/pipeline/runs/saved_run.h"
#include "core/pipeline/session/session_guess.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/synthetic/scenario_yaml.h"
#include "ui/document/printed_board.h"
#include "ui/window/page_work.h"
#include "ui/window/recent_files.h"

#include <QDesktopServices>
#include <QDir>
#include <QFile>
#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QSettings>
#include <QStandardPaths>
#include <QTemporaryDir>
#include <QTimer>
#include <QUrl>

#include <algorithm>
#include <optional>

namespace evical::ui {
namespace {

const char* const kFolderKey = "last_folder";
const char* const kReport = "report.html";

// The session's recording first.
QStringList recordingsOf(const Session& session) {
  QStringList recordings = {QString::fromStdString(session.recording.string())};
  const auto add = [&](const auto& sensor) {
    const QString own = QString::fromStdString(sensor.recording.string());
    if (!own.isEmpty() && !recordings.contains(own)) recordings << own;
  };
  std::for_each(session.cameras.begin(), session.cameras.end(), add);
  std::for_each(session.imus.begin(), session.imus.end(), add);
  return recordings;
}

bool isSessionFile(const QString& path) {
  const QString suffix = QFileInfo(path).suffix().toLower();
  return suffix == "yaml" || suffix == "yml";
}

// Session file of a run stored next to it; empty if there is none.
QString sessionOfRun(const QString& folder) {
  const QFileInfo place(QFileInfo(folder).absolutePath());
  if (place.suffix() != "runs") return {};
  for (const char* const suffix : {".yaml", ".yml"}) {
    const QString file = place.dir().filePath(place.completeBaseName() + suffix);
    if (QFile::exists(file)) return file;
  }
  return {};
}

// Scenarios refer to each other by file, so the embedded ones are copied to temporary files.
Scenario demoScenario() {
  const QTemporaryDir folder;
  for (const char* const name : {"davis346.yaml", "davis346_10s.yaml"})
    QFile::copy(QString(":/demo/") + name, folder.filePath(name));
  return readScenario(folder.filePath("davis346_10s.yaml").toStdString());
}

// "Kalibr", from the list of targets.
QString programOf(const std::string& target) {
  return QString::fromUtf8(exportTarget(target, {}).program);
}

// Runs in the job. A folder created for it is removed if the export fails.
ExportOutcome exportRun(const RunRecord& record, const ExportRequest& request, const QString& version,
                        const RunContext& context) {
  const std::filesystem::path folder = request.folder.toStdString();
  const NewFolder made(folder);
  const ExportRemarks remarks =
      writeResultFiles(folder, record.session, record.run, version.toStdString(), record.log.toStdString());
  for (const std::string& note : remarks.notes) context.progress.log(LogLevel::Info, note);
  ExportOutcome outcome{request.folder, {}, {}, request.check, {}};
  for (const std::string& target : remarks.targets) outcome.programs << programOf(target);
  for (const std::string& text : remarks.refused) {
    context.progress.log(LogLevel::Warning, text);
    outcome.refused << QString::fromStdString(text);
  }
  if (!request.check) return outcome;
  for (const ExportCheck& check : checkExports(folder, remarks.targets, context.stop)) {
    context.progress.log(check.same ? LogLevel::Info : LogLevel::Warning, check.text);
    if (!check.same) outcome.differing << QString::fromStdString(check.text);
  }
  return outcome;
}

}  // namespace

SessionFiles::SessionFiles(Workbench& workbench, QWidget* window)
    : QObject(window), workbench_(workbench), window_(window) {
  connect(&workbench_.inspection, &InspectionJob::inspected, this,
          [this](const QString& recording, const std::shared_ptr<const Inspection>& inspection) {
            recordingInspected(recording, *inspection);
            furtherRecordingInspected(recording, *inspection);
            takeResolutions(recording, *inspection);
          });
  connect(&workbench_.inspection, &InspectionJob::failed, this,
          [this](const QString& recording, const JobError& error) {
            const bool further = further_recordings_.removeAll(recording) > 0;
            if (recording != awaited_recording_ && !further) return;
            emit failed(tr("%1 cannot be opened").arg(QFileInfo(recording).fileName()), error);
            if (!further) inspectSession();
          });
  connect(&workbench_.document, &CalibrationDocument::sessionReplaced, this, [this] {
    exportEveryResult(false);
    export_targets_.reset();
  });
  connect(&workbench_.document, &CalibrationDocument::runsChanged, this, &SessionFiles::rememberRun);
  connect(&workbench_.history, &RunHistory::changed, this, &SessionFiles::showNewestRun);
  connect(&workbench_.lens, &LensDocument::runChanged, this, &SessionFiles::rememberRun);
  connect(&workbench_.calibration, &CalibrationJob::calibrated, this, [this] {
    if (every_result_folder_.isEmpty()) return;
    // After all receivers have handled the run: an export is a separate job.
    QTimer::singleShot(0, this, [this] { exportTo(every_result_folder_); });
  });
}

void SessionFiles::openRecent(const QString& path) {
  open(path);
  newest_run_awaited_ = !workbench_.runner.running();
}

// Recent files are listed with the verdict of their last run, so opening one shows this run.
void SessionFiles::showNewestRun() {
  RunHistory& history = workbench_.history;
  if (!newest_run_awaited_ || history.runs().empty()) return;
  newest_run_awaited_ = false;
  const auto is_wanted = [this] { return !workbench_.document.last().run && !workbench_.runner.running(); };
  if (!is_wanted()) return;
  history.open(history.runs().back().folder,
               [this, is_wanted, place = history.place()](const SavedRun& saved) {
                 if (!is_wanted() || workbench_.history.place() != place) return;
                 workbench_.lens.setAim(CalibrationAim::Rig);  // saved runs are rigs
                 workbench_.document.addRun({saved.run, saved.session, QString::fromStdString(saved.log)});
               });
}

void SessionFiles::open(const QString& path) {
  newest_run_awaited_ = false;
  if (workbench_.runner.running()) {
    emit failed(tr("%1 cannot be opened now").arg(QFileInfo(path).fileName()),
                {true, workbench_.runner.title(), tr("is still running"), tr("Cancel it, or wait")});
    return;
  }
  const QString session_inside = QDir(path).filePath("session.yaml");
  if (QFileInfo(path).isDir() && QFile::exists(session_inside)) return openSession(session_inside);
  if (isSavedRun(path.toStdString())) return openRun(path);
  isSessionFile(path) ? openSession(path) : openRecording(path);
}

void SessionFiles::openSession(const QString& file) {
  if (!mayDiscard()) return;
  try {
    workbench_.document.open(QFileInfo(file).absoluteFilePath());
  } catch (const CalibrationError& error) {
    emit failed(tr("%1 cannot be opened").arg(QFileInfo(file).fileName()), errorOf(error));
    return;
  }
  remember(workbench_.document.file());
  inspectSession();
  const QString truth = QFileInfo(file).dir().filePath("truth.yaml");
  try {
    if (QFile::exists(truth)) workbench_.document.loadReference(truth);
  } catch (const CalibrationError& error) {
    emit failed(tr("The truth next to the session cannot be read"), errorOf(error));
  }
  emit opened();
}

void SessionFiles::openRun(const QString& path) {
  if (!mayDiscard()) return;
  workbench_.history.open(path.toStdString(), [this](const SavedRun& saved) { runOpened(saved); });
}

void SessionFiles::runOpened(const SavedRun& saved) {
  const QString folder = QString::fromStdString(saved.summary.folder.string());
  if (workbench_.runner.running()) {
    emit failed(tr("%1 was not opened").arg(folder),
                {true, workbench_.runner.title(), tr("was started meanwhile"), tr("Cancel it, or wait")});
    return;
  }
  workbench_.lens.setAim(CalibrationAim::Rig);  // saved runs are rigs
  RunRecord record{saved.run, saved.session, QString::fromStdString(saved.log)};
  const QString session_file = sessionOfRun(folder);
  try {
    if (session_file.isEmpty())
      workbench_.document.openRun(std::move(record));
    else
      workbench_.document.openRun(std::move(record), session_file);
  } catch (const CalibrationError& error) {
    emit failed(tr("The session of %1 cannot be opened").arg(folder), errorOf(error));
    return;
  }
  remember(QDir(folder).filePath("result.yaml"));
  rememberVerdict(QDir(folder).filePath("result.yaml"), saved.run->result.status);
  inspectSession();
  emit opened();
  QStringList missing;
  for (const std::string& text : saved.missing) missing << QString::fromStdString(text);
  if (!missing.isEmpty())
    emit failed(tr("The run is incomplete"), {true, folder, missing.join('\n'),
                                              tr("Calibrate again: the pages show only the available data")});
}

void SessionFiles::lookForRecording(const QString& missing) {
  const QString name = QFileInfo(missing).fileName();
  const QString file = askForRecording(window_, tr("Where is %1?").arg(name), RecordingChoice::Recordings);
  if (file.isEmpty()) return;
  workbench_.document.moveRecording(missing.toStdString(), QFileInfo(file).absoluteFilePath().toStdString());
  inspectSession();
}

void SessionFiles::openRecording(const QString& path) {
  if (!mayDiscard()) return;
  further_recordings_.clear();
  await(QFileInfo(path).absoluteFilePath());
  workbench_.inspection.start({awaited_recording_});
}

void SessionFiles::await(const QString& recording) {
  if (recording == awaited_recording_) return;
  awaited_recording_ = recording;
  emit reading(QFileInfo(recording).fileName());
}

// Inspects the streams of the open session; also after a failure to open another recording.
void SessionFiles::inspectSession() {
  await({});
  further_recordings_.clear();
  const Session& session = workbench_.document.session();
  if (!session.recording.empty()) workbench_.inspection.start(recordingsOf(session));
}

bool SessionFiles::refuseUseless(const QString& recording, const Inspection& inspection) {
  const auto error = whyUseless(recording.toStdString(), inspection);
  if (error) emit failed(tr("%1 cannot be used").arg(QFileInfo(recording).fileName()), errorOf(*error));
  return error.has_value();
}

void SessionFiles::recordingInspected(const QString& recording, const Inspection& inspection) {
  if (recording != awaited_recording_) return;
  await({});
  if (refuseUseless(recording, inspection)) return inspectSession();
  Session session = withSeenResolutions(guessedSession(recording.toStdString(), inspection),
                                        recording.toStdString(), inspection);
  if (const auto printed = lastPrintedBoard()) setPrintedBoard(*printed, session);
  workbench_.document.startSession(session);
  remember(recording);
  emit opened();
}

void SessionFiles::addRecording(const QString& path) {
  const QString recording = QFileInfo(path).absoluteFilePath();
  const QStringList listed = recordingsOf(workbench_.document.session()) + further_recordings_;
  if (std::any_of(listed.begin(), listed.end(),
                  [&](const QString& other) { return QFileInfo(other) == QFileInfo(recording); })) {
    emit failed(
        tr("%1 was not added").arg(QFileInfo(path).fileName()),
        {true, recording, tr("its streams are listed already"), tr("Choose their roles in the list")});
    return;
  }
  further_recordings_ << recording;
  workbench_.inspection.add(recording);
}

void SessionFiles::furtherRecordingInspected(const QString& recording, const Inspection& inspection) {
  if (further_recordings_.removeAll(recording) == 0 || refuseUseless(recording, inspection)) return;
  CalibrationDocument& document = workbench_.document;
  const Session found = withMissingSensors(document.session(), recording.toStdString(), inspection);
  const bool more = found.cameras.size() + found.imus.size() >
                    document.session().cameras.size() + document.session().imus.size();
  if (more) document.edit(found, tr("Add sensors of %1").arg(QFileInfo(recording).fileName()), {});
}

// For sessions without a resolution whose recordings do not contain it either.
void SessionFiles::takeResolutions(const QString& recording, const Inspection& inspection) {
  CalibrationDocument& document = workbench_.document;
  const Session found = withSeenResolutions(document.session(), recording.toStdString(), inspection);
  const auto same = [](const SessionCamera& a, const SessionCamera& b) {
    return a.resolution_px == b.resolution_px;
  };
  const std::vector<SessionCamera>& before = document.session().cameras;
  if (!std::equal(found.cameras.begin(), found.cameras.end(), before.begin(), before.end(), same))
    document.edit(found, tr("Take the resolution from the recording"), {});
}

void SessionFiles::chooseSession() {
  const QString file = askForRecording(window_, tr("Open a session, a result or a recording"),
                                       RecordingChoice::RecordingsAndSessions);
  if (!file.isEmpty()) open(file);
}

void SessionFiles::chooseRecording() {
  const QString file = askForRecording(window_, tr("Open a recording"), RecordingChoice::Recordings);
  if (!file.isEmpty()) open(file);
}

void SessionFiles::chooseFurtherRecording() {
  const QString file =
      askForRecording(window_, tr("Sensors from another recording"), RecordingChoice::Recordings);
  if (!file.isEmpty()) addRecording(file);
}

bool SessionFiles::save() {
  return workbench_.document.file().isEmpty() ? saveAs() : saveTo(workbench_.document.file());
}

bool SessionFiles::saveAs() {
  const QString recording = QString::fromStdString(workbench_.document.session().recording.string());
  const QString proposal = workbench_.document.file().isEmpty()
                               ? QFileInfo(recording).dir().filePath("session.yaml")
                               : workbench_.document.file();
  const QString file =
      QFileDialog::getSaveFileName(window_, tr("Save the session"), proposal, tr("Sessions (*.yaml)"));
  return !file.isEmpty() && saveTo(file);
}

bool SessionFiles::saveTo(const QString& file) {
  try {
    workbench_.document.save(file);
    remember(file);
    return true;
  } catch (const CalibrationError& error) {
    emit failed(tr("The session was not saved"), errorOf(error));
    return false;
  }
}

bool SessionFiles::mayDiscard() {
  if (!workbench_.document.modified()) return true;
  QMessageBox question(QMessageBox::Question, tr("Unsaved changes"),
                       workbench_.document.file().isEmpty()
                           ? tr("Save the settings for %1 as a session?").arg(workbench_.document.title())
                           : tr("Save the changes to %1?").arg(workbench_.document.title()),
                       QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, window_);
  question.setInformativeText(
      tr("Board, sensors, parameters and rejected windows are stored in the session file; the recording is "
         "not changed."));
  question.setDefaultButton(QMessageBox::Save);
  const int answer = question.exec();
  if (answer == QMessageBox::Save) return save();
  return answer == QMessageBox::Discard;
}

void SessionFiles::openDemo() {
  const QString folder =
      QStandardPaths::writableLocation(QStandardPaths::AppDataLocation) + "/demo_" + workbench_.version;
  const QString session = folder + "/session.yaml";
  if (QFile::exists(session)) return open(session);  // written last, so the recording is complete
  if (!mayDiscard()) return;
  QDir().mkpath(QFileInfo(folder).path());
  const bool begun = workbench_.runner.start(
      tr("Simulate the demo"), {{"simulate", 1.0}},
      [folder](const RunContext& context) { simulate(demoScenario(), folder.toStdString(), context); });
  if (!begun) return;
  emit demoRunning(true);
  connect(
      &workbench_.runner, &JobRunner::finished, this,
      [this, session](JobOutcome outcome) {
        emit demoRunning(false);
        if (outcome == JobOutcome::Done) open(session);
      },
      Qt::SingleShotConnection);
}

void SessionFiles::chooseReference() {
  const QString file = QFileDialog::getOpenFileName(window_, tr("Compare with a result or a truth"),
                                                    lastFolder(), tr("Results (*.yaml);;All files (*)"));
  if (file.isEmpty()) return;
  try {
    workbench_.document.loadReference(file);
  } catch (const CalibrationError& error) {
    emit failed(tr("%1 cannot be used for the comparison").arg(QFileInfo(file).fileName()), errorOf(error));
  }
}

void SessionFiles::chooseExportFolder() {
  const RunRecord& last = workbench_.document.last();
  if (!last.run) return;
  ExportRequest proposal = proposedExport(last.session);
  if (export_targets_) proposal.targets = *export_targets_;
  ExportDialog dialog(proposal, window_);
  if (dialog.exec() != QDialog::Accepted) return;
  export_targets_ = dialog.request().targets;
  rememberExport(dialog.request());
  startExport(dialog.request());
}

void SessionFiles::exportTo(const QString& folder) {
  startExport({folder, export_targets_.value_or(workbench_.document.last().session.exports)});
}

void SessionFiles::startExport(const ExportRequest& request) {
  writeResult(tr("Export"), request, [this](const ExportOutcome& outcome) { emit exported(outcome); });
}

void SessionFiles::writeResult(const QString& title, const ExportRequest& request,
                               const std::function<void(const ExportOutcome&)>& written) {
  RunRecord record = workbench_.document.last();
  if (!record.run) return;
  record.session.exports = request.targets;
  const auto outcome = std::make_shared<ExportOutcome>();  // read here after the job
  const bool begun = workbench_.runner.start(
      title, {}, [record, request, outcome, version = workbench_.version](const RunContext& context) {
        *outcome = exportRun(record, request, version, context);
      });
  if (!begun) {
    emit failed(tr("Nothing was written"),
                {true, workbench_.runner.title(), tr("is still running"), tr("Cancel it, or wait")});
    return;
  }
  connect(
      &workbench_.runner, &JobRunner::finished, this,
      [this, run = record.run, folder = request.folder, outcome, written](JobOutcome ended) {
        if (ended != JobOutcome::Done) return;
        reported_run_ = run;
        report_folder_ = folder;
        written(*outcome);
      },
      Qt::SingleShotConnection);
}

void SessionFiles::openReport() {
  const RunRecord& record = workbench_.document.last();
  if (!record.run) return;
  if (reported_run_ == record.run && QFile::exists(QDir(report_folder_).filePath(kReport)))
    return showReport();
  writeResult(tr("Report"), {momentary_.path(), {}}, [this](const ExportOutcome&) { showReport(); });
}

void SessionFiles::showReport() {
  const QString file = QDir(report_folder_).filePath(kReport);
  if (QDesktopServices::openUrl(QUrl::fromLocalFile(file))) return;
  emit failed(tr("The report cannot be shown"),
              {true, file, tr("no program on this computer opens it"), tr("Open it with a browser")});
}

void SessionFiles::exportEveryResult(bool wanted) {
  every_result_folder_ =
      wanted ? QFileDialog::getExistingDirectory(window_, tr("Export every result to a folder"), lastFolder())
             : QString();
  emit exportsEveryResult(!every_result_folder_.isEmpty());
}

QString SessionFiles::lastFolder() const {
  return QSettings().value(kFolderKey, QDir::homePath()).toString();
}

void SessionFiles::remember(const QString& file) {
  rememberOpened(file);
  QSettings().setValue(kFolderKey, QFileInfo(file).path());
  emit recentFilesChanged();
}

// For the open session or recording.
void SessionFiles::rememberRun() {
  const std::optional<CalibrationStatus> verdict = workbench_.lastStatus();
  if (!verdict) return;
  const QString file = workbench_.document.file();
  rememberVerdict(
      file.isEmpty() ? QString::fromStdString(workbench_.document.session().recording.string()) : file,
      *verdict);
  emit recentFilesChanged();
}

}  // namespace evical::ui
