// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/path_row.h"

#include "ui/theme/theme.h"

#include <QDir>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QPushButton>

namespace evical::ui {

PathRow::PathRow(const QString& object_name, const QString& title, const QString& tip, QGridLayout& grid,
                 QWidget* parent)
    : QObject(parent),
      field_(new QLineEdit(parent)),
      choose_(new QPushButton(tr("Choose..."), parent)),
      tip_(tip) {
  const QString name = QString(title).remove('&');
  auto* const label = new QLabel(title, parent);
  label->setBuddy(field_);
  field_->setObjectName(object_name);
  field_->setAccessibleName(name);
  field_->setToolTip(tip);
  field_->setClearButtonEnabled(true);
  choose_->setObjectName("choose_" + object_name);
  choose_->setAccessibleName(tr("Choose: %1").arg(name));
  choose_->setToolTip(tip);
  const int row = grid.rowCount();
  grid.addWidget(label, row, 0);
  grid.addWidget(field_, row, 1);
  grid.addWidget(choose_, row, 2);
  connect(choose_, &QPushButton::clicked, this, &PathRow::chooseRequested);
  connect(field_, &QLineEdit::textEdited, this, [this] {
    by_hand_ = true;
    field_->setToolTip(tip_);
  });
  connect(field_, &QLineEdit::textChanged, this, &PathRow::changed);
}

QString PathRow::path() const {
  const QString text = field_->text();
  return text == shownAs(path_) ? path_ : QDir::fromNativeSeparators(text.trimmed());
}

QString PathRow::shownAs(const QString& path) const {
  const auto found = titles_.find(path);
  return found == titles_.end() ? QDir::toNativeSeparators(path) : found->second;
}

void PathRow::show(const QString& path) {
  path_ = path;
  const QString native = QDir::toNativeSeparators(path), shown = shownAs(path);
  field_->setText(shown);
  field_->setToolTip(shown == native ? tip_ : native + '\n' + tip_);
}

void PathRow::setTitles(const std::map<QString, QString>& titles) {
  const bool typed = path() != path_;
  titles_ = titles;
  if (!typed) show(path_);
}

void PathRow::setPath(const QString& path) {
  by_hand_ = true;
  show(path);
}

void PathRow::proposePath(const QString& path) {
  if (!by_hand_ || field_->text().isEmpty()) show(path);
}

void PathRow::setMenu(QMenu* menu) {
  choose_->setMenu(menu);
}

void PathRow::setPlaceholder(const QString& text) {
  field_->setPlaceholderText(text);
}

void PathRow::setEnabled(bool enabled) {
  field_->setEnabled(enabled);
  choose_->setEnabled(enabled);
}

OldResultRow::OldResultRow(const QString& object_name, QGridLayout& grid, QWidget* parent)
    : PathRow(object_name, tr("&Old result"),
              tr("A folder written by a calibration or an export, or its result.yaml"), grid, parent),
      menu_(new QMenu(parent)) {
  setMenu(menu_);
  setKeptRuns({});
}

void OldResultRow::setKeptRuns(const std::vector<std::pair<QString, QString>>& runs) {
  std::map<QString, QString> titles;
  for (const auto& [title, folder] : runs) titles[folder] = title;
  setTitles(titles);
  menu_->clear();
  menu_->addAction(icon("folder"), tr("A result's &folder..."), this, &OldResultRow::folderRequested);
  menu_->addAction(icon("open"), tr("A &result.yaml..."), this, &OldResultRow::fileRequested);
  if (!runs.empty()) menu_->addSection(tr("Runs of this session"));
  for (const auto& [title, folder] : runs)
    menu_->addAction(title, this, [this, chosen = folder] { setPath(chosen); });
}

}  // namespace evical::ui
