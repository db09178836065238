#include "core/egomotion/egomotion_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kEgomotionFields{
    Field{"window_s", &EgomotionOptions::window_s, 0.04, within(0.005, 0.5), "s",
          "Length of the windows in each of which the camera's motion is estimated."},
    Field{"least_slopes", &EgomotionOptions::least_slopes, 200, within(20, 1000000), "",
          "Edges with a speed that a window must have."},
    Field{"most_slopes", &EgomotionOptions::most_slopes, 2000, within(20, 1000000), "",
          "Of more only every second, third ... edge is taken: further ones tell little more."},
    Field{"time_noise_s", &EgomotionOptions::time_noise_s, 3e-4, within(0.0, 0.1), "s",
          "Sigma of the time at which an edge passes a pixel, of fast edges."},
    Field{"place_noise_px", &EgomotionOptions::place_noise_px, 0.15, within(0.001, 5.0), "px",
          "The same of slow edges, as a distance."},
    Field{"depth_columns", &EgomotionOptions::depth_columns, 6, within(1, 64), "",
          "Columns of patches of the image that have a depth of their own."},
    Field{"depth_rows", &EgomotionOptions::depth_rows, 5, within(1, 64), "", "Rows of them."},
    Field{"depth_spread", &EgomotionOptions::depth_spread, 0.5, within(0.01, 3.0), "",
          "Sigma of the logarithm of patches' depths, about their mean."},
    Field{"depth_error", &EgomotionOptions::depth_error, 0.8, within(0.0, 3.0), "",
          "Sigma of the same within a patch: edges that move by translation tell less."},
    Field{"least_inliers", &EgomotionOptions::least_inliers, 0.5, within(0.1, 1.0), "",
          "Part of a window's edges that its motion must explain."},
    Field{"least_speed_px_s", &EgomotionOptions::least_speed_px_s, 5.0, within(0.1, 1e4), "px/s",
          "Windows in which the image moves less, by the median, tell nothing."},
    Field{"largest_sigma_rad_s", &EgomotionOptions::largest_sigma_rad_s, 0.5, within(1e-4, 100.0), "rad/s",
          "Windows that know their rotation less well in all directions are left out."},
    Field{"kept_windows", &EgomotionOptions::kept_windows, 1500, within(50, 1000000), "",
          "Windows whose edges the last fit asks again; of longer recordings every second, fourth ..."},
    Field{"kept_slopes", &EgomotionOptions::kept_slopes, 1000, within(20, 1000000), "",
          "Edges of each of them."},
    Field{"velocity_weight", &EgomotionOptions::velocity_weight, 3.0, within(0.0, 1e4), "",
          "Windows' velocities are expected to be as large as those of all, with so many times the weight of "
          "one velocity."},
    Field{"lever_sigma", &EgomotionOptions::lever_sigma, 0.1, within(1e-4, 10.0), "",
          "Sigma of what is not known of the lever arm between camera and IMU, over the scene's depth."},
    Field{"shared_slopes", &EgomotionOptions::shared_slopes, 12.0, within(1.0, 1000.0), "",
          "Edges that have most of their neighbours in common: a window's sigmas are wider by its root."},
    Field{"far_sigmas", &EgomotionOptions::far_sigmas, 6.0, within(2.0, 100.0), "",
          "Windows whose turning is further from the IMU's are left out."},
    Field{"depths_left", &EgomotionOptions::depths_left, 1.0, within(0.0, 10.0), "",
          "Part of what half as many patches change that is added to the sigmas: depths are never known "
          "everywhere."},
    Field{"translation_left", &EgomotionOptions::translation_left, 0.15, within(0.0, 1.0), "",
          "The same of what changes where all motion of the image is taken as turning."},
    Field{"block_s", &EgomotionOptions::block_s, 3.0, within(0.1, 100.0), "s",
          "Sigmas are those of the scatter between blocks of the recording that are so long."},
    Field{"least_blocks", &EgomotionOptions::least_blocks, 6, within(3, 1000), "",
          "Blocks with windows, below which nothing is told."},
    Field{"search_s", &EgomotionOptions::search_s, 1.0, within(0.0, 60.0), "s",
          "The time offset is looked for within this to either side of the old one."}};
constexpr auto kEgomotionDefaults = defaultsOf<EgomotionOptions, kEgomotionFields>();

}  // namespace

EgomotionOptions::EgomotionOptions() : EgomotionOptions(kEgomotionDefaults) {}

const OptionTable<EgomotionOptions>& EgomotionOptions::table() {
  static const OptionTable<EgomotionOptions> table(
      kEgomotionFields, Ordered{&EgomotionOptions::least_slopes, &EgomotionOptions::most_slopes});
  return table;
}

}  // namespace evical
