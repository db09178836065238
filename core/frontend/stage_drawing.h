// Pictures of the front end's stages, one window each, enlarged by a whole factor so that pixels stay pixels.
// A separate library (evical_drawing): the front end itself draws nothing.
#pragma once

#include "core/frontend/board_search.h"
#include "core/frontend/circle_pairs.h"
#include "core/frontend/rgb_image.h"
#include "core/frontend/window_trace.h"

#include <string>

namespace evical {

struct DrawingStyle {
  int width_px = 1000;            // about; the factor is whole
  double covariance_sigmas = 30;  // of a measured centre's ellipse: true ones are too small to see
  double arrow_s = 0.1;           // velocity arrows are this long
};

// Bursts alone: brighter edges warm, darker edges cool, older ones fainter.
RgbImage drawBursts(const BurstWindow& window, const BoardScene& scene, const std::string& title,
                    const DrawingStyle& style = {});

// From the top of a search to its end: candidates (grey), moving circles with their velocities (green,
// yellow), the lattice (white), and where found the board's circles with their numbers (magenta). `arcs`, if
// given, are drawn in place of the candidates: leading, trailing and other flow, and the pairs.
RgbImage drawSearch(const BurstWindow& window, const BoardSearch& search, const BoardScene& scene,
                    const NormalFlowStages* arcs = nullptr, const DrawingStyle& style = {});

// The fitted board, or where there is no fit the predicted one: projected ellipses with velocities, and the
// measured centres with numbers and covariance.
RgbImage drawTrackedWindow(const BurstWindow& window, const WindowTrace& trace, const BoardScene& scene,
                           const DrawingStyle& style = {});

}  // namespace evical
