#include "core/synthetic/frame_simulator.h"

#include "core/base/time.h"
#include "core/geometry/camera_model.h"
#include "core/synthetic/board_pattern.h"
#include "core/synthetic/clutter_texture.h"
#include "core/synthetic/random.h"
#include "core/synthetic/sinusoid_motion.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

namespace evical {
namespace {

constexpr int kExposures = 3;     // moments within one
constexpr int kSide = 9;          // of the grid of places that make a pixel at an edge
constexpr float kReach = 2.3f;    // of that grid, in sigmas of the blur
constexpr double kWhite = 235.0;  // what white paper gives, of 255

using RayPerPixel = Eigen::Matrix<float, 3, 2>;

// How a ray of length 1 moves with its pixel; it stays of that length.
RayPerPixel rayPerPixel(const CameraIntrinsics& lens, const Eigen::Vector3d& ray) {
  Eigen::Matrix<double, 2, 3> by_ray;
  if (!project(lens, ray, &by_ray)) return RayPerPixel::Zero();
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = ray.unitOrthogonal();
  across.col(1) = ray.cross(across.col(0));
  return (across * (by_ray * across).inverse()).cast<float>();
}

// Ray to plane, and how that moves with the pixel.
struct Place {
  Eigen::Vector2f at_m;
  Eigen::Matrix2f per_px;
  bool ahead = false;
};

Place placeOn(const Eigen::Matrix3f& plane_from_ray, const Eigen::Vector3f& ray,
              const RayPerPixel& ray_per_px) {
  const Eigen::Vector3f h = plane_from_ray * ray;
  Place place;
  place.ahead = h.z() > 0.0f;
  if (!place.ahead) return place;
  place.at_m = h.hnormalized();
  place.per_px = (plane_from_ray.topRows<2>() - place.at_m * plane_from_ray.row(2)) / h.z() * ray_per_px;
  return place;
}

class FrameRenderer {
 public:
  FrameRenderer(const Scenario& scenario, std::size_t index)
      : scenario_(scenario),
        index_(index),
        camera_(scenario.cameras[index]),
        motion_(scenario),
        pattern_(scenario.board),
        blur_px_(
            static_cast<float>(std::sqrt(camera_.frames->blur_px * camera_.frames->blur_px + 1.0 / 12.0))),
        texture_({scenario.seed, scenario.scene.clutter_contrast, scenario.scene.clutter_object_share,
                  blur_px_ * texelsPerPixel()}) {
    const CameraIntrinsics& lens = camera_.intrinsics;
    for (int y = 0; y < lens.resolution_px.height_px; ++y) {
      for (int x = 0; x < lens.resolution_px.width_px; ++x) {
        const auto ray =
            unprojectRay(lens, Eigen::Vector2d(x, y));  // none: dark, as beyond a fisheye's circle
        rays_.push_back(ray.value_or(Eigen::Vector3d::Zero()).cast<float>());
        ray_per_px_.push_back(ray ? rayPerPixel(lens, *ray) : RayPerPixel::Zero());
      }
    }
    const double px_per_m =
        idealFocalLength_px(lens).x() / (scenario.motion.distance_m + scenario.scene.clutter_distance_m);
    texels_per_m_ = static_cast<float>(texelsPerPixel() * px_per_m);
    placeWeights();
  }

  // The pixels of a row of the frame whose middle is exposed at this time on the reference's clock.
  void render(int row, double time_s, Random& noise, std::uint8_t* pixels) const {
    const FrameModel& model = *camera_.frames;
    const Resolution& size = camera_.intrinsics.resolution_px;
    const double row_s = time_s + 1e-6 * model.line_delay_us * (row - 0.5 * (size.height_px - 1));
    std::array<Eigen::Matrix3f, kExposures> board, behind;
    for (std::size_t k = 0; k < kExposures; ++k) {
      const double share = (static_cast<double>(k) + 0.5) / kExposures - 0.5;
      const RigidTransform camera_from_world =
          inverse(motion_.worldFromCamera(index_, row_s + share * model.exposure_s));
      board[k] = planeFromRay(camera_from_world, 0.0);
      behind[k] = planeFromRay(camera_from_world, scenario_.scene.clutter_distance_m);
    }
    for (int x = 0; x < size.width_px; ++x) {
      const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(size.width_px) +
                     static_cast<std::size_t>(x);
      float light = 0.0f;
      for (std::size_t k = 0; k < kExposures; ++k) light += lightOf(i, board[k], behind[k]) / kExposures;
      const double value = kWhite / scenario_.scene.bright_reflectance * light + model.noise * noise.normal();
      pixels[x] = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
    }
  }

 private:
  double texelsPerPixel() const {
    constexpr double kTexelsOfDetail = 2.0;
    return kTexelsOfDetail / scenario_.scene.clutter_detail_px;
  }

  void placeWeights() {
    float sum = 0.0f;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const Eigen::Vector2f at =
            2.0f * kReach / (kSide - 1) * Eigen::Vector2f(x, y) - Eigen::Vector2f::Constant(kReach);
        offsets_px_.push_back(blur_px_ * at);
        weights_.push_back(std::exp(-0.5f * at.squaredNorm()));
        sum += weights_.back();
      }
    }
    for (float& weight : weights_) weight /= sum;
  }

  static Eigen::Matrix3f planeFromRay(const RigidTransform& camera_from_world, double depth_m) {
    const Eigen::Matrix3d r = camera_from_world.rotation.toRotationMatrix();
    Eigen::Matrix3d h;
    h << r.col(0), r.col(1), camera_from_world.translation_m + depth_m * r.col(2);
    return h.inverse().cast<float>();
  }

  bool onSheet(const Eigen::Vector2f& p) const {
    const auto margin = static_cast<float>(scenario_.scene.margin_m);
    return (p.array() > pattern_.low_m().array() - margin).all() &&
           (p.array() < pattern_.high_m().array() + margin).all();
  }

  // 0: behind the sheet, 1: its paper, 2: its ink.
  int shadeAt(const Eigen::Vector2f& p) const { return onSheet(p) ? (pattern_.isInk(p) ? 2 : 1) : 0; }

  float lightOf(std::size_t pixel, const Eigen::Matrix3f& board, const Eigen::Matrix3f& behind) const {
    const Place place = placeOn(board, rays_[pixel], ray_per_px_[pixel]);
    std::array<float, 3> shares = {1.0f, 0.0f, 0.0f};
    if (place.ahead) shares = sharesOf(place);
    const SceneModel& scene = scenario_.scene;
    const bool dark = scenario_.board.circles == CircleShade::Dark;
    const auto paper = static_cast<float>(dark ? scene.bright_reflectance : scene.dark_reflectance);
    const auto ink = static_cast<float>(dark ? scene.dark_reflectance : scene.bright_reflectance);
    const float background = shares[0] > 0.0f ? backgroundOf(pixel, behind) : 0.0f;
    return shares[0] * background + shares[1] * paper + shares[2] * ink;
  }

  std::array<float, 3> sharesOf(const Place& place) const {
    std::array<float, 3> shares = {};
    const int middle = shadeAt(place.at_m);
    const float reach = kReach * blur_px_;
    bool same = true;
    for (const auto& [x, y] : kAround)
      same = same && shadeAt(place.at_m + place.per_px * Eigen::Vector2f(reach * x, reach * y)) == middle;
    if (same) {
      shares[static_cast<std::size_t>(middle)] = 1.0f;
      return shares;
    }
    for (std::size_t k = 0; k < offsets_px_.size(); ++k)
      shares[static_cast<std::size_t>(shadeAt(place.at_m + place.per_px * offsets_px_[k]))] += weights_[k];
    return shares;
  }

  float backgroundOf(std::size_t pixel, const Eigen::Matrix3f& behind) const {
    constexpr float kMiddle = 0.25f;  // reflectance
    const Eigen::Vector3f h = behind * rays_[pixel];
    if (!(h.z() > 0.0f)) return kMiddle;
    const Eigen::Vector2f at = texels_per_m_ * h.hnormalized();
    return std::min(1.0f, kMiddle * std::exp(texture_(at.x(), at.y())));
  }

  static constexpr std::array<std::array<float, 2>, 12> kAround = {{{1, 0},
                                                                    {-1, 0},
                                                                    {0, 1},
                                                                    {0, -1},
                                                                    {0.7f, 0.7f},
                                                                    {-0.7f, 0.7f},
                                                                    {0.7f, -0.7f},
                                                                    {-0.7f, -0.7f},
                                                                    {0.5f, 0},
                                                                    {-0.5f, 0},
                                                                    {0, 0.5f},
                                                                    {0, -0.5f}}};

  const Scenario& scenario_;
  std::size_t index_;
  const SimulatedCamera& camera_;
  SinusoidMotion motion_;
  BoardPattern pattern_;
  float blur_px_;
  ClutterTexture texture_;
  float texels_per_m_ = 1.0f;
  std::vector<Eigen::Vector3f> rays_;
  std::vector<RayPerPixel> ray_per_px_;
  std::vector<Eigen::Vector2f> offsets_px_;
  std::vector<float> weights_;
};

}  // namespace

void simulateFrames(const Scenario& scenario, std::size_t index,
                    const std::function<void(const Frame&)>& sink, const RunContext& context, int threads) {
  constexpr std::uint64_t kNoiseStream = 0xf0u;
  const FrameRenderer renderer(scenario, index);
  const SimulatedCamera& camera = scenario.cameras[index];
  const Resolution& size = camera.intrinsics.resolution_px;
  const auto width = static_cast<std::size_t>(size.width_px);
  Frame frame;
  frame.size_px = size;
  frame.row_bytes = width;
  frame.exposure_s = camera.frames->exposure_s;
  frame.bytes.resize(width * static_cast<std::size_t>(size.height_px));
  const double interval_s = 1.0 / camera.frames->rate_hz;
  for (std::uint64_t k = 0; (static_cast<double>(k) + 0.5) * interval_s < scenario.duration_s; ++k) {
    context.throwIfStopped();
    const double time_s = (static_cast<double>(k) + 0.5) * interval_s;
    std::atomic<int> next = 0;
    const auto work = [&] {
      for (int row = next++; row < size.height_px; row = next++) {
        Random noise(scenario.seed, kNoiseStream + index,
                     k * static_cast<std::uint64_t>(size.height_px) + static_cast<std::uint64_t>(row));
        renderer.render(row, time_s, noise, frame.bytes.data() + static_cast<std::size_t>(row) * width);
      }
    };
    {
      std::vector<std::jthread> others;
      for (int worker = 1; worker < threads; ++worker) others.emplace_back(work);
      work();
    }
    frame.time_ns = scenario.start_ns + nanosecondsFrom(time_s - camera.time_offset_s);
    sink(frame);
  }
}

}  // namespace evical
