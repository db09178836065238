// SPDX-License-Identifier: GPL-3.0-or-later
// Layers drawn over the events: one per stage, in sensor pixels.
#pragma once

#include "core/data/board_observations.h"
#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"

#include <QColor>
#include <QPolygonF>
#include <QString>

#include <bitset>
#include <vector>

class QPainter;

namespace evical::ui {

struct WindowAnalysis;

enum class Layer { Flow, Clusters, Pairs, Circles, Ellipses, Centres, Grid, Prediction, Reprojection };
inline constexpr std::size_t kLayerCount = 9;
using LayerSet = std::bitset<kLayerCount>;

inline constexpr double kShownSigmas = 30.0;  // of centres: ellipses of one sigma are too small to see

struct LayerWords {
  QString name, help;
};
LayerWords layerWords(Layer layer);
QColor layerColour(Layer layer);  // of the theme; the first if a layer has several
std::vector<QColor> layerColours(Layer layer);
LayerSet defaultLayers();
bool isOfFrames(Layer layer);  // applies to frames as well as to events

// Outlines of the board's circles, projected with a calibration's trajectory; for corners one point each;
// empty outside the trajectory.
std::vector<QPolygonF> reprojectBoard(const CalibrationState& state, std::size_t camera,
                                      const SeenBoard& seen, double time_s);
// Expected measurements: shifted by the camera's edge localisation bias, in the direction from the view, and
// for frames at the exposure time of their rows.
std::vector<QPolygonF> reprojectBoard(const CalibrationState& state, std::size_t camera,
                                      const SeenBoard& seen, double time_s, const BoardView& view,
                                      double slow_edge_speed_px_s);

// `scale` is widget pixels per sensor pixel. The analysis may be null.
void paintLayers(QPainter& painter, double scale, const LayerSet& visible, const WindowAnalysis* analysis,
                 const std::vector<QPolygonF>& reprojection);

}  // namespace evical::ui
