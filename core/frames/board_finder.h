// Detection of the board in a picture, without knowledge of the lens and of other pictures.
//
// Corners are measured as crossing points of edges, circles as ellipses fitted to their edges. An ellipse's
// centre, in the sensor's own pixels, is correct for a lens without distortion (circle_conic.h); distortion
// changes the ellipse, by some thousandths of a pixel for small circles.
//
// Point 0 of a checkerboard is the corner with a dark square before it, towards -x -y. If rows and columns
// are both even or both odd, both ends or none have one, and either may be point 0, as with symmetric
// circles.
#pragma once

#include "core/frames/frame_options.h"
#include "core/frames/gray_image.h"
#include "core/frames/plane_map.h"

#include "core/geometry/board.h"

#include <memory>
#include <string>

namespace evical {

class PatternFinder;

// Use of parts of a checkerboard. A part does not determine its place on the board. Any place is acceptable
// if only the lens is calibrated: points are then numbered from the board's beginning.
enum class CheckerboardParts { None, Any };

class BoardFinder {
 public:
  // Throws CalibrationError (BadInput) if the board is invalid.
  BoardFinder(const Board& board, const FrameOptions& options,
              CheckerboardParts parts = CheckerboardParts::None);
  ~BoardFinder();
  BoardFinder(BoardFinder&&) noexcept;
  BoardFinder& operator=(BoardFinder&&) noexcept;

  // Detected points, all or a part of them; empty if the board is not found. Remembers properties of the
  // board: the tags' border, the markers' dictionary.
  FoundPoints find(const GrayImage& image);

  // True, once, if the last picture has shown that the points of earlier ones have wrong numbers.
  bool renumbered();

  // Points near their places according to the map: takes a hundredth of a search's time.
  FoundPoints measure(const GrayImage& image, const PlaneMap& map, double gate_px) const;

  // Contradiction between the pictures and the board's parameters, as a sentence; empty if there is none.
  std::string doubt() const;
  // Unusual properties of the printed board that were recognised, as a sentence; empty if there are none.
  std::string remark() const;

 private:
  std::unique_ptr<PatternFinder> finder_;
};

// Common interface of the finders of different boards.
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
