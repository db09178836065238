#include "core/optimisation/uncertainty/covariance.h"

#include "core/data/quantity.h"
#include "core/numerics/dense.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/calibration_problem.h"
#include "core/optimisation/known_values.h"
#include "core/optimisation/uncertainty/change_test.h"
#include "core/optimisation/uncertainty/observability.h"
#include "core/optimisation/uncertainty/projected_information.h"
#include "core/optimisation/uncertainty/quantity_covariance.h"
#include "core/optimisation/uncertainty/scale_check.h"
#include "core/optimisation/uncertainty/schur_columns.h"
#include "core/optimisation/uncertainty/score_test.h"
#include "core/optimisation/uncertainty/shared_sensors.h"

namespace evical {
namespace {

// A covariance in the format of results: addresses, standard deviations and correlation of all numbers, and
// each quantity's own sigmas.
UncertaintyReport makeReport(const CalibrationInput& input, const QuantityCovariance& quantities) {
  UncertaintyReport report;
  report.cameras.resize(input.cameras.size());
  report.imus.resize(input.imus.size());
  report.further_boards.resize(input.further_boards.size());
  report.standard_deviations = quantities.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd inverse = report.standard_deviations.cwiseMax(1e-300).cwiseInverse();
  report.correlation = inverse.asDiagonal() * quantities.covariance * inverse.asDiagonal();
  report.correlation.diagonal().setOnes();
  for (std::size_t i = 0; i < quantities.quantities.size(); ++i) {
    QuantityAddress number = quantities.quantities[i].address();
    if (number.id == QuantityId::Intrinsics)
      number.model = input.cameras[number.sensor].lens.detection_intrinsics->model;
    // Unused numbers of intrinsics and gravity, without a column, come last.
    for (Eigen::Index k = quantities.first_column[i]; k < quantities.first_column[i + 1];
         ++k, ++number.component)
      report.columns.push_back(number);
  }
  setSigmas(report);
  return report;
}

// Fills the drifts' sigmas of the report's IMUs. `covariance`: of the information's quantities, in their
// tangent spaces, the biases' means among them.
void reportDrift(const ProjectedInformation& information, const std::vector<Quantity>& drift_blocks,
                 const Eigen::MatrixXd& covariance, UncertaintyReport& report) {
  for (std::size_t k = 0; k < drift_blocks.size(); ++k) {
    const Quantity& knot = drift_blocks[k];
    const auto row = static_cast<Eigen::Index>(3 * k);
    const auto mean = columnOf(knot.address(), information.quantities, information.first_column);
    if (!mean) continue;
    Eigen::MatrixXd by_quantities = -information.drift_by_quantities.middleRows<3>(row);
    by_quantities.middleCols<3>(*mean) += Eigen::Matrix3d::Identity();
    const Eigen::Vector3d variance = information.drift_covariance.diagonal().segment<3>(row) +
                                     (by_quantities * covariance * by_quantities.transpose()).diagonal();
    ImuUncertainty& imu = report.imus[knot.sensor];
    const bool gyroscope = knot.info->id == QuantityId::GyroscopeBias;
    (gyroscope ? imu.gyroscope_drift_std_rad_s : imu.accelerometer_drift_std_m_s2)
        .push_back(variance.cwiseMax(0.0).cwiseSqrt());
  }
}

ProjectedInformation projected(CalibrationProblem& problem, const CalibrationInput& input,
                               const BatchSolution& solution, const OptimisationOptions& options,
                               const RunContext& context) {
  context.throwIfStopped();
  problem.build(lastStage(options), {solution.scales, solution.used_circles, solution.used_samples,
                                     std::vector<UnexcitedAxes>(input.imus.size())});
  return projectInformation(problem, options.correlation_time_s, options.threads, context);
}

// Information of all estimated quantities, noise-corrected.
struct Sigmas {
  QuantityCovariance covariance;
  UncertaintyReport report;
};
Sigmas sigmasFrom(CalibrationProblem& problem, const ProjectedInformation& information,
                  const CalibrationInput& input, const CalibrationState& state,
                  const OptimisationOptions& options) {
  const Eigen::MatrixXd report_from_tangent = reportFromTangent(information, state, problem.problem());
  Sigmas sigmas{withPixelDelay(input, options, quantityCovariance(information, report_from_tangent)), {}};
  sigmas.report = makeReport(input, sigmas.covariance);
  reportSharedSensors(input, options, sigmas.report);
  const Eigen::MatrixXd tangent_from_report = inverseOf(report_from_tangent);
  reportDrift(information, problem.driftBlocks(),
              congruence(tangent_from_report, sigmas.covariance.covariance), sigmas.report);
  return sigmas;
}

}  // namespace

UncertaintyReport estimateSigmas(const CalibrationInput& input, const BatchSolution& solution,
                                 const OptimisationOptions& options, const RunContext& context) {
  OptimisationOptions apart = options;
  apart.share_sensors = false;  // until they are tied
  CalibrationProblem problem(input, apart, solution.state);
  ProjectedInformation information = projected(problem, input, solution, options, context);
  information = withSharedSensors(input, options, std::move(information));
  information = withoutNoise(std::move(information));
  return sigmasFrom(problem, information, input, solution.state, options).report;
}

UncertaintyEstimate estimateUncertainty(const CalibrationInput& input, const BatchSolution& solution,
                                        const OptimisationOptions& options, const RunContext& context) {
  const OptimisationOptions tested = freeToBeTested(options);
  CalibrationProblem problem(input, tested, solution.state);
  ProjectedInformation information = projected(problem, input, solution, options, context);
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
  Sigmas sigmas = sigmasFrom(problem, information, input, solution.state, options);
  const QuantityCovariance& covariance = sigmas.covariance;
  estimate.report = std::move(sigmas.report);
  estimate.as_weighed = covariance.as_weighed;
  estimate.report.given = givenQuantities(input, options);
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
