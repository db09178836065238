#include "core/optimisation/uncertainty/covariance.h"

#include "core/numerics/dense.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/calibration_problem.h"
#include "core/optimisation/known_values.h"
#include "core/optimisation/uncertainty/credible_information.h"
#include "core/optimisation/uncertainty/drift_uncertainty.h"
#include "core/optimisation/uncertainty/observability.h"
#include "core/optimisation/uncertainty/projected_information.h"
#include "core/optimisation/uncertainty/scale_check.h"
#include "core/optimisation/uncertainty/turned_gyroscope.h"
#include "core/optimisation/uncertainty/uncertainty_report.h"

namespace evical {

UncertaintyEstimate estimateUncertainty(const CalibrationInput& input, const BatchSolution& solution,
                                        const OptimisationOptions& options, const RunContext& context) {
  context.throwIfStopped();
  // With gyroscopes free to turn, so that one that is turned is noticed where that is not estimated.
  OptimisationOptions free_to_turn = options;
  free_to_turn.gyroscope_rotation = true;
  CalibrationProblem problem(input, free_to_turn, solution.state);
  problem.build(lastStage(options), {solution.scales, solution.used_circles, solution.used_samples,
                                     std::vector<StillAxes>(input.imus.size())});
  ProjectedInformation information = projectInformation(problem, options.correlation_time_s, context);
  context.throwIfStopped();
  UncertaintyEstimate estimate;
  if (!options.gyroscope_rotation) {
    estimate.turned_gyroscopes = turnedGyroscopes(input, information, withoutNoise(information), options);
    information = withoutLookedForRotation(input, std::move(information));
  }
  information = withoutNoise(std::move(information));
  const Eigen::MatrixXd report_from_tangent =
      reportFromTangent(information, solution.state, problem.problem());
  const QuantityCovariance covariance = quantityCovariance(information, report_from_tangent);
  estimate.report = makeReport(input, covariance);
  estimate.report.given = givenQuantities(input, options);
  const Eigen::MatrixXd tangent_from_report = inverseOf(report_from_tangent);
  reportDrift(information, problem.driftBlocks(), congruence(tangent_from_report, covariance.covariance),
              estimate.report);
  ScaleCheck scale = checkScale(input, solution.state, covariance, options);
  estimate.scale_doubt = std::move(scale.doubt);
  estimate.notes = std::move(scale.notes);
  const Observability observability =
      judgeObservability(input, solution.state, covariance, withScaleKnown(covariance), options);
  estimate.report.observability = observability.eigenvalues;
  estimate.report.weakest = observability.weakest;
  estimate.status = observability.status;
  estimate.reason = observability.reason;
  return estimate;
}

}  // namespace evical
