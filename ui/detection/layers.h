// SPDX-License-Identifier: GPL-3.0-or-later
// What can be drawn over the events: one layer a stage, in the sensor's pixels.
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

inline constexpr double kShownSigmas = 30.0;  // of centres: honest ellipses are too small to see

struct LayerWords {
  QString name, help;
};
LayerWords layerWords(Layer layer);
QColor layerColour(Layer layer);  // of the theme; the first, where a layer has several
std::vector<QColor> layerColours(Layer layer);
LayerSet defaultLayers();
bool isOfFrames(Layer layer);  // says something of frames, too, not only of events

// Outlines of the board's circles where a calibration's trajectory puts them, of corners a point each; empty outside
// the trajectory.
std::vector<QPolygonF> reprojectBoard(const CalibrationState& state, std::size_t camera,
                                      const SeenBoard& seen, double time_s);
// Where they are expected to be measured: ahead by the camera's edge lead, of which the view says which way, and of
// frames when their rows were exposed.
std::vector<QPolygonF> reprojectBoard(const CalibrationState& state, std::size_t camera,
                                      const SeenBoard& seen, double time_s, const BoardView& view,
                                      double slow_edge_speed_px_s);

// `scale` is widget pixels per sensor pixel. The analysis may be null.
void paintLayers(QPainter& painter, double scale, const LayerSet& visible, const WindowAnalysis* analysis,
                 const std::vector<QPolygonF>& reprojection);

}  // namespace evical::ui
