#include "core/optimisation/uncertainty/scale_check.h"

#include "core/data/board_bow.h"
#include "core/data/quantity.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace evical {
namespace {

std::optional<Eigen::Index> boardColumn(const QuantityCovariance& covariance, QuantityId id,
                                        std::size_t board = 0) {
  return columnOf({QuantityOwner::Board, board, id}, covariance.quantities, covariance.first_column);
}

// Column of gravity's norm, behind its two tilts.
std::optional<Eigen::Index> gravityNormColumn(const QuantityCovariance& covariance) {
  return columnOf({QuantityOwner::Rig, 0, QuantityId::Gravity, 2}, covariance.quantities,
                  covariance.first_column);
}

// Prior of a number, and its estimate.
struct Weighed {
  double prior_sigma, found, found_sigma;  // the prior's mean is 0
  double max_share;                        // of the prior's sigma, with which the prior is tested

  // Disagreement between the recording and the prior; 0 if the recording adds little to the prior, since the
  // estimate then says nothing about the prior's error.
  double sigmas() const {
    if (found_sigma > max_share * prior_sigma) return 0.0;
    return found / std::sqrt(prior_sigma * prior_sigma - found_sigma * found_sigma);
  }
};

// One number, or the difference of two, of the covariance's columns.
struct Combination {
  Eigen::VectorXd weights;
  double prior_variance = 0.0, found = 0.0;

  explicit Combination(const QuantityCovariance& covariance)
      : weights(Eigen::VectorXd::Zero(covariance.covariance.rows())) {}

  void add(std::optional<Eigen::Index> column, double weight, double prior_sigma, double excess) {
    if (!column) return;
    weights[*column] = weight;
    prior_variance += weight * weight * prior_sigma * prior_sigma;
    found += weight * excess;
  }
  Weighed weighed(const QuantityCovariance& covariance, const OptimisationOptions& options) const {
    return {std::sqrt(prior_variance), found,
            std::sqrt(std::max(0.0, weights.dot(covariance.covariance * weights))), options.max_scale_share};
  }
};

// Relative excess of the board's size over its given value, from accelerations in units of gravity. Either
// value may be wrong.
Weighed excessOfBoard(const CalibrationInput& input, const CalibrationState& state,
                      const QuantityCovariance& covariance, const OptimisationOptions& options) {
  Combination excess(covariance);
  excess.add(boardColumn(covariance, QuantityId::Scale), 1.0, options.board_spacing_sigma,
             state.board.scale - 1.0);
  excess.add(gravityNormColumn(covariance), -1.0 / input.gravity_norm_m_s2, options.gravity_norm_sigma_m_s2,
             state.gravity_in_world_m_s2.norm() - input.gravity_norm_m_s2);
  return excess.weighed(covariance, options);
}

// Relative excess of a further board's size over its given value, measured by the world's board.
Weighed ratioToWorld(const CalibrationInput& input, const CalibrationState& state, std::size_t board,
                     const QuantityCovariance& covariance, const OptimisationOptions& options) {
  Combination ratio(covariance);
  for (const auto& [index, weight] : {std::pair<std::size_t, double>{board, 1.0}, {0, -1.0}})
    ratio.add(boardColumn(covariance, QuantityId::Scale, index), weight,
              input.spacingSigma(index, options.board_spacing_sigma), state.boardAt(index).scale - 1.0);
  return ratio.weighed(covariance, options);
}

std::string sizeDoubt(const CalibrationInput& input, const Weighed& excess) {
  return fmt::format(
      "accelerations make the {6} {0:.2g} % {1} than specified (spacing {2:.4g} m), or gravity {0:.2g} "
      "% {3} than {4:.4g} m/s^2 ({5:.1f} sigmas): measure the board over as many circles as possible, and "
      "give gravity.latitude_deg",
      100.0 * std::abs(excess.found), excess.found > 0.0 ? "larger" : "smaller", input.board.spacing_m,
      excess.found > 0.0 ? "smaller" : "larger", input.gravity_norm_m_s2, std::abs(excess.sigmas()),
      input.boardWords(0));
}

// If two boards' sizes contradict each other, one of them is wrong.
std::string ratioDoubt(const CalibrationInput& input, std::size_t board, const Weighed& ratio) {
  return fmt::format(
      "the boards {} and {} contradict each other: measured against the first, the second is {:.2g} % {} "
      "than specified (spacing {:.4g} m, {:.1f} sigmas): measure both over as many spacings as possible",
      input.boardName(0), input.boardName(board), 100.0 * std::abs(ratio.found),
      ratio.found > 0.0 ? "larger" : "smaller", input.boardAt(board).spacing_m, std::abs(ratio.sigmas()));
}

std::string stretchDoubt(const std::string& board, const Weighed& stretch) {
  return fmt::format(
      "the {} is stretched: it is {:.2g} % {} along its rows than along its columns ({:.1f} sigmas of "
      "board.spacing_std). Measure it in both directions, and mount it flat",
      board, 100.0 * std::abs(stretch.found), stretch.found > 0.0 ? "longer" : "shorter",
      std::abs(stretch.sigmas()));
}

// The curvatures that are certain.
BoardState certainBow(std::size_t board, const BoardState& found, const QuantityCovariance& covariance,
                      const OptimisationOptions& options) {
  BoardState bent;
  forEachSheetQuantity([&](const auto& row) {
    const auto column = boardColumn(covariance, row.info.id, board);
    if (row.info.release != QuantityRelease::BoardBow || !column) return;
    const double sigma = std::sqrt(std::max(0.0, covariance.covariance(*column, *column)));
    if (std::abs(row.value(found)) > options.bent_board_sigmas * sigma) row.value(bent) = row.value(found);
  });
  return bent;
}

// A small bow is estimated correctly. A large one exceeds the model.
void checkBow(const CalibrationInput& input, std::size_t index, const BoardState& bent,
              const OptimisationOptions& options, ScaleCheck& check) {
  const Board& board = input.boardAt(index);
  const double bow_mm = largestBow_mm(bent, board);
  if (bow_mm < options.bent_board_mm) return;
  if (bow_mm > options.doubtful_scale_sigmas * options.board_bow_sigma_mm)
    check.bow_doubt =
        bowWords(bent, board, input.boardWords(index)) + ", more than the model covers: mount it on glass";
  else
    check.notes.push_back(bowWords(bent, board, input.boardWords(index)) +
                          ", which is estimated with the rest");
}

// "left: a board 0.1 % larger than given changes its translation by 0.68 mm"
void addEffects(const CalibrationInput& input, const QuantityCovariance& covariance,
                std::vector<std::string>& notes) {
  const auto scale = boardColumn(covariance, QuantityId::Scale);
  if (!scale) return;
  constexpr double kTenthOfPercent = 1e-3;
  const double variance = covariance.covariance(*scale, *scale);
  for (std::size_t i = 0; i < covariance.quantities.size(); ++i) {
    const Quantity& quantity = covariance.quantities[i];
    if (!quantity.info->is(QuantityOwner::Camera, QuantityId::Translation)) continue;
    const Eigen::Vector3d moves_m =
        covariance.covariance.col(*scale).segment<3>(covariance.first_column[i]) / variance;
    notes.push_back(fmt::format(
        "{}: if the board is 0.1 % larger than given, the translation changes by {:.2f} mm; its sigmas "
        "include {:.2f} mm for this",
        input.cameras[quantity.sensor].name, 1e3 * kTenthOfPercent * moves_m.norm(),
        1e3 * std::sqrt(variance) * moves_m.norm()));
  }
}

}  // namespace

ScaleCheck checkScale(const CalibrationInput& input, const CalibrationState& state,
                      const QuantityCovariance& covariance, const OptimisationOptions& options) {
  ScaleCheck check;
  const auto isDoubtful = [&](const Weighed& weighed, const std::string& known) {
    return known.empty() && std::abs(weighed.sigmas()) > options.doubtful_scale_sigmas;
  };
  const Weighed excess = excessOfBoard(input, state, covariance, options);
  if (isDoubtful(excess, check.size_doubt)) check.size_doubt = sizeDoubt(input, excess);
  addEffects(input, covariance, check.notes);
  for (std::size_t i = 0; i < input.boardCount(); ++i) {
    const BoardState& board = state.boardAt(i);
    const double spacing_sigma = input.spacingSigma(i, options.board_spacing_sigma);
    if (i > 0) {
      const Weighed ratio = ratioToWorld(input, state, i, covariance, options);
      if (isDoubtful(ratio, check.size_doubt)) check.size_doubt = ratioDoubt(input, i, ratio);
    }
    Combination stretch(covariance);
    stretch.add(boardColumn(covariance, QuantityId::Stretch, i), 1.0, boardStretchSigma(spacing_sigma),
                board.stretch);
    const Weighed stretched = stretch.weighed(covariance, options);
    if (isDoubtful(stretched, check.stretch_doubt))
      check.stretch_doubt = stretchDoubt(input.boardWords(i), stretched);
    checkBow(input, i, certainBow(i, board, covariance, options), options, check);
  }
  return check;
}

QuantityCovariance withScaleKnown(const QuantityCovariance& covariance) {
  std::vector<Eigen::Index> known;
  for (std::size_t i = 0; i < covariance.quantities.size(); ++i)
    if (const QuantityInfo* const info = covariance.quantities[i].info;
        info->id == QuantityId::Scale || info->id == QuantityId::Stretch)
      known.push_back(covariance.first_column[i]);
  if (const auto norm = gravityNormColumn(covariance)) known.push_back(*norm);
  if (known.empty()) return covariance;
  const Eigen::MatrixXd of_known = covariance.covariance(known, known);
  const Eigen::MatrixXd mixed = covariance.covariance(Eigen::all, known);
  QuantityCovariance result = covariance;
  result.covariance -= mixed * of_known.ldlt().solve(mixed.transpose());
  return result;
}

}  // namespace evical
