#include "core/frontend/ring_vote.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace evical {
namespace {

constexpr double kLevelRadius_px = 13.0;  // larger circles are searched in an image of half the size

struct Vote {
  float x, y;
};

struct RingPoint {
  std::int32_t offset;  // from burst to centre, in the padded image
  float ux, uy;         // from centre to burst, unit
};

// Bursts of one pyramid level: one vote per cell and polarity.
struct PyramidLevel {
  int shift = 0, width = 0, height = 0;
  std::vector<std::uint32_t> cells;  // y * width + x
  std::vector<float> leads;
};

PyramidLevel makePyramidLevel(const BurstWindow& window, int shift) {
  PyramidLevel level;
  level.shift = shift;
  level.width = (window.resolution_px().width_px >> shift) + 1;
  level.height = (window.resolution_px().height_px >> shift) + 1;
  std::vector<std::uint8_t> seen(static_cast<std::size_t>(level.width * level.height), 0);
  for (const WindowBurst& burst : window.bursts()) {
    const int x = static_cast<int>(burst.x_px) >> shift, y = static_cast<int>(burst.y_px) >> shift;
    const auto cell = static_cast<std::uint32_t>(y * level.width + x);
    const std::uint8_t bit = burst.lead > 0.0f ? 1 : 2;
    if (seen[cell] & bit) continue;
    seen[cell] |= bit;
    level.cells.push_back(cell);
    level.leads.push_back(burst.lead);
  }
  return level;
}

std::vector<RingPoint> makeRing(double radius, double half_width, int stride) {
  std::vector<RingPoint> ring;
  const int reach = static_cast<int>(std::ceil(radius + half_width));
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const double distance = std::hypot(dx, dy);
      if (std::abs(distance - radius) >= half_width || distance < 0.5) continue;
      ring.push_back(
          {dy * stride + dx, static_cast<float>(-dx / distance), static_cast<float>(-dy / distance)});
    }
  }
  return ring;
}

// Per pixel of a level: the best score over all radii.
struct BestVotes {
  std::vector<float> score2;  // squared, of ring area
  std::vector<float> radius;
  std::vector<Vote> direction;
};

void voteRadius(const PyramidLevel& level, double radius, double half_width, int pad,
                std::vector<Vote>& votes, BestVotes& best) {
  const int stride = level.width + 2 * pad;
  const std::vector<RingPoint> ring = makeRing(radius, half_width, stride);
  std::fill(votes.begin(), votes.end(), Vote{0.0f, 0.0f});
  for (std::size_t i = 0; i < level.cells.size(); ++i) {
    const int x = static_cast<int>(level.cells[i]) % level.width,
              y = static_cast<int>(level.cells[i]) / level.width;
    Vote* const centre = votes.data() + (y + pad) * stride + x + pad;
    const float lead = level.leads[i];
    for (const RingPoint& point : ring) {
      Vote& vote = centre[point.offset];
      vote.x += lead * point.ux;
      vote.y += lead * point.uy;
    }
  }
  const float inverse_area2 = 1.0f / static_cast<float>(ring.size() * ring.size());
  for (int y = 0; y < level.height; ++y) {
    const Vote* const row = votes.data() + (y + pad) * stride + pad;
    for (int x = 0; x < level.width; ++x) {
      const float score2 = (row[x].x * row[x].x + row[x].y * row[x].y) * inverse_area2;
      const auto cell = static_cast<std::size_t>(y * level.width + x);
      if (score2 <= best.score2[cell]) continue;
      best.score2[cell] = score2;
      best.radius[cell] = static_cast<float>(radius);
      best.direction[cell] = row[x];
    }
  }
}

void collectPeaks(const PyramidLevel& level, const BestVotes& best, double min_score,
                  std::vector<CircleCandidate>& candidates) {
  constexpr int kNeighbourhood = 2;
  const auto least = static_cast<float>(min_score * min_score);
  const double size = 1 << level.shift;
  for (int y = 0; y < level.height; ++y) {
    for (int x = 0; x < level.width; ++x) {
      const auto cell = static_cast<std::size_t>(y * level.width + x);
      const float score2 = best.score2[cell];
      if (score2 < least) continue;
      bool peak = true;
      for (int dy = -kNeighbourhood; dy <= kNeighbourhood && peak; ++dy) {
        for (int dx = -kNeighbourhood; dx <= kNeighbourhood; ++dx) {
          const int nx = x + dx, ny = y + dy;
          if (nx < 0 || ny < 0 || nx >= level.width || ny >= level.height) continue;
          const auto other = static_cast<std::size_t>(ny * level.width + nx);
          if (best.score2[other] > score2 || (best.score2[other] == score2 && other < cell)) {
            peak = false;
            break;
          }
        }
      }
      if (!peak) continue;
      const Eigen::Vector2d direction(best.direction[cell].x, best.direction[cell].y);
      CircleCandidate candidate;
      candidate.centre_px = {(x + 0.5) * size - 0.5, (y + 0.5) * size - 0.5};
      candidate.radius_px = best.radius[cell] * size;
      candidate.direction = direction.normalized();
      candidate.score = std::sqrt(static_cast<double>(score2));
      candidates.push_back(candidate);
    }
  }
}

}  // namespace

std::vector<CircleCandidate> voteForCircles(const BurstWindow& window, const FrontEndOptions& all) {
  const RingVoteOptions& options = all.ring_vote;
  std::vector<CircleCandidate> candidates;
  const Resolution resolution = window.resolution_px();
  const double largest_px =
      std::min(all.detection.max_radius_px, 0.25 * std::min(resolution.width_px, resolution.height_px));
  double radius_px = all.detection.min_radius_px;
  for (int shift = 0; radius_px <= largest_px; ++shift) {
    const double size = 1 << shift;
    const double level_end_px = std::min(kLevelRadius_px * size, largest_px);
    const PyramidLevel level = makePyramidLevel(window, shift);
    const double half_width = std::max(options.ring_half_width_px, 0.07 * level_end_px / size);
    const int pad = static_cast<int>(std::ceil(level_end_px / size + half_width)) + 1;
    std::vector<Vote> votes(static_cast<std::size_t>((level.width + 2 * pad) * (level.height + 2 * pad)));
    const auto cells = static_cast<std::size_t>(level.width * level.height);
    BestVotes best{std::vector<float>(cells, 0.0f), std::vector<float>(cells, 0.0f),
                   std::vector<Vote>(cells)};
    for (; radius_px <= level_end_px; radius_px *= options.radius_step) {
      voteRadius(level, radius_px / size, half_width, pad, votes, best);
    }
    collectPeaks(level, best, options.min_score, candidates);
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const CircleCandidate& a, const CircleCandidate& b) { return a.score > b.score; });
  if (candidates.size() > static_cast<std::size_t>(options.max_candidates)) {
    candidates.resize(static_cast<std::size_t>(options.max_candidates));
  }
  return candidates;
}

}  // namespace evical
