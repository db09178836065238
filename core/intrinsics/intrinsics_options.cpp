#include "core/intrinsics/intrinsics_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kIntrinsicsFields{
    Choice{"model", &IntrinsicsOptions::model, IntrinsicsModel::Automatic,
           std::array{"automatic", "pinhole_radtan", "pinhole_equidistant", "double_sphere", "eucm",
                      "omni_radtan"},
           "Lens model; automatic takes equidistant only where it explains the views clearly better, and "
           "double sphere "
           "where neither of both fits.",
           Level::Public},
    Field{"equidistant_gain", &IntrinsicsOptions::equidistant_gain, 0.85, within(0.1, 1.0), "",
          "Clearly better: residuals smaller than this times those of radial-tangential."},
    Field{"double_sphere_gain", &IntrinsicsOptions::double_sphere_gain, 0.85, within(0.1, 1.0), "",
          "The same of double sphere against the better of both, where circles that a model leaves out count "
          "too."},
    Field{"radtan_coefficients", &IntrinsicsOptions::radtan_coefficients, 4, within(4, 5), "",
          "4: k1 k2 p1 p2; 5: k3 as well, for strong distortion.", Level::Public},
    Field{"first_look_period_s", &IntrinsicsOptions::first_look_period_s, 1.2, within(0.1, 60.0), "s",
          "Slices of the recording are looked at so far apart for a first, rough lens."},
    Field{"first_look_length_s", &IntrinsicsOptions::first_look_length_s, 0.2, within(0.1, 2.0), "s",
          "Duration of a slice."},
    Field{"first_look_slices", &IntrinsicsOptions::first_look_slices, 20, within(1, 1000), "",
          "The first look ends after so many slices with the board in view."},
    Field{"first_look_projection_px", &IntrinsicsOptions::first_look_projection_px, 0.2, within(1e-3, 100.0),
          "px", "It ends before that when the projection is known so well, RMS over the image."},
    Field{"least_views", &IntrinsicsOptions::least_views, 10, within(3, 1000), "",
          "With fewer views nothing is said.", Level::Expert},
    Field{"most_views", &IntrinsicsOptions::most_views, 80, within(3, 1000), "",
          "Views that are taken, spread over image and tilt.", Level::Expert},
    Field{"least_view_spacing_s", &IntrinsicsOptions::least_view_spacing_s, 0.1, within(0.0, 10.0), "s",
          "Views nearer in time say the same again."},
    Field{"least_circles", &IntrinsicsOptions::least_circles, 0.5, within(0.1, 1.0), "",
          "Part of the board's circles that a view must show."},
    Field{"huber_sigma", &IntrinsicsOptions::huber_sigma, 2.5, within(0.5, 100.0), "sigma",
          "Circles further from their place pull with constant force."},
    Field{"outlier_sigma", &IntrinsicsOptions::outlier_sigma, 6.0, within(2.0, 1000.0), "sigma",
          "Circles further from their place, in units of the spread of all, are dropped."},
    Field{"outlier_view_fraction", &IntrinsicsOptions::outlier_view_fraction, 0.5, within(0.1, 1.0), "",
          "A view is dropped if more than this share of its circles is."},
    Field{"least_centre_sigma_px", &IntrinsicsOptions::least_centre_sigma_px, 0.01, within(0.0, 10.0), "px",
          "Added in squares to the covariance of each measured centre."},
    Field{"edge_lead_sigma_px", &IntrinsicsOptions::edge_lead_sigma_px, 0.5, within(1e-6, 10.0), "px",
          "Prior on the lead of measured centres along their image motion, around 0."},
    Field{"correlation_time_s", &IntrinsicsOptions::correlation_time_s, 0.2, within(0.0, 10.0), "s",
          "Views nearer in time than this may have errors in common; the sigmas allow for it."},
    Field{"place_error_px", &IntrinsicsOptions::place_error_px, 0.003, within(0.0, 1.0), "px",
          "What all views may err alike at a place in the image, an eighth by a sixth of it; the sigmas "
          "allow for it."},
    Field{"max_iterations", &IntrinsicsOptions::max_iterations, 60, within(1, 1000), "",
          "Iterations of one solve."},
    Field{"most_passes", &IntrinsicsOptions::most_passes, 4, within(1, 20), "",
          "Circles are refitted in undistorted pixels at most this often."},
    Field{"settled_px", &IntrinsicsOptions::settled_px, 0.01, within(1e-4, 1.0), "px",
          "Passes end when one more would move the projection, RMS over the image, by less."},
    Field{"needed_focal_length", &IntrinsicsOptions::needed_focal_length, 0.005, within(1e-5, 1.0), "",
          "Relative sigma of the focal length beyond which the result is doubtful.", Level::Public},
    Field{"needed_projection_px", &IntrinsicsOptions::needed_projection_px, 0.5, within(1e-3, 100.0), "px",
          "Projection uncertainty, RMS over the image, beyond which the result is doubtful.", Level::Public},
    Field{"least_tilt_deg", &IntrinsicsOptions::least_tilt_deg, 12.0, within(0.0, 80.0), "deg",
          "Without any views tilted more than this the focal length is not observable."}};
constexpr auto kIntrinsicsDefaults = defaultsOf<IntrinsicsOptions, kIntrinsicsFields>();

}  // namespace

IntrinsicsOptions::IntrinsicsOptions() : IntrinsicsOptions(kIntrinsicsDefaults) {}

const OptionTable<IntrinsicsOptions>& IntrinsicsOptions::table() {
  static const OptionTable<IntrinsicsOptions> table(
      kIntrinsicsFields,
      Ordered{&IntrinsicsOptions::first_look_length_s, &IntrinsicsOptions::first_look_period_s},
      Ordered{&IntrinsicsOptions::least_views, &IntrinsicsOptions::most_views});
  return table;
}

}  // namespace evical
