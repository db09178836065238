// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/window_pictures.h"

#include "core/base/error.h"
#include "core/base/in_parallel.h"
#include "core/base/time.h"
#include "core/frames/gray_image.h"
#include "ui/detection/frame_analysis.h"

#include <algorithm>
#include <utility>

namespace evical::ui {
namespace {

constexpr std::size_t kAtOnce = 6;             // then they are shown, and requests may change
constexpr std::int64_t kSlice_ns = 2'000'000;  // span of a window's events in memory at once
constexpr std::int64_t kRounding_ns = 1000;    // error of times in seconds
constexpr double kStrongShare = 0.5;  // number of events for half the colour, relative to the usual one

struct Cell {
  int brighter = 0, darker = 0;
  int sum() const { return brighter + darker; }
};

QSize fitted(Resolution sensor_px, const QSize& max_px) {
  return QSize(sensor_px.width_px, sensor_px.height_px)
      .scaled(max_px, Qt::KeepAspectRatio)
      .expandedTo({1, 1});
}

int mixed(int from, int to, double share) {
  return static_cast<int>(from + share * (to - from));
}

QRgb pictureColour(const Cell& cell, double usual, const SurfaceStyle& style) {
  const double brighter = static_cast<double>(cell.brighter) / cell.sum();
  const double strength = cell.sum() / (cell.sum() + kStrongShare * usual);
  const auto channel = [&](int (*of)(QRgb)) {
    return mixed(of(style.background), mixed(of(style.darker), of(style.brighter), brighter), strength);
  };
  return qRgb(channel(qRed), channel(qGreen), channel(qBlue));
}

QImage painted(const std::vector<Cell>& cells, const QSize& size_px, const SurfaceStyle& style) {
  QImage image(size_px, QImage::Format_RGB32);
  image.fill(style.background);
  double sum = 0.0, covered = 0.0;
  for (const Cell& cell : cells) {
    sum += cell.sum();
    covered += cell.sum() > 0 ? 1.0 : 0.0;
  }
  const double usual = sum / std::max(covered, 1.0);
  auto cell = cells.begin();
  for (int y = 0; y < size_px.height(); ++y) {
    auto* const line = reinterpret_cast<QRgb*>(image.scanLine(y));
    for (int x = 0; x < size_px.width(); ++x, ++cell)
      if (cell->sum() > 0) line[x] = pictureColour(*cell, usual, style);
  }
  return image;
}

QImage pictureOfEvents(const PictureSource& source, const PictureWish& wish, const SurfaceStyle& style,
                       const QSize& max_px) {
  const std::int64_t end_ns = source.start_ns + nanosecondsFrom(wish.time_s + wish.half_width_s);
  if (!source.events || !source.resolution_px.known() || source.events->completeUntil_ns() < end_ns)
    return {};
  const QSize size_px = fitted(source.resolution_px, max_px);
  std::vector<Cell> cells(static_cast<std::size_t>(size_px.width()) *
                          static_cast<std::size_t>(size_px.height()));
  std::vector<Event> events;
  std::int64_t begin_ns = source.start_ns + nanosecondsFrom(wish.time_s - wish.half_width_s);
  for (; begin_ns < end_ns; begin_ns += kSlice_ns) {
    events.clear();
    source.events->gather(begin_ns, std::min(begin_ns + kSlice_ns, end_ns), events);
    for (const Event& event : events) {
      const int x = event.x_px * size_px.width() / source.resolution_px.width_px;
      const int y = event.y_px * size_px.height() / source.resolution_px.height_px;
      Cell& cell = cells[static_cast<std::size_t>(y * size_px.width() + x)];
      ++(event.brighter ? cell.brighter : cell.darker);
    }
  }
  return painted(cells, size_px, style);
}

QImage pictureOfFrame(const PictureSource& source, const PictureWish& wish, const SurfaceStyle& style,
                      const QSize& max_px) {
  if (!source.frames) return {};
  const std::int64_t time_ns = source.start_ns + nanosecondsFrom(wish.time_s);
  const auto last_ns = source.frames->lastTime_ns();
  if (!last_ns || *last_ns + kRounding_ns < time_ns) return {};
  try {
    const QImage whole =
        pictureOf(decodeFrame(source.frames->frame(*source.frames->nearest(time_ns)), "frame"));
    return whole.scaled(max_px, Qt::KeepAspectRatio, Qt::SmoothTransformation);
  } catch (const CalibrationError&) {
    return emptyImage({max_px.width(), max_px.height()}, style);  // the list reports that it is unreadable
  }
}

}  // namespace

QImage pictureOfWindow(const PictureSource& source, const PictureWish& wish, const SurfaceStyle& style,
                       const QSize& max_px) {
  return source.kind == CameraKind::Frames ? pictureOfFrame(source, wish, style, max_px)
                                           : pictureOfEvents(source, wish, style, max_px);
}

WindowPictures::WindowPictures(QObject* parent) : QObject(parent) {}

void WindowPictures::setSource(const PictureSource& source, const SurfaceStyle& style, const QSize& size_px,
                               double pixel_ratio) {
  if (source == source_ && style == style_ && size_px == size_px_ && pixel_ratio == pixel_ratio_) return;
  source_ = source;
  style_ = style;
  size_px_ = size_px;
  pixel_ratio_ = pixel_ratio;
  forget();
}

void WindowPictures::forget() {
  job_.discard();
  wishes_.clear();
  made_.clear();
}

void WindowPictures::want(std::vector<PictureWish> wishes) {
  wishes_ = std::move(wishes);
  std::erase_if(wishes_, [this](const PictureWish& wish) { return made_.object(wish.row) != nullptr; });
  if (!job_.busy()) makeNext();
}

void WindowPictures::makeNext() {
  if (wishes_.empty() || size_px_.isEmpty()) return;
  const std::vector<PictureWish> now(wishes_.begin(),
                                     wishes_.begin() + static_cast<long>(std::min(kAtOnce, wishes_.size())));
  wishes_.erase(wishes_.begin(), wishes_.begin() + static_cast<long>(now.size()));
  job_.start([this, now, source = source_, style = style_, size_px = size_px_](const std::stop_token& stop) {
    makeThreadModest();
    std::vector<Made> made;
    for (const PictureWish& wish : now) {
      if (stop.stop_requested()) break;
      try {
        made.push_back({wish.row, pictureOfWindow(source, wish, style, size_px)});
      } catch (const CalibrationError&) {
        break;  // the cache is unreadable, which the main picture's reader reports
      }
    }
    return [this, made = std::move(made)] { take(made); };
  });
}

void WindowPictures::take(const std::vector<Made>& made) {
  for (const Made& each : made) {
    if (each.image.isNull()) continue;
    auto pixmap = std::make_unique<QPixmap>(QPixmap::fromImage(each.image));
    pixmap->setDevicePixelRatio(pixel_ratio_);
    made_.insert(each.row, pixmap.release());
    emit this->made(each.row);
  }
  makeNext();
}

}  // namespace evical::ui
