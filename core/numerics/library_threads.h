// Threads that the libraries below a solver start on their own: CHOLMOD and some BLAS by OpenMP, OpenBLAS by
// itself. Each takes all processors unless it is told otherwise.
#pragma once

namespace evical {

// For what the calling thread does while this lives.
class LibraryThreads {
 public:
  explicit LibraryThreads(int threads);
  ~LibraryThreads();
  LibraryThreads(const LibraryThreads&) = delete;
  LibraryThreads& operator=(const LibraryThreads&) = delete;

 private:
  int openmp_before_, openmp_dynamic_before_, openblas_before_;  // 0: not there
};

}  // namespace evical
