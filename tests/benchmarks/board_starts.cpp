// Identification of the board from any start time: `evical_benchmarks board_starts [--moments N] [--length S]
// [--hidden S] [--duration S] [--seeds N] SCENARIO...`. A recording is simulated once. The front end starts
// at random times of it, with the whole board visible, and with a third of it silent at first, along its
// columns or its rows. Fails if circles are misidentified in more than 2 % of the windows with a board.
#include "core/frontend/board_tracker.h"
#include "core/frontend/detection_options.h"
#include "core/geometry/camera_model.h"
#include "core/synthetic/board_truth.h"
#include "core/synthetic/event_simulator.h"
#include "core/synthetic/random.h"
#include "tests/benchmarks/benchmark_program.h"
#include "tests/support/scenario_session.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace evical::benchmarks::board_starts {
namespace {

enum class Hidden { Nothing, AlongColumns, AlongRows };
constexpr std::array kHidden = {Hidden::Nothing, Hidden::AlongColumns, Hidden::AlongRows};

const char* wordOf(Hidden hidden) {
  return hidden == Hidden::Nothing        ? "nothing"
         : hidden == Hidden::AlongColumns ? "last rows"
                                          : "last columns";
}

struct Start {
  double at_s = 0.0, length_s = 3.0, hidden_s = 0.5;
  Hidden hidden = Hidden::Nothing;
};

struct Counts {
  int starts = 0, lost = 0, wrong_at_the_end = 0;  // nothing detected at all
  int windows = 0, wrong = 0;
  double longest_s = 0.0;  // time with misidentified circles after the whole board has become visible

  void operator+=(const Counts& other) {
    starts += other.starts;
    lost += other.lost;
    wrong_at_the_end += other.wrong_at_the_end;
    windows += other.windows;
    wrong += other.wrong;
    longest_s = std::max(longest_s, other.longest_s);
  }
  double share() const { return windows == 0 ? 0.0 : static_cast<double>(wrong) / windows; }
};

// True if a pixel shows the hidden part of the board.
class Cover {
 public:
  Cover(const Scenario& scenario, const SinusoidMotion& motion, Hidden hidden)
      : scenario_(scenario), motion_(motion), hidden_(hidden) {
    const Board& board = scenario.board;
    double last_m = 0.0;
    for (const Eigen::Vector2d& centre : boardPoints_m(board))
      last_m = std::max(last_m, hidden == Hidden::AlongColumns ? centre.y() : centre.x());
    from_m_ = 2.0 / 3.0 * last_m;
    const CameraIntrinsics& camera = scenario.cameras.front().intrinsics;
    for (int y = 0; y < camera.resolution_px.height_px; ++y)
      for (int x = 0; x < camera.resolution_px.width_px; ++x) {
        const auto ideal = idealPixel(camera, Eigen::Vector2d(x, y));
        rays_.push_back(
            ideal ? ((*ideal - camera.principal_point_px).cwiseQuotient(camera.focal_length_px)).eval()
                  : Eigen::Vector2d::Zero().eval());
      }
  }
  bool hides(const Event& event) {
    if (hidden_ == Hidden::Nothing) return false;
    const double stamp_s = 1e-9 * static_cast<double>(event.time_ns - scenario_.start_ns);
    if (std::abs(stamp_s - looked_at_s_) > 1e-3) look(stamp_s);
    const int width = scenario_.cameras.front().intrinsics.resolution_px.width_px;
    const Eigen::Vector3d place =
        board_from_ray_ * rays_[static_cast<std::size_t>(event.y_px * width + event.x_px)].homogeneous();
    return (hidden_ == Hidden::AlongColumns ? place.y() : place.x()) / place.z() > from_m_;
  }

 private:
  void look(double stamp_s) {
    looked_at_s_ = stamp_s;
    const SimulatedCamera& camera = scenario_.cameras.front();
    const RigidTransform camera_from_board =
        inverse(motion_.worldFromCamera(0, stamp_s + camera.time_offset_s - camera.pixel.delay_s()));
    const Eigen::Matrix3d r = camera_from_board.rotation.toRotationMatrix();
    Eigen::Matrix3d h;
    h << r.col(0), r.col(1), camera_from_board.translation_m;
    board_from_ray_ = h.inverse();
  }

  const Scenario& scenario_;
  const SinusoidMotion& motion_;
  Hidden hidden_;
  double from_m_ = 0.0, looked_at_s_ = -1e9;
  Eigen::Matrix3d board_from_ray_ = Eigen::Matrix3d::Identity();
  std::vector<Eigen::Vector2d> rays_;
};

// True if more than half of its circles are nearer to another circle's true position than to their own.
bool isWrong(const BoardView& view, const std::vector<TrueCircle>& truths) {
  std::size_t wrong = 0;
  for (const CircleObservation& circle : view.circles) {
    const auto nearest =
        std::min_element(truths.begin(), truths.end(), [&](const TrueCircle& a, const TrueCircle& b) {
          return (a.centre_px - circle.centre_px).squaredNorm() <
                 (b.centre_px - circle.centre_px).squaredNorm();
        });
    wrong += nearest != truths.end() && nearest->circle != circle.circle;
  }
  return 2 * wrong > view.circles.size();
}

Counts run(const Scenario& scenario, const SinusoidMotion& motion, const std::vector<Event>& events,
           const Start& start) {
  const Session session = test::sessionFor(scenario);
  const CameraIntrinsics& camera = *session.cameras.front().intrinsics;
  BoardTracker tracker(session.board, camera.resolution_px, camera, *session.options.front_end,
                       scenario.start_ns);
  Cover cover(scenario, motion, start.hidden);
  const auto at_ns = [&](double time_s) { return scenario.start_ns + std::llround(1e9 * time_s); };
  std::vector<Event> packet;
  constexpr std::size_t kPacket = 5000;
  for (const Event& event : events) {
    if (event.time_ns < at_ns(start.at_s)) continue;
    if (event.time_ns > at_ns(start.at_s + start.length_s)) break;
    if (event.time_ns < at_ns(start.at_s + start.hidden_s) && cover.hides(event)) continue;
    packet.push_back(event);
    if (packet.size() < kPacket) continue;
    tracker.add(packet);
    packet.clear();
  }
  tracker.add(packet);
  Counts counts{.starts = 1};
  for (const BoardView& view : tracker.finish().views) {
    const bool wrong = isWrong(view, trueBoardView(motion, scenario, 0, view.time_s));
    ++counts.windows;
    counts.wrong += wrong;
    counts.wrong_at_the_end = wrong;
    if (wrong) counts.longest_s = std::max(counts.longest_s, view.time_s - start.at_s - start.hidden_s);
  }
  counts.lost = counts.windows == 0;
  return counts;
}

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("Identification of the board from any start time");
  ScenarioArguments scenarios;
  int moments = 40;
  Start start;
  scenarios.addTo(app);
  app.option("--moments", moments, "Number of start times of each kind").between(1, 10000);
  app.option("--length", start.length_s, "Seconds from each start").between(0.2, 100.0);
  app.option("--hidden", start.hidden_s, "Seconds during which a third of the image is silent")
      .between(0.0, 100.0);
  if (!app.parse(argc, argv)) return 0;
  fmt::print(
      "| scenario | seed | hidden at first | starts | without a view | windows found | misidentified, % | "
      "starts wrong to the end | wrong after the whole board is visible, s "
      "|\n|---|---|---|---|---|---|---|---|---|\n");
  bool good = true;
  for (const std::string& file : scenarios.files) {
    for (int k = 0; k < scenarios.seeds; ++k) {
      const Scenario scenario = scenarios.read(file, k);
      const SinusoidMotion motion(scenario);
      std::vector<Event> events;
      simulateEvents(scenario, 0,
                     [&](EventSpan packet) { events.insert(events.end(), packet.begin(), packet.end()); });
      const double first_s =
          events.empty() ? 0.0 : 1e-9 * static_cast<double>(events.front().time_ns - scenario.start_ns);
      for (const Hidden hidden : kHidden) {
        Random random(scenario.seed, 0x310, static_cast<std::uint64_t>(hidden));
        Counts counts;
        for (int moment = 0; moment < moments; ++moment) {
          start.hidden = hidden;
          start.at_s = first_s + random.uniform() * std::max(0.0, scenario.duration_s - start.length_s);
          counts += run(scenario, motion, events, start);
        }
        constexpr double kMaxWrong = 0.02;
        good = good && counts.share() <= kMaxWrong;
        fmt::print("| {} | {} | {} | {} | {} | {} | {:.1f} | {} | {:.2f} |\n", scenario.name, scenario.seed,
                   wordOf(hidden), counts.starts, counts.lost, counts.windows, 100.0 * counts.share(),
                   counts.wrong_at_the_end, counts.longest_s);
        std::fflush(stdout);
      }
    }
  }
  return good ? 0 : 1;
}

}  // namespace evical::benchmarks::board_starts
