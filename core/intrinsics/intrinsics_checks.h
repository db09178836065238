// Checks of the views' coverage, and advice for the next recording.
#pragma once

#include "core/data/intrinsics_result.h"
#include "core/intrinsics/bundle.h"

namespace evical {

// Relative sigma of the focal length; for the wide models that of pixels per angle on the axis, since their
// focal length alone is meaningless without xi.
double focalLengthRelativeStd(const CameraIntrinsics& camera, const IntrinsicsMatrix& covariance);

// Throws CalibrationFailed if hardly any view is tilted: then the focal length is not observable.
void checkTilts(const Bundle& bundle, double focal_length_relative_std, const IntrinsicsOptions& options);

// Largest angle between board and image, without the most tilted twentieth of the used views.
double largestTilt_deg(const Bundle& bundle);

// Pose of the board in each used view.
std::vector<IntrinsicsView> viewsOf(const Bundle& bundle, const Board& board);

// Advice for parts of the image without views, and for missing tilts.
std::vector<std::string> coverageAdvice(const Bundle& bundle, const ImageMap& image);

// Names of the parts of the image without circles; empty if that is none or all of them.
std::string missingPlaces(const std::vector<SensorView>& views, Resolution resolution_px);

// Sets status and reason from the other members.
void judge(bool converged, const IntrinsicsOptions& options, IntrinsicsResult& result);

}  // namespace evical
