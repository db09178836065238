// Reference work of the speed guard: plane fits to the times of neighbouring pixels, like in the front end,
// and solutions of dense equations, like in the optimiser. It uses no code of the project, so that its cost
// does not change when a stage becomes slower.
#include "tests/benchmarks/benchmark_program.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace evical::benchmarks {
namespace {

// Sum of the slopes of planes around pixels at which events happen in a random order.
double planeFits(int events) {
  constexpr std::size_t kWidth = 346, kHeight = 260, kReach = 2;
  std::vector<double> times(kWidth * kHeight, 0.0);
  std::uint64_t state = 1;
  double slopes = 0.0;
  for (int event = 0; event < events; ++event) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    const std::size_t x = kReach + (state >> 33) % (kWidth - 2 * kReach);
    const std::size_t y = kReach + (state >> 45) % (kHeight - 2 * kReach);
    times[y * kWidth + x] = event;
    double count = 0.0, along_x = 0.0, along_y = 0.0;
    for (std::size_t row = y - kReach; row <= y + kReach; ++row) {
      for (std::size_t column = x - kReach; column <= x + kReach; ++column) {
        const double age = event - times[row * kWidth + column];
        if (age > 50'000.0) continue;
        count += 1.0;
        along_x += age * (static_cast<double>(column) - static_cast<double>(x));
        along_y += age * (static_cast<double>(row) - static_cast<double>(y));
      }
    }
    slopes += std::sqrt(along_x * along_x + along_y * along_y) / count;
  }
  return slopes;
}

// In-place Cholesky factors of a diagonally dominant matrix; returns the last one.
double factorised(std::vector<double>& matrix, std::size_t size) {
  for (std::size_t row = 0; row < size; ++row) {
    for (std::size_t column = 0; column <= row; ++column) {
      double sum = matrix[row * size + column];
      for (std::size_t k = 0; k < column; ++k) sum -= matrix[row * size + k] * matrix[column * size + k];
      matrix[row * size + column] = row == column ? std::sqrt(sum) : sum / matrix[column * size + column];
    }
  }
  return matrix.back();
}

double solutions(int count) {
  constexpr std::size_t kSize = 96;
  double sum = 0.0;
  std::vector<double> matrix(kSize * kSize);
  for (int k = 0; k < count; ++k) {
    for (std::size_t row = 0; row < kSize; ++row)
      for (std::size_t column = 0; column < kSize; ++column)
        matrix[row * kSize + column] =
            row == column ? kSize + k : 1.0 / static_cast<double>(1 + row + column);
    sum += factorised(matrix, kSize);
  }
  return sum;
}

}  // namespace

double speedReference() {
  return planeFits(600'000) + solutions(150);
}

}  // namespace evical::benchmarks
