// SPDX-License-Identifier: GPL-3.0-or-later
// Side bar: the pages under two headings, and the steps of a calibration. Pages without content are grey; one
// line, and their tool tips, give the reason. Otherwise the line has the recording's name. The second heading
// can be folded.
#pragma once

#include "ui/window/pages.h"

#include "core/data/calibration_status.h"

#include <QFrame>
#include <QStackedWidget>

#include <optional>
#include <utility>
#include <vector>

class QListWidget;
class QListWidgetItem;

namespace evical::ui {

class SideBar : public QFrame {
  Q_OBJECT

 public:
  // `below`: what is shown below the pages.
  SideBar(const std::vector<PageEntry>& pages, QWidget* below, QWidget* parent);

  void showPage(int page);
  // The reason why each page is grey; empty: it is not. The line has the first one, or else the recording.
  void setReasons(const std::vector<QString>& reasons, const QString& recording);
  // Mark next to a page's name, by colour and shape: it shows the outcome while other pages are shown.
  void setVerdict(int page, std::optional<CalibrationStatus> status);

 signals:
  void pageChosen(int page);
  void pageClicked();  // by mouse; the list's arrow keys select the next page

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void addPages();
  void addPage(std::size_t page);
  QListWidgetItem* addHeading(const QString& text);
  void foldMore(bool folded);
  void fitHeight();
  void colourHeadings();

  std::vector<PageEntry> pages_;
  QListWidget* list_;
  std::vector<QListWidgetItem*> items_;  // of each page
  std::vector<QListWidgetItem*> headings_;
  QListWidgetItem* reason_ = nullptr;
  QListWidgetItem* more_ = nullptr;
  bool folded_ = false;
  std::optional<std::pair<int, std::optional<CalibrationStatus>>> verdict_;  // last one set
};

// The pages of a window. Its size is independent of their contents (the parent sets the minimum): otherwise
// every change of size in the window would trigger a layout of the wrapped texts of all pages, hidden or not,
// which took half of a run's computing time.
class PageStack final : public QStackedWidget {
 public:
  using QStackedWidget::QStackedWidget;
  bool hasHeightForWidth() const override { return false; }
  QSize sizeHint() const override { return minimumSize(); }
  QSize minimumSizeHint() const override { return minimumSize(); }
};

}  // namespace evical::ui
