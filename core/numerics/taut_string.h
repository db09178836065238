// The shortest line through gates.
#pragma once

#include <deque>
#include <vector>

namespace evical {

struct LinePoint {
  double x, y;
};
inline double slope(const LinePoint& a, const LinePoint& b) {
  return (b.y - a.y) / (b.x - a.x);
}

// The line within the gates that bends least; straight between its bends. Gates in order of x.
class TautString {
 public:
  explicit TautString(const LinePoint& start) : bends_{start}, upper_{start}, lower_{start} {}

  void add(double x, double low, double high) {
    addTo(upper_, lower_, {x, high}, 1.0);
    addTo(lower_, upper_, {x, low}, -1.0);
  }
  // Start, bends and end. The last gate must be a point.
  std::vector<LinePoint> finish() {
    bends_.push_back(upper_.back());
    return bends_;
  }

 private:
  // Each side is the shortest line from the last bend around that side's ends of gates. If the other side is
  // in the way of a straight line to the new end, the string bends there. `sign`: 1 for upper ends, which
  // such a line passes below.
  void addTo(std::deque<LinePoint>& own, std::deque<LinePoint>& other, const LinePoint& end, double sign) {
    while (own.size() > 1 && sign * (slope(own[own.size() - 2], own.back()) - slope(own.back(), end)) >= 0.0)
      own.pop_back();
    own.push_back(end);
    while (own.size() == 2 && other.size() > 1 &&
           sign * (slope(own[0], own[1]) - slope(other[0], other[1])) < 0.0) {
      other.pop_front();
      own.front() = other.front();
      bends_.push_back(own.front());
    }
  }

  std::vector<LinePoint> bends_;
  std::deque<LinePoint> upper_, lower_;
};

}  // namespace evical
