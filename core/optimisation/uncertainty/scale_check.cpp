#include "core/optimisation/uncertainty/scale_check.h"

#include "core/data/board_bow.h"
#include "core/data/quantity.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <optional>

namespace evical {
namespace {

// Where one number of a quantity stands in the covariance; nothing where it is held.
std::optional<Eigen::Index> columnOf(const QuantityCovariance& covariance, const QuantityInfo& info,
                                     Eigen::Index part = 0) {
  for (std::size_t i = 0; i < covariance.quantities.size(); ++i) {
    if (covariance.quantities[i].info != &info) continue;
    const Eigen::Index first = covariance.first_column[i];
    if (first + part < covariance.first_column[i + 1]) return first + part;
  }
  return std::nullopt;
}

const QuantityInfo& scaleInfo() {
  return quantityInfo(kBoardQuantities, &BoardState::scale);
}
const QuantityInfo& stretchInfo() {
  return quantityInfo(kBoardQuantities, &BoardState::stretch);
}
constexpr Eigen::Index kGravityNorm = 2;  // behind its two tilts

// What is known of a number, and what the solution made of it.
struct Weighed {
  double prior_sigma, found, found_sigma;  // the prior's mean is 0

  // Of the recording against the prior; 0 where the recording says nothing of its own.
  double sigmas() const {
    const double moved2 = prior_sigma * prior_sigma - found_sigma * found_sigma;
    constexpr double kLeastShare = 0.05;  // of the prior's variance
    return moved2 > kLeastShare * prior_sigma * prior_sigma ? found / std::sqrt(moved2) : 0.0;
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
  Weighed weighed(const QuantityCovariance& covariance) const {
    return {std::sqrt(prior_variance), found,
            std::sqrt(std::max(0.0, weights.dot(covariance.covariance * weights)))};
  }
};

// How much larger the board is than said, by accelerations in units of gravity: either may be what is wrong.
Weighed excessOfBoard(const CalibrationInput& input, const CalibrationState& state,
                      const QuantityCovariance& covariance, const OptimisationOptions& options) {
  Combination excess(covariance);
  excess.add(columnOf(covariance, scaleInfo()), 1.0, options.board_spacing_sigma, state.board.scale - 1.0);
  excess.add(columnOf(covariance, kGravityQuantity, kGravityNorm), -1.0 / input.gravity_norm_m_s2,
             options.gravity_norm_sigma_m_s2, state.gravity_in_world_m_s2.norm() - input.gravity_norm_m_s2);
  return excess.weighed(covariance);
}

std::string sizeDoubt(const CalibrationInput& input, const Weighed& excess) {
  return fmt::format(
      "accelerations make the board {0:.2g} % {1} than board.spacing_m says ({2:.4g} m), or gravity {0:.2g} "
      "% {3} than {4:.4g} m/s^2 ({5:.1f} sigmas): measure the board over as many circles as there are, and "
      "give gravity.latitude_deg",
      100.0 * std::abs(excess.found), excess.found > 0.0 ? "larger" : "smaller", input.board.spacing_m,
      excess.found > 0.0 ? "smaller" : "larger", input.gravity_norm_m_s2, std::abs(excess.sigmas()));
}

std::string stretchDoubt(const Weighed& stretch) {
  return fmt::format(
      "the board is stretched: {:.2g} % {} along its rows than along its columns, {:.1f} sigmas beyond what "
      "board.spacing_std allows: measure it in both directions, and see that it lies flat",
      100.0 * std::abs(stretch.found), stretch.found > 0.0 ? "longer" : "shorter",
      std::abs(stretch.sigmas()));
}

// The curvatures that are certain.
BoardState certainBow(const BoardState& found, const QuantityCovariance& covariance,
                      const OptimisationOptions& options) {
  BoardState bent;
  forEachQuantity(kBoardQuantities, [&](const auto& row) {
    const auto column = columnOf(covariance, row.info);
    if (row.info.release != QuantityRelease::BoardBow || !column) return;
    const double sigma = std::sqrt(std::max(0.0, covariance.covariance(*column, *column)));
    if (std::abs(row.value(found)) > options.bent_board_sigmas * sigma) row.value(bent) = row.value(found);
  });
  return bent;
}

// What is bent a little is estimated, and right; what is bent a lot is no longer what was modelled.
void checkBow(const Board& board, const BoardState& bent, const OptimisationOptions& options,
              ScaleCheck& check) {
  const double bow_mm = largestBow_mm(bent, board);
  if (bow_mm < options.bent_board_mm) return;
  if (bow_mm > options.doubtful_scale_sigmas * options.board_bow_sigma_mm)
    check.bow_doubt = bowWords(bent, board) + ", further than is modelled well: lay it on glass";
  else
    check.notes.push_back(bowWords(bent, board) + ", which is estimated with the rest");
}

// "left: a board 0.1 % larger than said moves its translation by 0.68 mm"
void addEffects(const CalibrationInput& input, const QuantityCovariance& covariance,
                std::vector<std::string>& notes) {
  const auto scale = columnOf(covariance, scaleInfo());
  if (!scale) return;
  constexpr double kTenthOfPercent = 1e-3;
  const double variance = covariance.covariance(*scale, *scale);
  for (std::size_t i = 0; i < covariance.quantities.size(); ++i) {
    const Quantity& quantity = covariance.quantities[i];
    if (quantity.info->need != QuantityNeed::Translation || quantity.info->owner != QuantityOwner::Camera)
      continue;
    const Eigen::Vector3d moves_m =
        covariance.covariance.col(*scale).segment<3>(covariance.first_column[i]) / variance;
    notes.push_back(fmt::format(
        "{}: if the board is 0.1 % larger than said, the translation is {:.2f} mm off; its sigmas hold "
        "{:.2f} mm for that",
        input.cameras[quantity.sensor].name, 1e3 * kTenthOfPercent * moves_m.norm(),
        1e3 * std::sqrt(variance) * moves_m.norm()));
  }
}

}  // namespace

ScaleCheck checkScale(const CalibrationInput& input, const CalibrationState& state,
                      const QuantityCovariance& covariance, const OptimisationOptions& options) {
  ScaleCheck check;
  const Weighed excess = excessOfBoard(input, state, covariance, options);
  if (std::abs(excess.sigmas()) > options.doubtful_scale_sigmas) check.size_doubt = sizeDoubt(input, excess);
  Combination stretch(covariance);
  stretch.add(columnOf(covariance, stretchInfo()), 1.0, boardStretchSigma(options), state.board.stretch);
  const Weighed stretched = stretch.weighed(covariance);
  if (std::abs(stretched.sigmas()) > options.doubtful_scale_sigmas)
    check.stretch_doubt = stretchDoubt(stretched);
  addEffects(input, covariance, check.notes);
  checkBow(input.board, certainBow(state.board, covariance, options), options, check);
  return check;
}

QuantityCovariance withScaleKnown(const QuantityCovariance& covariance) {
  std::vector<Eigen::Index> known;
  for (const auto column : {columnOf(covariance, scaleInfo()), columnOf(covariance, stretchInfo()),
                            columnOf(covariance, kGravityQuantity, kGravityNorm)})
    if (column) known.push_back(*column);
  if (known.empty()) return covariance;
  const Eigen::MatrixXd of_known = covariance.covariance(known, known);
  const Eigen::MatrixXd mixed = covariance.covariance(Eigen::all, known);
  QuantityCovariance result = covariance;
  result.covariance -= mixed * of_known.ldlt().solve(mixed.transpose());
  return result;
}

}  // namespace evical
