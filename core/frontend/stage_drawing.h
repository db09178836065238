// Pictures of the front end's stages, one window each, enlarged by an integer factor so that pixels stay
// sharp. A separate library (evical_drawing): the front end itself does not draw.
#pragma once

#include "core/frontend/board_search.h"
#include "core/frontend/circle_pairs.h"
#include "core/frontend/rgb_image.h"
#include "core/frontend/window_trace.h"

#include <string>

namespace evical {

struct DrawingStyle {
  int width_px = 1000;            // approximate, since the factor is an integer
  double covariance_sigmas = 30;  // of a measured centre's ellipse: ellipses of 1 sigma are too small to see
  double arrow_s = 0.1;           // duration of motion that velocity arrows show
};

// Bursts only: brightening edges in warm colours, darkening edges in cool ones, older ones fainter.
RgbImage drawBursts(const BurstWindow& window, const BoardScene& scene, const std::string& title,
                    const DrawingStyle& style = {});

// All stages of a search: candidates (grey), moving circles with their velocities (green,
// yellow), the lattice (white), and if found the board's circles with their numbers (magenta). `arcs`, if
// given, are drawn instead of the candidates: leading, trailing and other flow, and the pairs.
RgbImage drawSearch(const BurstWindow& window, const BoardSearch& search, const BoardScene& scene,
                    const NormalFlowStages* arcs = nullptr, const DrawingStyle& style = {});

// The fitted board, or the predicted one if there is no fit: projected ellipses with velocities, and the
// measured centres with numbers and covariance.
RgbImage drawTrackedWindow(const BurstWindow& window, const WindowTrace& trace, const BoardScene& scene,
                           const DrawingStyle& style = {});

}  // namespace evical
