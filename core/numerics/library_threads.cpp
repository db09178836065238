#include "core/numerics/library_threads.h"

#include <dlfcn.h>

namespace evical {
namespace {

// Whether a program has such a library is known when it runs only.
template <class Function>
Function* loaded(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_DEFAULT, name));
}

int ask(const char* name) {
  auto* const function = loaded<int()>(name);
  return function != nullptr ? function() : 0;
}

void tell(const char* name, int number) {
  auto* const function = loaded<void(int)>(name);
  if (function != nullptr) function(number);
}

}  // namespace

LibraryThreads::LibraryThreads(int threads)
    : openmp_before_(ask("omp_get_max_threads")),
      openmp_dynamic_before_(ask("omp_get_dynamic")),
      openblas_before_(ask("openblas_get_num_threads")) {
  tell("omp_set_num_threads", threads);
  tell("omp_set_dynamic", 1);  // else CHOLMOD has the number that it was built with
  tell("openblas_set_num_threads", threads);
}

LibraryThreads::~LibraryThreads() {
  if (openmp_before_ > 0) tell("omp_set_num_threads", openmp_before_);
  tell("omp_set_dynamic", openmp_dynamic_before_);
  if (openblas_before_ > 0) tell("openblas_set_num_threads", openblas_before_);
}

}  // namespace evical
