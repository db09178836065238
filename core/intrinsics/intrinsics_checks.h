// What the views leave open, in words for whoever moves the board.
#pragma once

#include "core/data/intrinsics_result.h"
#include "core/data/intrinsics_story.h"
#include "core/intrinsics/bundle.h"

namespace evical {

// Relative sigma of the focal length; of pixels by angle on the axis, for the wide models' own number means nothing
// without their xi.
double focalLengthRelativeStd(const CameraIntrinsics& camera, const IntrinsicsMatrix& covariance);

// Throws CalibrationFailed where hardly any view is tilted: the focal length is not observable then.
void checkTilts(const Bundle& bundle, double focal_length_relative_std, const IntrinsicsOptions& options);

// Largest angle between board and image; of the views used, the most tilted twentieth left out.
double largestTilt_deg(const Bundle& bundle);

// Where the board was in each view that is used.
std::vector<IntrinsicsView> viewsOf(const Bundle& bundle, const Board& board);

// Where in the image views are missing, and which way the board was never tilted.
std::vector<std::string> coverageAdvice(const Bundle& bundle, const ImageMap& image);

// Parts of the image without a single circle, in words; nothing if that is none or all of them.
std::string missingPlaces(const std::vector<SensorView>& views, Resolution resolution_px);

// Status and reason, from what else is filled in.
void judge(bool converged, const IntrinsicsOptions& options, IntrinsicsResult& result);

}  // namespace evical
