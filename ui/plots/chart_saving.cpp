// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/plots/chart_saving.h"

#include "ui/jobs/file_saver.h"
#include "ui/plots/plot_panel.h"
#include "ui/theme/theme.h"

#include <QMenu>
#include <QRegularExpression>
#include <QToolButton>

#include <algorithm>

namespace evical::ui {
namespace {

// "Measured - predicted" gives "measured_predicted".
QString fileName(const QString& title) {
  static const QRegularExpression others("[^a-z0-9]+");
  const QString name = title.toLower().replace(others, "_");
  return name.isEmpty() ? QString("chart") : name;
}

std::vector<PlotPanel*> shownPanels(const QWidget& page) {
  std::vector<PlotPanel*> panels;
  for (PlotPanel* const panel : page.findChildren<PlotPanel*>())
    if (panel->isVisibleTo(&page)) panels.push_back(panel);
  return panels;
}

void fill(QMenu& menu, QWidget& page, const QString& name, FileSaver& saver) {
  menu.clear();
  const std::vector<PlotPanel*> panels = shownPanels(page);
  if (panels.empty()) {
    menu.addAction(QObject::tr("No chart to save"))->setEnabled(false);
    return;
  }
  menu.addAction(QObject::tr("&All charts as one picture..."), &saver, [panels, &page, name, &saver] {
    saver.askAndSave(QObject::tr("Save the charts"), name, PlotPanel::pictureForms(panels, page));
  });
  menu.addSeparator();
  for (PlotPanel* const panel : panels) addSaveActions(*menu.addMenu(panel->title()), *panel, saver);
}

}  // namespace

void addSaveActions(QMenu& menu, PlotPanel& panel, FileSaver& saver) {
  const auto save = [&panel, &saver](bool table) {
    std::vector<SavedForm> forms = panel.savedForms();
    std::erase_if(forms, [table](const SavedForm& form) { return (form.suffix == "csv") != table; });
    saver.askAndSave(table ? QObject::tr("Save the data") : QObject::tr("Save the picture"),
                     fileName(panel.title()), forms);
  };
  menu.addAction(QObject::tr("Save &picture (PNG, SVG, PDF)..."), &panel, [save] { save(false); });
  menu.addAction(QObject::tr("Save &data (CSV)..."), &panel, [save] { save(true); });
}

QToolButton* makeSaveButton(QWidget& page, const QString& name) {
  auto* const button = new QToolButton(&page);
  button->setObjectName("save_charts");
  button->setText(QObject::tr("Save"));
  button->setIcon(icon("save"));
  button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  button->setPopupMode(QToolButton::InstantPopup);
  button->setFocusPolicy(Qt::StrongFocus);
  button->setAccessibleName(QObject::tr("Save charts"));
  button->setToolTip(QObject::tr("Save the charts as pictures (PNG, SVG, PDF), their data as tables (CSV)"));
  auto* const menu = new QMenu(button);
  auto* const saver = new FileSaver(button);
  QObject::connect(menu, &QMenu::aboutToShow, button,
                   [menu, &page, name, saver] { fill(*menu, page, name, *saver); });
  button->setMenu(menu);
  return button;
}

}  // namespace evical::ui
