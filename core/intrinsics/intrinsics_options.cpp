#include "core/intrinsics/intrinsics_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kIntrinsicsFields{
    Choice{"model", &IntrinsicsOptions::model, IntrinsicsModel::Automatic,
           std::array{"automatic", "pinhole_radtan", "pinhole_equidistant", "double_sphere", "eucm",
                      "omni_radtan"},
           "Lens model; automatic: radial-tangential unless equidistant fits clearly better, or double "
           "sphere if "
           "neither fits.",
           Level::Public},
    Field{"equidistant_gain", &IntrinsicsOptions::equidistant_gain, 0.85, within(0.1, 1.0), "",
          "Largest ratio of equidistant to radial-tangential residuals that counts as clearly better."},
    Field{"double_sphere_gain", &IntrinsicsOptions::double_sphere_gain, 0.85, within(0.1, 1.0), "",
          "The same ratio for double sphere and the better of both; circles that a model excludes count as "
          "misfits."},
    Field{"radtan_coefficients", &IntrinsicsOptions::radtan_coefficients, 4, within(4, 5), "",
          "Radial-tangential coefficients: 4 for k1 k2 p1 p2; 5 with k3, for strong distortion.",
          Level::Public},
    Field{"first_look_period_s", &IntrinsicsOptions::first_look_period_s, 1.2, within(0.1, 60.0), "s",
          "Interval between the slices of the recording for a first, approximate lens."},
    Field{"first_look_length_s", &IntrinsicsOptions::first_look_length_s, 0.2, within(0.1, 2.0), "s",
          "Duration of a slice of the first look."},
    Field{"first_look_slices", &IntrinsicsOptions::first_look_slices, 20, within(1, 1000), "",
          "Largest number of slices with the board in the first look."},
    Field{"first_look_projection_px", &IntrinsicsOptions::first_look_projection_px, 0.2, within(1e-3, 100.0),
          "px", "Projection uncertainty, RMS over the image, at which the first look ends."},
    Field{"min_views", &IntrinsicsOptions::min_views, 10, within(3, 1000), "",
          "Smallest number of views for a result.", Level::Expert},
    Field{"max_views", &IntrinsicsOptions::max_views, 80, within(3, 1000), "",
          "Largest number of used views, spread over image and tilt.", Level::Expert},
    Field{"min_view_spacing_s", &IntrinsicsOptions::min_view_spacing_s, 0.1, within(0.0, 10.0), "s",
          "Smallest interval between used views; closer ones are redundant."},
    Field{"min_circles", &IntrinsicsOptions::min_circles, 0.5, within(0.1, 1.0), "",
          "Smallest share of the board's circles in a view."},
    Field{"huber_sigma", &IntrinsicsOptions::huber_sigma, 2.5, within(0.5, 100.0), "sigma",
          "Huber threshold of a circle's error."},
    Field{"outlier_sigma", &IntrinsicsOptions::outlier_sigma, 6.0, within(2.0, 1000.0), "sigma",
          "Largest error of a used circle, in units of the spread of all errors."},
    Field{"outlier_view_fraction", &IntrinsicsOptions::outlier_view_fraction, 0.5, within(0.1, 1.0), "",
          "Largest share of rejected circles in a used view."},
    Field{"min_centre_sigma_px", &IntrinsicsOptions::min_centre_sigma_px, 0.01, within(0.0, 10.0), "px",
          "Sigma whose square is added to the covariance of each measured centre."},
    Field{"edge_localisation_bias_sigma_px", &IntrinsicsOptions::edge_localisation_bias_sigma_px, 0.5,
          within(1e-6, 10.0), "px",
          "Prior sigma of the lead of measured centres along their image motion, around 0."},
    Field{"correlation_time_s", &IntrinsicsOptions::correlation_time_s, 0.2, within(0.0, 10.0), "s",
          "Time over which errors of views are correlated; the sigmas allow for it."},
    Field{"place_error_px", &IntrinsicsOptions::place_error_px, 0.003, within(0.0, 1.0), "px",
          "Error common to all views within an eighth by a sixth of the image; the sigmas "
          "allow for it."},
    Field{"max_iterations", &IntrinsicsOptions::max_iterations, 60, within(1, 1000), "",
          "Largest number of iterations of one solution."},
    Field{"max_passes", &IntrinsicsOptions::max_passes, 4, within(1, 20), "",
          "Largest number of passes in which circles are refitted in undistorted pixels."},
    Field{"settled_px", &IntrinsicsOptions::settled_px, 0.01, within(1e-4, 1.0), "px",
          "Change of the projection by a pass, RMS over the image, below which passes end."},
    Field{"needed_focal_length", &IntrinsicsOptions::needed_focal_length, 0.005, within(1e-5, 1.0), "",
          "Required relative sigma of the focal length; above it the result is doubtful.", Level::Public},
    Field{"needed_projection_px", &IntrinsicsOptions::needed_projection_px, 0.5, within(1e-3, 100.0), "px",
          "Required projection uncertainty, RMS over the image; above it the result is doubtful.",
          Level::Public},
    Field{"min_tilt_deg", &IntrinsicsOptions::min_tilt_deg, 12.0, within(0.0, 80.0), "deg",
          "Largest tilt in all views below which the focal length is not observable."}};
constexpr auto kIntrinsicsDefaults = defaultsOf<IntrinsicsOptions, kIntrinsicsFields>();

}  // namespace

IntrinsicsOptions::IntrinsicsOptions() : IntrinsicsOptions(kIntrinsicsDefaults) {}

const OptionTable<IntrinsicsOptions>& IntrinsicsOptions::table() {
  static const OptionTable<IntrinsicsOptions> table(
      kIntrinsicsFields,
      Ordered{&IntrinsicsOptions::first_look_length_s, &IntrinsicsOptions::first_look_period_s},
      Ordered{&IntrinsicsOptions::min_views, &IntrinsicsOptions::max_views});
  return table;
}

}  // namespace evical
