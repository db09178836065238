// SPDX-License-Identifier: GPL-3.0-or-later
// Files that another program is still writing: checks their size once a second, signals when there is enough
// new data for a check, and when the end is reached. The check itself is done elsewhere, which reports its
// start and end.
#pragma once

#include "ui/jobs/latest_job.h"

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace evical::ui {

// Total size of files and of all files in folders; 0 for missing ones.
std::uintmax_t bytesOf(const std::vector<std::filesystem::path>& files);

class GrowingRecording : public QObject {
  Q_OBJECT

 public:
  explicit GrowingRecording(QObject* parent = nullptr);

  // A change of files ends the following.
  void setFiles(const std::vector<std::filesystem::path>& files);
  void setFollowing(bool following);
  bool following() const { return following_; }
  // They have grown since setFiles().
  bool grown() const { return grown_; }
  // They were followed to their end.
  bool followedToEnd() const { return followed_to_end_; }

  void lookBegan();
  void lookEnded();

 signals:
  void growthNoticed();  // larger than at setFiles()
  void followingChanged(bool following);
  void lookWanted();
  void endReached();  // no growth for a while, and the last check has covered everything

 private:
  void poll();
  void take(std::uintmax_t size);

  std::vector<std::filesystem::path> files_;
  std::uintmax_t opened_size_ = 0, size_ = 0, seen_size_ = 0;
  bool known_ = false, grown_ = false, following_ = false, followed_to_end_ = false, looking_ = false;
  QElapsedTimer since_growth_, since_look_;
  QTimer timer_;
  LatestJob size_job_{OutdatedWork::Dropped};  // file systems may block
};

}  // namespace evical::ui
