// Sessions and recordings in memory for scenarios, so that tests and benchmarks need no files.
#pragma once

#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/session/session.h"
#include "core/report/result_yaml.h"
#include "core/synthetic/scenario.h"

namespace evical::test {

Session sessionFor(const Scenario& scenario);

// The IMUs' samples, and the first camera's circles as detected by the front end in the simulated events,
// with the session's board.
DetectionResult detectedPass(const Scenario& scenario, const Session& session);
// The same with circles of an ideal front end, with noise: fast, without events.
DetectionResult perfectPass(const Scenario& scenario, double centre_sigma_px, double window_s);

NamedResult truthOf(const Scenario& scenario);

}  // namespace evical::test
