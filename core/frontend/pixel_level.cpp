#include "core/frontend/pixel_level.h"

#include <algorithm>

namespace evical {

std::optional<double> PixelLevel::had(const LevelBurst& burst) const {
  if (burst.rested_before) return 0.0;
  if (level_ < 0.0f || burst.cut_begin) return std::nullopt;
  return (burst.brighter ? level_ : 1.0f - level_) * static_cast<float>(whole_[burst.brighter]);
}

std::optional<PixelLevel::Middle> PixelLevel::pass(const LevelBurst& burst) {
  constexpr double kOneEnd = 0.5;  // events: nearer to an end than to the next event
  std::uint16_t& whole = whole_[burst.brighter];
  const std::optional<double> before = had(burst);
  const Middle own{0.5 * (burst.events - 1), burst.events};
  const bool from_end = before && *before < kOneEnd;
  if (burst.rested_after && from_end) whole = static_cast<std::uint16_t>(burst.events);
  if (whole == 0 || burst.events >= whole || (!burst.rested_after && !before)) {
    const bool at_end = burst.rested_after || (whole > 0 && burst.events >= whole);
    level_ = kUnknown;
    if (at_end) set(burst.brighter, 1.0);
    return own;
  }
  const double missing = whole - burst.events;
  const double fired = burst.rested_after ? missing : std::clamp(*before, 0.0, missing);
  set(burst.brighter, (fired + burst.events) / whole);
  const double event = 0.5 * (whole - 1) - fired;
  if (event < 0.0 || event > burst.events - 1) return std::nullopt;
  return Middle{event, whole};
}

void PixelLevel::step(bool brighter, int events) {
  if (level_ < 0.0f || whole_[brighter] == 0) return;
  const float part = static_cast<float>(events) / static_cast<float>(whole_[brighter]);
  level_ = std::clamp(level_ + (brighter ? part : -part), 0.0f, 1.0f);
}

}  // namespace evical
