// Segments of both splines that contain one cost function's measurements, and
// their evaluation from Ceres' blocks.
#pragma once

#include "core/geometry/so3_spline.h"
#include "core/geometry/vector_spline.h"

#include <cstddef>

namespace evical {

struct SegmentTimes {
  int rotation = 0, position = 0;                         // indices of the first segments
  int rotations = 1, positions = 1;                       // counts of successive segments
  double rotation_start_s = 0.0, position_start_s = 0.0;  // start times of the segments
  double rotation_spacing_s = 0.0, position_spacing_s = 0.0;

  double rotationPlace(double time_s) const { return (time_s - rotation_start_s) / rotation_spacing_s; }
  double positionPlace(double time_s) const { return (time_s - position_start_s) / position_spacing_s; }
};

inline std::size_t rotationPointsOf(const SegmentTimes& segments) {
  return static_cast<std::size_t>(3 + segments.rotations);
}
inline std::size_t positionPointsOf(const SegmentTimes& segments) {
  return static_cast<std::size_t>(3 + segments.positions);
}
inline std::size_t controlPointsOf(const SegmentTimes& segments) {
  return rotationPointsOf(segments) + positionPointsOf(segments);
}

inline bool sameSegment(const SegmentTimes& a, const SegmentTimes& b) {
  return a.rotation == b.rotation && a.position == b.position;
}

inline SegmentTimes segmentAt(const So3Spline& r, const VectorSpline& p, double time_s) {
  SegmentTimes segment;
  segment.rotation = placeInSpline(r, time_s).segment;
  segment.position = placeInSpline(p.start_s, p.knot_spacing_s, p.segmentCount(), time_s).segment;
  segment.rotation_start_s = r.start_s + segment.rotation * r.knot_spacing_s;
  segment.position_start_s = p.start_s + segment.position * p.knot_spacing_s;
  segment.rotation_spacing_s = r.knot_spacing_s;
  segment.position_spacing_s = p.knot_spacing_s;
  return segment;
}

inline So3Segment rotationSegment(const SegmentTimes& times, const double* const* blocks,
                                  bool with_jacobians) {
  return So3Segment(blocks[0], blocks[1], blocks[2], blocks[3], times.rotation_spacing_s, with_jacobians);
}

inline VectorSample positionAt(const SegmentTimes& times, const double* const* blocks, double time_s) {
  return evaluateVectorSegment(blocks[0], blocks[1], blocks[2], blocks[3], times.positionPlace(time_s),
                               times.position_spacing_s);
}

// Third derivative of the position, constant over the segment.
inline Eigen::Vector3d jerkOf(const SegmentTimes& times, const double* const* blocks) {
  const auto point = [&](int k) { return Eigen::Map<const Eigen::Vector3d>(blocks[k]); };
  const double spacing_s = times.position_spacing_s;
  return (point(3) - point(0) + 3.0 * (point(1) - point(2))) / (spacing_s * spacing_s * spacing_s);
}

}  // namespace evical
