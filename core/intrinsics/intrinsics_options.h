// What camera intrinsics from events let people choose.
#pragma once

#include "core/base/option_field.h"

namespace evical {

enum class IntrinsicsModel { Automatic, PinholeRadtan, PinholeEquidistant };

struct IntrinsicsOptions {
  IntrinsicsModel model = IntrinsicsModel::Automatic;
  double equidistant_gain = 0.85;
  int radtan_coefficients = 4;
  double first_look_period_s = 1.2;
  double first_look_length_s = 0.2;
  int first_look_slices = 20;
  double first_look_projection_px = 0.2;
  int least_views = 10;
  int most_views = 80;
  double least_view_spacing_s = 0.1;
  double least_circles = 0.5;
  double huber_sigma = 2.5;
  double outlier_sigma = 6.0;
  double outlier_view_fraction = 0.5;
  double least_centre_sigma_px = 0.01;
  double edge_lead_sigma_px = 0.5;
  double rest_speed_px_s = 5.0;
  double correlation_time_s = 0.2;
  int max_iterations = 60;
  int most_passes = 4;
  double settled_px = 0.01;
  double needed_focal_length = 0.005;
  double needed_projection_px = 0.5;
  double least_tilt_deg = 12.0;

  bool operator==(const IntrinsicsOptions&) const = default;
};

inline constexpr auto kIntrinsicsFields = std::tuple{
    Choice{"model", &IntrinsicsOptions::model,
           std::array{"automatic", "pinhole_radtan", "pinhole_equidistant"},
           "Distortion model; automatic takes equidistant only where it explains the views clearly better."},
    Field{"equidistant_gain", &IntrinsicsOptions::equidistant_gain, 0.1, 1.0, "",
          "Clearly better: residuals smaller than this times those of radial-tangential."},
    Field{"radtan_coefficients", &IntrinsicsOptions::radtan_coefficients, 4, 5, "",
          "4: k1 k2 p1 p2; 5: k3 as well, for strong distortion."},
    Field{"first_look_period_s", &IntrinsicsOptions::first_look_period_s, 0.1, 60.0, "s",
          "Slices of the recording are looked at so far apart for a first, rough lens."},
    Field{"first_look_length_s", &IntrinsicsOptions::first_look_length_s, 0.1, 2.0, "s",
          "Duration of a slice."},
    Field{"first_look_slices", &IntrinsicsOptions::first_look_slices, 1, 1000, "",
          "The first look ends after so many slices with the board in view."},
    Field{"first_look_projection_px", &IntrinsicsOptions::first_look_projection_px, 1e-3, 100.0, "px",
          "It ends before that when the projection is known so well, RMS over the image."},
    Field{"least_views", &IntrinsicsOptions::least_views, 3, 1000, "", "With fewer views nothing is said."},
    Field{"most_views", &IntrinsicsOptions::most_views, 3, 1000, "",
          "Views that are taken, spread over image and tilt."},
    Field{"least_view_spacing_s", &IntrinsicsOptions::least_view_spacing_s, 0.0, 10.0, "s",
          "Views nearer in time say the same again."},
    Field{"least_circles", &IntrinsicsOptions::least_circles, 0.1, 1.0, "",
          "Part of the board's circles that a view must show."},
    Field{"huber_sigma", &IntrinsicsOptions::huber_sigma, 0.5, 100.0, "sigma",
          "Circles further from their place pull with constant force."},
    Field{"outlier_sigma", &IntrinsicsOptions::outlier_sigma, 2.0, 1000.0, "sigma",
          "Circles further from their place, in units of the spread of all, are dropped."},
    Field{"outlier_view_fraction", &IntrinsicsOptions::outlier_view_fraction, 0.1, 1.0, "",
          "A view is dropped if more than this share of its circles is."},
    Field{"least_centre_sigma_px", &IntrinsicsOptions::least_centre_sigma_px, 0.0, 10.0, "px",
          "Added in squares to the covariance of each measured centre."},
    Field{"edge_lead_sigma_px", &IntrinsicsOptions::edge_lead_sigma_px, 1e-6, 10.0, "px",
          "Prior on the lead of measured centres along their image motion, around 0."},
    Field{"rest_speed_px_s", &IntrinsicsOptions::rest_speed_px_s, 0.1, 1000.0, "px/s",
          "Below this image speed the edge lead fades to 0."},
    Field{"correlation_time_s", &IntrinsicsOptions::correlation_time_s, 0.0, 10.0, "s",
          "Views nearer in time than this may have errors in common; the sigmas allow for it."},
    Field{"max_iterations", &IntrinsicsOptions::max_iterations, 1, 1000, "", "Iterations of one solve."},
    Field{"most_passes", &IntrinsicsOptions::most_passes, 1, 20, "",
          "Circles are refitted in undistorted pixels at most this often."},
    Field{"settled_px", &IntrinsicsOptions::settled_px, 1e-4, 1.0, "px",
          "Passes end when one more would move the projection, RMS over the image, by less."},
    Field{"needed_focal_length", &IntrinsicsOptions::needed_focal_length, 1e-5, 1.0, "",
          "Relative sigma of the focal length beyond which the result is doubtful."},
    Field{"needed_projection_px", &IntrinsicsOptions::needed_projection_px, 1e-3, 100.0, "px",
          "Projection uncertainty, RMS over the image, beyond which the result is doubtful."},
    Field{"least_tilt_deg", &IntrinsicsOptions::least_tilt_deg, 0.0, 80.0, "deg",
          "Without any views tilted more than this the focal length is not observable."}};
static_assert(fieldCount<IntrinsicsOptions>() == std::tuple_size_v<decltype(kIntrinsicsFields)>);

}  // namespace evical
