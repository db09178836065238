// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/export_dialog.h"

#include "core/export/export_target.h"
#include "ui/theme/theme.h"

#include <QCheckBox>
#include <QDialogButtonBox>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QScreen>
#include <QSettings>
#include <QTreeWidget>
#include <QVBoxLayout>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace evical::ui {
namespace {

enum Column { kProgram, kUse, kFiles, kColumns };

const char* const kTargetsKey = "export/targets";
const char* const kCheckKey = "export/check";
constexpr const char* kAlways = "kalibr";
// Most common targets: Kalibr's files, two VIO programs, robots, and the user's own programs.
constexpr std::array<std::string_view, 5> kCommon = {kAlways, "openvins", "vins-fusion", "ros", "opencv"};

bool hasName(const auto& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

QTreeWidgetItem* exportItemOf(const ExportTarget& target) {
  const bool always = target.name == std::string_view(kAlways);
  const QString program = QString::fromUtf8(target.program), files = QString::fromUtf8(target.files);
  const QString what = QObject::tr(target.use);
  const QString use = target.inertial_odometry ? QObject::tr("VIO - %1").arg(what) : what;
  auto* const item =
      new QTreeWidgetItem({always ? QObject::tr("%1 (always)").arg(program) : program, use, files});
  item->setData(kProgram, Qt::UserRole, QString(target.name));
  if (target.inertial_odometry) item->setForeground(kUse, theme().accent);
  for (int column = 0; column < kColumns; ++column) item->setToolTip(column, what + "\n" + files);
  item->setFlags(always ? Qt::ItemIsEnabled | Qt::ItemIsSelectable
                        : Qt::ItemIsEnabled | Qt::ItemIsSelectable | Qt::ItemIsUserCheckable);
  return item;
}

QPushButton* button(const QString& object_name, const QString& text, const QString& tip, QWidget* parent) {
  auto* const made = new QPushButton(text, parent);
  made->setObjectName(object_name);
  made->setToolTip(tip);
  made->setAutoDefault(false);
  return made;
}

}  // namespace

QString newResultFolder(const QString& recording, const QString& kind) {
  const QFileInfo info(recording);
  const QString beside = info.absolutePath();
  const QDir folder(QFileInfo(beside).isWritable() ? beside : QDir::homePath());
  const QString stem = info.isDir() ? info.fileName() : info.completeBaseName();
  const QString name = stem.isEmpty() ? kind : stem + "_" + kind;
  QString free = name;
  for (int number = 2; folder.exists(free); ++number) free = QString("%1_%2").arg(name).arg(number);
  return folder.filePath(free);
}

QString newExportFolder(const QString& recording) {
  return newResultFolder(recording, "calibration");
}

ExportRequest proposedExport(const Session& session) {
  const QSettings settings;
  ExportRequest request;
  request.folder = newExportFolder(QString::fromStdString(session.recording.string()));
  request.targets = session.exports;
  if (request.targets.empty())
    for (const QString& name : settings.value(kTargetsKey).toStringList())
      request.targets.push_back(name.toStdString());
  request.check = settings.value(kCheckKey, false).toBool();
  return request;
}

void rememberExport(const ExportRequest& request) {
  QStringList names;
  for (const std::string& name : request.targets) names << QString::fromStdString(name);
  QSettings settings;
  settings.setValue(kTargetsKey, names);
  settings.setValue(kCheckKey, request.check);
}

ExportDialog::ExportDialog(const ExportRequest& proposal, QWidget* parent)
    : QDialog(parent),
      folder_(new QLineEdit(QDir::toNativeSeparators(proposal.folder), this)),
      hint_(new QLabel(this)),
      targets_(new QTreeWidget(this)),
      check_(new QCheckBox(tr("&Read the files back as those programs do, and compare them with the result"),
                           this)) {
  setWindowTitle(tr("Export the result"));
  check_->setObjectName("check");
  check_->setChecked(proposal.check);
  check_->setToolTip(tr("Checks that each program accepts its files and reads the same values from them"));
  auto* const buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
  ok_ = buttons->button(QDialogButtonBox::Ok);
  ok_->setText(tr("&Export"));
  ok_->setToolTip(tr("Write all files to the folder"));
  buttons->button(QDialogButtonBox::Cancel)->setToolTip(tr("Close without writing"));
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  fillTargets(proposal.targets);
  auto* const what =
      new QLabel(tr("The result, its report and tables are always written. Additional files for:"), this);
  auto* const layout = new QVBoxLayout(this);
  layout->addWidget(makeFolderRow());
  layout->addWidget(hint_);
  layout->addSpacing(6);
  layout->addWidget(what);
  layout->addWidget(targets_, 1);
  layout->addWidget(makeSelectionRow());
  layout->addWidget(check_);
  layout->addWidget(buttons);
  constexpr int kAround_px = 60, kHeight_px = 600;  // margins and scroll bar
  resize(std::min(fitColumns() + kAround_px, screen()->availableGeometry().width()), kHeight_px);
  judgeFolder();
}

QWidget* ExportDialog::makeFolderRow() {
  auto* const row = new QWidget(this);
  auto* const layout = new QHBoxLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* const label = new QLabel(tr("&To the folder"), row);
  label->setBuddy(folder_);
  folder_->setObjectName("folder");
  folder_->setAccessibleName(tr("Folder to export to"));
  folder_->setToolTip(tr("Folder for the files; created if it does not exist"));
  hint_->setObjectName("folder_hint");
  hint_->setProperty("role", "hint");
  QPushButton* const choose = button("choose_folder", tr("&Choose..."), tr("Choose an existing folder"), row);
  connect(choose, &QPushButton::clicked, this, &ExportDialog::chooseFolder);
  connect(folder_, &QLineEdit::textChanged, this, &ExportDialog::judgeFolder);
  layout->addWidget(label);
  layout->addWidget(folder_, 1);
  layout->addWidget(choose);
  return row;
}

QWidget* ExportDialog::makeSelectionRow() {
  auto* const row = new QWidget(this);
  auto* const layout = new QHBoxLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  const auto add = [&](const char* name, const QString& text, const QString& tip, Selection selection) {
    QPushButton* const made = button(name, text, tip, row);
    connect(made, &QPushButton::clicked, this, [this, selection] { select(selection); });
    layout->addWidget(made);
  };
  add("select_all", tr("Select &all"),
      tr("Files for all programs; those that cannot represent this rig are listed with the reason"),
      Selection::All);
  add("select_odometry", tr("For &VIO"),
      tr("Files for programs that estimate motion from cameras and an IMU"), Selection::Odometry);
  add("select_none", tr("&None"), tr("Only the files that are always written"), Selection::None);
  layout->addStretch();
  return row;
}

void ExportDialog::fillTargets(const std::vector<std::string>& chosen) {
  targets_->setObjectName("targets");
  targets_->setAccessibleName(tr("Programs to write files for"));
  targets_->setColumnCount(kColumns);
  targets_->setHeaderLabels({tr("Program"), tr("For"), tr("Files")});
  targets_->setUniformRowHeights(true);
  targets_->ensurePolished();  // heights and widths are those of the style sheet
  targets_->setIndentation(12);
  auto* const more = new QTreeWidgetItem;
  for (const ExportTarget& target : exportTargets()) {
    items_.push_back(exportItemOf(target));
    hasName(kCommon, target.name) ? targets_->addTopLevelItem(items_.back()) : more->addChild(items_.back());
  }
  more->setText(kProgram, tr("More (%1)").arg(more->childCount()));
  more->setToolTip(kProgram, tr("Show the other programs"));
  targets_->addTopLevelItem(more);
  more->setFirstColumnSpanned(true);
  // A click anywhere on the line folds it, not only one on its arrow.
  targets_->setExpandsOnDoubleClick(false);
  connect(targets_, &QTreeWidget::itemClicked, this, [more](const QTreeWidgetItem* item) {
    if (item == more) more->setExpanded(!more->isExpanded());
  });
  checkTargets([&](const ExportTarget& target) { return hasName(chosen, target.name); });
}

int ExportDialog::fitColumns() {
  QTreeWidgetItem* const more = items_.back()->parent();
  const bool shown = more->isExpanded();
  more->setExpanded(true);  // widths are those of shown lines
  targets_->header()->setStretchLastSection(false);
  for (int column = 0; column < kColumns; ++column) targets_->resizeColumnToContents(column);
  more->setExpanded(shown);
  return targets_->header()->length();
}

void ExportDialog::checkTargets(const std::function<bool(const ExportTarget&)>& wanted) {
  for (std::size_t k = 0; k < items_.size(); ++k) {
    const ExportTarget& target = exportTargets()[k];
    const bool checked = wanted(target) || target.name == std::string_view(kAlways);
    items_[k]->setCheckState(kProgram, checked ? Qt::Checked : Qt::Unchecked);
    if (checked && items_[k]->parent()) items_[k]->parent()->setExpanded(true);
  }
}

void ExportDialog::select(Selection selection) {
  checkTargets([selection](const ExportTarget& target) {
    return selection == Selection::All || (selection == Selection::Odometry && target.inertial_odometry);
  });
}

void ExportDialog::chooseFolder() {
  const QString start = QFileInfo(folder_->text()).absolutePath();
  const QString folder = QFileDialog::getExistingDirectory(this, tr("Export the result to a folder"), start);
  if (!folder.isEmpty()) folder_->setText(QDir::toNativeSeparators(folder));
}

void ExportDialog::judgeFolder() {
  const QString text = folder_->text().trimmed();
  const QFileInfo info(text);
  const bool usable = !text.isEmpty() && info.isAbsolute() && (!info.exists() || info.isDir());
  ok_->setEnabled(usable);
  if (text.isEmpty()) return hint_->setText(tr("Enter a folder."));
  if (!info.isAbsolute()) return hint_->setText(tr("Enter the folder's absolute path, or choose it."));
  if (info.exists() && !info.isDir()) return hint_->setText(tr("This is a file. Enter a folder."));
  const bool has_files = info.exists() && !QDir(text).isEmpty();
  hint_->setText(has_files       ? tr("This folder contains files. Files with the same names are replaced.")
                 : info.exists() ? tr("This folder exists and is empty.")
                                 : tr("A new folder will be created."));
}

ExportRequest ExportDialog::request() const {
  ExportRequest request{QDir::fromNativeSeparators(folder_->text().trimmed()), {}, check_->isChecked()};
  for (std::size_t k = 0; k < items_.size(); ++k)
    if (items_[k]->checkState(kProgram) == Qt::Checked) request.targets.emplace_back(exportTargets()[k].name);
  return request;
}

}  // namespace evical::ui
