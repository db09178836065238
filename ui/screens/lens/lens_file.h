// SPDX-License-Identifier: GPL-3.0-or-later
// File formats in which a lens can be saved.
#pragma once

#include <QtGlobal>

#include <array>

namespace evical::ui {

struct LensFile {
  const char* title;  // shown
  const char* name;   // in core (pipeline/intrinsics_files.h)
};

inline constexpr std::array kLensFiles = {
    LensFile{QT_TRANSLATE_NOOP("LensFile", "Evical: lens with sigmas and correlations"), "intrinsics.yaml"},
    LensFile{QT_TRANSLATE_NOOP("LensFile", "ROS camera_info"), "camera_info.yaml"},
    LensFile{QT_TRANSLATE_NOOP("LensFile", "Kalibr camchain"), "camchain.yaml"},
    LensFile{QT_TRANSLATE_NOOP("LensFile", "Projection uncertainty over the image, table"),
             "projection_std.csv"},
    LensFile{QT_TRANSLATE_NOOP("LensFile", "Detections of the board, table"), "detections.csv"}};

}  // namespace evical::ui
