#include "core/pipeline/lens/joint_intrinsics.h"

#include "core/data/quantity.h"
#include "core/intrinsics/intrinsics_checks.h"
#include "core/intrinsics/intrinsics_uncertainty.h"

namespace evical {

IntrinsicsResult jointIntrinsics(const IntrinsicsResult& first, std::size_t camera,
                                 const CameraIntrinsics& solved, const UncertaintyReport& report,
                                 const IntrinsicsOptions& options) {
  const Eigen::MatrixXd covariance = intrinsicsCovariance(report, camera);
  if (covariance.size() == 0) return first;
  IntrinsicsResult joint = first;
  joint.intrinsics = solved;
  joint.covariance.setZero();
  joint.covariance.topLeftCorner(covariance.rows(), covariance.cols()) = covariance;
  setSigmas(joint.intrinsics, joint.covariance, joint.image);
  constexpr bool kConverged = true;  // otherwise the whole calibration is doubtful already
  judge(kConverged, options, joint);
  return joint;
}

}  // namespace evical
