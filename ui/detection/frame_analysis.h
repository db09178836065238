// SPDX-License-Identifier: GPL-3.0-or-later
// Analysis of one frame with the tracker of a run (core/frames/frame_tracker.h) and the frames around it. A
// pure function of its inputs, for a worker thread.
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
  std::int64_t start_ns = 0;  // start of the recording
  std::size_t frame = 0;      // index in the cache
  std::size_t frames_read = 0;
  std::size_t frames_before = 2;  // number of processed frames from which the board is tracked to this one
  std::string camera;
  Board board;
  FrameOptions options;

  bool operator==(const FrameQuestion&) const = default;
};

// A run tracks the board through the recording. Here, some frames before this one are used, and the one after
// it, which gives the board's speed.
WindowAnalysis analyseFrame(const FrameQuestion& question);

// True if tracking from further back may find more of the board.
bool goesFurther(const WindowAnalysis& analysis);

std::vector<StageReport> describeFrame(const WindowAnalysis& analysis, const FrameOptions& options);

// The image as finders use it.
QImage pictureOf(const GrayImage& image);

}  // namespace evical::ui
