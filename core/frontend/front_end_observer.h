// Observer of the front end, for drawings and live views.
#pragma once

#include <cstdint>

namespace evical {

class BurstWindow;
struct BoardSearch;
struct WindowTrace;

// Receives every window when it is processed. Called from the thread that adds events.
class FrontEndObserver {
 public:
  virtual ~FrontEndObserver() = default;
  virtual void windowTracked(const BurstWindow& window, const WindowTrace& trace) = 0;
  virtual void windowSearched(const BoardSearch& search, std::int64_t middle_ns) = 0;
};

}  // namespace evical
