#include "core/optimisation/uncertainty/covariance.h"

#include "core/numerics/dense.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/calibration_problem.h"
#include "core/optimisation/known_values.h"
#include "core/optimisation/uncertainty/change_test.h"
#include "core/optimisation/uncertainty/credible_information.h"
#include "core/optimisation/uncertainty/drift_uncertainty.h"
#include "core/optimisation/uncertainty/observability.h"
#include "core/optimisation/uncertainty/projected_information.h"
#include "core/optimisation/uncertainty/scale_check.h"
#include "core/optimisation/uncertainty/score_test.h"
#include "core/optimisation/uncertainty/shared_sensors.h"
#include "core/optimisation/uncertainty/uncertainty_report.h"

namespace evical {

UncertaintyEstimate estimateUncertainty(const CalibrationInput& input, const BatchSolution& solution,
                                        const OptimisationOptions& options, const RunContext& context) {
  context.throwIfStopped();
  const OptimisationOptions tested = freeToBeTested(options);
  CalibrationProblem problem(input, tested, solution.state);
  problem.build(lastStage(options), {solution.scales, solution.used_circles, solution.used_samples,
                                     std::vector<StillAxes>(input.imus.size())});
  ProjectedInformation information = projectInformation(problem, options.correlation_time_s, context);
  context.throwIfStopped();
  UncertaintyEstimate estimate;
  HeldDoubts held = testHeldValues(input, solution.state, information, options);
  estimate.turned_gyroscopes = std::move(held.gyroscopes);
  estimate.wandering_imus = std::move(held.wandering_imus);
  estimate.bent_board = std::move(held.board);
  estimate.wrong_lenses = std::move(held.lenses);
  estimate.rolling_shutters = std::move(held.shutters);
  information = withoutHeldValues(input, options, std::move(information));
  estimate.other_sensors = doubtOfSensors(input, solution.state, information, options);
  information = withSharedSensors(input, options, std::move(information));
  ChangeDoubt change = doubtOfChanges(input, information, options);
  if (change.sigmas > held.gyroscope_sigmas) estimate.change = std::move(change.doubt);
  information = withoutNoise(std::move(information));
  const Eigen::MatrixXd report_from_tangent =
      reportFromTangent(information, solution.state, problem.problem());
  const QuantityCovariance covariance =
      withPixelDelay(input, options, quantityCovariance(information, report_from_tangent));
  estimate.report = makeReport(input, covariance);
  estimate.as_weighed = covariance.as_weighed;
  reportSharedSensors(input, options, estimate.report);
  estimate.report.given = givenQuantities(input, options);
  const Eigen::MatrixXd tangent_from_report = inverseOf(report_from_tangent);
  reportDrift(information, problem.driftBlocks(), congruence(tangent_from_report, covariance.covariance),
              estimate.report);
  ScaleCheck scale = checkScale(input, solution.state, covariance, options);
  estimate.scale_doubt = std::move(scale.size_doubt);
  estimate.stretch_doubt = std::move(scale.stretch_doubt);
  estimate.bow_doubt = std::move(scale.bow_doubt);
  estimate.notes = std::move(scale.notes);
  const Observability observability =
      judgeObservability(input, solution.state, covariance, withScaleKnown(covariance), options);
  estimate.report.observability = observability.eigenvalues;
  if (!observability.directions.empty()) estimate.report.weakest = observability.directions.front();
  estimate.report.directions = observability.directions;
  estimate.status = observability.status;
  estimate.reason = observability.reason;
  return estimate;
}

}  // namespace evical
