// SPDX-License-Identifier: GPL-3.0-or-later
// Thumbnails of windows for a list: made in a thread, for the most recently requested rows, from the caches
// of Detection. Their number is limited.
#pragma once

#include "core/data/board_observations.h"
#include "core/geometry/resolution.h"
#include "ui/detection/event_cache.h"
#include "ui/detection/frame_cache.h"
#include "ui/detection/surface_frame.h"
#include "ui/jobs/latest_job.h"

#include <QCache>
#include <QImage>
#include <QObject>
#include <QPixmap>
#include <QSize>

#include <memory>
#include <vector>

namespace evical::ui {

// A camera's events or frames, in the part that has been read.
struct PictureSource {
  CameraKind kind = CameraKind::Events;
  std::shared_ptr<const EventCache> events;
  std::shared_ptr<const FrameCache> frames;
  std::int64_t start_ns = 0;
  Resolution resolution_px;

  bool operator==(const PictureSource&) const = default;
};

struct PictureWish {
  int row = 0;
  double time_s = 0.0, half_width_s = 0.0;  // of the window
};

// Events by number and polarity, or the nearest frame; null if they are not yet read. Throws
// CalibrationError if they are unreadable.
QImage pictureOfWindow(const PictureSource& source, const PictureWish& wish, const SurfaceStyle& style,
                       const QSize& max_px);

class WindowPictures : public QObject {
  Q_OBJECT

 public:
  static constexpr int kMaxKept = 200;

  explicit WindowPictures(QObject* parent = nullptr);

  // A new source discards all pictures; `size_px` in device pixels.
  void setSource(const PictureSource& source, const SurfaceStyle& style, const QSize& size_px,
                 double pixel_ratio);
  void forget();  // the rows have changed
  // Requests the visible rows, the first ones first; pending earlier requests are dropped.
  void want(std::vector<PictureWish> wishes);

  const QPixmap* of(int row) const { return made_.object(row); }  // null: not ready
  int count() const { return static_cast<int>(made_.count()); }

 signals:
  void made(int row);

 private:
  struct Made {
    int row;
    QImage image;
  };
  void makeNext();
  void take(const std::vector<Made>& made);

  PictureSource source_;
  SurfaceStyle style_;
  QSize size_px_;
  double pixel_ratio_ = 1.0;
  std::vector<PictureWish> wishes_;
  QCache<int, QPixmap> made_{kMaxKept};
  LatestJob job_{OutdatedWork::Dropped};  // last member: its thread uses nothing of this object
};

}  // namespace evical::ui
