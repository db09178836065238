#include "core/export/distortion_fit.h"

#include "core/base/error.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/lens_fit.h"

#include <fmt/format.h>

namespace evical {
namespace {

constexpr double kLargestError_px = 2.0;  // largest errors are in the corners; RMS is a fifth of them

bool hasThirdRadial(const CameraIntrinsics& camera) {
  return camera.model == CameraModel::PinholeRadtan && camera.distortion[4] != 0.0;
}

bool knows(const KnownModels& known, const CameraIntrinsics& camera) {
  switch (camera.model) {
    case CameraModel::PinholeRadtan:
      return known.radtan && (!hasThirdRadial(camera) || known.third_radial);
    case CameraModel::PinholeEquidistant:
      return known.equidistant;
    case CameraModel::DoubleSphere:
      return known.double_sphere;
    case CameraModel::Eucm:
      return known.eucm;
    case CameraModel::OmniRadtan:
      break;
  }
  return known.omni;
}

std::string lensName(const CameraIntrinsics& camera) {
  switch (camera.model) {
    case CameraModel::PinholeRadtan:
      return hasThirdRadial(camera) ? "radial-tangential distortion with k3" : "radial-tangential distortion";
    case CameraModel::PinholeEquidistant:
      return "equidistant distortion";
    default:
      return fmt::format("the model {}", cameraModelName(camera.model));
  }
}

// Equidistant models approximate wide lenses best.
LensFit nearestLens(const CameraIntrinsics& own, const KnownModels& known) {
  const bool radtan = own.model == CameraModel::PinholeRadtan;
  const CameraModel model = known.radtan && (radtan || !known.equidistant) ? CameraModel::PinholeRadtan
                                                                           : CameraModel::PinholeEquidistant;
  return fitLens(own, model, model == CameraModel::PinholeRadtan && known.third_radial ? 5 : 4);
}

}  // namespace

CameraIntrinsics cameraFor(const RigCamera& camera, const KnownModels& known, ExportNotes& notes) {
  const CameraIntrinsics& own = camera.intrinsics;
  if (knows(known, own)) return own;
  const LensFit fit = nearestLens(own, known);
  const std::string have = lensName(own);
  if (!(fit.worst_px <= kLargestError_px))
    throw badInput(
        fmt::format("result: cameras.{}.intrinsics", camera.name),
        std::isfinite(fit.worst_px)
            ? fmt::format(
                  "{} does not support {}, and its closest lens model has an error of up to {:.3g} px",
                  known.program, have, fit.worst_px)
            : fmt::format("{} does not support {}, and none of its lens models covers this field of view",
                          known.program, have),
        "Calibrate the intrinsics with a model that it supports");
  const bool to_radtan = fit.camera.model == CameraModel::PinholeRadtan;
  notes.push_back(fmt::format(
      "{}: {} does not support {}: refitted over the {} as {} with {} coefficients, error "
      "{:.2g} px RMS, {:.2g} px at most",
      camera.name, known.program, have, fit.whole_image ? "whole image" : "image up to 85 deg off the axis",
      to_radtan ? "radial-tangential" : "equidistant", to_radtan && known.third_radial ? 5 : 4, fit.rms_px,
      fit.worst_px));
  return fit.camera;
}

std::vector<double> distortionOf(const CameraIntrinsics& camera, int coefficients) {
  return {camera.distortion.begin(), camera.distortion.begin() + coefficients};
}

}  // namespace evical
