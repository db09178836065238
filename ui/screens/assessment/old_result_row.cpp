// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/old_result_row.h"

#include "ui/theme/theme.h"

#include <QMenu>

namespace evical::ui {

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
