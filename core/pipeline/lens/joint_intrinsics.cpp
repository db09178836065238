#include "core/pipeline/lens/joint_intrinsics.h"

#include "core/intrinsics/intrinsics_checks.h"
#include "core/intrinsics/intrinsics_uncertainty.h"

#include <algorithm>

namespace evical {

IntrinsicsResult jointIntrinsics(const IntrinsicsResult& first, const std::string& camera,
                                 const CameraIntrinsics& solved, const UncertaintyReport& report,
                                 const IntrinsicsOptions& options) {
  const auto name = std::find(report.names.begin(), report.names.end(), camera + ".focal_length.x [px]");
  if (name == report.names.end()) return first;
  const Eigen::Index begin = name - report.names.begin();
  const std::string of_camera = camera + ".";
  Eigen::Index count = 4;  // and the coefficients that are free
  while (count < kIntrinsicsCount && begin + count < static_cast<Eigen::Index>(report.names.size()) &&
         report.names[static_cast<std::size_t>(begin + count)].starts_with(of_camera + "distortion."))
    ++count;
  IntrinsicsResult joint = first;
  joint.intrinsics = solved;
  joint.covariance.setZero();
  const Eigen::VectorXd sigmas = report.standard_deviations.segment(begin, count);
  joint.covariance.topLeftCorner(count, count) =
      sigmas.asDiagonal() * report.correlation.block(begin, begin, count, count) * sigmas.asDiagonal();
  setSigmas(joint.intrinsics, joint.covariance, joint.image);
  constexpr bool kConverged = true;  // else the whole calibration is doubtful for that
  judge(kConverged, options, joint);
  return joint;
}

}  // namespace evical
