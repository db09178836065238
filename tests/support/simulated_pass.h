// A session and what its front end would have found, by simulation without events: seconds instead of
// minutes.
#pragma once

#include "core/pipeline/recording_pass.h"
#include "core/pipeline/session.h"
#include "core/synthetic/scenario.h"

namespace evical::test {

struct SimulatedPass {
  Scenario truth;
  Session session;
  RecordingPass pass;
};

// The everyday scenario (config/scenarios/davis346.yaml), shortened; circle centres with a noise of 0.05 px.
SimulatedPass simulatePass(double duration_s);

}  // namespace evical::test
