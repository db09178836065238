// Common interface of the finders of different boards.
#pragma once

#include "core/frames/board_finder.h"
#include "core/frames/found_point.h"
#include "core/frames/frame_options.h"
#include "core/frames/gray_image.h"
#include "core/frames/plane_map.h"
#include "core/geometry/board.h"

#include <memory>
#include <string>

namespace evical {

class PatternFinder {
 public:
  PatternFinder() = default;
  PatternFinder(const PatternFinder&) = delete;
  PatternFinder& operator=(const PatternFinder&) = delete;
  virtual ~PatternFinder() = default;

  virtual FoundPoints search(const GrayImage& image) = 0;
  virtual FoundPoints measure(const GrayImage& image, const PlaneMap& map, double gate_px) const = 0;
  virtual bool renumbered() { return false; }
  virtual std::string doubt() const { return {}; }
  virtual std::string remark() const { return {}; }
};

std::unique_ptr<PatternFinder> makeCheckerboardFinder(const Board& board, const FrameOptions& options,
                                                      CheckerboardParts parts);
std::unique_ptr<PatternFinder> makeTagGridFinder(const Board& board, const FrameOptions& options);
std::unique_ptr<PatternFinder> makeCharucoFinder(const Board& board, const FrameOptions& options);
std::unique_ptr<PatternFinder> makeCircleFinder(const Board& board, const FrameOptions& options);

// The map from detected points; empty if there are too few.
std::optional<PlaneMap> mapOf(const FoundPoints& points, const Board& board);

}  // namespace evical
