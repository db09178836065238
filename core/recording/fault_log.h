// Collects what is wrong with a recording without drowning in it: a million bad lines are a few entries and a
// count.
#pragma once

#include "core/data/recording.h"

#include <cstddef>
#include <string>
#include <vector>

namespace evical {

class FaultLog {
 public:
  // Of one kind in one stream, the first few are listed; the last of these then counts the others.
  void add(const std::string& stream, const std::string& kind, double at_s, const std::string& text);
  const std::vector<RecordingFault>& list() const { return faults_; }

 private:
  struct Tally {
    std::string stream, kind;
    std::size_t listed = 0, more = 0;
    std::size_t last = 0;   // index into faults_ of the last listed one
    std::string last_text;  // its own text, without the count
  };
  std::vector<RecordingFault> faults_;
  std::vector<Tally> tallies_;
};

}  // namespace evical
