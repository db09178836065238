#include "core/egomotion/egomotion_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kEgomotionFields{
    Field{"window_s", &EgomotionOptions::window_s, 0.04, within(0.005, 0.5), "s",
          "Length of the event windows in which the camera's motion is estimated."},
    Field{"min_slopes", &EgomotionOptions::min_slopes, 200, within(20, 1000000), "",
          "Smallest number of edges with a speed in an event window."},
    Field{"max_slopes", &EgomotionOptions::max_slopes, 2000, within(20, 1000000), "",
          "Largest number of edges in an event window's fit; of more, every second, third, ... is used."},
    Field{"time_noise_s", &EgomotionOptions::time_noise_s, 3e-4, within(0.0, 0.1), "s",
          "Sigma of the time at which a fast edge passes a pixel."},
    Field{"place_noise_px", &EgomotionOptions::place_noise_px, 0.15, within(0.001, 5.0), "px",
          "Sigma of the position of slow edges."},
    Field{"depth_columns", &EgomotionOptions::depth_columns, 6, within(1, 64), "",
          "Columns of image patches, each with its own depth."},
    Field{"depth_rows", &EgomotionOptions::depth_rows, 5, within(1, 64), "",
          "Rows of image patches, each with its own depth."},
    Field{"depth_spread", &EgomotionOptions::depth_spread, 0.5, within(0.01, 3.0), "",
          "Sigma of the logarithm of patches' depths, about their mean."},
    Field{"depth_error", &EgomotionOptions::depth_error, 0.8, within(0.0, 3.0), "",
          "Sigma of the logarithm of depths within a patch; reduces the weight of translational motion."},
    Field{"min_inliers", &EgomotionOptions::min_inliers, 0.5, within(0.1, 1.0), "",
          "Smallest share of an event window's edges that its motion explains."},
    Field{"min_speed_px_s", &EgomotionOptions::min_speed_px_s, 5.0, within(0.1, 1e4), "px/s",
          "Smallest median speed of the image in a used event window."},
    Field{"max_sigma_rad_s", &EgomotionOptions::max_sigma_rad_s, 0.5, within(1e-4, 100.0), "rad/s",
          "Largest sigma of the rotation rate in the best direction; other event windows are excluded."},
    Field{"kept_windows", &EgomotionOptions::kept_windows, 1500, within(50, 1000000), "",
          "Largest number of event windows in the joint fit; of more, every second, fourth, ... is used."},
    Field{"kept_slopes", &EgomotionOptions::kept_slopes, 1000, within(20, 1000000), "",
          "Largest number of edges per event window in the joint fit."},
    Field{"velocity_weight", &EgomotionOptions::velocity_weight, 3.0, within(0.0, 1e4), "",
          "Weight of the prior that a window's velocity is as large as those of all windows, in units of one "
          "velocity."},
    Field{"lever_sigma", &EgomotionOptions::lever_sigma, 0.1, within(1e-4, 10.0), "",
          "Sigma of the lever arm between camera and IMU, relative to the scene's depth."},
    Field{"shared_slopes", &EgomotionOptions::shared_slopes, 12.0, within(1.0, 1000.0), "",
          "Number of edges that share most of their neighbourhood; a window's sigmas are multiplied by its "
          "square root."},
    Field{"far_sigmas", &EgomotionOptions::far_sigmas, 6.0, within(2.0, 100.0), "",
          "Largest difference between an event window's and the IMU's rotation rate; other windows are "
          "excluded."},
    Field{"depths_left", &EgomotionOptions::depths_left, 1.0, within(0.0, 10.0), "",
          "Share of the change with half as many patches that is added to the sigmas, for the error of the "
          "depth "
          "model."},
    Field{"translation_left", &EgomotionOptions::translation_left, 0.15, within(0.0, 1.0), "",
          "Share of the change without translation in the model that is added to the sigmas."},
    Field{"block_s", &EgomotionOptions::block_s, 3.0, within(0.1, 100.0), "s",
          "Length of the blocks of the recording whose scatter determines the sigmas."},
    Field{"min_blocks", &EgomotionOptions::min_blocks, 6, within(3, 1000), "",
          "Smallest number of blocks with event windows for a result."},
    Field{"search_s", &EgomotionOptions::search_s, 1.0, within(0.0, 60.0), "s",
          "Search range of the time offset, to either side of the old one."}};
constexpr auto kEgomotionDefaults = defaultsOf<EgomotionOptions, kEgomotionFields>();

}  // namespace

EgomotionOptions::EgomotionOptions() : EgomotionOptions(kEgomotionDefaults) {}

const OptionTable<EgomotionOptions>& EgomotionOptions::table() {
  static const OptionTable<EgomotionOptions> table(
      kEgomotionFields, Ordered{&EgomotionOptions::min_slopes, &EgomotionOptions::max_slopes});
  return table;
}

}  // namespace evical
