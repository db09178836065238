// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/export_dialog.h"

#include "core/report/export/export_target.h"

#include <QDialogButtonBox>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QVBoxLayout>

#include <algorithm>

namespace evical::ui {

ExportDialog::ExportDialog(const std::vector<std::string>& chosen, QWidget* parent)
    : QDialog(parent), list_(new QListWidget(this)) {
  setWindowTitle(tr("Export the result"));
  list_->setObjectName("targets");
  for (const ExportTarget& target : exportTargets()) {
    const std::string name = target.name;
    const bool always = name == "kalibr";
    const QString text = QString::fromUtf8(target.description);
    auto* const item = new QListWidgetItem(always ? tr("%1 (always)").arg(text) : text, list_);
    item->setData(Qt::UserRole, QString::fromStdString(name));
    const bool checked = always || std::find(chosen.begin(), chosen.end(), name) != chosen.end();
    item->setFlags(always ? Qt::ItemIsUserCheckable : Qt::ItemIsEnabled | Qt::ItemIsUserCheckable);
    item->setCheckState(checked ? Qt::Checked : Qt::Unchecked);
  }
  const int frame_px = 2 * list_->frameWidth();
  constexpr int kMargins_px = 24;  // the style sheet's, which no hint counts
  list_->setMinimumSize(list_->sizeHintForColumn(0) + frame_px + kMargins_px,
                        list_->count() * list_->sizeHintForRow(0) + frame_px + kMargins_px);
  auto* const buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
  buttons->button(QDialogButtonBox::Ok)->setText(tr("&Choose a folder..."));
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* const layout = new QVBoxLayout(this);
  layout->addWidget(new QLabel(tr("Besides the result itself, write files for:"), this));
  layout->addWidget(list_);
  layout->addWidget(buttons);
}

std::vector<std::string> ExportDialog::chosen() const {
  std::vector<std::string> names;
  for (int row = 0; row < list_->count(); ++row)
    if (list_->item(row)->checkState() == Qt::Checked)
      names.push_back(list_->item(row)->data(Qt::UserRole).toString().toStdString());
  return names;
}

}  // namespace evical::ui
