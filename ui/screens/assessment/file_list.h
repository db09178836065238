// SPDX-License-Identifier: GPL-3.0-or-later
// List of files that a page compares. They are dropped, removed, or chosen in a dialog that the receiver
// opens.
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
  // `things` is part of the object names: "recordings" makes list_recordings, add_recordings,
  // remove_recordings.
  FileList(const QString& things, const QString& title, const QString& tip, QWidget* parent = nullptr);

  QStringList files() const;
  void add(const QStringList& files);      // skips files that are listed already
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
