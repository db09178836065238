// SPDX-License-Identifier: GPL-3.0-or-later
// Files that another program is still writing: looks at their size once a second, says when there is enough more to look
// through, and when the end has come. Looking through is somebody else's, who says when it begins and ends.
#pragma once

#include "ui/jobs/latest_job.h"

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace evical::ui {

// Of files, and of all that is in folders; what is not there has none.
std::uintmax_t bytesOf(const std::vector<std::filesystem::path>& files);

class GrowingRecording : public QObject {
  Q_OBJECT

 public:
  explicit GrowingRecording(QObject* parent = nullptr);

  // Other ones than before end the following.
  void setFiles(const std::vector<std::filesystem::path>& files);
  void setFollowing(bool following);
  bool following() const { return following_; }
  // They have grown since they were set.
  bool grown() const { return grown_; }
  // They were followed to their end.
  bool followedToEnd() const { return followed_to_end_; }

  void lookBegan();
  void lookEnded();

 signals:
  void growthNoticed();  // they are larger than when they were set
  void followingChanged(bool following);
  void lookWanted();
  void endReached();  // for a while nothing has come, and the last look has seen all

 private:
  void poll();
  void take(std::uintmax_t size);

  std::vector<std::filesystem::path> files_;
  std::uintmax_t opened_size_ = 0, size_ = 0, seen_size_ = 0;
  bool known_ = false, grown_ = false, following_ = false, followed_to_end_ = false, looking_ = false;
  QElapsedTimer since_growth_, since_look_;
  QTimer timer_;
  LatestJob size_job_{OutdatedWork::Dropped};  // file systems may let one wait
};

}  // namespace evical::ui
