// A session and the detections of its front end, simulated without events: seconds instead of minutes.
#pragma once

#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/session/session.h"
#include "core/synthetic/scenario.h"

#include <string>

namespace evical::test {

struct SimulatedPass {
  Scenario truth;
  Session session;
  DetectionResult detections;
};

// A shortened scenario of config/scenarios; circle centres with a noise of 0.05 px.
SimulatedPass simulatePass(double duration_s, const std::string& scenario = "davis346");
SimulatedPass simulatePass(double duration_s, const Scenario& scenario);

}  // namespace evical::test
