// SPDX-License-Identifier: GPL-3.0-or-later
// Files that a page works on together: chosen by a dialog that whoever listens opens, dropped, or taken off again.
#pragma once

#include <QStringList>
#include <QWidget>

class QListWidget;
class QPushButton;
class QVBoxLayout;

namespace evical::ui {

class FileList : public QWidget {
  Q_OBJECT

 public:
  // `things` is in the names of list and buttons: "recordings" makes list_recordings, add_recordings, remove_recordings.
  FileList(const QString& things, const QString& title, const QString& tip, QWidget* parent = nullptr);

  QStringList files() const;
  void add(const QStringList& files);      // those that are not listed yet
  void insertButton(QPushButton* button);  // below Add

 signals:
  void changed();
  void addRequested();

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  void removeChosen();
  void offer();

  QListWidget* list_;
  QPushButton* remove_;
  QVBoxLayout* buttons_;
};

}  // namespace evical::ui
