// All options of the front end, one struct per stage.
#pragma once

#include "core/frontend/detection_options.h"
#include "core/frontend/normal_flow_options.h"

namespace evical {

struct FrontEndOptions {
  DetectionOptions detection;
  BurstOptions bursts;
  RingVoteOptions ring_vote;
  NormalFlowOptions normal_flow;
  MovingCircleOptions moving_circle;
  GridOptions grid;
  TrackingOptions tracking;
  ExtentOptions extent;
  bool operator==(const FrontEndOptions&) const = default;
};

}  // namespace evical
