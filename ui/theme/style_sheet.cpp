// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/theme/style_sheet.h"

namespace evical::ui {
namespace {

// No rules for spin boxes and combo boxes: with any rule they lose their arrows.
const char* const kRules = R"(
QToolTip { color: @text; background: @panel; border: 1px solid @line; padding: 4px 6px; }
QToolBar { border: none; border-bottom: 1px solid @line; padding: 4px 8px; spacing: 4px; }
QToolBar::separator { background: @line; width: 1px; margin: 5px 6px; }
QToolButton { border: 1px solid transparent; border-radius: 6px; padding: 5px 8px; }
QToolButton:hover { background: @hover; }
QToolButton:pressed, QToolButton:checked { background: @selected; }
QToolButton[primary="true"] { background: @accent; color: @on_accent; padding: 6px 14px; font-weight: 600; }
QToolButton[primary="true"]:hover { background: @accent_hover; }
QToolButton[primary="true"]:disabled { background: @line; color: @faint; }
QToolButton#cancel { padding: 6px 14px; font-weight: 600; }
QToolButton[popupMode="2"] { padding-right: 22px; }
QToolButton::menu-indicator { subcontrol-origin: padding; subcontrol-position: right center; right: 7px; }
QPushButton::menu-indicator { subcontrol-origin: padding; subcontrol-position: right center; right: 4px; }
QWidget#sidebar { border-right: 1px solid @line; }
QPushButton { border: 1px solid @border; border-radius: 6px; padding: 6px 14px; background: @panel; }
QPushButton:hover { border-color: @accent; }
QPushButton:pressed, QPushButton:checked { background: @selected; }
QPushButton:disabled { border-color: @line; background: transparent; }
QPushButton[primary="true"] { background: @accent; border-color: @accent; color: @on_accent; }
QPushButton[primary="true"]:disabled { background: @line; border-color: @line; color: @faint; }
QFrame[card="true"] { background: @card; border: 1px solid @line; border-radius: 8px; }
QFrame[card="bad"] { background: @card; border: 1px solid @bad; border-radius: 8px; }
QLabel[role="title"] { font-size: 17pt; font-weight: 600; }
QLabel[role="heading"] { font-size: 11pt; font-weight: 600; }
QLabel[role="hint"] { color: @faint; }
QLabel[role="problem"] { color: @bad; }
QListView, QTreeView, QTableView, QPlainTextEdit, QTextBrowser { border: 1px solid @line; border-radius: 6px; }
QListView::item, QTreeView::item { padding: 3px; }
QTableView::item { padding: 0 8px; }
QHeaderView::section { background: @window; border: none; border-bottom: 1px solid @line; padding: 5px 6px; }
QTreeView QHeaderView::section { padding: 5px 3px; }
QListView#navigation { border: none; border-radius: 0; background: @window; padding: 6px; }
QListView#navigation::item { border-radius: 6px; padding: 0 6px; margin: 1px 0; }
QListView#navigation::item:hover { background: @hover; }
QListView#navigation::item:selected { background: @selected; color: @text; }
QDockWidget::title { background: @window; border-bottom: 1px solid @line; padding: 7px 8px; }
QMainWindow::separator { background: @line; width: 1px; height: 1px; margin: 2px; }
QTabBar::tab { border: none; border-bottom: 2px solid transparent; padding: 8px 12px; color: @faint; }
QTabBar::tab:selected { color: @text; border-bottom-color: @accent; }
QTabWidget::pane { border: none; border-top: 1px solid @line; }
QGroupBox { font-weight: 600; border: none; margin-top: 22px; }
QGroupBox::title { subcontrol-origin: margin; left: 0; }
QProgressBar { border: none; border-radius: 4px; background: @line; max-height: 8px; }
QProgressBar::chunk { border-radius: 4px; background: @accent; }
QStatusBar { border-top: 1px solid @line; }
QStatusBar::item { border: none; }
QScrollBar:vertical { width: 11px; background: transparent; }
QScrollBar:horizontal { height: 11px; background: transparent; }
QScrollBar::handle { background: @border; border-radius: 3px; margin: 2px; min-height: 24px; min-width: 24px; }
QScrollBar::handle:hover { background: @faint; }
QScrollBar::add-line, QScrollBar::sub-line { width: 0; height: 0; }
QScrollBar::add-page, QScrollBar::sub-page { background: transparent; }
)";

}  // namespace

QString styleSheetOf(const Theme& t) {
  constexpr double kHover = 0.08, kSelected = 0.2, kBorder = 0.35, kRaised = 0.03;
  QString rules = kRules;
  rules.replace("@text", t.text.name());
  rules.replace("@faint", t.faint_text.name());
  // In dark themes, Fusion's fields have no visible outline: they are darker than the lighter ground.
  rules.replace("@card", t.dark ? mixed(t.window, t.text, kRaised).name() : t.panel.name());
  rules.replace("@panel", t.panel.name());
  rules.replace("@window", t.window.name());
  rules.replace("@line", t.grid_line.name());
  rules.replace("@on_accent", t.dark ? "#101317" : "#ffffff");
  rules.replace("@accent_hover", mixed(t.accent, t.text, kHover).name());
  rules.replace("@accent", t.accent.name());
  rules.replace("@bad", t.bad.name());
  rules.replace("@hover", mixed(t.window, t.text, kHover).name());
  rules.replace("@selected", mixed(t.window, t.accent, kSelected).name());
  rules.replace("@border", mixed(t.window, t.faint_text, kBorder).name());
  return rules;
}

}  // namespace evical::ui
