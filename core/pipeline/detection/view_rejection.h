// Rejection of views by hand because of their residuals, and its reversal.
#pragma once

#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/session/session.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace evical {

// Centres of windows that were rejected by hand, by camera; in time order.
using RejectedTimes = std::vector<std::vector<double>>;

// The pass with exactly these windows rejected, each the nearest one that contains the time: other rejected
// views are restored. Rejected windows whose
// views are no longer known stay rejected. Window reports are updated, so that all counts agree. Nothing was
// read for the new pass: its read_s and detect_s are 0.
DetectionResult withRejected(const DetectionResult& detections, const RejectedTimes& rejected_s);

// Rejects the windows that the session rejects, in addition to those that are.
void rejectAsIn(const Session& session, DetectionResult& detections);

// Centres of the windows with the board that contain these times: another detection may have other centres.
// Times without such a window stay.
std::vector<double> windowsAt(const std::vector<double>& times_s, const BoardObservations& camera);

// The pass with these views of a camera rejected as well: indices into pass.cameras[camera].views, in any
// order, duplicates allowed.
DetectionResult withoutViews(const DetectionResult& detections, std::size_t camera,
                             std::span<const int> views);

RejectedTimes rejectedTimes_s(const DetectionResult& detections);
// Rejected times of one camera; and the sentence about them, empty if there are none.
std::vector<double> rejectedTimes_s(const BoardObservations& camera);
std::string rejectedSentence(const BoardObservations& camera);

}  // namespace evical
