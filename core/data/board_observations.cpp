#include "core/data/board_observations.h"

namespace evical {

const char* windowOutcomeName(WindowOutcome outcome) {
  static constexpr std::array<const char*, kWindowOutcomeCount> kNames = {"complete",
                                                                          "partial",
                                                                          "too few events",
                                                                          "too few circle candidates",
                                                                          "no lattice",
                                                                          "too few circles in the lattice",
                                                                          "ambiguous placement",
                                                                          "circles lost in refinement",
                                                                          "too blurred",
                                                                          "unreadable",
                                                                          "rejected by hand"};
  return kNames[static_cast<std::size_t>(outcome)];
}

}  // namespace evical
