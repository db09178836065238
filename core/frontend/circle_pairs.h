// Circle candidates from pairs of arcs: a leading and a trailing one (docs/maths.md, 5.2).
#pragma once

#include "core/frontend/circle_candidate.h"
#include "core/frontend/detection_options.h"
#include "core/frontend/normal_flow.h"

#include <cstddef>
#include <vector>

namespace evical {

struct ArcPair {
  std::size_t leading = 0, trailing = 0;  // indices into the clusters
  CircleCandidate circle;
};

// Intermediate results of the published method; for drawings.
struct NormalFlowStages {
  NormalFlowField flow;
  std::vector<EventCluster> clusters;
  std::vector<ArcPair> pairs;
};

// Pairs arcs that move alike, one behind the other. Mutual nearest neighbours; arcs of a clear kind first.
std::vector<ArcPair> pairClusters(const std::vector<EventCluster>& clusters, const NormalFlowField& field,
                                  const FrontEndOptions& options);

NormalFlowStages findArcs(const BurstWindow& window, const FrontEndOptions& options);

// The circles of all pairs, best first.
std::vector<CircleCandidate> pairArcs(const BurstWindow& window, const FrontEndOptions& options);

}  // namespace evical
