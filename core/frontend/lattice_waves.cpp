#include "core/frontend/lattice_waves.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <utility>

namespace evical {
namespace {

using Complex = std::complex<double>;

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kShortestWave_px = 6.0, kLongestWave_px = 40.0;  // of a picture of at most kWidth_px
constexpr int kWidth_px = 160;
constexpr std::size_t kMaxEvents = 6000;  // of a window; more take longer
constexpr std::size_t kMaxPeaks = 8, kMaxLattices = 2;
constexpr double kMinSine = 0.7, kMaxRatio = 1.7;  // of the two waves' directions and lengths

struct SignedEvent {
  Eigen::Vector2d at_px;
  double time_s, sign;
};

Complex waveAt(const Eigen::Vector2d& wave_rad_px, const Eigen::Vector2d& at_px) {
  return std::polar(1.0, -wave_rad_px.dot(at_px));
}

// Waves of the whole picture, strongest first: peaks of its spectrum, of which one half is needed.
class Spectrum {
 public:
  explicit Spectrum(const std::vector<SignedEvent>& events)
      : reach_(static_cast<int>(std::ceil(kWidth_px / kShortestWave_px))),
        values_(static_cast<std::size_t>((2 * reach_ + 1) * (reach_ + 1))) {
    for (const SignedEvent& event : events) {
      const Complex step_x = waveAt({kStep_rad_px, 0.0}, event.at_px),
                    step_y = waveAt({0.0, kStep_rad_px}, event.at_px);
      const Complex first = event.sign * waveAt({-reach_ * kStep_rad_px, 0.0}, event.at_px);
      Complex row = first;
      for (int y = 0; y <= reach_; ++y, row *= step_y) {
        Complex value = row;
        for (int x = -reach_; x <= reach_; ++x, value *= step_x) values_[indexOf(x, y)] += value;
      }
    }
  }

  std::vector<Eigen::Vector2d> peaks() const {
    std::vector<std::pair<double, Eigen::Vector2d>> found;
    for (int y = 0; y <= reach_; ++y) {
      for (int x = -reach_; x <= reach_; ++x) {
        const double wave_rad_px = kStep_rad_px * std::hypot(x, y);
        if (y == 0 && x <= 0) continue;
        if (wave_rad_px > kTurn_rad / kShortestWave_px || wave_rad_px < kTurn_rad / kLongestWave_px) continue;
        if (isPeak(x, y)) found.emplace_back(power(x, y), between(x, y));
      }
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<Eigen::Vector2d> waves;
    for (std::size_t k = 0; k < std::min(found.size(), kMaxPeaks); ++k) waves.push_back(found[k].second);
    return waves;
  }

 private:
  static constexpr double kStep_rad_px = kTurn_rad / kWidth_px;

  std::size_t indexOf(int x, int y) const {
    return static_cast<std::size_t>(y * (2 * reach_ + 1) + x + reach_);
  }
  // The picture is real: opposite waves have equal powers.
  double power(int x, int y) const {
    if (y < 0) x = -x, y = -y;
    if (std::abs(x) > reach_ || y > reach_) return 0.0;
    return std::norm(values_[indexOf(x, y)]);
  }
  bool isPeak(int x, int y) const {
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if ((dx != 0 || dy != 0) && power(x + dx, y + dy) >= power(x, y)) return false;
    return true;
  }
  Eigen::Vector2d between(int x, int y) const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double weights = 0.0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        sum += power(x + dx, y + dy) * Eigen::Vector2d(x + dx, y + dy);
        weights += power(x + dx, y + dy);
      }
    return kStep_rad_px * sum / weights;
  }

  int reach_;
  std::vector<Complex> values_;
};

// Phases of two waves at one place, from the events around it.
struct LocalWaves {
  std::array<Complex, 2> early, late;  // relative to the waves, from either half of the window
  double events = 0.0;

  Complex both(std::size_t k) const { return early[k] + late[k]; }
  double coherence() const { return std::min(std::abs(both(0)), std::abs(both(1))); }
};

// Two waves over a grid of places, and their unwrapped phases in the region where they continue.
class WaveGrid {
 public:
  WaveGrid(const std::vector<SignedEvent>& events, const std::array<Eigen::Vector2d, 2>& waves,
           Eigen::Vector2d size_px)
      : waves_(waves),
        sigma_px_(kSigma * kTurn_rad / std::max(waves[0].norm(), waves[1].norm())),
        step_px_(kStep * sigma_px_),
        columns_(static_cast<int>(size_px.x() / step_px_) + 1),
        rows_(static_cast<int>(size_px.y() / step_px_) + 1),
        local_(static_cast<std::size_t>(columns_ * rows_)),
        phases_(local_.size()) {
    sum(events);
    grow();
  }

  struct Phases {
    bool known = false;
    std::array<double, 2> rad = {};  // of the signed picture, waves included
  };

  double score() const { return score_; }
  double step_px() const { return step_px_; }

  // Advance of the phases between the window's halves, over the region.
  std::array<double, 2> advance_rad() const {
    std::array<Complex, 2> sums = {};
    for (std::size_t n = 0; n < local_.size(); ++n)
      for (std::size_t k = 0; k < 2; ++k)
        if (phases_[n].known) sums[k] += local_[n].late[k] * std::conj(local_[n].early[k]);
    return {std::arg(sums[0]), std::arg(sums[1])};
  }

  template <class Visit>
  void visitRegion(Visit&& visit) const {
    for (int y = 0; y < rows_; ++y)
      for (int x = 0; x < columns_; ++x)
        if (const Phases& phases = phases_[indexOf(x, y)]; phases.known)
          visit(step_px_ * Eigen::Vector2d(x, y), phases.rad, local_[indexOf(x, y)].coherence());
  }

 private:
  static constexpr double kSigma = 0.7, kStep = 0.35;  // of a wave's length; of sigma
  static constexpr double kMinCoherence = 0.35;        // of the events around a place
  static constexpr double kMinEvents = 0.25;           // of those around the most coherent place
  static constexpr double kLargestStep_rad = 0.9;      // between neighbouring places, beyond the waves' own

  std::size_t indexOf(int x, int y) const { return static_cast<std::size_t>(y * columns_ + x); }

  void sum(const std::vector<SignedEvent>& events) {
    const int reach = static_cast<int>(std::ceil(2.5 * sigma_px_ / step_px_));
    for (const SignedEvent& event : events) {
      const std::array<Complex, 2> values = {event.sign * waveAt(waves_[0], event.at_px),
                                             event.sign * waveAt(waves_[1], event.at_px)};
      const int column = static_cast<int>(std::lround(event.at_px.x() / step_px_)),
                row = static_cast<int>(std::lround(event.at_px.y() / step_px_));
      for (int y = std::max(0, row - reach); y <= std::min(rows_ - 1, row + reach); ++y) {
        for (int x = std::max(0, column - reach); x <= std::min(columns_ - 1, column + reach); ++x) {
          const double distance2 = (step_px_ * Eigen::Vector2d(x, y) - event.at_px).squaredNorm();
          const double w = std::exp(-0.5 * distance2 / (sigma_px_ * sigma_px_));
          LocalWaves& local = local_[indexOf(x, y)];
          local.events += w * std::abs(event.sign);
          for (std::size_t k = 0; k < 2; ++k)
            (event.time_s < 0.0 ? local.early : local.late)[k] += w * values[k];
        }
      }
    }
  }

  bool isCoherent(const LocalWaves& local, double most_events) const {
    return local.events > kMinEvents * most_events && local.coherence() > kMinCoherence * local.events;
  }

  // From the most coherent place outwards.
  void grow() {
    const auto best = static_cast<std::size_t>(
        std::max_element(local_.begin(), local_.end(),
                         [](const auto& a, const auto& b) { return a.coherence() < b.coherence(); }) -
        local_.begin());
    const double most_events = local_[best].events;
    if (!isCoherent(local_[best], most_events)) return;
    std::vector<std::size_t> reached = {best};
    setPhases(best, local_[best], {});
    for (std::size_t n = 0; n < reached.size(); ++n) {
      score_ += local_[reached[n]].coherence();
      const int x = static_cast<int>(reached[n]) % columns_, y = static_cast<int>(reached[n]) / columns_;
      constexpr std::array<std::pair<int, int>, 4> kWays = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
      for (const auto& [dx, dy] : kWays) {
        if (x + dx < 0 || y + dy < 0 || x + dx >= columns_ || y + dy >= rows_) continue;
        const std::size_t next = indexOf(x + dx, y + dy);
        if (phases_[next].known || !isCoherent(local_[next], most_events)) continue;
        if (!continues(reached[n], next)) continue;
        setPhases(next, local_[next], phases_[reached[n]]);
        reached.push_back(next);
      }
    }
  }

  bool continues(std::size_t from, std::size_t to) const {
    for (std::size_t k = 0; k < 2; ++k)
      if (std::abs(std::arg(local_[to].both(k) * std::conj(local_[from].both(k)))) > kLargestStep_rad)
        return false;
    return true;
  }

  void setPhases(std::size_t n, const LocalWaves& local, const Phases& near) {
    const int x = static_cast<int>(n) % columns_, y = static_cast<int>(n) / columns_;
    const Eigen::Vector2d at_px = step_px_ * Eigen::Vector2d(x, y);
    Phases& phases = phases_[n];
    phases.known = true;
    for (std::size_t k = 0; k < 2; ++k) {
      phases.rad[k] = waves_[k].dot(at_px) + std::arg(local.both(k));
      if (!near.known) continue;
      // The neighbour's phase differs by at most one wave and the largest step: less than half a turn.
      const double own = phases.rad[k];
      phases.rad[k] = near.rad[k] + wrapped_rad(own - near.rad[k]);
    }
  }

  std::array<Eigen::Vector2d, 2> waves_;
  double sigma_px_, step_px_;
  int columns_, rows_;
  std::vector<LocalWaves> local_;
  std::vector<Phases> phases_;
  double score_ = 0.0;
};

// Corners where the lattice coordinates, in squares, are whole numbers.
WaveLattice latticeOf(const WaveGrid& grid, const std::array<Eigen::Vector2d, 2>& waves,
                      double between_halves_s, double pixel_px) {
  const std::array<double, 2> advance_rad = grid.advance_rad();
  Eigen::Matrix2d k;
  k << waves[0].transpose(), waves[1].transpose();
  WaveLattice out;
  // The phase of a wave that moves by v t is k (x - v t).
  out.velocity_px_s = k.inverse() * Eigen::Vector2d(-advance_rad[0], -advance_rad[1]) / between_halves_s;
  // Brightness A cos(phase) changes by A (k v) sin(phase): the signed picture is behind or ahead of it.
  std::array<double, 2> shift_rad;
  for (std::size_t n = 0; n < 2; ++n)
    shift_rad[n] = (waves[n].dot(out.velocity_px_s) > 0.0 ? 0.5 : -0.5) * std::numbers::pi;
  // sin(pi X) sin(pi Y) = (cos(pi X - pi Y) - cos(pi X + pi Y)) / 2. The waves are pi X - pi Y and pi X + pi
  // Y, in the order in which X and Y are positively oriented.
  const bool ordered = k.determinant() > 0.0;
  Eigen::Matrix2d squares_from_phases;
  squares_from_phases << 0.5, 0.5, -0.5, 0.5;
  squares_from_phases /= std::numbers::pi;
  const auto first = static_cast<std::size_t>(ordered ? 0 : 1), second = 1 - first;
  Eigen::Matrix2d by_px;
  by_px << waves[first].transpose(), waves[second].transpose();
  const Eigen::Matrix2d px_from_squares = (squares_from_phases * by_px).inverse();
  struct Sum {
    Eigen::Vector2d at_px = Eigen::Vector2d::Zero();
    double weight = 0.0;
  };
  std::map<std::pair<int, int>, Sum> corners;
  grid.visitRegion([&](const Eigen::Vector2d& at_px, const std::array<double, 2>& rad, double coherence) {
    const Eigen::Vector2d phases(rad[first] + shift_rad[first],
                                 rad[second] + shift_rad[second] - std::numbers::pi);
    const Eigen::Vector2d here = squares_from_phases * phases;
    const Eigen::Vector2d node(std::round(here.x()), std::round(here.y()));
    const Eigen::Vector2d way_px = px_from_squares * (node - here);
    if (way_px.norm() > grid.step_px()) return;
    Sum& sum = corners[{static_cast<int>(node.x()), static_cast<int>(node.y())}];
    sum.at_px += coherence * (at_px + way_px);
    sum.weight += coherence;
  });
  for (const auto& [node, sum] : corners) {
    out.corners.nodes.push_back({node.first, node.second, out.saddles.size()});
    out.saddles.push_back({pixel_px * sum.at_px / sum.weight, 0.0, sum.weight});
  }
  out.velocity_px_s *= pixel_px;
  return out;
}

// A window's events, in pixels of the picture, and the time between the means of its halves.
struct SignedWindow {
  std::vector<SignedEvent> events;
  double between_halves_s = 0.0;  // 0: a half is empty
};

SignedWindow signedEvents(const BurstWindow& window, double half_window_s, double pixel_px) {
  SignedWindow out;
  std::array<double, 2> time_s = {}, count = {};
  const std::size_t every = window.bursts().size() / kMaxEvents + 1;
  for (std::size_t n = 0; n < window.bursts().size(); n += every) {
    const WindowBurst& burst = window.bursts()[n];
    const double at_s = burst.time_s;
    if (std::abs(at_s) > half_window_s) continue;
    out.events.push_back({Eigen::Vector2d(burst.x_px, burst.y_px) / pixel_px, at_s, -burst.lead});
    time_s[at_s < 0.0 ? 0 : 1] += at_s;
    count[at_s < 0.0 ? 0 : 1] += 1.0;
  }
  if (count[0] > 0.0 && count[1] > 0.0) out.between_halves_s = time_s[1] / count[1] - time_s[0] / count[0];
  return out;
}

// True if both may be a square's diagonals.
bool mayCross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double sine = std::abs(a.x() * b.y() - a.y() * b.x()) / (a.norm() * b.norm());
  const double ratio = a.norm() / b.norm();
  return sine > kMinSine && ratio < kMaxRatio && ratio > 1.0 / kMaxRatio;
}

}  // namespace

std::vector<WaveLattice> findLatticeWaves(const BurstWindow& window, double half_window_s) {
  const Resolution size = window.resolution_px();
  const double pixel_px = std::max(1.0, std::max(size.width_px, size.height_px) / double{kWidth_px});
  const SignedWindow picture = signedEvents(window, half_window_s, pixel_px);
  if (picture.between_halves_s <= 0.0) return {};
  const std::vector<Eigen::Vector2d> waves = Spectrum(picture.events).peaks();
  std::vector<std::pair<double, WaveLattice>> found;  // with scores
  for (std::size_t a = 0; a < waves.size(); ++a) {
    for (std::size_t b = a + 1; b < waves.size(); ++b) {
      if (!mayCross(waves[a], waves[b])) continue;
      const std::array<Eigen::Vector2d, 2> pair = {waves[a], waves[b]};
      const WaveGrid grid(picture.events, pair, Eigen::Vector2d(size.width_px, size.height_px) / pixel_px);
      if (grid.score() <= 0.0) continue;
      found.emplace_back(grid.score() * grid.step_px() * grid.step_px(),
                         latticeOf(grid, pair, picture.between_halves_s, pixel_px));
    }
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<WaveLattice> lattices;
  for (std::size_t n = 0; n < std::min(found.size(), kMaxLattices); ++n)
    lattices.push_back(std::move(found[n].second));
  return lattices;
}

}  // namespace evical
