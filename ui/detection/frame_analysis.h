// SPDX-License-Identifier: GPL-3.0-or-later
// What becomes of one frame: the tracker's own answer (core/frames/frame_tracker.h), given the frames around it. A pure
// function of its inputs, for a worker thread.
#pragma once

#include "core/frames/frame_options.h"
#include "core/frames/gray_image.h"
#include "ui/detection/frame_cache.h"
#include "ui/detection/window_analysis.h"

#include <QImage>

#include <memory>
#include <string>

namespace evical::ui {

struct FrameQuestion {
  std::shared_ptr<const FrameCache> frames;
  std::int64_t start_ns = 0;  // the recording's
  std::size_t frame = 0;      // in the cache
  std::size_t frames_read = 0;
  std::size_t frames_before =
      2;  // from which the board is followed to this one, of those that a run would look at
  std::string camera;
  Board board;
  FrameOptions options;

  bool operator==(const FrameQuestion&) const = default;
};

// A run follows the board through the recording; here some frames before this one do, and the one after it tells with
// them how fast the board moves.
WindowAnalysis analyseFrame(const FrameQuestion& question);

// Whether a board that is followed from further away may show more.
bool goesFurther(const WindowAnalysis& analysis);

std::vector<StageReport> describeFrame(const WindowAnalysis& analysis, const FrameOptions& options);

// As finders see it.
QImage pictureOf(const GrayImage& image);

}  // namespace evical::ui
